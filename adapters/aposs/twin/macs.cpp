// Macs: what parameters and time do.
// In: writes. Out: limits of the axes, errors, the slave's way. Never starts a motion that homing or a software limit forbids.
#include "adapters/aposs/twin/macs.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::aposs {
namespace {
constexpr std::uint16_t position_error = 0x8611, limit_error = 0x8612;  // what CiA 402 has for errors without a number in the manual
constexpr auto tick = std::chrono::milliseconds(1);
constexpr std::int64_t mlong = 1'073'741'823;
bool is_absolute(std::int64_t encoder_type) { return encoder_type >= 1 && encoder_type <= 4; }
}  // namespace

Macs::Macs(const Objects& objects, canopen::Dictionary& dictionary) : objects_(objects), d_(dictionary) {
    for (int a = 0; a < axes; ++a)
        servos_.emplace_back(dictionary, 0.0, static_cast<std::uint16_t>(per_axis * a));
    for (int a = 0; a < axes; ++a)
        shown_[static_cast<std::size_t>(a)] = {objects.named("SYSVAR_4096", a), objects.named("PFG_COMMANDPOS", a),
                                               objects.named("PFG_OLDCOMMANDPOS", a), objects.named("SYSVAR_4105", a),
                                               objects.named("HOME_FORCE", a)};
}

std::int64_t Macs::value(std::string_view id, int axis) const {
    const Row* row = objects_.named(id, axis);
    return row ? d_.integer(row->address).value_or(row->initial) : 0;
}

void Macs::power_on(Instant now) {
    homed_ = {};
    gear_ = Gear::none;
    program_ = false;
    simulated_speed_ = {};
    ticked_ = now;
    for (int a = 0; a < axes; ++a)
        settle_axis(a, true);
    for (Servo& s : servos_)
        s.power_on(now);
}
void Macs::power_off(Instant now) {
    gear_ = Gear::none;
    for (Servo& s : servos_)
        s.power_off(now);
}
bool Macs::powered() const { return std::ranges::any_of(servos_, &Servo::powered); }

canopen::Abort Macs::may_write(Address a, std::int64_t v) const {
    if (const Row* row = objects_.at(a)) {
        if (row->storage == "computed") return canopen::Abort::read_only;
        if (row->id == "HOME_FORCE" && v > 1) return canopen::Abort::too_high;  // 255 is shown, never written (E-10)
        if (row->id == "SYNCFACTM" && v == 0) return canopen::Abort::value;     // a divisor (E-48)
        if (!row->allowed.empty() && std::ranges::find(row->allowed, v) == row->allowed.end()) return canopen::Abort::value;
        return canopen::Abort::none;
    }
    for (int k = 0; k < axes; ++k)
        if (a.index >= 0x6000 + per_axis * k && a.index < 0x6000 + per_axis * (k + 1))
            return servos_[static_cast<std::size_t>(k)].may_write(a, v);
    return canopen::Abort::none;
}

bool Macs::homing_due(int axis) const {
    const auto forced = value("HOME_FORCE", axis);
    return forced != 0 && !homed_[static_cast<std::size_t>(axis)];
}

void Macs::written(Address a, Instant now) {
    if (const Row* row = objects_.at(a)) return changed(row->key, now);
    const int k = a.index >= 0x6000 + per_axis ? 1 : 0;
    Servo& servo = servos_[static_cast<std::size_t>(k)];
    const auto base = static_cast<std::uint16_t>(per_axis * k);
    const auto of = [&](std::uint16_t index) { return d_.integer({static_cast<std::uint16_t>(index + base), 0}).value_or(0); };
    if (a.index != 0x6040 + base) return servo.written(a, now);
    const auto cw = static_cast<unsigned>(of(0x6040));
    const bool starts = (cw & 0x1Fu) == 0x1Fu && of(0x6060) == 1;
    if (k == 1 && gear_ != Gear::none && ((cw & 0x10Fu) != 0x0Fu || starts)) gear_ = Gear::none;  // a stop or another motion ends it
    if (starts) {
        const std::int64_t target = of(0x607A) + ((cw & 0x40u) ? of(0x6062) : 0);
        const bool low = value("SWNEGLIMACT", k) != 0 && target < value("NEGLIMIT", k);
        const bool high = value("SWPOSLIMACT", k) != 0 && target > value("POSLIMIT", k);
        if (homing_due(k) || low || high) {
            // The set-point is not taken: positioning outside the limits is not started [L2642], nor is any without homing [L1880].
            (void)d_.set({static_cast<std::uint16_t>(0x6040 + base), 0}, Value{static_cast<std::int64_t>(cw & ~0x10u)});
            servo.written(a, now);
            return raise(k, homing_due(k) ? homing_wanted : limit_error, now);
        }
    }
    servo.written(a, now);
}

