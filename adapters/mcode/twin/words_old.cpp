// DeviceSetup: a firmware before 6.0.01 does not know some words, so it takes them for unknown names and commands.
#include "adapters/mcode/twin/device.hpp"
#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {

int DeviceSetup::too_new(std::string_view text) const {
    if (!manners.before_6()) return 0;
    const Tokens tokens(text);
    for (std::size_t i = 0; tokens.peek(i).kind != Token::Kind::end; ++i) {
        const Token& t = tokens.peek(i);
        const auto word = t.kind == Token::Kind::name ? word_named(t.text) : std::nullopt;
        if (!word || !came_with_6(*word)) continue;
        if (i != 0) return err::bad_print;
        return info(*word).kind == WordKind::instruction ? err::unknown_command : err::unknown_set;
    }
    return 0;
}

}  // namespace axisgate::mcode::twin
