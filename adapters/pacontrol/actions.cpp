// Verbs, part actions: the functions of this family beyond the common ones, by the catalogue's names, and every command code by its own.
// In: Action with its argument. Out: jobs of the other verbs, or one command.
// Never guesses an argument: what cannot be read is refused with an example.
#include <fmt/core.h>

#include "adapters/pacontrol/drive.hpp"
#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {
namespace {
enum Step : std::uint8_t { one_command = 1, condition_set, conditional_move, manual_move };

struct Way {
    bool relative = false;
    std::string text;
};
/// "to 200.0", "absolute 200.0", "by -10", "relative -10".
std::optional<Way> way_of(std::string_view how, std::string_view distance) {
    const bool absolute = how == "to" || how == "absolute", relative = how == "by" || how == "relative";
    const auto v = real_of(distance);
    if ((!absolute && !relative) || !v) return std::nullopt;
    return Way{relative, real_text(*v)};
}

bool is_relative(std::uint16_t c) { return c == code::move_relative || c == code::manual_relative; }
bool is_by_hand(std::uint16_t c) { return c == code::manual_absolute || c == code::manual_relative; }
}  // namespace

void Actions::start(Axis& a, const Action& action, Turn& t) {
    const std::string& n = action.name;
    const std::string_view arg = action.argument;
    const auto w = words_of(arg);
    const auto mode = [&](std::uint16_t what) {
        if (!w.empty()) return jobs_.refuse(a, Reason::out_of_range, fmt::format("{} takes no argument", n), t);
        drive_.power.start_mode(a, what, t);
    };
    const auto real = [&](std::uint16_t what, std::string_view unit) {
        const auto v = w.size() == 1 ? real_of(w[0]) : std::nullopt;
        if (!v) return jobs_.refuse(a, Reason::out_of_range, fmt::format("{} takes one number in {}, as in 12.5", n, unit), t);
        start_code(a, *command_info(what), real_text(*v), t);
    };
    if (n == "online.start") return mode(code::start_online);
    if (n == "online.stop" || n == "automatic.stop") return mode(code::stop);
    if (n == "online.give_back") return mode(code::abort_online);
    if (n == "automatic.cancel") return mode(code::abort_auto);
    if (n == "automatic.start") {
        if (w.empty() || (w.size() == 1 && (w[0] == "START" || w[0] == "start"))) return drive_.power.start_mode(a, code::start_auto, t);
        return jobs_.refuse(a, Reason::not_supported,
                            fmt::format("program {}: the serial port starts the program that the control has defined as its START program; "
                                        "define it there and leave the argument empty",
                                        arg),
                            t);
    }
    if (n == "reference") return drive_.homing.start_several(a, arg, t);
    if (n == "traverse_until_input") return start_until_input(a, arg, t);
    if (n == "manual_move") return start_manual(a, arg, t);
    if (n == "measure") {
        if (arg == "on" || arg == "off") return start_code(a, *command_info(arg == "on" ? code::measuring_on : code::measuring_off), "", t);
        return jobs_.refuse(a, Reason::out_of_range, "measure takes on or off", t);
    }
    if (n == "override.speed") return real(code::set_speed, "AE/s");
    if (n == "override.acceleration") return real(code::set_acceleration, "AE/s2");
    if (n == "set_position_g29") return real(code::set_position, "AE");
    if (n == "set_position_g26") {
        const auto v = w.empty() ? std::optional(0.0) : w.size() == 1 ? real_of(w[0]) : std::nullopt;
        if (!v) return jobs_.refuse(a, Reason::out_of_range, "set_position_g26 takes one number in AE, or nothing for 0", t);
        if (*v == 0) return start_code(a, *command_info(code::position_null), "", t);
        return start_code(a, *command_info(code::reference_here), real_text(*v), t);
    }
    if (n == "delete_g29")
        return jobs_.refuse(a, Reason::not_supported,
                            "the serial port has no command that deletes G29 offsets (the Profibus axis interface has bit 12); set the "
                            "position back by set_position_g29",
                            t);
    if (n == "reset_error") return start_code(a, *command_info(code::reset_error), arg, t);
    if (const CommandInfo* c = command_named(n)) return start_code(a, *c, arg, t);
    jobs_.refuse(a, Reason::unknown_point, fmt::format("{} is not an action of a PA-CONTROL: see the catalogue's commands", n), t);
}

