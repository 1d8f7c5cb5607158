// Stops: which lines stop this drive now, how often each is said, and by what is read whether it was heard.
// In: the drive's mode, acknowledgements, polls, error codes. Out: lines, results.
// Never ends a stop by what the drive said before it.
#include "adapters/mcode/stop.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <utility>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {

void Stops::add(const Command& c, Turn& t) {
    // A drive that is being looked for or set up again may be moving: its stop waits for that, which ends in `ready` or `absent`.
    Stop fresh;
    fresh.command = c;
    Stop* s = lane_.add(std::move(fresh));
    if (!s) {
        drive_.tickets.refused(c.ticket, Reason::busy, "too many stops wait", t.out);
        return;
    }
    const bool off = std::holds_alternative<Disable>(c.body);
    drive_.jobs.cancel_motions(name_of(c.body), off, t);
    // Within PG every line would become part of the program: the mode is left before this stop.
    drive_.programs.interrupt(name_of(c.body), t);
    if (off) {
        s->lines = {"DE=0"};
    } else if (feedback().torque()) {
        s->lines = out_of_torque();
    } else if (std::holds_alternative<QuickStop>(c.body) && feedback().running()) {
        // A program would start the next motion: it is ended, and what it started meanwhile is stopped.
        s->lines = {"SL 0", "E", "SL 0"};
    } else {
        s->lines = {"SL 0"};
    }
}

const CommandBody* Stops::locking() const noexcept {
    const CommandBody* which = nullptr;
    lane_.each([&](const Stop& s) {
        if (!std::holds_alternative<Halt>(s.command.body)) which = &s.command.body;
    });
    return which;
}

/// What stops without a ramp: the escape character if it can be meant for one drive alone, else the bridges.
std::string_view Stops::at_once() const noexcept {
    return drive_.link().party() && drive_.words.es != 3 ? std::string_view("DE=0") : escape_key;
}

/// AS = 3 presses until AS is another mode, and AS changes at rest only [L7495, E-26].
std::vector<std::string> Stops::out_of_torque() const { return {std::string(at_once()), "AS=0"}; }

Request Stops::next(Instant now) {
    if (confirming()) return drive_.confirming_question(now);
    const Stop& s = *lane_.first();
    Request r = Request::say(Request::Purpose::stop, s.lines[s.at]);
    if (r.text == escape_key) {
        r.raw = escape(drive_.link());
        r.kind = Expect::Kind::nothing;
    }
    return r;
}

Request Stops::to_absent() {
    const Stop& s = *lane_.first();
    const LinkWords& w = drive_.words;
    Request r = Request::say(Request::Purpose::stop, s.lines.front());
    for (const auto& line : s.lines) {
        for (const bool sums : {w.known_sums, !w.known_sums}) {
            if (sums && drive_.bus.ethernet) continue;
            r.raw += line == escape_key ? escape(drive_.link()) : request({drive_.link().name, sums}, line);
        }
    }
    r.kind = Expect::Kind::nothing;
    r.wake = true;
    return r;
}

void Stops::ended(Verdict v, Turn& t) {
    if (empty()) return;
    Stop& s = *lane_.first();
    if (drive_.away()) {
        return over(Outcome::failed, Reason::no_answer,
                    fmt::format("{} does not answer to {}; {} was sent all the same, whether it was heard is not known", name(),
                                drive_.address(), s.lines.back()),
                    t);
    }
    drive_.line_ended(s.lines[s.at], v, true);
    s.acknowledgement = v == Verdict::answered ? Verdict::acknowledged : v;
    s.confirming = true;
    s.to_all = false;
    s.unproven = v != Verdict::acknowledged;
    s.quiet = v == Verdict::answered;
    s.at_once = drive_.turnaround.at_once();
    s.said = t.now;
    s.speed.reset();
    if (v == Verdict::waiting) drive_.start.silent(t);
}

void Stops::say_again() noexcept {
    lane_.each([](Stop& s) { s.confirming = s.to_all = false; });
}

void Stops::fail_all(Reason reason, std::string_view why, Turn& t) {
    lane_.each([&](const Stop& s) { drive_.tickets.failed(s.command.ticket, reason, std::string(why), t.out); });
    lane_.clear();
}

// --- a line to every drive at once -----------------------------------------------------------------------------------------------

std::string_view Stops::line() const noexcept {
    if (!drive_.ready() || drive_.mode.leaving() || empty()) return {};
    const Stop& s = *lane_.first();
    return s.at == 0 && s.lines[0] != escape_key ? std::string_view(s.lines[0]) : std::string_view();
}

/// Its stop's line has gone to all drives, who say nothing: reading tells what became of it.
void Stops::taken_by_all(Instant received) {
    if (empty() || confirming()) return;
    Stop& s = *lane_.first();
    feedback().demand.published(s.lines[s.at], received, true);  // who proves not to have heard it loses its demand
    s.confirming = s.to_all = true;
    s.unproven = s.quiet = false;
    s.acknowledgement = Verdict::acknowledged;
    s.speed.reset();
}

