// PID controller and mechanics are one lag that decreases with KPROP: plausible, not measured (E-17).
#include "adapters/aposs/twin/axis.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/cia402/twin/homing.hpp"

namespace axisgate::aposs {
namespace {
using cia402_drive::twin::State;
constexpr std::int64_t mlong = 1'073'741'823;
constexpr std::int64_t corrected_readings = 100;  ///< of ENCODERTYPE 3 and 4, one each ms
constexpr double lag_of_gain = 60;                ///< ms of lag of the shaft with KPROP 1
double real(std::int64_t v) { return static_cast<double>(v); }
}  // namespace

MacsAxis::MacsAxis(const Objects& objects, canopen::Dictionary& dictionary, Terminals& terminals, int axis, double travel,
                   const Manners& manners)
    : machine(manners, axis),
      objects_(objects),
      d_(dictionary),
      terminals_(terminals),
      axis_(axis),
      base_(static_cast<std::uint16_t>(per_axis * axis)),
      travel_(travel),
      servo_(dictionary, travel, static_cast<std::uint16_t>(per_axis * axis)),
      hysteresis_(manners.switch_hysteresis) {
    servo_.set_watch(std::chrono::milliseconds(20 * axes));  // the axes are checked in turn, every 20 ms [L6010]
}

std::int64_t MacsAxis::value(std::string_view id) const {
    const Row* row = objects_.named(id, axis_);
    return row ? d_.integer(row->address).value_or(row->initial) : 0;
}
void MacsAxis::set(std::string_view id, std::int64_t v) {
    const Row* row = objects_.named(id, axis_);
    if (row && d_.integer(row->address) != v) (void)d_.set(row->address, Value{v});
}
void MacsAxis::put(std::uint16_t index, std::uint8_t sub, double v) {
    const auto whole = std::clamp<std::int64_t>(std::llround(v), -mlong, mlong);
    (void)d_.set({static_cast<std::uint16_t>(index + base_), sub}, Value{whole});
}

void MacsAxis::power_on(Instant now) {
    homed_ = braked_ = hot_ = false;
    violated_ = 0;
    homing_.stop();
    current_ = {};
    jump_.readings = jump_.count = 0;
    settle(true);
    machine.follow(servo_.shaft(), servo_.powered(), now);
    servo_.power_on(now);
    encoder_zero_ = servo_.units().zero();
}

void MacsAxis::settle(bool defaults) {
    const auto real_of = [&](std::string_view id) { return real(value(id)); };
    const auto encoder = encoder_of(value("ENCODERTYPE"), false).value_or(EncoderCode{});
    const double per_turn = real_of("ENCODER") * (encoder.absolute() ? 1 : 4);
    const double ramp = std::max(1.0, real_of("RAMPMIN")), res = std::max(1.0, real_of("VELRES"));
    const double velocity = std::max(1.0, real_of("VELMAX") * per_turn / 60), acceleration = std::max(1.0, velocity / ramp * 1000);
    // Integers, truncated (E-70).
    const auto qc = static_cast<std::int64_t>(real_of("VELMAX") * per_turn * 65536 / 60000);
    set("VELMAXQC", std::clamp<std::int64_t>(qc, 1, mlong));
    set("ACCMAXQC", std::clamp<std::int64_t>(qc / static_cast<std::int64_t>(ramp), 1, mlong));

    // User units: qc = UU * FEEDREV * POSFACT_Z * POSENCQC / (FEEDDIST * POSFACT_N * POSENCREV) [L6037-6140]; a sign of POSDRCT inverts
    // user units and nothing in qc.
    put(0x608F, 1, real_of("POSENCQC")), put(0x608F, 2, real_of("POSENCREV"));
    put(0x6091, 1, real_of("POSFACT_Z")), put(0x6091, 2, real_of("POSFACT_N"));
    put(0x6092, 1, real_of("FEEDDIST")), put(0x6092, 2, real_of("FEEDREV"));
    put(0x607E, 0, direction_of(value("POSDRCT")).value_or(DirectionCode{}).units_inverse ? 0xC0 : 0);
    servo_.units().read();
    const double unit = std::fabs(servo_.units().way_in_units(1));  // UU of one qc

    put(0x607F, 0, std::max(1.0, velocity * unit));
    put(0x6080, 0, std::max(1.0, velocity * unit));
    for (const std::uint16_t index : std::initializer_list<std::uint16_t>{0x60C5, 0x60C6, 0x6085})
        put(index, 0, std::max(1.0, acceleration * unit));
    if (defaults) {
        put(0x6081, 0, velocity * unit * real_of("DFLTVEL") / res);
        put(0x6083, 0, std::max(1.0, acceleration * unit * real_of("DFLTACC") / res));
        put(0x6084, 0, std::max(1.0, acceleration * unit * real_of("DFLTACC") / res));
    }
    // Shape of the ramps. A jerk is the maximum acceleration divided by a number of ms; 0 means that of JERKMIN [L5640-5690]. The motion in
    // progress does not change; the next motion command uses the new values.
    const auto type = value("RAMPTYPE");
    const double jerk = real_of("JERKMIN");
    put(0x6086, 0, type == 1 ? 1 : type == 2 && jerk > 0 ? 3 : 0);
    put(0x60A3, 0, 4);
    std::uint8_t sub = 0;
    for (const char* id : {"JERKMIN", "JERKMIN2", "JERKMIN3", "JERKMIN4"}) {
        const double ms = real_of(id) > 0 ? real_of(id) : jerk;
        put(0x60A4, ++sub, ms > 0 ? std::max(1.0, acceleration * unit * 1000 / ms) : 0);
    }

    const double home = std::max(1.0, velocity * unit * std::fabs(real_of("HOME_VEL")) / res);
    put(0x6099, 1, home);
    put(0x6099, 2, std::max(1.0, home / 4));  // a choice: the fraction is not printed (E-18)
    put(0x609A, 0, std::max(1.0, acceleration * unit * std::min(real_of("HOME_RAMP"), real_of("DFLTACC")) / res));
    put(0x607C, 0, real_of("HOME_OFFSET") * unit);
    put(0x6065, 0, real_of("POSERR") * unit);
    put(0x6066, 0, real_of("POSERRTIME"));
    // TESTWIN 0: the target is reached when the command position is there [L2050].
    const auto window = value("TESTWIN");
    (void)d_.set({static_cast<std::uint16_t>(0x6067 + base_), 0},
                 Value{window == 0 ? std::int64_t{0xFFFFFFFF} : static_cast<std::int64_t>(std::llround(real(window) * unit))});
    put(0x6068, 0, window == 0 ? 0 : real_of("TESTTIM"));
    // With TESTVAL two readings with the interval TESTTIM; without it the time within the window, as in CANopen [L2050-2077, L2856-2900].
    const bool reads = window > 0 && value("TESTTIM") > 0 && value("TESTVAL") > 0;
    servo_.reach_by_readings(reads ? std::optional(real_of("TESTVAL")) : std::nullopt);
    const auto condition = value("ERRCOND");
    put(0x605E, 0, condition <= 1 ? 0 : condition == 4 ? 1 : 2);

    const double gain = lag_of_gain / std::max(1.0, real_of("KPROP")), band = 1000 / std::max(1.0, real_of("BANDWIDTH"));
    const double forward = std::max(0.0, 1 - real_of("FFVEL") / 1000);
    const double integral = value("KINT") > 0 && value("KILIM") > 0 && value("KILIMTIME") >= 0 ? 0.5 : 1;
    servo_.shaft().set_lag(encoder.source == Encoder::simulation ? 0 : gain * band * forward * integral / 1000);
}

SyncParameters MacsAxis::sync_parameters() const {
    SyncParameters p;
    p.fact_m = value("SYNCFACTM"), p.fact_s = value("SYNCFACTS");
    if (p.fact_m == 0) p.fact_m = 1;
    if (direction_of(value("POSDRCT")).value_or(DirectionCode{}).units_inverse) p.fact_m = -p.fact_m;  // all sync factors [L3227]
    p.offset = value("SYNCPOSOFFS"), p.accuracy = value("SYNCACCURACY"), p.ready = value("SYNCREADY"), p.fault = value("SYNCFAULT");
    p.pulse_m = value("SYNCMPULSM"), p.pulse_s = value("SYNCMPULSS"), p.window_m = value("SYNCMWINM"), p.window_s = value("SYNCMWINS");
    p.mark_m = value("SYNCMARKM"), p.mark_s = value("SYNCMARKS"), p.start = value("SYNCMSTART");
    p.offset_time = value("SYNCOFFTIME"), p.filter_time = value("SYNCMFTIME"), p.filter_par = value("SYNCMFPAR");
    p.slave_filter_time = value("SYNCSFTIME"), p.most_correction = value("SYNCMMAXCORR");
    p.velocity_time = value("SYNCVFTIME"), p.velocity_limit = value("SYNCVFLIMIT"), p.velocity_relation = value("SYNCVELREL");
    p.feed_forward = value("SYNCFFVEL"), p.type = value("SYNCTYPE"), p.resolution = value("MENCODER");
    p.reverse = revers_of(value("REVERS")).value_or(ReversCode{}).mode;
    const auto ramps = servo_.units().ramps();  // VEL, ACC, DEC; the shape of the ramps does not apply to SYNCx [L3345]
    p.velocity = ramps.velocity / 1000;
    p.acceleration = ramps.up / 1e6, p.deceleration = ramps.down / 1e6;
    if (const auto ms = value("JERKMIN"); ms > 0)  // the maximum acceleration divided by this number of ms [L5640]
        p.jerk = real(value("ACCMAXQC")) / 65536 / real(ms);
    return p;
}

double MacsAxis::limit_place(bool positive) const { return servo_.units().zero() + real(value(positive ? "POSLIMIT" : "NEGLIMIT")); }
bool MacsAxis::outside(bool positive, double place) const {
    if (value(positive ? "SWPOSLIMACT" : "SWNEGLIMACT") == 0) return false;
    return positive ? place > limit_place(true) + 1e-6 : place < limit_place(false) - 1e-6;
}

std::uint16_t MacsAxis::forbids(double direction, Instant now) const {
    if (homing_due()) return homing_wanted;
    if (direction == 0) return 0;
    const bool positive = direction > 0;
    const double place = servo_.shaft().demand(now).position;
    if (violated_ == (positive ? 1 : -1) && (outside(positive, place) || at_switch_[positive ? 1 : 0])) return limit_violated;
    return at_switch_[positive ? 1 : 0] || outside(positive, place) ? end_limit : std::uint16_t{0};
}

bool MacsAxis::written(canopen::Address a, Instant now) {
    const auto index = static_cast<std::uint16_t>(a.index - base_);
    bool ends = false;
    std::uint16_t refused = 0;
    if (index == 0x6040) {
        const auto cw = static_cast<unsigned>(of(0x6040));
        const bool starts = (cw & 0x1Fu) == 0x1Fu && of(0x6060) == 1;
        ends = (cw & 0x10Fu) != 0x0Fu || starts;
        if (servo_.state() == State::fault && (cw & 0x80u) && !may_clear_error())  // error 99 persists as long as its cause (E-64)
            (void)d_.set({static_cast<std::uint16_t>(0x6040 + base_), 0}, Value{static_cast<std::int64_t>(cw & ~0x80u)});
        if (starts) {
            start_positioning(cw, now);
            after(now);
            return ends;
        }
    }
    if (index == 0x6040 || index == 0x6060 || index == 0x60FF) refused = speed_refused(now);
    servo_.written(a, now);
    if (refused != 0 && servo_.takes_orders()) raise(refused, now);
    after(now);
    return ends;
}

/// The set-point is ignored: a positioning outside the limits does not start [L2642], and none without homing [L1880].
void MacsAxis::start_positioning(unsigned cw, Instant now) {
    const double here = servo_.shaft().demand(now).position;
    double target = servo_.units().place_of(0x607A);
    if (cw & 0x40u) target += here - servo_.units().zero();
    std::uint16_t refused = forbids(target - here, now);
    const bool further = (target > here && outside(true, target)) || (target < here && outside(false, target));
    const bool beyond = outside(true, target) || outside(false, target);
    if (refused == 0 && beyond && (violated_ == 0 || further)) refused = end_limit;
    // Without reversing, a way back ends where it begins (E-59).
    const int mode = revers_of(value("REVERS")).value_or(ReversCode{}).mode;
    const bool back = refused == 0 && mode != 0 && target < here - 0.5;
    if (refused != 0 || back) {
        cw &= ~0x10u;
        (void)d_.set({static_cast<std::uint16_t>(0x6040 + base_), 0}, Value{static_cast<std::int64_t>(cw)});
    }
    servo_.written({static_cast<std::uint16_t>(0x6040 + base_), 0}, now);
    if (refused != 0) raise(refused, now);
}
/// A speed that is not allowed is set to 0 before the servo receives it.
std::uint16_t MacsAxis::speed_refused(Instant now) {
    const auto v = of(0x60FF);
    if (of(0x6060) != 3 || v == 0) return 0;
    const double direction = servo_.units().velocity_of(0x60FF);
    const std::uint16_t refused = forbids(direction, now);
    const bool back = direction < 0 && revers_of(value("REVERS")).value_or(ReversCode{}).mode != 0;
    if (refused != 0 || back) put(0x60FF, 0, 0);
    return refused;
}

void MacsAxis::raise(std::uint16_t code, Instant now) {
    if (code == end_limit) {
        const double place = servo_.shaft().demand(now).position;
        if (outside(true, place) || at_switch_[1]) violated_ = 1;
        if (outside(false, place) || at_switch_[0]) violated_ = -1;
    }
    if (value("ERRCOND") == 5) {
        reported_.push_back({now, {code, 0x81, {}}});  // the control stays on, and the program's error routine decides [L3707]
        return;
    }
    servo_.fail(code, now);
    after(now);
}
/// Brake outputs: with ERRCOND 1 at once, with 3 at standstill; only OUT resets them [L3855].
void MacsAxis::after(Instant now) {
    const auto condition = value("ERRCOND");
    const bool fault = servo_.state() == State::fault, reacts = fault || servo_.state() == State::fault_reaction;
    if (!reacts) braked_ = false;
    if (!braked_ && ((condition == 1 && reacts) || (condition == 3 && fault))) {
        terminals_.set(value("O_BRAKE"), true);
        braked_ = true;
    }
    if (homing_.active() && !servo_.homing().led()) homing_.stop();
    if (servo_.homing().led() && !homing_.active()) {
        const auto encoder = encoder_of(value("ENCODERTYPE"), false).value_or(EncoderCode{});
        const bool possible = (value("I_REFSWITCH") != 0 || travel_ > 0 || servo_.home_switch) && !encoder.absolute();
        if (!possible) return servo_.homing_ended(std::nullopt);  // without a switch there is no search (E-76), [L2968]
        HomingParameters p;
        p.type = value("HOME_TYPE");
        p.velocity = servo_.units().speed_of(0x6099, 1) * (value("HOME_VEL") < 0 ? -1 : 1);
        if (direction_of(value("POSDRCT")).value_or(DirectionCode{}).units_inverse) p.velocity = -p.velocity;
        p.offset = real(value("HOME_OFFSET"));
        p.index_distance = std::max(1.0, real(value("ENCODER")) * 4);
        homing_order(homing_.begin(p, homing_input(now)), now);
    }
    if (servo_.homing().attained()) homed_ = true;
}

HomingInput MacsAxis::homing_input(Instant now) {
    const double place = this->place(now);
    in_cam_ = travel_ > 0 && std::fabs(place) < cia402_drive::twin::cam + (in_cam_ ? hysteresis_ : 0);
    return {place, servo_.home_switch || in_cam_ || terminals_.active(value("I_REFSWITCH")), index_pulses, !servo_.shaft().moves(now)};
}
void MacsAxis::homing_order(const HomingRun::Order& order, Instant now) {
    const double a = servo_.units().rate_of(0x609A);
    if (order.run) servo_.shaft().run(*order.run, {std::fabs(*order.run), a, a}, now);
    if (order.go) servo_.shaft().move(*order.go, {servo_.units().speed_of(0x6099, 1), a, a}, now);
    if (homing_.phase() == HomingRun::Phase::done) servo_.homing_ended(homing_.zero());
    if (homing_.phase() != HomingRun::Phase::index_missed) return;
    homing_.stop();
    if (servo_.homing().led()) servo_.homing_ended(std::nullopt);
    raise(index_missed, now);
}

void MacsAxis::inputs_changed(Instant now) {
    servo_.inputs = terminals_.inputs << 16;
    const double v = servo_.shaft().demand(now).velocity;
    for (const bool positive : {false, true}) {
        const bool is = (positive ? servo_.limit_positive : servo_.limit_negative) ||
                        terminals_.active(value(positive ? "I_POSLIMITSW" : "I_NEGLIMITSW"));
        const bool was = std::exchange(at_switch_[positive ? 1 : 0], is), came = is && !was;
        if (!is && violated_ == (positive ? 1 : -1) && !outside(positive, place(now))) violated_ = 0;
        if (!came || !servo_.powered() || (positive ? v <= 0 : v >= 0)) continue;
        if (value("ENDSWMOD") == 0) {
            raise(end_limit, now);
        } else {
            const auto stop = servo_.units().braking(2);
            servo_.shaft().stop(stop, now);
        }
    }
    servo_.inputs_changed(now);
    after(now);
}

bool MacsAxis::moves(Instant now) const { return servo_.powered() && servo_.shaft().moves(now); }
bool MacsAxis::ticks(bool led) const {
    if (homing_.active() || jump_.by != 0) return true;
    if (value("I2TFTIME") > 0 && (servo_.powered() || current_.value() > 0)) return true;
    const bool watched = value("SWNEGLIMACT") != 0 || value("SWPOSLIMACT") != 0;
    return watched && servo_.powered() && (led || (of(0x6060) == 3 && of(0x60FF) != 0));
}
void MacsAxis::tick(bool led, Instant at) {
    if (jump_.by != 0) read_encoder(at);
    if (homing_.active()) homing_order(homing_.step(homing_input(at)), at);
    const auto time = value("I2TFTIME");
    current_.step(servo_.powered() ? load * real(value("AMPMAXCUR")) : 0, time);
    const bool hot = current_.exceeds(time, value("I2TLIMIT"));
    if (hot && !std::exchange(hot_, hot) && servo_.state() == State::enabled) raise(i2t_limit, at);
    hot_ = hot;
    const double place = this->place(at), v = servo_.shaft().demand(at).velocity;
    if (violated_ != 0 && !outside(violated_ > 0, place) && !at_switch_[violated_ > 0 ? 1 : 0]) violated_ = 0;
    // During speed control and synchronisation, the error comes when the limit has been exceeded [L2645].
    if (servo_.state() == State::enabled && (led || of(0x6060) == 3) &&
        ((v > 0 && outside(true, place)) || (v < 0 && outside(false, place))) && violated_ == 0)
        raise(end_limit, at);
    after(at);
}

void MacsAxis::misread(double by, Instant now) {
    const auto shaft = servo_.shaft().shaft(now);
    jump_ = {by, shaft.position, shaft.velocity / 1000, now, 0, jump_.count};
    machine.misread(servo_.shaft(), 0);
    if (by != 0) read_encoder(now);
}
/// One reading while the encoder is wrong. A jump of more than half its resolution is recognised and replaced by the position that follows
/// from the last velocity, for a limited number of readings; after that the reading is used, as with any other encoder.
void MacsAxis::read_encoder(Instant at) {
    const auto code = encoder_of(value("ENCODERTYPE"), false).value_or(EncoderCode{});
    const bool reported = code.source == Encoder::linear_absolute && std::fabs(jump_.by) > real(value("ENCODER")) / 2;
    if (reported) ++jump_.count;
    if (!reported || ++jump_.readings > corrected_readings) return machine.misread(servo_.shaft(), jump_.by);
    const double artificial = jump_.from + jump_.velocity * seconds(at - jump_.since) * 1000;
    machine.misread(servo_.shaft(), artificial - servo_.shaft().shaft(at).position);
}

void MacsAxis::define_origin(Instant now) {
    const double here = place(now), way = here - servo_.units().zero();
    servo_.units().set_zero(here);
    for (const char* id : {"NEGLIMIT", "POSLIMIT"})
        set(id, std::clamp<std::int64_t>(value(id) - std::llround(way), -mlong, mlong));  // the range does not change [L1926]
}
bool MacsAxis::may_clear_error() const { return !current_.exceeds(value("I2TFTIME"), value("I2TLIMIT")); }
void MacsAxis::clear_error(Instant now) {
    for (const std::int64_t cw : {0, 0x80, 0}) {
        (void)d_.set({static_cast<std::uint16_t>(0x6040 + base_), 0}, Value{cw});
        (void)written({static_cast<std::uint16_t>(0x6040 + base_), 0}, now);
    }
}
bool MacsAxis::holds_in_error() const {
    const auto condition = value("ERRCOND");
    return servo_.state() == State::fault && (condition == 2 || condition == 3);
}
std::int64_t MacsAxis::track_error(Instant now) const {
    const auto demand = servo_.shaft().demand(now);
    const double velocity = demand.velocity / 1000;
    return std::fabs(velocity) < 0.001 ? 0 : std::llround((demand.position - place(now)) / velocity * 100);
}

}  // namespace axisgate::aposs
