// The effect of telegrams, motion commands by name and parameter writes as it is determined before they are sent; and the rates, the
// course, the inputs and the errors that an axis reports.
#include <cmath>
#include <functional>
#include <utility>

#include "adapters/linmot/native.hpp"
#include "adapters/linmot/tests/line_bench.hpp"

namespace axisgate::linmot::test::before_sending {
namespace {
using Kind = Stated::Kind;

Stated of(std::string_view hex) {
    Native n;
    n.send.assign(hex.begin(), hex.end());
    return stated(page(), 1, n);
}
Stated of_action(std::string name, std::string argument) { return stated(page(), 1, Action{std::move(name), std::move(argument), {}}); }

TEST(LinMotStated, TelegramsByTheirGroup) {
    struct Row {
        const char* text;
        Kind kind;
    };
    for (const Row& r : {Row{"01 00", Kind::nothing},
                         {"00 01 3E 00", Kind::nothing},
                         {"00 01 3F 00", Kind::unread},
                         {"00 01 3F 08", Kind::homing},
                         {"00 01 3F 01", Kind::unread},
                         {"00 03 C7 13", Kind::nothing},
                         {"01 05 C7 13 00 00", Kind::nothing},
                         {"00 02 71 01 40 42 0F 00", Kind::nothing},
                         {"00 02 01 20 01 00", Kind::unread},
                         {"00 02 01 04 01 00", Kind::unread},
                         {"00 02 F1 FF", Kind::unread},
                         {"00 09", Kind::unread},
                         {"no hex", Kind::nothing}})
        EXPECT_EQ(of(r.text).kind, r.kind) << r.text;
}

TEST(LinMotStated, MotionCommandsInIncrements) {
    // 010xh: position 20 mm, 0.1 m/s, 1 m/s2, 2 m/s2.
    Stated s = of("00 02 01 01 40 0D 03 00 A0 86 01 00 A0 86 01 00 40 0D 03 00");
    ASSERT_EQ(s.kind, Kind::motion);
    EXPECT_EQ(s.move.kind, Move::Kind::absolute);
    EXPECT_EQ(s.move.target, 200'000);
    EXPECT_EQ(s.move.velocity, 1'000'000);
    EXPECT_EQ(s.move.acceleration, 10'000'000);
    EXPECT_EQ(s.move.deceleration, 20'000'000);
    s = of("00 02 02 02 9C FF FF FF");  // 020xh: predefined rates
    EXPECT_EQ(s.kind, Kind::motion);
    EXPECT_EQ(s.move.target, -100);
    EXPECT_FALSE(s.move.velocity);
    s = of("00 02 01 02 9C FF");
    EXPECT_EQ(s.kind, Kind::unread) << "bytes are missing";
    s = of("01 11 0A 02 00 02 02 02 64 00 00 00 04");  // a complete telegram: length 10 does not fit the rest
    EXPECT_EQ(s.kind, Kind::unread);
    s = of("01 11 09 02 00 02 02 02 64 00 00 00 04");
    EXPECT_EQ(s.kind, Kind::motion) << "a whole telegram";
    EXPECT_EQ(s.move.target, 100);
}

TEST(LinMotStated, ActionsAndParameters) {
    Stated s = of_action("010xh", "position=5 velocity=0.5 acceleration=1 deceleration=1");
    if (s.kind == Kind::unread) s = of_action("010xh", "5 0.5 1 1");
    ASSERT_EQ(s.kind, Kind::motion);
    EXPECT_EQ(s.move.target, 50'000);
    EXPECT_EQ(of_action("017xh", "1").kind, Kind::nothing) << "a stop";
    EXPECT_EQ(of_action("200xh", "3").kind, Kind::unread) << "a command table";
    EXPECT_EQ(of_action("012xh", "5 0.5 1 1").kind, Kind::unread) << "counts from a target that is not known";
    EXPECT_EQ(of_action("table.save", "").kind, Kind::nothing);
    EXPECT_EQ(stated(page(), 1, WriteParameter{*page().find("14BFh"), Value{std::int64_t{700}}}).sets.acceleration, 70'000);
    EXPECT_EQ(stated(page(), 1, WriteParameter{*page().find("14BFh.rom"), Value{std::int64_t{700}}}).sets, DriveRates{});
}

const AxisFeedback& axis(LineBench& b) { return b.feedback[AxisId{0}]; }
void hand(LineBench& b, const std::string& name, Value value) { EXPECT_EQ(b.hand(name, value), ""); }

TEST(LinMotRates, AreReadAtTheStartAndAgainBehindAWrite) {
    LineBench b;
    b.run(2s);
    const DriveRates first = axis(b).rates;
    EXPECT_GT(first.velocity, 0);
    EXPECT_GT(first.acceleration, 0);
    EXPECT_GT(first.deceleration, 0);
    EXPECT_EQ(first.quick_stop, 0) << "no parameter of it is known";
    ASSERT_TRUE(good(b.ask(WriteParameter{*page().find("14BFh"), Value{std::int64_t{70'000}}})));
    b.run(1s);
    EXPECT_EQ(axis(b).rates.acceleration, 7'000'000);
    EXPECT_EQ(axis(b).rates.velocity, first.velocity);
}

TEST(LinMotRates, TheCourseIsThatOfTheMotionThatWasTaken) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(b.enable());
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = 100'000;
    m.acceleration = m.deceleration = 1'000'000;
    ASSERT_TRUE(good(b.ask(m)));
    b.run(200ms);
    EXPECT_EQ(axis(b).course, Course::endless);
    m.kind = Move::Kind::absolute;
    m.target = 1'000'000;
    m.velocity = 100'000;
    ASSERT_TRUE(good(b.ask(m)));
    b.run(100ms);
    EXPECT_EQ(axis(b).course, Course::to_target);
}

TEST(LinMotPower, AnInputThatTakesThePowerTakesTheEnableToo) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(b.enable());
    EXPECT_FALSE(axis(b).safe_stop);
    hand(b, "safe_voltage_enable", Value{false});
    b.run(500ms);
    EXPECT_EQ(axis(b).power, AxisFeedback::Power::off);
    EXPECT_TRUE(axis(b).safe_stop);
    hand(b, "safe_voltage_enable", Value{true});
    b.run(3s);
    EXPECT_EQ(axis(b).power, AxisFeedback::Power::off) << "nobody has enabled it again";
    EXPECT_FALSE(axis(b).safe_stop);
    ASSERT_TRUE(b.enable());
    EXPECT_EQ(axis(b).power, AxisFeedback::Power::on);
}

/// Each way in which bit 0 or 1 of the control word is reset while an error decelerates the motor, with a drive that keeps the error and
/// with one that loses it with its power.
TEST(LinMotPower, AnErrorWhoseBrakingIsCutShortStandsUntilItIsReset) {
    struct Cut {
        const char* what;
        std::function<void(LineBench&)> begin, end;
    };
    const auto panel = [](std::int64_t mask) {
        return [mask](LineBench& b) {
            hand(b, "control_word", Value{std::int64_t{0}});
            hand(b, "control_mask", Value{mask});
        };
    };
    const Cut cuts[] = {{"disable", [](LineBench& b) { EXPECT_TRUE(good(b.ask(Disable{}))); }, [](LineBench&) {}},
                        {"bit 0 by a PC tool", panel(1), panel(0)},
                        {"bit 1 by a PC tool", panel(2), panel(0)},
                        {"safe voltage enable", [](LineBench& b) { hand(b, "safe_voltage_enable", Value{false}); },
                         [](LineBench& b) { hand(b, "safe_voltage_enable", Value{true}); }}};
    for (const char* drive : {"kept", "lost"}) {
        for (const Cut& cut : cuts) {
            SCOPED_TRACE(std::string(drive) + ", " + cut.what);
            LineBench b(1, 115200, {{"braking_error", drive}});
            b.run(2s);
            ASSERT_TRUE(b.enable());
            Move m;
            m.kind = Move::Kind::velocity;
            m.target = 5'000'000;
            m.acceleration = m.deceleration = 50'000'000;
            ASSERT_TRUE(good(b.ask(m)));
            b.run(500ms);
            hand(b, "inject_error", Value{std::int64_t{0x0B}});  // position lag: the motor decelerates first
            for (int i = 0; i < 50 && b.bus->twin(DriveId{0})->mechanics(1, b.now).velocity > 4'900'000; ++i)
                b.run(1ms);
            b.run(15ms);
            ASSERT_TRUE(axis(b).quick_stopping);
            ASSERT_EQ(b.drive().state(), 14);
            hand(b, "inject_error", Value{std::int64_t{0}});  // its cause has ended
            cut.begin(b);
            b.run(500ms);
            EXPECT_EQ(b.drive().state() == 4, drive[0] == 'k') << "what the drive shows";
            EXPECT_TRUE(axis(b).fault);
            if (drive[0] == 'k') EXPECT_EQ(axis(b).error_code, 0x0B);
            cut.end(b);
            b.run(500ms);
            EXPECT_TRUE(axis(b).fault);
            EXPECT_FALSE(b.enable());
            EXPECT_LT(b.drive().state(), 8);
            ASSERT_TRUE(good(b.ask(ResetFault{})));
            b.run(100ms);
            EXPECT_FALSE(axis(b).fault);
            EXPECT_LT(b.drive().state(), 8) << "a reset enables nothing";
            EXPECT_TRUE(b.enable());
        }
    }
}

TEST(LinMotLimits, TheSitesLimitsGoIntoItsRam) {
    for (const bool on : {true, false}) {
        LineBench b(1, 115200, {{"drive_limits", on ? "on" : "off"}});
        auto& axis = b.setup.drives[0].axes[0];
        axis.position_min = -200'000;
        axis.position_max = 300'000;
        Out out;
        b.adapter->configure(b.setup, b.now, out);
        b.run(3s);
        EXPECT_EQ(b.links[DriveId{0}].limits.state, on ? DriveLimits::State::armed : DriveLimits::State::off)
            << b.links[DriveId{0}].limits.text;
        EXPECT_EQ(as_integer(b.ask(ReadParameter{*page().find("146Eh")}).value) == -200'000, on);
        EXPECT_EQ(as_integer(b.ask(ReadParameter{*page().find("146Fh")}).value) == 300'000, on);
    }
    LineBench b;
    b.run(3s);
    EXPECT_EQ(b.links[DriveId{0}].limits, DriveLimits{}) << "the site gives none";
}

TEST(LinMotHoming, APositionThatGetsAnotherNameIsNoSpeed) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(good(b.ask(WriteParameter{*page().find("13C7h"), Value{std::int64_t{500'000}}})));
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(Home{0})));
    for (int i = 0; i < 5000 && !axis(b).homing_attained; ++i) {
        b.run(2ms);
        EXPECT_LT(std::llabs(axis(b).velocity), 2'000'000) << i;
    }
    b.run(500ms);
    EXPECT_TRUE(axis(b).homing_attained);
    EXPECT_EQ(axis(b).position, 500'000);
    EXPECT_EQ(axis(b).position_demand, 500'000);
}

/// Slider, position and demand at each millisecond of two homings and a move after them.
TEST(LinMotHoming, AHomePositionOtherThanZeroMovesNothing) {
    for (const std::int64_t home : {0, 500'000, -1'234'567}) {
        for (const double lag : {0.0, 20.0}) {
            SCOPED_TRACE(std::to_string(home) + (lag > 0 ? ", the slider lags" : ""));
            LineBench b;
            b.run(2s);
            ASSERT_TRUE(good(b.ask(WriteParameter{*page().find("13C7h"), Value{home}})));
            hand(b, "position", Value{std::int64_t{80'000}});
            hand(b, "lag_ms", Value{lag});
            ASSERT_TRUE(b.enable());
            const auto slider = [&] { return b.bus->twin(DriveId{0})->mechanics(1, b.now).position; };
            for (int round = 0; round < 2; ++round) {
                ASSERT_TRUE(good(b.ask(Home{0})));
                double before = slider();
                bool ended = false;
                for (int i = 0; i < 5000; ++i) {
                    b.run(1ms);
                    ASSERT_LE(std::fabs(slider() - before), 500'000 * 0.001 * 1.5) << i << ": 50 mm/s";
                    ASSERT_LE(std::fabs(b.drive().demand() - b.drive().actual()), 500'000 * lag / 1000 + 1)
                        << i << ": no step of the demand";
                    before = slider();
                    if (!std::exchange(ended, axis(b).homing_attained) || axis(b).moving) continue;
                    ASSERT_EQ(axis(b).position, home);
                    ASSERT_EQ(axis(b).position_demand, home);
                    ASSERT_EQ(axis(b).velocity, 0);
                }
                ASSERT_TRUE(axis(b).homing_attained);
                EXPECT_NEAR(slider(), 0, 1) << "at the mechanical reference";
                EXPECT_EQ(b.drive().error_code(), 0);
            }
            Move m;
            m.kind = Move::Kind::relative;
            m.target = 10'000;
            m.velocity = 100'000;
            m.acceleration = m.deceleration = 1'000'000;
            ASSERT_TRUE(good(b.ask(m)));
            b.run(2s);
            EXPECT_NEAR(slider(), 10'000, 1);
            EXPECT_EQ(axis(b).position, home + 10'000);
        }
    }
}

TEST(LinMotMotion, AMoveThatWasAnsweredAsFailedIsNotGoneOnWith) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(b.enable());
    hand(b, "silent", Value{true});  // it receives, and does not answer
    Move m;
    m.target = 3'000'000;
    m.velocity = 100'000;
    m.acceleration = m.deceleration = 1'000'000;
    EXPECT_EQ(b.ask(m).outcome, Outcome::failed);
    hand(b, "silent", Value{false});
    b.run(5s);
    EXPECT_EQ(b.bus->twin(DriveId{0})->mechanics(1, b.now).velocity, 0) << "it was answered as failed, and is halted";
}

}  // namespace
}  // namespace axisgate::linmot::test::before_sending
