// Faults of the line, one by one, with real twins on a TwinBus: what a cable, a converter or a wrong setting does to the bytes.
// In: one fault at a time, at every place of an answer. Out: how long until every drive is heard again, who is named, and that no axis
// ever shows another's position.
#include <fmt/core.h>

#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

constexpr std::uint32_t rate = 19200;
/// One time-out with its time on the wire: the answer that is given up, and what had to cross before.
Duration one_timeout() { return 120ms + wire_time(10 * (64 + 64), rate); }

/// Two drives at places of their own; the fault of `break_one` happens to the next answer alone.
struct Fault : LineBench {
    explicit Fault(std::map<std::string, std::string> options = {}) : LineBench("ab", rate, std::move(options)) {
        run(6s);
        EXPECT_TRUE(online(0));
        EXPECT_TRUE(online(1));
        put(0, 1111);
        put(1, -222222);
        expect(0);
        expect(1);
    }
    /// To the start of the next answer of a poll.
    void to_next_answer() {
        const auto before = bytes_in;
        for (int i = 0; i < 2000 && bytes_in == before; ++i)
            run(1ms);
    }
    void recovers(const std::string& what) {
        const auto states = links.size();
        longest_gap.clear();
        run(2s);
        EXPECT_EQ(links.size(), states) << what << ": one fault takes no drive away";
        EXPECT_EQ(wrong, 0) << what;
        for (const auto& [axis, gap] : longest_gap)
            EXPECT_LE(gap, one_timeout() + 220ms) << what << ": heard again after one time-out and the turns of both";
    }
};

TEST(McodeLineFaults, NoiseBetweenAndInsideAnswers) {
    for (const char* noise : {"\xFF", "\x15", "\x06", "\r\n", "#", "#a0,0,00010000\r\n", "?", ">\r\n>", "\x80\x81\x82", "\x1B\x03"}) {
        Fault b;
        for (int at = 0; at < 30; at += 3) {
            b.run(std::chrono::milliseconds(at));
            b.receive(noise);
            b.drain();
            b.recovers(fmt::format("noise {} at {}", noise, at));
        }
        // Inside an answer: behind its nth byte.
        for (std::size_t at = 0; at < 20; at += 2) {
            bool once = true;
            b.on_cable = [&](std::string s) {
                if (once) s.insert(std::min(at, s.size()), noise);
                once = false;
                return s;
            };
            b.recovers(fmt::format("noise {} inside at {}", noise, at));
        }
    }
}

TEST(McodeLineFaults, EveryByteOfAnAnswerLostOrChanged) {
    for (int kind = 0; kind < 4; ++kind) {
        Fault b;
        for (std::size_t at = 0; at < 26; ++at) {
            bool once = true;
            b.on_cable = [&](std::string s) {
                if (!once || at >= s.size()) return s;
                once = false;
                if (kind == 0) s.erase(at, 1);
                if (kind == 1) s[at] = static_cast<char>(s[at] ^ 0x04);
                if (kind == 2) s.resize(at);                         // cut in the middle
                if (kind == 3) std::erase(s, at % 2 ? '\n' : '\r');  // the line end
                return s;
            };
            b.recovers(fmt::format("kind {} at {}", kind, at));
        }
    }
}

TEST(McodeLineFaults, TheGatewaysOwnBytesComeBackInEveryMode) {
    for (const std::string_view names : {"ab", "!"}) {
        for (int em = 0; em < 4; ++em) {
            for (int ck = 0; ck < 3; ++ck) {
                LineBench b(names, rate, {{"em", std::to_string(em)}, {"ck", std::to_string(ck)}});
                b.echo = true;
                b.run(12s);
                const auto what = fmt::format("{} em {} ck {}", names, em, ck);
                ASSERT_TRUE(b.online(0)) << what;
                b.put(0, 1111);
                b.expect(0);
                EXPECT_EQ(b.feedback[AxisId{0}].position, 1111) << what;
                if (names.size() > 1) {
                    ASSERT_TRUE(b.online(1)) << what;
                    EXPECT_EQ(b.feedback[AxisId{1}].position, 0) << what;
                    b.expect(1);
                }
                EXPECT_EQ(b.wait(Enable{}).outcome, Outcome::done) << what;
                EXPECT_EQ(b.wait(SetPosition{1111}).outcome, Outcome::done) << what;
                const auto timeouts = b.adapter.counters().timeouts;
                b.run(2s);
                EXPECT_EQ(b.adapter.counters().timeouts, timeouts) << what;
                EXPECT_EQ(b.wrong, 0) << what;
            }
        }
    }
}

TEST(McodeLineFaults, AnAnswerThatComesLateIntoTheNextExchange) {
    Fault b;
    for (int by = 20; by < 500; by += 17) {
        b.to_next_answer();
        b.hold = std::chrono::milliseconds(by);
        const auto before = b.late.size();
        for (int i = 0; i < 500 && b.late.size() == before; ++i)
            b.run(1ms);
        b.hold = {};
        const auto states = b.links.size();
        b.longest_gap.clear();
        b.run(3s);
        EXPECT_EQ(b.wrong, 0) << by;
        EXPECT_EQ(b.links.size(), states) << by;
        for (const auto& [axis, gap] : b.longest_gap)
            EXPECT_LE(gap, one_timeout() + 200ms) << by;
    }
}

