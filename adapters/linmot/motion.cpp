// Moves are commands of the VA interpolator, in increments of 0.1 um. The drive acknowledges a motion command by showing its count. Only
// rates that a client gave or the drive reported are used.
#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {
namespace {
constexpr Duration look_at_count = std::chrono::milliseconds(5);
constexpr int looks = 6;  ///< least number of reads of the count of a motion command until it counts as not executed
/// Increments per second to counts of 1e-6 m/s (1 = 10), per second squared to 1e-5 m/s2 (1 = 100); never 0.
std::int64_t counts(std::int64_t value, std::int64_t per) { return std::max<std::int64_t>((value + per / 2) / per, 1); }
}  // namespace

void Moves::begin(Turn& t) {
    const CommandBody& body = job().command.body;
    if (const auto* move = std::get_if<Move>(&body)) return begin_move(*move, t);
    const auto& place = std::get<SetPosition>(body);
    if (drive_.feedback.status().state() != state::enabled)
        return refuse(
            Reason::wrong_state,
            fmt::format("drive {} is in {}: its position is set while it is enabled", drive_.title(), drive_.feedback.state_text()), t);
    if (place.position < INT32_MIN || place.position > INT32_MAX)
        return refuse(Reason::out_of_range, "the position is beyond what the drive can count", t);
    drive_.motion.no_target();
    drive_.motion.begin_motion(*drive_.bus.motions.named("009xh"), {place.position});
}

void Moves::begin_move(const Move& move, Turn& t) {
    const auto wrong = [&](Reason reason, std::string text) { refuse(reason, std::move(text), t); };
    const Feedback& feedback = drive_.feedback;
    const Limits& own = drive_.limits;
    if (move.prepare_only) return wrong(Reason::not_supported, "a LinMot drive starts a move when it gets it; nothing can be prepared");
    if (feedback.status().state() != state::enabled)
        return wrong(Reason::wrong_state, feedback.in_error()
                                              ? fmt::format("drive {} is in {}", drive_.title(), feedback.error_text())
                                              : fmt::format("drive {} is in {}: enable it first", drive_.title(), feedback.state_text()));
    const bool endless = move.kind == Move::Kind::velocity;
    if (endless && move.target == 0) {
        const std::uint32_t d =
            move.deceleration ? static_cast<std::uint32_t>(counts(*move.deceleration, 100)) : drive_.demand.deceleration();
        drive_.motion.no_target();
        drive_.demand.ordered_stop(move, d);
        return drive_.motion.begin_motion(*drive_.bus.motions.named("017xh"), {std::int64_t{d}});
    }
    const auto pick = [&](const std::optional<std::int64_t>& given, std::int64_t per,
                          const std::optional<std::uint32_t>& limit) -> std::int64_t {
        return given ? counts(*given, per) : limit ? std::int64_t{*limit} : 0;
    };
    const std::int64_t v = endless ? counts(std::llabs(move.target), 10) : pick(move.velocity, 10, own.velocity);
    const std::int64_t a = pick(move.acceleration, 100, own.acceleration), d = pick(move.deceleration, 100, own.deceleration);
    if (v == 0 || a == 0 || d == 0)
        return wrong(Reason::out_of_range, "give velocity, acceleration and deceleration: what the drive would use is not known");
    constexpr std::int64_t most = std::numeric_limits<std::uint32_t>::max();
    if (v > most || a > most || d > most)
        return wrong(Reason::out_of_range, fmt::format("velocity is at most {} and acceleration {} increments", most * 10, most * 100));
    // An endless motion is a move to the end of the number range: 010xh is proven on drives, the layouts of the endless commands are
    // inferred.
    constexpr std::int64_t far = std::numeric_limits<std::int32_t>::max();
    const std::int64_t target = endless ? (move.target > 0 ? far : -far) : move.target;
    if (target < -far - 1 || target > far)
        return wrong(Reason::out_of_range, fmt::format("{} is outside {}..{} (0.1 um)", target, -far - 1, far));
    const bool relative = move.kind == Move::Kind::relative;
    if (relative && std::llabs(feedback.status().position + target) > far)
        return wrong(Reason::out_of_range, "the target is beyond what the drive can count");
    drive_.motion.has_target(!endless);
    if (endless) drive_.motion.endless();
    drive_.demand.ordered(move, static_cast<std::uint32_t>(v), static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(d));
    drive_.motion.begin_motion(*drive_.bus.motions.named(relative ? "011xh" : "010xh"), {target, v, a, d});
}

