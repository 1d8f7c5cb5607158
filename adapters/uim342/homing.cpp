// Homing and Origin: the zero by a switch, or where the axis stands.
// In: Home, SetPosition; statuses during a search. Out: steps, the result of the search, what is put back behind it.
// Never calls a search done before the drive said that its input has done its work.
#include "adapters/uim342/homing.hpp"

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

/// MF of an edge of input 0..2: IN1 rising 2, falling 3, IN2 4, 5, IN3 6, 7 [L1306-1315].
constexpr std::uint8_t edge_group(std::uint8_t input, bool rising) { return static_cast<std::uint8_t>((input + 1) * 2 + (rising ? 0 : 1)); }
}  // namespace

// --- where it stands -------------------------------------------------------------------------------------------------------------

void Origin::plan(const Command& command, Turn& t) {
    const auto* home = std::get_if<Home>(&command.body);
    if (!home && std::get<SetPosition>(command.body).position != 0)
        return refuse(Reason::not_supported, "the drive's only instruction for it is OG, which calls the present position 0", t);
    if (!home) return job().add(drive_.act(cw::OG));
    const int m = home->method;
    if (m == 0 || m == 35 || m == 37) {
        drive_.feedback.homing_begins();
        return job().add(drive_.act(cw::OG));
    }
    std::string_view why = "unknown";
    if (m >= 23 && m <= 30) why = "the drive cannot turn round at a limit switch by itself; methods 17 to 22 use one switch";
    if ((m >= 1 && m <= 14) || m == 33 || m == 34) why = "the drive has no instruction for the index pulse of the encoder";
    refuse(Reason::not_supported, fmt::format("homing method {}: {}; 35 and 37 call the present position 0", m, why), t);
}

void Origin::done(Turn& t) {
    drive_.feedback.origin_set(std::holds_alternative<Home>(job().command.body), t);
    accept("", t);
}

// --- the search ------------------------------------------------------------------------------------------------------------------

bool Homing::switch_active() const noexcept {
    const Status& s = drive_.feedback.status();
    const int input = drive_.options.home_input;
    return (input == 1 ? s.in1 : input == 2 ? s.in2 : s.in3) == drive_.options.home_high;
}

void Homing::plan(const Command& command, Turn& t) {
    const DriveOptions& o = drive_.options;
    const Known::Ram& ram = drive_.known.ram;
    const int method = std::get<Home>(command.body).method;
    if (o.home_input == 0 || o.home_velocity == 0) {
        return refuse(Reason::not_supported,
                      fmt::format("homing method {} needs the drive's options home_input (1..3) and home_velocity (pulse/s); "
                                  "35 and 37 call the present position 0",
                                  method),
                      t);
    }
    if (!drive_.feedback.status().on) return refuse(Reason::wrong_state, "the driver is off: enable the axis first", t);
    if (drive_.feedback.fb().moving) return refuse(Reason::wrong_state, "the axis moves: stop it first", t);
    if (!ram.dc) return refuse(Reason::wrong_state, "DC is not known yet, and the stop at the switch needs it: try again", t);
    if (ram.time_ramps != false)
        return refuse(Reason::not_supported, "with AC and DC as times (IC[4] = 1) the ramp of the stop at the switch is not defined", t);
    const Method m = method_of(method);
    search_ = {};
    search_.stage = Stage::save;
    search_.command = command;
    job().exact = true;
    job().command.ticket = no_ticket;
    search_.direction = m.direction;
    search_.entering = m.entering;
    search_.give_up = t.now + o.home_timeout;
    drive_.feedback.homing_begins();
    if (changed_.pending) return next(t);  // an interrupted search: what is to be put back is known, and not what stands there now
    const auto i = static_cast<std::uint8_t>(o.home_input - 1);
    job().add(drive_.get(cw::IL, i));
    job().add(drive_.get(cw::TG, i));
    for (const bool rising : {true, false})
        job().add_grouped(drive_.set(cw::MF, edge_group(i, rising)), drive_.get(cw::DC), edge_group(i, rising));
}

void Homing::answered(const Step& step, const Message* m, Turn&) {
    if (search_.stage != Stage::save || step.mf == 0) return;
    const auto dc = static_cast<std::uint32_t>(value_of(step.message, *m).value_or(0));
    (step.mf % 2 == 0 ? changed_.dc_rising : changed_.dc_falling) = dc;
}

void Homing::failed(const Step& step, Failure how, Turn& t) {
    searching() ? over(false, how.reason, std::move(how.text), t) : Verb::failed(step, std::move(how), t);
}

void Homing::done(Turn& t) {
    if (searching()) return next(t);
    nothing_to_put_back();  // it has been put back
    (void)drive_.jobs.hand_over();
}

