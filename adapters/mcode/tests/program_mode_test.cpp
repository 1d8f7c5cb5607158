// Program mode that somebody else has left open, and programs that run when a drive is found: real twins on a TwinBus.
// In: lines that another master types, at a start or while the gateway works. Out: a drive that is led out, its program as it was, an
// event; no stop and no command that became program text.
#include <fmt/core.h>

#include <random>

#include "adapters/mcode/native_program.hpp"
#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

struct Typist : LineBench {
    using LineBench::LineBench;
    /// Somebody else's terminal at the same line.
    void type(std::size_t drive, std::string_view text, bool with_sum) {
        const std::string bytes = request({setup.drives[drive].address[0], with_sum}, text);
        EXPECT_TRUE(bus->send(Frame::run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}), Priority::command, now));
        run(100ms);
    }
    void open_program(std::size_t drive, bool with_sum) {
        run(500ms);
        type(drive, "", with_sum);  // ends what was cut off
        for (const char* text : {"PG 1", "LB AA", "R1=R1+1", "H 100", "R2=R1"})
            type(drive, text, with_sum);
    }
    std::vector<Notice> reported(std::string_view kind) const {
        std::vector<Notice> some;
        for (const auto& n : notices) {
            if (n.kind == kind) some.push_back(n);
        }
        return some;
    }
    void is_out_with_its_program(const std::string& what, std::size_t drive = 0) {
        ASSERT_TRUE(online(drive)) << what;
        const Result r = wait(Action{"program.upload", ""}, drive);
        EXPECT_EQ(r.text, "LB AA\nR1=R1+1\nH 100\nR2=R1\n") << what;
        const auto events = reported("program_mode");
        ASSERT_EQ(events.size(), 2U) << what;
        EXPECT_EQ(events[0].severity, Severity::warning);
        EXPECT_NE(events[0].text.find("was in program mode and was led out"), std::string::npos) << events[0].text;
        EXPECT_NE(events[0].text.find("because"), std::string::npos) << events[0].text;
        EXPECT_NE(events[1].text.find("as it was found"), std::string::npos) << what << events[1].text;
        EXPECT_EQ(events[0].drive, setup.drives[drive].id);
    }
};

TEST(McodeProgramMode, AGatewayThatStartsLeadsADriveOut) {
    for (const std::string_view names : {"ab", "!"}) {
        for (const int em : {0, 1, 3}) {
            for (const int ck : {0, 1, 2}) {
                const auto what = fmt::format("{} em {} ck {}", names, em, ck);
                Typist b(names, 19200, {{"em", std::to_string(em)}, {"ck", std::to_string(ck)}});
                b.run(6s);
                ASSERT_TRUE(b.online()) << what;
                b.adapter.on_line(false, b.now, b.out);
                b.drain();
                b.open_program(0, ck > 0);
                const auto before = b.sent.size();
                b.adapter.on_line(true, b.now, b.out);
                b.drain();
                b.run(8s);
                b.is_out_with_its_program(what);
                int stored = 0;
                for (std::size_t i = before; i < b.sent.size() && b.sent[i].bytes.find("PG") == std::string::npos; ++i)
                    stored += b.sent[i].bytes.find(std::string(1, names[0]) + "PR \"#") != std::string::npos || names == "!";
                EXPECT_LE(stored, 3) << what << ": what is asked before it is known is stored";
                if (names.size() > 1) EXPECT_TRUE(b.online(1)) << what;
            }
        }
    }
}

TEST(McodeProgramMode, ADriveThatComesInProgramModeIsLedOutToo) {
    Typist b("a", 19200);
    b.run(6s);
    b.hand(0, "silent", Value{true});
    b.run(15s);
    ASSERT_FALSE(b.online(0));
    for (const auto before = b.sent.size(); b.sent.size() == before;)
        b.run(10ms);  // from here it has five seconds' peace
    b.open_program(0, true);
    b.hand(0, "silent", Value{false});
    b.run(12s);
    b.is_out_with_its_program("found again");
}

