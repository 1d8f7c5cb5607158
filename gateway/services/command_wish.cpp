// Makes commands of wishes by one table of the commands with their members. Whole increments are exact below 2^53.
#include "gateway/services/command_wish.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace axisgate {
namespace {
/// Below this value whole increments are exact as a double, as a JSON number and as int64.
constexpr double largest_increments = 9007199254740992.0;  // 2^53

struct Shape {
    CommandWord word;
    std::string_view command;
    std::array<std::string_view, 6> fields;  ///< in addition to "command"; empty entries are unused
};
constexpr std::array shapes{
    Shape{CommandWord::enable, "enable", {}},
    Shape{CommandWord::disable, "disable", {}},
    Shape{CommandWord::quick_stop, "quick_stop", {}},
    Shape{CommandWord::halt, "halt", {}},
    Shape{CommandWord::reset_fault, "reset_fault", {}},
    Shape{CommandWord::home, "home", {"method"}},
    Shape{CommandWord::set_position, "set_position", {"position"}},
    Shape{CommandWord::move_absolute, "move_absolute", {"position", "velocity", "acceleration", "deceleration", "prepare"}},
    Shape{CommandWord::move_relative, "move_relative", {"position", "velocity", "acceleration", "deceleration", "prepare"}},
    Shape{CommandWord::move_velocity, "move_velocity", {"velocity", "acceleration", "deceleration", "prepare", "hold_ms", "renew"}}};
constexpr std::array<std::string_view, 7> set_point_members{"axis",         "mode",         "value",      "velocity",
                                                            "acceleration", "deceleration", "good_for_ms"};

const Shape* shape_of(CommandWord word) noexcept {
    const auto shape = std::ranges::find(shapes, word, &Shape::word);
    return shape == shapes.end() ? nullptr : &*shape;
}

bool given(const WishedNumber& n) noexcept { return n.index() != 0; }
/// A value that is not a number is not a whole number either.
double number_in(const WishedNumber& n) noexcept {
    const auto* d = std::get_if<double>(&n);
    return d ? *d : std::nan("");
}
/// As people write it: -0 is 0.
std::string number_text(double d) { return fmt::format("{}", d + 0.0); }

class Maker {
public:
    Maker(double scale, std::string_view unit, ReadCommand& out) : scale_(scale), unit_(unit), out_(out) {}

    void malformed(std::string_view key, std::string text, std::string remedy) {
        out_.faults.push_back({"/" + std::string(key), std::move(text), std::move(remedy)});
        malformed_ = true;
    }
    void out_of_range(std::string_view key, std::string text, std::string remedy) {
        out_.faults.push_back({"/" + std::string(key), std::move(text), std::move(remedy)});
    }