void MotionOrders::begin_motion(const Motion& motion, std::vector<Value> values) {
    job().motion = Motions::pack(motion, 0, values);
    job().text = motion.command->name;
    job().step = 0;
    job().state_before = drive_.feedback.status().state();
    drive_.jobs.hand_to(*this);
}

Telegram MotionOrders::telegram(const Motion& motion, std::uint8_t count, std::span<const Value> values) const {
    Telegram telegram = linmot::request(drive_.id(), Main::motion, 0);
    for (const auto b : Motions::pack(motion, count, values))
        telegram.add(b);
    return telegram;
}

void MotionOrders::seen(const Status& s, Turn& t) {
    fresh_ = false;
    // The command was not answered, but the drive has accepted it; the client was informed that it failed.
    if (orphan_ && s.state() == state::enabled && (s.sub_state() & 0x0F) == *orphan_ && s.moving()) {
        orphan_.reset();
        drive_.notice(Severity::warning, "motion", 0,
                      fmt::format("drive {} has begun a motion that was answered as failed: it is halted", drive_.title()), t);
        drive_.stops.take_back(Halt{}, t);
    }
    if (s.state() != state::enabled) return;
    shown_ = s.sub_state() & 0x0F;
    // A count that was sent a moment ago is not shown yet by a drive whose response is late.
    if (!drive_.jobs.is(*this) && t.now >= sent_at_ + shown_within) count_ = shown_;
}

std::uint8_t MotionOrders::next_count(Instant now) noexcept {
    sent_at_ = now;
    const auto after = [](std::uint8_t count) { return static_cast<std::uint8_t>((count + 1) & 0x0F); };
    count_ = after(count_);
    return count_ == shown_ ? count_ = after(count_) : count_;
}

/// Sent with a new count, which is read then. A response that nobody has asked for may have been taken for the answer to a command that was
/// lost, so the command is sent again from time to time: with the same count it is not executed twice.
std::optional<Telegram> MotionOrders::request(Turn& t) {
    const bool again = job().step % looks == looks / 2 && drive_.feedback.status().state() == state::enabled;
    if (job().step > 0 && !again) return linmot::request(drive_.id(), Main::response, 1);
    if (job().step == 0) {
        job().step = 1;
        orphan_.reset();
        job().count = next_count(t.now);
        job().limit = t.now + shown_within;
    }
    std::vector<std::uint8_t> bytes = job().motion;
    bytes[0] = static_cast<std::uint8_t>((bytes[0] & 0xF0) | job().count);
    Telegram telegram = linmot::request(drive_.id(), Main::motion, 0);
    for (const auto b : bytes)
        telegram.add(b);
    return telegram;
}

void MotionOrders::answered(const Telegram&, Turn& t) {
    Feedback& feedback = drive_.feedback;
    const Status& s = feedback.status();
    Job& j = job();
    const bool was_enabled = j.state_before == state::enabled;
    if (feedback.in_error() && j.state_before != state::error && j.state_before != state::setup_error) {
        no_target();
        return refuse(Reason::drive_refused, fmt::format("drive {} refused {}: {}", drive_.title(), j.text, feedback.error_text()), t,
                      s.sub_state());
    }
    // Most errors stop the motor first: the state after that shows which error it was.
    const bool looks_on = ++j.step <= looks || t.now < j.limit;
    if (s.state() == state::quick_stop && looks_on) {
        j.not_before = t.now + look_at_count;
        return;
    }
    const bool executed = s.state() == state::enabled ? (s.sub_state() & 0x0F) == j.count : !was_enabled;
    if (s.state() != state::enabled && was_enabled) {
        no_target();
        return fail(Reason::interrupted,
                    fmt::format("drive {} went to {} while {} was sent", drive_.title(), feedback.state_text(), j.text), t);
    }
    if (!executed) {
        if (looks_on) {
            j.not_before = t.now + look_at_count;
            return;
        }
        no_target();
        given_up(j.count);
        return fail(Reason::drive_refused,
                    fmt::format("drive {} did not execute {}: its count stays {} instead of {}", drive_.title(), j.text,
                                s.sub_state() & 0x0F, j.count),
                    t);
    }
    fresh_ = true;
    course_ = wanted_;
    if (std::holds_alternative<Action>(j.command.body)) drive_.start.read_again();
    if (std::holds_alternative<Move>(j.command.body))
        drive_.demand.moves(t);
    else if (std::holds_alternative<Action>(j.command.body))
        drive_.demand.forget();
    else
        drive_.demand.rest(s.position);
    feedback.publish(t);
    drive_.poll.soon(t.now);
    accept({}, t);
}

}  // namespace axisgate::linmot