void Macs::changed(const Key& key, Instant now) {
    const Row* row = objects_.of(key);
    if (row == nullptr) return;
    if (row->id == "SYSVAR_4105") {  // a write is a speed, a read a position [L4815]
        on_event(now);
        simulated_speed_[static_cast<std::size_t>(key.axis)] = d_.integer(row->address).value_or(0);
        ticked_ = now;
        return;
    }
    if (key.scope == Scope::axis) settle_axis(key.axis, row->id == "DFLTVEL" || row->id == "DFLTACC");
}

/// The profile's objects of an axis by its parameters; by `defaults` velocity and acceleration, too, which a client may have changed.
void Macs::settle_axis(int axis, bool defaults) {
    const auto put = [&](std::uint16_t index, std::uint8_t sub, double v) {
        const auto whole = static_cast<std::int64_t>(std::clamp<std::int64_t>(std::llround(v), -mlong, mlong));
        (void)d_.set({static_cast<std::uint16_t>(index + per_axis * axis), sub}, Value{whole});
    };
    const auto of = [&](std::string_view id) { return static_cast<double>(value(id, axis)); };
    const double per_turn = of("ENCODER") * (is_absolute(value("ENCODERTYPE", axis)) ? 1 : 4);
    const double ramp = std::max(1.0, of("RAMPMIN")), res = std::max(1.0, of("VELRES"));
    const double velocity = std::max(1.0, of("VELMAX") * per_turn / 60), acceleration = std::max(1.0, velocity / ramp * 1000);
    if (const Row* row = objects_.named("VELMAXQC", axis)) {  // whole numbers, truncated (E-70)
        const auto qc = static_cast<std::int64_t>(of("VELMAX") * per_turn * 65536 / 60000);
        use(*row, std::clamp<std::int64_t>(qc, 1, mlong));
        if (const Row* acc = objects_.named("ACCMAXQC", axis))
            use(*acc, std::clamp<std::int64_t>(qc / static_cast<std::int64_t>(ramp), 1, mlong));
    }
    put(0x607F, 0, velocity);
    put(0x6080, 0, velocity);
    for (const std::uint16_t index : std::initializer_list<std::uint16_t>{0x60C5, 0x60C6, 0x6085})
        put(index, 0, acceleration);
    if (defaults) {
        put(0x6081, 0, velocity * of("DFLTVEL") / res);
        put(0x6083, 0, std::max(1.0, acceleration * of("DFLTACC") / res));
        put(0x6084, 0, std::max(1.0, acceleration * of("DFLTACC") / res));
    }
    const double home = std::max(1.0, velocity * std::fabs(of("HOME_VEL")) / res);
    put(0x6099, 1, home);
    put(0x6099, 2, std::max(1.0, home / 4));  // ours: the fraction is not printed (E-18)
    put(0x609A, 0, std::max(1.0, acceleration * std::min(of("HOME_RAMP"), of("DFLTACC")) / res));
    put(0x607C, 0, of("HOME_OFFSET"));
    put(0x6065, 0, of("POSERR"));
    // Each axis is looked at every 20 ms in turn, and the error comes at the first look after so many [L6003-6032].
    const double round = 20.0 * axes;
    put(0x6066, 0, (std::floor(of("POSERRTIME") / round) + (value("POSERRTIME", axis) > 0 ? 1 : 0)) * round);
    put(0x6067, 0, of("TESTWIN"));
    put(0x6068, 0, of("TESTTIM"));
    const auto condition = value("ERRCOND", axis);
    put(0x605E, 0, condition <= 1 ? 0 : condition == 4 ? 1 : 2);
}

void Macs::raise(int axis, std::uint16_t code, Instant now) {
    Servo& s = servos_[static_cast<std::size_t>(axis)];
    if (value("ERRCOND", axis) != 5) return s.fail(code, now);
    told_.push_back({now, {code, 0x81, {}}});  // control stays on, the program's error routine has it [L3707]
}

void Macs::on_sync(Instant now) {
    for (Servo& s : servos_)
        s.on_sync(now);
}
void Macs::connection_lost(Instant now) {
    for (Servo& s : servos_)
        s.connection_lost(now);
}
std::vector<Device::Told> Macs::take_told() {
    std::vector<Told> all = std::exchange(told_, {});
    for (int k = 0; k < axes; ++k)
        for (const Told& t : servos_[static_cast<std::size_t>(k)].take_told())
            all.push_back(t);
    std::ranges::stable_sort(all, {}, &Told::at);
    return all;
}