    /// The value of a member in whole increments (`per`: "", "/s", "/s^2").
    std::optional<std::int64_t> increments(std::string_view key, const WishedNumber& wished, bool required, bool positive,
                                           std::string_view per) {
        if (!given(wished)) {
            if (required) malformed(key, fmt::format("{} needs {}", out_.name, key), fmt::format("add \"{}\", in {}{}", key, unit(), per));
            return std::nullopt;
        }
        if (const auto* none = std::get_if<NoNumber>(&wished)) {
            malformed(key, fmt::format("{} must be a number, not {}", key, none->written), fmt::format("write it in {}{}", unit(), per));
            return std::nullopt;
        }
        const double asked = std::get<double>(wished);
        const double exact = asked * scale_;
        if (!std::isfinite(exact) || std::fabs(exact) >= largest_increments) {
            out_of_range(key, fmt::format("{} is too large: {} {}{} are more than 2^53 increments", key, asked, unit(), per),
                         "write a smaller value");
            return std::nullopt;
        }
        const auto n = static_cast<std::int64_t>(std::llround(exact));
        if (positive && !(asked > 0)) {
            out_of_range(key, fmt::format("{} must be above 0, not {}", key, number_text(asked)),
                         key == "velocity" ? "the direction follows from the position" : "write a positive value");
            return std::nullopt;
        }
        if (positive && n == 0) {
            out_of_range(key, fmt::format("{} {} {}{} is less than 1 increment{}", key, asked, unit(), per, per),
                         fmt::format("write at least {}", 1.0 / scale_));
            return std::nullopt;
        }
        return n;
    }
    bool flag(std::string_view key, WishedFlag wished) {
        if (wished == WishedFlag::no_flag)
            malformed(key, fmt::format("{} must be true or false", key), fmt::format("write \"{}\": true", key));
        return wished == WishedFlag::yes;
    }
    std::int16_t method(const WishedNumber& wished) {
        if (!given(wished)) return 0;
        const double d = number_in(wished);
        if (std::nearbyint(d) != d) {
            malformed("method", "method must be a whole number", "write a CiA 402 homing method, or 0 for the drive's own");
            return 0;
        }
        if (d < -32768 || d > 32767) {
            out_of_range("method", "method is outside -32768..32767", "write a CiA 402 homing method, or 0 for the drive's own");
            return 0;
        }
        return static_cast<std::int16_t>(d);
    }
    /// Milliseconds after which the axis is halted unless the same command is repeated.
    std::optional<std::int64_t> hold(std::string_view key, const WishedNumber& wished, std::int64_t least) {
        if (!given(wished)) return std::nullopt;
        const double d = number_in(wished);
        if (std::nearbyint(d) != d) {
            malformed(key, fmt::format("{} must be a whole number", key),
                      fmt::format("write milliseconds, {} to 10000, or leave it out", least));
            return std::nullopt;
        }
        if (d < static_cast<double>(least) || d > 10'000) {
            out_of_range(key, fmt::format("{} is outside {}..10000", key, least),
                         "write milliseconds after which the axis is halted unless the command comes again");
            return std::nullopt;
        }
        return static_cast<std::int64_t>(d);
    }
    Move move(Move::Kind kind, const CommandWish& wish) {
        Move m;
        m.kind = kind;
        if (kind == Move::Kind::velocity) {
            m.target = increments("velocity", wish.velocity, true, false, "/s").value_or(0);
        } else {
            m.target = increments("position", wish.position, true, false, "").value_or(0);
            m.velocity = increments("velocity", wish.velocity, false, true, "/s");
        }
        m.acceleration = increments("acceleration", wish.acceleration, false, true, "/s^2");
        m.deceleration = increments("deceleration", wish.deceleration, false, true, "/s^2");
        m.prepare_only = flag("prepare", wish.prepare);
        if (kind == Move::Kind::velocity) {
            m.hold_ms = hold("hold_ms", wish.hold_ms, 100);
            m.renew_only = flag("renew", wish.renew);
            if (m.renew_only && !m.hold_ms) malformed("renew", "renew needs hold_ms", "add \"hold_ms\", the time until the next renewal");
        }
        return m;
    }
    [[nodiscard]] bool is_malformed() const noexcept { return malformed_; }

private:
    [[nodiscard]] std::string_view unit() const { return unit_.empty() ? std::string_view("increments") : unit_; }

