// Drive: what is sent next, and what happens to all parts at once.
// In: the adapter's calls. Out: frames and results by its parts.
// Never lets a command pass a stop, nor a poll wait behind commands for more than a period.
#include "adapters/uim342/drive.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/drive/option_reader.hpp"

namespace axisgate::uim342 {
using drive::Want;
using Phase = drive::Presence::Phase;

DriveOptions drive_options(const DriveSetup& setup) {
    drive::OptionReader read(setup.options);
    DriveOptions o;
    o.notify = read.flag("notify", false);
    o.absolute_known = read.word("referenced", {"session", "absolute"}) == "absolute";
    o.home_high = read.word("home_active", {"high", "low"}) == "high";
    o.home_input = static_cast<std::uint8_t>(read.whole("home_input", 1, 3, 0));
    o.home_velocity = static_cast<std::uint32_t>(read.whole("home_velocity", 1, 8'388'607, 0));
    o.home_timeout = std::chrono::seconds(read.whole("home_timeout_s", 1, 3600, 60));
    o.faults = read.take_faults();
    return o;
}

Drive::Drive(Bus& of_line, const DriveSetup& setup, std::uint8_t address, std::size_t slot)
    : DriveBase(setup, of_line.timing, slot), bus(of_line), options(drive_options(setup)), address_(address) {}

// --- the line ----------------------------------------------------------------------------------------------------------------

void Drive::line_up(Turn& t) {
    tell_setup(options.faults, t);
    start.begin(t);
}

void Drive::line_down(std::string_view why, Turn& t) {
    const bool was_online = presence.online();
    remove(why, t);
    exchanges.forget_late();  // nothing of before comes through a line that was down
    polls.stop();
    if (was_online) presence.report(std::string(why), t.out);
}

void Drive::remove(std::string_view why, Turn& t) {
    fail_all(Reason::line_down, std::string(why), t);
    presence.close();
}

void Drive::fail_all(Reason reason, const std::string& text, Turn& t) {
    exchanges.drop();
    stops.fail_all(reason, text, t);
    break_off(reason, text, t);
    start.not_back(reason, text, t);
    jobs.fail_all(reason, text, t);
}

void Drive::break_off(Reason reason, const std::string& text, Turn& t) {
    if (homing.searching()) homing.over(false, reason, text, t);
    together.give_up({false, reason, 0, text}, t);
    together.unprepare();
}

void Drive::submit(const Command& command, Turn& t) {
    if (drive::refused_behind(stops.locking(), command, jobs.queue, t)) return;
    const std::string who = fmt::format("{} (ID {})", name(), address_);
    if (drive::admit(command, who, presence, jobs.queue, tickets, t) == drive::Admission::urgent) stops.add(command, t);
}

// --- what is sent next -----------------------------------------------------------------------------------------------------------

Want Drive::wants(Instant now) const noexcept {
    if (exchanges.active() || presence.is(Phase::down)) return Want::nothing;
    if (presence.is(Phase::starting)) return Want::poll;
    if (!presence.is(Phase::ready)) return presence.probe_due(now) ? Want::probe : Want::nothing;
    if (stops.to_repeat()) return Want::command;
    const bool job_runs = jobs.job().runs();
    if (start.reading().core_pending() && !job_runs) return Want::poll;
    // Commands wait while a stop is on its way: nothing may get between JV=0 and its BG, or start what is being stopped.
    const bool command = job_runs || jobs.ready() || homing.put_back_due() || (homing.check_due() && jobs.idle());
    if (stops.empty() && command) return Want::command;
    return polls.wants(now) ? Want::poll : Want::nothing;
}

Instant Drive::deadline() const noexcept { return std::min({stops.deadline(), homing.deadline(), exchanges.deadline()}); }

Instant Drive::wish() const noexcept { return presence.is(Phase::ready) ? polls.deadline() : presence.deadline(); }

void Drive::go(Turn& t) {
    if (exchanges.active() || presence.is(Phase::down)) return;
    if (presence.is(Phase::starting)) return start.read_next(t);
    if (!presence.is(Phase::ready)) return start.probe(t);
    if (stops.to_repeat()) return stops.repeat(t);
    const bool may_command = stops.empty();
    if (may_command && jobs.job().runs()) return jobs.run(t);
    if (start.reading().core_pending()) return start.read_next(t);
    // Commands go before polls, but a poll that is a whole period late goes between two commands: the picture stays alive. One poll; on a
    // line that cannot carry all of them every poll is late, and commands would never have their turn.
    if (may_command && jobs.idle() && !polls.overdue(t.now)) {
        if (homing.put_back_due()) return homing.put_back(t);
        if (homing.check_due()) return homing.check(t);
        while (!exchanges.active() && jobs.ready()) {
            polls.command_began();
            jobs.take_next(t);
        }
        if (exchanges.active() || !jobs.idle()) return;
    }
    polls.go(t);
}

// --- what comes ------------------------------------------------------------------------------------------------------------------

void Drive::on_message(const Message& m, Turn& t) {
    if (presence.is(Phase::down)) return;
    if (m.cw & ack_bit) {
        ++bus.counters.garbled;  // nothing that a device sends has bit 7 set
    } else if (presence.is(Phase::restarting)) {
        ++bus.counters.unexpected;  // said before it fell silent
    } else {
        m.cw == cw::RT ? feedback.on_notification(m, t) : exchanges.on_message(m, t);
    }
}

void Drive::on_deadline(Turn& t) {
    exchanges.on_deadline(t);
    stops.on_deadline(t);
    homing.on_deadline(t);
}

void Drive::publish(const Message& answer, std::uint8_t mf, Turn& t) const {
    bus.points.each(answer, mf, [&](const Binding& b, Value v) {
        t.out.samples.push_back({axis(), b.point, std::move(v), Quality::good, t.now});
    });
}

}  // namespace axisgate::uim342
