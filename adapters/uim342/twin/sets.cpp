// The SETs of all instructions, and the ones that do something (BG, ST, OG, SY).
// In: telegrams of a length that fits. Out: the acknowledgement, or the fault that kept the instruction from being executed.
// Never sends: instructions.cpp does.
#include <cmath>

#include "adapters/uim342/twin/device_reports.hpp"
#include "adapters/uim342/twin/telegrams.hpp"

namespace axisgate::uim342::twin {

Fault Device::set(const Telegram& t, Instant now, Telegram& reply, Out&) {
    switch (t.function()) {
        case MO:
            put_value(reply, t.d[0], 1);
            return set_driver(t.d[0], now);
        case BG:
            put_value(reply, 0, 4);
            return begin_motion(now);
        case ST:
            axis_.stop_fast(now, memory_.ram().sd);
            return Fault::none;
        case MF:
            if (t.d[0] == 1 || t.d[0] >= group_count) return Fault::data;
            wanted_.pending_group = t.d[0];
            put_value(reply, t.d[0], 1);
            return Fault::none;
        case OG:
            if (axis_.moving()) return Fault::origin_running;
            axis_.set_origin(now);
            return Fault::none;
        case DI:  // d0 the output, d1 = 1; answered by the image of all ports, not by what was written [L1677]
            if (t.d[0] > 1 || t.d[1] != 1 || t.d[2] != 0 || t.d[3] != 0) return Fault::data;
            flags_.output = t.d[0] == 1;
            put_ports(reply, inputs_.latched(), flags_.output);
            return Fault::none;
        default:
            return set_motion_value(t, reply);
    }
}

Fault Device::set_driver(std::uint8_t value, Instant now) {
    if (value > 1) return Fault::data;
    if (value == 0) {
        flags_.lock = false;  // the one way out of the lock besides a reboot
        enable_at_boot_ = false;
        driver_on_at_ = arrive_at_ = never;
    } else if (manners_.driver_on != Duration::zero() && !axis_.driver_on()) {
        if (driver_on_at_ == never) driver_on_at_ = now + manners_.driver_on;
        return Fault::none;
    }
    axis_.set_driver(value == 1, now);
    return Fault::none;
}

Fault Device::begin_motion(Instant now) {
    if (!axis_.driver_on()) return Fault::driver_off;
    if (flags_.lock || axis_.state() == Axis::State::emergency_stop) return Fault::stopping;
    flags_.paif = false;
    arrive_at_ = never;
    const double speed = std::abs(static_cast<double>(wanted_.speed));  // the sign of SP says nothing here [L799]
    if (!wanted_.ptp) {
        axis_.jog(now, wanted_.speed, values_of(0));
    } else if (wanted_.target_is_relative) {
        // What the distance comes to from here: DV[4] is where the motion ends, whichever way it was given.
        wanted_.absolute = wrap_i32(static_cast<double>(axis_.position(now)) + wanted_.relative);
        axis_.move_by(now, wanted_.relative, speed, values_of(0));
    } else {
        axis_.move_to(now, wanted_.absolute, speed, values_of(0));
    }
    return Fault::none;
}

Fault Device::set_motion_value(const Telegram& t, Telegram& reply) {
    const Settings& s = memory_.ram();
    const bool keep = !axis_.driver_on();
    const bool as_time = s.ic[4] == 1;
    const std::uint32_t n = value_of(t);
    const auto signed_n = static_cast<std::int32_t>(n);
    const std::size_t group = wanted_.take_group();
    switch (t.function()) {
        case AC:
            if (!ramp_takes(n, as_time)) return Fault::data;
            memory_.set(keep, [&](Settings& x) { x.group[group].ac = n; });
            put_value(reply, n, 4);
            return Fault::none;
        case DC:
            if (!ramp_takes(n, as_time)) return Fault::data;
            if (group == 0 && !as_time && n > s.sd) return Fault::sd_below_dc;
            memory_.set(keep, [&](Settings& x) { x.group[group].dc = n; });
            put_value(reply, n, 4);
            return Fault::none;
        case SS:
            memory_.set(keep, [&](Settings& x) { x.ss = n; });
            put_value(reply, n, 4);
            return Fault::none;
        case SD:
            if (!as_time && n < s.group[0].dc) return Fault::sd_below_dc;
            memory_.set(keep, [&](Settings& x) { x.sd = n; });
            put_value(reply, n, 4);
            return Fault::none;
        case BL:
            if (!bl_takes(n)) return Fault::data;
            memory_.set(keep, [&](Settings& x) { x.bl = n; });
            put_value(reply, n, 4);
            return Fault::none;
        case JV:
            wanted_.speed = signed_n;
            wanted_.ptp = false;
            put_desired(reply, 2, signed_n);
            return Fault::none;
        case SP:
            if (group == 0) {
                if (!wanted_.ptp) return Fault::syntax;  // "error #50" [L1453]
                wanted_.speed = signed_n;
            } else {
                memory_.set(keep, [&](Settings& x) { x.group[group].sp = signed_n; });
            }
            put_desired(reply, 2, signed_n);
            return Fault::none;
        case PR:
            if (group == 0) {
                wanted_.relative = signed_n;
                wanted_.ptp = wanted_.target_is_relative = true;
            } else {
                memory_.set(keep, [&](Settings& x) { x.group[group].pr = signed_n; });
            }
            put_desired(reply, 3, signed_n);
            return Fault::none;
        case PA:
            if (group == 0) {
                wanted_.absolute = signed_n;
                wanted_.ptp = true;
                wanted_.target_is_relative = false;
            } else {
                memory_.set(keep, [&](Settings& x) { x.group[group].pa = signed_n; });
            }
            put_desired(reply, 4, signed_n);
            return Fault::none;
        default:
            return Fault::syntax;
    }
}

/// SY: 1 starts the drive anew, 2 restores the factory's settings.
Fault Device::command_system(std::uint8_t i, Instant now, Out& out) {
    if (i != 1 && i != 2) return Fault::sub_index;
    if (i == 1) return restart(now, out), Fault::none;
    if (axis_.moving()) return Fault::running;
    memory_.restore_factory();
    inputs_.set_modes(memory_.ram().tg, now);
    configure_axis(now);
    if (manners_.restore_restarts) restart(now, out);
    return Fault::none;
}

void Device::restart(Instant now, Out& out) {
    axis_.set_driver(false, now);
    boot(now, axis_.place(now), manners_.restart);
    settle(now, out);
}

Fault Device::set_indexed(const Telegram& t, Instant now, Telegram& reply, Out& out) {
    const bool keep = !axis_.driver_on();
    const bool moving = axis_.moving();
    const std::uint8_t i = t.d[0];
    const auto n = static_cast<std::uint16_t>(t.d[1] | (t.d[2] << 8));
    switch (t.function()) {
        case PP:
            if (i != 5 && i != 7 && i != 8) return Fault::sub_index;
            if (!pp_takes(i, t.d[1])) return Fault::data;
            if (moving) return Fault::running;
            memory_.set_flash([&](Protocol& p) { (i == 5 ? p.bit_rate : (i == 7 ? p.node : p.group)) = t.d[1]; });
            put_indexed(reply, i, t.d[1], 1);
            return Fault::none;
        case IC:
            if (i >= memory_.ram().ic.size()) return Fault::sub_index;
            if (n > 1) return Fault::data;
            if (moving) return Fault::running;
            memory_.set(true, [&](Settings& s) { s.ic[i] = n; });  // it describes the power-on: kept whatever MO is
            if (i == 1 || i == 6) configure_axis(now);
            break;
        case IE: {
            const auto slot = ie_slot(i);
            if (!slot) return Fault::sub_index;
            if (n > 1) return Fault::data;
            memory_.set(keep, [&](Settings& s) { s.ie[*slot] = n; });
            break;
        }
        case QE:
            if (i >= memory_.ram().qe.size()) return Fault::sub_index;
            if (!qe_takes(i, n)) return Fault::data;
            if (moving) return Fault::running;
            memory_.set(keep, [&](Settings& s) { s.qe[i] = n; });
            if (i <= 2) configure_axis(now);
            break;
        case MT:
            if (i >= memory_.ram().mt.size()) return Fault::sub_index;
            if (!mt_takes(i, n)) return Fault::data;
            if (i == 0 && moving) return Fault::running;
            memory_.set(keep, [&](Settings& s) {
                s.mt[i] = n;
                if (i == 0) s.qe[4] = static_cast<std::uint16_t>(n * 200);  // pulses per turn follow [L1210, L1247]
            });
            break;
        case IL:
            if (i >= memory_.ram().il.size()) return Fault::sub_index;
            if (!il_takes(i, n)) return Fault::data;
            memory_.set(keep, [&](Settings& s) { s.il[i] = n; });
            break;
        case TG:
            if (i >= memory_.ram().tg.size()) return Fault::sub_index;
            if (!tg_takes(n)) return Fault::data;
            memory_.set(keep, [&](Settings& s) { s.tg[i] = n; });
            inputs_.set_mode(i, n, now);
            break;
        case ER:
            return clear_error(t, reply);
        case MS:
            if (i != 0) return Fault::sub_index;
            if (t.d[1] != 0) return Fault::data;
            flags_.paif = flags_.tlif = flags_.err = false;
            DeviceReports::fill_status(*this, reply, now);
            return Fault::none;
        case SY:
            return command_system(i, now, out);
        default:
            return Fault::syntax;
    }
    put_indexed(reply, i, n, 2);
    return Fault::none;
}

}  // namespace axisgate::uim342::twin
