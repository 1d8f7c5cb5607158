// Decoder of the remote family: the sentences.
// In: frames. Out: lines. Never shows a control character.
#include "adapters/remote/decoder.hpp"

#include <fmt/core.h>

namespace axisgate::remote {
using mirror::Telegram;

std::vector<std::string> LineDecoder::on_frame(const Frame& frame, std::optional<bool> to_drive) {
    std::vector<std::string> said;
    if (frame.kind != Frame::Kind::bytes) return said;
    const std::string_view bytes(reinterpret_cast<const char*>(frame.data().data()), frame.size);
    framers_[to_drive.value_or(true) ? 0 : 1].push(bytes, [&](std::string_view line) {
        if (line.empty()) return;
        const auto t = mirror::telegram_of(line);
        if (!t) return said.push_back(fmt::format("unknown: {} bytes that are no telegram", line.size()));
        const std::string_view verb = t->kind == Telegram::Kind::request  ? "is asked:"
                                      : t->kind == Telegram::Kind::answer ? "answers:"
                                      : t->kind == Telegram::Kind::state  ? "is:"
                                                                          : "cannot be told of:";
        said.push_back(fmt::format("{} {} {} (number {})", t->address, verb, t->body, t->number));
    });
    return said;
}

}  // namespace axisgate::remote
