// Drive: what it sends next, and what answers and silences mean.
// In: places on the line, frames, time. Out: requests, results. Never has two SDO transfers with one node.
#include "adapters/cia402/drive.hpp"

#include <fmt/core.h>

#include <charconv>

#include "gateway/drive/option_reader.hpp"

namespace axisgate::cia402_drive {
using Phase = Presence::Phase;
using Want = drive::Want;

void Line::take(const LineSetup& setup) {
    timing = drive::timing_of(setup.timing, drive::Timing{.reply_timeout = std::chrono::milliseconds(50)});
    bit_rate = setup.bit_rate;
    turns.set(
        {.window = 32, .probe_window = 8, .pause = timing.pause, .overtaken_limit = 64, .overtaken_grace = 20 * wire_time(140, bit_rate)});
}

std::string Node::stored(Turn& t) {
    ++stores;
    stored_at = t.now;
    if (line.dialect.between_stores == Duration::zero()) return {};
    std::string text = fmt::format("write {} to its EPROM since this gateway knows it; it lasts for about 10000", stores);
    notices.tell(Severity::info, no_axis, "eprom", static_cast<std::int32_t>(stores), fmt::format("{}: {}", setup.name, text), t.now,
                 t.out);
    return text;
}

Drive::Drive(Line& line, const DriveSetup& setup, std::size_t slot)
    : node_(line, setup, static_cast<std::uint8_t>(node_of(setup.address))),
      slot_(slot),
      // An answer waits for the SYNC's PDOs of all nodes in the worst case.
      sdo_(node_.number, {.patience = line.timing.reply_timeout + 64 * wire_time(140, line.bit_rate)}),
      heartbeat_(node_.number),
      expected_(expected_identity(node_.catalogue())) {
    drive::OptionReader options(node_.setup.options);
    node_.keep_quick_stop = options.flag("quick_stop_stays", true, "yes", "no");
    heartbeat_period_ = options.milliseconds("heartbeat_ms", 0, 60'000, heartbeat_period_);
    Watch& watch = node_.watch;
    watch.action = options.word("watchdog_action", {"quick_stop", "disable", "fault", "none"});
    watch.on = watch.action != "none";
    watch.option = watch.action == "fault" ? 1 : watch.action == "disable" ? 2 : 3;
    watch.time = options.milliseconds("watchdog_ms", 100, 60'000, watch.time);
    if (line.dialect.places_move) node_.places = moved_places(node_.setup.options);
    fit_axes();
}

void Drive::fit_axes() {
    for (const AxisSetup& a : node_.setup.axes)
        if (a.channel >= 1 && a.channel <= node_.line.dialect.channels && !of(a.id)) axes_.push_back(std::make_unique<Axis>(node_, a));
}
void Drive::set_axes(const DriveSetup& setup, Turn& t) {
    node_.setup = setup;
    ask_.axis = ask_.axis < axes_.size() ? ask_.axis : SIZE_MAX;
    const Axis* asked = ask_.axis == SIZE_MAX ? nullptr : axes_[ask_.axis].get();
    std::erase_if(axes_, [&](const auto& a) {
        const bool stays = std::ranges::any_of(
            setup.axes, [&](const AxisSetup& s) { return s.id == a->id() && s.channel == static_cast<int>(a->place()) + 1; });
        if (!stays) node_.tickets.fail_axis(a->id(), Reason::line_down, "the axis was removed or changed", t.out);
        return !stays;
    });
    const auto before = axes_.size();
    fit_axes();
    const auto it = std::ranges::find_if(axes_, [&](const auto& a) { return a.get() == asked; });
    ask_.axis = it == axes_.end() ? SIZE_MAX : static_cast<std::size_t>(it - axes_.begin());
    // What was being set up may be gone: it is begun again when its turn comes.
    if (node_.presence.is(Phase::starting)) start_.clear();
    if (axes_.size() != before && node_.presence.is(Phase::ready)) {
        node_.presence.found();
        start_.clear();
        start_at_ = 0;
        start_axes();
    }
}

Axis* Drive::of(AxisId id) noexcept {
    const auto it = std::ranges::find(axes_, id, [](const auto& a) { return a->id(); });
    return it == axes_.end() ? nullptr : it->get();
}
int Drive::listeners() const noexcept {
    return static_cast<int>(std::ranges::count_if(axes_, [](const auto& a) { return a->listens(); }));
}
bool Drive::quick() const noexcept {
    return std::ranges::any_of(axes_, [](const auto& a) { return a->quick(); });
}

bool Drive::streams() const noexcept {
    return std::ranges::any_of(axes_, [](const auto& a) { return a->streams(); });
}

void Drive::forget(Reason reason, std::string_view why, Turn& t) {
    for (const auto& a : axes_)
        a->forget();
    start_.clear();
    check_at_ = never;
    heartbeat_.set_time({});
    node_.tickets.fail_all(reason, why, t.out);
    node_.presence.report(std::string(why), t.out);
}
void Drive::line_down(std::string_view why, Turn& t) {
    node_.presence.close();
    two_nodes_told_ = false;
    if (sdo_.busy()) {
        std::vector<Frame> unsent;
        (void)sdo_.stop(canopen::Abort::timeout, unsent);
    }
    for (const auto& a : axes_)
        a->forget_stops();
    forget(Reason::line_down, why, t);
}

void Drive::submit(const Command& c, Turn& t) {
    Axis* a = of(c.axis);
    if (!a) return drive::Tickets::refuse(c, Reason::not_supported, "this drive has no such axis", t.out);
    if (a->submit(c, t) && sdo_.busy()) ask_.left = 0;
}
void Drive::follow(const SetPoint& p) {
    if (Axis* a = of(p.axis)) a->follow(p);
}
void Drive::before_sync(Duration cycle, Turn& t) {
    for (const auto& a : axes_)
        a->before_sync(cycle, t);
}
void Drive::after_sync() noexcept {
    for (const auto& a : axes_)
        a->after_sync();
}

Want Drive::wants(Instant now) const noexcept {
    const Presence& presence = node_.presence;
    if (sdo_.busy() || presence.is(Phase::down)) return Want::nothing;
    // In order of what they are: a stop of any axis before all that another one wants.
    Want most = Want::nothing;
    for (const auto& a : axes_)
        if (const Want w = a->wants(now); w != Want::nothing && (most == Want::nothing || w < most)) most = w;
    if (most == Want::urgent) return most;
    if (!presence.online() || presence.is(Phase::restarting)) return presence.probe_due(now) ? Want::probe : Want::nothing;
    if (presence.is(Phase::starting)) return Want::command;
    return most == Want::nothing && now >= check_at_ ? Want::poll : most;
}
/// Of what wants() looks at, and of nothing that waits behind it.
Instant Drive::wish() const noexcept {
    Instant first = never;
    for (const auto& a : axes_)
        first = std::min(first, a->wish());
    const Presence& presence = node_.presence;
    if (!presence.online() || presence.is(Phase::restarting)) return std::min(first, presence.deadline());
    return presence.is(Phase::starting) ? first : std::min(first, check_at_);
}

void Drive::go(Turn& t) {
    Presence& presence = node_.presence;
    const Want want = wants(t.now);
    if (want == Want::probe) {
        presence.probe_sent();
        return send({Ask::Why::probe, {Step::Kind::read, node_.mark(), {}}, no_ticket, 0, axes_.size()}, t);
    }
    if (want != Want::urgent && presence.is(Phase::starting)) return next_start(t);
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        const std::size_t at = (turn_ + i) % axes_.size();
        if (axes_[at]->wants(t.now) != want) continue;
        turn_ = at + 1;
        auto ask = axes_[at]->next(t);
        if (!ask) return;
        ask->axis = at;
        if (ask->step.kind != Step::Kind::nmt) return send(std::move(*ask), t);
        t.out.send(canopen::nmt_frame(ask->step.nmt, node_.number));  // nobody answers it
        return heed(axes_[at]->answered(*ask, {}, t), t);
    }
    if (t.now >= check_at_) send({Ask::Why::check, {Step::Kind::read, object::error_register, {}}, no_ticket, 0, axes_.size()}, t);
}

void Drive::send(Ask ask, Turn& t) {
    if (ask.axis < axes_.size() && !ask.step.literal) ask.step.address = of_axis(ask.step.address, axes_[ask.axis]->place());
    // A late answer to the same question would be taken for the new one: something else is asked before. A stop waits for nothing.
    if (ask.why != Ask::Why::stop && late_.has(ask.step.address)) {
        const bool other = late_.has(object::error_register);
        ask = {ask.why == Ask::Why::probe ? Ask::Why::probe : Ask::Why::flush,
               {Step::Kind::read, other ? object::vendor : object::error_register, {}},
               no_ticket,
               0,
               axes_.size()};
        if (late_.has(ask.step.address)) late_.clear();
        if (ask.why == Ask::Why::probe) {
            ask.step.address = node_.mark();
            late_.clear();
        }
    }
    ask_ = std::move(ask);
    node_.line.turns.began(slot_, ask_.why == Ask::Why::probe);
    transfer(t);
}
void Drive::transfer(Turn& t) {
    std::vector<Frame> frames;
    const Step& s = ask_.step;
    if (s.kind == Step::Kind::write) {
        (void)sdo_.write(s.address, s.bytes, t.now, frames);
    } else {
        (void)sdo_.read(s.address, t.now, frames);
    }
    emit_frames(frames, ask_.why == Ask::Why::stop ? Priority::urgent : ask_.why == Ask::Why::step ? Priority::command : Priority::poll, t);
}
void Drive::emit_frames(std::vector<Frame>& frames, Priority priority, Turn& t) {
    for (const Frame& f : frames)
        t.out.send(f, priority);
}

void Drive::on_frame(const Frame& f, Turn& t) {
    if (node_.presence.is(Phase::down)) return;
    if (const auto e = canopen::emergency_of(f, node_.number)) return on_emergency(*e, t);
    if (f.id == static_cast<std::uint32_t>(canopen::error_control_base + node_.number)) return on_heartbeat(f, t);
    if (on_pdo(f, t)) return;
    if (f.id != static_cast<std::uint32_t>(canopen::sdo_answer_base + node_.number)) return;
    std::vector<Frame> frames;
    const auto strays = sdo_.strays();
    const auto end = sdo_.on_frame(f, t.now, frames);
    emit_frames(frames, Priority::command, t);
    Line& line = node_.line;
    if (sdo_.strays() != strays) {
        ++line.counters.unexpected;
        answered_twice_ = true;
    }
    if (!end) {
        if (!sdo_.busy()) node_.presence.heard(t.now);
        return;
    }
    line.turns.ended(slot_);
    line.turns.heard(t.now);
    if (ask_.left != line.timing.retries && ask_.why == Ask::Why::step) late_.add(end->address);
    ++line.counters.exchanges;
    if (!end->done()) ++line.counters.refused;
    node_.presence.answered();
    watch_for_twins(t);
    ended(*end, t);
}

/// A late answer happens; one to every question means that there are two who answer.
void Drive::watch_for_twins(Turn& t) {
    constexpr int many = 12;
    twice_in_a_row_ = std::exchange(answered_twice_, false) ? std::min(twice_in_a_row_ + 1, many + 1) : 0;
    if (twice_in_a_row_ == many) tell_two_nodes("each question is answered twice", t);
}
void Drive::tell_two_nodes(std::string_view sign, Turn& t) {
    if (std::exchange(two_nodes_told_, true)) return;
    node_.notices.tell(Severity::warning, first_axis(), "two_nodes", 0,
                       fmt::format("{}: {}: two nodes have the number {}. Give one of them another number: both follow what is ordered "
                                   "of the one",
                                   node_.setup.name, sign, node_.number),
                       t.now, t.out);
}

void Drive::ended(const canopen::SdoEnd& end, Turn& t) {
    const Ask ask = ask_;
    switch (ask.why) {
        case Ask::Why::probe:
            return probed(end, t);
        case Ask::Why::start:
            return started(end, t);
        case Ask::Why::flush:
            return late_.clear();
        default:
            break;
    }
    if (ask.axis >= axes_.size()) {
        check_at_ = t.now + std::max<Duration>(4 * node_.line.cycle, std::chrono::milliseconds(100));
        return;
    }
    heed(axes_[ask.axis]->answered(ask, end, t), t);
}

void Drive::heed(Axis::News news, Turn& t) {
    if (news == Axis::News::deaf) start();
    if (news != Axis::News::node_resets) return;
    node_.presence.lose(t.now, std::chrono::seconds(1));  // its boot-up message brings it back at once
    forget(Reason::interrupted, "the drive restarts", t);
}

void Drive::on_deadline(Turn& t) {
    if (heartbeat_.on_deadline(t.now) == canopen::NodeNews::lost && node_.presence.online()) {
        node_.notices.tell(Severity::warning, first_axis(), "heartbeat", 0, fmt::format("{}: its heartbeat has stopped", node_.setup.name),
                           t.now, t.out);
        check_at_ = t.now;
        for (const auto& a : axes_)
            a->look_soon(t.now);
    }
    if (!sdo_.busy() || t.now < sdo_.deadline()) return;
    std::vector<Frame> frames;
    const auto end = sdo_.on_deadline(t.now, frames);
    if (!end) return;
    Line& line = node_.line;
    ++line.counters.timeouts;
    if (ask_.left > 0) {
        --ask_.left;
        ++line.counters.retries;
        return transfer(t);
    }
    line.turns.ended(slot_);
    late_.add(ask_.step.address);
    unanswered(t);
}

void Drive::unanswered(Turn& t) {
    Presence& presence = node_.presence;
    if (ask_.axis < axes_.size()) axes_[ask_.axis]->unanswered(ask_);
    node_.tickets.failed(ask_.ticket, Reason::no_answer,
                         canopen::to_text(ask_.step.address) + " was not answered: whether the drive took it is not known", t.out);
    if (presence.online()) {
        for (const auto& a : axes_)
            a->look_soon(t.now);
        if (axes_.empty()) check_at_ = t.now;
    }
    if (presence.is(Phase::starting)) start_.clear();
    if (presence.silent(t.now) != Presence::Silence::counted) forget(Reason::no_answer, "the drive does not answer", t);
}

}  // namespace axisgate::cia402_drive
