// Motion: MA and SL, and before them the values that differ from what the drive has: VI, VM, A, D.
// In: moves in the drive's own units. Out: lines; the motion as the axis shows it.
// Never leaves VI above VM, which the drive would refuse.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {

namespace {
/// QD and ^ choose who hears a line, not when it acts, and a line to * has one target for all [L4991, L5034].
constexpr std::string_view no_prepared_start =
    "MCode has no motion that is loaded now and started later, and one line to all drives has one target for all; a stored program in "
    "each drive that waits for the same input, or EX to each drive in turn, is what the language offers";
constexpr std::int64_t fastest = 5'000'000, fastest_move = 2'560'000;
}  // namespace

void Motion::plan(const Command& c, Turn& t) {
    relative_ = false;
    rounds_ = 0;
    if (const auto* m = std::get_if<Move>(&c.body)) return move(*m, t);
    const auto* set = std::get_if<SetPosition>(&c.body);
    if (!set) return refuse(Reason::not_supported, fmt::format("{}: {}", name_of(c.body), no_prepared_start), t);
    if (feedback().moving()) return refuse(Reason::wrong_state, fmt::format("{} moves: stop it first", name()), t);
    if (set->position < INT32_MIN || set->position > INT32_MAX)
        return refuse(Reason::out_of_range, fmt::format("position {}: P holds -2147483648..2147483647", set->position), t);
    job().send(fmt::format("P={}", set->position));
}

void Motion::move(const Move& m, Turn& t) {
    const Feedback& axis = feedback();
    Feedback::Values& values = feedback().values;
    if (m.prepare_only) return refuse(Reason::not_supported, std::string(no_prepared_start), t);
    if (!axis.flags().de) return refuse(Reason::wrong_state, fmt::format("{} is off (DE=0): enable it first", name()), t);
    const bool velocity = m.kind == Move::Kind::velocity;
    // A new MA is not taken during another one [L4110].
    const bool stop_first = !velocity && axis.moving();
    const std::int64_t target = m.target + (m.kind == Move::Kind::relative && !stop_first ? axis.position() : 0);
    std::string why = out_of_range(m);
    if (why.empty() && !velocity && (target < INT32_MIN || target > INT32_MAX))
        why = fmt::format("target {} is outside -2147483648..2147483647", target);
    if (!why.empty()) return refuse(Reason::out_of_range, std::move(why), t);
    relative_ = stop_first && m.kind == Move::Kind::relative;
    if (stop_first) job().send("SL 0").standstill();
    if (!velocity && m.velocity) set_speed(*m.velocity);
    set_ramp('A', m.acceleration, values.a);
    set_ramp('D', m.deceleration, values.d);
    if (velocity) slow_start(std::abs(m.target));
    // Nobody acknowledges what is set: a motion must not begin with a speed of before.
    if (drive_.quiet() && job().steps.size() > (stop_first ? 2U : 0U)) job().ask(feedback().value_items());
    job().send(fmt::format("{} {}", velocity ? "SL" : "MA", target));
}

std::string Motion::out_of_range(const Move& m) const {
    if (m.kind == Move::Kind::velocity) {
        if (m.target < -fastest || m.target > fastest) return fmt::format("SL: {} is outside -{}..{}", m.target, fastest, fastest);
    } else if (m.velocity && *m.velocity < 2) {
        return fmt::format("VM: {} is too low; the drive needs at least 2 (VI is at least 1 and below VM)", *m.velocity);
    } else if (m.velocity && *m.velocity > fastest_move) {
        return fmt::format("VM: {} is above {}", *m.velocity, fastest_move);
    }
    const bool counts = feedback().encoder_mode();
    const std::int64_t least = counts ? 6 : 66, most = counts ? 44'000'000 : 1'100'000'000;
    for (const auto& [word, rate] : {std::pair('A', m.acceleration), std::pair('D', m.deceleration)}) {
        if (rate && (*rate < least || *rate > most)) return fmt::format("{}: {} is outside {}..{}", word, *rate, least, most);
    }
    return {};
}

/// VI must stay below VM: it goes down first and comes up last.
void Motion::set_speed(std::int64_t v) {
    Feedback::Values& now = feedback().values;
    const std::int64_t vi = std::min(now.user_vi > 0 ? now.user_vi : v - 1, v - 1);
    if (vi < now.vi || now.vi == 0) job().send(fmt::format("VI={}", vi));
    if (v != now.vm) job().send(fmt::format("VM={}", v));
    if (vi > now.vi && now.vi != 0) job().send(fmt::format("VI={}", vi));
    now.vi = vi;
    now.vm = v;
}

void Motion::set_ramp(char word, const std::optional<std::int64_t>& rate, std::int64_t& known) {
    if (!rate || known == *rate) return;
    job().send(fmt::format("{}={}", word, *rate));
    known = *rate;
}

