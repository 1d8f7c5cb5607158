// There are steps of 1 ms only while something must be checked in each of them, and of 20 ms while a specimen's values are noted.
#include "adapters/aposs/twin/macs.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::aposs {
namespace {
using cia402_drive::twin::State;
constexpr auto one_tick = std::chrono::milliseconds(1);
constexpr auto one_sample = std::chrono::milliseconds(20);  ///< between two notes the position changes evenly
// Node guarding: its times are not printed (E-66).
constexpr auto guard_period = std::chrono::milliseconds(500);
constexpr auto guard_life = 3 * guard_period;
Coupling::Axes places(std::deque<MacsAxis>& axes_of) { return {&axes_of[0], &axes_of[1]}; }
std::deque<MacsAxis>& filled(std::deque<MacsAxis>& into, const Objects& objects, canopen::Dictionary& d, Terminals& t, double travel,
                             const Manners& manners) {
    for (int a = 0; a < axes; ++a)
        into.emplace_back(objects, d, t, a, travel, manners);
    return into;
}
/// A guarded device stays guarded when a program ends, although the value is lost: until another SET or the next start [L1559-1565].
void define_bus(BusDevices& bus, const std::deque<MacsAxis>& of, int k) {
    const MacsAxis& a = of[static_cast<std::size_t>(k)];
    bus.set(k, BusDevices::By::drive, a.value("DRIVETYPE"));
    bus.set(k, BusDevices::By::encoder, a.value("ENCODERTYPE"));
    bus.set(k, BusDevices::By::master, a.value("MENCODERTYPE"));
}
void follow(std::deque<MacsAxis>& of, Instant now) {
    for (MacsAxis& a : of)
        a.machine.follow(a.servo().shaft(), a.servo().powered(), now);
}
/// The second axis may start later than the controller.
bool started(int k, const Manners& manners, Instant powered_at, Instant now) { return k == 0 || now >= powered_at + manners.axis_start; }
/// Keeps the values that are shown late; each change of the state ends here.
void note(std::array<ShownLate, axes>& shown, const std::deque<MacsAxis>& of, Instant now) {
    for (std::size_t k = 0; k < shown.size(); ++k) {
        const Servo& servo = of[k].servo();
        if (shown[k].status.late()) shown[k].status.note(servo.statusword(now), now);
        if (shown[k].position.late()) shown[k].position.note(servo.shaft().read(now), now);
    }
}
/// During a motion, values that are shown late must be noted, and a real shaft that nothing else looks at must follow until it rests.
bool samples(const std::deque<MacsAxis>& of, const Manners& manners, Instant now) {
    const bool late = manners.status_late != Duration::zero() || manners.position_late != Duration::zero();
    return std::ranges::any_of(of, [&](const MacsAxis& a) {
        const Servo& s = a.servo();
        return (late && s.shaft().moves(now)) || (!s.shaft().lags() && a.machine.unsettled(s.shaft(), s.powered(), now));
    });
}
void show_late(MacsAxis& a, const ShownLate& shown, Instant now) {
    if (const auto v = a.machine.velocity()) a.put(0x606C, 0, a.servo().units().speed_in_units(*v));
    if (shown.status.late()) a.put(0x6041, 0, static_cast<double>(shown.status.at(now)));
    if (!shown.position.late()) return;
    const double read = std::round(shown.position.at(now));
    a.put(0x6063, 0, read);
    a.put(0x6064, 0, a.servo().units().in_units(read));
    a.put(0x60F4, 0, a.servo().units().way_in_units(a.servo().shaft().demand(now).position - read));
}
void tell_drives(BusDevices& bus, const std::deque<MacsAxis>& of) {
    for (int k = 0; k < axes; ++k) {
        const MacsAxis& a = of[static_cast<std::size_t>(k)];
        const State s = a.servo().state();
        bus.failing(k, s == State::fault || s == State::fault_reaction, a.value("ERRCOND"));
    }
}
}  // namespace

Macs::Macs(const Objects& objects, canopen::Dictionary& dictionary, double travel, const Manners& manners)
    : objects_(objects),
      d_(dictionary),
      manners_(manners),
      coupling_(places(filled(axes_, objects, dictionary, terminals_, travel, manners)), terminals_) {
    shown_.fill({Delayed(manners.status_late), DelayedCourse(manners.position_late)});
}

