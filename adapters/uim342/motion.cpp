// Moves: positioning and jog, taken apart into values and BG.
// In: Move, StartTogether of this drive alone, what is known of AC, DC, SS and their unit. Out: PA, PR or JV, SP, AC, DC, BG.
// Never starts what it could not set: any refused or altered value ends the job before BG.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>

#include "adapters/uim342/drive.hpp"

namespace axisgate::uim342 {
namespace {
constexpr std::int64_t ramp_rate_max = 65'000'000;  // pulse/s^2 [L1342]
constexpr std::int64_t ramp_time_max = 60'000;      // ms
constexpr std::int64_t i32_max = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t i32_min = std::numeric_limits<std::int32_t>::min();
}  // namespace

void Moves::plan(const Command& command, Turn& t) {
    job().exact = true;
    if (const auto* move = std::get_if<Move>(&command.body)) return plan_move(*move, t);
    const auto& prepared = drive_.together.prepared();
    if (!prepared) return refuse(Reason::wrong_state, "no motion has been prepared", t);
    if (auto why = drive_.together.not_startable(); !why.empty()) return refuse(Reason::wrong_state, std::move(why), t);
    motion_ = *prepared;
    job().add(drive_.act(cw::BG));
}

void Moves::done(Turn& t) {
    Job was = drive_.jobs.hand_over();
    const Command& c = was.command;
    if (const auto* move = std::get_if<Move>(&c.body); move && move->prepare_only) {
        drive_.together.prepare(motion_);
        if (!was.text.empty()) was.text += "; ";
        return (void)drive_.tickets.accepted(c.ticket, t.out, was.text + "prepared: start_together starts it");
    }
    drive_.feedback.begin_motion(motion_, t);
    const auto until = motion_.kind == Motion::Kind::velocity ? Waits::Until::speed : Waits::Until::target;
    drive_.waits.accepted({until, c.ticket, motion_.target}, c.until_done, std::move(was.text), t);
}

void Moves::plan_move(const Move& move, Turn& t) {
    const Status& status = drive_.feedback.status();
    // With the driver off PA would be kept, and act as a residual motion when it turns on.
    if (!status.on) return refuse(Reason::wrong_state, "the driver is off: enable the axis first", t);
    if (status.lock) return refuse(Reason::wrong_state, "the drive is locked after an emergency stop: reset the fault first", t);
    if (move.target < i32_min || move.target > i32_max) {
        return refuse(Reason::out_of_range, fmt::format("target {} is outside {}..{}", move.target, i32_min, i32_max), t);
    }
    const bool jog = move.kind == Move::Kind::velocity;
    std::int64_t speed = 0;
    if (jog) {
        speed = std::llabs(move.target);
    } else {
        // JV and SP share one register of the desired speed: SP is sent with every motion, or an old JV would decide (erratum E-46).
        speed = move.velocity.value_or(drive_.known.ptp_speed.value_or(0));
        if (speed < 1 || speed > i32_max) {
            return refuse(Reason::out_of_range,
                          move.velocity ? fmt::format("velocity {} is outside 1..{} pulse/s", speed, i32_max)
                                        : std::string("the drive has no speed for a positioning motion yet: give a velocity"),
                          t);
        }
    }
    std::string fault;
    // DC first: it is the one that can be refused for its relation to SD, and then nothing has changed.
    for (const bool down : {true, false}) {
        const auto& wanted = down ? move.deceleration : move.acceleration;
        if (!wanted) continue;
        const std::uint8_t which = down ? cw::DC : cw::AC;
        const auto v = ramp(*wanted, speed, down ? "DC" : "AC", fault);
        if (!fault.empty()) return refuse(Reason::out_of_range, std::move(fault), t);
        if (const auto& ram = drive_.known.ram; v && (down ? ram.dc : ram.ac) != *v) job().add(drive_.set(which, *v));
    }
    using Kind = Motion::Kind;
    const bool relative = move.kind == Move::Kind::relative;
    motion_ = {jog ? Kind::velocity : relative ? Kind::relative : Kind::absolute, move.target, speed};
    job().add(drive_.set(jog ? cw::JV : relative ? cw::PR : cw::PA, move.target));
    if (!jog) job().add(drive_.set(cw::SP, speed));  // after PA or PR, else 0x32 [L1453]
    drive_.together.unprepare();
    if (!move.prepare_only) job().add(drive_.act(cw::BG));
}

/// AC or DC for an acceleration in pulse/s^2. With IC[4] = 1 they are the time between cut-in speed and speed, in ms. Nothing and
/// no fault: no ramp is needed.
std::optional<std::uint32_t> Moves::ramp(std::int64_t rate, std::int64_t speed, std::string_view what, std::string& fault) {
    const auto& ram = drive_.known.ram;
    std::string& text = job().text;
    if (!ram.time_ramps) {
        fault = fmt::format("IC[4] could not be read, so the unit of {} is not known", what);
        return std::nullopt;
    }
    if (!*ram.time_ramps) {
        if (rate >= 1 && rate <= ramp_rate_max) return static_cast<std::uint32_t>(rate);
        fault = fmt::format("{}: {} is outside 1..{} pulse/s^2", what, rate, ramp_rate_max);
        return std::nullopt;
    }
    if (!ram.ss) {
        fault = fmt::format("SS could not be read, so {} cannot be converted to a time (IC[4] = 1)", what);
        return std::nullopt;
    }
    if (rate < 1) {
        fault = fmt::format("{}: {} pulse/s^2 is not above 0", what, rate);
        return std::nullopt;
    }
    const std::int64_t step = speed - static_cast<std::int64_t>(*ram.ss);
    if (step <= 0) return std::nullopt;  // the speed is reached at once
    const double ms = 1000.0 * static_cast<double>(step) / static_cast<double>(rate);
    const auto rounded = std::max<std::int64_t>(1, std::llround(ms));
    if (rounded > ramp_time_max) {
        fault = fmt::format("{}: {} pulse/s^2 up to {} pulse/s takes {} ms; the drive allows 1..{} ms (IC[4] = 1)", what, rate, speed,
                            rounded, ramp_time_max);
        return std::nullopt;
    }
    fmt::format_to(std::back_inserter(text), "{}{} = {} ms", text.empty() ? "" : ", ", what, rounded);
    return static_cast<std::uint32_t>(rounded);
}

}  // namespace axisgate::uim342