/// The drive refuses a speed below VI (error 97): VI goes down with it, and comes back at rest, where no motion feels it.
void Motion::slow_start(std::int64_t speed) {
    Feedback::Values& now = feedback().values;
    const std::int64_t vi = speed == 0 || now.user_vi == 0 ? now.vi : std::min(now.user_vi, speed);
    if (vi == now.vi || now.vi == 0) return;
    if (vi > now.vi && (feedback().flags().mv || (now.vm != 0 && vi >= now.vm))) return;
    job().send(fmt::format("VI={}", vi));
    now.vi = vi;
}

/// Speeds and ramps as the drive has them, in front of a motion.
void Motion::answered(const std::string& data, Turn& t) {
    const Feedback::Values& wanted = feedback().values;
    const auto f = split(data);
    constexpr std::size_t least = 4;
    const std::array<std::int64_t, least> values{wanted.vi, wanted.vm, wanted.a, wanted.d};
    bool same = f.size() >= least;
    for (std::size_t i = 0; same && i < least; ++i)
        same = values[i] == 0 || whole(f[i]) == values[i];
    if (same) return drive_.jobs.step_done(t);
    (void)drive_.turnaround.lost(job().at_once);
    if (++rounds_ > drive_.bus.timing.retries + 1)
        return fail(Reason::no_answer, fmt::format("{} did not take the speed and the ramps of its motion", name()), t);
    ++drive_.bus.counters.retries;
    job().at = 0;
    job().tries = 0;
}

/// Behind a move: it goes, has gone, or is where it was sent.
Motion::Proof Motion::begun(std::int64_t target, Duration since) const {
    constexpr std::int64_t play = 50;  // increments: noise of an encoder
    const auto& flags = feedback().flags();
    const std::int64_t from = std::llabs(feedback().position() - begin_), to = std::llabs(feedback().position() - target);
    if (flags.mv || flags.mp || flags.vc || from > play || to <= (feedback().encoder_mode() ? play : 0)) return Proof::taken;
    return since < shows_within ? Proof::open : Proof::lost;
}

/// Behind SL.
Motion::Proof Motion::slews(std::int64_t speed, Duration since) const {
    const auto& flags = feedback().flags();
    const std::int64_t v = feedback().velocity();
    const bool there = std::llabs(v - speed) <= std::max<std::int64_t>(2, std::llabs(speed) / 50);
    if (flags.vc || there || (speed != 0 && !moved_ && flags.mv)) return Proof::taken;
    return since < shows_within ? Proof::open : Proof::lost;
}

Verb::Proof Motion::proof(const Step& step, Duration since) const {
    const auto number = [&](std::size_t from) { return std::atoll(step.text.c_str() + from); };
    if (step.text.starts_with("MA ")) return begun(number(3), since);
    if (step.text.starts_with("SL ")) return slews(number(3), since);
    if (step.text.starts_with("P=")) {
        const std::int64_t off = std::llabs(feedback().position() - number(2));
        return off <= (feedback().encoder_mode() ? 50 : 0) ? Proof::taken : Proof::lost;
    }
    return Proof::none;
}

void Motion::sending(Step& step, Request& r) {
    begin_ = feedback().position();
    moved_ = feedback().flags().mv || feedback().velocity() != 0;
    if (!relative_ || !step.text.starts_with("MA ")) return;
    relative_ = false;
    step.text = r.text = fmt::format("MA {}", std::atoll(step.text.c_str() + 3) + feedback().position());
}

void Motion::done(Turn& t) {
    using Kind = Feedback::Motion::Kind;
    if (std::holds_alternative<SetPosition>(job().command.body)) {
        feedback().homed(false, t);
        return succeed({}, t);
    }
    const std::string& line = job().steps.back().text;
    const std::int64_t number = std::atoll(line.c_str() + 3);
    const bool endless = line.starts_with("SL ");
    feedback().began({endless ? Kind::velocity : Kind::position, endless ? 0 : number, endless && number == 0}, t);
    // The confirming poll was taken before `target_reached` was withdrawn: what it showed is shown again.
    drive_.poll.soon(t.now);
    accept({}, t);
}

/// What it had planned to set may not have been.
void Motion::without_success(drive::Failure& how, Turn&) {
    Feedback::Values& now = feedback().values;
    const bool move = std::holds_alternative<Move>(job().command.body);
    if (how.dropped) {
        feedback().relearn = feedback().relearn || move;
        return;
    }
    if (move) {
        now.vi = now.vm = now.a = now.d = 0;
        feedback().relearn = true;
    }
    feedback().no_zero();
}

}  // namespace axisgate::mcode