/// Whatever is said when it happens: the stop is done, not stored, and behind PG.
TEST(McodeProgramMode, AStopIsSaidBehindPgAndDone) {
    for (const int ck : {0, 1}) {
        for (int at = 0; at < 12; ++at) {
            const auto what = fmt::format("ck {} at {}", ck, at);
            Typist b("a", 19200, {{"ck", std::to_string(ck)}});
            b.setup.timing.poll_period = 400ms;
            b.adapter.configure(b.setup, b.now, b.out);
            b.run(6s);
            ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
            b.run(1s);
            // Typed between two polls, while the gateway works.
            for (const auto before = b.bytes_in; b.bytes_in == before;)
                b.run(1ms);
            b.run(50ms);
            b.type(0, "PG 1", ck > 0);
            b.run(std::chrono::milliseconds(47 * at));
            const Ticket stop = b.command(QuickStop{});
            b.run(5s);
            ASSERT_TRUE(b.result(stop)) << what;
            EXPECT_EQ(b.result(stop)->outcome, Outcome::accepted) << what << b.result(stop)->text;
            EXPECT_TRUE(b.online()) << what;
            const Result r = b.wait(Action{"program.upload", ""});
            EXPECT_EQ(r.text.find("PR"), std::string::npos) << what << r.text;
            // The line that was said before anybody could know is the only one that may have been stored; it was said again.
            std::size_t stops = 0;
            for (const auto& s : b.sent)
                stops += s.bytes.starts_with("aSL 0");
            EXPECT_GE(stops, 1U) << what;
            EXPECT_GE(b.reported("program_mode").size(), 1U) << what;
        }
    }
}

TEST(McodeProgramMode, ARefusedQuestionIsNoProgramMode) {
    for (const int ck : {0, 1}) {
        Typist b("ab", 19200, {{"ck", std::to_string(ck)}});
        b.run(6s);
        ASSERT_TRUE(b.online());
        // One answer loses all but its acknowledgement: asked after, and no PG.
        for (int i = 0; i < 5; ++i) {
            bool once = true;
            b.on_cable = [&](std::string s) {
                if (once && s.size() > 10) s.resize(s[0] == '\x06' ? 1 : 2);
                once = once && s.size() > 2;
                return s;
            };
            b.run(1s);
        }
        for (const auto& s : b.sent)
            EXPECT_EQ(s.bytes.find("PG"), std::string::npos);
        EXPECT_TRUE(b.online(0));
        EXPECT_TRUE(b.online(1));
        EXPECT_TRUE(b.reported("program_mode").empty());
    }
}

/// Ends of lines that are lost join two requests, and the refusal of that looks like a line that prints nothing. PG would put a drive that
/// is not in program mode into it, and what is said next over its program.
TEST(McodeProgramMode, LostLineEndsAreNoProgramMode) {
    for (const std::string_view names : {"ab", "!"}) {
        for (const int em : {0, 1, 2, 3}) {
            for (const int ck : {0, 1, 2}) {
                for (const bool each : {false, true}) {
                    const auto what = fmt::format("{} em {} ck {} each {}", names, em, ck, each);
                    Typist b(names, 115200, {{"em", std::to_string(em)}, {"ck", std::to_string(ck)}});
                    b.run(6s);
                    ASSERT_TRUE(b.online()) << what;
                    ASSERT_EQ(b.wait(Action{"program.download", "PG 1\nLB A1\nPR \"hello\"\nE\nPG"}).outcome, Outcome::done) << what;
                    // Where bytes collide some become CTRL+C: a drive that restarts has it still.
                    ASSERT_EQ(b.wait(Action{"program.save", ""}).outcome, Outcome::done) << what;
                    b.run(1s);
                    const auto before = b.sent.size();
                    std::mt19937 dice(em * 10U + static_cast<unsigned>(ck) + names.size());
                    b.on_way = [&](std::string s) {
                        const char end = names == "!" ? '\r' : '\n';
                        const bool all = dice() % 100 < 12;
                        std::string out;
                        for (const char c : s)
                            if (c != end || !(each ? dice() % 100 < 12 : all)) out += c;
                        return out;
                    };
                    const Instant end = b.now + 60s;
                    for (int i = 0; b.now < end; ++i) {
                        b.command(ReadParameter{*catalogue().find("A")}, 0);
                        if (names.size() > 1) b.command(ReadParameter{*catalogue().find("R1")}, 1);
                        if (i % 7 == 0) b.command(WriteParameter{*catalogue().find("R2"), Value{std::int64_t{i}}}, 0);
                        b.run(100ms);
                    }
                    b.on_way = nullptr;
                    b.run(12s);
                    for (auto i = before; i < b.sent.size(); ++i)
                        ASSERT_EQ(b.sent[i].bytes.find("PG"), std::string::npos) << what;
                    ASSERT_TRUE(b.online()) << what;
                    const Result r = b.wait(Action{"program.upload", ""});
                    EXPECT_EQ(r.outcome, Outcome::done) << r.text;
                    EXPECT_EQ(r.text, "LB A1\nPR \"hello\"\nE\n") << what;
                }
            }
        }
    }
}

