// Adapter of the remote family: the line.
// In: calls from outside. Out: what the drives say of them. Every call ends with what a drive has to send.
#include "adapters/remote/adapter.hpp"

#include <algorithm>

namespace axisgate::remote {

void LineAdapter::configure(const LineSetup& setup, Instant now, Out& out) {
    Turn t{now, out};
    line_.take(setup, now);
    const auto taken = [&](const DriveSetup& s) -> std::string {
        const auto* other = drives_.find([&](const Drive& d) { return d.setup().address == s.address; });
        return other ? s.address + " is mirrored by " + other->setup().name + " already" : mirror::check_address(s.address);
    };
    const auto fresh = drives_.fit(
        setup, [&](Drive& d) { d.line_down("the drive was removed or changed", t); }, taken,
        [&](const DriveSetup& s, std::size_t) { return std::make_unique<Drive>(line_, s); }, out);
    for (Drive* d : fresh)
        if (up_) d->line_up(t);
    drives_.each([&](Drive& d) { d.go(t); });
}

void LineAdapter::on_line(bool up, Instant now, Out& out) {
    if (std::exchange(up_, up) == up) return;
    Turn t{now, out};
    framer_.clear();
    drives_.each([&](Drive& d) { up ? d.line_up(t) : d.line_down("the line is down", t); });
}

void LineAdapter::on_command(const Command& command, Instant now, Out& out) {
    Turn t{now, out};
    Drive* d = drives_.of(command.axis);
    if (!d) return drive::Tickets::refuse(command, Reason::line_down, "this axis is not on the line", out);
    d->submit(command, t);
    d->go(t);
}

void LineAdapter::on_frame(const Frame& frame, Instant now, Out& out) {
    Turn t{now, out};
    if (!up_ || frame.kind != Frame::Kind::bytes) return;
    framer_.push({reinterpret_cast<const char*>(frame.data().data()), frame.size}, [&](std::string_view line) {
        if (line.empty()) return;
        const auto telegram = mirror::telegram_of(line);
        const bool ours = telegram && telegram->kind != mirror::Telegram::Kind::request;
        Drive* d = ours ? drives_.find([&](const Drive& x) { return x.setup().address == telegram->address; }) : nullptr;
        if (!d) return void(++(telegram ? line_.counters.unexpected : line_.counters.garbled));
        d->on_telegram(*telegram, t);
        d->go(t);
    });
}

void LineAdapter::on_deadline(Instant now, Out& out) {
    Turn t{now, out};
    drives_.each([&](Drive& d) {
        if (d.deadline() > now) return;
        d.on_deadline(t);
        d.go(t);
    });
}

Instant LineAdapter::deadline() const {
    Instant first = never;
    drives_.each([&](const Drive& d) { first = std::min(first, d.deadline()); });
    return first;
}

}  // namespace axisgate::remote