void Macs::power_on(Instant now) {
    program_.reset();
    ticked_ = now;
    tick_every_ = {};
    terminals_.outputs = 0;
    powered_at_ = now;
    orders_.clear();
    cycle_at_ = never;
    for (ShownLate& s : shown_)
        s.status.forget(), s.position.forget();
    for (MacsAxis& a : axes_)
        a.power_on(now);
    coupling_.power_on(now);
    bus_ = {};
    for (int k = 0; k < axes; ++k)
        define_bus(bus_, axes_, k);
    set_inputs(terminals_.inputs, now);
}
void Macs::power_off(Instant now) {
    for (int k = 0; k < axes; ++k)
        coupling_.end(k);
    coupling_.virtual_master().off();
    orders_.clear();
    cycle_at_ = never;
    for (MacsAxis& a : axes_) {
        a.machine.follow(a.servo().shaft(), a.servo().powered(), now);
        a.servo().power_off(now);
    }
}
bool Macs::powered() const {
    return std::ranges::any_of(axes_, [](const MacsAxis& a) { return a.servo().powered(); });
}

canopen::Abort Macs::may_write(Address a, std::int64_t v, Instant now) const {
    if (const Row* row = objects_.at(a)) {
        if (row->storage == "computed") return canopen::Abort::read_only;
        if (row->id == "HOME_FORCE" && v > 1) return canopen::Abort::too_high;  // 255 can be read, never written (E-10)
        if (!means_something(row->id, v)) return canopen::Abort::value;
        if (!row->allowed.empty() && std::ranges::find(row->allowed, v) == row->allowed.end()) return canopen::Abort::value;
        return canopen::Abort::none;
    }
    for (int k = 0; k < axes; ++k)
        if (a.index >= 0x6000 + per_axis * k && a.index < 0x6000 + per_axis * (k + 1)) {
            if (!started(k, manners_, powered_at_, now)) return canopen::Abort::device_state;
            return axis(k + 1).servo().may_write(a, v, now);
        }
    return canopen::Abort::none;
}

/// The application takes the objects of the profile in its next cycle; parameters are in force at once.
void Macs::written(Address a, Instant now) {
    if (manners_.extra_pdo != Duration::zero() && a.index >= 0x1800 && a.index < 0x1804)  // the event timer is not switched off
        (void)d_.set({a.index, 5}, Value{static_cast<std::int64_t>(manners_.extra_pdo / std::chrono::milliseconds(1))});
    const Duration every = manners_.program_cycle;
    if (every == Duration::zero() || a.index < 0x6000) return apply(a, now);
    if (orders_.size() < most_orders && std::ranges::find(orders_, a) == orders_.end()) orders_.push_back(a);
    if (cycle_at_ == never) cycle_at_ = now + every - now.time_since_epoch() % every;
}
void Macs::apply(Address a, Instant now) {
    follow(axes_, now);
    if (const Row* row = objects_.at(a)) {
        changed(row->key, now);
    } else {
        const int k = a.index >= 0x6000 + per_axis ? 1 : 0;
        const bool ends = axis(k + 1).written(a, now);
        if (a.index == 0x6040 + per_axis * k) {
            const auto cw = static_cast<unsigned>(axis(k + 1).of(0x6040));
            if ((cw & 0xFu) == 0xF && axis(k + 1).servo().state() == State::enabled) bus_.motor_on(k);
            if ((cw & 2u) == 0) bus_.motor_off(k, axis(k + 1).value("ERRCOND"));
        }
        if (ends || !axis(k + 1).servo().takes_orders()) coupling_.end(k);  // a stop or another motion ends it
        check_position_errors(now);
    }
    begin_ticks(now);
}

void Macs::changed(const Key& key, Instant now) {
    const Row* row = objects_.of(key);
    if (row == nullptr) return;
    if (row->id == "SYSVAR_4105")  // written as a speed, read as a position [L4815]
        return coupling_.simulate(key.axis, d_.integer(row->address).value_or(0), now);
    if (key.scope != Scope::axis) return;
    axis(key.axis + 1).settle(row->id == "DFLTVEL" || row->id == "DFLTACC");
    if (row->id == "ENCODERTYPE") coupling_.forget_markers(key.axis, now);
    define_bus(bus_, axes_, key.axis);
    axis(key.axis + 1).inputs_changed(now);  // another input may have the function
}

void Macs::set_inputs(std::uint32_t mask, Instant now) {
    const auto active = [&](const char* id) { return terminals_.active(axes_[0].value(id)); };
    follow(axes_, now);
    const bool breaks = active("I_BREAK"), clears = active("I_ERRCLR"), starts = active("I_PRGSTART");
    terminals_.inputs = mask;
    for (MacsAxis& a : axes_)
        a.inputs_changed(now);
    if (!breaks && active("I_BREAK") && program_) escape(now);
    if (!starts && active("I_PRGSTART") && !program_)
        if (const auto n = chosen_program(mask, axes_[0].value("I_PRGCHOICE"), axes_[0].value("I_PRGSTART"))) start_program(*n);
    if (!clears && active("I_ERRCLR"))
        for (MacsAxis& a : axes_)
            if (a.servo().state() == State::fault) a.clear_error(now);
    check_position_errors(now);
    begin_ticks(now);
}
std::uint32_t Macs::outputs(Instant now) const {
    Terminals t = terminals_;
    bool error = false;
    for (int k = 0; k < axes; ++k) {
        const MacsAxis& a = axes_[static_cast<std::size_t>(k)];
        const State s = a.servo().state();
        error = error || s == State::fault || s == State::fault_reaction;
        t.set(a.value("O_AXMOVE"), a.moves(now) || coupling_.leads(k));
    }
    t.set(axes_[0].value("O_ERROR"), error);
    return t.outputs;
}

