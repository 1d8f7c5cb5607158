// The adapter against fake drives: finding, polling, commands, faults of the line.
#include "adapters/mcode/tests/fake_drive.hpp"

namespace axisgate::mcode::test {
namespace {

Move to(std::int64_t target) {
    Move m;
    m.target = target;
    m.velocity = 4000;
    m.acceleration = 20000;
    m.deceleration = 20000;
    return m;
}
bool has(const std::vector<std::string>& list, std::string_view line) { return std::ranges::find(list, line) != list.end(); }
Native native(std::string_view s) { return {{s.begin(), s.end()}, true}; }

/// Every state that a drive may be found in: EM 0..3, CK 0..2, single and party.
TEST(McodeAdapter, FindsDrivesInEveryModeAndSetsTheirLink) {
    for (const char name : {'!', 'a'}) {
        for (int em = 0; em < 4; ++em) {
            for (int ck = 0; ck < 3; ++ck) {
                Bench b({name});
                b.drives[0].em = em;
                b.drives[0].ck = ck;
                b.up();
                b.run(4s);
                EXPECT_TRUE(b.online()) << name << em << ck;
                EXPECT_EQ(b.drives[0].em, 1) << name << em << ck;
                EXPECT_EQ(b.drives[0].ck, 1) << name << em << ck;
                EXPECT_FALSE(has(b.drives[0].received_lines, "S")) << "nothing is saved unasked";
            }
        }
    }
}
TEST(McodeAdapter, WorksInEveryWantedMode) {
    for (int em = 0; em < 4; ++em) {
        for (int ck = 0; ck < 3; ++ck) {
            Bench b;
            b.setup.options = {{"em", std::to_string(em)}, {"ck", std::to_string(ck)}};
            b.up();
            b.run(3s);
            ASSERT_TRUE(b.online()) << em << ck;
            EXPECT_EQ(b.wait(Enable{}).outcome, Outcome::done) << em << ck;
            EXPECT_EQ(b.wait(to(500)).outcome, Outcome::accepted) << em << ck;
            b.run(1s);
            EXPECT_EQ(b.feedback[AxisId{0}].position, 500) << em << ck;
            EXPECT_TRUE(b.feedback[AxisId{0}].target_reached) << em << ck;
            b.drives[0].refuse["DE=0"] = 21;
            const Result r = b.wait(Disable{});
            EXPECT_EQ(r.outcome, Outcome::refused) << em << ck;
            EXPECT_EQ(r.code, 21) << em << ck;
        }
    }
}
TEST(McodeAdapter, WhatWouldMoveIsOverWithAStopInWhateverWordsItWaits) {
    const Point de = *catalogue().find("DE");
    const std::pair<CommandBody, bool> rows[] = {
        // and whether a halt ends it too
        {native("MA 5000"), true},
        {native("sl=400"), true},
        {Action{"MR", "300"}, true},
        {Action{"program.start", ""}, true},
        {Action{"HM", "1"}, true},
        {native("DE=1"), false},
        {Enable{}, false},
        {WriteParameter{de, Value{true}}, false},
        {Action{"program.resume", ""}, true},
    };
    for (const auto& [body, by_halt] : rows) {
        for (const bool halt : {true, false}) {
            Bench b;
            b.up();
            b.run(2s);
            const Ticket before = b.command(ReadParameter{*catalogue().find("VM")});
            const Ticket waits = b.command(body);
            b.drives[0].received_lines.clear();
            const Ticket stop = b.command(halt ? CommandBody{Halt{}} : CommandBody{Disable{}});
            b.run(3s);
            ASSERT_TRUE(b.result(before) && b.result(waits) && b.result(stop));
            const bool over = by_halt || !halt;
            EXPECT_EQ(b.result(waits)->reason == Reason::interrupted, over) << name_of(body) << " halt " << halt;
            const bool received_lines = std::ranges::any_of(b.drives[0].received_lines, [](const std::string& line) {
                return line.starts_with("MA") || line.starts_with("sl") || line.starts_with("MR") || line.starts_with("EX") ||
                       line.starts_with("HM") || line.starts_with("DE=1") || line.starts_with("RS");
            });
            EXPECT_EQ(received_lines, !over) << name_of(body) << " halt " << halt;
        }
    }
}
TEST(McodeAdapter, AStartedDriveIsNotEnabledAndNothingMoves) {
    Bench b;
    b.up();
    b.run(2s);
    EXPECT_EQ(b.feedback[AxisId{0}].power, AxisFeedback::Power::off);
    for (const auto& l : b.drives[0].received_lines)
        EXPECT_FALSE(l.starts_with("MA") || l.starts_with("SL") || l.starts_with("DE")) << l;
}
TEST(McodeAdapter, MoveSetsItsProfileAndAcceptedComesAfterReachedIsWithdrawn) {
    Bench b;
    b.up();
    b.run(2s);
    ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    ASSERT_EQ(b.wait(to(500)).outcome, Outcome::accepted);
    EXPECT_FALSE(b.reached_at_result.back().second);
    b.run(500ms);
    ASSERT_TRUE(b.feedback[AxisId{0}].target_reached);
    Move back = to(-100);
    back.kind = Move::Kind::relative;
    back.velocity = 500;
    ASSERT_EQ(b.wait(back).outcome, Outcome::accepted);
    EXPECT_FALSE(b.reached_at_result.back().second);
    const auto& h = b.drives[0].received_lines;
    for (const char* l : {"VM=4000", "A=20000", "D=20000", "MA 500", "VI=499", "VM=500", "MA 400"})
        EXPECT_TRUE(has(h, l)) << l;
    EXPECT_LT(std::ranges::find(h, "VI=499") - h.begin(), std::ranges::find(h, "VM=500") - h.begin()) << "VI stays below VM";
    EXPECT_FALSE(has(h, "MR -100"));
}
TEST(McodeAdapter, ARefusedValueEndsTheMoveBeforeItStarts) {
    Bench b;
    b.up();
    b.run(2s);
    ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    b.drives[0].refuse["VM=4000"] = 77;
    const Result r = b.wait(to(500));
    EXPECT_EQ(r.outcome, Outcome::refused);
    EXPECT_EQ(r.reason, Reason::drive_refused);
    EXPECT_EQ(r.code, 77);
    EXPECT_FALSE(has(b.drives[0].received_lines, "MA 500"));
}
TEST(McodeAdapter, ALostAcknowledgementIsAskedAfter) {
    Bench b;
    b.up();
    b.run(2s);
    b.drives[0].lose.insert("DE=1");
    EXPECT_EQ(b.wait(Enable{}).outcome, Outcome::done);
}
TEST(McodeAdapter, AStopOvertakesAndInterrupts) {
    Bench b({'a', 'b'});
    b.up();
    b.run(3s);
    ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    std::vector<Ticket> moves;
    for (int i = 0; i < 10; ++i)
        moves.push_back(b.command(to(1000 + i)));
    const auto before = b.sent.size();
    const Ticket stop = b.command(QuickStop{});
    for (const Ticket t : moves) {
        ASSERT_TRUE(b.result(t));
        EXPECT_EQ(b.result(t)->reason, Reason::interrupted);
    }
    b.run(2s);
    ASSERT_TRUE(b.result(stop));
    EXPECT_EQ(b.result(stop)->outcome, Outcome::accepted);
    std::size_t at = before;
    while (at < b.sent.size() && b.sent[at].find("SL 0") == std::string::npos)
        ++at;
    EXPECT_LE(at - before, 0U) << "the first thing behind the exchange in progress";
}
TEST(McodeAdapter, AHomingIsStoppedByTheEscapeCharacterOfThisDriveAlone) {
    Bench b;
    b.up();
    b.run(2s);
    b.drives[0].refuse["SL 0"] = 85;
    EXPECT_EQ(b.wait(Halt{}).outcome, Outcome::accepted);
    EXPECT_TRUE(has(b.sent, "a\x1B"));
    EXPECT_EQ(b.drives[0].values["ES"], "3") << "else the escape would stop every drive of the line";
}
TEST(McodeAdapter, HomingMethods) {
    struct Row {
        std::int16_t method;
        const char* line;
    };
    for (const Row& r : {Row{21, "HM 1"}, Row{22, "HM 2"}, Row{19, "HM 3"}, Row{20, "HM 4"}, Row{33, "HI 1"}, Row{34, "HI 3"},
                         Row{-4, "HM 4"}, Row{-8, "HI 4"}, Row{35, "P=0"}, Row{37, "P=0"}, Row{0, "HM 1"}}) {
        Bench b;
        b.up();
        b.run(2s);
        ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
        EXPECT_TRUE(good(b.wait(Home{r.method}))) << r.method;
        b.run(1s);
        EXPECT_TRUE(has(b.drives[0].received_lines, r.line)) << r.method;
        EXPECT_TRUE(has(b.drives[0].received_lines, "P=0")) << r.method << ": the place that was found is 0";
        EXPECT_TRUE(b.feedback[AxisId{0}].referenced) << r.method;
        EXPECT_TRUE(b.feedback[AxisId{0}].homing_attained) << r.method;
    }
    Bench b;
    b.up();
    b.run(2s);
    ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    EXPECT_EQ(b.wait(Home{1}).reason, Reason::not_supported);
    for (const std::int16_t limit : {std::int16_t{17}, std::int16_t{18}}) {
        const Result r = b.wait(Home{limit});
        EXPECT_EQ(r.reason, Reason::not_supported);
        EXPECT_NE(r.text.find("limit switch"), std::string::npos) << r.text;
    }
}
TEST(McodeAdapter, FaultsAreReadOnceKeptAndReset) {
    Bench b;
    b.up();
    b.run(2s);
    b.drives[0].er = 86;
    b.drives[0].values["ST"] = "1";
    b.run(1s);
    EXPECT_TRUE(b.feedback[AxisId{0}].fault);
    EXPECT_EQ(b.feedback[AxisId{0}].error_code, 86);
    EXPECT_EQ(b.drives[0].er, 0) << "reading has cleared it in the drive";
    EXPECT_EQ(std::ranges::count_if(b.notices, [](const Notice& n) { return n.code == 86; }), 1);
    EXPECT_EQ(b.wait(ResetFault{}).outcome, Outcome::done);
    b.run(500ms);
    EXPECT_TRUE(has(b.drives[0].received_lines, "ST=0"));
    EXPECT_FALSE(b.feedback[AxisId{0}].fault);
}
TEST(McodeAdapter, NoAxisGetsAnothersLateAnswer) {
    Bench b({'a', 'b'});
    b.up();
    b.run(3s);
    b.drives[0].values["P"] = "111";
    b.drives[1].values["P"] = "222";
    b.delay = 400ms;  // every answer comes when the next question has been asked
    b.run(5s);
    b.delay = 2ms;
    b.run(10s);
    EXPECT_EQ(b.feedback[AxisId{0}].position, 111);
    EXPECT_EQ(b.feedback[AxisId{1}].position, 222);
    EXPECT_TRUE(b.online(0));
    EXPECT_TRUE(b.online(1));
}
TEST(McodeAdapter, AfterATimeOutALineWaitsUntilALateAcknowledgementIsOver) {
    Bench b({'a', 'b'});
    b.up();
    b.run(3s);
    b.drives[0].silent = true;
    for (int i = 0; i < 1000 && b.adapter.counters().timeouts == 0; ++i)
        b.run(1ms);
    ASSERT_EQ(b.adapter.counters().timeouts, 1U);
    const Instant asked = b.now;
    (void)b.command(Enable{}, 1);
    while (!has(b.drives[1].received_lines, "DE=1") && b.now - asked < 1s)
        b.run(1ms);
    EXPECT_GE(b.now - asked, 200ms);
    EXPECT_LE(b.now - asked, 550ms) << "one exchange in progress, and the wait";
}
TEST(McodeAdapter, NoiseIsOverWithinOneTimeOut) {
    Bench b;
    b.up();
    b.run(2s);
    b.receive("\xFF\x00#zz12,3\r\ngarbage >?\x06");
    b.drives[0].values["P"] = "77";
    b.run(600ms);
    EXPECT_EQ(b.feedback[AxisId{0}].position, 77);
    EXPECT_TRUE(b.online());
}
TEST(McodeAdapter, ASilentDriveIsNamedAndCostsOneTimeOutPerPause) {
    Bench b({'a', 'b'});
    b.up();
    b.run(3s);
    b.drives[1].silent = true;
    b.run(3s);
    EXPECT_FALSE(b.online(1));
    EXPECT_NE(b.links.back().text.find("d1"), std::string::npos);
    const auto sent = b.sent.size();
    b.run(3s);
    std::size_t to_b = 0;
    for (std::size_t i = sent; i < b.sent.size(); ++i)
        to_b += b.sent[i].find("bPR") != std::string::npos;
    EXPECT_LE(to_b, 4U);
    EXPECT_GE(to_b, 1U);
    EXPECT_EQ(b.wait(Enable{}, 1).reason, Reason::no_answer);
    b.drives[1].silent = false;
    b.run(6s);
    EXPECT_TRUE(b.online(1));
}
TEST(McodeAdapter, NativeLines) {
    Bench b;
    b.up();
    b.run(2s);
    EXPECT_EQ(b.wait(native("PR VM")).text, "768000");
    for (const auto& bad : {std::string(65, 'A'), std::string("MA 1\rMA 2"), std::string("PG 1"), std::string("CK=0"), std::string("")}) {
        const auto before = b.drives[0].received_lines.size();
        const Result r = b.wait(native(bad));
        EXPECT_EQ(r.outcome, Outcome::refused) << bad;
        for (auto i = before; i < b.drives[0].received_lines.size(); ++i)
            EXPECT_NE(b.drives[0].received_lines[i], bad);
    }
    b.drives[0].refuse["XYZ"] = 60;
    EXPECT_EQ(b.wait(native("XYZ")).code, 60);
}
TEST(McodeAdapter, NativeBytesAreTheLineThatTheySpell) {
    Bench b;
    b.up();
    b.run(2s);
    const auto bytes = [](std::string_view s) { return Native{{s.begin(), s.end()}, false}; };
    for (const auto* same : {"PR VM", "PR VM\r", "PR VM\n", "PR VM\r\n"})
        EXPECT_EQ(b.wait(bytes(same)).text, "768000") << same;
    struct Bad {
        std::string_view bytes;
        const char* says;
    };
    using namespace std::string_view_literals;
    for (const Bad& bad :
         {Bad{"PR VM\0"sv, "character 6 is 0x00"}, Bad{"\x80PR VM"sv, "character 1 is 0x80"}, Bad{"MA 1\rMA 2"sv, "character 5 is 0x0D"},
          Bad{"PR VM\r\r"sv, "character 6 is 0x0D"}, Bad{"PR\x7FVM\r\n"sv, "character 3 is 0x7F"}, Bad{"\r\n"sv, "empty"}}) {
        const Result r = b.wait(bytes(bad.bytes));
        EXPECT_EQ(r.outcome, Outcome::refused);
        EXPECT_EQ(r.reason, Reason::out_of_range);
        EXPECT_NE(r.text.find(bad.says), std::string::npos) << r.text;
    }
}
TEST(McodeAdapter, ASlowVelocityTakesViAlong) {
    Bench b;
    b.up();
    b.run(2s);
    ASSERT_TRUE(good(b.wait(Enable{})));
    Move jog;
    jog.kind = Move::Kind::velocity;
    const auto lines = [&](std::int64_t target) {
        const auto before = b.drives[0].received_lines.size();
        jog.target = target;
        EXPECT_TRUE(good(b.wait(jog)));
        std::string reported;
        for (auto i = before; i < b.drives[0].received_lines.size(); ++i) {
            const auto& line = b.drives[0].received_lines[i];
            if (line.find("VI=") != std::string::npos || line.find("SL") != std::string::npos) reported += line + "; ";
        }
        return reported;
    };
    EXPECT_EQ(lines(5000), "SL 5000; ") << "VI is 1000";
    EXPECT_EQ(lines(-427), "VI=427; SL -427; ") << "the drive refuses a speed below VI";
    EXPECT_EQ(lines(-427), "SL -427; ");
    EXPECT_EQ(lines(0), "SL 0; ");
    b.run(3s);
    EXPECT_EQ(lines(600), "VI=600; SL 600; ") << "up with it, no further";
    EXPECT_EQ(lines(0), "SL 0; ");
    b.run(3s);
    EXPECT_EQ(lines(2000), "VI=1000; SL 2000; ") << "as it was set";
    EXPECT_EQ(lines(-3), "VI=3; SL -3; ");
    EXPECT_EQ(lines(0), "SL 0; ");
    b.run(3s);
    const auto before = b.drives[0].received_lines.size();
    (void)b.wait(Home{21});
    const auto first =
        std::find(b.drives[0].received_lines.begin() + static_cast<std::ptrdiff_t>(before), b.drives[0].received_lines.end(), "VI=1000");
    EXPECT_NE(first, b.drives[0].received_lines.end()) << "a search creeps with VI";
}
TEST(McodeAdapter, Parameters) {
    Bench b;
    b.up();
    b.run(2s);
    const auto vm = catalogue().find("VM");
    ASSERT_TRUE(vm);
    EXPECT_EQ(as_integer(b.wait(ReadParameter{*vm}).value), 768000);
    EXPECT_EQ(as_integer(b.wait(WriteParameter{*vm, Value{std::int64_t{5000}}}).value), 5000);
    EXPECT_TRUE(has(b.drives[0].received_lines, "VM=5000"));
    const auto ck = catalogue().find("CK");
    ASSERT_TRUE(ck);
    EXPECT_EQ(b.wait(WriteParameter{*ck, Value{std::int64_t{0}}}).outcome, Outcome::refused);
}
TEST(McodeAdapter, ProgramsAreCheckedSentVerifiedAndRun) {
    Bench b;
    b.up();
    b.run(2s);
    Result r = b.wait(Action{"program.download", "LB AA\nMA 100\nQQ=1\n"});
    EXPECT_EQ(r.outcome, Outcome::refused);
    EXPECT_NE(r.text.find("line 3"), std::string::npos) << r.text;
    EXPECT_FALSE(has(b.drives[0].received_lines, "CP 1")) << "the memory is not touched";
    r = b.wait(Action{"program.download", "LB AA\nMA 100\nH\nE\n"});
    EXPECT_EQ(r.outcome, Outcome::done) << r.text;
    EXPECT_EQ(b.drives[0].program, (std::vector<std::string>{"LB AA", "MA 100", "H", "E"})) << "no poll got into it";
    EXPECT_NE(b.wait(Action{"program.upload", ""}).text.find("MA 100"), std::string::npos);
    EXPECT_EQ(b.wait(Action{"program.start", "AA"}).outcome, Outcome::accepted);
    EXPECT_TRUE(has(b.drives[0].received_lines, "EX AA"));
    EXPECT_EQ(b.wait(Action{"program.save", ""}).outcome, Outcome::done);
    EXPECT_TRUE(has(b.drives[0].received_lines, "S"));
    EXPECT_EQ(b.wait(Action{"no.such", ""}).reason, Reason::unknown_point);
}
/// A stop at every moment of a download, for every way to write its first line: no stop and no poll is stored, the order is kept.
TEST(McodeAdapter, AStopDuringADownloadNeverBecomesProgramText) {
    for (const char* first : {"", "PG 1\n", "PG 100\n", "pg 100\n", "  Pg   7\n"}) {
        for (int kind = 0; kind < 3; ++kind) {
            for (int at = 0; at < 40; ++at) {
                Bench b;
                b.up();
                b.run(2s);
                ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
                const std::string framed = *first ? std::string(first) + "LB AA\nMA 100\nH\nE\nPG\n" : "LB AA\nMA 100\nH\nE\n";
                b.drives[0].received_lines.clear();
                const Ticket download = b.command(Action{"program.download", framed});
                b.run(at * 5ms);
                if (b.result(download)) break;
                const auto before = b.drives[0].received_lines.size();
                const Ticket stop = b.command(kind == 0   ? CommandBody{Halt{}}
                                              : kind == 1 ? CommandBody{QuickStop{}}
                                                          : CommandBody{Disable{}});
                for (int i = 0; i < 200 && !b.result(stop); ++i) {
                    b.run(5ms);
                    for (const auto& l : b.drives[0].program)
                        ASSERT_TRUE(l == "LB AA" || l == "MA 100" || l == "H" || l == "E") << l << " was stored; " << first << at;
                }
                ASSERT_TRUE(b.result(download));
                EXPECT_EQ(b.result(download)->outcome, Outcome::failed) << first << at;
                ASSERT_TRUE(b.result(stop)) << first << kind << at;
                EXPECT_TRUE(good(*b.result(stop))) << b.result(stop)->text << first << kind << at;
                const auto& h = b.drives[0].received_lines;
                const auto reported =
                    std::ranges::find(h.begin() + static_cast<std::ptrdiff_t>(before), h.end(), kind == 2 ? "DE=0" : "SL 0");
                ASSERT_NE(reported, h.end());
                EXPECT_LE(reported - h.begin() - static_cast<std::ptrdiff_t>(before), 1) << "PG and nothing else goes before it";
                b.run(2s);
                EXPECT_FALSE(b.drives[0].in_program) << first << kind << at;
                EXPECT_TRUE(b.drives[0].program.empty()) << "the half is removed; " << first << kind << at;
                EXPECT_TRUE(b.online());
            }
        }
    }
}
TEST(McodeAdapter, ALostPgIsAskedAfterInEveryEchoAndChecksumMode) {
    for (int em = 0; em < 4; ++em) {
        for (int ck = 0; ck < 2; ++ck) {
            for (const char* lost : {"PG 1", "PG", "H"}) {
                Bench b;
                b.setup.options = {{"em", std::to_string(em)}, {"ck", std::to_string(ck)}};
                b.up();
                b.run(3s);
                ASSERT_TRUE(b.online());
                b.drives[0].lose.insert(lost);
                const Ticket download = b.command(Action{"program.download", "LB AA\nMA 100\nH\nE\n"});
                b.run(150ms);
                const Ticket stop = b.command(Halt{});
                b.run(8s);
                ASSERT_TRUE(b.result(download)) << em << ck << lost;
                ASSERT_TRUE(b.result(stop)) << em << ck << lost;
                EXPECT_FALSE(b.drives[0].in_program) << em << ck << lost;
                EXPECT_TRUE(b.online()) << em << ck << lost;
                EXPECT_FALSE(has(b.drives[0].program, "SL 0")) << em << ck << lost;
            }
        }
    }
}
TEST(McodeAdapter, ADriveThatWentAwayInProgramModeIsLedOutWhenItComesBack) {
    Bench b;
    b.up();
    b.run(2s);
    (void)b.command(Action{"program.download", "LB AA\nMA 100\nH\nE\n"});
    for (int i = 0; i < 500 && !b.drives[0].in_program; ++i)
        b.run(1ms);
    ASSERT_TRUE(b.drives[0].in_program);
    b.drives[0].silent = true;
    b.run(3s);
    EXPECT_FALSE(b.online());
    b.drives[0].silent = false;
    b.run(15s);
    EXPECT_TRUE(b.online());
    EXPECT_FALSE(b.drives[0].in_program);
}
TEST(McodeAdapter, ResetRestartsOneDriveAndFindsItAgain) {
    for (const char name : {'!', 'a'}) {
        Bench b({name});
        b.up();
        b.run(2s);
        ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
        EXPECT_EQ(b.wait(Action{"reset", ""}).outcome, Outcome::accepted);
        EXPECT_EQ(b.drives[0].resets, 1);
        b.run(8s);
        EXPECT_TRUE(b.online());
        EXPECT_EQ(b.drives[0].ck, 1) << "its link is set again";
        EXPECT_EQ(b.feedback[AxisId{0}].power, AxisFeedback::Power::off);
    }
    // On a party line by name (CE = 2, set when a drive is found), and only while it means nobody else.
    Bench b({'a', 'b'});
    b.up();
    b.run(3s);
    EXPECT_EQ(b.drives[0].values["CE"], "2");
    EXPECT_EQ(b.wait(Action{"reset", ""}).outcome, Outcome::accepted);
    EXPECT_EQ(b.drives[0].resets, 1);
    EXPECT_EQ(b.drives[1].resets, 0);
    b.run(8s);
    EXPECT_TRUE(b.online());
    EXPECT_EQ(b.drives[0].values["CE"], "2") << "its link is set again";
    for (const std::size_t who : {0U, 1U}) {
        ASSERT_EQ(b.wait(WriteParameter{*catalogue().find("CE"), Value{std::int64_t{1}}}, who).outcome, Outcome::done);
        const Result r = b.wait(Action{"reset", ""});
        EXPECT_EQ(r.outcome, Outcome::refused);
        EXPECT_NE(r.text.find("CE=2"), std::string::npos) << r.text;
        ASSERT_EQ(b.wait(WriteParameter{*catalogue().find("CE"), Value{std::int64_t{2}}}, who).outcome, Outcome::done);
    }
    ASSERT_EQ(b.wait(WriteParameter{*catalogue().find("CE"), Value{std::int64_t{0}}}).outcome, Outcome::done);
    const Result r = b.wait(Action{"reset", ""});
    EXPECT_EQ(r.outcome, Outcome::refused) << "it would not hear";
    EXPECT_NE(r.text.find("CE=0"), std::string::npos) << r.text;
    EXPECT_EQ(b.drives[0].resets + b.drives[1].resets, 1);
}
TEST(McodeAdapter, ABrokenDownloadSaysThatTheMemoryIsCleared) {
    Bench b;
    b.up();
    b.run(2s);
    b.drives[0].lose.insert("H");
    const Result r = b.wait(Action{"program.download", "LB AA\nMA 100\nH\nE\n"});
    EXPECT_EQ(r.outcome, Outcome::failed);
    EXPECT_NE(r.text.find("cleared or incomplete"), std::string::npos) << r.text;
    b.run(2s);
    EXPECT_FALSE(b.drives[0].in_program) << "program mode has been left";
    EXPECT_TRUE(b.online());
}
TEST(McodeAdapter, EveryTicketGetsOneResultWhenTheDriveOrTheLineGoes) {
    for (const bool by_site : {true, false}) {
        Bench b;
        b.up();
        b.run(2s);
        std::vector<Ticket> tickets;
        for (int i = 0; i < 100; ++i)
            tickets.push_back(b.command(Enable{}));
        if (by_site) {
            LineSetup empty = b.setup;
            empty.drives.clear();
            b.adapter.configure(empty, b.now, b.out);
        } else {
            b.adapter.on_line(false, b.now, b.out);
        }
        b.drain();
        b.run(1s);
        for (const Ticket t : tickets)
            EXPECT_EQ(std::ranges::count_if(b.results, [&](const Result& r) { return r.ticket == t; }), 1);
        EXPECT_GT(std::ranges::count_if(b.results, [](const Result& r) { return r.reason == Reason::busy; }), 10);
    }
}
/// A drive that is looked for may be moving: its stop is kept and goes first.
TEST(McodeAdapter, AStopWhileADriveIsLookedForIsSaidWhenItIsFound) {
    for (const bool again : {false, true}) {
        Bench b;
        b.up();
        if (again) {
            b.run(2s);
            b.adapter.on_line(false, b.now, b.out);
            b.adapter.on_line(true, b.now, b.out);
            b.drain();
        }
        const Ticket stop = b.command(Halt{});
        EXPECT_EQ(b.result(stop), nullptr);
        b.run(3s);
        ASSERT_TRUE(b.result(stop)) << again;
        EXPECT_EQ(b.result(stop)->outcome, Outcome::accepted) << b.result(stop)->text;
        EXPECT_TRUE(has(b.drives[0].received_lines, "SL 0")) << again;
    }
    Bench b;
    b.drives[0].silent = true;
    b.up();
    const Ticket stop = b.command(Halt{});
    b.run(3s);
    ASSERT_TRUE(b.result(stop));
    EXPECT_EQ(b.result(stop)->reason, Reason::no_answer);
}
TEST(McodeAdapter, AnErrorCodeThatIsNoNumberHoldsNobodyUp) {
    Bench b;
    b.up();
    b.run(2s);
    ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    b.drives[0].er = 60;
    b.drives[0].er_text = "many";
    const auto before = b.drives[0].received_lines.size();
    b.run(2s);
    b.drives[0].values["P"] = "55";
    b.run(500ms);
    EXPECT_EQ(b.feedback[AxisId{0}].position, 55) << "polls go on";
    EXPECT_LT(std::count_if(b.drives[0].received_lines.begin() + static_cast<std::ptrdiff_t>(before), b.drives[0].received_lines.end(),
                            [](const std::string& l) { return l.ends_with(",ER"); }),
              static_cast<std::ptrdiff_t>(b.drives[0].received_lines.size() - before) * 4 / 5);
    EXPECT_TRUE(b.result(b.command(Halt{})) == nullptr);
    b.run(3s);
    EXPECT_NE(b.results.back().outcome, Outcome::done);
    EXPECT_TRUE(b.online());
}
TEST(McodeAdapter, SingleModeAndPartyModeDoNotMix) {
    Bench b({'!', 'a'});
    b.up();
    ASSERT_FALSE(b.links.empty());
    EXPECT_NE(b.links[0].text.find("alone"), std::string::npos);
}

}  // namespace
}  // namespace axisgate::mcode::test
