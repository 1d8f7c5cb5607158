// An event loop over three kinds of event: a transmission ends, a twin's deadline passes, a transmission starts. When its queues have grown
// to the size of the traffic, a frame allocates no memory.
#include "gateway/wire/twin_bus.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/core/wire_time.hpp"

namespace axisgate {

struct TwinBus::Node {
    std::unique_ptr<Twin> twin;
    SendQueue queue;
    std::size_t ear = 0;                  // in ears_
    std::size_t place = npos;             // in heap_
    std::bitset<Frame::capacity> missed;  // bytes of the host's transmission of `missed_of` during which it was sending
    Instant missed_of = never;
    static constexpr std::size_t npos = static_cast<std::size_t>(-1);

    /// On one pair of wires the receiver of a drive is switched off while the drive sends.
    [[nodiscard]] Frame heard_of(const Frame& frame) const {
        Frame heard = frame;
        heard.size = 0;
        for (std::size_t i = 0; i < frame.size; ++i) {
            if (!missed[i]) heard.storage[heard.size++] = frame.storage[i];
        }
        return heard;
    }
};

TwinBus::TwinBus(const TwinBusOptions& options) : options_(options) {
    if (options_.bits_per_byte == 0) options_.bits_per_byte = 10;
    intermission_ = wire_time(can_intermission_bits, options_.bit_rate);
    wire_.reserve(4);
}

TwinBus::~TwinBus() = default;

// --- twins ----------------------------------------------------------------------------------------------------------

TwinBus::Number TwinBus::find(DriveId key) const noexcept {
    const auto at = std::ranges::find(keys_, key);
    return at == keys_.end() ? gone : ears_[static_cast<std::size_t>(at - keys_.begin())].number;
}

void TwinBus::add(DriveId key, std::unique_ptr<Twin> twin, const NonVolatile& memory, Instant now) {
    remove(key);
    processed_ = std::max(processed_, now);
    const auto free = std::ranges::find_if(nodes_, [](const auto& n) { return n == nullptr; });
    const auto number = static_cast<Number>(free - nodes_.begin());
    if (free == nodes_.end()) nodes_.emplace_back();
    nodes_[number] = std::make_unique<Node>();
    nodes_[number]->twin = std::move(twin);
    nodes_[number]->ear = ears_.size();
    ears_.push_back({{}, number});
    keys_.push_back(key);
    hearers_ = {};
    nodes_[number]->twin->power_on(memory, processed_, scratch_);
    take(number, processed_);
}

void TwinBus::remove(DriveId key) {
    next_known_ = false;
    const Number number = find(key);
    if (number == gone) return;
    place(number, never);
    drop_sender(number);
    ears_.erase(ears_.begin() + static_cast<std::ptrdiff_t>(nodes_[number]->ear));
    keys_.erase(keys_.begin() + static_cast<std::ptrdiff_t>(nodes_[number]->ear));
    hearers_ = {};
    for (std::size_t i = nodes_[number]->ear; i < ears_.size(); ++i)
        nodes_[ears_[i].number]->ear = i;
    for (Transmission& t : wire_) {
        if (t.sender == number) t.sender = gone;
    }
    if (done_.sender == number) done_.sender = gone;
    nodes_[number].reset();
}

Twin* TwinBus::twin(DriveId key) noexcept {
    const Number number = find(key);
    return number == gone ? nullptr : nodes_[number]->twin.get();
}

const Twin* TwinBus::twin(DriveId key) const noexcept {
    const Number number = find(key);
    return number == gone ? nullptr : nodes_[number]->twin.get();
}

std::size_t TwinBus::size() const noexcept { return ears_.size(); }

std::string TwinBus::set_hand(DriveId key, const std::string& name, const Value& value, Instant now) {
    next_known_ = false;
    const Number number = find(key);
    if (number == gone) return "there is no twin of this drive on the bus: it is served by the device, or not at all";
    processed_ = std::max(processed_, now);
    std::string fault = nodes_[number]->twin->set_hand(name, value, processed_, scratch_);
    take(number, processed_);
    return fault;
}

void TwinBus::restart(DriveId key, const NonVolatile& memory, Instant now) {
    next_known_ = false;
    const Number number = find(key);
    if (number == gone) return;
    processed_ = std::max(processed_, now);
    nodes_[number]->queue.clear();
    drop_sender(number);
    nodes_[number]->twin->power_on(memory, processed_, scratch_);
    take(number, processed_);
}

/// Must follow every call of a twin: moves its frames into its queue, its deadline into the heap, its filters into ears_.
void TwinBus::take(Number number, Instant t, Duration at_least) {
    next_known_ = false;
    Node& node = *nodes_[number];
    const bool reported = !scratch_.frames.empty();
    for (const auto& tx : scratch_.frames) {
        if ((tx.frame.kind == Frame::Kind::can) != (options_.kind == LineKind::can) || tx.frame.kind == Frame::Kind::can_error) {
            ++counters_.foreign;
        } else if (!node.queue.push(tx.frame, tx.priority, t)) {
            ++counters_.twin_dropped;
        }
    }
    scratch_.clear();
    if (reported) note_sender(number);
    if (options_.kind == LineKind::can) {
        if (const Acceptance now = node.twin->acceptance(); now != ears_[node.ear].acceptance) {
            ears_[node.ear].acceptance = now;
            hearers_ = {};
        }
    }
    const Instant due = node.twin->deadline();
    place(number, due == never ? never : std::max(due, t + at_least));
}

/// Must follow a change of a node's queue.
void TwinBus::note_sender(Number number) {
    const SendQueue& queue = nodes_[number]->queue;
    const SendQueue::Entry* e = queue.front();
    if (e == nullptr) return drop_sender(number);
    const Sender now{number, options_.kind == LineKind::can ? can_arbitration(e->frame) : 0, queue.earliest()};
    const auto known = std::ranges::find(senders_, number, &Sender::number);
    if (known == senders_.end()) {
        senders_.push_back(now);
    } else {
        *known = now;
    }
}

void TwinBus::drop_sender(Number number) noexcept {
    std::erase_if(senders_, [number](const Sender& s) { return s.number == number; });
}

// --- deadlines: a binary heap in which every node knows its index ----------------------------------------------------

void TwinBus::place(Number number, Instant due) {
    Node& node = *nodes_[number];
    if (node.place == Node::npos) {
        if (due == never) return;
        node.place = heap_.size();
        heap_.push_back({due, number});
        sift_up(node.place);
        return;
    }
    const std::size_t i = node.place;
    if (due == never) {
        node.place = Node::npos;
        const Due last = heap_.back();
        heap_.pop_back();
        if (i == heap_.size()) return;
        heap_[i] = last;
        nodes_[last.number]->place = i;
        sift_up(i);
        sift_down(nodes_[last.number]->place);
        return;
    }
    const Instant before = heap_[i].at;
    heap_[i].at = due;
    if (due < before) sift_up(i);
    if (due > before) sift_down(i);
}

void TwinBus::sift_up(std::size_t i) noexcept {
    const Due moving = heap_[i];
    while (i > 0) {
        const std::size_t parent = (i - 1) / 2;
        if (heap_[parent].at <= moving.at) break;
        heap_[i] = heap_[parent];
        nodes_[heap_[i].number]->place = i;
        i = parent;
    }
    heap_[i] = moving;
    nodes_[moving.number]->place = i;
}

void TwinBus::sift_down(std::size_t i) noexcept {
    const Due moving = heap_[i];
    for (;;) {
        std::size_t child = 2 * i + 1;
        if (child >= heap_.size()) break;
        if (child + 1 < heap_.size() && heap_[child + 1].at < heap_[child].at) ++child;
        if (moving.at <= heap_[child].at) break;
        heap_[i] = heap_[child];
        nodes_[heap_[i].number]->place = i;
        i = child;
    }
    heap_[i] = moving;
    nodes_[moving.number]->place = i;
}

// --- the line -------------------------------------------------------------------------------------------------------

void TwinBus::open(LineEvents& events, Instant now) {
    next_known_ = false;
    events_ = &events;
    processed_ = std::max(processed_, now);
    status_.state = LineStatus::State::opening;
    tell_up_ = true;
}

void TwinBus::close() {
    next_known_ = false;
    events_ = nullptr;
    tell_up_ = false;
    status_.state = LineStatus::State::closed;
    host_queue_.clear();
    wire_.clear();
    for (const Sender& s : senders_)
        nodes_[s.number]->queue.clear();
    senders_.clear();
}

bool TwinBus::send(const Frame& frame, Priority priority, Instant now) {
    next_known_ = false;
    const bool fits = frame.kind == (options_.kind == LineKind::can ? Frame::Kind::can : Frame::Kind::bytes);
    if (!fits) ++counters_.foreign;
    const std::uint64_t displaced = host_queue_.displaced();
    const bool good = fits && status_.state == LineStatus::State::up && host_queue_.push(frame, priority, std::max(now, processed_));
    status_.dropped += (good ? 0 : 1) + (host_queue_.displaced() - displaced);
    return good;
}

bool TwinBus::sending(Number sender) const noexcept {
    return std::ranges::any_of(wire_, [sender](const Transmission& t) { return t.sender == sender; });
}

/// True if a twin with a waiting frame on a byte line would begin now.
bool TwinBus::may_start(Number twin) const noexcept {
    if (!options_.converter) return !sending(twin);
    return std::ranges::none_of(wire_, [](const Transmission& t) { return t.sender != host; });
}

Instant TwinBus::first_end() const noexcept {
    Instant t = never;
    for (const Transmission& x : wire_)
        t = std::min(t, x.next);
    return t;
}

/// The number of its bytes that the host has after the next run.
std::uint16_t TwinBus::run_end(const Transmission& x) const noexcept {
    if (options_.kind == LineKind::can || x.sender == host || x.end == x.start) return x.frame.size;
    const auto each = std::max<std::int64_t>(1, run_time * x.frame.size / (x.end - x.start));
    return static_cast<std::uint16_t>(std::min<std::int64_t>(x.frame.size, x.given + each));
}

/// When the next transmission may start, as far as it is known now.
Instant TwinBus::next_start() const noexcept {
    const bool can = options_.kind == LineKind::can;
    if (can && !wire_.empty()) return never;
    Instant t = never;
    if (can || !sending(host)) t = host_queue_.earliest();
    for (const Sender& s : senders_) {
        if (can || may_start(s.number)) t = std::min(t, s.since);
    }
    if (t == never) return never;
    return std::max({t, processed_, can ? bus_free_ : Instant{}});
}

TwinBus::Event TwinBus::next_event() const noexcept {
    if (events_ == nullptr) return {};
    if (tell_up_) return {processed_, Event::Kind::start};
    Event next{std::max(first_end(), processed_), Event::Kind::end};
    const Instant twin = heap_.empty() ? never : std::max(heap_.front().at, processed_);
    if (twin < next.at) next = {twin, Event::Kind::deadline};
    if (const Instant start = next_start(); start < next.at) next = {start, Event::Kind::start};
    return next;
}

void TwinBus::on_deadline(Instant now) {
    if (events_ == nullptr || running_) return;
    running_ = true;
    if (tell_up_) {
        tell_up_ = next_known_ = false;
        status_.state = LineStatus::State::up;
        events_->on_line_state(true, text());
    }
    for (std::size_t i = 0; i < max_events_per_call && events_ != nullptr; ++i) {
        if (!next_known_) next_ = next_event();
        next_known_ = next_.at > now;
        if (next_known_) {
            processed_ = std::max(processed_, now);
            break;
        }
        step(next_);
    }
    running_ = false;
}

void TwinBus::step(Event e) {
    processed_ = e.at;
    if (e.kind == Event::Kind::end) return finish_one();
    if (e.kind == Event::Kind::start) return start(e.at);
    const Number number = heap_.front().number;
    nodes_[number]->twin->on_deadline(e.at, scratch_);
    take(number, e.at, std::chrono::microseconds(1));  // a twin that stays due must not stop the time for all others
}

void TwinBus::start(Instant t) {
    if (options_.kind == LineKind::can) {
        start_can(t);
        return;
    }
    // All that are ready begin now: on a byte line a sender does not listen before it sends.
    if (host_queue_.front(t) != nullptr && !sending(host)) begin(host, host_queue_, t);
    for (std::size_t i = 0; i < senders_.size();) {
        const Number n = senders_[i].number;
        if (may_start(n)) begin(n, nodes_[n]->queue, t);
        if (i < senders_.size() && senders_[i].number == n) ++i;  // otherwise it has nothing more to send and has left the list
    }
}

void TwinBus::start_can(Instant t) {
    Number winner = gone;
    std::uint32_t best = 0xFFFFFFFF;
    if (const SendQueue::Entry* e = host_queue_.front(t); e != nullptr) {
        winner = host;
        best = can_arbitration(e->frame);
    }
    for (const Sender& s : senders_) {  // the frames of this twin are in its queue by now
        if (winner != gone && s.arbitration >= best) continue;
        winner = s.number;
        best = s.arbitration;
    }
    if (winner != gone) begin(winner, winner == host ? host_queue_ : nodes_[winner]->queue, t);
}

void TwinBus::begin(Number sender, SendQueue& queue, Instant t) {
    Transmission& x = wire_.emplace_back();
    queue.take(x.frame, t);
    x.sender = sender;
    x.start = t;
    const bool can = options_.kind == LineKind::can;
    const std::uint64_t bits = can ? can_bits(x.frame) : std::uint64_t{x.frame.size} * options_.bits_per_byte;
    x.end = t + wire_time(bits, options_.bit_rate);
    const std::uint16_t first = run_end(x);
    x.next = first == x.frame.size ? x.end : t + (x.end - t) * first / x.frame.size;  // a CAN frame may have no bytes
    if (sender != host) note_sender(sender);
    if (can || x.end == t) return;
    for (Transmission& other : wire_) {
        const bool same_wire = !(options_.full_duplex || options_.converter) || (other.sender != host && sender != host);
        if (&other != &x && same_wire && other.end > t) garble_overlap(other, x);
    }
}

/// Both drivers are active from the start of the later transmission to the end of the earlier: the bytes in this time are corrupted.
void TwinBus::garble_overlap(Transmission& a, Transmission& b) noexcept {
    const Instant from = std::max(a.start, b.start), to = std::min(a.end, b.end);
    for (Transmission* x : {&a, &b}) {
        counters_.collisions += x->garbled.any() ? 0 : 1;
        const Number other = x == &a ? b.sender : a.sender;
        Node* deaf = x->sender == host && other != gone ? nodes_[other].get() : nullptr;
        if (deaf && std::exchange(deaf->missed_of, x->start) != x->start) deaf->missed.reset();
        const auto duration = (x->end - x->start).count();
        for (std::uint16_t i = 0; i < x->frame.size; ++i) {
            const Instant begins = x->start + Duration{duration * i / x->frame.size};
            const Instant ends = x->start + Duration{duration * (i + 1) / x->frame.size};
            if (ends <= from || begins >= to) continue;
            if (deaf) deaf->missed[i] = true;
            if (x->garbled[i]) continue;
            x->garbled[i] = true;
            x->frame.storage[i] = static_cast<std::uint8_t>(~x->frame.storage[i]);
        }
    }
}

void TwinBus::finish_one() {
    const auto first = std::ranges::min_element(wire_, {}, &Transmission::next);  // of equal ones, the one that began first
    if (first->next < first->end) return give_run(*first);
    done_ = *first;
    wire_.erase(first);
    const Instant t = processed_;  // the end itself, unless set_hand() or a new twin has advanced the time
    const bool can = options_.kind == LineKind::can;
    done_.frame.at = done_.end;
    load_.add(done_.end, done_.end - done_.start);
    if (can) bus_free_ = done_.end + intermission_;
    if (done_.garbled.any()) ++status_.errors;
    if (done_.sender == host) {
        ++status_.frames_out;
        status_.bytes_out += done_.frame.size;
        events_->on_sent(done_.frame);
        if (events_ != nullptr) deliver_to_twins(t);
        return;
    }
    if (can || !(options_.full_duplex || options_.converter)) deliver_to_twins(t);
    ++status_.frames_in;
    status_.bytes_in += done_.frame.size - done_.given;
    if (done_.given == 0) return events_->on_frame(done_.frame);
    Frame rest = Frame::run(done_.frame.data().subspan(done_.given));
    rest.at = done_.end;
    events_->on_frame(rest);
}

void TwinBus::give_run(Transmission& x) {
    const std::uint16_t until = run_end(x);
    Frame run = Frame::run(x.frame.data().subspan(x.given, until - x.given));
    run.at = x.next;
    x.given = until;
    const std::uint16_t further = run_end(x);
    x.next = further == x.frame.size ? x.end : x.start + (x.end - x.start) * further / x.frame.size;
    ++status_.frames_in;
    status_.bytes_in += run.size;
    events_->on_frame(run);
}

/// If a twin changes its own filters while a frame is delivered, the change applies to later frames.
std::span<const TwinBus::Number> TwinBus::who_receives(std::uint32_t id) {
    auto& set = hearers_[(id * 2654435761u) >> 25];
    const auto known = std::ranges::find(set, id, &Hearer::id);
    hearing_.clear();
    if (known != set.end() && known->number != host) {
        if (known->number != gone) hearing_.push_back(known->number);
        return hearing_;
    }
    for (const Ear& e : ears_) {
        if (e.acceptance.takes(id)) hearing_.push_back(e.number);
    }
    if (known == set.end()) {
        std::ranges::move_backward(set.begin(), set.end() - 1, set.end());
        set.front() = {id, hearing_.empty() ? gone : hearing_.size() == 1 ? hearing_.front() : host};
    }
    return hearing_;
}

void TwinBus::deliver_to_twins(Instant t) {
    for (const Number number : who_receives(done_.frame.id)) {  // twins cannot reach the bus, so the list does not change
        if (number == done_.sender) continue;
        Node& node = *nodes_[number];
        const bool missed = done_.sender == host && done_.garbled.any() && node.missed_of == done_.start && node.missed.any();
        if (!missed) {
            node.twin->on_frame(done_.frame, t, scratch_);
        } else if (const Frame heard = node.heard_of(done_.frame); heard.size > 0) {
            node.twin->on_frame(heard, t, scratch_);
        }
        take(number, t);
    }
}

std::string TwinBus::text() const {
    return fmt::format("twin bus with {} drive{}, {}", ears_.size(), ears_.size() == 1 ? "" : "s",
                       options_.bit_rate == 0 ? std::string("without wire time") : fmt::format("{} bit/s", options_.bit_rate));
}

LineStatus TwinBus::status(Instant now) const {
    LineStatus s = status_;
    s.text = status_.state == LineStatus::State::closed ? "closed" : text();
    s.queued = static_cast<std::uint32_t>(host_queue_.size());
    s.load = options_.bit_rate == 0 ? 0 : load_.share(now);
    return s;
}

}  // namespace axisgate
