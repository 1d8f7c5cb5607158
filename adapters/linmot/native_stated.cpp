// The effect of a native telegram, an action or a parameter write on the axis: target and rates of VAI commands in increments, rates of
// predefined moves. The state of the drive is not known here. Therefore these are reported as not readable: cams, curves, triggers, command
// tables, 16-bit commands (their unit is a parameter), increments of an unknown target, and a control word that could continue a frozen
// motion.
#include <algorithm>
#include <array>

#include "adapters/linmot/drive_part.hpp"
#include "adapters/linmot/motion_commands.hpp"
#include "adapters/linmot/native.hpp"
#include "adapters/linmot/wire.hpp"
#include "gateway/core/command_arguments.hpp"
#include "gateway/core/text.hpp"

namespace axisgate::linmot {
namespace {
using Kind = Stated::Kind;
constexpr std::int64_t velocity_count = 10, rate_count = 100;  // increments/s of 1e-6 m/s, increments/s^2 of 1e-5 m/s^2

bool in(std::uint16_t header, std::initializer_list<std::uint16_t> list) { return std::ranges::find(list, header) != list.end(); }

Stated of_word(std::uint16_t word) {
    constexpr std::uint16_t runs = 0x002F,
                            moves = 0xB740;  // operation without freeze; go to position, jog, special, clearance, initial, search
    if ((word & 0x0F) != 0x0F) return {Kind::nothing};  // a drive below operation enabled does not move
    if ((word & moves) != 0 || (word & runs) != runs) return {(word & moves) != 0 ? Kind::unread : Kind::nothing};
    return {(word & cw_home) != 0 ? Kind::homing : Kind::unread};
}

Stated of_live(std::uint16_t upid, std::int64_t value) {
    Stated s{Kind::nothing};
    if (value <= 0) return s;
    if (upid == Limits::upids[0]) s.sets.velocity = velocity_count * value;
    if (upid == Limits::upids[1]) s.sets.acceleration = rate_count * value;
    if (upid == Limits::upids[2]) s.sets.deceleration = rate_count * value;
    return s;
}

/// The kind of motion that the arguments of a command describe, by its header.
std::optional<Move::Kind> kind_of(std::uint16_t h) {
    if (in(h, {0x0100, 0x0130, 0x0140, 0x0180, 0x0200, 0x0230, 0x0240, 0x0280, 0x0300, 0x0310, 0x0320, 0x07E0, 0x07F0, 0x0B00, 0x0B30,
               0x0B40, 0x0B80, 0x0C00, 0x0C30, 0x0C40, 0x0C50, 0x0C60, 0x0C70, 0x0C80, 0x3800, 0x3810, 0x3830, 0x3840, 0x3850}))
        return Move::Kind::absolute;
    if (in(h, {0x0110, 0x0150, 0x0160, 0x0210, 0x0B10, 0x0C10})) return Move::Kind::relative;
    if (in(h, {0x0CE0, 0x0CF0})) return Move::Kind::velocity;
    return std::nullopt;
}

/// Stops, waits, changes of the drive's memory and its variables.
bool harmless(std::uint16_t h) {
    const bool memory = h >= 0x0500 && h <= 0x0560, waits = h >= 0x2100 && h <= 0x22F0, variables = h >= 0x2400 && h <= 0x24F0;
    return memory || waits || variables ||
           in(h, {0x0000, 0x0030, 0x0040, 0x0080, 0x0090, 0x0170, 0x0270, 0x03F0, 0x0970, 0x0A70, 0x1010, 0x1040, 0x1170, 0x1270, 0x2080,
                  0x2090, 0x3820});
}

Stated of_motion(const Motion& motion, std::span<const Value> values) {
    const auto& arguments = motion.command->arguments;
    const auto argument = [&](std::string_view name) -> std::optional<std::int64_t> {
        for (std::size_t i = 0; i < arguments.size() && i < values.size(); ++i)
            if (arguments[i].name == name) return as_integer(values[i]);
        return std::nullopt;
    };
    const std::uint16_t h = motion.header;
    if (h == 0x0010) return of_word(static_cast<std::uint16_t>(argument("control_word").value_or(0)));
    if (h == 0x0020) return of_live(static_cast<std::uint16_t>(argument("upid").value_or(0)), argument("value").value_or(0));
    if (harmless(h)) return {Kind::nothing};
    const auto kind = kind_of(h);
    if (!kind) return {Kind::unread};
    Stated s{Kind::motion};
    s.move.kind = *kind;
    const auto rate = [&](std::string_view name, std::int64_t count) -> std::optional<std::int64_t> {
        const auto v = argument(name);
        return v && *v > 0 ? std::optional(*v * count) : std::nullopt;
    };
    const auto velocity = rate("velocity", velocity_count);
    s.move.acceleration = rate("acceleration", rate_count);
    s.move.deceleration = rate("deceleration", rate_count);
    if (h >= 0x0C00 && h <= 0x0CF0) s.move.deceleration = s.move.acceleration;  // "Dec=Acc"
    if (*kind == Move::Kind::velocity) {
        if (!velocity) return {Kind::unread};
        s.move.target = h == 0x0CE0 ? *velocity : -*velocity;
        return s;
    }
    const auto target = argument(*kind == Move::Kind::absolute ? "position" : "increment");
    if (!target) return {Kind::unread};
    s.move.target = *target;
    s.move.velocity = velocity;
    return s;
}

Stated of_bytes(const Catalogue& catalogue, std::span<const std::uint8_t> b) {
    const Motions motions(catalogue);
    const Motion* motion = b.size() >= 2 ? motions.of_header(static_cast<std::uint16_t>(b[0] | b[1] << 8)) : nullptr;
    if (!motion) return {Kind::unread};
    if (motion->header == 0x0020 && b.size() >= 6) {  // the size of its value is that of the parameter
        std::int64_t value = 0;
        for (std::size_t i = 4; i < b.size() && i < 8; ++i)
            value |= std::int64_t{b[i]} << 8 * (i - 4);
        return of_live(static_cast<std::uint16_t>(b[2] | b[3] << 8), value);
    }
    const auto values = Motions::unpack(*motion, b);
    return values ? of_motion(*motion, *values) : Stated{Kind::unread};
}

Stated of_native(const Catalogue& catalogue, const Native& native) {
    const auto bytes = native.is_text ? native_bytes(native.send) : std::optional(native.send);
    if (!bytes || bytes->size() < 2) return {Kind::nothing};  // it is refused
    std::span<const std::uint8_t> b(*bytes);
    // A complete telegram: start, ID, length, 02h, and its end, with or without a checksum.
    const bool whole = b.size() >= 7 && b[0] == 1 && b[3] == 2 && b.back() == 4 && b[2] >= 3 &&
                       (b.size() == std::size_t{b[2]} + 4 || b.size() == std::size_t{b[2]} + 6);
    if (whole) b = b.subspan(4, std::size_t{b[2]} - 1);
    const std::uint8_t sub = b[0];
    const auto data = b.subspan(2);
    switch (b[1]) {
        case static_cast<std::uint8_t>(Main::response):
        case static_cast<std::uint8_t>(Main::curves):
        case static_cast<std::uint8_t>(Main::parameters):
        case static_cast<std::uint8_t>(Main::program):
        case static_cast<std::uint8_t>(Main::errors):
        case static_cast<std::uint8_t>(Main::table):
            return {Kind::nothing};
        case static_cast<std::uint8_t>(Main::ram):
            return {sub == 0 ? Kind::nothing : Kind::unread};
        case static_cast<std::uint8_t>(Main::control_word):
            return data.size() < 2 ? Stated{Kind::unread} : of_word(static_cast<std::uint16_t>(data[0] | data[1] << 8));
        case static_cast<std::uint8_t>(Main::motion):
            return of_bytes(catalogue, data);
        default:
            return {Kind::unread};
    }
}

Stated of_action(const Catalogue& catalogue, const Action& action) {
    const CatalogueCommand* command = catalogue.command(action.name);
    if (!command) return {Kind::nothing};  // it is refused
    const Motions motions(catalogue);
    const Motion* motion = motions.named(command->id);
    if (!motion) return {Kind::nothing};  // texts, tables and curves: a motion command starts them
    std::vector<Value> values = action.values;
    if (values.size() != command->arguments.size()) values = check_arguments(*command, action.argument).values;
    return of_motion(*motion, values);
}
}  // namespace

Stated stated(const Catalogue& catalogue, int, const CommandBody& body) {
    if (const auto* native = std::get_if<Native>(&body)) return of_native(catalogue, *native);
    if (const auto* action = std::get_if<Action>(&body)) return of_action(catalogue, *action);
    if (const auto* write = std::get_if<WriteParameter>(&body)) {
        const Parameter* p = catalogue.parameter(write->point);
        const auto* upid = p ? p->wire.if_contains("upid") : nullptr;
        const auto* rom = p ? p->wire.if_contains("rom") : nullptr;
        const auto value = as_integer(write->value);
        if (!upid || !value || (rom && rom->as_bool())) return {Kind::nothing};
        return of_live(static_cast<std::uint16_t>(upid->as_int64()), *value);
    }
    return {Kind::nothing};
}

}  // namespace axisgate::linmot