/// A late acknowledgement must not stand for the next line's: the drive refuses that one, and the command says so.
TEST(McodeLineFaults, ALateAcknowledgementStandsForNoOtherLine) {
    for (int by = 60; by < 400; by += 31) {
        Fault b;
        ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
        const Ticket first = b.command(Enable{});
        b.hold = std::chrono::milliseconds(by);
        b.run(std::chrono::milliseconds(by + 20));
        b.hold = {};
        const Result refused = b.wait(Native{{'M', 'A', ' ', 'Z', 'Z'}, true});
        EXPECT_FALSE(good(refused)) << by << ": " << refused.text;
        b.run(3s);
        ASSERT_TRUE(b.result(first)) << by;
        EXPECT_EQ(b.wrong, 0) << by;
        EXPECT_TRUE(b.online(0)) << by;
    }
}

TEST(McodeLineFaults, TwoDrivesWithOneNameAreNamed) {
    LineBench b("ab", rate, {}, "aab");
    b.run(10s);
    EXPECT_TRUE(b.online(1)) << "the others go on";
    EXPECT_FALSE(b.online(0));
    bool named = false;
    for (const auto& l : b.links)
        named = named || (l.drive == DriveId{0} && l.text.find("two drives with this name") != std::string::npos);
    for (const auto& n : b.notices)
        named = named || (n.drive == DriveId{0} && n.text.find("same name") != std::string::npos);
    EXPECT_TRUE(named);
    for (const auto& l : b.links)
        EXPECT_EQ(l.text.find("d1 has"), std::string::npos) << l.text;
}

/// Both drives have their bytes behind one another, as where each has its own pause: the same question is answered twice.
TEST(McodeLineFaults, TheSameAnswerTwiceIsReportedWithTheName) {
    LineBench b("a", rate);
    b.run(5s);
    ASSERT_TRUE(b.online(0));
    b.on_cable = [](std::string s) { return s.starts_with('\x06') ? s + s.substr(1) : s; };
    b.run(2s);
    EXPECT_TRUE(std::ranges::any_of(
        b.notices, [](const Notice& n) { return n.drive == DriveId{0} && n.text.find("same name") != std::string::npos; }));
}

/// The second answer comes into the next exchange, in front of that one's answer.
TEST(McodeLineFaults, TheSameAnswerTwiceIsReportedWhenItComesLate) {
    LineBench b("a", rate);
    b.run(5s);
    ASSERT_TRUE(b.online());
    b.put(0, 1111);
    b.expect(0);
    b.notices.clear();
    std::string again;
    b.on_cable = [&](std::string s) {
        const std::string both = again + s;
        again = s.starts_with('\x06') ? s.substr(1) : std::string();
        return both;
    };
    b.run(500ms);
    EXPECT_TRUE(std::ranges::any_of(
        b.notices, [](const Notice& n) { return n.drive == DriveId{0} && n.text.find("same name") != std::string::npos; }));
    EXPECT_EQ(b.wrong, 0);
    EXPECT_TRUE(b.online());
}

TEST(McodeLineFaults, ASilentDriveIsNamedAndTheOtherGoesOn) {
    Fault b;
    b.hand(1, "silent", Value{true});
    b.longest_gap.clear();
    b.run(5s);
    EXPECT_TRUE(b.online(0));
    EXPECT_FALSE(b.online(1));
    EXPECT_NE(b.links.back().text.find("d1"), std::string::npos) << b.links.back().text;
    EXPECT_LE(b.longest_gap[AxisId{0}], one_timeout() + 200ms);
    b.hand(1, "silent", Value{false});
    b.run(7s);
    EXPECT_TRUE(b.online(1));
    EXPECT_EQ(b.wrong, 0);
}

/// Everything at once for a while, then quiet: all drives are back, each with its own position, and every command has one result.
TEST(McodeLineFaults, AfterAStormEveryDriveIsBackWithItsOwnPosition) {
    Fault b;
    std::uint32_t seed = 7;
    const auto random = [&] { return (seed = seed * 1664525U + 1013904223U) >> 16U; };
    b.on_cable = [&](std::string s) {
        if (random() % 4 == 0 && !s.empty()) s.erase(random() % s.size(), 1 + random() % 3);
        if (random() % 4 == 0) s.insert(random() % (s.size() + 1), 1, static_cast<char>(random() & 0xFF));
        return s;
    };
    std::vector<Ticket> tickets;
    for (int i = 0; i < 40; ++i) {
        tickets.push_back(b.command(Enable{}, static_cast<std::size_t>(i % 2)));
        b.run(500ms);
    }
    EXPECT_EQ(b.wrong, 0) << "a checksum stands before every position";
    b.on_cable = nullptr;
    b.run(15s);
    EXPECT_TRUE(b.online(0));
    EXPECT_TRUE(b.online(1));
    for (const Ticket t : tickets)
        EXPECT_EQ(std::ranges::count_if(b.results, [&](const Result& r) { return r.ticket == t; }), 1);
    EXPECT_EQ(b.feedback[AxisId{0}].position, 1111);
    EXPECT_EQ(b.feedback[AxisId{1}].position, -222222);
}

}  // namespace
}  // namespace axisgate::mcode::test
