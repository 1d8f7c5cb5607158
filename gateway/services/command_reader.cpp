// Command reader: one table of the commands with the members that each may have; whole increments stay exact below 2^53.
// In: JSON. Out: a CommandBody or all faults. Never takes a member that the command has no use for.
#include "gateway/services/command_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "gateway/core/text.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;

/// Whole increments stay exact as a double, as JSON number and as int64 below this.
constexpr double largest_increments = 9007199254740992.0;  // 2^53

struct Shape {
    std::string_view command;
    std::array<std::string_view, 6> fields;  ///< beside "command"; empty ones are none
};
constexpr std::array shapes{Shape{"enable", {}},
                            Shape{"disable", {}},
                            Shape{"quick_stop", {}},
                            Shape{"halt", {}},
                            Shape{"reset_fault", {}},
                            Shape{"home", {"method"}},
                            Shape{"set_position", {"position"}},
                            Shape{"move_absolute", {"position", "velocity", "acceleration", "deceleration", "prepare"}},
                            Shape{"move_relative", {"position", "velocity", "acceleration", "deceleration", "prepare"}},
                            Shape{"move_velocity", {"velocity", "acceleration", "deceleration", "prepare", "hold_ms", "renew"}}};

class Reader {
public:
    Reader(const json::object& body, double scale, std::string_view unit, ReadCommand& out)
        : body_(body), scale_(scale), unit_(unit), out_(out) {}

    void malformed(std::string_view key, std::string text, std::string remedy) {
        out_.faults.push_back({"/" + std::string(key), std::move(text), std::move(remedy)});
        malformed_ = true;
    }
    void out_of_range(std::string_view key, std::string text, std::string remedy) {
        out_.faults.push_back({"/" + std::string(key), std::move(text), std::move(remedy)});
    }