/// And one that is in it is led out all the same, as soon as the line allows.
TEST(McodeProgramMode, OverABadLineADriveIsLedOutToo) {
    for (const int em : {1, 3}) {
        for (const int ck : {0, 1}) {
            const auto what = fmt::format("em {} ck {}", em, ck);
            Typist b("ab", 115200, {{"em", std::to_string(em)}, {"ck", std::to_string(ck)}});
            b.run(6s);
            ASSERT_TRUE(b.online()) << what;
            std::mt19937 dice(3);
            b.adapter.on_line(false, b.now, b.out);
            b.drain();
            b.open_program(0, ck > 0);
            b.adapter.on_line(true, b.now, b.out);
            b.drain();
            b.on_way = [&](std::string s) {
                if (dice() % 100 < 12) std::erase(s, '\n');
                return s;
            };
            b.run(20s);
            b.on_way = nullptr;
            b.run(5s);
            ASSERT_TRUE(b.online()) << what;
            EXPECT_GE(b.reported("program_mode").size(), 1U) << what;
            EXPECT_EQ(b.wait(Action{"program.end", ""}).outcome, Outcome::refused) << what << ": it is obeyed again";
        }
    }
}

TEST(McodeProgramMode, NobodyIsLedOutWhoIsNotThere) {
    for (const bool echo : {false, true}) {
        Typist b("ab", 19200, {}, "a");
        b.echo = echo;
        b.run(20s);
        EXPECT_TRUE(b.online(0));
        EXPECT_FALSE(b.online(1));
        for (const auto& s : b.sent)
            EXPECT_EQ(s.bytes.find("PG"), std::string::npos) << echo;
    }
}

TEST(McodeProgramMode, ADriveThatDoesNotLeaveIsAskedWithPausesAlone) {
    Bench b;
    b.drives[0].in_program = b.drives[0].stuck = true;
    b.up();
    b.run(10s);
    EXPECT_FALSE(b.online());
    EXPECT_NE(b.links.back().text.find("does not leave"), std::string::npos) << b.links.back().text;
    const auto stored = b.drives[0].program.size();
    b.run(30s);
    EXPECT_LE(b.drives[0].program.size() - stored, 16U) << "in 30 s";
    b.drives[0].stuck = false;
    b.run(15s);
    EXPECT_TRUE(b.online());
    EXPECT_FALSE(b.drives[0].in_program);
}

TEST(McodeProgramMode, NativePgIsRefusedInEveryForm) {
    Bench b;
    b.up();
    b.run(2s);
    for (const char* text : {"PG", "PG 1", "PG1", "pg100", " PG"})
        EXPECT_EQ(b.wait(line(text)).outcome, Outcome::refused) << text;
    EXPECT_FALSE(b.drives[0].in_program);
}

