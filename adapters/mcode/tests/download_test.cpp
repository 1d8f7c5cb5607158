// Downloads as people write them: settings and S around the program, printed listings, refusals by the drive, lines that break.
// In: texts, drives that refuse, a line that goes down, a drive that has just moved. Out: results with the line of the user's text, what
// the drive holds, events.
// Never judges a text: that is program_test.cpp.
#include <fmt/core.h>

#include "adapters/mcode/tests/line_bench.hpp"
#include "adapters/mcode/tests/printed_listings.hpp"

namespace axisgate::mcode::test {
namespace {

Action download(std::string_view text) { return {"program.download", std::string(text)}; }
std::size_t reported(const std::vector<Notice>& notices, std::string_view text) {
    return static_cast<std::size_t>(
        std::ranges::count_if(notices, [&](const Notice& n) { return n.text.find(text) != std::string::npos; }));
}

/// Settings in front are made, S behind saves, and the stored count counts what stands between.
TEST(McodeDownload, WhatStandsOutsideOfPgIsDoneAndNotLookedForInTheListing) {
    for (const int ck : {0, 1, 2}) {
        for (const int em : {0, 1, 2, 3}) {
            const auto what = fmt::format("ck {} em {}", ck, em);
            LineBench b("ab", 19200, {{"ck", std::to_string(ck)}, {"em", std::to_string(em)}});
            b.run(6s);
            Result r = b.wait(download("' set up\nA=500000\nVA Q1=7\nPG 1\nLB A1\n  R1=Q1\nE\nPG\nS\n' kept\n"));
            EXPECT_EQ(r.outcome, Outcome::done) << what << r.text;
            EXPECT_TRUE(r.text.starts_with("3 statements stored and verified")) << what << r.text;
            EXPECT_EQ(b.wait(line("PR A,Q1")).text, "5000007") << what;
            EXPECT_EQ(b.wait(Action{"program.upload", ""}).text, "LB A1\nR1=Q1\nE\n") << what;
            r = b.wait(download("A=600000\nPG 1\nLB A1\nE\nPG"));
            EXPECT_EQ(r.outcome, Outcome::done) << what << r.text;
            // The pace of moves is asked for again: the next one is not started from old values.
            EXPECT_EQ(b.wait(line("PR A")).text, "600000") << what;
        }
    }
}

TEST(McodeDownload, PrintedListingsAreStoredAsTheyStand) {
    for (const auto& l : printed_listings) {
        LineBench b("a", 115200);
        b.run(6s);
        const Result r = b.wait(download(l.text), 0, 30s);
        if (!l.fault.empty()) {
            EXPECT_EQ(r.outcome, Outcome::refused) << l.name;
            EXPECT_NE(r.text.find(l.fault), std::string::npos) << l.name << r.text;
            EXPECT_EQ(b.wait(Action{"program.upload", ""}).text, "") << l.name;
            continue;
        }
        EXPECT_EQ(r.outcome, Outcome::done) << l.name << ": " << r.text;
        EXPECT_NE(r.text.find("S has saved"), std::string::npos) << l.name << ": " << r.text;
        // Once more: a point that has its type already is no fault.
        const Result again = b.wait(download(l.text), 0, 30s);
        EXPECT_EQ(again.outcome, Outcome::done) << l.name << ": " << again.text;
    }
}

TEST(McodeDownload, ARefusalOfTheDriveHasTheLineOfTheText) {
    for (const int ck : {0, 1}) {
        Bench b;
        b.setup.options["ck"] = std::to_string(ck);
        b.drives[0].refuse["A=7000"] = 21;
        b.up();
        b.run(2s);
        Result r = b.wait(download("' one\n\nVA Q1\nA=7000\nPG 1\nLB A1\nE\nPG\n"));
        EXPECT_EQ(r.outcome, Outcome::failed) << r.text;
        EXPECT_NE(r.text.find("line 4: A=7000 was refused with error 21"), std::string::npos) << r.text;
        EXPECT_EQ(r.code, 21);
        r = b.wait(download("PG 1\nLB A1\nE\nPG\n\n\nA=7000\n"));
        EXPECT_NE(r.text.find("line 7: A=7000 was refused"), std::string::npos) << r.text;
        EXPECT_NE(r.text.find("the program before it is stored"), std::string::npos) << r.text;
        b.run(2s);
        EXPECT_EQ(b.drives[0].program, (std::vector<std::string>{"LB A1", "E"})) << "and it stays";
    }
    Bench b;
    b.up();
    b.run(2s);
    b.drives[0].deaf_after = "E";
    const Result r = b.wait(download("' one\nPG 1\n\nLB A1\nE\nPG\n"));
    EXPECT_NE(r.text.find("line 5: E was not acknowledged"), std::string::npos) << r.text;
}

/// The line goes down in the middle: behind its return the half is removed and that is told; a drive that has restarted keeps its own.
TEST(McodeDownload, AHalfThatABrokenLineHasLeftIsRemoved) {
    for (const int ck : {0, 1}) {
        for (int at = 1; at < 9; ++at) {
            for (const bool restarted : {false, true}) {
                const auto what = fmt::format("ck {} at {} restarted {}", ck, at, restarted);
                LineBench b("ab", 19200, {{"ck", std::to_string(ck)}});
                b.run(6s);
                ASSERT_EQ(b.wait(download("PG 1\nLB A1\nPR \"old\"\nE\nPG\nS")).outcome, Outcome::done) << what;
                const Ticket t = b.command(download("PG 1\nLB B1\nPR \"n1\"\nPR \"n2\"\nPR \"n3\"\nE\nPG"));
                const auto from = b.sent.size();
                const auto lines = [&] {
                    int n = 0;
                    for (std::size_t i = from; i < b.sent.size(); ++i)
                        n += b.sent[i].bytes[0] == 'a' && b.sent[i].bytes.find("PR \"#") == std::string::npos;
                    return n;
                };
                for (int guard = 0; lines() < at && guard < 5000; ++guard)
                    b.run(1ms);
                b.adapter.on_line(false, b.now, b.out);
                b.drain();
                ASSERT_TRUE(b.result(t)) << what;
                EXPECT_EQ(b.result(t)->outcome, Outcome::failed) << what;
                b.run(1s);
                if (restarted) {
                    b.hand(0, "power", Value{false});
                    b.run(500ms);
                    b.hand(0, "power", Value{true});
                }
                b.run(1s);
                b.notices.clear();
                b.adapter.on_line(true, b.now, b.out);
                b.drain();
                b.run(10s);
                ASSERT_TRUE(b.online()) << what;
                const auto stored = b.wait(Action{"program.upload", ""}).text;
                EXPECT_EQ(stored, restarted ? "LB A1\nPR \"old\"\nE\n" : "") << what;
                EXPECT_EQ(reported(b.notices, "was removed (CP)"), restarted ? 0U : 1U) << what;
                EXPECT_EQ(reported(b.notices, "that is left alone"), restarted ? 1U : 0U) << what;
            }
        }
    }
}

TEST(McodeDownload, AfterAFinishedMoveOrAStopRestIsWaitedFor) {
    for (const bool stop : {false, true}) {
        for (const char* what : {"program.download", "program.save", "program.clear", "restore", "S"}) {
            LineBench b("a", 19200);
            b.run(6s);
            ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
            Move m;
            m.kind = stop ? Move::Kind::velocity : Move::Kind::relative;
            m.target = stop ? 100000 : 20000;
            ASSERT_EQ(b.wait(m).outcome, Outcome::accepted);
            b.run(500ms);
            if (stop) {
                EXPECT_EQ(b.wait(download("E")).outcome, Outcome::refused) << "it moves";
                ASSERT_EQ(b.wait(QuickStop{}).outcome, Outcome::accepted);
            } else {
                for (int i = 0; i < 400 && !b.feedback[AxisId{0}].target_reached; ++i)
                    b.run(10ms);
            }
            ASSERT_NE(b.feedback[AxisId{0}].native_status & 1U, 0U) << "MV lasts for MT and HT";
            const Result r = b.wait(Action{what, std::string_view(what) == "program.download" ? "PG 1\nLB A1\nE\nPG" : ""});
            EXPECT_EQ(r.outcome, Outcome::done) << what << stop << r.text;
        }
    }
}

}  // namespace
}  // namespace axisgate::mcode::test
