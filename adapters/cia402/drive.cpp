#include "adapters/cia402/drive.hpp"

#include <fmt/core.h>

#include <charconv>

#include "gateway/core/only_reads.hpp"
#include "gateway/drive/option_reader.hpp"

namespace axisgate::cia402_drive {
using Phase = Presence::Phase;
using Want = drive::Want;

void Line::take(const LineSetup& setup) {
    timing = drive::timing_of(setup.timing, drive::Timing{.reply_timeout = std::chrono::milliseconds(500)});
    bit_rate = setup.bit_rate;
    turns.set(
        {.window = 32, .probe_window = 16, .pause = timing.pause, .overtaken_limit = 64, .overtaken_grace = 20 * wire_time(140, bit_rate)});
}

Dialect dialect_of(const Catalogue& catalogue) {
    Dialect d;
    d.channels = std::min(catalogue.most_channels(), most_axes);
    const auto* has = catalogue.document().if_contains("dialect");
    if (!has) return d;
    const auto& o = has->as_object();
    d.noun = std::string(o.at("noun").as_string());
    d.profile_optional = o.at("profile_optional").as_bool();
    d.mark = {o.at("mark_index").to_number<std::uint16_t>(), o.at("mark_sub").to_number<std::uint8_t>()};
    d.errors_in_low_byte = o.at("errors_in_low_byte").as_bool();
    d.between_stores = std::chrono::seconds(o.at("between_stores_s").to_number<int>());
    d.places_move = o.at("places_move").as_bool();
    return d;
}

std::string Node::stored(Turn& t) {
    ++stores;
    stored_at = t.now;
    if (dialect.between_stores == Duration::zero()) return {};
    std::string text = fmt::format("write {} to its EPROM since this gateway knows it; it lasts for about 10000", stores);
    notices.tell(Severity::info, no_axis, "eprom", static_cast<std::int32_t>(stores), fmt::format("{}: {}", setup.name, text), t.now,
                 t.out);
    return text;
}

namespace {
/// The reports of the axes in one cycle, in units of those of an axis with the gateway's mapping.
int weight_of(const std::vector<std::unique_ptr<Axis>>& axes) noexcept {
    int sum = 0;
    for (const auto& a : axes) {
        std::uint32_t bits = 0;
        for (const canopen::Pdo& p : a->known.pdos.reports)
            bits += canopen::most_bits(static_cast<std::uint32_t>(canopen::bits_of(p.mapping) / 8));
        sum += std::max(1, static_cast<int>((bits + axis_bits - 1) / axis_bits));
    }
    return sum;
}
}  // namespace

Drive::Drive(Line& line, const DriveSetup& setup, std::size_t slot)
    : node(line, setup, static_cast<std::uint8_t>(node_of(setup.address))),
      exchanges(*this, node),
      start(*this, node),
      nmt(*this),
      slot_(slot),
      heartbeat_(node.number) {
    drive::OptionReader options(node.setup.options);
    node.only_reads = only_reads(node.setup.options);
    node.keep_quick_stop = options.flag("quick_stop_stays", false, "yes", "no");
    node.restart_stopped = options.flag("restart_stopped", false, "yes", "no");
    node.keep_limits = options.flag("drive_limits", true, "on", "off");
    if (const auto plan = options.word("pdo_plan", {"auto", "free", "file", "few", "sdo"}); plan != "auto")
        for (const PdoPlan p : {PdoPlan::free, PdoPlan::file, PdoPlan::few, PdoPlan::sdo})
            if (plan == name_of(p)) node.pdo_plan = p;
    heartbeat_period_ = options.milliseconds("heartbeat_ms", 0, 60'000, heartbeat_period_);
    node.mode_timeout = options.milliseconds("mode_timeout_ms", 10, 10'000, node.mode_timeout);
    node.start_timeout = options.milliseconds("start_timeout_ms", 50, 10'000, node.start_timeout);
    Watch& watch = node.watch;
    watch.action = options.word("watchdog_action", {"quick_stop", "disable", "fault", "none"});
    watch.on = watch.action != "none";
    watch.option = watch.action == "fault" ? 1 : watch.action == "disable" ? 2 : 3;
    watch.time = options.milliseconds("watchdog_ms", 100, 60'000, watch.time);
    if (node.dialect.places_move) node.places = moved_places(node.setup.options);
    fit_axes();
    node.weight = weight_of(axes);
}

void Drive::fit_axes() {
    for (const AxisSetup& a : node.setup.axes)
        if (a.channel >= 1 && a.channel <= node.dialect.channels && !of(a.id)) axes.push_back(std::make_unique<Axis>(node, a));
}
void Drive::look(const DriveSetup& setup) {
    (void)pace_.take(setup);
    bool others = false;
    for (const AxisSetup& s : setup.axes)
        if (Axis* a = of(s.id)) others = a->set_limits(s) || others;
    if (others && node.presence.is(Phase::ready)) start.begin();
}
void Drive::set_axes(const DriveSetup& setup, Turn& t) {
    node.setup = setup;
    const std::size_t asking = exchanges.ask().axis;
    const Axis* asked = asking < axes.size() ? axes[asking].get() : nullptr;
    std::erase_if(axes, [&](const auto& a) {
        const bool stays = std::ranges::any_of(
            setup.axes, [&](const AxisSetup& s) { return s.id == a->id() && s.channel == static_cast<int>(a->place()) + 1; });
        if (!stays) node.tickets.fail_axis(a->id(), Reason::line_down, "the axis was removed or changed", t.out);
        return !stays;
    });
    const auto before = axes.size();
    fit_axes();
    const auto it = std::ranges::find_if(axes, [&](const auto& a) { return a.get() == asked; });
    exchanges.moved(it == axes.end() ? SIZE_MAX : static_cast<std::size_t>(it - axes.begin()));
    if (node.presence.is(Phase::starting)) start.forget();
    if (axes.size() != before && node.presence.is(Phase::ready)) {
        node.presence.found();
        start.begin_axes();
    }
}

Axis* Drive::of(AxisId id) noexcept {
    const auto it = std::ranges::find(axes, id, [](const auto& a) { return a->id(); });
    return it == axes.end() ? nullptr : it->get();
}
int Drive::listeners() const noexcept {
    return static_cast<int>(std::ranges::count_if(axes, [](const auto& a) { return a->listens(); }));
}
bool Drive::quick() const noexcept {
    return std::ranges::any_of(axes, [](const auto& a) { return a->quick(); });
}

bool Drive::streams() const noexcept {
    return std::ranges::any_of(axes, [](const auto& a) { return a->stream.on() || a->needs_even_syncs(); });
}

void Drive::forget(Reason reason, std::string_view why, Turn& t) {
    for (const auto& a : axes)
        a->forget();
    start.forget();
    node.stopped = false;
    check_at_ = never;
    heartbeat_.set_time({});
    node.tickets.fail_all(reason, why, t.out);
    node.presence.report(std::string(why), t.out);
}
void Drive::notice(Severity severity, std::string_view kind, std::int32_t code, std::string text, Turn& t) {
    node.notices.tell(severity, axes.empty() ? no_axis : axes.front()->id(), kind, code, std::move(text), t.now, t.out);
}
void Drive::line_down(std::string_view why, Turn& t) {
    node.presence.close();
    two_nodes_reported_ = false;
    exchanges.drop();
    for (const auto& a : axes)
        a->forget_stops();
    forget(Reason::line_down, why, t);
}

void Drive::made_ready(Turn& t) {
    if (!axes.empty() && !node.only_reads) heartbeat_.set_time(3 * heartbeat_period_);
    for (const auto& a : axes)
        if (a->is_new()) a->made_ready(t.now);
    if (listeners() == 0) check_at_ = t.now + std::chrono::milliseconds(200);
    const int weight = weight_of(axes);
    if (std::exchange(node.weight, weight) != weight) node.line.plan_anew = true;
}

void Drive::submit(const Command& c, Turn& t) {
    Axis* a = of(c.axis);
    if (!a) return drive::Tickets::refuse(c, Reason::not_supported, "this drive has no such axis", t.out);
    if (a->submit(c, t)) exchanges.no_repeats(t.now);
}
void Drive::follow(const SetPoint& p) {
    if (Axis* a = of(p.axis)) a->stream.follow(p);
}
void Drive::before_sync(Turn& t) {
    for (const auto& a : axes)
        a->stream.before_sync(t);
}
void Drive::after_sync() noexcept {
    for (const auto& a : axes)
        a->feedback.after_sync();
}

Want Drive::wants(Instant now) const noexcept {
    const Presence& presence = node.presence;
    if (exchanges.active() || presence.is(Phase::down)) return Want::nothing;
    // A stop of any axis comes before all other requests of the node.
    Want most = Want::nothing;
    for (const auto& a : axes)
        if (const Want w = a->wants(now); w != Want::nothing && (most == Want::nothing || w < most)) most = w;
    if (most == Want::urgent) return most;
    if (node.stopped) return most == Want::command ? most : Want::nothing;
    if (!presence.online() || presence.is(Phase::restarting)) return presence.probe_due(now) ? Want::probe : Want::nothing;
    if (presence.is(Phase::starting)) return start.waits(now) ? Want::nothing : Want::command;
    return most == Want::nothing && now >= check_at_ ? Want::poll : most;
}
/// Only requests that wants() considers may cause a wake-up.
Instant Drive::wish() const noexcept {
    Instant first = never;
    for (const auto& a : axes)
        first = std::min(first, a->wish());
    const Presence& presence = node.presence;
    if (!presence.online() || presence.is(Phase::restarting)) return std::min(first, presence.deadline());
    return std::min(first, presence.is(Phase::starting) ? start.wish() : node.stopped ? never : check_at_);
}

void Drive::go(Turn& t) {
    const Want want = wants(t.now);
    if (want == Want::probe) return start.probe(t);
    if (want != Want::urgent && node.presence.is(Phase::starting)) return start.next(t);
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const std::size_t at = (turn_ + i) % axes.size();
        if (axes[at]->wants(t.now) != want) continue;
        turn_ = at + 1;
        auto ask = axes[at]->next(t);
        if (!ask) return;
        ask->axis = at;
        if (node.stopped && ask->why == Ask::Why::stop) nmt.start(Priority::urgent, ask->ticket, t);
        if (ask->step.kind != Step::Kind::nmt) return exchanges.send(std::move(*ask), t);
        t.out.send(canopen::nmt_frame(ask->step.nmt, node.number), Priority::command, ask->ticket);  // NMT has no answer
        return heed(axes[at]->answered(*ask, {}, t), t);
    }
    if (t.now >= check_at_) exchanges.send({Ask::Why::check, {Step::Kind::read, object::error_register, {}}, no_ticket, 0, axes.size()}, t);
}

void Drive::on_frame(const Frame& f, Turn& t) {
    if (node.presence.is(Phase::down)) return;
    if (const auto e = canopen::emergency_of(f, node.number)) return on_emergency(*e, t);
    if (f.id == static_cast<std::uint32_t>(canopen::error_control_base + node.number)) return on_heartbeat(f, t);
    if (on_pdo(f, t)) return;
    if (f.id != static_cast<std::uint32_t>(canopen::sdo_answer_base + node.number)) return;
    const auto end = exchanges.on_frame(f, t);
    if (!end) return;
    if (node.stopped) nmt.back(t);
    if (double_answer_.answered()) tell_two_nodes("each question is answered twice", t);
    ended(*end, t);
}

void Drive::tell_two_nodes(std::string_view sign, Turn& t) {
    if (std::exchange(two_nodes_reported_, true)) return;
    notice(Severity::warning, "two_nodes", 0,
           fmt::format("{}: {}: two nodes have the number {}. Give one of them another number: both follow what is ordered "
                       "of the one",
                       node.setup.name, sign, node.number),
           t);
}

void Drive::ended(const canopen::SdoEnd& end, Turn& t) {
    const Ask ask = exchanges.ask();
    switch (ask.why) {
        case Ask::Why::probe:
            return start.probed(end, t);
        case Ask::Why::start:
            return start.answered(end, t);
        case Ask::Why::flush:
            return exchanges.nothing_late();
        default:
            break;
    }
    if (ask.axis >= axes.size()) {
        check_at_ = t.now + std::max<Duration>(4 * node.line.cycle(), std::chrono::milliseconds(100));
        return;
    }
    heed(axes[ask.axis]->answered(ask, end, t), t);
}

void Drive::heed(Axis::News news, Turn& t) {
    if (news == Axis::News::deaf) start.begin();
    if (news != Axis::News::node_resets) return;
    node.presence.lose(t.now, std::chrono::seconds(1));  // its boot-up message brings it back at once
    forget(Reason::interrupted, "the drive restarts", t);
}

void Drive::on_deadline(Turn& t) {
    if (heartbeat_.on_deadline(t.now) == canopen::NodeNews::lost && node.presence.online()) {
        notice(Severity::warning, "heartbeat", 0, fmt::format("{}: its heartbeat has stopped", node.setup.name), t);
        check_at_ = t.now;
        node.stopped = false;
        look_soon(t.now);
    }
    const auto late = exchanges.on_deadline(t);
    if (late != Exchanges::Late::no) unanswered(late == Exchanges::Late::cut, t);
}

void Drive::look_soon(Instant now) noexcept {
    for (const auto& a : axes)
        a->feedback.look_soon(now);
}
/// `cut`: a stop has ended the exchange early, so that it says nothing about the node.
void Drive::unanswered(bool cut, Turn& t) {
    Presence& presence = node.presence;
    const Ask& ask = exchanges.ask();
    if (cut && ask.why == Ask::Why::start) return;  // the start repeats this request
    if (ask.axis < axes.size()) axes[ask.axis]->unanswered(ask, t);
    node.tickets.failed(ask.ticket, Reason::no_answer,
                        canopen::to_text(ask.step.address) + " was not answered: whether the drive took it is not known", t.out);
    if (cut && ask.why != Ask::Why::probe) return;
    if (presence.online()) {
        look_soon(t.now);
        if (axes.empty()) check_at_ = t.now;
        nmt.silent(t);
    }
    if (presence.is(Phase::starting)) start.forget();
    if (presence.silent(t.now) != Presence::Silence::counted) forget(Reason::no_answer, "the drive does not answer", t);
}

}  // namespace axisgate::cia402_drive
