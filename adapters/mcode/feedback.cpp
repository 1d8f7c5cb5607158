// Feedback: what is shown of the axis: what its polls and this gateway's own commands add up to; and what its error codes mean for it.
// In: answers to polls and ER. Out: feedback, notices. What an answer lacks makes all of it no answer.
// Never takes AS, LR, ST or IF for granted: only models that have them are asked.
#include "adapters/mcode/feedback.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {
using namespace std::chrono_literals;

bool is_fault_code(int code) noexcept {
    constexpr std::array faults{13, 14, 70, 72, 75, 78, 79, 82, 86, 92, 96, 98, 99, 104, 105, 111};
    return std::ranges::find(faults, code) != faults.end();
}

// --- errors ----------------------------------------------------------------------------------------------------------------------

std::string Errors::text_of(int code) const {
    const ErrorCode* e = drive_.bus.catalogue.error(code);
    return fmt::format("error {}{}", code, e ? ", " + e->text : std::string());
}

void Errors::learn(int code, bool ours, Turn& t) {
    last_ = code;
    if (!ours && code != 0) drive_.program.reported(code);
    if (is_fault_code(code)) fault_ = code;
    if (code == 48 || code == 91) stopped_by_input_ = true;
    // SM says whether a stall (86) ends the motion, and the flags tell that.
    if (!ours && code != 86 && (is_fault_code(code) || code == 83 || code == 84 || code == 91)) feedback().demand.ended(t.now);
    const bool no_news = std::exchange(by_search_, false) && !is_fault_code(code);
    if (!ours && !no_news && code != 0) {
        const ErrorCode* e = drive_.bus.catalogue.error(code);
        note(is_fault_code(code) ? Severity::alarm : Severity::warning, "error", code,
             fmt::format("{}: error {}, {}", name(), code, e ? e->text : "a code that the catalogue does not have"), t);
    }
    feedback().show(t);
}

void Errors::answered(Verdict v, const std::string& data, Turn& t) {
    const bool waits = drive_.confirms();
    const auto code = v == Verdict::answered ? whole(data) : std::nullopt;
    if (!code) {
        if (v == Verdict::waiting) drive_.start.silent(t);
        if (v == Verdict::refused || !drive_.ready()) wanted_ = false;
        if (!wanted_ || ++tries_ <= drive_.bus.timing.retries) return;  // asked again
        // What is no number stays none: the polls go on, and who waits for it hears so.
        wanted_ = false;
        tries_ = 0;
        if (drive_.confirms()) drive_.unconfirmed(fmt::format("{} has an error and its code cannot be read", name()), t);
        return;
    }
    wanted_ = false;
    tries_ = 0;
    feedback().error_read();
    // With a line to all nobody says whose error it is: a fault is told, and the stop is judged by what is read.
    const bool ours = waits && ours_ && !(drive_.stops.sent_to_all() && is_fault_code(static_cast<int>(*code)));
    learn(static_cast<int>(*code), ours, t);
    if (!waits) return;
    const int keep = last_;
    if (!ours) last_ = 0;
    drive_.confirmed(t);
    if (last_ == 0) last_ = keep;
    if (!ours) drive_.program.reported_first(keep);
}

// --- the questions ---------------------------------------------------------------------------------------------------------------

std::string Feedback::poll_items(Instant now) {
    std::string s = R"(P,",",V,",",MV,MP,VC,DE,EF,BY)";
    if (has.encoder) s += ",ST";
    if (has.hmt) s += ",LR,AS";
    if (has.input) s += ",IF";
    // Only where it means something: LL is 0 or not measured in the other modes [L3872].
    asks_lag_ = (hmt_mode_ == 1 || hmt_mode_ == 2) && (lag_misses_ < 2 || now >= lag_again_);
    if (asks_lag_) s += R"(,",",LL)";
    return s;
}

void Feedback::poll_missed(Instant now) noexcept {
    if (!asks_lag_) return;
    lag_misses_ = std::min(lag_misses_ + 1, 2);
    lag_again_ = now + 10s;
}

std::string Feedback::value_items() const { return std::string(R"(VI,",",VM,",",A,",",D)") + (has.encoder ? R"(,",",EE)" : ""); }

void Feedback::learn_values(std::string_view data) {
    const auto f = split(data);
    if (f.size() != (has.encoder ? 5U : 4U)) return;
    const auto number = [&](std::size_t i) { return whole(f[i]).value_or(0); };
    const auto vi = number(0);
    const auto user_vi = vi != values.vi ? vi : values.user_vi;  // else it is as a slow move has left it
    values = {vi, user_vi, number(1), number(2), number(3), has.encoder && number(4) == 1};
    demand.knows({values.vi, values.vm, values.a, values.d, values.encoder});
}

void Feedback::learn_value(std::string_view word, std::int64_t value) noexcept {
    demand.value(word, value);
    if (word == "VI") values.vi = values.user_vi = value;
    if (word == "VM") values.vm = value;
    if (word == "A") values.a = value;
    if (word == "D") values.d = value;
    if (word == "EE") values.encoder = value == 1;
}

