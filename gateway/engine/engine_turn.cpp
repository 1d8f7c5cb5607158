// Engine, time, and what it tells: whose deadline is next, who is due, and what is looked at every now and then.
// In: the time. Out: turns of adapters and twins, stale axes, drives that are given up, memories of twins to keep.
// Never looks at a side that nothing has touched and that is not due.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/engine.hpp"
#include "gateway/engine/engine_parts.hpp"
#include "gateway/engine/flight_record.hpp"

namespace axisgate {

// --- what is told ---------------------------------------------------------------------------------------------------

void Engine::event(Event e, Instant now) {
    if (tap_) tap_->event(e, now);
    host_.on_event(std::move(e), now);
}

void Engine::answer(const Result& result) {
    if (tap_) tap_->result(result, now_);
    host_.on_result(result);
}

void Engine::tell_sample(const Sample& sample, Instant now) {
    if (tap_) tap_->sample(sample, now);
    host_.on_sample(sample);
}

// --- time -----------------------------------------------------------------------------------------------------------

bool Engine::at_rest(Instant now) const noexcept {
    return clients_.empty() && orders_.empty() && !change_ && now - last_stir_ >= std::chrono::seconds(1);
}

Instant Engine::deadline() const {
    Instant t = lines_.empty() ? never : next_housekeeping_;
    for (Side* s : sides_)
        t = std::min(t, s->deadline());
    return t;
}

void Engine::on_deadline(Instant now) {
    if (tap_) tap_->turn(now);
    const FlightWithin within(tap_);
    now_ = std::max(now_, now);
    // Bounded: a side that is due again at once gets its next turn with the next call.
    for (std::size_t i = 0; i < sides_.size(); ++i) {
        Side& s = *sides_[i];
        if (s.deadline() > now) continue;
        s.touched();
        if (s.line->deadline() <= now) s.line->on_deadline(now);
        for (std::size_t k = 0; k < s.speakers.size(); ++k) {
            Speaker& by = *s.speakers[k];
            if (by.adapter->deadline() <= now) ask(by, now, [&](Out& out) { by.adapter->on_deadline(now, out); });
        }
    }
    if (now >= next_housekeeping_) {
        next_housekeeping_ = now + housekeeping_period;
        housekeeping(now);
        check_change(now);
        for (Side* s : sides_)
            s->touched();
    }
}

std::string Engine::look_closely(const std::vector<AxisId>& axes, Duration period, Instant until, Instant now) {
    if (tap_) tap_->look({axes, period, until}, now);
    const FlightWithin within(tap_);
    const bool on = period > Duration::zero();
    const LineUnit* line = nullptr;
    for (const AxisId id : axes) {
        const Axis* a = axis(id);
        if (!a) return "there is no such axis";
        if (line && a->drive->line != line) return "the axes are not on one line";
        line = a->drive->line;
    }
    for (const AxisId id : axes) {
        Axis& a = *axis(id);
        a.look_period = on ? std::max(period, shortest_look_period) : Duration::zero();
        a.look_until = on ? std::min(until, now + longest_look) : Instant{};
    }
    for (Side* s : sides_)
        if (&s->unit == line) configure_side(*s, now);
    return {};
}

/// Nobody who asked to look closely needs to be there to say that it is enough.
void Engine::end_looks(Instant now) {
    for (const auto& slot : axes_) {
        if (!slot || slot->look_period == Duration::zero() || now < slot->look_until) continue;
        slot->look_period = Duration::zero();
        for (Side* s : sides_)
            if (&s->unit == slot->drive->line) configure_side(*s, now);
    }
}

void Engine::housekeeping(Instant now) {
    end_looks(now);
    for (const auto& unit : lines_) {
        if (unit) scan_turn(*unit, now);
    }
    for (const auto& slot : axes_) {
        if (!slot) continue;
        Axis& a = *slot;
        const bool stale = now - a.profile.feedback().at > a.drive->line->stale_after || !image_.picture(a.id).current;
        if (stale != a.stale) {
            a.stale = stale;
            publish(a, now);
        }
        if (!a.clients.empty()) track(a, now);
        check_hold(a, now);
        check_watchdog(a, now);
        check_stream(a, now);
        const bool led = a.authority.holder() == a.authority.commander();
        if (const auto v = a.authority.expire(now); v.change != AxisAuthority::Change::none) {
            if (led) fail_safe(a, LossCause::lease_ended, now);
            authority_changed(a, v, nullptr, now);
        }
    }
    for (const auto& slot : drives_) {
        if (!slot) continue;
        Drive& d = *slot;
        decide_presence(d, now);
        if (d.handback && d.handback->waiting == 0 && d.device_online) {
            bool rest = true;
            for (const AxisId id : d.axes)
                rest = rest && axes_[index_of(id)]->profile.at_rest();
            if (rest) {
                auto h = std::move(d.handback);
                serve(d, Presence::device,
                      fmt::format("the drive is back; {} parameters compared, {} differ", h->compared, h->differences.size()), now);
                for (const auto& text : h->differences) {
                    Event e;
                    e.severity = Severity::warning;
                    e.kind = "parameters_differ";
                    e.drive = d.spec.name;
                    e.text = text;
                    event(std::move(e), now);
                }
            }
        }
        save_twin_memory(d);
    }
}

/// Hands a twin's non-volatile memory to the store if it has changed since.
void Engine::save_twin_memory(Drive& d) {
    if (d.serving != Presence::twin || !d.line->twins) return;
    const Twin* t = d.line->twins->bus->twin(d.id);
    if (!t || t->non_volatile_revision() == d.memory_revision) return;
    d.memory_revision = t->non_volatile_revision();
    d.memory = t->non_volatile();
    host_.on_twin_memory(d.spec.name, d.memory);
}

}  // namespace axisgate
