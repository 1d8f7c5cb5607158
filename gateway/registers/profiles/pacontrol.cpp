// The image and the operating modes of a PA-CONTROL. A write is applied in the order CTRL, axis interfaces, CMD, so that switching off
// comes first. An image that is all zero starts nothing, because a bus begins with it.
#include "gateway/registers/profiles/pacontrol.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace axisgate::registers {
namespace {
constexpr std::uint16_t ctrl_reset = 1u << 0, ctrl_stop = 1u << 1, ctrl_cancel = 1u << 2, ctrl_online = 1u << 4, ctrl_integers = 1u << 15;
}

PaControlMap::Meaning PaControlMap::meaning_of(const LanguageRow& row) {
    using enum Meaning;
    constexpr std::array<std::pair<std::string_view, Meaning>, 17> names{{{"cmd_data", cmd_data},
                                                                          {"cmd_parameter", cmd_parameter},
                                                                          {"cmd_code", cmd_code},
                                                                          {"ctrl", ctrl},
                                                                          {"ack_data", ack_data},
                                                                          {"ack_status", ack_status},
                                                                          {"ack_code", ack_code},
                                                                          {"ctrl_status", ctrl_status},
                                                                          {"ctrl_error", ctrl_error},
                                                                          {"axis_control", axis_control},
                                                                          {"axis_acceleration", axis_acceleration},
                                                                          {"axis_speed", axis_speed},
                                                                          {"axis_target", axis_target},
                                                                          {"axis_status", axis_status},
                                                                          {"axis_cmd_error", axis_cmd_error},
                                                                          {"axis_error", axis_error},
                                                                          {"axis_position", axis_position}}};
    const auto it = std::ranges::find(names, row.meaning, &std::pair<std::string_view, Meaning>::first);
    return it == names.end() ? other : it->second;
}

PaControlMap::PaControlMap(const DoorPort& port, Setup setup) : ProfileMap(port, std::move(setup)) {
    const auto& rows = language().rows;
    values_.resize(rows.size());
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const Meaning m = meaning_of(rows[r]);
        meanings_.push_back(m);
        if (m <= Meaning::cmd_code) cmd_rows_[static_cast<std::size_t>(m)] = r;
        if (m >= Meaning::axis_control && m <= Meaning::axis_target && rows[r].axis >= 1)
            axis_rows_[rows[r].axis - 1u][static_cast<std::size_t>(m) - static_cast<std::size_t>(Meaning::axis_control)] = r;
    }
    for (std::size_t i = 0; i < axes(); ++i) {
        axes_[i].speed = axes_[i].reference_speed = axes_[i].manual_speed = axis(i).velocity.value_or(0);
        axes_[i].acceleration = axis(i).acceleration.value_or(0);
    }
}

bool PaControlMap::shown(std::size_t row, Instant, std::uint32_t& bits) {
    const std::size_t i = language().rows[row].axis == 0 ? 0 : language().rows[row].axis - 1u;
    switch (meanings_[row]) {
        case Meaning::ack_data:
            bits = reply_.live && !reply_.done ? bits_of(MapType::f32, position(reply_.axis)) : reply_.data;
            return true;
        case Meaning::ack_status:
            bits = operating_status() | (system_error() != 0 ? 0x8000u : 0u);
            return true;
        case Meaning::ack_code:
            bits = (sf_ ? 0x8000u : 0u) | (reply_.failed ? 0x4000u : 0u) |
                   (reply_.done && !reply_.failed && mode_ != Mode::silent ? 0x2000u : 0u) | (reply_.error & 0x1FFFu);
            return true;
        case Meaning::ctrl_status:
            bits = ctrl_status();
            return true;
        case Meaning::ctrl_error:
            bits = system_error();
            return true;
        case Meaning::axis_status:
            bits = axis_status(i);
            return true;
        case Meaning::axis_cmd_error:
            bits = axes_[i].cmd_error;
            return true;
        case Meaning::axis_error:
            bits = flag(i, flag_fault) ? picture(i).error_code : axes_[i].axis_error;
            return true;
        case Meaning::axis_position:
            bits = position_bits(position(i));
            return true;
        default:
            bits = values_[row];
            return true;
    }
}

