// A party line from fresh drives: line.setup, with real twins in factory state that a hand powers up one after the other.
// In: drives at `!`, 9600 bit/s. Out: drives with names, party mode and checksums, kept or not kept as asked.
#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

void power_all_off(LineBench& b, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i)
        b.hand(i, "power", Value{false});
}

TEST(McodeLineSetup, FreshDrivesGetTheirNamesOneAfterTheOtherAndKeepThem) {
    for (const bool save : {true, false}) {
        LineBench b("aD7", 9600, {}, "!!!");
        power_all_off(b, 3);
        b.run(3s);
        for (std::size_t i = 0; i < 3; ++i) {
            b.hand(i, "power", Value{true});
            b.run(1s);
            const Result r = b.wait(Action{"line.setup", save ? "save" : ""}, i);
            EXPECT_EQ(r.outcome, Outcome::done) << i << r.text;
            EXPECT_NE(r.text.find(save ? "has saved" : "program.save"), std::string::npos) << r.text;
            b.run(6s);  // its echo has disturbed the others until it had its name
            for (std::size_t k = 0; k < 3; ++k)
                EXPECT_EQ(b.online(k), k <= i) << i << ' ' << k;
        }
        if (!save) EXPECT_TRUE(std::ranges::none_of(b.sent, [](const auto& s) { return s.bytes.size() > 1 && s.bytes[1] == 'S'; }));
        power_all_off(b, 3);
        b.run(6s);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_FALSE(b.online(i));
        const auto before = b.sent.size();
        for (std::size_t i = 0; i < 3; ++i)
            b.hand(i, "power", Value{true});
        b.run(20s);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_EQ(b.online(i), save) << i;
        if (save) {
            for (std::size_t i = before; i < b.sent.size(); ++i)
                EXPECT_EQ(b.sent[i].bytes.find("CK="), std::string::npos) << "the checksum mode was kept too";
        }
    }
}
TEST(McodeLineSetup, TwoFreshDrivesAtOnceOrNoneIsSaid) {
    for (const std::size_t powered : {std::size_t{0}, std::size_t{2}}) {
        LineBench b("ab", 9600, {}, "!!");
        power_all_off(b, 2);
        for (std::size_t i = 0; i < powered; ++i)
            b.hand(i, "power", Value{true});
        b.run(3s);
        const Result r = b.wait(Action{"line.setup", "save"}, 0, 20s);
        EXPECT_EQ(r.outcome, Outcome::failed) << powered;
        EXPECT_NE(r.text.find("power up one alone"), std::string::npos) << r.text;
    }
}
TEST(McodeLineSetup, AStopOfAnotherDriveGoesBeforeItsNextStep) {
    LineBench b("ba", 9600, {}, "ba");
    b.hand(0, "power", Value{false});
    b.run(6s);
    ASSERT_TRUE(b.online(1));
    (void)b.command(Action{"line.setup", "save"}, 0);
    b.run(50ms);
    const auto before = b.sent.size();
    const Ticket stop = b.command(Halt{}, 1);
    b.run(3s);
    ASSERT_GT(b.sent.size(), before);
    EXPECT_TRUE(b.sent[before].bytes.starts_with("aSL 0")) << b.sent[before].bytes;
    ASSERT_TRUE(b.result(stop));
    EXPECT_EQ(b.result(stop)->outcome, Outcome::accepted);
}
TEST(McodeLineSetup, ANameThatAnswersIsNotGivenAgain) {
    LineBench b("ab", 9600, {}, "a!");
    b.hand(1, "power", Value{false});
    b.run(6s);
    ASSERT_TRUE(b.online(0));
    const auto before = b.sent.size();
    EXPECT_EQ(b.wait(Action{"line.setup", "save"}, 0).reason, Reason::wrong_state);
    for (std::size_t i = before; i < b.sent.size(); ++i)
        EXPECT_EQ(b.sent[i].bytes.find("DN="), std::string::npos);
    EXPECT_EQ(b.wait(Action{"line.setup", "sometimes"}, 1).reason, Reason::out_of_range);
    b.hand(1, "power", Value{true});
    EXPECT_EQ(b.wait(Action{"line.setup", "save"}, 1).outcome, Outcome::done) << "beside a drive that works";
    b.run(6s);
    EXPECT_TRUE(b.online(0));
    EXPECT_TRUE(b.online(1));
}

}  // namespace
}  // namespace axisgate::mcode::test
