// The order of transmission: stops, the stream, the values at the start, commands, polls. After a time-out nothing is sent for as long as
// the answer may still arrive.
#include "adapters/linmot/drive.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/drive/option_reader.hpp"

namespace axisgate::linmot {
using drive::Want;
using Phase = drive::Presence::Phase;

DriveOptions drive_options(const DriveSetup& setup, const Bus& bus) {
    drive::OptionReader read(setup.options);
    DriveOptions o;
    o.warn_inferred = read.word("warn_word", {"off", "inferred"}) == "inferred";
    o.inferred = read.flag("inferred", true);
    o.keeps_limits = read.flag("drive_limits", true, "on", "off");
    o.stop_by_off3 = read.word("quick_stop", {"abort", "off3"}) == "off3";
    const auto set_points = read.word("set_points", {"moves", "auto", "stream"});
    o.streams = set_points != "moves";
    if (set_points == "stream" && stream_period(bus) <= Duration{})
        read.fault(
            "set_points: a stream needs a set-point every 2 to 5 ms, which this line cannot hold (a bit rate of 115200 or more, and "
            "no other drive): set-points are sent as moves");
    o.faults = read.take_faults();
    return o;
}

Drive::Drive(Bus& of_line, const DriveSetup& setup, std::uint8_t id, std::size_t slot)
    : DriveBase(setup, of_line.timing, slot), bus(of_line), options(drive_options(setup, of_line)), id_(id) {}

std::string Drive::title() const { return fmt::format("{} (ID {})", setup_.name, id_); }

// --- the line ----------------------------------------------------------------------------------------------------------------

void Drive::line_up(Turn& t) {
    presence.begin(t.now);
    exchanges.nothing_late();
    feedback.unknown();
    control.forget();
}

void Drive::line_down(std::string_view why, Turn& t) {
    remove(why, t);
    presence.report(std::string(why), t.out);
}

void Drive::remove(std::string_view why, Turn& t) {
    presence.close();
    exchanges.drop();
    lost(t, {});
    tickets.fail_all(Reason::line_down, why, t.out);
}

void Drive::lost(Turn& t, std::string why) {
    if (jobs.is(motion)) motion.given_up(jobs.job().count);
    jobs.forget();
    stops.forget();
    stream.forget();
    poll.stop();
    homing.forget();
    motion.forget();
    feedback.forget();
    control.forget();
    demand.forget();
    if (why.empty()) return;
    tickets.fail_all(Reason::no_answer, why, t.out);
    presence.report(std::move(why), t.out);
}

void Drive::look(const DriveSetup& setup) {
    if (pace.take(setup)) poll.hurry();
    const auto other = [](const AxisSetup& a, const AxisSetup& b) {
        return a.position_min != b.position_min || a.position_max != b.position_max;
    };
    const bool others = !std::ranges::equal(setup_.axes, setup.axes, [&](const auto& a, const auto& b) { return !other(a, b); });
    setup_.axes = setup.axes;
    if (others && ready()) start.set_limits();
}

void Drive::follow(const SetPoint& p) {
    if (p.axis == axis() && presence.online() && !stream.take(p)) jobs.set_points.put(p);
}

void Drive::submit(const Command& command, Turn& t) {
    if (is_urgent(command.body) || drive::is_motion(command.body)) {
        jobs.set_points.clear();
        stream.interrupt();
    } else if (stream.on() && !stream.ending()) {
        return drive::Tickets::refuse(
            command, Reason::busy,
            fmt::format("drive {} follows a stream that leaves no time for other exchanges: end the stream first", title()), t.out);
    }
    if (drive::admit(command, title(), presence, jobs.queue, tickets, t) == drive::Admission::urgent) stops.add(command, t);
}

// --- transmission ------------------------------------------------------------------------------------------------------------

Want Drive::wants(Instant now) const noexcept {
    if (presence.is(Phase::down) || !exchanges.ready(now)) return Want::nothing;
    if (!stops.empty()) return now >= stops.wish() ? Want::urgent : Want::nothing;
    if (!served()) return presence.probe_due(now) ? Want::probe : Want::nothing;
    if (stream.on()) return stream.ending() || now >= stream.next() ? Want::command : Want::nothing;
    if (start.reads() || homing.to_release() || jobs.wants(now) || (jobs.idle() && stream.waits())) return Want::command;
    if (poll.due(now)) return feedback.fb().moving && !pace.close() ? Want::quick_poll : Want::poll;
    return Want::nothing;
}

Instant Drive::wish() const noexcept {
    if (presence.is(Phase::down)) return never;
    Instant at = presence.deadline();
    if (served()) {
        if (stream.on())
            return std::max(!stops.empty() ? stops.wish() : !stream.ending() ? stream.next() : Instant{}, exchanges.ready_at());
        at = std::min({at, poll.deadline(), jobs.wish()});
        if (homing.to_release() || start.reads() || (jobs.idle() && stream.waits())) at = Instant{};
    }
    if (!stops.empty()) at = stops.wish();
    return std::max(at, exchanges.ready_at());
}

void Drive::go(Turn& t) {
    if (exchanges.active() || (!stops.empty() && t.now < stops.wish())) return;
    if (stream.on() && stream.ending() && stops.empty_or_halt()) return stream.send(t);
    if (auto telegram = stops.request(t)) return exchanges.send({std::move(*telegram), Purpose::stop}, t);
    if (!served()) return start.probe(t);
    if (start.reads()) return start.read_next(t);
    if (homing.to_release()) return homing.release(t);
    if (!stream.on() && stream.waits() && jobs.idle() && jobs.queue.empty()) stream.begin(t);
    if (stream.on()) return t.now >= stream.next() ? stream.send(t) : void();
    if (jobs.go(t) || !poll.due(t.now)) return;
    poll.asked(t.now, pace.period(bus.timing.poll_period));
    exchanges.send({start.status_request(), Purpose::poll}, t);
}

// --- reception ---------------------------------------------------------------------------------------------------------------

void Drive::on_telegram(const Telegram& telegram, Turn& t) {
    const Request r = exchanges.answered();
    presence.answered();
    if (r.purpose == Purpose::probe) return start.probed(r, telegram, t);
    if (r.purpose == Purpose::core) return start.read(telegram, t);
    start.tell_limits(t);
    const bool response = telegram.sub == 0 || r.purpose == Purpose::poll;  // the sub ID of a RAM answer is not known
    if (const auto status = start.status_in(r.telegram, telegram); status && response) feedback.learn(*status, t);
    if (r.purpose == Purpose::stop) stops.answered(t);
    if (r.purpose == Purpose::job) jobs.answered(telegram, t);
    if (r.purpose == Purpose::stream) stream.answered(t);
}

void Drive::on_deadline(Turn& t) {
    if (exchanges.on_deadline(t)) silence(t);
}

void Drive::silence(Turn& t) {
    const Request& r = exchanges.request();
    if (r.quiet) return jobs.look_later(t);
    if (r.purpose == Purpose::stream && stream.received_lately(t.now)) return;
    exchanges.missed(t.now);
    if (r.purpose == Purpose::probe && start.probe_silent(r, t)) return;
    const auto what = presence.silent(t.now);
    if (what == drive::Presence::Silence::lost) return lost(t, fmt::format("drive {} does not answer", title()));
    if (what == drive::Presence::Silence::still_absent && r.purpose == Purpose::probe) return start.absent(t);
    if (r.purpose == Purpose::core) start.read_silent(t);
    if (r.purpose == Purpose::stop) stops.silent(t);
    if (r.purpose == Purpose::job) jobs.silent(t);
    if (r.purpose == Purpose::release) homing.release_lost();
}

}  // namespace axisgate::linmot
