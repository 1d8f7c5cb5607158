// The direction is in the telegram.
#include "adapters/example/decoder.hpp"

#include <fmt/core.h>

namespace axisgate::example {

std::optional<std::string> LineDecoder::sentence(std::string_view line) const {
    bool request = false;
    const auto t = telegram_of(line, request);
    if (!t) return std::nullopt;
    using Kind = Telegram::Kind;
    const std::string_view verb = t->kind == Kind::read ? " is asked" : t->kind == Kind::refused ? " is refused: " : " = ";
    return fmt::format("{} {} axis {}: {}{}{}", request ? "to drive" : "drive", t->address, t->axis, t->item, verb, t->text);
}

}  // namespace axisgate::example