TEST(McodeProgramMode, WhatIsNotAtTheEndIsLeftAndSaid) {
    struct Row {
        const char* listing;
        std::size_t count;
        bool at_end;
        const char* address;
    };
    for (const Row& r : {Row{"1 LB AA\r\n7 H\r\n", 0, false, ""}, Row{"1 LB AA\r\n7 PR \"#b\",EM,CK,ES\r\n24 PR \"#c\",EM", 2, true, "7"},
                         Row{"1 PR \"#b\",EM\r\n14 LB AA", 1, false, "1"}, Row{"PR \"#b\",EM", 1, true, ""},
                         Row{"1 PR \"#b\",EM\r\n9 H\r\n11 PR \"#c\",EM", 2, false, "1"}, Row{"1 PR \"# parts\",R1", 0, false, ""}}) {
        const auto s = stored_questions(r.listing);
        EXPECT_EQ(s.count, r.count) << r.listing;
        if (r.count > 0) EXPECT_EQ(s.at_end, r.at_end) << r.listing;
        EXPECT_EQ(s.address, r.address) << r.listing;
    }
}

/// A program that runs when a gateway starts goes on, undisturbed to its last register, and is told.
TEST(McodeProgramMode, AProgramThatRunsAtStartIsLeftAloneAndTold) {
    for (const char* product : {"LMDC", "LMDO", "LMM"}) {
        Typist b("ab", 19200, {{"product", product}});
        b.run(6s);
        ASSERT_TRUE(b.online());
        // Its handler counts errors: what the gateway asks must raise none.
        ASSERT_EQ(b.wait(Action{"program.download", "LB AA\nOE E1\nLB L1\nR1=R1+1\nH 50\nBR L1\nE\nLB E1\nR3=R3+1\nRT\n"}).outcome,
                  Outcome::done);
        ASSERT_EQ(b.wait(Action{"program.start", "AA"}).outcome, Outcome::accepted);
        b.run(2s);
        ASSERT_NE(b.feedback[AxisId{0}].native_status & 32U, 0U) << product;
        b.notices.clear();
        b.adapter.on_line(false, b.now, b.out);
        b.drain();
        b.run(1s);
        const auto before = b.sent.size();
        b.adapter.on_line(true, b.now, b.out);
        b.drain();
        b.run(6s);
        ASSERT_TRUE(b.online()) << product;
        const auto reported = b.reported("program");
        ASSERT_EQ(reported.size(), 1U) << product;
        EXPECT_EQ(reported[0].drive, DriveId{0});
        EXPECT_NE(reported[0].text.find("left alone"), std::string::npos) << reported[0].text;
        EXPECT_NE(b.feedback[AxisId{0}].native_status & 32U, 0U) << product << ": told as state";
        for (auto i = before; i < b.sent.size(); ++i) {
            for (const char* word : {"SL", "E\n", "PS", "DE=", "ER", "MA", "EX", "\x1B"})
                EXPECT_EQ(b.sent[i].bytes.find(std::string("a") + word), std::string::npos) << product << b.sent[i].bytes;
        }
        EXPECT_EQ(b.wait(line("PR R3")).text, "0") << product << ": its error handler was not called";
        const Result first = b.wait(line("PR R1"));
        b.run(1s);
        EXPECT_NE(b.wait(line("PR R1")).text, first.text) << product << ": it runs on";
        EXPECT_TRUE(b.reported("error").empty()) << product;
    }
}

TEST(McodeProgramMode, AnErrorFromBeforeTheStartIsTold) {
    Bench b;
    b.drives[0].er = 72;
    b.up();
    b.run(3s);
    EXPECT_TRUE(b.feedback[AxisId{0}].fault);
    EXPECT_EQ(b.feedback[AxisId{0}].error_code, 72);
    EXPECT_EQ(std::ranges::count_if(b.notices, [](const Notice& n) { return n.code == 72; }), 1);
}

}  // namespace
}  // namespace axisgate::mcode::test
