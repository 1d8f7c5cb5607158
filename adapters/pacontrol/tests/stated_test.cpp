// What commands of the control, actions and parameter writes are read as before they are sent; what an axis tells of its rates and its
// course; and motions that are ordered behind a quick stop on its way. In: bodies of commands; a control's twin. Out: motions, rates,
// unread.
#include <fstream>
#include <sstream>

#include "adapters/pacontrol/native.hpp"
#include "adapters/pacontrol/tests/rig.hpp"

namespace axisgate::pacontrol::test::before_sending {
namespace {
using Kind = Stated::Kind;

const Catalogue& whole_page() {
    static const Catalogue c = [] {
        std::ifstream in(AXISGATE_SOURCE_DIR "/schema/families/pacontrol.json");
        std::stringstream text;
        text << in.rdbuf();
        std::vector<std::string> faults;
        auto read = Catalogue::parse(text.str(), faults);
        if (!read) std::abort();
        return std::move(*read);
    }();
    return c;
}
Stated of(std::string_view text, int channel = 1) {
    Native n;
    n.send.assign(text.begin(), text.end());
    return stated(whole_page(), channel, n);
}
Stated of_action(std::string name, std::string argument = {}) {
    return stated(whole_page(), 2, Action{std::move(name), std::move(argument), {}});
}

TEST(PaControlStated, Commands) {
    struct Row {
        const char* text;
        Kind kind;
    };
    for (const Row& r : {Row{"1900;5;0;0", Kind::nothing},
                         {"EOT", Kind::nothing},
                         {"0A9A;1;0;0", Kind::nothing},
                         {"0600;0;0;0", Kind::nothing},
                         {"0A98;1;0;0", Kind::nothing},
                         {"0603;0;0;0", Kind::unread},
                         {"0602;0;0;0", Kind::unread},
                         {"0A97;1;0;0", Kind::unread},
                         {"0A84;1;0;0", Kind::homing},
                         {"0A94;1;1;200.5", Kind::motion},
                         {"0A95;1;1;-3.0", Kind::motion},
                         {"0FFF;1;0;0", Kind::unread},
                         {"no command", Kind::nothing}})
        EXPECT_EQ(of(r.text).kind, r.kind) << r.text;
}

TEST(PaControlStated, TargetsRatesAndTheirAxis) {
    Stated s = of("0A94;3;1;200.5");
    EXPECT_EQ(s.move.kind, Move::Kind::absolute);
    EXPECT_EQ(s.move.target, 200'500);
    EXPECT_EQ(s.channel, 3);
    EXPECT_EQ(of("0A94;3;1;200.5", 3).channel, 0) << "the axis that was addressed";
    s = of("0A95;1;1;-3.0");
    EXPECT_EQ(s.move.kind, Move::Kind::relative);
    EXPECT_EQ(s.move.target, -3'000);
    EXPECT_EQ(of("0A8D;1;1;25.0").sets, (DriveRates{25'000, 0, 0, 0}));
    EXPECT_EQ(of("0A8E;1;1;500.0").sets, (DriveRates{0, 500'000, 500'000, 500'000}));
    EXPECT_EQ(of("0800;257;1;80.0").sets.velocity, 80'000) << "parameter 1 of axis 1";
    EXPECT_EQ(of_action("override.speed", "12.5").sets.velocity, 12'500);
    EXPECT_EQ(of_action("manual_move", "by -10").move.target, -10'000);
    EXPECT_EQ(of_action("reference").kind, Kind::homing);
    EXPECT_EQ(of_action("traverse_until_input", "I5=1 to 200.0").kind, Kind::unread);
    EXPECT_EQ(of_action("automatic.start").kind, Kind::unread);
    EXPECT_EQ(of_action("reset_error").kind, Kind::nothing);
    s = of_action("cmd_start_axis_absolut", "50.0");
    EXPECT_EQ(s.kind, Kind::motion);
    EXPECT_EQ(s.move.target, 50'000);
    EXPECT_EQ(s.channel, 0);
}

TEST(PaControlRates, AreThoseOfTheParametersUntilAnOverrideIsAcknowledged) {
    Rig r(1);
    r.run(5s);
    const AxisFeedback& axis = r.feedback[AxisId{0}];
    const DriveRates first = axis.rates;
    EXPECT_GT(first.velocity, 0);
    EXPECT_GT(first.acceleration, 0);
    EXPECT_EQ(first.deceleration, first.acceleration) << "one acceleration for both ramps";
    EXPECT_EQ(first.quick_stop, first.acceleration);
    ASSERT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
    Move m;
    m.target = 400'000;
    m.velocity = 7'000;
    m.acceleration = 90'000;
    ASSERT_EQ(r.ask(m, 0), Outcome::accepted);
    r.run(1s);
    EXPECT_EQ(axis.rates, (DriveRates{7'000, 90'000, 90'000, 90'000}));
    EXPECT_EQ(axis.course, Course::to_target);
}

TEST(PaControlStop, AMotionBehindAQuickStopOnItsWayIsNotCarriedOut) {
    Rig r(1);
    ASSERT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = 10'000;
    ASSERT_EQ(r.ask(m, 0), Outcome::accepted);
    r.run(1s);
    EXPECT_EQ(r.feedback[AxisId{0}].course, Course::endless);
    const Ticket stop = r.command(QuickStop{}, 0);
    r.run(1ms);
    m.target = 5'000;
    const Ticket move = r.command(m, 0);
    EXPECT_EQ(r.answer(stop).outcome, Outcome::accepted);
    EXPECT_EQ(r.answer(move).outcome, Outcome::refused);
    EXPECT_EQ(r.answer(move).reason, Reason::interrupted);
    r.run(3s);
    EXPECT_FALSE(r.feedback[AxisId{0}].moving);
}

}  // namespace
}  // namespace axisgate::pacontrol::test::before_sending
