// Drive, part actions: the functions of this family beyond the common ones, by the catalogue's names, and every command code by its own.
// In: Action with its argument. Out: jobs of the other parts, or one command.
// Never guesses an argument: what cannot be read is refused with an example.
#include <fmt/core.h>

#include <algorithm>
#include <charconv>

#include "adapters/pacontrol/drive.hpp"
#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {
namespace {
std::vector<std::string_view> words(std::string_view s) {
    std::vector<std::string_view> w;
    while (true) {
        const auto at = s.find_first_not_of(" ,\t");
        if (at == std::string_view::npos) return w;
        s.remove_prefix(at);
        const auto end = std::min(s.size(), s.find_first_of(" ,\t"));
        w.push_back(s.substr(0, end));
        s.remove_prefix(end);
    }
}

std::optional<std::uint32_t> whole(std::string_view s) {
    int base = 10;
    if (s.starts_with("0x") || s.starts_with("0X")) {
        base = 16;
        s.remove_prefix(2);
    }
    std::uint32_t v = 0;
    const auto [p, ec] = std::from_chars(s.data(), s.data() + s.size(), v, base);
    if (s.empty() || ec != std::errc{} || p != s.data() + s.size()) return std::nullopt;
    return v;
}

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
}  // namespace

void Drive::start_action(Axis& a, const Action& action, Turn& t) {
    const std::string& n = action.name;
    const std::string_view arg = action.argument;
    const auto bare = [&](std::uint16_t what) {
        if (!words(arg).empty()) return refuse(a, Reason::out_of_range, fmt::format("{} takes no argument", n), t);
        start_mode(a, what, t);
    };
    const auto real = [&](std::uint16_t what, std::string_view unit) {
        const auto w = words(arg);
        const auto v = w.size() == 1 ? real_of(w[0]) : std::nullopt;
        if (!v) return refuse(a, Reason::out_of_range, fmt::format("{} takes one number in {}, as in 12.5", n, unit), t);
        start_single(a, *command_info(what), real_text(*v), t);
    };
    if (n == "online.start") return bare(code::start_online);
    if (n == "online.stop" || n == "automatic.stop") return bare(code::stop);
    if (n == "online.give_back") return bare(code::abort_online);
    if (n == "automatic.cancel") return bare(code::abort_auto);
    if (n == "automatic.start") {
        const auto w = words(arg);
        if (!w.empty() && !(w.size() == 1 && (w[0] == "START" || w[0] == "start"))) {
            return refuse(a, Reason::not_supported,
                          fmt::format("program {}: the serial port starts the program that the control has defined as its START program; "
                                      "define it there and leave the argument empty",
                                      arg),
                          t);
        }
        return start_mode(a, code::start_auto, t);
    }
    if (n == "reference") return start_reference(a, arg, t);
    if (n == "traverse_until_input") return start_until_input(a, arg, t);
    if (n == "manual_move") return start_manual(a, arg, t);
    if (n == "measure") {
        if (arg == "on" || arg == "off")
            return start_single(a, *command_info(arg == "on" ? code::measuring_on : code::measuring_off), "", t);
        return refuse(a, Reason::out_of_range, "measure takes on or off", t);
    }
    if (n == "override.speed") return real(code::set_speed, "AE/s");
    if (n == "override.acceleration") return real(code::set_acceleration, "AE/s2");
    if (n == "set_position_g29") return real(code::set_position, "AE");
    if (n == "set_position_g26") {
        const auto w = words(arg);
        const auto v = w.empty() ? std::optional(0.0) : w.size() == 1 ? real_of(w[0]) : std::nullopt;
        if (!v) return refuse(a, Reason::out_of_range, "set_position_g26 takes one number in AE, or nothing for 0", t);
        if (*v == 0) return start_single(a, *command_info(code::position_null), "", t);
        return start_single(a, *command_info(code::reference_here), real_text(*v), t);
    }
    if (n == "delete_g29") {
        return refuse(a, Reason::not_supported,
                      "the serial port has no command that deletes G29 offsets (the Profibus axis interface has bit 12); set the position "
                      "back by set_position_g29",
                      t);
    }
    if (n == "reset_error") return start_single(a, *command_info(code::reset_error), arg, t);
    if (const CommandInfo* c = command_named(n)) return start_single(a, *c, arg, t);
    refuse(a, Reason::unknown_point, fmt::format("{} is not an action of a PA-CONTROL: see the catalogue's commands", n), t);
}

