// The adapter with drives that use what CiA 301 and CiA 402 leave open: a mode that is shown late, a control word that is sampled slowly,
// an acknowledgement that is late or missing, mappings in pre-operational only, slow SDO answers, NMT stop by another master. The twins are
// configured by the freedoms of the page.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "adapters/cia402/tests/manners_bench.hpp"

namespace axisgate::cia402_drive::test {
namespace {
// --- PDOs that are later than SDO answers ------------------------------------------------------------------------------------

TEST(Cia402LateReports, ReportsFromBeforeAnEnableAreNoLossOfPower) {
    Manners b({{"sdo_answer_ms", "1"}, {"reply_ms", "112"}});
    b.run(3s);
    for (int i = 0; i < 2; ++i) {
        ASSERT_TRUE(good(b.ask(Enable{})));
        b.words.clear();
        EXPECT_TRUE(good(b.ask(speed(4000))));
        EXPECT_EQ(b.axis.power, AxisFeedback::Power::on);
        b.run(1s);
        EXPECT_EQ(std::ranges::count(b.words, 0), 0) << "nobody has told it to switch off";
        EXPECT_EQ(b.axis.power, AxisFeedback::Power::on);
        EXPECT_NE(b.axis.velocity, 0);
        ASSERT_TRUE(good(b.ask(QuickStop{})));
        b.run(1s);
        ASSERT_TRUE(good(b.ask(Enable{}))) << "out of the quick stop";
        EXPECT_TRUE(good(b.ask(speed(4000))));
        b.run(1s);
        EXPECT_FALSE(b.axis.quick_stopping);
        EXPECT_NE(b.axis.velocity, 0);
        ASSERT_TRUE(good(b.ask(Disable{})));
        b.run(1s);
        EXPECT_EQ(b.axis.power, AxisFeedback::Power::off);
    }
    ASSERT_TRUE(good(b.ask(Enable{})));
    b.run(500ms);
    b.words.clear();
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "safe_voltage_enable", Value{false}, b.now), "");
    b.run(500ms);
    EXPECT_EQ(b.axis.power, AxisFeedback::Power::off);
    EXPECT_EQ(std::ranges::count(b.words, 0), 1) << "a loss of power is one";
}

// --- 6061h -----------------------------------------------------------------------------------------------------------------

