// What lines of instructions, their bytes, actions and parameter writes are read as before they are sent.
// In: bodies of commands. Out: the motion, the rates, or that it cannot be read. No drive is needed.
#include "adapters/uim342/native.hpp"
#include "adapters/uim342/tests/fake_bench.hpp"

namespace axisgate::uim342::test::before_sending {
namespace {
using Kind = Stated::Kind;

Stated of(std::string_view text) {
    Native n;
    n.send.assign(text.begin(), text.end());
    return stated(catalogue(), 1, n);
}
Stated of(std::vector<std::uint8_t> bytes) { return stated(catalogue(), 1, Native{std::move(bytes), false}); }
Stated of_action(std::string name, std::string argument = {}) {
    return stated(catalogue(), 1, Action{std::move(name), std::move(argument), {}});
}
Stated of_write(std::string_view id, std::int64_t value) {
    return stated(catalogue(), 1, WriteParameter{*catalogue().find(id), Value{value}});
}

TEST(Uim342Stated, LinesThatBeginNothing) {
    for (const char* line : {"MS[0]", "MO", "MO=0", "ST", "OG", "PA=1000", "JV=500", "SP=200", "IC[6]=1", "MS[0]=0", "ER[0]=0", "ST;MO=1",
                             "DI=1", "IL[0]=0x0202", "TG[0]=20", "SY[2]", "no line"})
        EXPECT_EQ(of(line).kind, Kind::nothing) << line;
}

TEST(Uim342Stated, LinesThatCannotBeRead) {
    for (const char* line : {"BG", "MO=1", "PA=5;MO=1", "SY[1]", "IL[0]=0x0800", "IL[2]=0x000B"})
        EXPECT_EQ(of(line).kind, Kind::unread) << line;
}

TEST(Uim342Stated, MotionsAreReadWithTheirValues) {
    Stated s = of("PA=-1000;SP=300;AC=4000;BG");
    ASSERT_EQ(s.kind, Kind::motion);
    EXPECT_EQ(s.move.kind, Move::Kind::absolute);
    EXPECT_EQ(s.move.target, -1000);
    EXPECT_EQ(s.move.velocity, 300);
    EXPECT_EQ(s.move.acceleration, 4000);
    EXPECT_FALSE(s.move.deceleration);
    EXPECT_EQ(s.sets.velocity, 300);
    s = of("PR=250;BG");
    EXPECT_EQ(s.move.kind, Move::Kind::relative);
    EXPECT_EQ(s.move.target, 250);
    s = of("JV=-700;BG");
    EXPECT_EQ(s.kind, Kind::motion);
    EXPECT_EQ(s.move.kind, Move::Kind::velocity);
    EXPECT_EQ(s.move.target, -700);
    EXPECT_FALSE(s.move.velocity);
}

TEST(Uim342Stated, TheBytesOfMessagesAreReadAsTheirText) {
    const Stated s = of({0x9D, 4, 0x44, 0xFD, 0xFF, 0xFF, 0x96, 0});  // JV=-700, BG
    EXPECT_EQ(s.kind, Kind::motion);
    EXPECT_EQ(s.move.target, -700);
    EXPECT_EQ(of({0x16, 0}).kind, Kind::unread) << "a BG whose target is in the drive";
    EXPECT_EQ(of({0x91, 1, 0}).kind, Kind::nothing) << "MS[0]";
    EXPECT_EQ(of({0x99, 2, 0xE8, 0x03}).sets.acceleration, 1000) << "short data words are zero-extended";
    EXPECT_EQ(of({0x42, 0}).kind, Kind::unread) << "no instruction of the manual";
}

TEST(Uim342Stated, RatesOfLaterMotions) {
    EXPECT_EQ(of("AC=1000;DC=2000").sets, (DriveRates{0, 1000, 2000, 0}));
    EXPECT_EQ(of("SD=9000").sets.quick_stop, 9000);
    EXPECT_EQ(of("MF=3;AC=1000").sets, DriveRates{}) << "of an input's group";
    EXPECT_EQ(of("MF=3;PA=1000;BG").kind, Kind::unread) << "the target was the group's";
    EXPECT_EQ(of_write("DC", 700).sets.deceleration, 700);
    EXPECT_EQ(of_write("MO", 1).kind, Kind::nothing) << "it goes behind an ST";
}

TEST(Uim342Stated, Actions) {
    EXPECT_EQ(of_action("reboot").kind, Kind::unread);
    EXPECT_EQ(of_action("clear_status").kind, Kind::nothing);
    EXPECT_EQ(of_action("start_group", "20").kind, Kind::unread);
    EXPECT_EQ(of_action("global_stop").kind, Kind::nothing);
    EXPECT_EQ(of_action("begin_motion").kind, Kind::unread);
    EXPECT_EQ(of_action("acceleration", "123").sets.acceleration, 123);
}

}  // namespace
}  // namespace axisgate::uim342::test::before_sending