/// One command by its name. Argument: nothing, `data`, or `parameter;data`. Without a parameter it is this axis' number.
void Drive::start_single(Axis& a, const CommandInfo& c, std::string_view argument, Turn& t) {
    Job& j = a.job;
    std::string_view parameter, data = argument;
    if (const auto at = argument.find(';'); at != std::string_view::npos) {
        parameter = argument.substr(0, at);
        data = argument.substr(at + 1);
    } else if (c.data == Carries::nothing) {
        parameter = argument;
        data = {};
    }
    const bool of_axis = c.parameter == Takes::axis || c.parameter == Takes::axis_or_all;
    const auto p =
        parameter.empty() ? std::optional<std::uint32_t>(of_axis ? static_cast<std::uint32_t>(a.channel) : 0u) : whole(parameter);
    if (!p || *p > 0xFFFF || (parameter.empty() && !of_axis && c.parameter != Takes::nothing)) {
        return refuse(
            a, Reason::out_of_range,
            fmt::format("{} ({:04X}) needs a parameter 0..65535{}", c.name, c.code,
                        c.data == Carries::nothing ? std::string(" as its argument") : std::string(" before its data, as in 5;1")),
            t);
    }
    if (c.parameter == Takes::axis && *p != static_cast<std::uint32_t>(a.channel)) {
        return refuse(a, Reason::out_of_range, fmt::format("{} of axis {}: send it to that axis", c.name, *p), t);
    }
    const bool needs_data = c.data != Carries::nothing;
    if (needs_data ? !(c.data == Carries::real ? real_of(data).has_value() : integer_of(data).has_value()) : !data.empty()) {
        return refuse(a, Reason::out_of_range,
                      needs_data ? fmt::format("{} ({:04X}) needs {} as data", c.name, c.code,
                                               c.data == Carries::real ? "a number" : "a whole number")
                                 : fmt::format("{} ({:04X}) has no data", c.name, c.code),
                      t);
    }
    j.kind = Job::Kind::single;
    j.step = 1;
    ask(a, {c.code, *p, c.data == Carries::real || (c.data == Carries::nothing && c.answer == Carries::real),
            needs_data ? std::string(data) : std::string("0")});
}

