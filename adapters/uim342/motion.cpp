// Moves: positioning and jog, taken apart into values and BG; Together: one drive's share of a joint start, whose BG is the adapter's.
// In: Move, StartTogether, what is known of AC, DC, SS and their unit. Out: PA, PR or JV, SP, AC, DC, BG; news for Bus::share_done.
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
    std::string text = job().text;
    if (const auto* move = std::get_if<Move>(&job().command.body); move && move->prepare_only) {
        drive_.together.prepare(motion_);
        return accept(text + (text.empty() ? "" : "; ") + "prepared: start_together starts it", t);
    }
    drive_.feedback.begin_motion(motion_, t);
    accept(std::move(text), t);
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

// --- a share of a joint start ----------------------------------------------------------------------------------------------------

bool Together::is_place(const CommandBody& body) noexcept {
    const auto* together = std::get_if<StartTogether>(&body);
    return together && together->axes.empty();
}

bool Together::join() {
    if (!drive_.jobs.queue.push(Command{no_ticket, drive_.axis(), StartTogether{}, false, {}})) return false;
    stage_ = Stage::joined;
    return true;
}

void Together::plan(const Command&, Turn& t) {
    job().waiting = true;
    drive_.bus.share_ready(drive_, t);
}

std::string Together::not_startable() const {
    const std::string& name = drive_.name();
    const Status& s = drive_.feedback.status();
    if (!drive_.presence.is(drive::Presence::Phase::ready)) return fmt::format("{} does not answer", name);
    if (!s.on) return fmt::format("{} is off", name);
    if (s.lock) return fmt::format("{} is locked", name);
    const bool ramp = drive_.stops.ramp() && drive_.feedback.fb().moving;
    return !drive_.stops.empty() || ramp ? fmt::format("{} is being stopped", name) : std::string();
}

void Together::begun(Turn& t) {
    if (drive_.jobs.is(*this)) (void)drive_.jobs.hand_over();
    stage_ = Stage::none;
    broadcast_until_ = t.now + 4 * drive_.bus.timing.reply_timeout;  // it may wait in the line's queue behind other frames
    drive_.feedback.begin_motion(prepared_.value_or(Motion{Motion::Kind::unknown}), t);
    stage_ = Stage::begun;
}

/// Asked behind the joint BG: had the drive refused that, its report would have come before this.
void Together::at_status(Instant sent, Turn& t) {
    if (stage_ != Stage::begun || sent < drive_.feedback.motion().begun) return;
    broadcast_until_ = t.now;
    give_up({true}, t);
}

void Together::over(Share share, Turn& t) {
    if (stage_ == Stage::begun) give_up(std::move(share), t);
}

void Together::give_up(Share share, Turn& t) {
    if (std::exchange(stage_, Stage::none) != Stage::none) drive_.bus.share_done(drive_, std::move(share), t);
}

void Together::leave(Turn& t) {
    if (drive_.jobs.is(*this)) (void)drive_.jobs.hand_over();
    (void)drive_.jobs.queue.interrupt([](const Command& c) { return is_place(c.body); }, "", drive_.tickets, t);
    stage_ = Stage::none;
}

}  // namespace axisgate::uim342
