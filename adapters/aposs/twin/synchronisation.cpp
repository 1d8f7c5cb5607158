// Corrections stay within their window, SYNCMMAXCORR and SYNCMSTART.
#include "adapters/aposs/twin/synchronisation.hpp"

#include <cstdlib>
#include <utility>

namespace axisgate::aposs {
namespace {
double as_real(std::int64_t v) { return static_cast<double>(v); }
}  // namespace

void Synchronisation::begin(SyncMode mode, const SyncParameters& p, const SyncInput& here, double command, double velocity) {
    const Synchronisation before = std::exchange(*this, {});
    mode_ = mode;
    master_at_ = here.master;
    wanted_ = command_ = command;
    velocity_ = velocity;
    accuracy_ = p.accuracy;
    master_.average.reset(as_real(p.pulse_m));
    slave_.average.reset(as_real(p.pulse_s));
    offset_allowed_ = mode == SyncMode::position;
    if (p.always_watches()) {  // the marker data up to now
        master_ = before.master_;
        slave_ = before.slave_;
        master_.count = slave_.count = 0;
        marker_velocity_ = before.marker_velocity_;
        status_.master_window = before.status_.master_window;
        status_.slave_window = before.status_.slave_window;
    }
    if (mode != SyncMode::marker || p.start % 1000 != 7) return;
    // The known marker that would have been the last one: markers are observed from there on.
    if (here.master_marker)
        master_.last = as_real(here.master) - within_cycle(as_real(here.master - *here.master_marker), as_real(p.pulse_m));
    if (here.slave_marker) slave_.last = here.slave - within_cycle(here.slave - *here.slave_marker, as_real(p.pulse_s));
    approach_.begin();
}

void Synchronisation::shift_master(std::int64_t by) {
    master_at_ -= by;
    if (master_.last) *master_.last -= as_real(by);
    approach_.shift_master(as_real(by));
}

void Synchronisation::watch(const SyncParameters& p, const SyncInput& in) {
    if (!p.always_watches() || mode_ == SyncMode::marker) return;
    if (mode_ == SyncMode::none) {
        const auto way = as_real(in.master - std::exchange(master_at_, in.master));
        marker_velocity_ = p.velocity_time < 0 ? pt(marker_velocity_, way, velocity_filter_us(p.velocity_time, p.resolution) / 1000) : way;
    }
    (void)check_markers(p, in);
}

/// SYNCMSTART 7: the position of the slave during the approach. At its end the slave is synchronous, or SYNCMSTART 5 applies.
double Synchronisation::approach(const SyncParameters& p, const SyncInput& in, std::int64_t way) {
    (void)check_markers(p, in);
    const double gear = as_real(p.fact_s) / as_real(p.fact_m);
    offset_seen_ = p.start < 1000 ? p.offset : 0;
    ApproachInput now{as_real(in.master), as_real(way), master_.last, slave_.last, command_, velocity_};
    if (now.slave_marker) *now.slave_marker += as_real(offset_seen_);
    const ApproachMaster to{gear, as_real(p.pulse_m), as_real(p.pulse_s) * as_real(std::max<std::int64_t>(1, p.mark_s)),
                            std::max(50.0, p.velocity_time < 0 ? velocity_filter_us(p.velocity_time, p.resolution) / 1000 : 0)};
    const double before = command_;
    command_ = approach_.step(to, {p.velocity, p.acceleration, p.jerk}, now);
    velocity_ = command_ - before;
    if (approach_.active()) return command_;
    rest_ = 0;
    wanted_ = command_;
    offset_allowed_ = offset_seen_ != 0;
    if (!approach_.arrived()) return command_;
    synchronous_ = paired_ = true;
    offset_allowed_ = true;
    wanted_ = *now.slave_marker + (now.master - *master_.last) * gear;  // exactly; the curve has reached it except for rounding
    wanted_ = command_ + nearest(wanted_ - command_, to.cycle);
    evaluate(p, wanted_ - command_);
    return command_;
}

/// SYNCTYPE bit 2: distances that the master moves back are stored, and the slave does not follow the same distance forward [L4036-4050].
std::int64_t Synchronisation::forward(std::int64_t way, const SyncParameters& p) {
    if ((p.type & 4) == 0) return way;
    const std::int64_t side = p.fact_m < 0 ? -1 : 1;
    if (way * side < 0) {
        negative_ += std::abs(way);
        return 0;
    }
    const std::int64_t used = std::min(negative_, std::abs(way));
    negative_ -= used;
    return way - side * used;
}
/// Whole quad counts of the slave; the remainder of the division is kept for the next step.
std::int64_t Synchronisation::geared(std::int64_t way, const SyncParameters& p) {
    rest_ += way * p.fact_s;
    const std::int64_t whole = rest_ / p.fact_m;
    rest_ -= whole * p.fact_m;
    return whole;
}

double Synchronisation::step(const SyncParameters& p, const SyncInput& in) {
    if (mode_ == SyncMode::none) return command_;
    const std::int64_t way = forward(in.master - master_at_, p);
    master_at_ = in.master;
    const double tau = velocity_filter_us(p.velocity_time, p.resolution);
    marker_velocity_ = p.velocity_time < 0 ? pt(marker_velocity_, as_real(way), tau / 1000) : as_real(way);
    if (approach_.active()) return approach(p, in, way);
    const auto act = as_real(geared(way, p));
    const bool filtered = mode_ == SyncMode::velocity || p.velocity_time < 0;
    double ahead = act;
    if (filtered) ahead = filter_.step(act, tau, as_real(p.velocity_limit), mode_ != SyncMode::velocity);
    if (mode_ == SyncMode::marker && p.velocity_limit > 0 && as_real(++since_filter_reset_) * 1000 >= tau) {
        since_filter_reset_ = 0;  // it only increases there [L5988-5990]
        filter_.forget_error();
    }
    filtered_velocity_ = ahead;

    if (mode_ == SyncMode::velocity) {
        wanted_ = command_ + ahead;
    } else {
        wanted_ += ahead;
        if (mode_ == SyncMode::marker) {
            if (p.filter_time > 0 && (p.filter_par & 2) == 0)  // the gear is corrected by the marker distances
                wanted_ += act * master_.average.gear_correction(as_real(p.pulse_m));
            take_markers(p, in);
            const double part = std::fabs(per_ms_left_) < std::fabs(per_ms_) ? per_ms_left_ : per_ms_;
            per_ms_left_ -= part;
            wanted_ += part + correction_.step(p.pulse_m, p.offset_time);
        }
        if (offset_allowed_) offset_.add(as_real(p.offset - std::exchange(offset_seen_, p.offset)));  // at once, whenever it is set
        wanted_ += offset_.step(p.pulse_m, p.offset_time);
    }
    const double before = command_;
    command_ = follow(p);
    velocity_ = command_ - before;
    if (mode_ == SyncMode::velocity) wanted_ = command_;  // lost distance is not made up for
    error_ = wanted_ + filter_.error() - in.slave;
    if (mode_ == SyncMode::velocity) error_ = 0;
    if (mode_ == SyncMode::position) status_.accuracy = std::fabs(error_) <= as_real(std::abs(accuracy_));
    const double lead = mode_ == SyncMode::velocity ? 0 : velocity_ * as_real(p.feed_forward) / 1000;
    return command_ + lead;
}

/// Moves towards the wanted position within VEL, ACC, DEC and SYNCVELREL.
double Synchronisation::follow(const SyncParameters& p) {
    const double master = filtered_velocity_;
    const double left = wanted_ - command_ - master, size = std::fabs(left), rate_down = p.deceleration;  // in addition to the present way
                                                                                                          // of the master
    // The speed from which steps of DEC end at the position: v (v + d) / 2d = remaining distance.
    const double most = std::sqrt(rate_down * rate_down / 4 + 2 * rate_down * size) - rate_down / 2;
    const double catching = std::copysign(std::min(size, most), left);
    double v = master + catching;
    if (p.velocity_relation > 0) {
        const double part = std::fabs(master) * as_real(p.velocity_relation) / 100, side = std::copysign(1.0, master);
        v = side * std::clamp(side * v, std::fabs(master) - part, std::fabs(master) + part);
    }
    v = std::clamp(v, -p.velocity, p.velocity);
    if (p.reverse == 2 || (p.reverse == 1 && master >= 0)) v = std::max(v, 0.0);
    const double change = v - velocity_, rate = std::fabs(v) > std::fabs(velocity_) ? p.acceleration : p.deceleration;
    v = velocity_ + std::clamp(change, -rate, rate);
    if (p.reverse == 2 && velocity_ >= 0) v = std::max(v, 0.0);
    if (std::fabs(v - master) <= rate) synchronous_ = true;
    return command_ + v;
}

/// Whether a marker counts. A marker before its window is ignored; after the window one is missing, and the next one is measured from here.
bool Synchronisation::accepts(Markers& m, double place, std::int64_t pulse, std::int64_t window, bool& flag, std::int64_t filter_time,
                              const SyncParameters& p) {
    if (!m.last) {  // observed from the first one on [L5027]
        m.last = place;
        return true;
    }
    const double distance = std::fabs(place - *m.last);
    const bool outside = window > 0 && std::fabs(distance - as_real(pulse)) > as_real(window);
    if (outside) flag = true;
    if (!outside || distance > as_real(pulse)) m.last = place;
    if (outside) return false;
    if (filter_time > 0 && m.average.distance() <= 0) m.average.reset(as_real(pulse));
    if (filter_time > 0) m.average.add(distance, as_real(pulse), marker_filter(p.filter_par, filter_time, marker_velocity_, pulse));
    return true;
}

/// Whether the markers of this step count: master, slave.
std::pair<bool, bool> Synchronisation::check_markers(const SyncParameters& p, const SyncInput& in) {
    const bool master =
        in.master_marker && accepts(master_, as_real(*in.master_marker), p.pulse_m, p.window_m, status_.master_window, p.filter_time, p);
    const bool slave =
        in.slave_marker && accepts(slave_, *in.slave_marker, p.pulse_s, p.window_s, status_.slave_window, p.slave_filter_time, p);
    return {master, slave};
}

void Synchronisation::take_markers(const SyncParameters& p, const SyncInput& in) {
    const std::int64_t kind = p.start % 1000 == 7 ? 5 : p.start % 1000;
    const bool waits = kind >= 2 && kind <= 5 && !paired_ && !synchronous_;
    const auto [good_m, good_s] = check_markers(p, in);
    if (in.master_marker) {
        const double back = as_real(in.master - *in.master_marker) * as_real(p.fact_s) / as_real(p.fact_m);
        const bool good = good_m;
        if (!waits && good && (!paired_ ? !master_mark_ || kind == 1 : ++master_.count >= p.mark_m)) {
            master_.count = 0;
            master_mark_ = wanted_ - back;
        }
        if (!good && paired_) {  // the missing marker of the other side is not replaced [L5022]
            master_.count = 0;
            slave_mark_.reset();
        }
    }
    if (in.slave_marker) {
        const bool good = good_s;
        // Leading: the slave's marker after the first one of the master [L4466].
        const bool early = !paired_ && kind == 0 && !master_mark_;
        if (!waits && !early && good && (!paired_ ? !slave_mark_ : ++slave_.count >= p.mark_s)) {
            slave_.count = 0;
            slave_mark_ = *in.slave_marker;
            if (!paired_ && kind == 1) master_mark_.reset();  // the master's next marker
        }
        if (!good && paired_) {
            slave_.count = 0;
            master_mark_.reset();
        }
    }
    if (!master_mark_ || !slave_mark_) return;
    pair(p, *master_mark_, *slave_mark_);
    master_mark_.reset();
    slave_mark_.reset();
}

/// A marker of each side: the distance by which the wanted position must be shifted so that they coincide.
void Synchronisation::pair(const SyncParameters& p, double wanted, double place) {
    const double cycle = as_real(p.pulse_s) * as_real(std::max<std::int64_t>(1, p.mark_s));
    const bool first = !paired_;
    double difference = place + as_real(offset_seen_) - offset_.left() - wanted;
    difference = first ? first_correction(p, difference, cycle) : nearest(difference, cycle);
    if (p.filter_time > 0 && (p.filter_par & 16) == 0) difference += master_.average.deviation() * as_real(p.fact_s) / as_real(p.fact_m);
    if (p.slave_filter_time > 0 && (p.filter_par & 16) == 0) difference -= slave_.average.deviation();
    paired_ = true;
    evaluate(p, difference);
    if (p.most_correction >= 0) {
        if (p.most_correction > 0) difference = std::clamp(difference, -as_real(p.most_correction), as_real(p.most_correction));
        if (first && p.filter_time > 0) {
            start_rest_ = difference;
            const double markers = std::max(1.0, as_real(p.offset_time) * std::fabs(marker_velocity_) / std::max(1.0, as_real(p.pulse_m)));
            start_value_ = difference / markers;
        }
        correct(p, difference);
    }
    // SYNCPOSOFFS: with the first evaluation; 1000 to 1007: after the first correction is complete [L4137, L4484].
    offset_allowed_ = offset_allowed_ || p.start < 1000 || !first;
}

double Synchronisation::first_correction(const SyncParameters& p, double difference, double cycle) const {
    const std::int64_t kind = p.start % 1000;
    const double near = nearest(difference, cycle);
    if (cycle <= 0) return difference;
    if (kind == 3) return near < 0 ? near + cycle : near;  // forward
    if (kind == 4) return near > 0 ? near - cycle : near;  // backward
    if (kind == 5 || kind == 7) return near;               // 7 if its curve is not possible (E-79)
    return difference;
}

void Synchronisation::correct(const SyncParameters& p, double difference) {
    if (p.filter_time <= 0) {
        if (p.velocity_time < 0) {  // distributed over -SYNCVFTIME/100 ms
            per_ms_left_ = difference;
            per_ms_ = difference / as_real(std::max<std::int64_t>(-p.velocity_time / 100, 1));
            return;
        }
        correction_.reset();
        correction_.add(difference);
        return;
    }
    // From firmware 6.2.35 on [L2565-2590].
    const double speed = std::fabs(marker_velocity_), pulse = std::max(1.0, as_real(p.pulse_m));
    const double tau = (p.filter_par & 4) ? marker_filter(p.filter_par, p.filter_time, marker_velocity_, p.pulse_m)
                                          : as_real(p.offset_time) * speed / pulse;
    smoothed_ = pt(smoothed_, difference - start_rest_, tau);
    const double start = std::fabs(start_rest_) < std::fabs(start_value_) ? start_rest_ : start_value_;
    start_rest_ -= start;
    per_ms_left_ = smoothed_ + start;
    per_ms_ = per_ms_left_ / std::max(1.0, speed > 0 ? pulse / speed : 1.0);
}

void Synchronisation::evaluate(const SyncParameters& p, double difference) {
    status_.accuracy = std::fabs(difference) <= as_real(std::abs(accuracy_));
    accurate_ = status_.accuracy ? accurate_ + 1 : 0;  // E-42
    inaccurate_ = status_.accuracy ? 0 : inaccurate_ + 1;
    status_.ready = accurate_ >= p.ready && status_.accuracy;
    status_.fault = inaccurate_ >= p.fault && !status_.accuracy;
}

}  // namespace axisgate::aposs