/// Steps: 1 the command itself; 10 a condition, then a start; 20 a manual move; 30 one reference run after the other, 31 its position.
void Drive::run_single(Axis& a, const Reply* reply, Turn& t) {
    Job& j = a.job;
    const auto ch = static_cast<std::uint32_t>(a.channel);
    if (!reply) return;  // asked already
    const std::uint16_t sent = j.request.code;
    if (j.step == 30) {
        Axis& x = axes_[j.places[j.at]];
        x.running = false;
        const std::string cause = what_ended(x);
        const bool good = reply->quit == 0 && cause.empty();
        const Reason reason = in_trouble() || cause.empty() ? Reason::drive_refused : Reason::interrupted;
        if (x.motion.kind != Motion::Kind::reference && good) begin_motion(x, {Motion::Kind::reference, 0, false, false, exchanges_}, t);
        x.running = false;
        const std::string said = reply->quit == 0 ? std::string() : fmt::format("{}: {}", describe(j.request), describe_quit(reply->quit));
        end_motion(x, good, reason, cause.empty() ? said : cause, t);
        if (!good) {
            const bool nothing = reply->quit != 0 && !j.begun;
            counters_.refused += reply->quit != 0;
            return job_over(
                a, nothing ? Outcome::refused : Outcome::failed, reason,
                fmt::format("axis {} did not come to its reference: {}{}{}; axes before it in the order are referenced, {} of {}",
                            x.channel, cause, cause.empty() || said.empty() ? "" : "; ", said, j.at, j.places.size()),
                t, error_ != 0 ? error_ : reply->quit);
        }
        j.step = 31;  // the position has a new zero: known before anybody hears of the end
        return ask(a, code::position, static_cast<std::uint32_t>(x.channel), t);
    }
    if (j.step == 31) {
        if (reply->quit == 0) learn_position(axes_[j.places[j.at]], number_of(*reply).value_or(0), t);
        j.step = 30;
        if (++j.at < j.places.size()) return ask(a, code::reference, static_cast<std::uint32_t>(j.places[j.at]) + 1, t);
        return job_over(a, Outcome::done, Reason::none, fmt::format("{} axes referenced", j.places.size()), t);
    }
    if (ended_by_quit(a, *reply, t)) return;
    if (j.step == 10) {
        a.condition_set = true;
        j.step = 11;
        return ask(a, {j.at == 0 ? code::move_absolute : code::move_relative, ch, true, j.text});
    }
    if (j.step == 11 || j.step == 20) {
        learn_position(a, number_of(*reply).value_or(0), t);
        Motion m;
        m.kind = j.step == 20 ? Motion::Kind::manual : Motion::Kind::position;
        m.target = increments_of(real_of(j.text).value_or(0)) + (j.at == 1 ? a.counter : 0);
        m.conditional = j.step == 11;
        begin_motion(a, m, t);
        if (j.step == 20) a.renew_at = t.now + std::chrono::milliseconds(400);
        const Command c = j.command;
        a.job = Job{};
        return accepted(a, c, Wait::For::target, 0, "", t);
    }
    switch (sent) {
        case code::axis_on:
            a.on = true;
            break;
        case code::axis_off:
            a.on = false;
            break;
        case code::measuring_on:
            a.on = false;
            a.status = 8;
            poll_soon(PollKind::status, a);
            break;
        case code::measuring_off:
            a.status = -1;  // read anew at once; nothing is refused for what was
            poll_soon(PollKind::status, a);
            break;
        case code::no_reference:
        case code::position_null:
        case code::reference_here:
            a.fb.referenced = a.referenced_own = true;
            if (sent == code::position_null) learn_position(a, 0, t);
            if (sent == code::reference_here && reply->real && number_of(*reply)) learn_position(a, *number_of(*reply), t);
            break;
        case code::condition:
            a.condition_set = true;
            break;
        case code::position:
        case code::abort_move:
        case code::stop_axis:
            learn_position(a, number_of(*reply).value_or(0), t);
            break;
        case code::move_absolute:
        case code::move_relative:
        case code::manual_absolute:
        case code::manual_relative: {
            learn_position(a, number_of(*reply).value_or(0), t);
            const bool by = sent == code::move_relative || sent == code::manual_relative;
            const bool by_hand = sent == code::manual_absolute || sent == code::manual_relative;
            begin_motion(a,
                         {by_hand ? Motion::Kind::manual : Motion::Kind::position,
                          increments_of(real_of(j.request.data).value_or(0)) + (by ? a.counter : 0), a.condition_set, false, exchanges_},
                         t);
            break;
        }
        default:
            break;
    }
    if (sent == code::set_position || sent == code::position_null || sent == code::reference_here) poll_soon(PollKind::position, a);
    emit(a, t);
    const CommandInfo* c = command_info(sent);
    Value v;
    if (c && c->answer != Carries::nothing) {
        if (c->answer == Carries::real) {
            v = number_of(*reply).value_or(0);
        } else if (const auto n = integer_of(reply->data)) {
            v = *n;
        }
    }
    job_over(a, Outcome::done, Reason::none, c && c->answer != Carries::nothing ? reply->data : std::string(), t, 0, std::move(v));
}

