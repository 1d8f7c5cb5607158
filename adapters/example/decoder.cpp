// Decoder of the example drive: the sentences.
// In: frames. Out: lines. Never shows a control character.
#include "adapters/example/decoder.hpp"

#include <fmt/core.h>

namespace axisgate::example {

std::vector<std::string> LineDecoder::on_frame(const Frame& frame, std::optional<bool> to_drive) {
    std::vector<std::string> said;
    const std::string_view bytes(reinterpret_cast<const char*>(frame.data().data()), frame.size);
    framers_[to_drive.value_or(true) ? 0 : 1].push(bytes, [&](std::string_view line) {
        bool request = false;
        const auto t = telegram_of(line, request);
        if (!t) return said.push_back(fmt::format("unknown: {} bytes that are no telegram", line.size()));
        const std::string_view verb = t->kind == Telegram::Kind::read      ? " is asked"
                                      : t->kind == Telegram::Kind::refused ? " is refused: "
                                                                           : " = ";
        said.push_back(fmt::format("{} {} axis {}: {}{}{}", request ? "to drive" : "drive", t->address, t->axis, t->item, verb, t->text));
        for (char& c : said.back())
            if (c < ' ' || c > '~') c = '.';
    });
    return said;
}

}  // namespace axisgate::example
