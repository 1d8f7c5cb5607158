#include "adapters/cia402/adapter.hpp"

#include <utility>

#include "gateway/drive/option_reader.hpp"

namespace axisgate::cia402_drive {
namespace {
constexpr int rest_cycle = 250;  ///< ms; an axis at standstill is observed in this cycle, or in its own if that is longer
}

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
    plan_beats(t);
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
    // Sent after all waiting frames: its identifier has nearly the lowest priority, and a SYNC that waits for it would be late.
    if (const auto beat = heartbeat_.on_deadline(now, line_.own_node, canopen::NmtState::operational)) t.out.send(*beat, Priority::poll);
    if (now >= targets_at_) send_targets(t);
    if (up_ && now >= sync_.deadline()) send_sync(t);
    drive::wake(line_.turns, drives_, t);
    end(t);
}

void LineAdapter::send_targets(Turn& t) {
    targets_at_ = never;
    targets_for_ = line_.beat + 1;
    drives_.each([&](Drive& d) { d.before_sync(t); });
}
void LineAdapter::send_sync(Turn& t) {
    if (targets_for_ != line_.beat + 1) send_targets(t);
    if (const auto sync = sync_.on_deadline(t.now)) t.out.send(*sync, Priority::command);
    ++line_.beat;
    line_.synced_at = t.now;
    drives_.each([&](Drive& d) { d.after_sync(); });
}

void LineAdapter::end(Turn& t) {
    if (line_.targets.none() && (wished_ != wished_beat() || line_.plan_anew)) plan_beats(t);  // not while axes follow set-points
    drives_.each([&](Drive& d) { drive::settle(line_.turns, d, t.now); });
    drive::serve(line_.turns, drives_, t);
    plan_sync(t.now);
    plan_heartbeat(t.now);
}

/// Chooses a node number that no drive of the line has. It is kept as long as possible, because the drives watch it.
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
    constexpr Duration usual = std::chrono::milliseconds(50);  // one hundredth of a bus at 125 kbit/s
    Duration period{};
    drives_.each([&](const Drive& d) {
        const Duration time = up_ ? d.watch_time() : Duration::zero();
        if (time != Duration::zero()) period = std::min(period == Duration::zero() ? usual : period, time / 4);
    });
    if (std::exchange(heartbeat_period_, period) != period) heartbeat_.set_period(period, now);
}

Duration LineAdapter::wished_beat() const {
    const auto whole = std::chrono::milliseconds(milliseconds_of(line_.timing.poll_period + std::chrono::microseconds(999)));
    return line_.targets.none() ? std::max<Duration>(whole, std::chrono::milliseconds(1)) : line_.plan.beat;
}
void LineAdapter::plan_beats(Turn& t) {
    wished_ = wished_beat();
    canopen::TurnsWish wish{wished_, line_.bit_rate, axis_bits, target_bits, line_.targets.fullest(), {}};
    drives_.each([&](const Drive& d) { wish.nodes.push_back({d.node.weight, d.node.slot}); });
    auto plan = canopen::plan_turns(wish);
    if (!line_.targets.none() && plan.beat != line_.plan.beat) {  // drives that follow set-points calculate with the cycle: their streams
                                                                  // end when it may change
        wished_ = {};
        return;
    }
    line_.plan = std::move(plan);
    line_.plan_anew = false;
    std::size_t i = 0;
    drives_.each([&](Drive& d) { d.node.take_slot(line_.plan.slots[i++], t); });
}

Duration LineAdapter::period() const {
    using std::chrono::milliseconds;
    bool wanted = false, quick = false, streams = false;
    const Duration beat = line_.plan.beat;
    Duration close = beat;
    drives_.each([&](const Drive& d) {
        wanted = wanted || d.beats_wanted();
        quick = quick || d.quick() || d.pace().close();
        streams = streams || d.streams();
        close = std::min(close, d.pace().period(beat));
    });
    if (!wanted) return Duration::zero();
    if (streams) return beat;  // the drives that follow set-points were configured with this cycle
    if (!quick)
        return std::min<Duration>(drive::Pace::rested * beat, std::max<Duration>(beat, milliseconds(rest_cycle / line_.plan.turns)));
    // For an axis that is observed closely, as far as the load of the fullest cycle permits.
    const auto whole = [](Duration d) { return milliseconds(milliseconds_of(d + std::chrono::microseconds(999))); };
    const Duration least = 2 * wire_time(line_.plan.bits, line_.bit_rate == 0 ? 1'000'000 : line_.bit_rate);
    return std::min<Duration>(beat, std::max<Duration>({whole(close), whole(least), milliseconds(1)}));
}
void LineAdapter::plan_sync(Instant now) {
    const Duration period = up_ ? this->period() : Duration::zero();
    sync_.set_period(period, now);
    targets_at_ = never;
    if (period == Duration::zero()) return;
    line_.period = period;
    const int due = line_.targets.in(line_.beat + 1);
    if (due == 0 || targets_for_ == line_.beat + 1) return;
    // Time for a frame that is being transmitted, for the targets one after the other, and for a delay of this thread.
    const auto bits = canopen::most_bits(8) + static_cast<std::uint64_t>(due) * target_bits;
    const Duration before = wire_time(bits, line_.bit_rate) + std::chrono::microseconds(200);
    targets_at_ = sync_.deadline() - std::min<Duration>(before, period / 2);
}

}  // namespace axisgate::cia402_drive