/// "all", channels with commas ("1,3"), or a mask ("0x5"). The runs follow one another: each bars the line until its end.
void Drive::start_reference(Axis& a, std::string_view argument, Turn& t) {
    Job& j = a.job;
    if (std::string why = why_not_movable(a); !why.empty()) return refuse(a, Reason::wrong_state, std::move(why), t);
    std::uint32_t mask = 0;
    const auto w = words(argument);
    if (w.empty()) {
        mask = 1u << (a.channel - 1);
    } else if (w.size() == 1 && w[0] == "all") {
        for (const Axis& x : axes_)
            mask |= x.id != no_axis && !x.missing ? 1u << (x.channel - 1) : 0u;
    } else if (w.size() == 1 && w[0].starts_with("0x")) {
        mask = whole(w[0]).value_or(0);
    } else {
        for (const auto& one : w) {
            const auto n = whole(one);
            mask = n && *n >= 1 && *n <= 16 ? mask | 1u << (*n - 1) : 0x10000u;
            if (mask & 0x10000u) break;
        }
    }
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        if ((mask >> i & 1u) && axes_[i].id == no_axis) mask |= 0x10000u;
    }
    if (mask == 0 || mask > 0xFFFF) {
        return refuse(a, Reason::out_of_range, "reference takes all, channels of the site's axes as in 1,3, or a mask as in 0x5", t);
    }
    for (const int channel : options_.reference_order) {
        if (mask >> (channel - 1) & 1u) j.places.push_back(static_cast<std::size_t>(channel) - 1);
        mask &= ~(1u << (channel - 1));
    }
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        if (mask >> i & 1u) j.places.push_back(i);
    }
    j.kind = Job::Kind::single;
    j.step = 30;
    ask(a, code::reference, static_cast<std::uint32_t>(j.places[0]) + 1, t);
}

/// "I5=1 to 200.0": moves as long as the input is not yet so; also O (outputs) and M (flags).
void Drive::start_until_input(Axis& a, std::string_view argument, Turn& t) {
    Job& j = a.job;
    const auto w = words(argument);
    const auto way = w.size() == 3 ? way_of(w[1], w[2]) : std::nullopt;
    const auto equals = w.empty() ? std::string_view::npos : w[0].find('=');
    std::optional<std::uint32_t> n;
    std::uint32_t type = 0;
    if (way && equals != std::string_view::npos && equals > 1) {
        type = w[0][0] == 'I' ? 1u : w[0][0] == 'O' ? 2u : w[0][0] == 'M' ? 3u : 0u;
        n = whole(w[0].substr(1, equals - 1));
    }
    const std::string_view level = equals == std::string_view::npos ? std::string_view() : w[0].substr(equals + 1);
    if (!way || type == 0 || !n || *n < 1 || *n > 1024 || (level != "0" && level != "1")) {
        return refuse(a, Reason::out_of_range,
                      "traverse_until_input takes an input, output or flag with its level and a way: I5=1 to 200.0, M7=0 by -10", t);
    }
    if (std::string why = why_not_movable(a); !why.empty()) return refuse(a, Reason::wrong_state, std::move(why), t);
    // 0AA3 says while what the axis moves [L3861-L3868]: the opposite of until.
    const std::uint32_t while_level = level == "1" ? 0u : 1u;
    j.kind = Job::Kind::single;
    j.step = 10;
    j.at = way->relative ? 1 : 0;
    j.text = way->text;
    ask(a, {code::condition, static_cast<std::uint32_t>(a.channel), false, std::to_string(while_level << 24 | type << 16 | *n)});
}

/// "to 200.0" or "by -10": a move at manual speed that the gateway keeps alive by 0A92; it ends within a second if the gateway falls
/// silent.
void Drive::start_manual(Axis& a, std::string_view argument, Turn& t) {
    Job& j = a.job;
    const auto w = words(argument);
    const auto way = w.size() == 2 ? way_of(w[0], w[1]) : std::nullopt;
    if (!way) return refuse(a, Reason::out_of_range, "manual_move takes a way: to 200.0, by -10", t);
    if (std::string why = why_not_movable(a); !why.empty()) return refuse(a, Reason::wrong_state, std::move(why), t);
    j.kind = Job::Kind::single;
    j.step = 20;
    j.at = way->relative ? 1 : 0;
    j.text = way->text;
    ask(a, {way->relative ? code::manual_relative : code::manual_absolute, static_cast<std::uint32_t>(a.channel), true, way->text});
}

}  // namespace axisgate::pacontrol
