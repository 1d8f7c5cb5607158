// The interpreter: what the 216 motion commands of the manual do in a simulated drive.
// In: the motion command buffer. Out: motions, armed events, changed parameters, errors 0081h and 0086h.
// Never moves for a header whose count did not change, and never carries out half a command.
#include <algorithm>
#include <cmath>

#include "adapters/linmot/twin/bytes.hpp"
#include "adapters/linmot/twin/drive.hpp"

namespace axisgate::linmot::twin {
namespace {
constexpr double velocity_count = 10, acceleration_count = 100;  // 1e-6 m/s and 1e-5 m/s2 in 0.1 um

/// Sub IDs of each master ID, a bit each [L548-901].
constexpr std::uint16_t subs_of(std::uint8_t master) {
    switch (master) {
        case 0x00:
            return 0x031F;
        case 0x01:
            return 0xFFFF;
        case 0x02:
            return 0xFD9F;
        case 0x03:
            return 0x8007;
        case 0x04:
            return 0xD4FF;
        case 0x05:
            return 0x0077;
        case 0x06:
            return 0x7E10;
        case 0x07:
            return 0xC003;
        case 0x09:
            return 0xFDFF;
        case 0x0A:
            return 0x3D9F;
        case 0x0B:
            return 0x3D1F;
        case 0x0C:
            return 0xFDFF;
        case 0x0D:
            return 0xC0F3;
        case 0x10:
            return 0x0017;
        case 0x11:
        case 0x12:
            return 0x01FF;
        case 0x20:
            return 0x0307;
        case 0x21:
            return 0x031F;
        case 0x22:
            return 0xCFFF;
        case 0x24:
            return 0x730F;
        case 0x25:
            return 0xFFCF;
        case 0x26:
            return 0x003D;
        case 0x30:
            return 0x0033;
        case 0x31:
            return 0x0003;
        case 0x38:
            return 0x003F;
        default:
            return 0;
    }
}
}  // namespace

bool Drive::listed(std::uint16_t header) noexcept {
    return (subs_of(static_cast<std::uint8_t>(header >> 8)) >> (header >> 4 & 0x0F) & 1) != 0;
}

bool Drive::has(std::uint16_t header) const noexcept {
    if (!listed(header)) return false;
    const auto master = static_cast<std::uint8_t>(header >> 8);
    if (master == 0x38) return setup_.force_key;
    if (setup_.series == Series::e1100) return true;
    switch (master) {
        case 0x05:
        case 0x0B:
        case 0x30:
            return false;  // winding by the text of the manual (E-28)
        case 0x04:
        case 0x06:
        case 0x10:
        case 0x11:
        case 0x12:
        case 0x31:
            return setup_.curve_key;
        default:
            break;
    }
    const std::uint16_t h = header & 0xFFF0;
    return h != 0x0040 && h != 0x2080 && h != 0x2090 && h != 0x2630;
}

void Drive::write_motion_command(std::span<const std::uint8_t> bytes, Instant now) {
    advance(now);
    if (!running_ || bytes.size() < 2) return;
    std::copy_n(bytes.begin(), std::min(bytes.size(), buffer_.size()), buffer_.begin());
    const std::uint16_t header = at16(buffer_, 0);
    if ((header & 0x0F) == (echo_ & 0x0F)) return;  // the count alone decides, whatever the rest says [L545-547]
    echo_ = static_cast<std::uint8_t>(header & 0x0F);
    last_header_ = header;
    execute(header, buffer_, false, now);
    evaluate(now);
}

void Drive::execute(std::uint16_t header, const Bytes& b, bool from_table, Instant now) {
    const auto master = static_cast<std::uint8_t>(header >> 8);
    const auto sub = static_cast<std::uint8_t>(header >> 4 & 0x0F);
    const bool anywhere = master == 0 && sub <= 8;
    if (state_ == error || state_ == setup_error) {
        if (!anywhere) return;  // dropped: the first code stays (choice O-01)
    } else if (!has(header)) {
        return raise(0x81, now);
    } else if (!anywhere && state_ != operation_enabled) {
        return raise(0x86, now);
    }
    ++commands_done_;
    // An immediate motion command empties the queue of one, and ends a running sequence unless it belongs to it (choices O-08, O-16).
    const bool waits_or_branches = master >= 0x20 && master <= 0x26;
    const bool arms = (master == 1 || master == 2 || master == 9 || master == 0x0A || master == 0x0B || master == 0x0C)
                          ? sub >= 0x0A && !((master == 2 || master == 0x0C) && sub >= 0x0E)
                          : (master == 4 && sub >= 6) || (master == 6 && sub >= 9);
    const bool defines = (master >= 0x10 && master <= 0x12 && (master != 0x10 || sub == 4)) || (master == 0x30 && sub >= 4);
    if (master != 0 && !waits_or_branches && !arms && !defines && sub != 8 && master != 5) {
        after_.reset();
        if (!from_table) end_table();
    }
    switch (master) {
        case 0x00:
            return general(sub, b, now);
        case 0x01:
        case 0x02:
        case 0x09:
        case 0x0A:
        case 0x0B:
        case 0x0C:
        case 0x0D:
        case 0x07:
            return interpolator(header, b, now);
        case 0x03:
            return stream(sub, b, now);
        case 0x04:
        case 0x05:
            return curve_command(header, b, now);
        case 0x06:
        case 0x10:
        case 0x11:
        case 0x12:
            return cam_command(header, b, now);
        case 0x30:
        case 0x31:
            return winding_command(header, b, now);
        case 0x38:
            return force_command(sub, b, now);
        default:
            return table_command(header, b, from_table, now);
    }
}

void Drive::general(std::uint8_t sub, const Bytes& b, Instant now) {
    const auto masked = [&](std::uint16_t& word) { word = static_cast<std::uint16_t>((word & ~at16(b, 2)) | (at16(b, 4) & at16(b, 2))); };
    switch (sub) {
        case 1:
            interface_word_ = at16(b, 2);
            compute_control_word(now);
            return;
        case 2:
            if (const auto* f = memory.facts(at16(b, 2)); f && f->live()) {  // others: ignored (choice O-24)
                follow_step(now);
                const double here = demand_at(now).position;
                memory.set_ram(at16(b, 2), at32(b, 4));
                if (follow_ != Follow::none && !follows()) profile_.rest(here, now);  // "cam enabled" was cleared: it rests there
            }
            return;
        case 3:
            return masked(x4_outputs_);
        case 4:
            return masked(x6_outputs_);
        case 8:
            event_ = {};
            indexing_ = false;
            return;
        case 9: {  // homing at the actual position, without state 9 [L1000-1004]
            const double here = actual_at(now).position;
            const double shift = signed32(b, 2) - (here + offset_);
            memory.set_ram(0x13C7, at32(b, 2));
            memory.set_ram(0x13CA, static_cast<std::uint32_t>(static_cast<std::int32_t>(memory.number(0x13CA) + shift)));
            offset_ += shift;
            profile_.rest(here + offset_, now);
            target_ = here + offset_;
            homed_ = true;
            return;
        }
        default:
            return;
    }
}

Ramps Drive::predefined() const {
    return {memory.number(0x14BE) * velocity_count, memory.number(0x14BF) * acceleration_count, memory.number(0x14C0) * acceleration_count};
}

void Drive::interpolator(std::uint16_t header, const Bytes& b, Instant now) {
    const auto master = static_cast<std::uint8_t>(header >> 8);
    auto sub = static_cast<std::uint8_t>(header >> 4 & 0x0F);
    const auto v32 = [&](std::size_t at) { return at32(b, at) * velocity_count; };
    const auto a32 = [&](std::size_t at) { return at32(b, at) * acceleration_count; };
    const auto v16 = [&](std::size_t at) { return at16(b, at) * velocity_count; };  // 16-bit factors are neutral (choice O-19)
    const auto a16 = [&](std::size_t at) { return at16(b, at) * acceleration_count; };
    Order o;
    o.sub = sub;
    o.ramps = predefined();
    bool press = false, endless = false;
    switch (master) {
        case 0x01:
            if (sub == 7) return stop_motion(a32(2), now);
            if (sub == 9) {
                o = {0, static_cast<double>(outside_.analog), {v32(2), a32(6), a32(10)}};
                break;
            }
            o.value = signed32(b, 2);
            o.ramps = {v32(6), a32(10), a32(14)};
            break;
        case 0x02:
            if (sub == 7) return stop_motion(quick_deceleration(), now);
            endless = sub >= 0x0E;
            o.value = signed32(b, 2);
            break;
        case 0x09:
            if (sub == 7) return stop_motion(a16(2), now);
            o.value = signed16(b, 2);
            o.ramps = {v16(4), a16(6), a16(8)};
            break;
        case 0x0A:
            if (sub == 7) return stop_motion(quick_deceleration(), now);
            o.value = signed16(b, 2);
            break;
        case 0x0B:
            o.value = signed32(b, 2);
            o.ramps.velocity = v32(6);
            break;
        case 0x0C:
            endless = sub >= 0x0E;
            if (endless) {
                o.ramps = {v32(2), a32(6), a32(6)};
                break;
            }
            o.value = signed32(b, 2);
            o.ramps = {v32(6), a32(10), a32(10)};
            press = sub >= 5 && sub <= 7;
            if (press) {
                const std::uint16_t most = at16(b, 14);
                if (most == 0) return raise(0x63, now);
                memory.set_ram(0x13A6, most);  // controller set A is the active one; the value stays [L2687-2750]
                o.sub = sub == 5 ? 0 : sub == 6 ? 3 : 4;
            }
            break;
        case 0x0D:
            if (sub == 0)
                o = {0, captured_ + signed32(b, 2), {v32(6), a32(10), a32(14)}};
            else if (sub == 1)
                o = {0, signed16(b, 2), {v16(4), a16(6), a16(6)}};
            else if (sub >= 0x0E)
                o = {0, sub == 0x0E ? setup_.trig_rise : setup_.trig_fall, predefined()};
            else
                o = {static_cast<std::uint8_t>(sub >= 6 ? 3 : 0),
                     memory.number((sub & 1) == 0 ? 0x1E72 : 0x1E73),
                     {v32(2), a32(6), a32(10)}};
            break;
        case 0x07:
            o.value = signed32(b, 2);
            if (sub == 0 || sub == 0x0E) o.ramps = {v32(6), a32(10), a32(14)};
            if (sub <= 1) {
                indexing_ = true;
                index_base_ = o.value;
                index_ramps_ = o.ramps;  // latched once [L2043]
                stop_play(now);
                streaming_ = false;
                return index(now);
            }
            indexing_ = false;
            o.sub = 0;
            break;
        default:
            return;
    }
    sub = o.sub;
    const bool arms = !endless && sub >= 0x0A, later = !endless && sub == 8 && motion_active();
    if (!arms && !later) {
        stop_play(now);
        streaming_ = force_watch_ = false;
    }
    if (endless) {
        last_ramps_ = o.ramps;
        vai_ever_ = true;
        profile_.run(now, demand_at(now), sub == 0x0E ? 1 : -1, o.ramps);
        return;
    }
    if (sub == 8) {
        o.sub = 0;
        if (later) {
            after_ = o;
            return;
        }
    }
    if (arms) {
        event_ = {};
        event_.header = header;
        event_.order = o;
        const bool rising = sub <= 0x0B, transition = sub >= 0x0E;
        event_.kind = transition ? (sub == 0x0E ? Event::Kind::upwards : Event::Kind::downwards)
                      : rising   ? Event::Kind::rising
                                 : Event::Kind::falling;
        event_.what = transition ? Event::What::change : Event::What::vai;
        event_.position = o.value;
        event_.order.sub = sub == 0x0B || sub == 0x0D ? 2 : 0;
        return;
    }
    start(o, now);
}

/// Start rules by sub ID: what the target is, and from where the profile begins.
void Drive::start(const Order& o, Instant now) {
    Point from = demand_at(now);
    Point act = actual_at(now);
    act.position += offset_;
    double target = o.value;
    switch (o.sub) {
        case 1:
            target += from.position;
            break;
        case 2:
            target += target_;
            break;
        case 3:
            from = act;
            break;
        case 4:
            from = {act.position, 0};
            break;
        case 5:
            target += act.position;
            break;
        case 6:
            target += act.position;
            from = {act.position, 0};
            break;
        default:
            break;
    }
    stop_play(now);
    vai_ever_ = true;
    target_ = target;
    last_ramps_ = o.ramps;
    profile_.move(now, from, target, o.ramps);
}

void Drive::stop_motion(double deceleration, Instant now) {
    const Point from = demand_at(now);
    stop_play(now);
    streaming_ = false;
    after_.reset();
    profile_.stop(now, from, std::max(deceleration, 1.0));
    target_ = profile_.target();
}

void Drive::stop_play(Instant now) {
    if (!play_.active && follow_ == Follow::none) return;
    const Point p = demand_at(now);
    play_.active = false;
    follow_ = Follow::none;
    profile_.rest(p.position, now);
}

/// Position indexing: the master encoder's counts are added to the target, one unit per count (choice E-23).
void Drive::index(Instant now) {
    target_ = index_base_ + std::nearbyint(master_.count(now));
    last_ramps_ = index_ramps_;
    vai_ever_ = true;
    profile_.move(now, demand_at(now), target_, index_ramps_);
}

void Drive::force_command(std::uint8_t sub, const Bytes& b, Instant now) {
    if (sub == 2) {
        if (force_control_) force_target_ = at16(b, 2);
        return;
    }
    Order o{0, signed32(b, 2), {at32(b, 6) * velocity_count, at32(b, 10) * acceleration_count, at32(b, 10) * acceleration_count}};
    if (sub == 1) {
        o.sub = 3;
        o.ramps.deceleration = at32(b, 14) * acceleration_count;
        force_watch_ = force_control_ = false;
        return start(o, now);
    }
    force_higher_ = sub == 0 || sub == 3;
    force_limit_ = at16(b, 14);
    force_target_ = sub == 3 || sub == 5 ? at16(b, 16) : force_limit_;
    force_watch_ = true;
    force_control_ = false;
    start(o, now);
    check_outside(now);
}

/// Set points of a stream, delayed by 1.5 periods; the period is measured over the first ones, or configured (032xh) [L3914-3944].
void Drive::stream(std::uint8_t sub, const Bytes& b, Instant now) {
    if (sub == 0x0F) {
        if (!streaming_) return;
        const Point p = demand_at(now);
        streaming_ = false;
        stream_points_.clear();
        profile_.rest(p.position, now);
        target_ = p.position;
        return;
    }
    const Point here = demand_at(now);
    if (!streaming_) {
        streaming_ = true;
        stream_count_ = 0;
        stream_period_ =
            sub == 2 ? std::chrono::milliseconds(static_cast<std::int64_t>(std::clamp(memory.number(0x14E6), 2.0, 5.0))) : Duration{};
        stream_points_.clear();
        stream_points_.emplace_back(now, here);
    } else if (sub != 2 && stream_count_ < 3) {
        const Duration gap = now - stream_last_;
        if (gap < std::chrono::milliseconds(2)) return streaming_ = false, profile_.rest(here.position, now), raise(0x84, now);
        if (gap > std::chrono::milliseconds(5)) return streaming_ = false, profile_.rest(here.position, now), raise(0x85, now);
        stream_period_ = gap;
    }
    ++stream_count_;
    stream_last_ = now;
    if (stream_points_.size() > 5) {
        streaming_ = false;
        profile_.rest(here.position, now);
        return raise(0x82, now);
    }
    const Duration period = stream_period_ > Duration{} ? stream_period_ : Duration{std::chrono::milliseconds(2)};
    stream_points_.emplace_back(std::max(now + period * 3 / 2, stream_points_.back().first + Duration{1}),
                                Point{signed32(b, 2), sub == 1 ? signed32(b, 6) * velocity_count : 0});
    stream_velocities_ = sub == 1;
    target_ = signed32(b, 2);
}

}  // namespace axisgate::linmot::twin