void Macs::refresh(Instant now) {
    for (int k = 0; k < axes; ++k) {
        Servo& s = servos_[static_cast<std::size_t>(k)];
        s.refresh(now);
        const auto base = static_cast<std::uint16_t>(per_axis * k);
        const auto demand = d_.integer({static_cast<std::uint16_t>(0x6062 + base), 0}).value_or(0);
        const auto at = static_cast<std::size_t>(k);
        const auto show = [&](const Row* row, std::int64_t v) {
            if (row && d_.integer(row->address) != v) use(*row, v);
        };
        const Shown& rows = shown_[at];
        show(rows.place, demand);
        if (rows.command) show(rows.old_command, d_.integer(rows.command->address).value_or(0));
        show(rows.command, demand);
        show(rows.master, std::llround(simulated_master_[at] + static_cast<double>(simulated_speed_[at]) * seconds(now - ticked_) * 1000));
        const bool attained = (s.statusword(now) & 0x3000u) == 0x1000u && d_.integer({static_cast<std::uint16_t>(0x6060 + base), 0}) == 6;
        if (attained) homed_[at] = true;
        if (rows.home_force && d_.integer(rows.home_force->address) != 0) show(rows.home_force, homing_due(k) ? 1 : 255);
    }
}

Instant Macs::next_event(Instant now) const {
    Instant next = gear_ == Gear::none ? never : ticked_ + tick;
    for (const Servo& s : servos_)
        next = std::min(next, s.next_event(now));
    return next;
}

void Macs::on_event(Instant at) {
    for (int k = 0; k < axes; ++k) {
        Servo& s = servos_[static_cast<std::size_t>(k)];
        const bool was = s.powered();
        if (s.next_event(at) <= at) s.on_event(at);
        // A position error takes the control off all axes [L2318].
        if (was && d_.integer({static_cast<std::uint16_t>(0x603F + per_axis * k), 0}) == position_error && !s.takes_orders())
            for (Servo& other : servos_)
                if (other.takes_orders()) other.fail(position_error, at);
    }
    if (gear_ != Gear::none && ticked_ + tick <= at) follow(at);
}

std::string Macs::set_gear(Gear gear, Instant now) {
    if (gear != Gear::none && !servos_[1].takes_orders()) return "the second axis is off: enable it first";
    if (gear != Gear::none && homing_due(1)) return raise(1, homing_wanted, now), "homing is due (error 6)";
    gear_ = gear;
    gear_master_ = servos_[0].mechanics(now).position;
    gear_slave_ = servos_[1].mechanics(now).position;
    ticked_ = now;
    return {};
}

/// One millisecond of the gear: the slave's way is the master's times SYNCFACTS / SYNCFACTM, within its own VELMAX. What SYNCP cannot
/// follow it makes good later, what SYNCV cannot follow is lost.
void Macs::follow(Instant at) {
    if (!servos_[1].takes_orders()) {
        gear_ = Gear::none;
        return;
    }
    const double master = servos_[0].mechanics(at).position;
    const double ratio = static_cast<double>(value("SYNCFACTS", 1)) / static_cast<double>(value("SYNCFACTM", 1));
    const double offset = gear_ == Gear::position ? static_cast<double>(value("SYNCPOSOFFS", 1)) : 0;
    const double span = seconds(at - ticked_);
    const double most = static_cast<double>(d_.integer({0x607F + per_axis, 0}).value_or(1)) * span;
    const double here = servos_[1].demanded(at);
    const double wanted = gear_slave_ + (master - gear_master_) * ratio + offset;
    const double there = here + std::clamp(wanted - here, -most, most);
    if (gear_ == Gear::velocity) {
        gear_master_ = master;
        gear_slave_ = there;
    }
    if (there != here || servos_[1].mechanics(at).velocity != 0) servos_[1].steer(there, at);
    ticked_ = at;
}

bool Macs::keeps(Address address, const canopen::Entry& entry) const {
    return address.index < 0x2000 && servos_.front().keeps(address, entry);  // its own parameters are in its own memory
}
/// SAVEPROM: what is valid now is what the EPROM holds [L73-75].
void Macs::save(NonVolatile& memory) {
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
        if (v != before && key.scope == Scope::axis) homed_[static_cast<std::size_t>(key.axis)] = false;  // E-72
    }
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

void Macs::end_program() {
    program_ = false;
    for (const auto& [key, row] : objects_.rows()) {
        if (row.storage != "parameter") continue;
        const auto it = user_.find(key);
        use(row, it == user_.end() ? row.initial : it->second);
    }
    for (int a = 0; a < axes; ++a)
        settle_axis(a, true);
}
void Macs::start_program() {
    end_program();
    program_ = true;
}
void Macs::reset_parameters() {
    user_.clear();
    end_program();
}

}  // namespace axisgate::aposs
