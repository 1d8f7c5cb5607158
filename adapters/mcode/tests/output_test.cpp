// What programs print on the line of the adapter, and answers that are late, cut, spoiled, lost or doubled: real twins on a TwinBus.
// In: programs that print, cables with faults, two drives with one name. Out: events `output` and `protocol`, named and few.
// Never asks for the text itself.
#include <fmt/core.h>

#include <random>

#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

std::size_t count(const std::vector<Notice>& notices, std::string_view kind, std::string_view text) {
    return static_cast<std::size_t>(
        std::ranges::count_if(notices, [&](const Notice& n) { return n.kind == kind && (text.empty() || n.text.ends_with(text)); }));
}

/// Together with the acknowledgement of EX, between polls, and in the middle of them.
TEST(McodeOutput, EveryLineOfAProgramIsAnEvent) {
    for (const std::string_view names : {"ab", "!"}) {
        for (const int em : {0, 1, 2, 3}) {
            for (const int ck : {0, 1, 2}) {
                const auto what = fmt::format("{} em {} ck {}", names, em, ck);
                LineBench b(names, 19200, {{"em", std::to_string(em)}, {"ck", std::to_string(ck)}});
                b.run(6s);
                ASSERT_TRUE(b.online()) << what;
                ASSERT_EQ(b.wait(Action{"program.download",
                                        "PG 1\nLB A1\nPR \"hello\"\nE\nLB B1\nH 200\nR1=0\nLB B2\nPR \"count \",R1\nH 37\nR1=R1+1\n"
                                        "BR B2,R1<20\nE\nPG"})
                              .outcome,
                          Outcome::done)
                    << what;
                b.run(1s);
                b.notices.clear();
                for (int i = 0; i < 4; ++i) {
                    ASSERT_EQ(b.wait(Action{"program.start", "A1"}).outcome, Outcome::accepted) << what;
                    b.run(std::chrono::milliseconds(300 + 7 * i));
                }
                EXPECT_EQ(count(b.notices, "output", "hello"), 4U) << what;
                ASSERT_EQ(b.wait(Action{"program.start", "B1"}).outcome, Outcome::accepted) << what;
                b.run(4s);
                // On one pair of wires two who speak at once spoil both; what arrives whole is told, and nothing else.
                std::size_t whole = 0;
                for (int i = 0; i < 20; ++i)
                    whole += count(b.notices, "output", fmt::format(": count {}", i));
                EXPECT_GE(whole, names == "!" ? 20U : 9U) << what;
                EXPECT_LE(count(b.notices, "output", ""), 4U + whole + (names == "!" ? 0U : 4U)) << what << ": spoiled ones";
                for (const auto& n : b.notices)
                    if (n.kind == "output") EXPECT_TRUE(n.text.starts_with("d0: ")) << n.text;
            }
        }
    }
}

TEST(McodeOutput, TwoDrivesWithOneNameAreToldOnceAMinute) {
    for (const int em : {0, 1, 3}) {
        for (const int ck : {0, 1}) {
            Bench b({'a', 'b'});
            b.setup.options = {{"em", std::to_string(em)}, {"ck", std::to_string(ck)}};
            b.drives.push_back(b.drives[0]);
            b.up();
            for (int s = 0; s < 200; ++s)
                b.run(1s);
            const auto n = count(b.notices, "protocol", "the same name a");
            EXPECT_GE(n, 2U) << em << ck;
            EXPECT_LE(n, 5U) << em << ck;
        }
    }
}

TEST(McodeOutput, AnswersThatAreSpoiledAgainAndAgainNameTheirDrive) {
    for (const std::string_view how : {"late", "cut off", "spoiled", "lost"}) {
        LineBench b("ab", 19200);
        b.run(6s);
        b.notices.clear();
        std::mt19937 dice(7);
        const bool late = how == "late";
        b.on_cable = [&](std::string s) -> std::string {
            if (b.sent.empty() || b.sent.back().bytes.find("aPR") == std::string::npos || dice() % 4 != 0) return s;
            if (late) {
                b.late.push_back({b.now + 200ms, s});
                return {};
            }
            if (how == "lost") return {};
            if (how == "cut off") return s.size() > 4 ? s.substr(0, s.size() / 2) : s;
            if (s.size() > 6) s[s.size() / 2] ^= 1;
            return s;
        };
        int online = 0;
        for (int second = 0; second < 150; ++second) {
            b.run(1s);
            online += b.online(0);
        }
        EXPECT_GE(online, 130) << how << ": three in a row make it absent until the next question";
        const auto about = [&](DriveId d) {
            return std::ranges::count_if(b.notices, [&](const Notice& n) { return n.kind == "protocol" && n.drive == d; });
        };
        EXPECT_GE(about(DriveId{0}), 2) << how;
        EXPECT_LE(about(DriveId{0}), 4) << how;
        EXPECT_EQ(about(DriveId{1}), 0) << how;
        bool named = false;
        for (const auto& n : b.notices)
            named = named || (n.kind == "protocol" && n.text.find(how) != std::string::npos);
        EXPECT_TRUE(named) << how;
        EXPECT_LE(count(b.notices, "output", ""), 0U) << how;
    }
    LineBench b("ab", 19200);
    b.run(6s);
    bool once = true;
    b.on_cable = [&](std::string s) { return std::exchange(once, false) ? std::string() : s; };
    b.run(60s);
    EXPECT_EQ(count(b.notices, "protocol", ""), 0U) << "one is nothing";
    b.notices.clear();
    b.hand(0, "silent", Value{true});
    b.run(20s);
    EXPECT_EQ(count(b.notices, "protocol", ""), 0U) << "a silent one is absent, and that is told";
}

}  // namespace
}  // namespace axisgate::mcode::test