/// By what was just read: off, out of torque mode, no program, at rest, or slower than a reading ago while its speed changes. Nothing: read
/// again. false: it is said again, to this drive alone.
std::optional<bool> Stops::reached(Stop& s, Instant now) const {
    using namespace std::chrono_literals;
    const auto& flags = feedback().flags();
    const std::string& line = s.lines[s.at];
    if (line == "DE=0") return !flags.de;
    if (line == "AS=0") return !feedback().torque();
    if (line == "E") {
        // A program that was told to end waits until its motion has ended.
        if (!flags.by) return true;
        return flags.mv && now - s.said < 10s ? std::nullopt : std::optional(false);
    }
    const std::int64_t speed = std::llabs(feedback().velocity());
    if (speed == 0 && !flags.vc) return true;
    if (const auto before = std::exchange(s.speed, speed)) return flags.vc && speed < *before;
    return flags.vc ? std::nullopt : std::optional(false);
}

// --- what confirms it ------------------------------------------------------------------------------------------------------------

void Stops::over(Outcome o, Reason r, std::string text, Turn& t, std::int32_t code) {
    Stop* s = lane_.first();
    const Ticket ticket = s->command.ticket;
    lane_.remove(s);
    drive_.tickets.answer(ticket, o, r, std::move(text), t.out, code);
}

void Stops::unconfirmed(std::string why, Turn& t) { over(Outcome::failed, Reason::no_answer, std::move(why), t); }

void Stops::missed(Turn& t) {
    if (++lane_.first()->tries > said_again_limit) unconfirmed(fmt::format("{} did not confirm the stop", name()), t);
}

/// SL 0 is not what stops this drive now: what does comes instead.
bool Stops::changed_way(Stop& s) const {
    if (s.lines[s.at] != "SL 0") return false;
    if (drive_.errors.last() == 85) {
        // During a homing only the escape character stops [L4106].
        s.lines[s.at] = at_once();
        s.confirming = false;
        return true;
    }
    if (!feedback().torque()) return false;
    // It went into torque mode since it was last asked: a program did that, or a native line.
    s.lines = out_of_torque();
    s.at = 0;
    s.confirming = s.to_all = false;
    return true;
}

/// What nobody has acknowledged is judged by what was read. False: it is read again, said again, or given up.
bool Stops::proven(Stop& s, Turn& t) {
    const auto received = reached(s, t.now);
    if (!received) return false;
    const bool to_all = std::exchange(s.to_all, false), quiet = std::exchange(s.quiet, false);
    s.unproven = false;
    if (*received) {
        if (quiet) drive_.turnaround.received(s.at_once);
        return true;
    }
    feedback().demand.forget();
    if (quiet) (void)drive_.turnaround.lost(s.at_once);
    if (!to_all && ++s.tries > said_again_limit) {
        over(Outcome::failed, Reason::no_answer, fmt::format("{} did not take {}", name(), s.lines[s.at]), t);
        return false;
    }
    ++drive_.bus.counters.retries;
    s.confirming = false;
    return false;
}

void Stops::confirmed(Turn& t) {
    Stop& s = *lane_.first();
    const std::string line = s.lines[s.at];
    const int error = drive_.errors.last();
    AxisDemand& demand = feedback().demand;
    if (changed_way(s)) return;
    if (error == 0 && (s.to_all || s.unproven)) {
        if (proven(s, t)) line_taken(s, t);
        return;
    }
    if (error != 0) demand.withdraw();
    const bool off = line == "DE=0" && !feedback().flags().de;
    const bool harmless = error == 40 || error == 94;  // no program ran; nothing can move with the drive off
    const bool taken = s.acknowledgement == Verdict::acknowledged && error == 0 && (line != "DE=0" || off);
    if (taken || off || harmless) return line_taken(s, t);
    if (error != 0 && s.tries >= drive_.bus.timing.retries) {
        return over(Outcome::refused, Reason::drive_refused, fmt::format("{}: {} was refused with error {}", name(), line, error), t,
                    error);
    }
    if (++s.tries > drive_.bus.timing.retries)
        return over(Outcome::failed, Reason::no_answer, fmt::format("{} did not take {}", name(), line), t);
    ++drive_.bus.counters.retries;
    s.confirming = false;
    // Refused while it still presses: the escape character before it was not received.
    if (error != 0 && line == "AS=0") s.at = 0;
}

void Stops::line_taken(Stop& s, Turn& t) {
    if (s.lines.back() != "AS=0") s.tries = 0;  // its two lines are said again together
    s.confirming = false;
    const bool out_of_torque = s.lines[s.at] == "AS=0";
    if (++s.at < s.lines.size()) return;
    if (out_of_torque) {
        feedback().values_unknown();  // the drive may have scaled them
        note(Severity::warning, "torque", 0,
             fmt::format("{}: the stop has ended its torque mode: AS is 0 now, and 3 starts it again", name()), t);
    }
    feedback().stopped(s.lines[0] == "DE=0", t);
    over(std::holds_alternative<Disable>(s.command.body) ? Outcome::done : Outcome::accepted, Reason::none, {}, t);
}

}  // namespace axisgate::mcode
