// R21 and R22 are motions, R06 to R09 rates; all registers are listed in the README.
#include "adapters/example/native.hpp"
#include "gateway/core/text.hpp"

namespace axisgate::example {
namespace {
using What = Stated::Kind;

Stated of_register(std::string_view item, std::optional<std::int64_t> value) {
    Stated s{What::nothing};
    if (item == "R21" || item == "R22") {
        if (!value) return {What::unread};
        s.kind = What::motion;
        s.move.kind = item == "R21" ? Move::Kind::absolute : Move::Kind::velocity;
        s.move.target = *value;
    }
    if (value && *value > 0) {
        if (item == "R06") s.sets.velocity = *value;
        if (item == "R07") s.sets.acceleration = *value;
        if (item == "R08") s.sets.deceleration = *value;
        if (item == "R09") s.sets.quick_stop = *value;
    }
    const auto number = item.size() == 3 && item[0] == 'R' ? parse_whole(item.substr(1), 0, 99) : std::nullopt;
    if (!number || *number > 26) s.kind = What::unread;
    return s;
}
}  // namespace

Stated stated(const Catalogue& catalogue, int, const CommandBody& body) {
    if (const auto* native = std::get_if<Native>(&body)) {
        const std::string_view s(reinterpret_cast<const char*>(native->send.data()), native->send.size());
        if (s.size() < 4 || s[3] != '=') return {What::nothing};  // a read, or it is refused
        return of_register(s.substr(0, 3), parse_whole(s.substr(4), INT64_MIN, INT64_MAX));
    }
    if (const auto* write = std::get_if<WriteParameter>(&body)) {
        const Parameter* p = catalogue.parameter(write->point);
        const auto* number = p ? p->wire.if_contains("register") : nullptr;
        if (!number) return {What::nothing};
        const auto n = number->as_int64();
        return of_register(n < 10 ? "R0" + std::to_string(n) : "R" + std::to_string(n), as_integer(write->value));
    }
    return {What::nothing};  // the action identify
}

}  // namespace axisgate::example
