// Stated: what a line of MCode, an action or a parameter write would do to the axis, read before it is sent.
// In: bodies of commands. Out: targets and speeds of MA, MR and SL, rates for later motions, or that it cannot be read.
// Never knows the drive's program: what starts, resumes or calls one, or lets an input or a master move the axis, is unread.
#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "adapters/mcode/native.hpp"
#include "adapters/mcode/parameters.hpp"
#include "adapters/mcode/wire.hpp"
#include "gateway/core/text.hpp"

namespace axisgate::mcode {
namespace {
using Kind = Stated::Kind;

bool any_of(std::string_view word, std::span<const std::string_view> words) { return std::ranges::find(words, word) != words.end(); }

/// Instructions that begin no motion by themselves. PS and E end one; a reset and what is stored act by SU alone, which is judged by
/// itself.
constexpr std::array<std::string_view, 25> harmless{"PR", "L",  "S",  "CP", "IP", "FD", "VA", "LB", "IN", "IT",  "VT", "PN", "SN",
                                                    "VR", "AL", "UV", "CF", "PS", "E",  "H",  "BP", "OF", "ESC", "C1", "C2"};
/// Settings by which something else than an order of the gateway may move the axis: jog, follow, input functions, programs at power-on and
/// by trips, bare numbers as motions.
constexpr std::array<std::string_view, 6> triggers{"JE", "FL", "IS", "SU", "NE", "TE"};
constexpr std::array<std::string_view, 10> programs{"EX", "BR", "CL", "RS", "RT", "OE", "PG", "UG", "SC", "IV"};

std::optional<std::int64_t> number_behind(std::string_view line) {
    const auto equals = line.find('=');
    const auto at = equals != std::string_view::npos ? equals : line.find(' ');
    return at == std::string_view::npos ? std::nullopt : parse_whole(trimmed(line.substr(at + 1)), INT64_MIN, INT64_MAX);
}

Stated moves(Move::Kind kind, std::optional<std::int64_t> target) {
    if (!target) return {Kind::unread};  // a variable, or two fields
    Stated s{Kind::motion};
    s.move.kind = kind;
    s.move.target = *target;
    return s;
}

Stated of_setting(std::string_view word, std::optional<std::int64_t> number) {
    Stated s{Kind::nothing};
    if (any_of(word, triggers) && number != 0) return {Kind::unread};
    if (word == "AS" && (!number || *number == 3)) return {Kind::unread};  // torque mode turns at once [L5995]
    if (word == "IC" || word == "DC" || !number || *number <= 0) return s;
    if (word == "VM") s.sets.velocity = *number;
    if (word == "A") s.sets.acceleration = *number;
    if (word == "D") s.sets.deceleration = s.sets.quick_stop = *number;
    return s;
}

Stated of_line(std::string_view text) {
    std::string line(trimmed(text));
    if (const auto comment = line.find('\''); comment != std::string::npos) line = std::string(trimmed(line.substr(0, comment)));
    if (line.empty()) return {Kind::nothing};
    const std::string w = word_of(line);
    const auto number = number_behind(line);
    if (w == "MA") return moves(Move::Kind::absolute, number);
    if (w == "MR") return moves(Move::Kind::relative, number);
    if (w == "SL") return number == 0 ? Stated{Kind::nothing} : moves(Move::Kind::velocity, number);
    if (w == "HM" || w == "HI" || w == "HF") return {Kind::homing};
    if (w.empty() || any_of(w, programs)) return {Kind::unread};  // a bare number repeats the last motion with NE = 1 [L4464]
    if (w == "PR" || w == "L") return {Kind::nothing};
    if (w == "IC" || w == "DC") return {Kind::nothing};
    if (line.find('=') != std::string::npos) return of_setting(w, number);
    return any_of(w, harmless) ? Stated{Kind::nothing} : Stated{Kind::unread};
}

Stated of_action(const Action& a) {
    constexpr std::array<std::string_view, 12> lines{"program.list",  "program.upload", "program.download",   "program.edit",
                                                     "program.pause", "program.end",    "program.clear",      "program.save",
                                                     "restore",       "line.setup",     "clear_locked_rotor", "factory_defaults"};
    if (any_of(a.name, lines)) return {Kind::nothing};
    if (a.name.find('.') != std::string::npos || a.name == "reset" || a.name == "calibrate") return {Kind::unread};
    return of_line(a.argument.empty() ? a.name : fmt::format("{} {}", a.name, a.argument));
}
}  // namespace

Stated stated(const Catalogue& catalogue, int, const CommandBody& body) {
    if (const auto* native = std::get_if<Native>(&body)) {
        if (native->send.size() == 1 && native->send[0] == 0x1B) return {Kind::nothing};  // the escape character stops
        return of_line({reinterpret_cast<const char*>(native->send.data()), native->send.size()});
    }
    if (const auto* action = std::get_if<Action>(&body)) return of_action(*action);
    if (const auto* write = std::get_if<WriteParameter>(&body)) {
        const Parameter* p = catalogue.parameter(write->point);
        return p ? of_setting(word_of(word_of_parameter(*p)), as_integer(write->value)) : Stated{Kind::nothing};
    }
    return {Kind::nothing};
}

}  // namespace axisgate::mcode
