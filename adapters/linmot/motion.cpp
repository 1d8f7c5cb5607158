// Motion: moves as commands of the VA interpolator, and how a motion command is known to have been executed: its count comes back.
// In: moves in increments (0.1 um). Out: motion commands. Never uses a velocity, acceleration or deceleration that nobody gave or read.
#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {
namespace {
constexpr Duration look_again = std::chrono::milliseconds(5);
constexpr int looks = 6;  ///< at the count of a motion command until it counts as not executed
/// Increments per second into counts of 1e-6 m/s (1 = 10), per second squared into 1e-5 m/s2 (1 = 100); never 0.
std::int64_t counts(std::int64_t value, std::int64_t per) { return std::max<std::int64_t>((value + per / 2) / per, 1); }
}  // namespace

std::uint8_t Drive::next_count() noexcept { return count_ = static_cast<std::uint8_t>((count_ + 1) & 0x0F); }

Telegram Drive::motion_telegram(const Motion& motion, std::uint8_t count, std::span<const Value> values) const {
    Telegram telegram = request(id_, Main::motion, 0);
    for (const auto b : Motions::pack(motion, count, values))
        telegram.add(b);
    return telegram;
}

void Drive::begin_move(const Move& move, Turn& t) {
    const auto refuse = [&](Reason reason, std::string text) { end_job(Outcome::refused, reason, std::move(text), t); };
    if (move.prepare_only) return refuse(Reason::not_supported, "a LinMot drive starts a move when it gets it; nothing can be prepared");
    if (status_.state() != state::enabled) {
        return refuse(Reason::wrong_state, in_error() ? fmt::format("drive {} is in {}", title(), error_text())
                                                      : fmt::format("drive {} is in {}: enable it first", title(), state_text()));
    }
    const bool endless = move.kind == Move::Kind::velocity;
    if (endless && move.target == 0) {
        const std::uint32_t d = move.deceleration ? static_cast<std::uint32_t>(counts(*move.deceleration, 100))
                                : move_d_         ? move_d_
                                                  : dec_.value_or(100'000);
        to_target_ = false;
        demand_move_ = move;
        move_d_ = d;
        return begin_motion(*bus_.motions.named("017xh"), {std::int64_t{d}}, t);
    }
    const auto pick = [&](const std::optional<std::int64_t>& given, std::int64_t per,
                          const std::optional<std::uint32_t>& own) -> std::int64_t {
        return given ? counts(*given, per) : own ? std::int64_t{*own} : 0;
    };
    const std::int64_t v = endless ? counts(std::llabs(move.target), 10) : pick(move.velocity, 10, vmax_);
    const std::int64_t a = pick(move.acceleration, 100, acc_), d = pick(move.deceleration, 100, dec_);
    if (v == 0 || a == 0 || d == 0)
        return refuse(Reason::out_of_range, "give velocity, acceleration and deceleration: what the drive would use is not known");
    constexpr std::int64_t most = std::numeric_limits<std::uint32_t>::max();
    if (v > most || a > most || d > most)
        return refuse(Reason::out_of_range, fmt::format("velocity is at most {} and acceleration {} increments", most * 10, most * 100));
    // An endless motion is a move to the end of the numbers: 010xh is proven on drives, the endless commands' layouts are inferred.
    constexpr std::int64_t far = std::numeric_limits<std::int32_t>::max();
    const std::int64_t target = endless ? (move.target > 0 ? far : -far) : move.target;
    if (target < -far - 1 || target > far)
        return refuse(Reason::out_of_range, fmt::format("{} is outside {}..{} (0.1 um)", target, -far - 1, far));
    const bool relative = move.kind == Move::Kind::relative;
    if (relative && std::llabs(status_.position + target) > far)
        return refuse(Reason::out_of_range, "the target is beyond what the drive can count");
    to_target_ = !endless;
    move_v_ = static_cast<std::uint32_t>(v);
    move_a_ = static_cast<std::uint32_t>(a);
    move_d_ = static_cast<std::uint32_t>(d);
    demand_move_ = move;
    begin_motion(*bus_.motions.named(relative ? "011xh" : "010xh"), {target, v, a, d}, t);
}

/// Sends it when the line is free; motion_answered() sees what became of it.
void Drive::begin_motion(const Motion& motion, std::vector<Value> values, Turn&) {
    job_.bytes = Motions::pack(motion, 0, values);
    job_.text = motion.command->name;
    job_.step = 0;
    job_.number = -1;  // its count is watched
    job_.state_before = status_.state();
}

void Drive::motion_answered(Turn& t) {
    const bool was_enabled = job_.state_before == state::enabled;
    if (in_error() && job_.state_before != state::error && job_.state_before != state::setup_error) {
        to_target_ = false;
        return end_job(Outcome::refused, Reason::drive_refused, fmt::format("drive {} refused {}: {}", title(), job_.text, error_text()), t,
                       status_.sub_state());
    }
    // Most errors stop the motor first: the state after that says which it was.
    if (status_.state() == state::quick_stop && ++job_.step <= looks) {
        job_.not_before = t.now + look_again;
        return;
    }
    const bool executed = status_.state() == state::enabled ? (status_.sub_state() & 0x0F) == job_.count : !was_enabled;
    if (status_.state() != state::enabled && was_enabled) {
        to_target_ = false;
        return end_job(Outcome::failed, Reason::interrupted,
                       fmt::format("drive {} went to {} while {} was sent", title(), state_text(), job_.text), t);
    }
    if (!executed) {
        if (++job_.step <= looks) {
            job_.not_before = t.now + look_again;
            return;
        }
        to_target_ = false;
        return end_job(Outcome::failed, Reason::drive_refused,
                       fmt::format("drive {} did not execute {}: its count stays {} instead of {}", title(), job_.text,
                                   status_.sub_state() & 0x0F, job_.count),
                       t);
    }
    motion_fresh_ = true;
    if (std::holds_alternative<Move>(job_.command.body))
        demand_moves(t);
    else if (std::holds_alternative<Action>(job_.command.body))
        demand_.forget();
    else
        demand_.rest(static_cast<double>(status_.position));
    tell(t);
    poll_.soon(t.now);
    end_job(Outcome::accepted, Reason::none, {}, t);
}

}  // namespace axisgate::linmot
