// The laws of every family's adapter, for a drive and a line of the kit's parts alone, under random commands, silences, late answers,
// restarts and line faults, in virtual time.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>

#include "gateway/drive/command_queue.hpp"
#include "gateway/drive/exchange.hpp"
#include "gateway/drive/notices.hpp"
#include "gateway/drive/polls.hpp"
#include "gateway/drive/presence.hpp"
#include "gateway/drive/turns.hpp"

namespace axisgate::drive::test {
namespace {
using namespace std::chrono_literals;
using Phase = Presence::Phase;

struct Ask {
    enum class Why : std::uint8_t { probe, stop, command, poll } why = Why::probe;
    std::uint32_t number = 0;
    Ticket ticket = no_ticket;
};

/// A drive that answers each question by its number. Stops wait for the exchange in progress at most.
struct ToyDrive {
    ToyDrive(std::uint16_t id, const Timing& of_line, Turns& turns_of_line, std::size_t at)
        : timing(of_line), presence(DriveId{id}, of_line), turns(turns_of_line), slot(at) {}

    void submit(const Command& c, Turn& t) {
        switch (admit(c, "toy", presence, queue, tickets, t)) {
            case Admission::answered:
            case Admission::queued:
                return;
            case Admission::urgent:
                break;
        }
        (void)queue.interrupt([](const Command& w) { return is_motion(w.body); }, name_of(c.body), tickets, t);
        if (job && is_motion(job->body)) {
            tickets.failed(job->ticket, Reason::interrupted, "interrupted", t.out);
            job.reset();
        }
        if (!stops.add(c.ticket)) tickets.refused(c.ticket, Reason::busy, "too many stops", t.out);
    }
    [[nodiscard]] Want wants(Instant now) const {
        if (exchange.active() || presence.is(Phase::down)) return Want::nothing;
        if (!stops.empty()) return Want::urgent;
        if (!presence.is(Phase::ready)) return presence.probe_due(now) ? Want::probe : Want::nothing;
        if (job || !queue.empty()) return Want::command;
        return poll.due(now) ? Want::quick_poll : Want::nothing;
    }
    void settle(Instant now) { turns.settle(slot, wants(now), exchange.deadline(), std::min(presence.deadline(), poll.deadline())); }
    void go(Turn& t) {
        Ask a{Ask::Why::poll, ++count, no_ticket};
        if (!stops.empty()) {
            a.why = Ask::Why::stop;
            a.ticket = *stops.first();
        } else if (!presence.is(Phase::ready)) {
            a.why = Ask::Why::probe;
            presence.probe_sent();
        } else if (job || !queue.empty()) {
            if (!job) job = queue.pop();
            a.why = Ask::Why::command;
            a.ticket = job->ticket;
        } else {
            poll.asked(t.now, timing.poll_period);
        }
        exchange.begin(a, t.now, timing.reply_timeout, a.why == Ask::Why::probe ? 0 : timing.retries);
        turns.began(slot, a.why == Ask::Why::probe);
        sent.push_back(a);
    }
    void answered(std::uint32_t number, Turn& t, AdapterCounters& counters) {
        if (!exchange.active() || exchange.request().number != number) {
            ++counters.unexpected;
            presence.received(t.now);
            return;
        }
        const Ask a = exchange.answered(counters);
        turns.ended(slot);
        turns.received(t.now);
        presence.answered();
        if (!presence.online()) {
            presence.found();
            presence.made_ready();
            presence.report("toy", t.out);
            poll.begin(t.now, timing.poll_period, slot);
        }
        if (a.why == Ask::Why::stop) stop_over();
        if (a.why == Ask::Why::command && job && job->ticket == a.ticket) job.reset();
        tickets.accepted(a.ticket, t.out);
    }
    void on_deadline(Turn& t, AdapterCounters& counters) {
        const Late late = exchange.on_deadline(t.now, counters);
        if (late == Late::repeat) sent.push_back(exchange.request());
        if (late != Late::over) return;
        turns.ended(slot);
        const Ask a = exchange.request();
        if (a.why == Ask::Why::stop) stop_over();
        if (a.why == Ask::Why::command && job && job->ticket == a.ticket) job.reset();
        tickets.failed(a.ticket, Reason::no_answer, "not answered", t.out);
        const auto silence = presence.silent(t.now);
        if (silence == Presence::Silence::lost) end_all(Reason::no_answer, t);
        if (silence != Presence::Silence::counted) presence.report("silent", t.out);
    }
    void stop_over() {
        if (stops.first()) stops.remove(stops.first());
    }
    void end_all(Reason reason, Turn& t) {
        queue.clear();
        stops.clear();
        job.reset();
        poll.stop();
        tickets.fail_all(reason, "over", t.out);
    }
    void line(bool up, Turn& t) {
        exchange.drop();
        end_all(Reason::line_down, t);
        up ? presence.begin(t.now) : presence.close();
        presence.report(up ? "looked for" : "the line is down", t.out);
    }

    const Timing& timing;
    Presence presence;
    Turns& turns;
    std::size_t slot;
    CommandQueue queue{8};
    Tickets tickets;
    StopLane<Ticket, 3> stops;
    Exchange<Ask> exchange;
    PollTimer poll;
    std::optional<Command> job;
    std::uint32_t count = 0;
    std::vector<Ask> sent;
};

struct World {
    World(std::uint32_t seed, std::size_t window) : random(seed) {
        timing.reply_timeout = 20ms;
        timing.poll_period = 50ms;
        timing.pause = window == 1 ? 1ms : 0ms;
        turns.set({.window = window, .probe_window = 1 + window / 4, .pause = timing.pause});
        turns.line_changed(now);
        for (std::uint16_t i = 0; i < drives_of_line; ++i)
            drives.push_back(std::make_unique<ToyDrive>(i, timing, turns, i));
    }
    bool chance(int percent) { return static_cast<int>(random() % 100) < percent; }

