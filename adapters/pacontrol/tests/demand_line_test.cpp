// Where an axis should be, as the embedded control on a 9600 baud line lets it be known: by 1915 (EP) and by the order alone (others).
// In: orders, the tester's hand. Out: demand and position against the control's own counter and shaft.
// Bounds: what moves during one exchange or one cycle is all that may be missed.
#include <cmath>

#include "adapters/pacontrol/tests/rig.hpp"

namespace axisgate::pacontrol::test {
namespace {

constexpr AxisId first{0};
const std::map<std::string, std::string> other{{"model", "other"}};

Move move_to(std::int64_t target, std::int64_t velocity, std::int64_t ramp = 50'000) {
    Move m;
    m.target = target;
    m.velocity = velocity;
    m.acceleration = ramp;
    return m;
}
Move by(std::int64_t way, std::int64_t velocity) {
    Move m = move_to(way, velocity);
    m.kind = Move::Kind::relative;
    return m;
}

struct Guided : Rig {
    explicit Guided(std::map<std::string, std::string> model = {}, int axes = 1) : Rig(axes, std::move(model)) {
        for (int i = 0; i < axes; ++i)
            EXPECT_EQ(ask(Enable{}, i), Outcome::accepted);
        run(500ms);
        history.clear();
    }
    const AxisFeedback& fb() { return feedback[first]; }
    std::int64_t behind() { return fb().position_demand - fb().position; }
    bool until(const std::function<bool()>& f, Duration limit = 30s) {
        for (const Instant end = now + limit; !f() && now < end;)
            run(1ms);
        return f();
    }
    void stand() {
        EXPECT_TRUE(until([&] { return !fb().moving; }));
        run(500ms);
    }
    std::size_t asked(const std::string& head) const {
        return static_cast<std::size_t>(
            std::ranges::count_if(handed, [&](const Handed& h) { return h.text.substr(0, head.size()) == head; }));
    }
    /// The greatest difference, and the sources, since the history was cleared.
    std::int64_t greatest() const {
        std::int64_t most = 0;
        for (const auto& [axis, f] : history)
            if (axis == first && f.demand_source != DemandSource::none)
                most = std::max<std::int64_t>(most, std::llabs(f.position_demand - f.position));
        return most;
    }
    std::set<DemandSource> sources() const {
        std::set<DemandSource> s;
        for (const auto& [axis, f] : history)
            if (axis == first) s.insert(f.demand_source);
        return s;
    }
};
using Sources = std::set<DemandSource>;

// --- the control says it: EP -----------------------------------------------------------------------------------------------------

TEST(PacontrolDemandLine, AnEpTellsItsDemandWhileItStandsAndWhileItMoves) {
    Guided r;
    EXPECT_EQ(r.fb().demand_source, DemandSource::drive) << "a little after enabling, with the axis parameters read before";
    EXPECT_EQ(r.behind(), 0);
    r.hand("load", 1.0);  // 1 ms of its way behind
    r.history.clear();
    const Ticket go = r.command(move_to(60'000, 20'000), 0, true);
    r.run(1500ms);
    EXPECT_EQ(r.fb().demand_source, DemandSource::drive);
    EXPECT_NEAR(static_cast<double>(r.behind()), 20, 1) << "1 ms at 20000 increments/s; position and demand belong together";
    EXPECT_NEAR(static_cast<double>(r.fb().position_demand), 1e3 * r.axis(0).shaft().position(r.fb().at), 20.0 * 160)
        << "the counter, as it was told within the last cycle";
    EXPECT_EQ(r.answer(go).outcome, Outcome::done);
    r.run(500ms);
    EXPECT_EQ(r.fb().position_demand, 60'000);
    EXPECT_EQ(r.behind(), 0);
    EXPECT_EQ(r.sources(), Sources{DemandSource::drive});
    EXPECT_LE(r.greatest(), 21);
}

TEST(PacontrolDemandLine, AHeldShaftStandsAndTheDemandGoesOnInBothDirections) {
    for (const int sign : {1, -1}) {
        SCOPED_TRACE(sign);
        Guided r;
        const Ticket go = r.command(move_to(sign * 60'000, 4'000), 0, true);
        r.run(2s);
        r.hand("stall", true);
        const auto held = static_cast<std::int64_t>(std::llround(1e3 * r.axis(0).shaft().place(r.now)));
        r.run(500ms);
        std::int64_t before = r.behind();
        for (int i = 1; i <= 300; ++i) {
            r.run(5ms);
            // 1915 is one exchange older than its position, and by the way of that time the shaft seems to be ahead: always the same,
            // never creeping on with the counter and falling back.
            ASSERT_NEAR(static_cast<double>(r.fb().position), static_cast<double>(held), 4.0 * 100) << i;
            EXPECT_EQ(r.fb().demand_source, DemandSource::drive);
            if (i % 100 != 0) continue;
            EXPECT_GT(sign * (r.behind() - before), 1000) << "2000 in half a second, seen every second cycle";
            before = r.behind();
        }
        EXPECT_EQ(r.answer(go).outcome, Outcome::failed) << "E531 of the model at 10 AE";
        r.run(200ms);
        EXPECT_EQ(r.fb().demand_source, DemandSource::none) << "stopped by the control itself";
        EXPECT_EQ(r.fb().position_demand, r.fb().position);
        EXPECT_NEAR(static_cast<double>(r.fb().position), static_cast<double>(held), 1) << "the counter takes the encoder over";
    }
}

TEST(PacontrolDemandLine, LostStepsStayVisibleAtRestAndAFaultlessAxisIsNotAskedMoreOften) {
    Guided r;
    const Ticket go = r.command(move_to(8'000, 8'000), 0, true);
    r.run(600ms);
    r.hand("stall", true);
    r.run(300ms);
    r.hand("stall", false);
    const double lost = 1e3 * r.axis(0).shaft().lag(r.now);
    EXPECT_GT(lost, 1500);
    EXPECT_EQ(r.answer(go).outcome, Outcome::done) << "an open motor does not know";
    r.run(500ms);
    EXPECT_EQ(r.fb().demand_source, DemandSource::drive);
    EXPECT_EQ(r.fb().position_demand, 8'000);
    EXPECT_NEAR(static_cast<double>(r.behind()), lost, 1) << "asked once more at rest";
    // While it stands 1915 takes every second of its places in the round, and no more.
    const std::size_t lag = r.asked("1915"), position = r.asked("190C");
    r.run(5s);
    EXPECT_NEAR(static_cast<double>(r.asked("1915") - lag), static_cast<double>(r.asked("190C") - position), 2);
}

TEST(PacontrolDemandLine, TheCycleTakesNoLongerForIt) {
    std::array<std::size_t, 2> positions{};
    for (const std::size_t ep : {0u, 1u}) {
        Rig r(4, ep ? std::map<std::string, std::string>{} : other);
        r.move_all(4);
        r.run(1s);
        const std::size_t mark = r.handed.size();
        r.run(15s);
        std::size_t lags = 0;
        for (std::size_t i = mark; i < r.handed.size(); ++i) {
            positions[ep] += r.handed[i].text.substr(0, 4) == "190C";
            lags += r.handed[i].text.substr(0, 4) == "1915";
        }
        if (ep) EXPECT_NEAR(static_cast<double>(lags), static_cast<double>(positions[ep]) / 2, 5);
        if (!ep) EXPECT_EQ(lags, 0u) << "refused once, asked no more";
    }
    std::printf("positions of four moving axes in 15 s: %zu, with following errors %zu\n", positions[0], positions[1]);
    EXPECT_GE(static_cast<double>(positions[1]), 0.97 * static_cast<double>(positions[0]));
}

// --- computed: other models ------------------------------------------------------------------------------------------------------

TEST(PacontrolDemandLine, OtherModelsRefuse1915OnceAndTheirDemandIsComputed) {
    Guided r(other, 2);
    EXPECT_EQ(r.asked("1915;1"), 1u);
    EXPECT_EQ(r.asked("1915;2"), 1u);
    EXPECT_EQ(r.fb().demand_source, DemandSource::computed) << "rests where it stands";
    EXPECT_EQ(r.behind(), 0);
    r.command(move_to(60'000, 20'000), 0, true);
    r.run(10s);
    EXPECT_EQ(r.asked("1915"), 2u);
}

TEST(PacontrolDemandLine, AComputedMoveIsWhereTheControlIs) {
    for (const int sign : {1, -1}) {
        SCOPED_TRACE(sign);
        Guided r(other);
        EXPECT_EQ(r.answer(r.command(move_to(sign * 30'000, 20'000), 0, true)).outcome, Outcome::done);
        r.run(300ms);
        EXPECT_EQ(r.sources(), Sources{DemandSource::computed});
        // Both instants are those of an acknowledgement's last byte; their lengths differ by up to 4 bytes, 3.75 ms at 20 increments/ms.
        EXPECT_LE(r.greatest(), 80);
        EXPECT_GT(r.history.size(), 20u);
        EXPECT_EQ(r.fb().position_demand, sign * 30'000);
        EXPECT_EQ(r.behind(), 0);
    }
}

TEST(PacontrolDemandLine, WithoutOverridesTheAxisParametersRule) {
    Guided r(other);
    Move m;
    m.target = 400'000;  // at 500 AE/s with 1000 AE/s2: all of it ramps
    EXPECT_EQ(r.answer(r.command(m, 0, true)).outcome, Outcome::done);
    r.run(300ms);
    EXPECT_EQ(r.sources(), Sources{DemandSource::computed});
    EXPECT_LE(r.greatest(), 500 * 4) << "4 bytes at 500 increments/ms";
}

TEST(PacontrolDemandLine, StartStopSpeedAndParametersWrittenLaterCount) {
    Rig r(1, other);
    for (const char* argument : {"261;20.0", "262;40.0", "257;50.0"})  // 05h: 20 AE/s, 06h: 40 AE/s2, 01h: 50 AE/s
        EXPECT_EQ(r.answer(r.command(Action{"cmd_set_axis_parameter", argument}, 0)).outcome, Outcome::done);
    r.run(400ms);  // they are read anew before anything else
    EXPECT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
    r.run(500ms);
    r.history.clear();
    Move m;
    m.target = 100'000;
    EXPECT_EQ(r.answer(r.command(m, 0, true)).outcome, Outcome::done);
    std::int64_t most = 0;
    for (const auto& [axis, f] : r.history) {
        EXPECT_EQ(f.demand_source, DemandSource::computed);
        most = std::max<std::int64_t>(most, std::llabs(f.position_demand - f.position));
    }
    EXPECT_LE(most, 50 * 4);
}

TEST(PacontrolDemandLine, RelativeMovesRetargetsAndStopsAreFollowed) {
    Guided r(other);
    EXPECT_EQ(r.answer(r.command(by(-20'000, 20'000), 0, true)).outcome, Outcome::done);
    EXPECT_EQ(r.answer(r.command(by(-12'000, 20'000), 0, true)).outcome, Outcome::done);
    EXPECT_EQ(r.fb().position_demand, -32'000);
    r.command(move_to(100'000, 20'000), 0);
    r.run(1s);
    const Ticket back = r.command(move_to(-40'000, 30'000), 0, true);  // the control is stopped first
    EXPECT_EQ(r.answer(back).outcome, Outcome::done);
    r.run(300ms);
    EXPECT_EQ(r.fb().position_demand, -40'000);
    r.command(move_to(100'000, 30'000, 20'000), 0);
    r.run(2500ms);
    const Ticket halt = r.command(Halt{}, 0, true);
    r.run(700ms);
    EXPECT_TRUE(r.fb().moving) << "1.5 s of ramp";
    EXPECT_EQ(r.fb().demand_source, DemandSource::computed);
    EXPECT_EQ(r.answer(halt).outcome, Outcome::done);
    r.run(500ms);
    EXPECT_EQ(r.sources(), Sources{DemandSource::computed}) << "never in doubt";
    EXPECT_LE(r.greatest(), 30 * 8) << "a stop's acknowledgement is as long as a position's, its beginning is not seen";
    EXPECT_EQ(r.fb().position_demand, std::llround(1e3 * r.axis(0).shaft().position(r.now))) << "the place where it stands is taken over";
}

TEST(PacontrolDemandLine, VelocityMovesEndAtTheTraverseArea) {
    Guided r(other);
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = -30'000;
    m.acceleration = 60'000;
    EXPECT_TRUE(good(r.answer(r.command(m, 0))));
    r.run(3s);
    EXPECT_EQ(r.fb().demand_source, DemandSource::computed);
    EXPECT_LT(r.fb().position_demand, -60'000);
    r.command(Halt{}, 0);
    r.stand();
    EXPECT_LE(r.greatest(), 30 * 8);
    EXPECT_EQ(r.behind(), 0);
}

// --- nobody's demand -------------------------------------------------------------------------------------------------------------

TEST(PacontrolDemandLine, OffReferencePanelAndAutomaticAreNobodysDemand) {
    for (const auto& model : {std::map<std::string, std::string>{}, other}) {
        Rig r(1, model);
        const auto source = [&] { return r.feedback[first].demand_source; };
        const DemandSource own = model.empty() ? DemandSource::drive : DemandSource::computed;
        EXPECT_EQ(source(), DemandSource::none) << "home position";
        EXPECT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
        r.run(500ms);
        EXPECT_EQ(source(), own);
        const Ticket home = r.command(Home{}, 0, true);
        r.run(100ms);
        ASSERT_TRUE(r.feedback[first].moving);
        EXPECT_EQ(source(), DemandSource::none);
        EXPECT_EQ(r.answer(home).outcome, Outcome::done);
        r.run(500ms);
        EXPECT_EQ(source(), own) << "rests at the new zero";
        EXPECT_EQ(r.feedback[first].position_demand, 0);
        EXPECT_EQ(r.ask(Disable{}, 0), Outcome::accepted);
        r.run(500ms);
        EXPECT_EQ(source(), DemandSource::none);
        r.hand("panel", std::string("manual"));
        r.run(300ms);
        r.hand("jog", std::int64_t{1});
        r.run(2s);
        EXPECT_EQ(source(), DemandSource::none);
        r.hand("jog", std::int64_t{0});
        r.hand("panel", std::string("home"));
        r.run(1s);
        EXPECT_EQ(r.ask(Action{"automatic.start", ""}, 0), Outcome::accepted);
        r.run(1s);
        EXPECT_EQ(source(), DemandSource::none);
    }
}

TEST(PacontrolDemandLine, AnAxisThatIsOffHasNoneWhileAnotherIsOn) {
    for (const auto& model : {std::map<std::string, std::string>{}, other}) {
        Guided r(model, 2);
        EXPECT_EQ(r.ask(Disable{}, 0), Outcome::accepted);
        r.run(1s);
        EXPECT_EQ(r.fb().demand_source, DemandSource::none) << "ONLINE goes on for the other axis";
        EXPECT_NE(r.feedback[AxisId{1}].demand_source, DemandSource::none);
    }
}

TEST(PacontrolDemandLine, ALimitSwitchEndsTheDemandUntilAnotherOrder) {
    Guided r(other);
    r.command(move_to(100'000, 20'000), 0);
    r.run(2s);
    r.hand("limit_positive", true);
    r.run(500ms);
    EXPECT_EQ(r.fb().demand_source, DemandSource::none);
    r.hand("limit_positive", false);
    EXPECT_TRUE(good(r.answer(r.command(ResetFault{}, 0, true))));
    EXPECT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
    r.run(500ms);
    EXPECT_EQ(r.fb().demand_source, DemandSource::computed);
    EXPECT_EQ(r.fb().position_demand, std::llround(1e3 * r.axis(0).shaft().position(r.now)));
}

TEST(PacontrolDemandLine, AConditionEndsTheMoveAndTheAxisRestsWhereItStands) {
    Guided r(other);
    EXPECT_TRUE(good(r.answer(r.command(Action{"override.speed", "50"}, 0))));
    EXPECT_TRUE(good(r.answer(r.command(Action{"traverse_until_input", "I5=1 to 300.0"}, 0))));
    r.run(700ms);
    EXPECT_EQ(r.fb().demand_source, DemandSource::computed);
    r.hand("input", std::string("I5=1"));
    r.stand();
    EXPECT_LT(r.fb().position, 299'000);
    EXPECT_EQ(r.fb().demand_source, DemandSource::computed);
    EXPECT_EQ(r.behind(), 0);
}

TEST(PacontrolDemandLine, SettingThePositionMovesTheDemandAlong) {
    for (const auto& model : {std::map<std::string, std::string>{}, other}) {
        Guided r(model);
        EXPECT_EQ(r.answer(r.command(move_to(5'000, 20'000), 0, true)).outcome, Outcome::done);
        r.run(300ms);
        r.history.clear();
        EXPECT_TRUE(good(r.answer(r.command(SetPosition{123'000}, 0, true))));
        r.run(300ms);
        EXPECT_EQ(r.fb().position_demand, 123'000);
        EXPECT_EQ(r.greatest(), 0) << "never one without the other";
    }
}

TEST(PacontrolDemandLine, FoundInOnlineItsParametersAreNotKnown) {
    Rig r(1);
    EXPECT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
    r.hand("silent", true);
    r.run(3s);
    r.hand("silent", false);
    r.run(8s);
    EXPECT_TRUE(good(r.answer(r.command(Enable{}, 0))));
    r.run(1s);
    EXPECT_EQ(r.feedback[first].demand_source, DemandSource::computed) << "at rest: where it stands";
    const Ticket go = r.command(move_to(30'000, 20'000), 0, true);
    r.run(700ms);
    EXPECT_EQ(r.feedback[first].demand_source, DemandSource::none) << "neither gear nor start-stop speed can be asked in ONLINE";
    EXPECT_EQ(r.answer(go).outcome, Outcome::done);
    EXPECT_EQ(r.feedback[first].demand_source, DemandSource::computed) << "a finished move: its target";
    EXPECT_EQ(r.feedback[first].position_demand, 30'000);
}

}  // namespace
}  // namespace axisgate::pacontrol::test
