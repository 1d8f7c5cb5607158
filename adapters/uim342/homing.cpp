// Drive, part homing: the search for a switch (CiA 402 methods 17 to 22), built from the drive's own input actions.
// In: the method, the options home_input, home_active, home_velocity, the level of the input, the standing still of the axis.
// Out: TG[i]=60001 (one time) and IL[i] with "stop" or "origin, then stop", JV and BG; in the end the settings of before.
// The drive itself sets the origin within 1 ms of the edge; nothing here is on the way between the switch and the zero.
// Never writes to EEPROM: every SET is done with the driver on [L1632, L1667], and what was changed is put back.
#include <fmt/core.h>

#include "adapters/uim342/drive.hpp"
#include "adapters/uim342/native.hpp"

namespace axisgate::uim342 {
namespace {
constexpr std::uint16_t one_time = 60001;                                            // [L1653]
constexpr std::uint8_t edge_none = 0x80, edge_stop = 0x83, edge_origin_stop = 0x86;  // FG = 1: not at power-on
constexpr Duration start_limit = std::chrono::milliseconds(500);

struct Method {
    int direction;  ///< of the final move
    bool entering;  ///< the final edge: the switch becomes active; else it becomes inactive
};
// IEC 61800-7-201, methods 17 to 22: 1 to 6 without the index pulse.
constexpr Method method_of(int m) {
    switch (m) {
        case 17:
            return {+1, false};  // negative limit switch, left in the positive direction
        case 18:
            return {-1, false};  // positive limit switch, left in the negative direction
        case 19:
            return {-1, false};  // home switch on the positive side, edge while leaving
        case 20:
            return {+1, true};  // ... while entering
        case 21:
            return {+1, false};  // home switch on the negative side, edge while leaving
        default:
            return {-1, true};  // 22: ... while entering
    }
}
}  // namespace

bool Drive::switch_active() const noexcept {
    const bool level = options_.home_input == 1 ? status_.in1 : options_.home_input == 2 ? status_.in2 : status_.in3;
    return level == options_.home_high;
}

/// MF of an edge of the home input: IN1 rising 2, falling 3, IN2 4, 5, IN3 6, 7 [L1306-1315].
std::uint8_t Drive::edge_group(bool rising) const noexcept { return static_cast<std::uint8_t>(options_.home_input * 2 + (rising ? 0 : 1)); }

void Drive::plan_search(std::int16_t method, Turn& t) {
    if (options_.home_input == 0 || options_.home_velocity == 0) {
        return refuse_job(Reason::not_supported,
                          fmt::format("homing method {} needs the drive's options home_input (1..3) and home_velocity (pulse/s); "
                                      "35 and 37 call the present position 0",
                                      method),
                          t);
    }
    if (!status_.on) return refuse_job(Reason::wrong_state, "the driver is off: enable the axis first", t);
    if (fb_.moving) return refuse_job(Reason::wrong_state, "the axis moves: stop it first", t);
    if (!dc_) return refuse_job(Reason::wrong_state, "DC is not known yet, and the stop at the switch needs it: try again", t);
    if (time_ramps_ != false) {
        return refuse_job(Reason::not_supported, "with AC and DC as times (IC[4] = 1) the ramp of the stop at the switch is not defined",
                          t);
    }
    const Method m = method_of(method);
    search_ = {};
    search_.stage = Search::Stage::save;
    search_.command = job_.command;
    job_.command.ticket = no_ticket;
    search_.direction = m.direction;
    search_.entering = m.entering;
    search_.give_up = t.now + options_.home_timeout;
    fb_.homing_attained = false;
    fb_.homing_error = false;
    if (restore_.pending) return search_next(t);  // an interrupted search: what is to be put back is known, and not what stands there now
    const auto i = static_cast<std::uint8_t>(options_.home_input - 1);
    job_.add(msg_get(cw::IL, i));
    job_.add(msg_get(cw::TG, i));
    for (const bool rising : {true, false}) {
        job_.add(msg_set(cw::MF, edge_group(rising)), 0, true);
        job_.add(msg_get(cw::DC), edge_group(rising));
    }
}

/// The present list of steps is through.
void Drive::search_next(Turn& t) {
    using Stage = Search::Stage;
    if (search_.stage == Stage::idle) return;
    // Where the final move must begin: outside the switch to enter it, inside to leave it.
    const bool may_begin = switch_active() != search_.entering;
    if (search_.stage == Stage::save) {
        if (!restore_.pending) {
            const auto i = static_cast<std::size_t>(options_.home_input - 1);
            restore_.pending = true;
            restore_.input = static_cast<std::uint8_t>(i);
            restore_.il = il_[i].value_or(0x8080);
            restore_.tg = tg_[i].value_or(0);
        }
        search_.stage = may_begin ? Stage::final : Stage::approach;
        return search_arm(t);
    }
    if (!search_.checking) {  // BG was acknowledged
        search_.running = true;
        job_.active = false;
        begin_motion(Motion{.kind = Motion::Kind::velocity}, t);
        forget_demand();  // the switch ends it, and may call the place 0
        if (!search_.command.until_done) {
            result(search_.command.ticket, Outcome::accepted, Reason::none, "", t);
            search_.command.ticket = no_ticket;
        }
        return;
    }
    search_.checking = false;
    const auto left = il_[restore_.input].value_or(0xFFFF);
    if ((left & 0x7F7F) != 0) {
        return search_over(false, Reason::interrupted,
                           fmt::format("the axis stopped at {} without the switch having changed", fb_.position), t);
    }
    if (search_.stage == Stage::approach) {
        if (!may_begin) {
            return search_over(
                false, Reason::interrupted,
                fmt::format("the switch has changed and gone back while the axis stopped at {}: approach it more slowly", fb_.position), t);
        }
        search_.stage = Stage::final;
        return search_arm(t);
    }
    search_over(true, Reason::none, "", t);
}

/// One move: the input is told what to do at the edge, then the axis is sent off.
void Drive::search_arm(Turn& t) {
    using Stage = Search::Stage;
    const bool final = search_.stage == Stage::final;
    const bool to_active = final ? search_.entering : !search_.entering;
    const bool rising = to_active == options_.home_high;
    const int direction = final ? search_.direction : -search_.direction;
    const std::uint8_t action = final ? edge_origin_stop : edge_stop;
    const auto i = restore_.input;
    job_.restep();
    job_.add(msg_set(cw::TG, one_time, i));
    job_.add(msg_set(cw::IL, rising ? edge_none | action << 8 : action | edge_none << 8, i));
    job_.add(msg_set(cw::MF, edge_group(rising)), 0, true);
    job_.add(msg_set(cw::DC, *dc_), edge_group(rising));
    job_.add(msg_set(cw::JV, static_cast<std::int64_t>(direction) * options_.home_velocity));
    job_.add(msg_act(cw::BG));
    run_job(t);
}

/// Called with every status: has the move come to its end?
void Drive::search_status(Turn& t) {
    if (!search_.running) return;
    if (fb_.fault || !status_.on) {
        return search_over(
            false, Reason::interrupted,
            fb_.fault ? fmt::format("a fault ended it (drive's code 0x{:02X})", fb_.error_code) : std::string("the driver is off"), t);
    }
    if (!status_.stop || (!motion_.seen_moving && t.now - motion_.begun < start_limit)) return;
    search_.running = false;
    search_.check_due = true;
}

void Drive::search_check(Turn& t) {
    search_.check_due = false;
    search_.checking = true;
    begin_job(JobKind::search, Command{no_ticket, axis_, search_.command.body, false, {}});
    job_.add(msg_get(cw::IL, restore_.input));
    job_.add(msg_get(cw::MS, 1));  // where it stands, read behind its standstill: the end is told with it
    run_job(t);
}

/// Whether the next command of the queue may begin: during a search only values are read.
bool Drive::queue_ready() const noexcept {
    if (queue_.empty() || job_.active) return false;
    return !searching() || (search_.running && std::holds_alternative<ReadParameter>(queue_.front().body));
}

void Drive::search_deadline(Turn& t) {
    search_.give_up = never;
    const bool moving = search_.running;
    search_over(false, Reason::interrupted,
                fmt::format("the switch was not found within {} s", milliseconds_of(options_.home_timeout) / 1000), t);
    if (!moving) return;
    Stop s;
    s.by_supervision = true;
    add_stop(s, t);
}

void Drive::search_over(bool good, Reason reason, std::string text, Turn& t) {
    if (job_.active && job_.kind == JobKind::search) {
        abandon_job_exchange();
        job_.active = false;
    }
    const Ticket ticket = search_.command.ticket;
    search_ = {};
    if (good) {
        fb_.referenced = fb_.homing_attained = true;
    } else {
        fb_.homing_error = true;
        if (ticket == no_ticket) notice(Severity::warning, "homing", 0, "homing failed: " + text, t);
    }
    emit(t);
    result(ticket, good ? Outcome::done : Outcome::failed, reason, std::move(text), t);
}

// --- putting back ----------------------------------------------------------------------------------------------------------------

/// Only with the driver on, so that it stays in RAM; until then the armed input is harmless, because nothing moves.
bool Drive::restore_due() const noexcept {
    return restore_.pending && presence_.is(Phase::ready) && status_.on && !job_.active && !fb_.moving && !searching();
}

void Drive::plan_restore(Turn& t) {
    begin_job(JobKind::restore, Command{no_ticket, axis_, ReadParameter{}, false, {}});
    const auto i = restore_.input;
    job_.add(msg_set(cw::TG, restore_.tg, i));
    job_.add(msg_set(cw::IL, restore_.il, i));
    const auto group = [&](bool rising) { return static_cast<std::uint8_t>((i + 1) * 2 + (rising ? 0 : 1)); };
    if (restore_.dc_rising != 0) {
        job_.add(msg_set(cw::MF, group(true)), 0, true);
        job_.add(msg_set(cw::DC, restore_.dc_rising), group(true));
    }
    if (restore_.dc_falling != 0) {
        job_.add(msg_set(cw::MF, group(false)), 0, true);
        job_.add(msg_set(cw::DC, restore_.dc_falling), group(false));
    }
    run_job(t);
}

}  // namespace axisgate::uim342