void Feedback::values_unknown() noexcept {
    values = {0, 0, 0, 0, 0, values.encoder};
    relearn = true;
}

bool Feedback::learn_poll(const std::string& data, Turn& t) {
    std::string bare = data;
    std::erase(bare, ' ');  // some drives print a blank in front of a number that is not negative (E-12)
    const auto f = split(bare);
    const std::size_t lr = 6U + (has.encoder ? 1U : 0U), as = lr + 1U;
    const std::size_t count = lr + (has.hmt ? 2U : 0U) + (has.input ? 1U : 0U);
    bool fits = f.size() == (asks_lag_ ? 4U : 3U) && f[2].size() == count;
    for (std::size_t i = 0; fits && i < count; ++i)
        fits = f[2][i] >= '0' && f[2][i] <= (has.hmt && i == as ? '3' : '1');
    const auto number = [&](std::size_t i) { return fits ? whole(f[i]) : std::nullopt; };
    const auto p = number(0), v = number(1), lag = asks_lag_ ? number(3) : std::nullopt;
    if (!p || !v || (asks_lag_ && !lag)) {
        poll_missed(t.now);
        ++drive_.bus.counters.garbled;
        return false;
    }
    const auto flag = [&](std::size_t i) { return f[2][i] == '1'; };
    const bool waited = flags_.input;
    read_at_ = std::min(received_at, t.now);
    fb_.position = *p;
    fb_.velocity = *v;
    flags_ = {
        flag(0), flag(1), flag(2), flag(3), flag(4), flag(5), has.encoder && flag(6), has.hmt && flag(lr), has.input && flag(count - 1)};
    hmt_mode_ = has.hmt ? f[2][as] - '0' : 0;
    if (flags_.by) prints_until_ = t.now + 2s;
    if (!flags_.mv) stopping_ = false;
    if (asks_lag_) lag_misses_ = 0;
    read_demand(lag);
    program_ran_ = program_ran_ || flags_.by;
    if (!flags_.by && std::exchange(program_ran_, false)) relearn = true;
    if (flags_.input && !waited) {
        // No poll can be the number: it begins with PR. What is sent as native text and begins with a digit or a sign is.
        note(Severity::info, "input", 0, fmt::format("{}: its program waits for a number (IV): send it as a native line", name()), t);
    }
    if (!std::exchange(seen_, true) && flags_.by) {
        note(Severity::info, "program", 0,
             fmt::format("{}: a program runs in it already: it is left alone; quick stop ends it, halt stops its motion only", name()), t);
    }
    // Each answer gives the line a pause. Who looks closely counts from the question, as long as the line is quicker than he.
    const Duration usual = drive_.bus.timing.poll_period, period = drive_.pace.period(usual);
    const Instant rhythm = read_at_ + period;
    drive_.poll.soon(period < usual && t.now <= rhythm ? rhythm : t.now + period);
    show(t);
    drive_.program.watch(t);
    drive_.jobs.watch(t);
    return true;
}

// --- what it is shown as ---------------------------------------------------------------------------------------------------------

void Feedback::derive() {
    const auto& [mv, mp, vc, de, ef, by, stalled, locked, input] = flags_;
    const Errors& errors = drive_.errors;
    if (!de) enabled_ = false;
    fb_.power = de && enabled_ ? AxisFeedback::Power::on : AxisFeedback::Power::off;
    // In torque mode V reads 0 whatever the shaft does [L5995].
    fb_.moving = mv && (fb_.velocity != 0 || vc || encoder_mode() || torque() || motion_.kind == Motion::Kind::home);
    fb_.fault = errors.fault() != 0 || stalled || locked;
    fb_.error_code = static_cast<std::uint16_t>(errors.fault() != 0 ? errors.fault() : stalled ? 86 : locked ? 104 : errors.last());
    fb_.safe_stop = errors.stopped_by_input();
    fb_.internal_limit = errors.last() == 83 || errors.last() == 84;
    fb_.warning = errors.last() == 71 || fb_.internal_limit;
    fb_.native_status = 0;
    for (std::uint32_t bit = 1; const bool f : {mv, mp, vc, de, ef, by, stalled, locked, input}) {
        if (f) fb_.native_status |= bit;
        bit <<= 1;
    }
    if (motion_.ended) {
        if (fb_.moving) fb_.target_reached = false;  // a program, or somebody else, moves it
        return;
    }
    // MV may show a motion late: at rest before that it has not ended, unless it is where it was sent.
    motion_.shown = motion_.shown || mv;
    const bool may_end = motion_.shown || read_at_ >= motion_.until;
    if (motion_.kind == Motion::Kind::position && !fb_.moving && !(encoder_mode() && mv)) {
        const bool near = may_end && encoder_mode() && !fb_.fault && !ef && std::llabs(fb_.position - motion_.target) <= 65000;
        if (fb_.position == motion_.target || near) fb_.target_reached = motion_.ended = true;
        if (!mv && may_end) motion_.ended = true;
    } else if (motion_.kind == Motion::Kind::home && !mv && may_end) {
        motion_.ended = true;
        if (ef || fb_.fault)
            fb_.homing_error = true;
        else
            zero_after_home_ = zero_wanted_ = true;
    }
}

