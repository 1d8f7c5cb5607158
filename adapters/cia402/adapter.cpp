// Adapter of CiA 402 drives: the line.
// In: calls from outside. Out: what the drives say of them. Every call ends with end(): free places are given away, the next SYNC is set.
#include "adapters/cia402/adapter.hpp"

#include <utility>

#include "gateway/drive/option_reader.hpp"

namespace axisgate::cia402_drive {

void LineAdapter::configure(const LineSetup& setup, Instant now, Out& out) {
    Turn t{now, out};
    line_.take(setup);
    choose_own_node(setup);
    const auto fault = [&](const DriveSetup& s) -> std::string {
        const auto* other = drives_.find([&](const Drive& d) { return d.node.number == node_of(s.address); });
        return other ? "node " + s.address + " belongs to drive " + other->setup().name : check_address(s.address);
    };
    drives_.fit_axes(setup, [&](Drive& d, const DriveSetup& s) { d.set_axes(s, t); });
    const auto fresh = drives_.fit(
        setup,
        [&](Drive& d) {
            d.line_down("the drive was removed or changed", t);
            line_.turns.remove(d.slot());
        },
        fault, [&](const DriveSetup& s, std::size_t slot) { return std::make_unique<Drive>(line_, s, slot); }, out);
    by_node_.fill(nullptr);
    drives_.each([&](Drive& d) { by_node_[d.node.number] = &d; });
    for (Drive* d : fresh)
        if (up_) d->line_up(t);
    end(t);
}

void LineAdapter::on_line(bool up, Instant now, Out& out) {
    if (std::exchange(up_, up) == up) return;
    Turn t{now, out};
    line_.turns.line_changed(now);
    drives_.each([&](Drive& d) { up ? d.line_up(t) : d.line_down("the line is down", t); });
    end(t);
}

void LineAdapter::on_command(const Command& command, Instant now, Out& out) {
    Turn t{now, out};
    Drive* d = drives_.of(command.axis);
    if (!d) return drive::Tickets::refuse(command, Reason::line_down, "this axis is not on the line", out);
    d->submit(command, t);
    drive::settle(line_.turns, *d, now);
    drive::serve(line_.turns, drives_, t);
    plan_sync(now);
}

void LineAdapter::on_set_point(const SetPoint& p, Instant now, Out& out) {
    Turn t{now, out};
    Drive* d = drives_.of(p.axis);
    if (!d) return;
    d->follow(p);
    plan_sync(now);
    drive::settle(line_.turns, *d, now);
    drive::serve(line_.turns, drives_, t);
    plan_sync(now);
}

void LineAdapter::on_frame(const Frame& f, Instant now, Out& out) {
    if (!up_ || f.kind != Frame::Kind::can || f.extended) return;
    Turn t{now, out};
    const auto role = canopen::role_of(f.id);
    Drive* d = role.node != 0 && role.node < by_node_.size() ? by_node_[role.node] : nullptr;
    if (!d) {
        if (role.service == canopen::Service::other) ++line_.counters.garbled;
        return;
    }
    d->on_frame(f, t);
    drive::settle(line_.turns, *d, now);
    drive::serve(line_.turns, drives_, t);
    plan_sync(now);
    plan_heartbeat(now);
}

void LineAdapter::on_deadline(Instant now, Out& out) {
    Turn t{now, out};
    if (const auto beat = heartbeat_.on_deadline(now, line_.own_node, canopen::NmtState::operational)) t.out.send(*beat, Priority::command);
    if (up_ && now >= next_sync_) {
        drives_.each([&](Drive& d) { d.before_sync(line_.cycle, t); });
        out.send(canopen::data_frame(canopen::sync_id, {}), Priority::command);
        last_sync_ = now;
        next_sync_ = never;
        drives_.each([&](Drive& d) { d.after_sync(); });
    }
    drive::wake(line_.turns, drives_, t);
    end(t);
}

void LineAdapter::end(Turn& t) {
    drives_.each([&](Drive& d) { drive::settle(line_.turns, d, t.now); });
    drive::serve(line_.turns, drives_, t);
    plan_sync(t.now);
    plan_heartbeat(t.now);
}

/// A number that no drive of the line has. It stays while it can: the drives watch it.
void LineAdapter::choose_own_node(const LineSetup& setup) {
    drive::OptionReader options(setup.options);
    const auto before = line_.own_node;
    auto number = static_cast<std::uint8_t>(options.whole("gateway_node", 1, 127, 127));
    const auto taken = [&](std::uint8_t n) {
        return std::ranges::any_of(setup.drives, [n](const DriveSetup& d) { return node_of(d.address) == n; });
    };
    for (int tried = 0; taken(number) && tried < 127; ++tried)
        number = number > 1 ? static_cast<std::uint8_t>(number - 1) : std::uint8_t{127};
    line_.own_node = number;
    if (number != before) drives_.each([](Drive& d) { d.watch_anew(); });
}

void LineAdapter::plan_heartbeat(Instant now) {
    constexpr Duration usual = std::chrono::milliseconds(50);  // of a bus at 125 kbit/s a hundredth
    Duration period{};
    drives_.each([&](const Drive& d) {
        if (up_ && d.watches()) period = std::min(period == Duration::zero() ? usual : period, d.node.watch.time / 4);
    });
    if (std::exchange(heartbeat_period_, period) != period) heartbeat_.set_period(period, now);
}

Duration LineAdapter::cycle() const {
    std::int64_t ready = 0;
    bool quick = false, streams = false;
    Duration period = line_.timing.poll_period;
    drives_.each([&](const Drive& d) {
        ready += d.listeners();
        quick = quick || d.quick() || d.pace().close();
        streams = streams || d.streams();
        period = std::min(period, d.pace().period(period));
    });
    if (streams) period = line_.timing.poll_period;  // by which the drive that follows was told to reckon
    if (ready == 0) return Duration::zero();
    // Two PDOs of each at a SYNC, and one to those that are led: 0.4 ms of a bus at 1 Mbit/s, half of which is for others.
    const Duration least = ready * 3 * 2 * wire_time(140, line_.bit_rate == 0 ? 1'000'000 : line_.bit_rate);
    const Duration whole = std::max(period, least) + std::chrono::microseconds(999);
    const Duration ms = std::max<Duration>(std::chrono::milliseconds(1), std::chrono::milliseconds(milliseconds_of(whole)));
    return quick ? ms : 4 * ms;
}
void LineAdapter::plan_sync(Instant now) {
    const Duration period = up_ ? cycle() : Duration::zero();
    if (period == Duration::zero()) {
        next_sync_ = never;
        return;
    }
    line_.cycle = period;
    next_sync_ = std::max(now, last_sync_ + period);
}

}  // namespace axisgate::cia402_drive