Verdict PaControlMap::taken(std::span<const Written> rows, WritePlan& plan) {
    bool ctrl = false, code = false;
    std::array<bool, 8> touched{};
    std::array<std::uint32_t, 8> before{};
    for (std::size_t i = 0; i < axes(); ++i)
        before[i] = axes_[i].control;
    for (const Written& w : rows) {
        values_[w.row] = w.bits;
        ctrl = ctrl || meanings_[w.row] == Meaning::ctrl;
        code = code || meanings_[w.row] == Meaning::cmd_code;
        if (const auto k = language().rows[w.row].axis; k != 0) touched[k - 1u] = true;
    }
    if (mode_ == Mode::silent) mode_ = Mode::home;
    for (const Written& w : rows) {
        if (ctrl && meanings_[w.row] == Meaning::ctrl) take_ctrl(static_cast<std::uint16_t>(w.bits), plan);
    }
    for (std::size_t i = 0; i < axes(); ++i) {
        if (!touched[i]) continue;
        const bool first = !std::exchange(axes_[i].configured, true);
        interfaces_ = true;
        axes_[i].control = values_[axis_rows_[i][0]];
        if (first && !axes_[i].based) before[i] = axes_[i].control;
        take_axis(i, before[i], plan);
    }
    if (code) {
        const auto word = static_cast<std::uint16_t>(values_[cmd_rows_[2]]);
        if (((word & 0x8000u) != 0) != sf_) {
            sf_ = !sf_;
            execute(word & 0x7FFFu, static_cast<std::uint16_t>(values_[cmd_rows_[1]]), values_[cmd_rows_[0]], plan);
        }
    }
    return Verdict::good;
}

/// The toggle of CMD counts as unchanged, and every set bit of CTRL and of an axis interface as set before; only cleared bits act. An
/// interface that is all zero does not become configured by that: a master that uses CMD alone leaves it so.
void PaControlMap::adopted(std::span<const Written> rows, WritePlan& plan) {
    if (mode_ == Mode::silent) mode_ = Mode::home;
    std::array<std::uint32_t, 8> control{};
    std::array<bool, 8> there{};
    for (const Written& w : rows) {
        values_[w.row] = w.bits;
        const auto axis = language().rows[w.row].axis;
        if (axis != 0) there[axis - 1u] = there[axis - 1u] || w.bits != 0 || axes_[axis - 1u].configured;
        if (meanings_[w.row] == Meaning::axis_control) {
            control[axis - 1u] = w.bits;
            axes_[axis - 1u].based = true;
        }
        if (meanings_[w.row] == Meaning::cmd_code) sf_ = (w.bits & 0x8000u) != 0;
        if (meanings_[w.row] != Meaning::ctrl) continue;
        ctrl_based_ = true;
        if (w.bits == 0 && !ctrl_configured_) continue;
        ctrl_ |= w.bits & ctrl_online;
        take_ctrl(static_cast<std::uint16_t>(w.bits), plan);
    }
    for (std::size_t i = 0; i < axes(); ++i) {
        AxisState& a = axes_[i];
        if (!there[i] || !a.based) continue;
        const std::uint32_t before = (a.configured ? a.control : 0u) | control[i];
        a.control = control[i];
        a.configured = interfaces_ = true;
        take_axis(i, before, plan);
    }
}

void PaControlMap::take_ctrl(std::uint16_t word, WritePlan& plan) {
    const auto fell = [&](std::uint16_t bit) { return (ctrl_ & bit) != 0 && (word & bit) == 0; };
    // Bits in the first image may be older than this gateway's start, so they start nothing.
    const bool online = (ctrl_configured_ || ctrl_based_) && (ctrl_ & ctrl_online) == 0 && (word & ctrl_online) != 0;
    if (fell(ctrl_reset)) reset_faults(plan, Asked::nothing);
    if (fell(ctrl_cancel)) {
        leave_online(plan);
    } else if (fell(ctrl_stop)) {
        stop_all(plan);
    }
    ctrl_ = word;
    ctrl_configured_ = true;
    if (online && (word & ctrl_stop) != 0 && (word & ctrl_cancel) != 0) start_online(plan);
}

void PaControlMap::start_online(WritePlan& plan) {
    if (mode_ == Mode::stopping && !any_moving()) {
        mode_ = Mode::online;
        return;
    }
    if (mode_ != Mode::home) return;
    mode_ = Mode::online;
    integers_ = ctrl_configured_ && (ctrl_ & ctrl_integers) != 0;
    for (std::size_t i = 0; i < axes(); ++i) {
        const bool on = axes_[i].configured ? (axes_[i].control & 1u) != 0 : !interfaces_ && axes_[i].enable_mode == 1;
        if (on && !enabled(i)) switch_power(i, true, plan);
    }
}

