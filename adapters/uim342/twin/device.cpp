// Life of the drive: power, boot, events at their instants, input actions, notifications.
// In: time, edges, ends of motions. Out: notifications.
// Never handles an instruction: instructions.cpp does.
#include "adapters/uim342/twin/device_reports.hpp"

#include <algorithm>
#include <cstdlib>

#include "adapters/uim342/twin/telegrams.hpp"
#include "gateway/core/specimen.hpp"

namespace axisgate::uim342::twin {
namespace {

constexpr const char* encoder_position_name = "encoder.position";

Settings factory_settings(const Manners& manners) {
    Settings s;
    if (!manners.notifications_at_factory) s.ie = {0, 0, 0, 0};
    return s;
}

}  // namespace

Device::Device(const DeviceSetup& setup)
    : identity_(setup.identity),
      manners_(setup.manners),
      link_(setup.kind, setup.form, setup.bus_rate),
      memory_(setup.factory, setup.identity.serial, factory_settings(setup.manners)),
      axis_(setup.manners.shaft, setup.manners.seed),
      reader_(setup.crc) {
    link_.notifies = manners_.notification_to;
    inputs_.set_late(manners_.input_late);
}

// --- power and boot -----------------------------------------------------------------------------------------------------

void Device::power_on(const NonVolatile& memory, Instant now, Out& out) {
    last_ = std::max(last_, now);
    memory_.load(memory);
    powered_ = true;
    std::int32_t position = 0;
    if (const auto it = memory.find(encoder_position_name); it != memory.end()) {
        if (const auto n = as_integer(it->second)) position = wrap_i32(static_cast<double>(*n));
    }
    boot(last_, position, {});
    settle(last_, out);
}

NonVolatile Device::non_volatile() const {
    NonVolatile all;
    memory_.save(all);
    if (memory_.has_absolute_encoder()) all[encoder_position_name] = Value{std::int64_t{saved_position_}};
    return all;
}

void Device::power_off(Instant now) {
    axis_.set_driver(false, now);
    powered_ = online_ = false;
    boot_end_ = actions_at_ = arrive_at_ = driver_on_at_ = unasked_at_ = never;
    notices_.clear();
}

/// Section 3.4: RAM from FLASH and EEPROM, flags and history clear, everything volatile at its beginning.
void Device::boot(Instant now, std::int32_t encoder_position, Duration takes) {
    memory_.reboot();
    link_.boot(memory_.flash());
    microsteps_ = memory_.ram().mt[0];
    pulses_per_turn_ = memory_.ram().qe[4];
    absolute_ = memory_.has_absolute_encoder();
    axis_.power_up(absolute_ ? encoder_position : manners_.counter_start, now);
    keep_position(now);
    configure_axis(now);
    flags_ = {};
    wanted_ = {};
    history_ = ErrorHistory(manners_.error_slots);
    notices_.clear();
    statuses_.clear();
    arrive_at_ = driver_on_at_ = unasked_at_ = never;
    reader_.reset();
    online_ = false;
    actions_at_ = never;
    boot_end_ = now + takes;
}

void Device::boot_done(Instant at, Out& out) {
    boot_end_ = never;
    online_ = true;
    inputs_.restart(memory_.ram().tg);
    if (encoder_error_) history_.at_power_on({static_cast<std::uint8_t>(Alarm::encoder_error), 0, 0});
    if (battery_low_ && !encoder_error_) history_.at_power_on({static_cast<std::uint8_t>(Alarm::battery_low), 0, 0});
    if (encoder_error_) DeviceReports(*this).raise(Alarm::encoder_error, at, out);
    if (battery_low_) DeviceReports(*this).raise(Alarm::battery_low, at, out);
    if (manners_.boot_notice) {
        Telegram model;
        DeviceReports::fill_model(*this, model);
        model.producer = link_.node;
        model.consumer = link_.notifies;
        link_.send(model, at, out);
    }
    if (manners_.unasked_status != Duration::zero()) unasked_at_ = at + manners_.unasked_status;
    enable_at_boot_ = memory_.ram().ic[0] == 1;
    actions_at_ = enable_at_boot_ ? at + std::chrono::milliseconds(memory_.ram().mt[3]) : at;
}

/// Automatic enable, then every edge byte with FG = 0 whatever the level: IN1..IN3, falling before rising [L1000-1002].
void Device::power_on_actions(Instant at, Out& out) {
    actions_at_ = never;
    if (enable_at_boot_) axis_.set_driver(true, at);
    for (std::size_t i = 0; i < input_count; ++i) {
        const std::uint16_t il = memory_.ram().il[i];
        const auto falling = static_cast<std::uint8_t>(il & 0xFFu);
        const auto rising = static_cast<std::uint8_t>(il >> 8);
        if ((falling & 0x80) == 0) run_action(falling, 3 + 2 * i, at, out);
        if ((rising & 0x80) == 0) run_action(rising, 2 + 2 * i, at, out);
    }
}

/// The fitted encoder is the one that the factory settings describe; QE says what the drive takes it for.
void Device::configure_axis(Instant now) {
    const Settings& s = memory_.ram();
    const Settings fitted;
    const double counts = absolute_ ? 1u << fitted.qe[2] : 4u * fitted.qe[0];  // per turn [L839]
    const double taken_for = absolute_ ? 1u << s.qe[2] : 4u * s.qe[0];
    axis_.configure({s.ic[6] == 1, s.qe[1], 200.0 * microsteps_, pulses_per_turn_ * counts / taken_for, s.ic[1] == 1 ? 1 : -1}, now);
}

// --- time ---------------------------------------------------------------------------------------------------------------

void Device::on_frame(const Frame& frame, Instant now, Out& out) {
    now = std::max(now, last_);
    if (next_ <= now) settle(now, out);
    last_ = now;
    axis_.follow(now);
    if (link_.kind == LineKind::can) {
        if (!online_ || !link_.on_the_bus() || frame.kind != Frame::Kind::can || !link_.is_for_me(consumer_of(frame.id))) return;
        if (const auto t = read_can(frame)) {
            // Another node's error report is no instruction: answering it would make two nodes report to each other for ever, once a
            // spoilt identifier has named a node as the producer.
            if (t->cw == 0x0F && t->dl >= 4 && t->producer != host_id) return;
            receive(*t, now, out);
        }
        return;
    }
    if (!online_ || frame.kind != Frame::Kind::bytes) return;
    reader_.feed(frame.data(), [&](const Telegram& t, Form form) {
        link_.form = form;  // the host's way of speaking; notifications follow it
        if (!online_ || !link_.is_for_me(t.consumer)) return;
        receive(t, now, out);
    });
}

/// What an instruction causes at once is told behind its acknowledgement, by a specimen before it.
void Device::receive(const Telegram& t, Instant now, Out& out) {
    if (!manners_.notification_first) {
        instruct(t, now, out);
        return settle(now, out);
    }
    answer_.frames.clear();
    instruct(t, now, answer_);
    settle(now, out);
    out.frames.insert(out.frames.end(), answer_.frames.begin(), answer_.frames.end());
}

void Device::on_deadline(Instant now, Out& out) { settle(std::max(now, last_), out); }

Instant Device::earliest() const noexcept {
    Instant t = std::min({boot_end_, actions_at_, axis_.deadline(), arrive_at_, driver_on_at_, unasked_at_});
    if (!notices_.empty()) t = std::min(t, notices_.front().at);
    if (online_) t = std::min(t, inputs_.deadline());
    return t;
}

/// Everything that is due up to `now`, each at its own instant.
void Device::settle(Instant now, Out& out) {
    for (next_ = earliest(); next_ <= now; next_ = earliest()) {
        if (next_ == unasked_at_ && now - next_ >= manners_.unasked_status) {
            unasked_at_ += (now - next_) / manners_.unasked_status * manners_.unasked_status;  // of those that a late call missed, the last
        } else {
            step(next_, out);
        }
    }
    last_ = now;
    axis_.follow(now);
    keep_position(now);
    DeviceReports(*this).keep_status(now);
}

/// The absolute encoder's own memory: where the shaft came to rest.
void Device::keep_position(Instant now) noexcept {
    if (!memory_.has_absolute_encoder() || axis_.moving()) return;
    const std::int32_t there = axis_.place(now);
    if (there == saved_position_) return;
    saved_position_ = there;
    memory_.touch();
}

/// One event. At the same instant the end of a motion comes before an input, so that an arrival is never lost to a stop.
void Device::step(Instant at, Out& out) {
    axis_.follow(at);
    if (boot_end_ <= at) {
        boot_done(at, out);
    } else if (driver_on_at_ <= at) {
        driver_on_at_ = never;
        axis_.set_driver(true, at);
    } else if (actions_at_ <= at) {
        power_on_actions(at, out);
    } else if (axis_.deadline() <= at) {
        on_axis(axis_.step(at), at, out);
    } else if (arrive_at_ <= at) {
        DeviceReports(*this).arrive(at, out);
    } else if (!notices_.empty() && notices_.front().at <= at) {
        const Notice n = notices_.front();
        notices_.pop_front();
        link_.notify({n.data.data(), n.size}, at, out);
    } else if (unasked_at_ <= at) {
        unasked_at_ += manners_.unasked_status;
        DeviceReports(*this).send_status(at, out);
    } else if (const auto edge = inputs_.step(at)) {
        on_edge(*edge, at, out);
    }
    DeviceReports(*this).keep_status(at);
}

// --- what happens by itself -------------------------------------------------------------------------------------------

void Device::on_axis(Axis::Event event, Instant at, Out& out) {
    if (event == Axis::Event::arrived) {
        if (manners_.in_position == Duration::zero())
            DeviceReports(*this).arrive(at, out);
        else
            arrive_at_ = at + manners_.in_position;
    } else if (event == Axis::Event::too_fast) {
        DeviceReports(*this).raise(Alarm::overspeed, at, out);  // what the drive does about it is not printed: nothing (E-51)
    } else if (event == Axis::Event::stalled) {
        flags_.tlif = true;
        arrive_at_ = never;
        DeviceReports(*this).raise(Alarm::stall, at, out);
        if (memory_.ram().il[3] == 1) {
            axis_.set_driver(false, at);
        } else {
            axis_.stop_fast(at, memory_.ram().sd);
        }
    }
}

/// Order on one edge: the level is latched (by Inputs), the notification goes out if enabled, the action runs whatever IE says.
void Device::on_edge(Edge edge, Instant at, Out& out) {
    if (memory_.ram().ie[edge.input] == 1) {
        DeviceReports(*this).notify({static_cast<std::uint8_t>(2 * edge.input + (edge.rising ? 2 : 1))}, at, out);
    }
    const std::uint16_t il = memory_.ram().il[edge.input];
    if (memory_.ram().tg[edge.input] == trigger_one_time) {
        // Spent until IL[i] is set again; the EEPROM keeps it, so a power cycle arms it again.
        memory_.set(false, [&](Settings& s) { s.il[edge.input] = 0; });
    }
    const auto byte = static_cast<std::uint8_t>(edge.rising ? il >> 8 : il & 0xFFu);
    run_action(byte, (edge.rising ? 2 : 3) + 2 * edge.input, at, out);
}

Axis::Values Device::values_of(std::size_t group) const noexcept {
    const Settings& s = memory_.ram();
    return {s.group[group].ac, s.group[group].dc, s.ic[4] == 1, s.ss, s.bl};
}

bool Device::may_start() const noexcept { return axis_.driver_on() && !flags_.lock && axis_.state() != Axis::State::emergency_stop; }

void Device::emergency_stop_by_input(Instant at, Out& out) {
    axis_.stop_fast(at, memory_.ram().sd);
    if (memory_.ram().ic[3] == 0 || flags_.lock) return;
    flags_.lock = true;
    DeviceReports(*this).raise(Alarm::emergency_lock, at, out);
}

/// Action codes [L1006-1022]. The values are those of the edge's MF group; starts need the driver on and no emergency stop under way.
void Device::run_action(std::uint8_t action, std::size_t group, Instant at, Out& out) {
    const Settings& s = memory_.ram();
    const Group& g = s.group[group];
    const auto distance = std::abs(std::int64_t{g.pr});
    const double speed = std::abs(static_cast<double>(g.sp));
    const int reverse = axis_.reverse_direction(at);
    const auto stop_slowly = [&] {
        if (axis_.state() != Axis::State::emergency_stop) axis_.stop_slowly(at, g.dc, s.ic[4] == 1);
    };
    action &= 0x7F;  // FG is for power-on alone
    if (action == 0x04 || action >= 0x07) {
        if (!may_start()) return;
        flags_.paif = false;
        arrive_at_ = never;
    }
    switch (action) {
        case 0x01:
            axis_.set_driver(false, at);
            break;
        case 0x02:
            emergency_stop_by_input(at, out);
            break;
        case 0x03:
            stop_slowly();
            break;
        case 0x04:
            axis_.set_origin(at);
            axis_.move_by(at, reverse * distance, speed, values_of(group));
            break;
        case 0x05:
            axis_.set_origin(at);
            emergency_stop_by_input(at, out);
            break;
        case 0x06:
            axis_.set_origin(at);
            stop_slowly();
            break;
        case 0x07:
            axis_.jog(at, reverse * speed, values_of(group));
            break;
        case 0x08:
            axis_.jog(at, g.sp, values_of(group));
            break;
        case 0x09:
            axis_.move_by(at, reverse * distance, speed, values_of(group));
            break;
        case 0x0A:
            axis_.move_by(at, g.pr, speed, values_of(group));
            break;
        case 0x0B:
            axis_.move_to(at, g.pa, speed, values_of(group));
            break;
        default:
            break;
    }
}

TwinMechanics Device::mechanics(int channel, Instant now) const {
    if (channel != 1) return {};
    Axis axis = axis_;  // a question must not change it
    axis.follow(std::max(now, last_));
    const MotionState s = axis.shaft(std::max(now, last_));
    return {s.position, s.velocity, axis_.driver_on()};
}

}  // namespace axisgate::uim342::twin
