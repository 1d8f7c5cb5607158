#include "adapters/remote/decoder.hpp"

#include <fmt/core.h>

namespace axisgate::remote {
using Kind = mirror::Telegram::Kind;

std::optional<std::string> LineDecoder::sentence(std::string_view line) const {
    const auto t = mirror::telegram_of(line);
    if (!t) return std::nullopt;
    const std::string_view verb = t->kind == Kind::request  ? "is asked:"
                                  : t->kind == Kind::answer ? "answers:"
                                  : t->kind == Kind::state  ? "is:"
                                                            : "cannot be told of:";
    return fmt::format("{} {} {} (number {})", t->address, verb, t->body, t->number);
}

}  // namespace axisgate::remote
