// Motions that follow the master encoder of a simulated drive: cams, cams on a trigger, winding.
// In: motion commands of 06h, 10h..12h, 30h and 31h, the encoder's count. Out: a demand that belongs to the count.
// Never moves because an encoder turns, unless a command has coupled it; never jumps further than the lag limit allows: that is error
// 000Bh.
#include <algorithm>
#include <cmath>

#include "adapters/linmot/twin/bytes.hpp"
#include "adapters/linmot/twin/drive.hpp"

namespace axisgate::linmot::twin {

// --- where the count leads ----------------------------------------------------------------------------------------------------
bool Drive::follows() const noexcept {
    if (follow_ == Follow::cams) return memory.ram(0x1BA9) != 0;
    return follow_ != Follow::none;
}
std::span<const Cam> Drive::cams() const noexcept {
    const std::span<const Cam> all(cams_);
    return follow_ == Follow::shot ? all.subspan(shot, 1) : all.first(shot);
}
const Curve* Drive::curve_of(std::uint16_t id) const {
    const auto it = curves.find(id);
    return it == curves.end() || it->second.points() < 2 ? nullptr : &it->second;
}

/// Nothing: the count is not there yet, or a curve has gone; the demand rests.
std::optional<Followed> Drive::followed_at(double count) const {
    if (follow_ == Follow::winding) {
        const double turned = count - wound_from_;
        if (turned < 0) return std::nullopt;
        const double per_turn = std::max(1.0, memory.number(0x1291));
        const double adapted = adaptation_held_ ? *adaptation_held_ : turned - adaptation_lost_;
        const Curve* shape = wound_curve_ != 0 ? curve_of(wound_curve_) : nullptr;
        const double here = setup_.winding.at(turned, adapted, per_turn, shape);
        return Followed{here, setup_.winding.at(turned + 0.01, adapted, per_turn, shape) / 0.01 - here / 0.01};
    }
    const auto range = cam_range();
    const Cam* cam = cam_at(cams(), range, count);
    if (!cam || (follow_ == Follow::shot && count < cam->start)) return std::nullopt;
    const Curve* curve = curve_of(cam->curve);
    if (!curve) return std::nullopt;
    return cam->at(range.wrapped(count), *curve);
}

/// The next instant at which a count matters: the start of a cam on which something waits, the end of one that a trigger started.
Instant Drive::follow_due() const {
    const double speed = master_.speed();
    if (follow_ == Follow::none || follow_ == Follow::winding || speed == 0 || !controlled()) return never;
    const double here = master_.count(now_);
    Instant at = never;
    const auto take = [&](double count) {
        const double wait = (count - here) / speed;
        if (wait >= 0 && wait < 1e8) at = std::min(at, now_ + Duration{static_cast<std::int64_t>(std::ceil(wait * 1e9)) + 1});
    };
    if (follow_ == Follow::shot) {
        if (memory.ram(0x1527) == 0) take(cams_[shot].end());
        return at;
    }
    const bool waits = memory.ram(0x1528) == 0 || memory.ram(0x1BA9) == 0;
    const auto range = cam_range();
    for (const Cam& c : cams()) {
        if (!c.used() || (!waits && !c.next)) continue;
        if (const auto count = range.meets(here, c.start, speed > 0)) take(*count);
    }
    return at;
}

/// What the way from the last look to now has passed: starts of cams, the end of a triggered one.
void Drive::follow_step(Instant now) {
    const double from = follow_count_, to = master_.count(now);
    follow_count_ = to;
    if (follow_ == Follow::none || follow_ == Follow::winding) return;
    if (follow_ == Follow::shot) {
        const Cam& c = cams_[shot];
        if (to >= c.end() && memory.ram(0x1527) == 0) {
            const auto end = followed_at(c.end());
            follow_ = Follow::none;
            if (end) profile_.rest(end->position, now);
            target_ = profile_.target();
        }
        return;
    }
    const auto range = cam_range();
    for (Cam& c : std::span(cams_).first(shot)) {
        if (!c.used() || !range.passes(from, to, c.start)) continue;
        if (c.next) {
            std::tie(c.scale, c.length) = *c.next;
            c.next.reset();
        }
        // A cam starts where "cam start enable" allows it; where not, what was enabled ends here [L3986-3995].
        const bool may = memory.ram(0x1528) != 0, was = memory.ram(0x1BA9) != 0;
        if (may == was) continue;
        const double here = demand_at(now).position;
        memory.set_ram(0x1BA9, may ? 1 : 0);
        if (!may) profile_.rest(here, now);
    }
}

/// Couples the demand to the encoder. What would make it jump further than the lag limit is the error that the jump would be.
void Drive::follow_begin(Follow what, Instant now) {
    const Point before = demand_at(now);
    stop_play(now);
    streaming_ = indexing_ = force_watch_ = false;
    follow_ = what;
    follow_count_ = master_.count(now);
    profile_.rest(before.position, now);
    const auto to = follows() ? followed_at(follow_count_) : std::nullopt;
    if (const double limit = memory.number(0x1473); to && limit > 0 && std::fabs(to->position - before.position) > limit) {
        follow_ = Follow::none;
        raise(0x0B, now);
    }
}

void Drive::follow_end(Instant now) {
    stop_play(now);
    memory.set_ram(0x1BA9, 0);
    target_ = profile_.target();
}

// --- commands -----------------------------------------------------------------------------------------------------------------
void Drive::cam_command(std::uint16_t header, const Bytes& b, Instant now) {
    const auto master = static_cast<std::uint8_t>(header >> 8);
    const auto sub = static_cast<std::uint8_t>(header >> 4 & 0x0F);
    follow_step(now);
    if (master == 0x06) return sub == 4 ? start_shot(sub, b, now) : arm_cam(sub, b, now);
    if (master != 0x10) return define_cam(cams_[master - 0x11u], sub, b, now);
    switch (sub) {
        case 0:
            if (!cams_[0].used() && !cams_[1].used()) return raise(0x62, now);
            follow_end(now);
            memory.set_ram(0x1BA9, memory.ram(0x1528) != 0 ? 1 : 0);
            return follow_begin(Follow::cams, now);
        case 1:
            return follow_end(now);
        case 2: {  // to the place that belongs to the present count, with the predefined values
            follow_end(now);
            const auto to = followed_at(master_.count(now));
            if (!to) return raise(0x62, now);
            return start({0, to->position, predefined()}, now);
        }
        default:
            master_.name(signed32(b, 2), now);
            follow_count_ = master_.count(now);
            return;
    }
}

/// Scale and offset so that the curve goes from one place to the other; beyond 2000 % it is 0089h and nothing is defined.
void Drive::lay(Cam& cam, const Curve& of, double from, double to, Instant now) {
    const double span = of.last() - of.first();
    const double scale = span == 0 ? 1e9 : (to - from) / span;
    if (std::fabs(scale) > 20) return raise(0x89, now);
    cam.scale = scale;
    cam.offset = from - of.first() * scale;
    cam.defined = true;
}

/// 1y0..1y8 [L2985-3126]. Without a length of its own a cam has the x length of its curve.
void Drive::define_cam(Cam& cam, std::uint8_t sub, const Bytes& b, Instant now) {
    const auto counts = [](double n) { return std::max(1.0, std::fabs(n)); };
    if (sub == 6 || sub == 7) {
        const double here = demand_at(now).position;
        cam.enabled = sub == 6;
        if (follow_ == Follow::cams && !cams_[0].used() && !cams_[1].used()) profile_.rest(here, now);
        return;
    }
    if (sub == 8) {
        cam.next = std::pair{signed16(b, 2) / 1000, counts(signed32(b, 4))};
        return;
    }
    const Curve* curve = curve_of(at16(b, 2));
    if (!curve) return raise(0x62, now);
    const double here = actual_at(now).position + offset_;
    Cam made;
    made.curve = at16(b, 2);
    made.start = signed32(b, 4);
    made.length = counts(sub == 3 ? signed32(b, 16) : sub == 4 ? signed32(b, 12) : sub == 5 ? signed32(b, 10) : curve->x_length());
    switch (sub) {
        case 0:
            made.defined = true;
            break;
        case 1:
            made.offset = here - curve->first();
            made.defined = true;
            break;
        case 2:
        case 4:
            lay(made, *curve, here, signed32(b, 8), now);
            break;
        case 3:
            lay(made, *curve, signed32(b, 8), signed32(b, 12), now);
            break;
        default:
            made.scale = signed16(b, 8) / 1000;
            made.defined = true;
            break;
    }
    if (made.defined) cam = made;
}

/// 069, 06A, 06D on rising, 06B, 06C, 06E on falling edges: curve and delay go into their parameters, from where each edge takes them.
void Drive::arm_cam(std::uint8_t sub, const Bytes& b, Instant now) {
    if (!curve_of(at16(b, 2))) return raise(0x62, now);
    const bool rising = sub == 9 || sub == 0x0A || sub == 0x0D;
    memory.set_ram(rising ? 0x154A : 0x154B, at16(b, 2));
    memory.set_ram(rising ? 0x154C : 0x154D, at32(b, 4));
    event_ = {};
    event_.kind = rising ? Event::Kind::rising : Event::Kind::falling;
    event_.what = Event::What::cam;
    event_.order.sub = sub;
    event_.bytes = b;
}

void Drive::start_shot(std::uint8_t sub, const Bytes& b, Instant now) {
    const bool rising = sub == 9 || sub == 0x0A || sub == 0x0D, now_at_once = sub == 4;
    Cam made;
    made.curve = now_at_once ? at16(b, 2) : static_cast<std::uint16_t>(memory.ram(rising ? 0x154A : 0x154B));
    const Curve* curve = curve_of(made.curve);
    if (!curve) return raise(0x62, now);
    made.start = master_.count(now) + (now_at_once ? signed32(b, 4) : memory.number(rising ? 0x154C : 0x154D));
    const double here = demand_at(now).position;
    const bool to_target = sub == 0x0A || sub == 0x0C, scaled = sub == 0x0D || sub == 0x0E;
    made.length = std::max(1.0, std::fabs(to_target ? signed32(b, 12) : scaled ? signed32(b, 10) : curve->x_length()));
    if (to_target)
        lay(made, *curve, here, signed32(b, 8), now);
    else
        made.defined = true;
    if (scaled) made.scale = signed16(b, 8) / 1000;
    if (!made.defined) return;
    cams_[shot] = made;
    follow_begin(Follow::shot, now);
}

/// 300, 310 at once, 301, 311 from a revolution on; 304, 305 hold the adaptation of ends and disturbance and let it go on [L3128-3160].
void Drive::winding_command(std::uint16_t header, const Bytes& b, Instant now) {
    const auto sub = static_cast<std::uint8_t>(header >> 4 & 0x0F);
    const bool curve = header >> 8 == 0x31;
    const double count = master_.count(now), turned = count - wound_from_;
    if (!curve && sub >= 4) {
        if (follow_ != Follow::winding) return;
        if (sub == 4 && !adaptation_held_) adaptation_held_ = turned - adaptation_lost_;
        if (sub == 5 && adaptation_held_) {
            adaptation_lost_ = turned - *adaptation_held_;
            adaptation_held_.reset();
        }
        return;
    }
    wound_curve_ = curve ? at16(b, 2) : std::uint16_t{0};
    if (curve && !curve_of(wound_curve_)) return raise(0x62, now);
    const double at = sub == 1 ? signed32(b, curve ? 4 : 2) * std::max(1.0, memory.number(0x1291)) : count;
    wound_from_ = std::max(at, count);
    adaptation_lost_ = 0;
    adaptation_held_.reset();
    follow_begin(Follow::winding, now);
}

}  // namespace axisgate::linmot::twin
