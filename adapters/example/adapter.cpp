// Adapter of the example drive: the line.
// In: calls from outside. Out: what the drives say of them. Every call ends with serve(): a free line is given away at once.
#include "adapters/example/adapter.hpp"

#include <charconv>

namespace axisgate::example {
namespace {
int address_of(std::string_view text) {
    int n = 0;
    const auto [p, ec] = std::from_chars(text.data(), text.data() + text.size(), n);
    return ec == std::errc{} && p == text.data() + text.size() && n >= 1 && n <= 99 ? n : 0;
}
}  // namespace

std::string check_address(std::string_view address) {
    return address_of(address) != 0 ? std::string() : "an example drive has a number from 1 to 99";
}

void LineAdapter::configure(const LineSetup& setup, Instant now, Out& out) {
    Turn t{now, out};
    line_.take(setup);
    const auto taken = [&](const DriveSetup& s) -> std::string {
        const auto* other = drives_.find([&](const Drive& d) { return d.address() == address_of(s.address); });
        return other ? "number " + s.address + " belongs to drive " + other->setup().name : check_address(s.address);
    };
    drives_.fit_axes(setup, [&](Drive& d, const DriveSetup& s) { d.set_axes(s, t); });
    const auto fresh = drives_.fit(
        setup,
        [&](Drive& d) {
            d.line_down("the drive was removed or changed", t);
            line_.turns.remove(d.slot());
        },
        taken, [&](const DriveSetup& s, std::size_t slot) { return std::make_unique<Drive>(line_, s, address_of(s.address), slot); }, out);
    for (Drive* d : fresh)
        if (up_) d->line_up(t);
    drives_.each([&](Drive& d) { drive::settle(line_.turns, d, now); });
    drive::serve(line_.turns, drives_, t);
}

void LineAdapter::on_line(bool up, Instant now, Out& out) {
    if (std::exchange(up_, up) == up) return;
    Turn t{now, out};
    line_.turns.line_changed(now);
    drives_.each([&](Drive& d) {
        up ? d.line_up(t) : d.line_down("the line is down", t);
        drive::settle(line_.turns, d, now);
    });
    drive::serve(line_.turns, drives_, t);
}

void LineAdapter::on_command(const Command& command, Instant now, Out& out) {
    Turn t{now, out};
    Drive* d = drives_.of(command.axis);
    if (!d) return drive::Tickets::refuse(command, Reason::line_down, "this axis is not on the line", out);
    d->submit(command, t);
    drive::settle(line_.turns, *d, now);
    drive::serve(line_.turns, drives_, t);
}

void LineAdapter::on_set_point(const SetPoint& p, Instant now, Out& out) {
    Turn t{now, out};
    Drive* d = drives_.of(p.axis);
    if (!d) return;
    d->follow(p);
    drive::settle(line_.turns, *d, now);
    drive::serve(line_.turns, drives_, t);
}

void LineAdapter::on_frame(const Frame& frame, Instant now, Out& out) {
    Turn t{now, out};
    if (!up_ || frame.kind != Frame::Kind::bytes) return;
    framer_.push({reinterpret_cast<const char*>(frame.data().data()), frame.size}, [&](std::string_view line) {
        bool request = false;
        const auto telegram = telegram_of(line, request);
        Drive* d = telegram && !request ? drives_.find([&](const Drive& x) { return x.address() == telegram->address; }) : nullptr;
        if (!d) ++(telegram ? line_.counters.unexpected : line_.counters.garbled);
        if (d) d->on_telegram(*telegram, t), drive::settle(line_.turns, *d, now);
    });
    drive::serve(line_.turns, drives_, t);
}

void LineAdapter::on_deadline(Instant now, Out& out) {
    Turn t{now, out};
    drive::wake(line_.turns, drives_, t);
    drive::serve(line_.turns, drives_, t);
}

}  // namespace axisgate::example