/// The present list of steps is through.
void Homing::next(Turn& t) {
    // Where the final move must begin: outside the switch to enter it, inside to leave it.
    const bool may_begin = switch_active() != search_.entering;
    const Known::Ram& ram = drive_.known.ram;
    if (search_.stage == Stage::save) {
        if (!changed_.pending) {
            changed_.pending = true;
            changed_.input = static_cast<std::uint8_t>(drive_.options.home_input - 1);
            changed_.il = ram.il[changed_.input].value_or(0x8080);
            changed_.tg = ram.tg[changed_.input].value_or(0);
        }
        search_.stage = may_begin ? Stage::final : Stage::approach;
        return arm(t);
    }
    if (!search_.checking) return begun(t);
    search_.checking = false;
    const std::int64_t here = drive_.feedback.fb().position;
    if ((ram.il[changed_.input].value_or(0xFFFF) & 0x7F7F) != 0)
        return over(false, Reason::interrupted, fmt::format("the axis stopped at {} without the switch having changed", here), t);
    if (search_.stage == Stage::final) return over(true, Reason::none, "", t);
    if (!may_begin) {
        return over(false, Reason::interrupted,
                    fmt::format("the switch has changed and gone back while the axis stopped at {}: approach it more slowly", here), t);
    }
    search_.stage = Stage::final;
    arm(t);
}

/// BG was acknowledged.
void Homing::begun(Turn& t) {
    search_.running = true;
    (void)drive_.jobs.hand_over();
    drive_.feedback.begin_motion({Motion::Kind::velocity}, t);
    drive_.demand.forget();  // the switch ends it, and may call the place 0
    drive_.tickets.accepted(std::exchange(search_.command.ticket, no_ticket), t.out);
}

/// One move: the input is told what to do at the edge, then the axis is sent off.
void Homing::arm(Turn& t) {
    const bool final = search_.stage == Stage::final;
    const bool to_active = final ? search_.entering : !search_.entering;
    const bool rising = to_active == drive_.options.home_high;
    const std::int64_t direction = final ? search_.direction : -search_.direction;
    const std::uint8_t action = final ? edge_origin_stop : edge_stop;
    const auto i = changed_.input;
    Job& j = job();
    j.restep();
    j.add(drive_.set(cw::TG, one_time, i));
    j.add(drive_.set(cw::IL, rising ? edge_none | action << 8 : action | edge_none << 8, i));
    j.add_grouped(drive_.set(cw::MF, edge_group(i, rising)), drive_.set(cw::DC, *drive_.known.ram.dc), edge_group(i, rising));
    j.add(drive_.set(cw::JV, direction * drive_.options.home_velocity));
    j.add(drive_.act(cw::BG));
    drive_.jobs.run(t);
}

/// Called with every status: has the move come to its end?
void Homing::on_status(Turn& t) {
    if (!search_.running) return;
    const AxisFeedback& fb = drive_.feedback.fb();
    const Status& s = drive_.feedback.status();
    const Motion& motion = drive_.feedback.motion();
    if (fb.fault || !s.on) {
        return over(false, Reason::interrupted,
                    fb.fault ? fmt::format("a fault ended it (drive's code 0x{:02X})", fb.error_code) : std::string("the driver is off"),
                    t);
    }
    if (!s.stop || (!motion.seen_moving && t.now - motion.begun < start_limit)) return;
    search_.running = false;
    search_.check_due = true;
}

void Homing::check(Turn& t) {
    search_.check_due = false;
    search_.checking = true;
    Job& j = drive_.jobs.begin_own(*this, search_.command.body);
    j.exact = true;
    j.add(drive_.get(cw::IL, changed_.input));
    j.add(drive_.get(cw::MS, 1));  // where it stands, read behind its standstill: the end is told with it
    drive_.jobs.run(t);
}

void Homing::on_deadline(Turn& t) {
    if (t.now < search_.give_up) return;
    const bool moving = search_.running;
    over(false, Reason::interrupted,
         fmt::format("the switch was not found within {} s", milliseconds_of(drive_.options.home_timeout) / 1000), t);
    if (moving) drive_.stops.enforce(t);
}

void Homing::over(bool good, Reason reason, std::string text, Turn& t) {
    if (drive_.jobs.is(*this)) {
        drive_.exchanges.abandon_job();
        (void)drive_.jobs.hand_over();
    }
    const Ticket ticket = search_.command.ticket;
    search_ = {};
    if (!good && ticket == no_ticket) drive_.notice(Severity::warning, "homing", 0, "homing failed: " + text, t);
    drive_.feedback.homing_ended(good, t);
    (void)drive_.tickets.answer(ticket, good ? Outcome::done : Outcome::failed, reason, std::move(text), t.out);
}

// --- putting back ----------------------------------------------------------------------------------------------------------------

/// Only with the driver on, so that it stays in RAM; until then the armed input is harmless, because nothing moves.
bool Homing::put_back_due() const noexcept {
    return changed_.pending && drive_.presence.is(drive::Presence::Phase::ready) && drive_.feedback.status().on && drive_.jobs.idle() &&
           !drive_.feedback.fb().moving && !searching();
}

void Homing::put_back(Turn& t) {
    Job& j = drive_.jobs.begin_own(*this, ReadParameter{});
    const auto i = changed_.input;
    j.add(drive_.set(cw::TG, changed_.tg, i));
    j.add(drive_.set(cw::IL, changed_.il, i));
    for (const bool rising : {true, false}) {
        if (const auto dc = rising ? changed_.dc_rising : changed_.dc_falling; dc != 0)
            j.add_grouped(drive_.set(cw::MF, edge_group(i, rising)), drive_.set(cw::DC, dc), edge_group(i, rising));
    }
    drive_.jobs.run(t);
}

}  // namespace axisgate::uim342