void PaControlMap::stop_all(WritePlan& plan) {
    if (mode_ != Mode::online) return;
    mode_ = Mode::stopping;
    for (std::size_t i = 0; i < axes(); ++i) {
        axes_[i].active = false;
        ++axes_[i].sequence;
        if (enabled(i)) order(plan, i, Halt{}, note(Asked::nothing, i, 0), Answer::acknowledged);
    }
}

void PaControlMap::leave_online(WritePlan& plan) {
    if (mode_ == Mode::online) stop_all(plan);
    if (mode_ == Mode::stopping) mode_ = Mode::home;
    for (auto& a : axes_)
        a.online_speed = a.online_acceleration = 0;
}

void PaControlMap::reset_faults(WritePlan& plan, Asked asked) {
    for (std::size_t i = 0; i < axes(); ++i) {
        if (!flag(i, flag_fault)) continue;
        order(plan, i, ResetFault{}, note(asked, i, reply_.sequence), Answer::done);
        if (asked == Asked::cmd) ++reply_.waits;
    }
}

bool PaControlMap::any_moving() const {
    for (std::size_t i = 0; i < axes(); ++i) {
        if (flag(i, flag_moving)) return true;
    }
    return false;
}

std::uint16_t PaControlMap::system_error() const {
    for (std::size_t i = 0; i < axes(); ++i) {
        if (flag(i, flag_fault)) return picture(i).error_code != 0 ? picture(i).error_code : std::uint16_t{1};
    }
    return 0;
}

std::uint16_t PaControlMap::operating_status() const {
    switch (mode_) {
        case Mode::home:
            return system_error() != 0 ? 9 : 1;
        case Mode::online:
            return 31;
        case Mode::stopping:
            return any_moving() ? 32 : 35;
        case Mode::silent:
            break;
    }
    return 0;
}

std::uint16_t PaControlMap::ctrl_status() const {
    if (!ctrl_configured_) return 0;
    std::uint16_t s = (1u << 0) | (1u << 1);
    if (system_error() != 0) s |= 1u << 2;
    if (mode_ == Mode::online || (mode_ == Mode::stopping && any_moving())) s |= 1u << 10;
    if (mode_ == Mode::stopping && !any_moving()) s |= 1u << 11;
    if (integers_) s |= 1u << 15;
    return s;
}

std::uint32_t PaControlMap::position_bits(double counts) const {
    return integers_ ? bits_of(MapType::i32, counts * 1000) : bits_of(MapType::f32, counts);
}
double PaControlMap::position_of(std::uint32_t bits) const {
    return integers_ ? number_of(MapType::i32, bits) / 1000 : number_of(MapType::f32, bits);
}

std::uint16_t PaControlMap::error_of(const Result& result, bool motion) const {
    if (motion && result.reason == Reason::out_of_range) return pacontrol_errors::outside_range;
    return static_cast<std::uint16_t>(language().error_of(result.reason));
}

Move PaControlMap::move(std::size_t i, Move::Kind kind, double target, double speed, double acceleration) const {
    Move m;
    m.kind = kind;
    m.target = increments(i, target);
    if (speed > 0) m.velocity = positive_increments(i, speed);
    if (acceleration > 0) m.acceleration = m.deceleration = positive_increments(i, acceleration);
    return m;
}

void PaControlMap::on_own_result(std::uint32_t note, const Result& result) {
    const std::size_t i = (note >> 24) & 0xF;
    const std::uint32_t sequence = note & 0xFF'FFFFu;
    AxisState& a = axes_[std::min<std::size_t>(i, 7)];
    switch (static_cast<Asked>(note >> 28)) {
        case Asked::cmd:
            if (sequence != (reply_.sequence & 0xFF'FFFFu) || reply_.done) return;
            if (reply_.waits > 0) --reply_.waits;
            if (!good(result) && !reply_.failed) {
                reply_.failed = true;
                reply_.error = error_of(result, true);
            }
            if (reply_.waits == 0) {
                if (reply_.live) reply_.data = bits_of(MapType::f32, position(reply_.axis));
                reply_.done = true;
            }
            return;
        case Asked::axis:
            if (sequence != (a.sequence & 0xFF'FFFFu)) return;
            a.active = false;
            if (!good(result)) a.cmd_error = error_of(result, true);
            return;
        case Asked::power:
            if (!good(result)) a.axis_error = error_of(result, false);
            return;
        case Asked::nothing:
            return;
    }
}

}  // namespace axisgate::registers