    /// All consequences of the calls of one instant, and the laws that must hold afterwards.
    void settle(Turn& t) {
        for (auto& d : drives)
            d->settle(now);
        while (const auto s = turns.next(now)) {
            drives[*s]->go(t);
            drives[*s]->settle(now);
        }
        for (std::size_t i = 0; i < drives.size(); ++i) {
            ToyDrive& d = *drives[i];
            for (const Ask& a : d.sent) {
                // A waiting command was overtaken by the stop, if there is one: a drive with a stop sends nothing but stops.
                if (!d.stops.empty() && d.exchange.active() && d.exchange.sent() >= stop_came[i]) ASSERT_EQ(a.why, Ask::Why::stop);
                if (!chance(silence))
                    replies.emplace(now + std::chrono::milliseconds(1 + random() % (chance(10) ? 80 : 8)), std::pair{i, a.number});
            }
            d.sent.clear();
            ASSERT_LE(d.queue.size(), 8u);
            ASSERT_LE(d.stops.size(), 3u);
            ASSERT_LE(d.tickets.size(), 8u + 3u + 1u) << "what is open waits somewhere";
            if (d.presence.is(Phase::absent)) {
                ASSERT_GE(d.presence.retry_pause(), timing.pause_min);
                ASSERT_LE(d.presence.retry_pause(), timing.pause_max);
                if (d.presence.deadline() != never) ASSERT_LE(d.presence.deadline(), now + timing.pause_max);
            }
        }
        ASSERT_LE(turns.on_their_way(), turns.rules().window);
        ASSERT_GT(turns.deadline(), now) << "nothing is due any more";
        for (const Result& r : out.results)
            ASSERT_EQ(++results[r.ticket], 1) << "ticket " << r.ticket << ": " << r.text;
        out.clear();
    }
    void step() {
        const Instant reply = replies.empty() ? never : replies.begin()->first;
        const Instant client = now + std::chrono::microseconds(random() % 9000);
        now = std::min({turns.deadline(), reply, client});
        Turn t{now, out};
        if (now == reply) {
            const auto [who, number] = replies.begin()->second;
            replies.erase(replies.begin());
            if (up) drives[who]->answered(number, t, counters);
        } else if (now == client) {
            client_acts(t);
        }
        for (std::size_t n = 0; n < slot_limit; ++n) {
            const auto s = turns.due(now);
            if (!s) break;
            drives[*s]->on_deadline(t, counters);
            drives[*s]->settle(now);
        }
        settle(t);
    }
    void client_acts(Turn& t) {
        if (chance(1)) silence = static_cast<int>(random() % 3) * 50;
        if (chance(up ? 1 : 20)) return set_line(!up, t);
        const std::size_t who = random() % drives.size();
        Command c{++given, AxisId{1}, CommandBody{}, false, {}};
        const auto kind = random() % 10;
        if (kind < 4)
            c.body = Move{};
        else if (kind < 7)
            c.body = ReadParameter{};
        else if (kind < 8)
            c.body = Enable{};
        else
            c.body = Halt{};
        if (is_urgent(c.body)) stop_came[who] = now + Duration{1};
        results[c.ticket] = 0;
        drives[who]->submit(c, t);
    }
    void set_line(bool on, Turn& t) {
        up = on;
        replies.clear();
        turns.line_changed(now);
        for (auto& d : drives)
            d->line(up, t);
    }

    static constexpr std::uint16_t drives_of_line = 6;
    std::mt19937 random;
    Timing timing;
    Turns turns;
    std::vector<std::unique_ptr<ToyDrive>> drives;
    Instant now = time_zero + 1h;
    Out out;
    AdapterCounters counters;
    bool up = false;
    int silence = 0;
    std::multimap<Instant, std::pair<std::size_t, std::uint32_t>> replies;
    std::array<Instant, drives_of_line> stop_came{};
    std::map<Ticket, int> results;
    Ticket given = 0;
};

void play(std::size_t window) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", window " + std::to_string(window));
        World w(seed, window);
        Turn t{w.now, w.out};
        w.set_line(true, t);
        for (int n = 0; n < 4000 && !testing::Test::HasFatalFailure(); ++n)
            w.step();
        ASSERT_FALSE(testing::Test::HasFatalFailure());
        // Commands that were refused because the line was down, or waited when it went down, get one result each, and none is left.
        Turn end{w.now, w.out};
        w.set_line(false, end);
        w.settle(end);
        std::size_t answered = 0;
        for (const auto& [ticket, n] : w.results) {
            ASSERT_EQ(n, 1) << "ticket " << ticket;
            ++answered;
        }
        ASSERT_GT(answered, 500u);
        ASSERT_GT(w.counters.exchanges, 300u);
        ASSERT_GT(w.counters.timeouts, 0u);
        ASSERT_EQ(w.turns.deadline(), never) << "a line that is down waits for nothing";
    }
}

TEST(DriveLaws, OneExchangeAtATime) { play(1); }
TEST(DriveLaws, ManyAtOnce) { play(5); }

}  // namespace
}  // namespace axisgate::drive::test