/// One command by its code. Argument: nothing, `data`, or `parameter;data`. Without a parameter it is this axis' number.
void Actions::start_code(Axis& a, const CommandInfo& c, std::string_view argument, Turn& t) {
    const auto refused = [&](std::string text) { jobs_.refuse(a, Reason::out_of_range, std::move(text), t); };
    const bool needs_data = c.data != Carries::nothing;
    std::string_view parameter, data = argument;
    if (const auto at = argument.find(';'); at != std::string_view::npos) {
        parameter = argument.substr(0, at);
        data = argument.substr(at + 1);
    } else if (!needs_data) {
        parameter = argument;
        data = {};
    }
    const bool of_axis = c.parameter == Takes::axis || c.parameter == Takes::axis_or_all;
    const auto p = parameter.empty() ? std::optional<std::uint32_t>(of_axis ? a.number() : 0u) : whole_of(parameter);
    if (!p || *p > 0xFFFF || (parameter.empty() && !of_axis && c.parameter != Takes::nothing))
        return refused(fmt::format("{} ({:04X}) needs a parameter 0..65535{}", c.name, c.code,
                                   needs_data ? " before its data, as in 5;1" : " as its argument"));
    if (c.parameter == Takes::axis && *p != a.number()) return refused(fmt::format("{} of axis {}: send it to that axis", c.name, *p));
    if (!needs_data && !data.empty()) return refused(fmt::format("{} ({:04X}) has no data", c.name, c.code));
    const bool real = c.data == Carries::real;
    if (needs_data && !(real ? real_of(data).has_value() : integer_of(data).has_value()))
        return refused(fmt::format("{} ({:04X}) needs {} as data", c.name, c.code, real ? "a number" : "a whole number"));
    a.job.step = one_command;
    jobs_.ask(a, request_for(c.code, *p, needs_data ? std::string(data) : std::string("0")));
}

void Actions::run(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    if (!reply) return start(a, Action(std::get<Action>(j.command.body)), t);
    if (jobs_.ended_by_quit(a, *reply, t)) return;
    const std::uint16_t sent = j.request.code;
    switch (j.step) {
        case condition_set:
            a.condition_set = true;
            j.step = conditional_move;
            return jobs_.ask(a, j.at == 0 ? code::move_absolute : code::move_relative, j.text);
        case conditional_move:
        case manual_move:
            begun(a, j.step == conditional_move, *reply, t);
            if (j.step == manual_move) a.renewal.soon(t.now + renew_period);
            return jobs_.accepted(a, Wait::For::target, 0, "", t);
        default:
            break;
    }
    learn(a, *reply, t);
    feedback_.publish(a, t);
    const CommandInfo* c = command_info(sent);
    const bool answers = c && c->answer != Carries::nothing;
    Value v;
    if (answers && c->answer == Carries::real) {
        v = number_of(*reply).value_or(0);
    } else if (const auto n = answers ? integer_of(reply->data) : std::nullopt) {
        v = *n;
    }
    jobs_.over(a, Outcome::done, Reason::none, answers ? reply->data : std::string(), t, 0, std::move(v));
}

/// The motion that was sent has begun.
void Actions::begun(Axis& a, bool conditional, const Reply& reply, Turn& t) {
    feedback_.learn_position(a, reply, t);
    const Request& r = a.job.request;
    Motion m;
    m.kind = is_by_hand(r.code) ? Motion::Kind::manual : Motion::Kind::position;
    m.target = increments_of(real_of(r.data).value_or(0)) + (is_relative(r.code) ? a.counter : 0);
    m.conditional = conditional;
    feedback_.begin_motion(a, m, t);
}

