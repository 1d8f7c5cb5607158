// What the language makes special on a party line, with real twins: a program that waits for input, group orders, settings sent again.
// In: commands. Out: what the drives did, and what the adapter says that they cannot do.
#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

TEST(McodeParty, AProgramThatWaitsForInputTakesNoPollForIt) {
    for (const std::string_view names : {"ab", "!"}) {
        LineBench b(names, 19200);
        b.run(6s);
        ASSERT_TRUE(b.online());
        ASSERT_EQ(b.wait(Action{"program.download", "LB AA\nR1=7\nIV R1\nLB X2\nBR X2,IF=1\nR2=R1\nE\n"}).outcome, Outcome::done);
        ASSERT_EQ(b.wait(Action{"program.start", "AA"}).outcome, Outcome::accepted);
        const auto polls = b.adapter.counters().exchanges;
        b.run(3s);
        EXPECT_GT(b.adapter.counters().exchanges, polls + 20) << "it is polled all the time";
        EXPECT_EQ(b.wait(line("PR R1")).text, "7") << "and no poll became the number";
        EXPECT_EQ(std::ranges::count_if(b.notices, [](const Notice& n) { return n.kind == "input"; }), 1);
        EXPECT_NE(b.feedback[AxisId{0}].native_status & 256U, 0U);
        EXPECT_EQ(b.wait(line("42")).outcome, Outcome::done);
        b.run(1s);
        EXPECT_EQ(b.feedback[AxisId{0}].native_status & 256U, 0U);
        EXPECT_EQ(b.wait(line("PR R2")).text, "42");
        EXPECT_TRUE(b.online());
    }
}

TEST(McodeParty, StartTogetherIsRefusedWithItsReason) {
    LineBench b("ab", 19200);
    b.run(6s);
    ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    Move m;
    m.target = 1000;
    m.prepare_only = true;
    const Result prepared = b.wait(m);
    EXPECT_EQ(prepared.reason, Reason::not_supported);
    StartTogether both;
    both.axes = {AxisId{0}, AxisId{1}};
    const auto before = b.sent.size();
    const Result r = b.wait(both);
    EXPECT_EQ(r.outcome, Outcome::refused);
    EXPECT_EQ(r.reason, Reason::not_supported);
    for (const auto& text : {prepared.text, r.text})
        EXPECT_NE(text.find("EX"), std::string::npos) << "what can be done instead: " << text;
    for (auto i = before; i < b.sent.size(); ++i)
        EXPECT_EQ(b.sent[i].bytes.find("MA "), std::string::npos);
}

/// Outputs and inputs of the real drive's rules: the same setting sent again is no error.
TEST(McodeParty, IoSettingsMayBeWrittenAgain) {
    LineBench b("a", 19200);
    b.run(4s);
    ASSERT_TRUE(b.online());
    for (const char* text : {"IS=1,0,1", "IS=1,0,1", "OS=1,16,1", "OS=1,16,1"})
        EXPECT_EQ(b.wait(line(text)).outcome, Outcome::done) << text;
}

}  // namespace
}  // namespace axisgate::mcode::test
