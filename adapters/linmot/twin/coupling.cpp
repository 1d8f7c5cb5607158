#include "adapters/linmot/twin/coupling.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "adapters/linmot/twin/bytes.hpp"

namespace axisgate::linmot::twin {

// --- where the count leads ----------------------------------------------------------------------------------------------------
std::span<const Cam> Coupling::cams() const noexcept {
    const std::span<const Cam> all(cams_);
    return mode_ == Mode::shot ? all.subspan(shot, 1) : all.first(shot);
}

double Coupling::per_turn() const noexcept { return std::max(1.0, memory_.number(0x1291)); }

std::optional<Point> Coupling::at(Instant now) const {
    const auto f = place(master_.count(now));
    if (!f) return std::nullopt;
    return Point{f->position, f->slope * master_.speed()};
}

std::optional<Followed> Coupling::place(double count) const {
    if (mode_ == Mode::winding) {
        const double turned = count - wound_from_;
        if (turned < 0) return std::nullopt;
        const double adapted = adaptation_held_ ? *adaptation_held_ : turned - adaptation_lost_;
        const Curve* shape = wound_curve_ != 0 ? curve_of(curves_, wound_curve_) : nullptr;
        const double here = winding_.at(turned, adapted, per_turn(), shape);
        return Followed{here, winding_.at(turned + 0.01, adapted, per_turn(), shape) / 0.01 - here / 0.01};
    }
    const auto range = this->range();
    const Cam* cam = cam_at(cams(), range, count);
    if (!cam || (mode_ == Mode::shot && count < cam->start)) return std::nullopt;
    const Curve* curve = curve_of(curves_, cam->curve);
    if (!curve) return std::nullopt;
    return cam->at(range.wrapped(count), *curve);
}

Instant Coupling::due(Instant now) const {
    const double speed = master_.speed();
    if (mode_ == Mode::none || mode_ == Mode::winding || speed == 0) return never;
    const double here = master_.count(now);
    Instant at = never;
    const auto take = [&](double count) {
        const double wait = (count - here) / speed;
        if (wait >= 0 && wait < 1e8) at = std::min(at, now + Duration{static_cast<std::int64_t>(std::ceil(wait * 1e9)) + 1});
    };
    if (mode_ == Mode::shot) {
        if (memory_.ram(0x1527) == 0) take(cams_[shot].end());
        return at;
    }
    const bool waits = memory_.ram(0x1528) == 0 || memory_.ram(0x1BA9) == 0;
    const auto range = this->range();
    for (const Cam& c : cams()) {
        if (!c.used() || (!waits && !c.next)) continue;
        if (const auto count = range.meets(here, c.start, speed > 0)) take(*count);
    }
    return at;
}

Coupling::Step Coupling::step(Instant now) {
    const double from = count_, to = master_.count(now);
    count_ = to;
    Step step;
    if (mode_ == Mode::none || mode_ == Mode::winding) return step;
    if (mode_ == Mode::shot) {
        const Cam& c = cams_[shot];
        if (to < c.end() || memory_.ram(0x1527) != 0) return step;
        step.what = Passed::shot_over;
        if (const auto end = place(c.end())) step.place = end->position;
        mode_ = Mode::none;
        return step;
    }
    const auto range = this->range();
    for (Cam& c : std::span(cams_).first(shot)) {
        if (!c.used() || !range.passes(from, to, c.start)) continue;
        if (c.next) {
            std::tie(c.scale, c.length) = *c.next;
            c.next.reset();
        }
        // A cam starts only where "cam start enable" permits it; where it does not, an enabled cam ends here [L3986-3995].
        const bool may = memory_.ram(0x1528) != 0, was = memory_.ram(0x1BA9) != 0;
        if (may == was) continue;
        if (!may) {
            step.what = Passed::released;
            if (const auto here = place(to)) step.place = here->position;
        }
        memory_.set_ram(0x1BA9, may ? 1 : 0);
    }
    return step;
}

// --- definitions --------------------------------------------------------------------------------------------------------------
/// Scale and offset so that the curve leads from one position to the other; more than 2000 % is error 0089h.
Fault Coupling::lay(Cam& cam, const Curve& of, double from, double to) noexcept {
    const double span = of.last() - of.first();
    const double scale = span == 0 ? 1e9 : (to - from) / span;
    if (std::fabs(scale) > 20) return 0x89;
    cam.scale = scale;
    cam.offset = from - of.first() * scale;
    return 0;
}

/// [L2985-3126]. A cam without its own length has the x length of its curve.
Fault Coupling::define(std::size_t index, std::uint8_t sub, const Bytes& b, double actual) {
    const auto counts = [](double n) { return std::max(1.0, std::fabs(n)); };
    Cam& cam = cams_[index];
    if (sub == 6 || sub == 7) {
        cam.enabled = sub == 6;
        return 0;
    }
    if (sub == 8) {
        cam.next = std::pair{signed16(b, 2) / 1000, counts(signed32(b, 4))};
        return 0;
    }
    Cam made;
    made.defined = true;
    made.curve = at16(b, 2);
    const Curve* curve = curve_of(curves_, made.curve);
    if (!curve) return 0x62;
    made.start = signed32(b, 4);
    made.length = counts(sub == 3 ? signed32(b, 16) : sub == 4 ? signed32(b, 12) : sub == 5 ? signed32(b, 10) : curve->x_length());
    Fault fault = 0;
    switch (sub) {
        case 0:
            break;
        case 1:
            made.offset = actual - curve->first();
            break;
        case 2:
        case 4:
            fault = lay(made, *curve, actual, signed32(b, 8));
            break;
        case 3:
            fault = lay(made, *curve, signed32(b, 8), signed32(b, 12));
            break;
        default:
            made.scale = signed16(b, 8) / 1000;
            break;
    }
    if (fault == 0) cam = made;
    return fault;
}

Fault Coupling::preset(std::uint8_t sub, const Bytes& b) {
    if (!curve_of(curves_, at16(b, 2))) return 0x62;
    memory_.set_ram(rising(sub) ? 0x154A : 0x154B, at16(b, 2));
    memory_.set_ram(rising(sub) ? 0x154C : 0x154D, at32(b, 4));
    return 0;
}

Fault Coupling::prepare_shot(std::uint8_t sub, const Bytes& b, double here, Instant now) {
    const bool up = rising(sub), now_at_once = sub == 4;
    Cam made;
    made.defined = true;
    made.curve = now_at_once ? at16(b, 2) : static_cast<std::uint16_t>(memory_.ram(up ? 0x154A : 0x154B));
    const Curve* curve = curve_of(curves_, made.curve);
    if (!curve) return 0x62;
    made.start = master_.count(now) + (now_at_once ? signed32(b, 4) : memory_.number(up ? 0x154C : 0x154D));
    const bool to_target = sub == 0x0A || sub == 0x0C, scaled = sub == 0x0D || sub == 0x0E;
    made.length = std::max(1.0, std::fabs(to_target ? signed32(b, 12) : scaled ? signed32(b, 10) : curve->x_length()));
    if (to_target) {
        if (const Fault fault = lay(made, *curve, here, signed32(b, 8))) return fault;
    }
    if (scaled) made.scale = signed16(b, 8) / 1000;
    cams_[shot] = made;
    return 0;
}

Fault Coupling::prepare_winding(std::uint16_t header, const Bytes& b, Instant now) {
    const bool curve = header >> 8 == 0x31, later = (header >> 4 & 0x0F) == 1;
    wound_curve_ = curve ? at16(b, 2) : std::uint16_t{0};
    if (curve && !curve_of(curves_, wound_curve_)) return 0x62;
    const double count = master_.count(now);
    wound_from_ = std::max(later ? signed32(b, curve ? 4 : 2) * per_turn() : count, count);
    adaptation_lost_ = 0;
    adaptation_held_.reset();
    return 0;
}

void Coupling::hold_adaptation(bool hold, Instant now) {
    if (mode_ != Mode::winding) return;
    const double turned = master_.count(now) - wound_from_;
    if (hold && !adaptation_held_) adaptation_held_ = turned - adaptation_lost_;
    if (!hold && adaptation_held_) {
        adaptation_lost_ = turned - *adaptation_held_;
        adaptation_held_.reset();
    }
}

}  // namespace axisgate::linmot::twin