/// What one command that was acknowledged has changed.
void Actions::learn(Axis& a, const Reply& reply, Turn& t) {
    const std::uint16_t sent = a.job.request.code;
    switch (sent) {
        case code::axis_on:
            a.on = true;
            return;
        case code::axis_off:
            a.on = false;
            return;
        case code::measuring_on:
            a.on = false;
            a.status = 8;
            return drive_.polls.soon(code::status_axis, a);
        case code::measuring_off:
            a.status = -1;  // read anew at once; nothing is refused for what was
            return drive_.polls.soon(code::status_axis, a);
        case code::no_reference:
            a.fb.referenced = true;
            return;
        case code::position_null:
            a.fb.referenced = true;
            feedback_.learn_position(a, 0.0, t);
            return drive_.polls.soon(code::position, a);
        case code::reference_here:
            a.fb.referenced = true;
            if (reply.real && number_of(reply)) feedback_.learn_position(a, reply, t);
            return drive_.polls.soon(code::position, a);
        case code::set_position:
            return drive_.polls.soon(code::position, a);
        case code::condition:
            a.condition_set = true;
            return;
        case code::position:
        case code::abort_move:
        case code::stop_axis:
            return feedback_.learn_position(a, reply, t);
        case code::move_absolute:
        case code::move_relative:
        case code::manual_absolute:
        case code::manual_relative:
            return begun(a, a.condition_set, reply, t);
        default:
            return;
    }
}

/// "I5=1 to 200.0": moves as long as the input is not yet so; also O (outputs) and M (flags).
void Actions::start_until_input(Axis& a, std::string_view argument, Turn& t) {
    const auto w = words_of(argument);
    const auto way = w.size() == 3 ? way_of(w[1], w[2]) : std::nullopt;
    const auto equals = w.empty() ? std::string_view::npos : w[0].find('=');
    std::optional<std::uint32_t> n;
    std::uint32_t type = 0;
    if (way && equals != std::string_view::npos && equals > 1) {
        type = w[0][0] == 'I' ? 1u : w[0][0] == 'O' ? 2u : w[0][0] == 'M' ? 3u : 0u;
        n = whole_of(w[0].substr(1, equals - 1));
    }
    const std::string_view level = equals == std::string_view::npos ? std::string_view() : w[0].substr(equals + 1);
    if (!way || type == 0 || !n || *n < 1 || *n > 1024 || (level != "0" && level != "1"))
        return jobs_.refuse(a, Reason::out_of_range,
                            "traverse_until_input takes an input, output or flag with its level and a way: I5=1 to 200.0, M7=0 by -10", t);
    if (jobs_.ended_by_state(a, t)) return;
    // 0AA3 says while what the axis moves [L3861-L3868]: the opposite of until.
    const std::uint32_t while_level = level == "1" ? 0u : 1u;
    a.job.step = condition_set;
    a.job.at = way->relative ? 1 : 0;
    a.job.text = way->text;
    jobs_.ask(a, code::condition, std::to_string(while_level << 24 | type << 16 | *n));
}

/// "to 200.0" or "by -10": a move at manual speed that the gateway keeps alive by 0A92; it ends within a second if the gateway falls
/// silent.
void Actions::start_manual(Axis& a, std::string_view argument, Turn& t) {
    const auto w = words_of(argument);
    const auto way = w.size() == 2 ? way_of(w[0], w[1]) : std::nullopt;
    if (!way) return jobs_.refuse(a, Reason::out_of_range, "manual_move takes a way: to 200.0, by -10", t);
    if (jobs_.ended_by_state(a, t)) return;
    a.job.step = manual_move;
    jobs_.ask(a, way->relative ? code::manual_relative : code::manual_absolute, way->text);
}

}  // namespace axisgate::pacontrol