void Macs::set_bus_silent(bool silent, Instant now) {
    bus_silent_ = silent;
    silent_since_ = now;
}

void Macs::on_sync(Instant now) {
    for (MacsAxis& a : axes_)
        a.servo().on_sync(now);
}
void Macs::connection_lost(Instant now) {
    for (MacsAxis& a : axes_)
        a.servo().connection_lost(now);
}
std::vector<Device::Reported> Macs::take_reported() {
    std::vector<Reported> all;
    for (MacsAxis& a : axes_) {
        for (const Reported& t : a.take_reported())
            all.push_back(t);
        for (const Reported& t : a.servo().take_reported())
            all.push_back(t);
    }
    std::ranges::stable_sort(all, {}, &Reported::at);
    return all;
}

void Macs::refresh(Instant now) {
    follow(axes_, now);
    note(shown_, axes_, now);
    if (tick_every_ == one_sample) ticked_ = now;
    for (int k = 0; k < axes; ++k) {
        MacsAxis& a = axis(k + 1);
        a.servo().refresh(now);
        show_late(a, shown_[static_cast<std::size_t>(k)], now);
        if (!started(k, manners_, powered_at_, now)) a.put(0x6041, 0, 0);  // "not ready to switch on"
        const auto demand = a.of(0x6062), before = a.value("PFG_COMMANDPOS");
        a.set("SYSVAR_4096", demand);
        a.set("PFG_OLDCOMMANDPOS", before);
        a.set("PFG_COMMANDPOS", demand);
        a.set("SYSVAR_4105", coupling_.simulated(k, now));
        a.set("PFG_SYNCMNEGBUFFER", coupling_.of(k).negative_buffer());
        a.set("SYSVAR_4238", std::llround(coupling_.of(k).marker_distance()));
        a.set("REG_NORMTRACKERR", a.track_error(now));
        if (a.value("HOME_FORCE") != 0) a.set("HOME_FORCE", a.homing_due() ? 1 : 255);
    }
    axis(1).set("SYSVAR_42", std::llround(axis(2).encoder(now)));  // encoder 2, independent of the zero of its axis
    axis(1).set("SYSVAR_16", axis(1).misreading().count + axis(2).misreading().count);
    axis(1).set("AMP_I2TVALUE", std::max(axis(1).current().value(), axis(2).current().value()));
}

void Macs::begin_ticks(Instant now) {
    tell_drives(bus_, axes_);
    note(shown_, axes_, now);
    const bool ticks = coupling_.ticks() || axes_[0].ticks(coupling_.leads(0)) || axes_[1].ticks(coupling_.leads(1));
    const Duration every = ticks ? one_tick : samples(axes_, manners_, now) ? one_sample : Duration{};
    if (tick_every_ == Duration::zero()) ticked_ = now;
    tick_every_ = every;
}
Instant Macs::next_event(Instant now) const {
    Instant next = std::min(tick_every_ == Duration::zero() ? never : ticked_ + tick_every_, cycle_at_);
    for (const ShownLate& s : shown_)
        next = std::min(next, s.status.next(now));
    if (!started(axes - 1, manners_, powered_at_, now)) next = std::min(next, powered_at_ + manners_.axis_start);
    if (bus_silent_ && bus_.guards()) next = std::min(next, std::max(now, silent_since_ + guard_life));
    for (const MacsAxis& a : axes_)
        next = std::min(next, a.servo().next_event(now));
    return next;
}

/// A position error switches off the control of all axes [L2318].
void Macs::check_position_errors(Instant now) {
    for (int k = 0; k < axes; ++k) {
        const State s = axis(k + 1).servo().state();
        const bool is = (s == State::fault || s == State::fault_reaction) && (axis(k + 1).of(0x603F) & 0xFFFF) == position_error;
        const bool came = is && !in_position_error_[static_cast<std::size_t>(k)];
        in_position_error_[static_cast<std::size_t>(k)] = is;
        if (!came) continue;
        for (int other = 0; other < axes; ++other) {
            if (other == k || axis(other + 1).servo().state() != State::enabled) continue;
            in_position_error_[static_cast<std::size_t>(other)] = true;
            axis(other + 1).servo().fail(position_error, now);
            axis(other + 1).after(now);
        }
    }
}