    /// The value of a member in whole increments (`per`: "", "/s", "/s^2").
    std::optional<std::int64_t> increments(std::string_view key, bool required, bool positive, std::string_view per) {
        const auto* v = body_.if_contains(key);
        if (!v || v->is_null()) {
            if (required) malformed(key, fmt::format("{} needs {}", out_.name, key), fmt::format("add \"{}\", in {}{}", key, unit(), per));
            return std::nullopt;
        }
        if (!v->is_number()) {
            malformed(key, fmt::format("{} must be a number, not {}", key, json_text(*v)), fmt::format("write it in {}{}", unit(), per));
            return std::nullopt;
        }
        const double asked = v->to_number<double>();
        const double exact = asked * scale_;
        if (!std::isfinite(exact) || std::fabs(exact) >= largest_increments) {
            out_of_range(key, fmt::format("{} is too large: {} {}{} are more than 2^53 increments", key, asked, unit(), per),
                         "write a smaller value");
            return std::nullopt;
        }
        const auto n = static_cast<std::int64_t>(std::llround(exact));
        if (positive && !(asked > 0)) {
            out_of_range(key, fmt::format("{} must be above 0, not {}", key, json_text(*v)),
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
    bool flag(std::string_view key) {
        const auto* v = body_.if_contains(key);
        if (!v || v->is_null()) return false;
        if (v->is_bool()) return v->get_bool();
        malformed(key, fmt::format("{} must be true or false", key), fmt::format("write \"{}\": true", key));
        return false;
    }
    std::int16_t method() {
        const auto* v = body_.if_contains("method");
        if (!v || v->is_null()) return 0;
        const double d = v->is_number() ? v->to_number<double>() : 0.5;
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
    /// Milliseconds after which the axis is halted unless the same comes again.
    std::optional<std::int64_t> hold(std::string_view key, std::int64_t least) {
        const auto* v = body_.if_contains(key);
        if (!v || v->is_null()) return std::nullopt;
        const double d = v->is_number() ? v->to_number<double>() : 0.5;
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
    Move move(Move::Kind kind) {
        Move m;
        m.kind = kind;
        if (kind == Move::Kind::velocity) {
            m.target = increments("velocity", true, false, "/s").value_or(0);
        } else {
            m.target = increments("position", true, false, "").value_or(0);
            m.velocity = increments("velocity", false, true, "/s");
        }
        m.acceleration = increments("acceleration", false, true, "/s^2");
        m.deceleration = increments("deceleration", false, true, "/s^2");
        m.prepare_only = flag("prepare");
        if (kind == Move::Kind::velocity) {
            m.hold_ms = hold("hold_ms", 100);
            m.renew_only = flag("renew");
            if (m.renew_only && !m.hold_ms) malformed("renew", "renew needs hold_ms", "add \"hold_ms\", the time until the next renewal");
        }
        return m;
    }
    [[nodiscard]] bool is_malformed() const noexcept { return malformed_; }

private:
    [[nodiscard]] std::string_view unit() const { return unit_.empty() ? std::string_view("increments") : unit_; }

    const json::object& body_;
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
}  // namespace

ReadSetPoint read_set_point(const json::object& body, double increments_per_unit, std::string_view unit) {
    static constexpr std::array<std::string_view, 7> known{"axis",         "mode",         "value",      "velocity",
                                                           "acceleration", "deceleration", "good_for_ms"};
    ReadCommand read_into;
    read_into.name = "a set-point";
    const auto* word = body.if_contains("mode");
    const auto mode = word && word->is_string() ? set_point_mode_of(std::string_view(word->get_string())) : std::nullopt;
    const bool torque = mode == SetPoint::Mode::torque;
    Reader read(body, torque ? 1 : increments_per_unit, torque ? "1/1000 of the rated torque" : unit, read_into);
    for (const auto& [k, v] : body) {
        if (std::ranges::find(known, std::string_view(k)) == known.end())
            read.malformed(k, fmt::format("a set-point does not know {}", std::string_view(k)),
                           fmt::format("remove it; a set-point takes {}", fmt::join(known, ", ")));
    }
    SetPoint p;
    if (!mode) read.malformed("mode", "mode must be \"position\", \"velocity\" or \"torque\"", "write what the value is");
    p.mode = mode.value_or(SetPoint::Mode::position);
    p.value = read.increments("value", true, false, p.mode == SetPoint::Mode::velocity ? "/s" : "").value_or(0);
    p.velocity = read.increments("velocity", false, true, "/s");
    p.acceleration = read.increments("acceleration", false, true, "/s^2");
    p.deceleration = read.increments("deceleration", false, true, "/s^2");
    if (const auto ms = read.hold("good_for_ms", milliseconds_of(SetPoint::good_for_min))) p.good_for = std::chrono::milliseconds(*ms);
    ReadSetPoint out;
    out.faults = std::move(read_into.faults);
    if (out.faults.empty()) out.set_point = std::move(p);
    return out;
}

ReadCommand read_command(const json::object& body, double increments_per_unit, std::string_view unit) {
    ReadCommand out;
    Reader read(body, increments_per_unit, unit, out);
    const auto* c = body.if_contains("command");
    if (!c || !c->is_string()) {
        read.malformed("command", c ? "command must be a text" : "command is missing", "write one of: " + known_commands());
        return out;
    }
    out.name = std::string(c->get_string());
    const auto shape = std::ranges::find(shapes, out.name, &Shape::command);
    if (shape == shapes.end()) {
        read.malformed("command", fmt::format("there is no command {}", out.name), "write one of: " + known_commands());
        return out;
    }
    for (const auto& [k, v] : body) {
        const std::string_view key = k;
        if (key == "command" || (!key.empty() && std::ranges::find(shape->fields, key) != shape->fields.end())) continue;
        std::string list;
        for (const auto f : shape->fields) {
            if (!f.empty()) list += (list.empty() ? "" : ", ") + std::string(f);
        }
        read.malformed(key, fmt::format("{} does not know {}", out.name, key),
                       list.empty() ? fmt::format("remove it: {} takes nothing else", out.name)
                                    : fmt::format("remove it; {} takes {}", out.name, list));
    }

    CommandBody command;
    if (out.name == "enable") command = Enable{};
    if (out.name == "disable") command = Disable{};
    if (out.name == "quick_stop") command = QuickStop{};
    if (out.name == "halt") command = Halt{};
    if (out.name == "reset_fault") command = ResetFault{};
    if (out.name == "home") command = Home{read.method()};
    if (out.name == "set_position") command = SetPosition{read.increments("position", true, false, "").value_or(0)};
    if (out.name == "move_absolute") command = read.move(Move::Kind::absolute);
    if (out.name == "move_relative") command = read.move(Move::Kind::relative);
    if (out.name == "move_velocity") command = read.move(Move::Kind::velocity);
    out.range_only = !out.faults.empty() && !read.is_malformed();
    if (out.faults.empty()) out.body = std::move(command);
    return out;
}

}  // namespace axisgate
