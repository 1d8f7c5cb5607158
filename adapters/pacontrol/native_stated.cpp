// Stated: what a command of the control, an action or a parameter write would do to an axis, read before it is sent.
// In: bodies of commands. Out: targets in increments with the axis that they concern, references, overrides, or that it cannot be read.
// Never knows what was interrupted: ONLINE that starts again and an axis that is switched on may let a motion go on, and are unread.
#include "adapters/pacontrol/native.hpp"

#include <span>

#include "adapters/pacontrol/parameters_elements.hpp"
#include "adapters/pacontrol/wire.hpp"
#include "adapters/pacontrol/wire_commands.hpp"
#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {
namespace {
using Kind = Stated::Kind;

Stated of_request(const Request& r, int channel) {
    const CommandInfo* c = command_info(r.code);
    if (!c) return {Kind::unread};
    const auto data = real_of(r.data);
    const std::int64_t value = increments_of(data.value_or(0));
    Stated s{Kind::nothing};
    std::uint32_t axis = c->parameter == Takes::axis ? r.parameter : 0;
    const auto moves = [&](Move::Kind kind) {
        s.kind = data ? Kind::motion : Kind::unread;
        s.move.kind = kind;
        s.move.target = value;
    };
    switch (r.code) {
        case code::move_absolute:
        case code::move_absolute_wait:
        case code::manual_absolute:
            moves(Move::Kind::absolute);
            break;
        case code::move_relative:
        case code::move_relative_wait:
        case code::manual_relative:
            moves(Move::Kind::relative);
            break;
        case code::reference:
            s.kind = Kind::homing;
            break;
        case code::set_speed:
            if (value > 0) s.sets.velocity = value;
            break;
        case code::set_acceleration:
            if (value > 0) s.sets.acceleration = s.sets.deceleration = s.sets.quick_stop = value;
            break;
        case code::put_axis_parameter: {
            axis = r.parameter >> 8;
            const std::uint32_t number = r.parameter & 0xFF;
            if (value > 0 && number == 0x01) s.sets.velocity = value;
            if (value > 0 && number == 0x06) s.sets.acceleration = s.sets.deceleration = s.sets.quick_stop = value;
            break;
        }
        case code::start_online:
        case code::start_auto:
        case code::axis_on:
            s.kind = Kind::unread;
            break;
        default:
            break;
    }
    if (axis != 0 && axis != static_cast<std::uint32_t>(channel)) s.channel = static_cast<int>(axis);
    return s;
}

Stated of_native(const Native& native, int channel) {
    std::string fault;
    std::optional<Request> r;
    if (native.is_text) {
        std::string text(native.send.begin(), native.send.end());
        while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' '))
            text.pop_back();
        r = request_of(text, fault);
    } else {
        Framer framer;
        framer.push(native.send, {[&](std::string_view text, std::string_view) { r = request_of(text, fault); }, [] {},
                                  [](FrameFault, std::span<const std::uint8_t>) {}});
    }
    return r ? of_request(*r, channel) : Stated{Kind::nothing};  // a poll, or it is refused
}

/// "to 200.0", "by -10"; nothing: another form.
Stated of_way(std::string_view argument) {
    const auto w = words_of(argument);
    const auto v = w.size() == 2 ? real_of(w[1]) : std::nullopt;
    if (!v || (w[0] != "to" && w[0] != "by")) return {Kind::unread};
    Stated s{Kind::motion};
    s.move.kind = w[0] == "to" ? Move::Kind::absolute : Move::Kind::relative;
    s.move.target = increments_of(*v);
    return s;
}

Stated of_action(const Action& a, int channel) {
    const std::string& n = a.name;
    if (n == "online.start" || n == "automatic.start" || n == "traverse_until_input" || n == "measure") return {Kind::unread};
    if (n == "reference") return {words_of(a.argument).size() > 1 ? Kind::unread : Kind::homing};  // of several axes
    if (n == "manual_move") return of_way(a.argument);
    const auto number = static_cast<std::uint32_t>(channel);
    if (n == "override.speed") return of_request(request_for(code::set_speed, number, a.argument), channel);
    if (n == "override.acceleration") return of_request(request_for(code::set_acceleration, number, a.argument), channel);
    const CommandInfo* c = command_named(n);
    if (!c) return {Kind::nothing};
    const auto at = a.argument.find(';');
    const std::string parameter = at == std::string::npos ? std::string() : a.argument.substr(0, at);
    const std::string data = at == std::string::npos ? a.argument : a.argument.substr(at + 1);
    const auto p = parameter.empty() ? std::optional(number) : whole_of(parameter);
    if (!p) return {Kind::nothing};  // it is refused
    return of_request(request_for(c->code, *p, data), channel);
}
}  // namespace

Stated stated(const Catalogue& catalogue, int channel, const CommandBody& body) {
    if (const auto* native = std::get_if<Native>(&body)) return of_native(*native, channel);
    if (const auto* action = std::get_if<Action>(&body)) return of_action(*action, channel);
    if (const auto* write = std::get_if<WriteParameter>(&body)) {
        const Elements elements(catalogue);
        const Binding* b = elements.binding(write->point);
        if (!b || !b->write) return {Kind::nothing};
        return of_request(Elements::write(*b, write->point, channel, write->value), channel);
    }
    return {Kind::nothing};
}

}  // namespace axisgate::pacontrol
