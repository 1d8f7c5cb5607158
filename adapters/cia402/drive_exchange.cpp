// Exchanges: transfers, one after the other.
// In: questions, frames, time. Out: SDO frames, counted. A question whose late answer may still come goes behind another one.
#include "adapters/cia402/drive_exchange.hpp"

#include "adapters/cia402/drive.hpp"

namespace axisgate::cia402_drive {
namespace {
void emit(const std::vector<Frame>& frames, Priority priority, Ticket order, Turn& t) {
    for (const Frame& f : frames)
        t.out.send(f, priority, order);
}
}  // namespace

// An answer waits for the SYNC's PDOs of all nodes in the worst case.
Exchanges::Exchanges(Drive& drive, const Node& node)
    : Part(drive), sdo_(node.number, {.patience = node.line.timing.reply_timeout + 64 * wire_time(140, node.line.bit_rate)}) {}

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
    transfer(t);
}

void Exchanges::transfer(Turn& t) {
    std::vector<Frame> frames;
    const Step& s = ask_.step;
    if (s.kind == Step::Kind::write) {
        (void)sdo_.write(s.address, s.bytes, t.now, frames);
    } else {
        (void)sdo_.read(s.address, t.now, frames);
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
        drive_.stray();
    }
    if (!end) {
        if (!active()) node.presence.received(t.now);
        return std::nullopt;
    }
    line.turns.ended(drive_.slot());
    line.turns.received(t.now);
    if (ask_.left != line.timing.retries && ask_.why == Ask::Why::step) late_.add(end->address);
    ++line.counters.exchanges;
    if (!end->done()) ++line.counters.refused;
    node.presence.answered();
    return end;
}

bool Exchanges::on_deadline(Turn& t) {
    if (!active() || t.now < sdo_.deadline()) return false;
    std::vector<Frame> frames;
    if (!sdo_.on_deadline(t.now, frames)) return false;
    Line& line = drive_.node.line;
    ++line.counters.timeouts;
    if (ask_.left > 0) {
        --ask_.left;
        ++line.counters.retries;
        transfer(t);
        return false;
    }
    line.turns.ended(drive_.slot());
    late_.add(ask_.step.address);
    return true;
}

void Exchanges::drop() {
    if (!active()) return;
    std::vector<Frame> unsent;
    (void)sdo_.stop(canopen::Abort::timeout, unsent);
}

void Exchanges::no_repeats() noexcept {
    if (active()) ask_.left = 0;
}

}  // namespace axisgate::cia402_drive