TEST(Cia402LateMode, AModeThatComesLateLosesNoMove) {
    for (const int late : {1, 50, 400, 900}) {
        SCOPED_TRACE(late);
        Manners b({{"mode_shown_ms", std::to_string(late)}});
        b.run(2s);
        ASSERT_TRUE(b.enable());
        ASSERT_TRUE(good(b.ask(speed(5'000)))) << "mode 3";
        b.run(500ms);
        EXPECT_NEAR(b.speed(), 5'000, 1);
        const auto to = static_cast<std::int64_t>(b.place()) + 20'000;
        ASSERT_TRUE(good(b.ask(LineBench::to(to)))) << "mode 1";
        b.run(6s);
        EXPECT_EQ(b.place(), static_cast<double>(to));
        EXPECT_TRUE(b.axis.target_reached);
        EXPECT_FALSE(b.axis.moving);
        ASSERT_TRUE(good(b.ask(Home{35}))) << "mode 6";
        b.run(1s);
        EXPECT_TRUE(b.axis.homing_attained);
        EXPECT_FALSE(b.axis.moving);
    }
}

/// Another master has set halt meanwhile, which this gateway does not know of; the drive drops the order without a word.
TEST(Cia402LateMode, AModeThatTheDriveHasDroppedSilentlyIsOrderedAgain) {
    Manners b({{"mode_refusal", "1"}, {"mode_refusal_silent", "1"}});
    b.run(2s);
    ASSERT_TRUE(b.enable());
    b.deaf = true;
    b.others(canopen::sdo_frame(0x605, 0x2B, {0x6040, 0}, 0x10F));
    b.run(2ms);
    b.deaf = false;
    const Instant begun = b.now;
    bool released = false;
    b.crossed = [&](const Frame& f) {
        b.note(f);
        if (released || b.now < begun + 500ms) return;
        released = true;
        b.others(canopen::sdo_frame(0x605, 0x2B, {0x6040, 0}, 0x0F));
    };
    EXPECT_TRUE(good(b.ask(speed(5'000))));
    b.run(500ms);
    EXPECT_NEAR(b.speed(), 5'000, 1);
    EXPECT_GT(b.now, begun + 1s) << "the first order was dropped";
}

TEST(Cia402LateMode, AModeThatDoesNotComeIsSaidAndDoesNotComeAboutLater) {
    Manners b;
    b.run(2s);
    ASSERT_TRUE(b.enable());
    b.be("mode_shown_ms", 3000);
    const Result r = b.ask(speed(5'000));
    EXPECT_EQ(r.outcome, Outcome::failed);
    EXPECT_NE(r.text.find("6061h"), std::string::npos) << r.text;
    EXPECT_NE(r.text.find("mode_timeout_ms"), std::string::npos) << r.text;
    EXPECT_FALSE(b.axis.moving) << "not for ever";
    for (int i = 0; i < 80; ++i) {
        b.run(100ms);
        ASSERT_EQ(b.speed(), 0) << "what was answered as failed";
        ASSERT_FALSE(b.axis.moving);
    }
    b.be("mode_shown_ms", 0);
    ASSERT_TRUE(good(b.ask(LineBench::to(1000))));
    b.run(2s);
    EXPECT_EQ(b.place(), 1000);
}

TEST(Cia402NmtStop, AStandingNodeIsStartedAgainWhereTheSiteSaysSoThreeTimesAMinuteAtMost) {
    Manners b({}, {{"restart_stopped", "yes"}});
    b.run(2s);
    ASSERT_TRUE(good(b.line("6007:00=0")));
    ASSERT_TRUE(b.enable());
    b.others(canopen::nmt_frame(canopen::NmtCommand::stop, 5));
    b.run(2s);
    EXPECT_EQ(b.reported("nmt_stopped"), 1);
    EXPECT_EQ(b.link.text.find("NMT"), std::string::npos) << b.link.text;
    ASSERT_TRUE(good(b.ask(LineBench::to(1000))));
    b.run(2s);
    EXPECT_EQ(b.place(), 1000);
    constexpr int others = 20;  // the bench counts their frames, too
    b.started = -others;
    for (int n = 0; n < others; ++n) {
        b.others(canopen::nmt_frame(canopen::NmtCommand::stop, 5));
        b.run(1500ms);
    }
    EXPECT_EQ(b.started, 2) << "with the first one three in a minute: two masters that disagree do not fight";
}

TEST(Cia402LateMode, TheSiteMayWaitLonger) {
    Manners b({}, {{"mode_timeout_ms", "10000"}});
    b.run(2s);
    ASSERT_TRUE(b.enable());
    b.be("mode_shown_ms", 6000);
    const Instant asked = b.now;
    ASSERT_TRUE(good(b.ask(speed(5'000))));
    EXPECT_GE(b.now - asked, 6s);
    b.run(500ms);
    EXPECT_NEAR(b.speed(), 5'000, 1);
}

TEST(Cia402LateMode, AStreamBeginsWhereTheAxisIsWhenTheModeIsShown) {
    for (const int late : {0, 30, 500, 900}) {
        for (const bool from_motion : {false, true}) {
            SCOPED_TRACE(fmt::format("{} ms, {}", late, from_motion ? "out of a motion" : "from rest"));
            Manners b;
            b.run(2s);
            ASSERT_TRUE(b.enable());
            if (from_motion) {
                ASSERT_TRUE(good(b.ask(speed(8'000))));
                b.run(1s);
            }
            b.be("mode_shown_ms", late);
            double before = b.place(), most = 0;
            for (int i = 0; i < 400; ++i) {
                b.follow(led_to(1'000'000, 8'000));
                b.run(10ms);
                most = std::max(most, std::fabs(b.place() - before));
                before = b.place();
            }
            EXPECT_LE(most, 8'000 * 0.010 + 2) << "increments in one cycle";
            EXPECT_NEAR(b.speed(), 8'000, 100) << "and it follows";
            EXPECT_TRUE(b.stream_ends.empty());
        }
    }
}

// --- 6040h -----------------------------------------------------------------------------------------------------------------

TEST(Cia402Handshake, ADriveThatSamplesItsControlWordStarts) {
    for (const int every : {1, 2, 5, 10}) {
        for (const int late : {0, 200}) {
            SCOPED_TRACE(fmt::format("each {} ms, acknowledged after {}", every, late));
            Manners b({{"control_sample_ms", std::to_string(every)}, {"acknowledge_ms", std::to_string(late)}});
            b.run(2s);
            ASSERT_TRUE(b.enable());
            for (int i = 1; i <= 8; ++i) {
                const Result r = b.ask(LineBench::to(500 * i));
                ASSERT_TRUE(good(r)) << i << ": " << r.text;
                EXPECT_EQ(r.text.find("bit 12"), std::string::npos) << r.text;
            }
            b.run(3s);
            EXPECT_EQ(b.place(), 4000);
            EXPECT_TRUE(b.axis.target_reached);
            for (int i = 0; i < 3; ++i) {
                ASSERT_TRUE(good(b.ask(Home{37}))) << i;
                b.run(300ms);
                EXPECT_TRUE(b.axis.homing_attained) << i;
            }
            ASSERT_TRUE(good(b.ask(LineBench::to(700)))) << "bit 4 of the homing was taken back before";
            b.run(2s);
            EXPECT_EQ(b.axis.position, 700);
            ASSERT_TRUE(good(b.ask(SetPosition{-5})));
            EXPECT_EQ(b.axis.position, -5);
        }
    }
}

TEST(Cia402Handshake, BitFourStaysUntilItIsAcknowledgedAndGoesBeforeTheNext) {
    Manners b({{"acknowledge_ms", "300"}});
    b.run(2s);
    ASSERT_TRUE(b.enable());
    b.words.clear();
    const Instant asked = b.now;
    ASSERT_TRUE(good(b.ask(LineBench::to(10'000))));
    EXPECT_GE(b.now - asked, 300ms);
    ASSERT_EQ(b.words, (std::vector<std::uint16_t>{0x3F, 0x0F}));
    ASSERT_TRUE(good(b.ask(LineBench::to(-10'000))));
    EXPECT_EQ(b.words, (std::vector<std::uint16_t>{0x3F, 0x0F, 0x3F, 0x0F}));
}

TEST(Cia402Handshake, ADriveThatNeverAcknowledgesMovesAndTheAnswerSaysSo) {
    Manners b({{"acknowledges", "0"}, {"control_sample_ms", "10"}});
    b.run(2s);
    ASSERT_TRUE(b.enable());
    for (int i = 1; i <= 3; ++i) {
        const Instant asked = b.now;
        const Result r = b.ask(LineBench::to(3'000 * i));
        ASSERT_TRUE(good(r)) << r.text;
        EXPECT_NE(r.text.find("bit 12"), std::string::npos) << r.text;
        if (i > 1) EXPECT_LT(b.now - asked, 200ms) << "known by now";
        b.run(2s);
        EXPECT_EQ(b.place(), 3'000 * i);
        EXPECT_TRUE(b.axis.target_reached);
    }
}

TEST(Cia402Handshake, AMotionThatDoesNotBeginIsFailedWithTheStatusWordInWords) {
    Manners b({{"acknowledges", "0"}});
    b.run(2s);
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(WriteParameter{*page().find("6081h"), Value{std::int64_t{0}}})));
    Move m;  // the drive has no velocity: it accepts the set-point and stays at standstill
    m.target = 50'000;
    const Result r = b.ask(m);
    EXPECT_EQ(r.outcome, Outcome::failed) << r.text;
    EXPECT_NE(r.text.find("operation enabled"), std::string::npos) << r.text;
    EXPECT_NE(r.text.find("not acknowledged"), std::string::npos) << r.text;
    EXPECT_FALSE(b.axis.moving);
    b.run(1s);
    EXPECT_FALSE(b.axis.moving);
    ASSERT_TRUE(good(b.ask(WriteParameter{*page().find("6081h"), Value{std::int64_t{10'000}}})));
    b.run(3s);
    EXPECT_EQ(b.place(), 0) << "what was answered as failed does not come about later";
}

TEST(Cia402Handshake, AStopBetweenSetPointAndAcknowledgeEndsTheMotion) {
    Manners b({{"acknowledge_ms", "500"}});
    b.run(2s);
    ASSERT_TRUE(b.enable());
    Command c;
    c.ticket = 900;
    c.axis = AxisId{0};
    c.body = LineBench::to(500'000);
    Out out;
    b.adapter.on_command(c, b.now, out);
    b.forward(out);
    b.run(100ms);
    ASSERT_GT(b.speed(), 0);
    ASSERT_TRUE(good(b.ask(Halt{})));
    b.run(2s);
    EXPECT_EQ(b.speed(), 0);
    EXPECT_EQ(b.words.back(), 0x10F);
    EXPECT_FALSE(b.axis.moving);
    const auto here = static_cast<std::int64_t>(b.place());
    ASSERT_TRUE(good(b.ask(LineBench::to(here + 1000))));
    b.run(1s);
    EXPECT_EQ(b.place(), static_cast<double>(here + 1000));
}

TEST(Cia402Handshake, AFaultIsResetWhereTheControlWordIsSampled) {
    Manners b({{"control_sample_ms", "10"}});
    b.run(2s);
    ASSERT_TRUE(b.enable());
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "inject_error", Value{std::int64_t{0x2310}}, b.now), "");
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "inject_error", Value{std::int64_t{0}}, b.now), "");
    b.run(300ms);
    ASSERT_TRUE(b.axis.fault);
    ASSERT_TRUE(good(b.ask(ResetFault{})));
    b.run(300ms);
    EXPECT_FALSE(b.axis.fault);
    EXPECT_TRUE(b.enable());
}

// --- relative moves ----------------------------------------------------------------------------------------------------------

TEST(Cia402Relative, TheDifferencesOfMovesToTheirTargetsDoNotAddUp) {
    Manners b({{"friction_increments", "2"}});
    b.run(2s);
    ASSERT_TRUE(b.enable());
    const double begin = b.place();
    const auto by = [&](std::int64_t way) {
        Move m = LineBench::to(way);
        m.kind = Move::Kind::relative;
        ASSERT_TRUE(good(b.ask(m)));
        b.run(1s);
        ASSERT_TRUE(b.axis.target_reached);
    };
    for (int i = 0; i < 20; ++i)
        by(1'000);
    EXPECT_NEAR(b.place() - begin, 20'000, 4);
    ASSERT_TRUE(good(b.ask(SetPosition{0}))) << "the target was a number of before";
    const double zero = b.place();
    by(1'000);
    EXPECT_NEAR(b.place() - zero, 1'000, 4);
    ASSERT_TRUE(good(b.ask(LineBench::to(500'000))));
    b.run(300ms);
    ASSERT_TRUE(good(b.ask(Halt{})));
    b.run(1s);
    const double stood = b.place();
    by(1'000);
    EXPECT_NEAR(b.place() - stood, 1'000, 40) << "a target that was not reached counts for nothing";
}

/// The engine checks the limits from the actual position, so the way from the target must not lead farther.
TEST(Cia402Relative, TheLimitsOfTheSiteHoldFromTheTargetAsWell) {
    Manners b({{"friction_increments", "2"}});
    b.setup.drives[0].axes[0].position_max = 10'000;
    b.configure();
    b.run(3s);
    std::vector<std::int64_t> targets;
    b.crossed = [&](const Frame& f) {
        const auto d = f.data();
        if (f.id == 0x605 && d.size() == 8 && d[0] >> 5 == 1 && d[1] == 0x7A && d[2] == 0x60) targets.push_back(signed_of(d.subspan(4)));
    };
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(LineBench::to(9'000))));
    b.run(3s);
    ASSERT_LT(b.axis.position, 9'000) << "it stands before its target";
    Move m = LineBench::to(10'000 - b.axis.position);
    m.kind = Move::Kind::relative;
    ASSERT_TRUE(good(b.ask(m)));
    b.run(2s);
    ASSERT_FALSE(targets.empty());
    EXPECT_EQ(targets.back(), 10'000);
}

// --- mappings, NMT ---------------------------------------------------------------------------------------------------------

TEST(Cia402PdoSetup, ADriveThatMapsInPreOperationalAloneIsBroughtBackAfterARestartOfTheGateway) {
    for (const char* setup : {"0", "1", "2"}) {
        SCOPED_TRACE(setup);
        Manners b({{"pdo_setup", setup}});
        b.run(2s);
        ASSERT_TRUE(b.link.online) << b.link.text;
        b.others(canopen::nmt_frame(canopen::NmtCommand::start, 5));
        ASSERT_TRUE(good(b.line("1A00:00=x00")) == (setup[0] == '0'));  // another tool has changed the node; PDO 1 is enabled
        b.pre_operational = 0;
        b.restart_gateway();
        b.run(3s);
        EXPECT_TRUE(b.link.online) << b.link.text;
        EXPECT_EQ(b.pre_operational, setup[0] == '0' ? 0 : 1) << "once, and only where it is needed";
        b.feedback.clear();
        b.run(500ms);
        EXPECT_GT(b.feedback.size(), 1u) << "its PDOs come";
        ASSERT_TRUE(b.enable());
        ASSERT_TRUE(good(b.ask(LineBench::to(3'000))));
        b.run(2s);
        EXPECT_EQ(b.place(), 3'000);
        for (int i = 0; i < 100; ++i) {
            b.follow(led_to(6'000, 8'000));
            b.run(20ms);
        }
        EXPECT_EQ(b.place(), 6'000) << "and its targets";
    }
}

TEST(Cia402PdoSetup, ANodeThatMovesIsNotSentToPreOperational) {
    for (const char* setup : {"1", "2"}) {
        for (const bool same : {true, false}) {
            SCOPED_TRACE(fmt::format("{}, {}", setup, same ? "PDOs as this gateway sets them" : "PDOs of others"));
            Manners b({{"pdo_setup", setup}});  // it monitors the heartbeat of the gateway before, and goes on with that of this one
            b.run(2s);
            ASSERT_TRUE(b.enable());
            ASSERT_TRUE(good(b.ask(speed(8'000))));
            b.run(1s);
            b.pre_operational = 0;
            if (!same) {  // written by another master before
                b.others(canopen::nmt_frame(canopen::NmtCommand::pre_operational, 5));
                b.deaf = true;
                b.run(1ms);
                b.others(canopen::sdo_frame(0x605, 0x23, {0x1800, 1}, 0x80000185));
                b.run(1ms);
                b.others(canopen::sdo_frame(0x605, 0x2F, {0x1A00, 0}, 0));
                b.run(1ms);
                b.others(canopen::sdo_frame(0x605, 0x23, {0x1A00, 1}, 0x60640020));
                b.run(1ms);
                b.others(canopen::sdo_frame(0x605, 0x2F, {0x1A00, 0}, 1));
                b.run(1ms);
                b.others(canopen::nmt_frame(canopen::NmtCommand::start, 5));
                b.run(1ms);
                b.deaf = false;
                b.pre_operational = 0;
            }
            b.feedback.clear();
            b.restart_gateway();
            b.run(3s);
            EXPECT_EQ(b.pre_operational, 0);
            EXPECT_NEAR(b.speed(), 8'000, 1) << "it goes on undisturbed";
            EXPECT_TRUE(b.link.online) << b.link.text;
            ASSERT_GT(b.feedback.size(), 10u) << "and is watched";
            EXPECT_TRUE(b.axis.moving);
            EXPECT_EQ(b.axis.velocity, 8'000);
            EXPECT_NEAR(static_cast<double>(b.axis.position), b.place(), 8'000 * 0.2);
            ASSERT_TRUE(good(b.ask(QuickStop{})));
            b.run(3s);
            EXPECT_EQ(b.speed(), 0);
            EXPECT_EQ(b.pre_operational, same ? 0 : 1) << "now it stands";
            ASSERT_TRUE(b.enable());
            ASSERT_TRUE(good(b.ask(LineBench::to(0))));
            b.run(5s);
            EXPECT_EQ(b.place(), 0);
        }
    }
}

TEST(Cia402NmtStop, ATurningNodeThatSomebodyStopsIsWatchedToldAndStoppedByAStop) {
    for (const bool heartbeat : {true, false}) {
        for (const bool quick : {true, false}) {
            SCOPED_TRACE(fmt::format("{} heartbeat, {}", heartbeat ? "with" : "without", quick ? "quick stop" : "halt"));
            Manners b({}, {{"watchdog_action", "none"}, {"heartbeat_ms", heartbeat ? "500" : "0"}});
            b.run(2s);
            ASSERT_TRUE(good(b.line("6007:00=0"))) << "it does not stop by itself";
            ASSERT_TRUE(b.enable());
            ASSERT_TRUE(good(b.ask(speed(8'000))));
            b.run(1s);
            b.others(canopen::nmt_frame(canopen::NmtCommand::stop, 5));
            b.run(4s);
            EXPECT_TRUE(b.link.online) << b.link.text;
            EXPECT_NEAR(b.speed(), 8'000, 1);
            EXPECT_TRUE(b.axis.moving);
            if (heartbeat) EXPECT_GE(b.reported("nmt_stopped"), 1) << "it is told";
            EXPECT_NEAR(static_cast<double>(b.axis.position), b.place(), 8'000 * 0.2) << "and watched";
            b.others(canopen::nmt_frame(canopen::NmtCommand::stop, 5));
            b.run(1ms);
            const Instant asked = b.now;
            const Result r = quick ? b.ask(QuickStop{}) : b.ask(Halt{});
            EXPECT_TRUE(good(r)) << r.text;
            EXPECT_LT(b.now - asked, 400ms);
            b.run(2s);
            EXPECT_EQ(b.speed(), 0);
        }
    }
}

TEST(Cia402NmtStop, AnOrderBehindTheStartWaitsForTheStateThatTheDriveHasThen) {
    for (const auto& [setup, later] : {std::pair{"0", 520ms}, {"4", 100ms}, {"4", 300ms}, {"4", 500ms}, {"4", 700ms}}) {
        SCOPED_TRACE(testing::Message() << setup << ", " << later.count());
        Manners b({{"pdo_setup", setup}, {"sdo_answer_ms", "100"}}, {{"watchdog_action", "disable"}});
        b.run(6s);
        ASSERT_TRUE(b.enable());
        b.run(1s);
        b.others(canopen::nmt_frame(canopen::NmtCommand::stop, 5));
        b.run(3s);
        ASSERT_TRUE(good(b.ask(Action{"nmt_start", {}, {}})));
        b.run(later);  // its heartbeat tells that it is back
        const Result r = b.ask(LineBench::to(1000));
        EXPECT_EQ(r.reason, Reason::wrong_state) << "it has lost its power meanwhile";
        EXPECT_NE(r.text.find("enable"), std::string::npos) << r.text;
        ASSERT_TRUE(b.enable());
        ASSERT_TRUE(good(b.ask(LineBench::to(1000))));
        b.run(3s);
        EXPECT_EQ(b.place(), 1000);
    }
}

TEST(Cia402NmtStop, AStandingNodeIsLeftStoppedAndIsNotGivenUp) {
    Manners b;
    b.run(2s);
    ASSERT_TRUE(good(b.line("6007:00=0")));
    ASSERT_TRUE(b.enable());
    b.others(canopen::nmt_frame(canopen::NmtCommand::stop, 5));
    b.run(1s);
    b.started = 0;
    b.run(5s);
    EXPECT_EQ(b.started, 0) << "somebody is at work there";
    EXPECT_TRUE(b.link.online) << b.link.text;
    EXPECT_NE(b.link.text.find("NMT"), std::string::npos) << b.link.text;
    EXPECT_EQ(b.reported("nmt_stopped"), 1);
    const Result r = b.ask(LineBench::to(1000));
    EXPECT_EQ(r.reason, Reason::wrong_state);
    EXPECT_NE(r.text.find("nmt_start"), std::string::npos) << r.text;
    ASSERT_TRUE(good(b.ask(Action{"nmt_start", {}, {}})));
    b.run(1s);
    EXPECT_EQ(b.link.text.find("NMT"), std::string::npos) << b.link.text;
    ASSERT_TRUE(good(b.ask(LineBench::to(1000))));
    b.run(2s);
    EXPECT_EQ(b.place(), 1000);
}

TEST(Cia402NmtStop, AGatewayThatStartsFindsANodeThatIsStopped) {
    Manners b;
    b.run(2s);
    b.others(canopen::nmt_frame(canopen::NmtCommand::stop, 5));
    b.run(100ms);
    b.restart_gateway();
    b.run(6s);
    EXPECT_TRUE(b.link.online) << b.link.text;
    EXPECT_TRUE(b.enable());
}

// --- SDO -------------------------------------------------------------------------------------------------------------------

TEST(Cia402SlowAnswers, ASlowDriveIsOneNodeAndIsServed) {
    for (const int slow : {1, 40, 70, 150, 400}) {
        SCOPED_TRACE(slow);
        Manners b({{"sdo_answer_ms", std::to_string(slow)}});
        b.run(60s);
        ASSERT_TRUE(b.link.online) << b.link.text;
        ASSERT_TRUE(good(b.ask(Enable{}, 60s)));
        for (int i = 1; i <= 3; ++i) {
            ASSERT_TRUE(good(b.ask(LineBench::to(2000 * i), 60s)));
            b.run(2s);
            EXPECT_TRUE(b.link.online) << b.link.text;
            EXPECT_EQ(b.place(), 2000 * i);
        }
        EXPECT_EQ(b.reported("two_nodes"), 0);
    }
}

TEST(Cia402SlowAnswers, ADriveThatBecomesSlowInAMoveIsNotDropped) {
    for (const int slow : {70, 200, 400}) {
        SCOPED_TRACE(slow);
        Manners b;
        b.run(2s);
        ASSERT_TRUE(b.enable());
        ASSERT_TRUE(good(b.ask(LineBench::to(100'000))));
        b.run(500ms);
        b.be("sdo_answer_ms", slow);
        const auto before = b.feedback.size();
        for (int i = 0; i < 30; ++i) {
            const Result r = b.ask(ReadParameter{*page().find(i % 2 ? "6081h" : "6083h")});
            EXPECT_TRUE(good(r)) << i << ": " << r.text;
            EXPECT_EQ(as_integer(r.value), i % 2 ? 10'000 : 50'000) << "a late answer is not taken for another question's";
        }
        EXPECT_GT(b.feedback.size(), before + 50);
        EXPECT_TRUE(b.link.online) << b.link.text;
        EXPECT_EQ(b.reported("two_nodes"), 0);
        EXPECT_TRUE(good(b.ask(Halt{})));
        b.run(1s);
        EXPECT_EQ(b.speed(), 0);
        b.be("sdo_answer_ms", 0);
        b.run(2s);
        ASSERT_TRUE(good(b.ask(LineBench::to(0))));
        b.run(15s);
        EXPECT_EQ(b.place(), 0);
        EXPECT_EQ(b.reported("two_nodes"), 0);
    }
}

TEST(Cia402SlowAnswers, AnAnswerToAQuestionThatWasGivenUpIsIgnoredAndCounted) {
    Manners b;
    b.setup.timing.reply_timeout = 20ms;
    b.setup.timing.retries = 0;
    b.configure();
    b.run(2s);
    b.be("sdo_answer_ms", 60);
    const auto unexpected = b.adapter.counters().unexpected;
    const Result r = b.ask(ReadParameter{*page().find("6081h")});
    EXPECT_EQ(r.reason, Reason::no_answer) << r.text;
    b.be("sdo_answer_ms", 0);
    b.run(200ms);
    EXPECT_GT(b.adapter.counters().unexpected, unexpected);
    EXPECT_EQ(as_integer(b.ask(ReadParameter{*page().find("6083h")}).value), 50'000);
    EXPECT_EQ(as_integer(b.ask(ReadParameter{*page().find("6081h")}).value), 10'000);
    EXPECT_TRUE(b.link.online);
}

TEST(Cia402SlowAnswers, AStopDoesNotWaitForAnAnswerThatIsLost) {
    Manners b;
    b.run(2s);
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(speed(8'000))));
    b.run(1s);
    b.deaf = true;  // the request is lost
    Command c;
    c.ticket = 901;
    c.axis = AxisId{0};
    c.body = ReadParameter{*page().find("6081h")};
    Out out;
    b.adapter.on_command(c, b.now, out);
    b.run(1ms);
    b.deaf = false;
    const Instant asked = b.now;
    ASSERT_TRUE(good(b.ask(QuickStop{})));
    EXPECT_LT(b.now - asked, 100ms);
    b.deaf = true;  // the stop itself is lost, too
    c.ticket = 902;
    c.body = Halt{};
    out.clear();
    b.adapter.on_command(c, b.now, out);
    b.run(1ms);
    b.deaf = false;
    b.run(100ms);
    ASSERT_EQ(b.results[902].size(), 1u) << "it is repeated";
    EXPECT_TRUE(good(b.results[902][0]));
}

}  // namespace
}  // namespace axisgate::cia402_drive::test
