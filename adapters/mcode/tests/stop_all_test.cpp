// All drives of a party line stopped at once: one line to `*`, then each is read; and when that is not possible, one by one.
// In: stops of several axes in the same instant. Out: what was sent, when each drive stands, one result each.
#include <fmt/core.h>

#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

struct Crowd : LineBench {
    explicit Crowd(std::string_view names = "abcd", std::map<std::string, std::string> options = {})
        : LineBench(names, 19200, std::move(options)) {
        run(10s);
        for (std::size_t i = 0; i < setup.drives.size(); ++i) {
            EXPECT_TRUE(online(i)) << i;
            EXPECT_EQ(wait(Enable{}, i).outcome, Outcome::done) << i;
        }
    }
    void slew(std::size_t i, std::int64_t speed = 50000) {
        Move m;
        m.kind = Move::Kind::velocity;
        m.target = speed;
        m.acceleration = m.deceleration = 200000;
        EXPECT_EQ(wait(m, i).outcome, Outcome::accepted) << i;
    }
    void slew_all() {
        for (std::size_t i = 0; i < setup.drives.size(); ++i)
            slew(i, i % 2 ? -50000 : 50000);
        run(1s);
    }
    std::size_t count(std::string_view start, std::size_t from = 0) const {
        std::size_t n = 0;
        for (auto i = from; i < sent.size(); ++i)
            n += sent[i].bytes.starts_with(start);
        return n;
    }
    bool turns(std::size_t i) const { return feedback.at(AxisId{static_cast<std::uint16_t>(i)}).velocity != 0; }
    /// To the middle of a poll: stops that come now find the line taken, as they nearly always do.
    void to_a_poll() {
        for (const auto before = sent.size(); sent.size() == before;)
            run(1ms);
    }
    std::vector<Ticket> stop_all(const CommandBody& body) {
        std::vector<Ticket> tickets;
        for (std::size_t i = 0; i < setup.drives.size(); ++i)
            tickets.push_back(command(body, i));
        return tickets;
    }
    void all_good(const std::vector<Ticket>& tickets, const std::string& what) {
        for (const Ticket t : tickets) {
            ASSERT_TRUE(result(t)) << what << t;
            EXPECT_TRUE(good(*result(t))) << what << result(t)->text;
        }
    }
};

TEST(McodeStopAll, OneLineStopsAllAndEachIsRead) {
    for (const int kind : {0, 1, 2}) {
        for (const int ck : {0, 1}) {
            for (const int em : {0, 1, 2}) {
                const auto what = fmt::format("kind {} ck {} em {}", kind, ck, em);
                Crowd b("abcd", {{"ck", std::to_string(ck)}, {"em", std::to_string(em)}});
                b.slew_all();
                b.to_a_poll();
                const auto before = b.sent.size();
                const auto exchanges = b.adapter.counters().timeouts;
                const CommandBody body = kind == 0 ? CommandBody{QuickStop{}} : kind == 1 ? CommandBody{Halt{}} : CommandBody{Disable{}};
                const std::string line = kind == 2 ? "DE=0" : "SL 0";
                const auto tickets = b.stop_all(body);
                b.run(3s);
                b.all_good(tickets, what);
                EXPECT_EQ(b.count("*" + line, before), 1U) << what;
                for (const char name : {'a', 'b', 'c', 'd'})
                    EXPECT_EQ(b.count(name + line, before), 0U) << what << name;
                EXPECT_EQ(b.sent[before].bytes[0], '*') << what << ": the first thing behind the exchange in progress";
                for (std::size_t i = 0; i < 4; ++i) {
                    EXPECT_FALSE(b.turns(i)) << what << i;
                    EXPECT_EQ(std::ranges::count_if(b.results, [&](const Result& r) { return r.ticket == tickets[i]; }), 1) << what;
                }
                EXPECT_EQ(b.adapter.counters().timeouts, exchanges) << what << ": nothing is waited for";
                EXPECT_TRUE(std::ranges::none_of(b.notices, [](const Notice& n) { return n.kind == "error"; })) << what;
            }
        }
    }
}

/// The times on the wire, not the orders of the clients: the last drive hears its stop as early as the first.
TEST(McodeStopAll, EightDrivesAreToldInOneLinesTime) {
    Crowd b("abcdefgh");
    b.slew_all();
    b.to_a_poll();
    const auto before = b.sent.size();
    const Instant asked = b.now;
    const auto tickets = b.stop_all(QuickStop{});
    b.run(3s);
    b.all_good(tickets, "eight");
    ASSERT_GT(b.sent.size(), before);
    EXPECT_TRUE(b.sent[before].bytes.starts_with("*SL 0"));
    EXPECT_LE(b.sent[before].at - asked, 60ms);
}

TEST(McodeStopAll, NobodyIsStoppedWhoWasNotAsked) {
    Crowd b;
    b.slew_all();
    b.to_a_poll();
    std::vector<Ticket> tickets;
    for (std::size_t i = 0; i < 3; ++i)
        tickets.push_back(b.command(QuickStop{}, i));
    b.run(3s);
    b.all_good(tickets, "three of four");
    EXPECT_EQ(b.count("*"), 0U);
    EXPECT_TRUE(b.turns(3));
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_FALSE(b.turns(i));
}