void Macs::on_event(Instant at) {
    follow(axes_, at);
    if (cycle_at_ <= at) {
        cycle_at_ = never;
        for (const Address a : std::exchange(orders_, {}))
            apply(a, at);
    }
    for (MacsAxis& a : axes_) {
        if (a.servo().next_event(at) > at) continue;
        a.servo().on_event(at);
        a.after(at);
    }
    check_position_errors(at);
    if (bus_silent_ && bus_.guards() && silent_since_ + guard_life <= at) {
        silent_since_ = at - (guard_life - guard_period);  // it returns after each ERRCLR as long as the node is guarded
        for (MacsAxis& a : axes_)
            if (a.servo().state() != State::fault && a.servo().state() != State::fault_reaction) a.raise(guarding_failed, at);
    }
    const bool ticks = tick_every_ != Duration::zero() && ticked_ + tick_every_ <= at;
    if (ticks) ticked_ = at;
    if (ticks && tick_every_ == one_tick) {
        coupling_.tick(at);
        for (int k = 0; k < axes; ++k)
            axis(k + 1).tick(coupling_.leads(k), at);
    }
    begin_ticks(at);
}

bool Macs::keeps(Address address, const canopen::Entry& entry) const {
    return address.index < 0x2000 && axes_.front().servo().keeps(address, entry);  // its own parameters are stored separately
}
/// SAVEPROM: stores the values in force in the EPROM [L73-75].
void Macs::save_user() {
    ++eprom_writes_;
    for (const auto& [key, row] : objects_.rows()) {
        if (row.storage != "parameter") continue;
        std::int64_t v = d_.integer(row.address).value_or(row.initial);
        if (row.id == "HOME_FORCE" && v == 255) v = 1;
        const auto it = user_.find(key);
        const std::int64_t before = it == user_.end() ? row.initial : it->second;
        if (v == row.initial) {
            user_.erase(key);
        } else {
            user_[key] = v;
        }
        if (v != before && key.scope == Scope::axis) axis(key.axis + 1).revoke_homing();  // E-72
    }
}
void Macs::save(NonVolatile& memory) {
    save_user();
    for (const auto& [key, v] : user_)
        memory[(key.scope == Scope::axis ? "axis" + std::to_string(key.axis + 1) + "." : std::string("global.")) +
               std::to_string(key.number)] = Value{v};
    memory["eprom_writes"] = Value{eprom_writes_};
}
void Macs::load(const NonVolatile& memory) {
    user_.clear();
    eprom_writes_ = integer_in(memory, "eprom_writes", 0, 0);
    for (const auto& [key, row] : objects_.rows()) {
        if (row.storage != "parameter") continue;
        const std::string name =
            (key.scope == Scope::axis ? "axis" + std::to_string(key.axis + 1) + "." : std::string("global.")) + std::to_string(key.number);
        const std::int64_t v = integer_in(memory, name, row.initial);
        if (v != row.initial && d_.set(row.address, Value{v})) user_[key] = v;
    }
}

void Macs::end_program(bool concluded) {
    const auto next = program_of(axes_[0].value("PRGPAR")).value_or(ProgramCode{}).program;
    const bool by_input = axes_[0].value("I_PRGSTART") != 0;
    const bool ran = std::exchange(program_, std::nullopt).has_value();
    for (const auto& [key, row] : objects_.rows()) {
        if (row.storage != "parameter") continue;
        const auto it = user_.find(key);
        (void)d_.set(row.address, Value{it == user_.end() ? row.initial : it->second});
    }
    for (MacsAxis& a : axes_)
        a.settle(true);
    if (concluded && ran && next >= 0 && !by_input) start_program(next);
}
void Macs::start_program(int number) {
    end_program();
    program_ = number;
    bus_.forget();  // all of them are made again from the values in force
    for (int k = 0; k < axes; ++k)
        define_bus(bus_, axes_, k);
}
/// ESCCOND: 0 stop with maximum deceleration, outputs unchanged; 1 all outputs 0; 2 all 1; the brake always, the simulated master only with
/// 0 [L5111-5150].
void Macs::escape(Instant now) {
    for (int k = 0; k < axes; ++k) {
        MacsAxis& a = axis(k + 1);
        coupling_.end(k);
        const auto condition = a.value("ESCCOND");
        if (a.servo().powered() && a.servo().shaft().moves(now)) a.servo().shaft().stop(a.servo().units().braking(3), now);
        if (condition == 0) coupling_.simulate(k, 0, now);
        if (condition == 1) terminals_.outputs = 0;
        if (condition == 2) terminals_.outputs = 0xFF;
        terminals_.set(a.value("O_BRAKE"), true);
    }
    end_program();
    begin_ticks(now);
}
void Macs::reset_parameters() {
    user_.clear();
    end_program();
}

}  // namespace axisgate::aposs
