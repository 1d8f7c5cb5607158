// RealLine: opening, sending in order and reconnecting, for every transport.
// The owner is never called from inside open(), close() or send().
#include "gateway/lines/real_line.hpp"

#include <algorithm>

namespace axisgate {
namespace {

/// A line that stayed up for this long starts with the shortest pause again when it goes down.
constexpr Duration up_for_good_after = std::chrono::seconds(5);

}  // namespace

RealLine::RealLine(const LineBase& base) : base_(base), retry_(base.io), pause_(base.pauses) {}

void RealLine::open(LineEvents& events, Instant) {
    close();
    events_ = &events;
    opened_ = std::make_shared<char>();
    attempt_ = std::make_shared<char>();
    published_ = ever_up_ = false;
    pause_.reset();
    status_.state = State::opening;
    text_ = "opening";
    asio::post(base_.io, guarded([this] { attempt(); }));
}

void RealLine::close() {
    if (!opened_) return;
    opened_.reset();
    attempt_.reset();
    flush_posted_ = false;
    retry_.cancel();
    stop();
    let_go();
    drop_all();
    events_ = nullptr;
    status_.state = State::closed;
    text_ = "closed";
}

bool RealLine::send(const Frame& frame, Priority priority, Instant) {
    // The instant comes from the line's own clock, not from the caller: the queue and its age limit need instants that never go back.
    const std::uint64_t displaced = queue_.displaced();
    const bool good = status_.state == State::up && takes(frame) && queue_.push(frame, priority, base_.clock.now());
    status_.dropped += (good ? 0 : 1) + (queue_.displaced() - displaced);
    if (good) flush_soon();
    return good;
}

void RealLine::flush_soon() {
    if (flush_posted_) return;
    flush_posted_ = true;
    asio::post(base_.io, guarded([this] {
                   flush_posted_ = false;
                   flush();
               }));
}

void RealLine::drop_all() noexcept {
    status_.dropped += queue_.size();
    queue_.clear();
}

void RealLine::drop_stale(Instant now) {
    if (base_.stale_after > Duration::zero()) status_.dropped += queue_.drop_older_than(now - base_.stale_after);
}

void RealLine::count_received(std::size_t frames, std::size_t bytes) noexcept {
    received_ = true;
    status_.frames_in += frames;
    status_.bytes_in += bytes;
}

void RealLine::attempt() {
    attempt_ = std::make_shared<char>();
    flush_posted_ = false;
    start();
}

void RealLine::retry_after(Duration pause) {
    retry_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(pause));
    retry_.async_wait(guarded([this](const boost::system::error_code& error) {
        if (!error) attempt();
    }));
}

void RealLine::try_now() {
    if (status_.state == State::down) retry_after(Duration::zero());
}

bool RealLine::came_up(std::string text) {
    status_.reopened += ever_up_ ? 1 : 0;
    ever_up_ = true;
    received_ = false;
    up_since_ = base_.clock.now();
    return tell_state(State::up, true, std::move(text));
}

void RealLine::went_down(std::string why) {
    const bool was_up = status_.state == State::up;
    const bool was_bus_off = status_.state == State::bus_off;
    attempt_ = std::make_shared<char>();
    flush_posted_ = false;
    stop();
    drop_all();
    if (was_up && (received_ || base_.clock.now() - up_since_ >= up_for_good_after)) pause_.reset();
    retry_after(pause_.take());
    if (was_up || was_bus_off || !published_) {
        (void)tell_state(State::down, false, std::move(why));
        return;
    }
    status_.state = State::down;
    text_ = std::move(why);
}

bool RealLine::tell_state(State state, bool up, std::string text) {
    const std::weak_ptr<char> alive = attempt_;
    published_ = true;
    status_.state = state;
    text_ = text;
    events_->on_line_state(up, text);
    return !alive.expired();
}

bool RealLine::deliver(const Frame& frame) {
    const std::weak_ptr<char> alive = attempt_;
    events_->on_frame(frame);
    return !alive.expired();
}

bool RealLine::tell_sent(const Frame& frame) {
    const std::weak_ptr<char> alive = attempt_;
    ++status_.frames_out;
    status_.bytes_out += frame.size;
    events_->on_sent(frame);
    return !alive.expired();
}

LineStatus RealLine::status(Instant now) const {
    LineStatus s = status_;
    s.text = s.state == State::up ? up_text() : text_;
    s.queued = static_cast<std::uint32_t>(queue_.size());
    const double in = load_in_.share(now), out = load_out_.share(now);
    s.load = one_wire_ ? std::min(1.0, in + out) : std::max(in, out);
    return s;
}

}  // namespace axisgate
