// Loses, doubles, delays and corrupts frames; the faults and their instants are a function of the seed. Reports of a CAN controller are not
// touched, because they belong to the line itself.
#include "gateway/wire/fault_line.hpp"

#include <algorithm>
#include <array>

namespace axisgate {
namespace {

/// SplitMix64: small, sufficient, and the same on every machine (the distributions of the standard library are not).
std::uint64_t next_random(std::uint64_t& state) noexcept {
    state += 0x9E3779B97F4A7C15ull;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
}

bool chance(std::uint64_t& state, double probability) noexcept {
    if (probability <= 0) return false;
    return static_cast<double>(next_random(state) >> 11) * 0x1.0p-53 < probability;
}

/// A number in 0..bound-1; bound > 0.
std::uint64_t below(std::uint64_t& state, std::uint64_t bound) noexcept { return next_random(state) % bound; }

/// Inverts one bit of the content; for a CAN frame without data, of its identifier.
void flip_bit(std::uint64_t& state, Frame& f) noexcept {
    if (f.size > 0) {
        const std::uint64_t bit = below(state, std::uint64_t{f.size} * 8);
        f.storage[bit / 8] = static_cast<std::uint8_t>(f.storage[bit / 8] ^ (1u << (bit % 8)));
    } else if (f.kind == Frame::Kind::can) {
        f.id ^= 1u << below(state, f.extended ? 29 : 11);
    }
}

Frame foreign_can_frame(std::uint64_t& state) noexcept {
    std::array<std::uint8_t, 8> data{};
    for (auto& b : data)
        b = static_cast<std::uint8_t>(next_random(state));
    const std::size_t size = below(state, data.size() + 1);
    return Frame::can_extended(static_cast<std::uint32_t>(next_random(state)), std::span(data).first(size));
}

}  // namespace

FaultLine::FaultLine(std::unique_ptr<Line> inner, const FaultPlan& plan) : inner_(std::move(inner)) {
    out_.random = plan.seed;
    in_.random = ~plan.seed;
    in_.to_drive = false;
    set_rates(plan.to_drive, plan.from_drive);
}

void FaultLine::set_rates(const FaultRates& to_drive, const FaultRates& from_drive) noexcept {
    out_.rates = to_drive;
    in_.rates = from_drive;
    out_.since = in_.since = never;
}

void FaultLine::cut(Instant now, std::string why) {
    cut_ = true;
    cut_why_ = std::move(why);
    counters_.swallowed += out_.late.size() + in_.late.size() + (out_.held ? 1 : 0) + (in_.held ? 1 : 0);
    drop_late();
    heal_at_ = never;
    tell_at_ = now;
}

void FaultLine::bus_off(Instant now, Duration pause) {
    if (cut_) return;
    constexpr std::uint32_t bus_off_class = 0x40;  // CAN_ERR_BUSOFF of linux/can/error.h
    cut(now, "bus-off after too many errors");
    heal_at_ = now + pause;
    if (events_ == nullptr) return;
    Frame report;
    report.kind = Frame::Kind::can_error;
    report.id = bus_off_class;
    report.assign(std::array<std::uint8_t, 8>{});
    report.at = now;
    events_->on_frame(report);
}

void FaultLine::heal(Instant now) {
    cut_ = false;
    heal_at_ = never;
    tell_at_ = now;
}

void FaultLine::drop_late() {
    for (Direction* d : {&out_, &in_}) {
        d->late.clear();
        d->held.reset();
    }
}

void FaultLine::open(LineEvents& events, Instant now) {
    events_ = &events;
    if (cut_) tell_at_ = now;
    inner_->open(*this, now);
}

void FaultLine::close() {
    inner_->close();
    events_ = nullptr;
    tell_at_ = heal_at_ = never;
    inner_up_ = published_up_ = false;
    drop_late();
}

bool FaultLine::send(const Frame& frame, Priority priority, Instant now) {
    now_ = std::max(now_, now);
    if (cut_) {
        ++counters_.swallowed;
        ++refused_;
        return false;
    }
    return spoil(out_, frame, priority, now_);
}

Instant FaultLine::deadline() const {
    if (events_ == nullptr) return never;
    Instant t = std::min({inner_->deadline(), tell_at_, heal_at_});
    for (const Direction* d : {&out_, &in_}) {
        if (!d->late.empty()) t = std::min(t, d->late.front().due);
        if (d->held) t = std::min(t, d->held->due);
    }
    return t;
}

/// Handles one event after the other, so that delayed frames and events of the inner line come in order of time, however late the call is.
void FaultLine::on_deadline(Instant now) {
    constexpr int max_events_per_call = 10'000;
    for (int i = 0; i < max_events_per_call && events_ != nullptr; ++i) {
        const Instant t = deadline();
        if (t > now) break;
        now_ = std::max(now_, t);
        if (tell_at_ <= t) {
            tell_at_ = never;
            tell();
        } else if (heal_at_ <= t) {
            heal(t);
        } else if (out_.held && out_.held->due <= t) {
            release_held(out_);
        } else if (in_.held && in_.held->due <= t) {
            release_held(in_);
        } else if (!out_.late.empty() && out_.late.front().due <= t) {
            release(out_);
        } else if (!in_.late.empty() && in_.late.front().due <= t) {
            release(in_);
        } else {
            inner_->on_deadline(t);
        }
    }
}

void FaultLine::tell() {
    const bool up = inner_up_ && !cut_;
    if (up == published_up_ && !cut_) return;
    published_up_ = up;
    events_->on_line_state(up, cut_ ? cut_why_ : inner_why_);
}

void FaultLine::on_line_state(bool up, const std::string& why) {
    inner_up_ = up;
    inner_why_ = why;
    if (cut_ || events_ == nullptr) return;
    published_up_ = up;
    events_->on_line_state(up, why);
}

void FaultLine::on_sent(const Frame& frame) {
    if (!cut_ && events_ != nullptr) events_->on_sent(frame);
}

void FaultLine::on_frame(const Frame& frame) {
    if (events_ == nullptr) return;
    if (cut_) {
        ++counters_.swallowed;
        return;
    }
    now_ = std::max(now_, frame.at);
    (void)spoil(in_, frame, Priority::command, frame.at);
}

bool FaultLine::spoil(Direction& d, const Frame& frame, Priority priority, Instant now) {
    if (frame.kind == Frame::Kind::can_error) return give(d, frame, priority, now);
    if (chance(d.random, d.rates.loss)) {
        ++counters_.lost;
        return true;  // a sender is not informed that its frame did not arrive
    }
    Frame f = frame;
    if (f.size > 0 && chance(d.random, d.rates.truncate)) {
        ++counters_.truncated;
        f.size = static_cast<std::uint16_t>(below(d.random, f.size));
        if (f.size == 0 && f.kind == Frame::Kind::bytes) return true;
    }
    if (chance(d.random, d.rates.flip)) {
        ++counters_.flipped;
        flip_bit(d.random, f);
    }
    bool good = true;
    const bool twice = chance(d.random, d.rates.duplicate);
    if (chance(d.random, d.rates.insert)) {
        ++counters_.inserted;
        if (f.kind == Frame::Kind::bytes) {
            good = spoil_bytes(d, f, priority, now);
        } else {
            Frame foreign = foreign_can_frame(d.random);
            foreign.at = f.at;
            (void)give(d, foreign, priority, now);
            good = give(d, f, priority, now);
        }
    } else {
        good = give(d, f, priority, now);
    }
    if (twice) {
        ++counters_.duplicated;
        (void)give(d, f, priority, now);
    }
    return good;
}

/// Inserts foreign bytes somewhere in the run; bytes that do not fit into one frame go into a second one.
bool FaultLine::spoil_bytes(Direction& d, Frame frame, Priority priority, Instant now) {
    std::array<std::uint8_t, Frame::capacity + 8> all{};
    const std::size_t foreign = 1 + below(d.random, 8), place = below(d.random, std::uint64_t{frame.size} + 1);
    const auto data = frame.data();
    std::ranges::copy(data.first(place), all.begin());
    for (std::size_t i = 0; i < foreign; ++i)
        all[place + i] = static_cast<std::uint8_t>(next_random(d.random));
    std::ranges::copy(data.subspan(place), all.begin() + static_cast<std::ptrdiff_t>(place + foreign));
    bool good = true;
    for_each_run(std::span(all).first(data.size() + foreign), [&](Frame piece) {
        piece.at = frame.at;
        good = give(d, piece, priority, now) && good;
    });
    return good;
}

bool FaultLine::give(Direction& d, const Frame& frame, Priority priority, Instant now) {
    Instant due = now;
    if (d.rates.drift > Duration::zero()) {
        if (d.since == never) d.since = now;
        due += std::min(d.rates.drift_max,
                        Duration{static_cast<Duration::rep>(static_cast<double>(d.rates.drift.count()) * seconds(now - d.since))});
    }
    if (d.rates.delay_max > Duration::zero() && chance(d.random, d.rates.delay)) {
        ++counters_.delayed;
        due += Duration{1 + static_cast<std::int64_t>(below(d.random, static_cast<std::uint64_t>(d.rates.delay_max.count())))};
    }
    if (d.held) {
        Late overtaken = *d.held;
        d.held.reset();
        const bool good = queue(d, frame, priority, due, now);
        overtaken.frame.at = frame.at;
        (void)queue(d, overtaken.frame, overtaken.priority, due, now);
        return good;
    }
    if (frame.kind == Frame::Kind::can && chance(d.random, d.rates.reorder)) {
        ++counters_.reordered;
        d.held = Late{frame, priority, std::max(due, d.late.empty() ? due : d.late.back().due) + overtaken_at_most};
        return true;
    }
    return queue(d, frame, priority, due, now);
}

bool FaultLine::queue(Direction& d, const Frame& frame, Priority priority, Instant due, Instant now) {
    if (d.late.empty() && due == now) return pass(d, frame, priority);
    if (d.late.size() >= max_delayed) {
        ++counters_.overflowed;
        refused_ += d.to_drive ? 1 : 0;
        return false;
    }
    if (!d.late.empty()) due = std::max(due, d.late.back().due);
    d.late.push_back({frame, priority, due});
    return true;
}

bool FaultLine::pass(Direction& d, const Frame& frame, Priority priority) {
    if (d.to_drive) return inner_->send(frame, priority, now_);
    if (events_ != nullptr) events_->on_frame(frame);
    return true;
}

void FaultLine::release(Direction& d) {
    Late late = d.late.front();
    d.late.pop_front();
    if (!d.to_drive) late.frame.at = late.due;
    (void)pass(d, late.frame, late.priority);  // the inner line counts a refusal
}

/// No other frame has overtaken it.
void FaultLine::release_held(Direction& d) {
    d.late.push_back(*d.held);
    d.held.reset();
    release(d);
}

LineStatus FaultLine::status(Instant now) const {
    LineStatus s = inner_->status(now);
    s.dropped += refused_;
    if (cut_ && events_ != nullptr) {
        s.state = heal_at_ == never ? LineStatus::State::down : LineStatus::State::bus_off;
        s.text = cut_why_;
    }
    return s;
}

}  // namespace axisgate
