// One MCode drive: what it would send now, and which part hears how that ended.
// In: the line's calls. Out: requests, results, feedback, links, notices by its parts.
// Never chooses a poll or a command while a stop waits, nor a stop while the drive may be in program mode.
#include "adapters/mcode/drive.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "gateway/core/text.hpp"

namespace axisgate::mcode {
using namespace std::chrono_literals;
using What = Request::Purpose;

const std::string& Part::name() const noexcept { return drive_.name(); }
Feedback& Part::feedback() const noexcept { return drive_.feedback; }
void Part::note(Severity severity, std::string_view kind, std::int32_t code, std::string text, Turn& t) const {
    drive_.notice(severity, kind, code, std::move(text), t);
}

// --- words -----------------------------------------------------------------------------------------------------------------------

std::optional<std::int64_t> whole(std::string_view s) {
    s.remove_prefix(std::min(s.find_first_not_of(' '), s.size()));
    const auto v = parse_number(s);
    return v && std::fabs(*v) < 9e15 ? std::optional<std::int64_t>(std::llround(*v)) : std::nullopt;
}

std::vector<std::string_view> split(std::string_view s) {
    std::vector<std::string_view> parts;
    for (;;) {
        const auto at = s.find(',');
        parts.push_back(s.substr(0, at));
        if (at == std::string_view::npos) return parts;
        s.remove_prefix(at + 1);
    }
}

Request Request::ask(Purpose purpose, std::string items) {
    Request r;
    r.purpose = purpose;
    r.text = std::move(items);
    return r;
}

Request Request::say(Purpose purpose, std::string line) {
    Request r = ask(purpose, std::move(line));
    r.kind = Expect::Kind::command;
    r.urgent = purpose == What::stop;
    const auto w = word_of(r.text);
    if (w == "S" || w == "FD" || w == "CP" || w == "IP") r.patience = 2s;
    return r;
}

// --- presence --------------------------------------------------------------------------------------------------------------------

void Drive::fail_all(Reason reason, const std::string& why, Turn& t) {
    program.lost(reason, why, t);
    stops.fail_all(reason, why, t);
    jobs.fail_all(reason, why, t);
}

void Drive::remove(std::string_view why, Turn& t) {
    restart.over(Outcome::failed, Reason::line_down, why, t);
    fail_all(Reason::line_down, std::string(why), t);
}

void Drive::line_down(std::string_view why, Turn& t) {
    remove(why, t);
    programs.drive_away();
    mode.away(true);
    unanswered_ = 0;
    presence.close();
    presence.report(std::string(why), t.out);
    feedback.line_lost();
}

/// A stop that was not confirmed is said once more to a drive that may only not be heard.
void Drive::lost(const std::string& why, Turn& t) {
    poll.stop();
    errors.stop_asking();
    feedback.lost();
    stops.say_again();
    program.lost(Reason::no_answer, why, t);
    jobs.fail_all(Reason::no_answer, why, t);
    programs.drive_away();
    mode.away(false);
    unanswered_ = 0;
}

void Drive::came(std::string identity, Turn& t) {
    program.lost(Reason::interrupted, "the drive was found anew: it may have restarted", t);
    errors.clear_fault();
    feedback.found();
    presence.report(std::move(identity), t.out);
    poll.soon(t.now);
    survey.plan_listing(t.now);
    const std::string rate = line_setup.named() ? std::string() : start.rate_trouble();  // line.setup sets BD too
    if (!rate.empty()) notice(Severity::warning, "bit_rate", 0, rate, t);
    restart.came(rate, t);
    line_setup.came(t);
}

// --- what it wants ---------------------------------------------------------------------------------------------------------------

void Drive::submit(const Command& c, Turn& t) {
    if (drive::refused_behind(stops.locking(), c, jobs.queue, t)) return;
    const auto* action = std::get_if<Action>(&c.body);
    if (action && action->name == "line.setup" && !ready() && !presence.is(drive::Presence::Phase::down) && jobs.idle()) {
        // It makes the drive ready: it does not wait for that.
        if (tickets.open(c, t.out)) jobs.take(c, t);
        return;
    }
    if (drive::admit(c, name(), presence, jobs.queue, tickets, t) == drive::Admission::urgent) stops.add(c, t);
}

drive::Want Drive::wants(Instant now) const noexcept {
    using drive::Want;
    const auto if_so = [](bool yes) { return yes ? Want::poll : Want::nothing; };
    switch (presence.phase()) {
        case drive::Presence::Phase::down:
            return Want::nothing;
        case drive::Presence::Phase::probing:
        case drive::Presence::Phase::absent:
            if ((away() && !stops.empty()) || line_setup.naming()) return Want::command;
            return if_so(presence.probe_due(now) || start.says_line());
        case drive::Presence::Phase::starting:
        case drive::Presence::Phase::restarting:
            return Want::poll;
        case drive::Presence::Phase::ready:
            break;
    }
    if (mode.leaving()) return Want::urgent;
    if (!stops.empty()) return stops.confirming() ? Want::command : Want::urgent;
    if (programs.wants_clean_up() && feedback.at_rest()) return Want::poll;
    if (errors.wanted() || poll.due(now)) return Want::poll;
    if (!jobs.idle()) return if_so(!jobs.job().waits_for_rest());
    return if_so(!jobs.queue.empty() || (feedback.seen() && survey.wants(now)));
}

bool Drive::wants_unmarked(Instant now) const noexcept {
    if (!ready()) return start.says_line();
    if (!stops.empty() || mode.leaving() || errors.wanted() || !feedback.seen()) return false;
    if (jobs.idle()) {
        return !jobs.queue.empty() || feedback.wants_zero() || survey.wants_listing(now) ||
               (programs.wants_clean_up() && feedback.at_rest());
    }
    const Job& job = jobs.job();
    if (job.confirming || !job.pending()) return false;
    const auto what = job.steps[job.at].what;
    return what == Step::What::send || what == Step::What::bare || what == Step::What::block;
}

Request Drive::next(Turn& t) {
    Request r = choose(t);
    purpose_ = r.purpose;
    if (!stops.empty()) {
        r.order = stops.order();
    } else if (purpose_ == What::step || purpose_ == What::confirm || purpose_ == What::error) {
        r.order = jobs.job().command.ticket;
    }
    return r;
}

Request Drive::choose(Turn& t) {
    if (line_setup.naming()) return jobs.next(t.now);
    if (!ready()) return away() && !stops.empty() ? stops.to_absent() : start.next();
    if (mode.leaving()) return mode.next();
    if (!stops.empty()) return stops.next(t.now);
    if (errors.wanted()) return Request::ask(What::error, "ER");
    // The first poll goes before the first command: an error that stands from before must not count as its own.
    if (feedback.seen()) jobs.take_next(t);
    if (feedback.seen() && jobs.job().pending() && !jobs.job().waits_for_rest()) return jobs.next(t.now);
    poll.soon(t.now + pace.period(bus.timing.poll_period));
    return Request::ask(What::poll, feedback.poll_items(t.now));
}

Request Drive::confirming_question(Instant now) {
    return errors.wanted() ? Request::ask(What::error, "ER") : Request::ask(What::confirm, feedback.poll_items(now));
}

// --- how it ended ----------------------------------------------------------------------------------------------------------------

void Drive::ended(Verdict v, const ReplyReader& r, Turn& t) {
    if (v == Verdict::garbled) ++bus.counters.garbled;
    if (v == Verdict::refused) ++bus.counters.refused;
    if (v == Verdict::answered || v == Verdict::acknowledged) ++bus.counters.exchanges;
    if (ready()) watch_quality(v, r, t);
    start.received(v, r);
    restart.watch(t);
    const bool mode_line = mode.line_ended(v);
    if (!ready() && (line_setup.too_late(t.now) || restart.too_late(t.now)))
        return start.lose(start.not_understood() + start.factory_hint(), t);
    const bool is_poll = purpose_ == What::poll || purpose_ == What::confirm;
    if ((is_poll || purpose_ == What::error) && mode.immediate() && v != Verdict::answered && r.taken_without_answer()) mode.suspect();
    if (is_poll && v != Verdict::answered) feedback.poll_missed(t.now);
    switch (purpose_) {
        case What::leave:
            return mode.ended(v, r, t);
        case What::probe:
        case What::link:
        case What::startup:
            return start.ended(v, r, mode_line, t);
        case What::stop:
            return stops.ended(v, t);
        case What::error:
            return errors.answered(v, r.data(), t);
        case What::confirm:
            return confirm_ended(v, r, t);
        case What::step:
            return jobs.ended(v, r, t);
        case What::poll:
            return poll_ended(v, r, t);
    }
}

void Drive::confirm_ended(Verdict v, const ReplyReader& r, Turn& t) {
    if (v == Verdict::answered && feedback.learn_poll(r.data(), t)) {
        if (!feedback.flags().ef) {
            errors.clear_last();
            return confirmed(t);
        }
        const Verdict reported = stops.confirming() ? stops.acknowledgement() : jobs.job().acknowledgement;
        return errors.ask(reported == Verdict::refused || !words.sums || quiet() || stops.sent_to_all());  // an ACK means: no error [L2081]
    }
    if (v == Verdict::waiting) start.silent(t);
    if (ready()) stops.confirming() ? stops.missed(t) : jobs.missed(t);
}

void Drive::poll_ended(Verdict v, const ReplyReader& r, Turn& t) {
    if (v != Verdict::refused) poll_refusals_ = 0;
    if (v == Verdict::answered && feedback.learn_poll(r.data(), t)) {
        if (feedback.flags().ef && !bus.only_reads) errors.ask(false);
    } else if (v == Verdict::refused) {
        // One may be noise. Two: its link has changed. With LL the next without it tells.
        poll.soon(t.now);
        if (feedback.asks_lag() || ++poll_refusals_ < 2) return;
        poll_refusals_ = 0;
        start.link_changed(t);
    } else if (v == Verdict::waiting) {
        start.silent(t);
    }
}

void Drive::line_ended(std::string_view line, Verdict v, bool own) {
    AxisDemand& demand = feedback.demand;
    if (v == Verdict::refused) return demand.refused();
    program.line_taken(line);
    const auto w = word_of(line);
    // By somebody's text, or nobody knows whether it was taken: what the next move would find is read anew.
    constexpr std::array<std::string_view, 11> values{"VI", "VM", "A", "D", "EE", "AS", "MS", "IP", "FD", "IC", "DC"};
    if (v == Verdict::waiting || v == Verdict::garbled) {
        if (std::ranges::find(values, w) != values.end()) feedback.relearn = true;
        return demand.doubt(line);
    }
    demand.published(line, feedback.received_at, own);
    if (w == "EX") feedback.program_ran();
    if (!own && std::ranges::find(values, w) != values.end()) feedback.relearn = true;
}

void Drive::confirmed(Turn& t) {
    if (stops.confirming()) return stops.confirmed(t);
    if (jobs.job().confirming) jobs.confirmed(t);
}

void Drive::unconfirmed(std::string why, Turn& t) {
    stops.confirming() ? stops.unconfirmed(std::move(why), t) : jobs.fail(Reason::no_answer, std::move(why), t);
}

// --- what is told ----------------------------------------------------------------------------------------------------------------

void Drive::watch_quality(Verdict v, const ReplyReader& r, Turn& t) {
    const bool received = v != Verdict::waiting;
    const bool begun = r.raw().find('#') != std::string::npos && r.raw().find("PR \"#") == std::string::npos;
    if (v == Verdict::garbled || (!received && begun)) trouble(received ? Trouble::Kind::garbled : Trouble::Kind::cut, t);
    if (!received && !begun) ++unanswered_;
    // Without an answer it may be going away, which is told otherwise: they count when it is heard again.
    for (; received && unanswered_ > 0; --unanswered_)
        trouble(Trouble::Kind::lost, t);
}

void Drive::trouble(Trouble::Kind kind, Turn& t) {
    const bool doubled = kind == Trouble::Kind::twice;
    const std::string counts = (doubled ? twice_ : trouble_).add(kind, t.now);
    if (counts.empty()) return;
    notice(
        Severity::warning, "protocol", 0,
        doubled
            ? fmt::format("{} answered the same question twice ({}): two drives may have the same name {}", name(), counts, address())
            : fmt::format("{}: answers of the drive at {} are spoiled again and again ({}): look at its cable, its rate and its reply time",
                          name(), address(), counts),
        t);
}

void Drive::foreign(std::string_view text, Turn& t) {
    ++bus.counters.unexpected;
    std::string shown;
    std::ranges::copy_if(text, std::back_inserter(shown), [](char c) { return c >= 0x20 && c <= 0x7E; });
    if (shown.size() < 2 || shown.find("PR \"#") != std::string::npos || shown.size() > 200) return;
    notice(Severity::info, "output", 0, fmt::format("{}: {}", name(), shown), t);
}

}  // namespace axisgate::mcode