    double scale_;
    std::string_view unit_;
    ReadCommand& out_;
    bool malformed_ = false;
};

std::string known_commands() {
    std::string s;
    for (const auto& shape : shapes)
        s += (s.empty() ? "" : ", ") + std::string(shape.command);
    return s;
}

/// Refuses members that the command does not have: unknown ones, and known ones of other commands.
void refuse_others(Maker& make, const CommandWish& wish, const Shape& shape) {
    const auto refuse = [&](std::string_view key) {
        std::string list;
        for (const auto f : shape.fields) {
            if (!f.empty()) list += (list.empty() ? "" : ", ") + std::string(f);
        }
        make.malformed(key, fmt::format("{} does not know {}", wish.name, key),
                       list.empty() ? fmt::format("remove it: {} takes nothing else", wish.name)
                                    : fmt::format("remove it; {} takes {}", wish.name, list));
    };
    for (const auto& key : wish.unknown)
        refuse(key);
    const std::array<std::pair<std::string_view, bool>, 8> members{{{"position", given(wish.position)},
                                                                    {"velocity", given(wish.velocity)},
                                                                    {"acceleration", given(wish.acceleration)},
                                                                    {"deceleration", given(wish.deceleration)},
                                                                    {"method", given(wish.method)},
                                                                    {"hold_ms", given(wish.hold_ms)},
                                                                    {"prepare", wish.prepare != WishedFlag::no},
                                                                    {"renew", wish.renew != WishedFlag::no}}};
    for (const auto& [key, is_given] : members) {
        if (is_given && !takes(wish.word, key)) refuse(key);
    }
}

CommandBody body_of(Maker& make, const CommandWish& wish) {
    switch (wish.word) {
        case CommandWord::disable:
            return Disable{};
        case CommandWord::quick_stop:
            return QuickStop{};
        case CommandWord::halt:
            return Halt{};
        case CommandWord::reset_fault:
            return ResetFault{};
        case CommandWord::home:
            return Home{make.method(wish.method)};
        case CommandWord::set_position:
            return SetPosition{make.increments("position", wish.position, true, false, "").value_or(0)};
        case CommandWord::move_absolute:
            return make.move(Move::Kind::absolute, wish);
        case CommandWord::move_relative:
            return make.move(Move::Kind::relative, wish);
        case CommandWord::move_velocity:
            return make.move(Move::Kind::velocity, wish);
        default:
            return Enable{};
    }
}
}  // namespace

CommandWord command_word_named(std::string_view name) noexcept {
    const auto shape = std::ranges::find(shapes, name, &Shape::command);
    return shape == shapes.end() ? CommandWord::unknown : shape->word;
}

bool takes(CommandWord word, std::string_view member) noexcept {
    const Shape* shape = shape_of(word);
    return shape && !member.empty() && std::ranges::find(shape->fields, member) != shape->fields.end();
}

bool is_set_point_member(std::string_view member) noexcept {
    return std::ranges::find(set_point_members, member) != set_point_members.end();
}

ReadCommand make_command(const CommandWish& wish, double increments_per_unit, std::string_view unit) {
    ReadCommand out;
    Maker make(increments_per_unit, unit, out);
    out.name = wish.name;
    const Shape* shape = shape_of(wish.word);
    if (!shape) {
        make.malformed("command",
                       wish.word == CommandWord::missing   ? "command is missing"
                       : wish.word == CommandWord::no_text ? "command must be a text"
                                                           : fmt::format("there is no command {}", wish.name),
                       "write one of: " + known_commands());
        return out;
    }
    refuse_others(make, wish, *shape);
    CommandBody command = body_of(make, wish);
    out.range_only = !out.faults.empty() && !make.is_malformed();
    if (out.faults.empty()) out.body = std::move(command);
    return out;
}

ReadSetPoint make_set_point(const SetPointWish& wish, double increments_per_unit, std::string_view unit) {
    ReadCommand made;
    made.name = "a set-point";
    const bool torque = wish.mode == SetPoint::Mode::torque;
    Maker make(torque ? 1 : increments_per_unit, torque ? "1/1000 of the rated torque" : unit, made);
    for (const auto& key : wish.unknown)
        make.malformed(key, fmt::format("a set-point does not know {}", key),
                       fmt::format("remove it; a set-point takes {}", fmt::join(set_point_members, ", ")));
    SetPoint p;
    if (!wish.mode) make.malformed("mode", "mode must be \"position\", \"velocity\" or \"torque\"", "write what the value is");
    p.mode = wish.mode.value_or(SetPoint::Mode::position);
    p.value = make.increments("value", wish.value, true, false, p.mode == SetPoint::Mode::velocity ? "/s" : "").value_or(0);
    p.velocity = make.increments("velocity", wish.velocity, false, true, "/s");
    p.acceleration = make.increments("acceleration", wish.acceleration, false, true, "/s^2");
    p.deceleration = make.increments("deceleration", wish.deceleration, false, true, "/s^2");
    if (const auto ms = make.hold("good_for_ms", wish.good_for_ms, milliseconds_of(SetPoint::good_for_min)))
        p.good_for = std::chrono::milliseconds(*ms);
    ReadSetPoint out;
    out.faults = std::move(made.faults);
    if (out.faults.empty()) out.set_point = std::move(p);
    return out;
}

}  // namespace axisgate