void Feedback::emit(Turn& t) {
    if (drive_.axis() == no_axis || !seen_) return;
    fb_.at = read_at_;  // what an acknowledgement or an error code adds is newer
    fb_.homing = motion_.kind == Motion::Kind::home && (!motion_.ended || zero_after_home_);
    // A halt and a quick stop are SL 0, which brakes with D [L861, L4110]. A program may set others while it runs: read behind it.
    fb_.rates = relearn || flags_.by || program_ran_ ? DriveRates{} : DriveRates{values.vm, values.a, values.d, values.d};
    fb_.course = course();
    t.out.feedback.push_back({drive_.axis(), fb_});
    if (fb_.power != AxisFeedback::Power::on) {
        // DE is 1 from the factory: as long as this gateway has not enabled it the axis is shown as off, and nobody wants it anywhere.
        AxisFeedback& shown = t.out.feedback.back().value;
        shown.demand_source = DemandSource::none;
        shown.position_demand = shown.position;
    }
}

/// What was ordered and acknowledged; else what MP says, "moving to position": MV without it is a slew.
Course Feedback::course() const noexcept {
    using Kind = Motion::Kind;
    if (torque()) return Course::endless;
    if (!motion_.ended && motion_.kind == Kind::velocity) return Course::endless;
    if (flags_.mp || (!motion_.ended && motion_.kind == Kind::position)) return Course::to_target;
    if (motion_.kind == Kind::home && !motion_.ended) return Course::unknown;
    return flags_.mv && (fb_.velocity != 0 || flags_.vc) ? Course::endless : Course::unknown;
}

void Feedback::show(Turn& t) {
    derive();
    emit(t);
}

bool Feedback::goes() const noexcept {
    const bool homes = motion_.kind == Motion::Kind::home && !motion_.ended;
    return torque() || homes || (!stopping_ && (fb_.velocity != 0 || flags_.vc));
}

/// Bridges that a fault has switched off hold nothing, although DE is 1 [L3983, L8452].
void Feedback::read_demand(std::optional<std::int64_t> lag) {
    constexpr std::array off{13, 14, 72, 75, 79, 96};
    const bool bridges_off = (flags_.locked && !torque()) || std::ranges::find(off, drive_.errors.fault()) != off.end();
    if (has.old_firmware && demand.wants_shape()) demand.shape(true);
    demand.read({.at = received_at,
                 .position = fb_.position,
                 .velocity = fb_.velocity,
                 .lag = lag,
                 .hmt = hmt_mode_,
                 .energised = flags_.de && !bridges_off,
                 .moving = flags_.mv,
                 .changing = flags_.vc,
                 .stalled = flags_.stalled,
                 .program = flags_.by,
                 .homing = motion_.kind == Motion::Kind::home && !motion_.ended},
                fb_);
}

void Feedback::demand_lost() noexcept {
    demand.lost();
    fb_.demand_source = DemandSource::none;
    hmt_mode_ = 0;
    shape_refused = program_ran_ = false;
}

// --- what has happened to it -----------------------------------------------------------------------------------------------------

void Feedback::found() noexcept {
    enabled_ = seen_ = false;
    motion_ = {};
    fb_.target_reached = fb_.homing_error = false;
    demand_lost();
    demand.knows({values.vi, values.vm, values.a, values.d, values.encoder});
}

void Feedback::lost() noexcept {
    enabled_ = false;
    fb_.referenced = fb_.homing_attained = false;
    motion_ = {};
    no_zero();
    demand_lost();
}

void Feedback::line_lost() noexcept {
    seen_ = enabled_ = false;
    no_zero();
    demand_lost();
}

void Feedback::restarted(Turn& t) {
    lost();
    fb_.target_reached = false;
    show(t);
}

void Feedback::powered(Turn& t) {
    enabled_ = flags_.de;
    show(t);
}

/// Before the acknowledgement of the command is told: the old "reached" must not stand for the new target.
void Feedback::began(Motion motion, Turn& t) {
    motion_ = motion;
    motion_.until = t.now + Verb::shows_within;
    motion_.shown = flags_.mv;
    stopping_ = false;
    drive_.errors.clear_last();
    if (motion.kind == Motion::Kind::home) fb_.homing_attained = fb_.homing_error = fb_.referenced = false;
    fb_.target_reached = fb_.internal_limit = false;
    emit(t);
    derive();
}

void Feedback::homed(bool here, Turn& t) {
    fb_.referenced = true;
    if (here || zero_after_home_) {
        fb_.homing_attained = fb_.target_reached = true;
        fb_.homing_error = false;
    }
    no_zero();
    show(t);
}

void Feedback::stopped(bool power_off, Turn& t) {
    fb_.target_reached = false;
    motion_.ended = stopping_ = true;
    if (power_off) enabled_ = false;
    show(t);
}

}  // namespace axisgate::mcode
