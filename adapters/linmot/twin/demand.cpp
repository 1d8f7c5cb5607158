#include "adapters/linmot/twin/demand.hpp"

#include <cmath>

#include "adapters/linmot/twin/bytes.hpp"

namespace axisgate::linmot::twin {

Point Demand::at(Instant now) const {
    if (play_.active) {
        if (const auto p = play_.at(curves_, now)) return *p;
    }
    if (coupling_.active()) {
        if (const auto p = coupling_.at(now)) return *p;
    }
    return stream_.active() ? stream_.at(now) : vai_.profile().at(now);
}

void Demand::drop(double position, Instant now) {
    vai_.rest(position, now);
    vai_.forget_queued();
    play_ = {};
    coupling_.end();
    memory_.set_ram(0x1BA9, 0);
    stream_.end();
    index_.reset();
}

void Demand::brake(Instant now) {
    vai_.freeze(at(now), play_.active || coupling_.mode() != Coupling::Mode::none, moves(now), now);
    play_ = {};
    coupling_.end();
    stream_.end();
    index_.reset();
}

void Demand::go(double target, const Ramps& ramps, Instant now) {
    leave_all(now);
    index_.reset();
    vai_.move(at(now), target, ramps, now);
}

void Demand::jog(double direction, const Ramps& ramps, Instant now) {
    leave_all(now);
    index_.reset();
    vai_.run(at(now), direction, ramps, now);
}

void Demand::leave(Instant now) {
    if (!play_.active && coupling_.mode() == Coupling::Mode::none) return;
    const Point p = at(now);
    play_ = {};
    coupling_.end();
    vai_.rest(p.position, now);
}

void Demand::start(const Order& order, Point actual, Instant now) {
    const Point from = at(now);
    leave(now);
    vai_.start(order, from, actual, now);
}

void Demand::stop(double deceleration, Instant now) {
    const Point from = at(now);
    leave_all(now);
    vai_.stop(from, deceleration, now);
}

void Demand::index(double base, const Ramps& ramps, Instant now) {
    leave_all(now);
    index_ = Index{base, ramps};
    step_index(now);
}

void Demand::step_index(Instant now) {
    if (index_) vai_.start({0, index_->base + std::nearbyint(master_.count(now)), index_->ramps}, at(now), {}, now);
}

Fault Demand::play(std::uint8_t sub, const Bytes& b, Instant now) {
    Play laid;
    if (const Fault fault = lay(laid, curves_, sub, b, at(now).position, now)) return fault;
    leave_all(now);
    play_ = laid;
    return 0;
}

Fault Demand::take(std::uint8_t sub, const Bytes& b, Instant now) {
    const Point here = at(now);
    if (sub == 0x0F) {
        if (stream_.active()) {
            stream_.end();
            vai_.stand(here.position, now);
        }
        return 0;
    }
    if (const Fault fault = stream_.take(sub, b, here, now)) {
        vai_.rest(here.position, now);
        return fault;
    }
    vai_.set_target(signed32(b, 2));
    return 0;
}

Fault Demand::starve(Instant now) {
    if (!stream_.starved(now)) return 0;
    const Point p = at(now);
    stream_.end();
    vai_.rest(p.position, now);
    return 0x83;
}

Fault Demand::couple(Coupling::Mode mode, Instant now) {
    const Point before = at(now);
    leave_all(now);
    index_.reset();
    coupling_.begin(mode, now);
    vai_.rest(before.position, now);
    const auto to = coupling_.active() ? coupling_.place(master_.count(now)) : std::nullopt;
    const double limit = memory_.number(0x1473);
    if (!to || limit <= 0 || std::fabs(to->position - before.position) <= limit) return 0;
    coupling_.end();
    return 0x0B;
}

void Demand::uncouple(Instant now) {
    leave(now);
    memory_.set_ram(0x1BA9, 0);
    vai_.target_end();
}

void Demand::step_coupling(Instant now) {
    const auto step = coupling_.step(now);
    switch (step.what) {
        case Coupling::Passed::nothing:
            return;
        case Coupling::Passed::shot_over:
            if (step.place) vai_.rest(*step.place, now);
            return vai_.target_end();
        case Coupling::Passed::released:
            return vai_.rest(step.place.value_or(at(now).position), now);
    }
}

}  // namespace axisgate::linmot::twin
