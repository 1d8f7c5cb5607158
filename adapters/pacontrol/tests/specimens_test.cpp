// Controls that close the gaps of the manual in other ways than the embedded control does by itself: without switching commands, late with
// their status, busy after a change of mode, acknowledging a reference run when it begins.
#include <cmath>

#include "adapters/pacontrol/tests/rig.hpp"

namespace axisgate::pacontrol::test {
namespace {

bool has_sent(const Rig& r, const std::string& code) {
    return std::ranges::any_of(r.handed, [&](const Rig::Handed& h) { return h.text.starts_with(code); });
}

Move way_of(std::int64_t increments) {
    Move m;
    m.kind = Move::Kind::relative;
    m.target = increments;
    m.velocity = 10'000;
    return m;
}

TEST(PacontrolSpecimens, AnAxisThatTheControlDoesNotSwitchIsServedAndStoppedByItself) {
    for (const char* switching : {"0", "2"}) {
        SCOPED_TRACE(switching);
        Rig r(2, {{"switching_commands", switching}});
        EXPECT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
        EXPECT_NE(r.notice_of("power").find("does not switch it on or off"), std::string::npos) << r.notice_of("power");
        for (const CommandBody& stop : {CommandBody{QuickStop{}}, CommandBody{Disable{}}}) {
            EXPECT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
            EXPECT_EQ(r.ask(way_of(100'000), 0), Outcome::accepted);
            r.run(1s);
            EXPECT_TRUE(r.axis(0).running());
            const Result stopped = r.answer(r.command(stop, 0));
            const bool off = std::holds_alternative<Disable>(stop);
            EXPECT_EQ(stopped.outcome, off ? Outcome::failed : Outcome::accepted) << stopped.text;
            r.run(2s);
            EXPECT_FALSE(r.axis(0).running());
            if (off) EXPECT_NE(stopped.text.find("keeps its power"), std::string::npos) << stopped.text;
        }
        EXPECT_FALSE(has_sent(r, "0600")) << "the other axis is not stopped with it";
        EXPECT_EQ(r.feedback[AxisId{0}].power, AxisFeedback::Power::on) << "it is not shown as off, because it is not";
    }
}

TEST(PacontrolSpecimens, AReplyCheckThatIsAlwaysZeroIsTaken) {
    Rig r(2, {{"reply_check_form", "2"}});
    r.move_all(2);
    r.run(60s);
    for (const Notice& n : r.notices)
        EXPECT_NE(n.kind, "protocol") << n.text;
}

TEST(PacontrolSpecimens, ACommandThatIsRefusedAfterAChangeOfModeIsRepeated) {
    Rig r(1, {{"busy_ms", "500"}});
    EXPECT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
    EXPECT_EQ(r.notice_of("power"), "") << "15h was \"not yet\": the axis has a switch";
    EXPECT_EQ(r.ask(way_of(5'000), 0), Outcome::accepted);
    EXPECT_EQ(r.ask(Disable{}, 0), Outcome::accepted);
    EXPECT_FALSE(r.axis(0).state().enabled() && !r.axis(0).state().off);
}

TEST(PacontrolSpecimens, AMotionWaitsForAnAxisThatIsNotOnYet) {
    for (const char* awaited : {"0", "1"}) {
        Rig r(1, {{"axis_on_ms", "800"}, {"axis_on_acknowledged", awaited}});
        EXPECT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
        EXPECT_EQ(r.ask(Disable{}, 0), Outcome::accepted);
        EXPECT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
        EXPECT_EQ(r.ask(way_of(5'000), 0), Outcome::accepted) << awaited;
    }
}

TEST(PacontrolSpecimens, AReferenceRunThatIsAcknowledgedAtOnceIsWatchedToItsEnd) {
    for (const char* shown : {"0", "1"}) {
        SCOPED_TRACE(shown);
        Rig r(1, {{"reference_acknowledged", "1"}, {"reference_status", shown}});
        EXPECT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
        EXPECT_EQ(r.answer(r.command(way_of(20'000), 0, true)).outcome, Outcome::done);
        const Result home = r.answer(r.command(Home{}, 0, true));
        EXPECT_EQ(home.outcome, Outcome::done) << home.text;
        EXPECT_TRUE(r.axis(0).state().referenced);
        EXPECT_FALSE(r.axis(0).running());
        EXPECT_TRUE(r.feedback[AxisId{0}].homing_attained);
    }
}

TEST(PacontrolSpecimens, AStatusThatFollowsLateDoesNotEndAMotion) {
    for (const std::map<std::string, std::string>& late :
         {std::map<std::string, std::string>{{"status_late_ms", "500"}}, {{"position_every_ms", "500"}}, {{"motion_start_ms", "500"}}}) {
        SCOPED_TRACE(late.begin()->first);
        Rig r(1, late);
        EXPECT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
        for (const std::int64_t way : {20'000, -20'000}) {
            const double from = r.axis(0).shaft().place(r.now);
            const Result done = r.answer(r.command(way_of(way), 0, true));
            EXPECT_EQ(done.outcome, Outcome::done) << done.text;
            EXPECT_NEAR(r.axis(0).shaft().place(r.now) - from, static_cast<double>(way) / 1000, 0.01);
            EXPECT_NEAR(static_cast<double>(r.feedback[AxisId{0}].position), (way > 0 ? 20'000 : 0), 50);
        }
    }
}

TEST(PacontrolSpecimens, AControlThatInitialisesIsWaitedFor) {
    Rig r(1, {{"initialise_ms", "6000"}});
    EXPECT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
    r.handed.clear();
    r.run(5s);
    EXPECT_TRUE(has_sent(r, "1921")) << "34h does not mean that the control lacks a command";
}

}  // namespace
}  // namespace axisgate::pacontrol::test
