#include "adapters/cia402/drive_exchange.hpp"

#include "adapters/cia402/drive.hpp"

namespace axisgate::cia402_drive {
namespace {
void emit(const std::vector<Frame>& frames, Priority priority, Ticket order, Turn& t) {
    for (const Frame& f : frames)
        t.out.send(f, priority, order);
}
/// The time within which a node has sent its answer if it answers at once: in the worst case after the PDOs of all nodes that follow a
/// SYNC.
Duration usual_time(const Line& line) { return std::chrono::milliseconds(50) + 64 * wire_time(140, line.bit_rate); }
/// A busy node refuses a request by the codes of a node that never accepts it in its state (CiA 301, 7.2.4.3.17): only further attempts
/// distinguish them.
constexpr int most_refusals = 6;
constexpr Duration between_attempts = std::chrono::milliseconds(10);
}  // namespace

Exchanges::Exchanges(Drive& drive, const Node& node) : Part(drive), sdo_(node.number) {}

Duration Exchanges::patience() const noexcept {
    const Node& node = drive_.node;
    const Duration most = node.line.timing.reply_timeout + 64 * wire_time(140, node.line.bit_rate);
    // During a search most numbers have no node. Only the last probe waits for a slow node, and it accepts answers to the earlier ones.
    const bool early = ask_.why == Ask::Why::probe && node.presence.is(Presence::Phase::probing) &&
                       node.presence.silences() + 1 < static_cast<std::uint32_t>(node.line.timing.silent_limit);
    return early ? std::min(most, usual_time(node.line)) : most + times_.behind();
}
Duration Exchanges::repeat_after() const noexcept {
    const Line& line = drive_.node.line;
    return times_.repeat_after(usual_time(line), line.timing.reply_timeout + 64 * wire_time(140, line.bit_rate));
}

void Exchanges::send(Ask ask, Turn& t) {
    const auto& axes = drive_.axes;
    Node& node = drive_.node;
    if (ask.axis < axes.size() && !ask.step.literal) ask.step.address = of_axis(ask.step.address, axes[ask.axis]->place());
    if (ask.why != Ask::Why::stop && late_.has(ask.step.address)) {
        const bool other = late_.has(object::error_register);
        ask = {ask.why == Ask::Why::probe ? Ask::Why::probe : Ask::Why::flush,
               {Step::Kind::read, other ? object::vendor : object::error_register, {}},
               no_ticket,
               0,
               axes.size()};
        if (late_.has(ask.step.address)) late_.clear();
        if (ask.why == Ask::Why::probe) {
            ask.step.address = node.mark();
            late_.clear();
        }
    }
    ask_ = std::move(ask);
    node.line.turns.began(drive_.slot(), ask_.why == Ask::Why::probe);
    repeated_ = false;
    refusals_ = 0;
    cut_at_ = never;
    transfer(t);
}

void Exchanges::transfer(Turn& t) {
    std::vector<Frame> frames;
    const Step& s = ask_.step;
    sdo_.set_patience(patience());
    sent_ = t.now;
    repeat_at_ = ask_.left > 0 ? t.now + repeat_after() : never;
    times_.asked(s.address, t.now);
    if (!sdo_.repeat(t.now, frames)) {
        sdo_.abandon();
        if (s.kind == Step::Kind::write) {
            (void)sdo_.write(s.address, s.bytes, t.now, frames);
        } else {
            (void)sdo_.read(s.address, t.now, frames);
        }
    }
    const bool soon = ask_.why == Ask::Why::step || ask_.why == Ask::Why::turns;
    emit(frames, ask_.why == Ask::Why::stop ? Priority::urgent : soon ? Priority::command : Priority::poll, ask_.ticket, t);
}

std::optional<canopen::SdoEnd> Exchanges::on_frame(const Frame& f, Turn& t) {
    Node& node = drive_.node;
    Line& line = node.line;
    std::vector<Frame> frames;
    const auto strays = sdo_.strays();
    auto end = sdo_.on_frame(f, t.now, frames);
    emit(frames, Priority::command, ask_.ticket, t);
    if (sdo_.strays() != strays) {
        ++line.counters.unexpected;
        if (f.size == 8) late_or_second(canopen::address_of(f), t);
    }
    if (!end) {
        if (!active()) node.presence.received(t.now);
        return std::nullopt;
    }
    if (is_busy(*end) && ++refusals_ < most_refusals && cut_at_ == never) {
        (void)times_.answered(end->address, true, t.now);
        node.presence.answered();
        repeat_at_ = never;
        busy_until_ = t.now + between_attempts;
        return std::nullopt;
    }
    const bool one_frame = end->data.size() <= 4 && ask_.step.bytes.size() <= 4;
    (void)times_.answered(end->address, one_frame, t.now);
    this->end();
    line.turns.received(t.now);
    if (repeated_) late_.add(end->address);
    ++line.counters.exchanges;
    if (!end->done()) ++line.counters.refused;
    node.presence.answered();
    return end;
}

bool Exchanges::is_busy(const canopen::SdoEnd& end) const noexcept {
    const bool may_be = end.abort == canopen::Abort::transfer || end.abort == canopen::Abort::device_state;
    return may_be && end.by_node && !ask_.once;
}

/// A node answers requests in order: while it answers older ones, the wait for the newest is extended.
void Exchanges::late_or_second(Address address, Turn& t) {
    if (!times_.answered(address, true, t.now)) return drive_.stray();
    sdo_.extend(t.now + patience());
    if (repeat_at_ != never) repeat_at_ = std::max(repeat_at_, t.now + repeat_after());
}

void Exchanges::end() noexcept {
    repeat_at_ = cut_at_ = busy_until_ = never;
    drive_.node.line.turns.ended(drive_.slot());
}

Exchanges::Late Exchanges::on_deadline(Turn& t) {
    if (!active() || t.now < deadline()) return Late::no;
    AdapterCounters& counters = drive_.node.line.counters;
    if (t.now >= cut_at_) {
        if (!waits()) late_.add(ask_.step.address);
        sdo_.abandon();
        end();
        return Late::cut;
    }
    if (waits()) {
        busy_until_ = never;
        transfer(t);
        return Late::no;
    }
    if (ask_.left > 0) return again(t);
    std::vector<Frame> unsent;
    if (!sdo_.on_deadline(t.now, unsent)) {
        repeat_at_ = never;
        return Late::no;
    }
    ++counters.timeouts;
    end();
    late_.add(ask_.step.address);
    return Late::over;
}

Exchanges::Late Exchanges::again(Turn& t) {
    Node& node = drive_.node;
    const bool silent = t.now >= sdo_.deadline();
    if (!sdo_.beginning() && !silent) {  // the answer has begun: each further frame has its own time-out
        repeat_at_ = never;
        return Late::no;
    }
    --ask_.left;
    ++node.line.counters.timeouts;
    ++node.line.counters.retries;
    repeated_ = true;
    // Another NMT master may have stopped the node; then it accepts a stop only after NMT start.
    if (ask_.why == Ask::Why::stop && ask_.left == after_start - 1)
        t.out.send(canopen::nmt_frame(canopen::NmtCommand::start, node.number), Priority::urgent, ask_.ticket);
    transfer(t);
    return Late::no;
}

void Exchanges::drop() {
    times_.forget();
    repeat_at_ = cut_at_ = busy_until_ = never;
    if (!active()) return;
    std::vector<Frame> unsent;
    (void)sdo_.stop(canopen::Abort::timeout, unsent);
}

void Exchanges::no_repeats(Instant now) noexcept {
    if (!active() || ask_.why == Ask::Why::stop) return;
    ask_.left = 0;
    repeat_at_ = never;
    cut_at_ = waits() ? now : std::max(now, sent_ + repeat_after());
}

bool Exchanges::give_up() noexcept {
    if (!active()) return false;
    if (!waits()) late_.add(ask_.step.address);
    sdo_.abandon();
    end();
    return true;
}

}  // namespace axisgate::cia402_drive