TEST(McodeStopAll, DifferentStopsAndSingleModeGoOneByOne) {
    Crowd b("ab");
    b.slew_all();
    b.to_a_poll();
    const Ticket off = b.command(Disable{}, 0), halt = b.command(Halt{}, 1);
    b.run(3s);
    b.all_good({off, halt}, "mixed");
    EXPECT_EQ(b.count("*"), 0U);
    Crowd one("!");
    one.slew(0);
    const Ticket stop = one.command(QuickStop{});
    one.run(2s);
    one.all_good({stop}, "single");
    EXPECT_EQ(one.count("*"), 0U);
}

/// The first is on its way when the others come: the rest of the line is still told together.
TEST(McodeStopAll, StopsThatComeWhileTheFirstIsSaidAreJoined) {
    Crowd b;
    b.slew_all();
    b.to_a_poll();
    const auto before = b.sent.size();
    std::vector<Ticket> tickets{b.command(QuickStop{}, 0)};
    while (b.sent.size() == before)
        b.run(1ms);
    for (std::size_t i = 1; i < 4; ++i)
        tickets.push_back(b.command(QuickStop{}, i));
    b.run(3s);
    b.all_good(tickets, "joined");
    EXPECT_EQ(b.count("aSL 0", before), 1U);
    EXPECT_EQ(b.count("*SL 0", before), 1U);
    EXPECT_EQ(b.count("bSL 0", before) + b.count("cSL 0", before) + b.count("dSL 0", before), 0U);
}

TEST(McodeStopAll, AHomingAProgramAndADriveThatAnswersGlobalLinesAreStoppedToo) {
    Crowd b;
    const auto native = [&](std::string_view s, std::size_t i) {
        EXPECT_EQ(b.wait(Native{{s.begin(), s.end()}, true}, i).outcome, Outcome::done) << s;
    };
    native("IS=1,1,0", 0);
    EXPECT_EQ(b.wait(Home{21}, 0).outcome, Outcome::accepted);
    ASSERT_EQ(b.wait(Action{"program.download", "LB AA\nMR 50000\nH\nMR -50000\nH\nBR AA\nE\n"}, 1).outcome, Outcome::done);
    ASSERT_EQ(b.wait(Action{"program.start", "AA"}, 1).outcome, Outcome::accepted);
    native("DG=0", 2);
    native("DG=0", 3);
    b.slew(2);
    b.run(1s);
    ASSERT_TRUE(b.turns(0));
    b.to_a_poll();
    const auto tickets = b.stop_all(QuickStop{});
    b.run(4s);
    b.all_good(tickets, "three kinds");
    EXPECT_EQ(b.count("*SL 0"), 1U);
    EXPECT_EQ(b.count("a\x1B"), 1U) << "a homing takes the escape character of its drive alone";
    b.run(3s);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_FALSE(b.turns(i)) << i;
        EXPECT_TRUE(b.online(i)) << i;
    }
    EXPECT_EQ(b.feedback[AxisId{1}].native_status & 32U, 0U) << "its program was ended";
}

/// Drives that have not heard the line (these fakes do not know `*`) are read, found out and told alone.
TEST(McodeStopAll, WhoHasNotHeardItIsToldAlone) {
    for (const char* changing : {"0", "1"}) {
        Bench b({'a', 'b'});
        b.up();
        b.run(3s);
        ASSERT_EQ(b.wait(Enable{}, 0).outcome, Outcome::done);
        ASSERT_EQ(b.wait(Enable{}, 1).outcome, Outcome::done);
        for (auto& d : b.drives) {
            d.values["V"] = "5000";
            d.values["MV"] = "1";
            d.values["VC"] = changing;
        }
        b.run(200ms);
        while (b.coming.empty())
            b.run(1ms);
        const Ticket first = b.command(QuickStop{}, 0), second = b.command(Halt{}, 1);
        b.run(2s);
        ASSERT_TRUE(b.result(first) && b.result(second));
        EXPECT_TRUE(good(*b.result(first)) && good(*b.result(second)));
        EXPECT_EQ(std::ranges::count_if(b.sent, [](const auto& s) { return s.starts_with("*SL 0"); }), 1);
        for (const auto& d : b.drives) {
            EXPECT_EQ(std::ranges::count(d.received_lines, "SL 0"), 1) << d.name;
            EXPECT_EQ(d.values.at("V"), "0");
        }
    }
}

TEST(McodeStopAll, ADriveThatIsAwayDelaysNobody) {
    Crowd b;
    b.slew_all();
    b.hand(3, "silent", Value{true});
    b.run(3s);
    ASSERT_FALSE(b.online(3));
    b.to_a_poll();
    std::vector<Ticket> tickets;
    for (std::size_t i = 0; i < 3; ++i)
        tickets.push_back(b.command(QuickStop{}, i));
    b.run(2s);
    b.all_good(tickets, "one is away");
    EXPECT_EQ(b.count("*SL 0"), 1U);
    // Silent since a moment, and asked: the others have their results first.
    Crowd c;
    c.slew_all();
    c.hand(0, "silent", Value{true});
    const auto all = c.stop_all(QuickStop{});
    c.run(900ms);
    int done = 0;
    for (std::size_t i = 1; i < 4; ++i)
        done += c.result(all[i]) && good(*c.result(all[i]));
    EXPECT_EQ(done, 3);
    c.run(4s);
    ASSERT_TRUE(c.result(all[0]));
    EXPECT_EQ(c.result(all[0])->reason, Reason::no_answer);
}

}  // namespace
}  // namespace axisgate::mcode::test
