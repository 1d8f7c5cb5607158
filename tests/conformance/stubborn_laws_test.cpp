// Conformance laws for drives that do not follow their orders: a drive that moves further or faster than ordered, answers a move late, does
// not acknowledge a stop, or leaves a stream. The engine must detect this from the feedback and end the motion. The laws run for all
// law_subjects() on twins, behind an adapter that changes orders or answers. No law names a family.
#include <gtest/gtest.h>

#include "gateway/axis/cia402.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "tests/conformance/laws.hpp"
#include "tests/conformance/ways.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

/// The faults of the drive. A test sets a member, and it applies from then on.
struct Flaw {
    int stops_unheard = 0;         ///< number of stops that do not reach the drive and are answered as failed
    int halts_swallowed = 0;       ///< number of halts that do not reach the drive and are answered as accepted
    bool answers_late = false;     ///< the answers to moves are held back while this is true
    bool leaves_stream = false;    ///< the next set-point ends the stream
    bool shows_rest = false;       ///< the feedback says that the axis is at rest
    std::int64_t further = 0;      ///< increments that are added to each target
    std::int64_t faster = 1;       ///< factor for the speed of velocity moves
    std::vector<Result> held{};    ///< the answers that are held back
    int stops = 0;                 ///< number of orders to stop that were given to the drive
    const Family* base = nullptr;  ///< the family whose adapter carries out the orders
};
Flaw flaw;

class Stubborn final : public PassingAdapter {
public:
    using PassingAdapter::PassingAdapter;
    void on_command(const Command& command, Instant now, Out& out) override {
        const bool stop = std::holds_alternative<Halt>(command.body) || std::holds_alternative<QuickStop>(command.body) ||
                          std::holds_alternative<Disable>(command.body);
        flaw.stops += stop;
        if (stop && flaw.stops_unheard > 0) {
            --flaw.stops_unheard;
            return answer(command, Outcome::failed, out);
        }
        if (std::holds_alternative<Halt>(command.body) && flaw.halts_swallowed > 0) {
            --flaw.halts_swallowed;
            return answer(command, Outcome::accepted, out);
        }
        Command other = command;
        auto* m = std::get_if<Move>(&other.body);
        if (m) m->target = m->kind == Move::Kind::velocity ? m->target * flaw.faster : m->target + flaw.further;
        if (m || std::holds_alternative<StartTogether>(command.body)) moves_.push_back(command.ticket);
        PassingAdapter::on_command(other, now, out);
        hold(out);
    }
    void on_set_point(const SetPoint& p, Instant now, Out& out) override {
        if (std::exchange(flaw.leaves_stream, false))
            return out.stream_ends.push_back({p.axis, Reason::drive_refused, "it has left the mode"});
        PassingAdapter::on_set_point(p, now, out);
    }
    void on_frame(const Frame& frame, Instant now, Out& out) override {
        PassingAdapter::on_frame(frame, now, out);
        for (auto& f : out.feedback) {
            if (!flaw.shows_rest) continue;
            f.value.moving = false;
            f.value.velocity = 0;
        }
        hold(out);
    }
    void on_deadline(Instant now, Out& out) override {
        PassingAdapter::on_deadline(now, out);
        hold(out);
        if (!flaw.answers_late) std::ranges::move(std::exchange(flaw.held, {}), std::back_inserter(out.results));
    }
    [[nodiscard]] Instant deadline() const override {
        return !flaw.answers_late && !flaw.held.empty() ? time_zero : PassingAdapter::deadline();
    }

private:
    static void answer(const Command& command, Outcome outcome, Out& out) {
        Result r;
        r.ticket = command.ticket;
        r.axis = command.axis;
        r.outcome = outcome;
        if (outcome == Outcome::failed) {
            r.reason = Reason::no_answer;
            r.text = "the drive did not answer in time";
        }
        if (command.ticket != no_ticket) out.results.push_back(std::move(r));
    }
    void hold(Out& out) {
        if (!flaw.answers_late) return;
        std::erase_if(out.results, [&](const Result& r) {
            if (std::ranges::find(moves_, r.ticket) == moves_.end()) return false;
            flaw.held.push_back(r);
            return true;
        });
    }
    std::vector<Ticket> moves_;
};

class StubbornLaws : public Laws {
protected:
    const Origin bert{http::clients, std::make_shared<const std::string>("bert"), {}};
    const Origin plc{modbus::clients, std::make_shared<const std::string>("192.0.2.7:50000"), {}};
    std::uint64_t tickets = 1;
    Family changed;

    void SetUp() override {
        flaw = {};
        flaw.base = e.family;
        changed = *e.family;
        changed.served_by = nullptr;
        changed.make_adapter = [](const Catalogue& c, LineKind kind) -> std::unique_ptr<Adapter> {
            return std::make_unique<Stubborn>(flaw.base->make_adapter(c, kind));
        };
    }
    struct Drives {
        std::size_t count = 1;
        int channels = 1;
        bool enabled = true;
    };
    /// Starts a world in which the drives of this family have the faults of `flaw`. `fit` changes the site's entry of each axis.
    void begin(Drives drives) {
        begin([](AxisSpec&) {}, drives);
    }
    void begin(const std::function<void(AxisSpec&)>& fit, Drives drives = {1, 1, true}) {
        Families mine = families();
        for (auto& entry : mine.entries) {
            if (entry.family->name != e.family->name) continue;
            entry = e;
            entry.family = &changed;
        }
        world = std::make_unique<World>(1, std::make_shared<Plant>(), std::move(mine));
        Site s = world->twins(e, drives.count, drives.channels);
        for (AxisSpec& a : s.axes)
            fit(a);
        start(std::move(s));
        for (const AxisId axis : site->axis_ids) {
            if (drives.enabled) order(axis, Enable{});
        }
        world->events.clear();
    }
    Ticket give(AxisId axis, CommandBody body, const Origin& by) {
        Command c;
        c.ticket = make_ticket(1, tickets++);
        c.axis = axis;
        c.body = std::move(body);
        c.origin = by;
        const Ticket ticket = c.ticket;
        world->received_at = world->now;
        world->engine.on_command(std::move(c), world->now);
        return ticket;
    }
    [[nodiscard]] bool alarmed(std::string_view kind) const {
        return std::ranges::any_of(world->events, [&](const Event& v) { return v.kind == kind && v.severity == Severity::alarm; });
    }
    /// After a second, in which a motion that nothing ends has gained its speed.
    [[nodiscard]] bool stands(Duration within) { return stands(a1, within); }
    [[nodiscard]] bool stands(AxisId axis, Duration within) {
        world->run_for(1s);
        return world->run_until_true([&] { return speed(axis) < 1; }, within);
    }
};

/// A position inside the limits is trusted until the axis is seen beyond them.
TEST_P(StubbornLaws, ADriveThatAcknowledgesAHaltAndGoesOnIsStopped) {
    begin(Drives{});
    turn(a1);
    flaw.halts_swallowed = 1;
    const Ticket halt = give(a1, Halt{}, bert);
    const Result* r = world->wait(halt, 5s);
    ASSERT_TRUE(r && good(*r)) << published(r);
    EXPECT_TRUE(world->run_until_true([&] { return speed(a1) < 1; }, 8s)) << "nobody has noticed that it goes on";
    EXPECT_TRUE(alarmed("state"));
}

TEST_P(StubbornLaws, APositionMoveThatGoesFurtherThanItsTargetIsStoppedBeyondTheLimit) {
    begin([](AxisSpec& a) { a.position_max = 20'000 / a.increments_per_unit; });
    flaw.further = 200'000;
    const Result* r = ask(a1, move_to(15'000), false);
    ASSERT_TRUE(r);
    if (!good(*r)) {
        EXPECT_EQ(r->reason, Reason::out_of_range) << "only a drive that keeps the limit itself may refuse it: " << published(r);
        return;
    }
    ASSERT_TRUE(stands(20s));
    EXPECT_LT(mechanics(a1).position, 25'000);
    // A drive with limits of its own may have stopped before the gateway had to.
    EXPECT_TRUE(alarmed("limit") || mechanics(a1).position <= 20'000) << "it is beyond the limit, and no alarm says so";
    world->run_for(1s);
    EXPECT_LT(speed(a1), 1);
}

TEST_P(StubbornLaws, AnAxisThatIsFasterThanItsLimitIsStoppedWithAnAlarm) {
    begin([](AxisSpec& a) { a.velocity_max = 4'000 / a.increments_per_unit; });
    flaw.faster = 4;
    const Result* r = ask(a1, move_to(3'000, Move::Kind::velocity), false);
    ASSERT_TRUE(r);
    if (r->reason == Reason::not_supported) return lacks_velocity(*r);
    ASSERT_TRUE(good(*r)) << published(r);
    ASSERT_TRUE(stands(10s));
    EXPECT_TRUE(alarmed("limit"));
    EXPECT_EQ(now().stop_latch & 1, 1);
    world->run_for(1s);
    EXPECT_LT(speed(a1), 1);
}

/// The order to move came before the stop; that its answer comes behind it takes nothing of the stop back.
TEST_P(StubbornLaws, AMoveWhoseAnswerComesBehindAStopTakesNothingOfTheStopBack) {
    begin({1, 1, true});
    flaw.answers_late = true;
    flaw.stops_unheard = 1;
    const Ticket move = world->command(a1, move_to(400'000, Move::Kind::relative), false);
    ASSERT_TRUE(world->run_until_true([&] { return !flaw.held.empty(); }, 5s)) << "the drive has taken it";
    give(a1, QuickStop{}, bert);
    world->run_for(1ms);
    ASSERT_NE(now().stop_latch, 0);
    flaw.answers_late = false;
    ASSERT_TRUE(world->wait(move, 5s)) << "it has its answer";
    EXPECT_NE(now().stop_latch, 0) << "the stop of somebody else holds";
    EXPECT_TRUE(stands(5s)) << "and is said again, because the drive has not heard it";
}

/// Two axes with a prepared move each, which the drive has started together; its answer is still held back.
class JointStartLaws : public StubbornLaws {
protected:
    AxisId a2 = no_axis;
    Ticket both = no_ticket;

    /// `client_lost`: as soon as the order is on its way. False: the family cannot start two axes together, and its answer says so.
    /// `own_too`: the axis that the order names first has a motion prepared as well; without it, only the other one moves.
    [[nodiscard]] bool set_off(bool client_lost = false, bool own_too = true) {
        const int channels = std::min(2, e.catalogue->most_channels());
        begin([](AxisSpec& a) { a.fail_safe.of(modbus::loss_closed) = FailSafeAction::quick_stop; },
              {channels > 1 ? 1u : 2u, channels, true});
        a2 = site->axis_ids.at(1);
        Move m = move_to(400'000, Move::Kind::relative);
        m.prepare_only = true;
        for (const AxisId axis : own_too ? std::vector{a1, a2} : std::vector{a2}) {
            const Result* r = ask(axis, m, false);
            EXPECT_TRUE(r);
            if (!r || is_lacking(*r)) return false;
            EXPECT_TRUE(good(*r)) << published(r);
        }
        flaw.answers_late = true;
        both = give(a1, own_too ? StartTogether{{a1, a2}} : StartTogether{{a2}}, plc);
        if (client_lost) world->engine.on_client_lost(AuthorityClient::of(plc), modbus::loss_closed, world->now);
        EXPECT_TRUE(world->run_until_true([&] { return !flaw.held.empty() || world->result(both); }, 5s));
        if (const Result* r = flaw.held.empty() ? world->result(both) : &flaw.held.front(); !r || !good(*r)) {
            if (client_lost && r && r->reason == Reason::interrupted) return true;  // the stop for the loss came first
            EXPECT_TRUE(r && (own_too ? is_lacking(*r) : r->outcome == Outcome::refused && !r->text.empty())) << published(r);
            return false;
        }
        return true;
    }

private:
    static bool is_lacking(const Result& r) {
        return r.outcome == Outcome::refused && r.reason == Reason::not_supported && !r.text.empty();
    }
};

TEST_P(JointStartLaws, AnAnswerThatComesBehindAStopOfTheSecondAxisTakesNothingOfThatStopBack) {
    if (!set_off()) return;
    flaw.stops_unheard = 1;
    give(a2, QuickStop{}, bert);
    world->run_for(1ms);
    ASSERT_NE(now(a2).stop_latch, 0);
    flaw.answers_late = false;
    ASSERT_TRUE(world->wait(both, 5s)) << "it has its answer";
    EXPECT_NE(now(a2).stop_latch, 0) << "the stop of another client holds";
    EXPECT_TRUE(stands(a2, 5s));
}

TEST_P(JointStartLaws, AClientThatIsLostBeforeTheAnswerLeavesNoAxisMoving) {
    if (!set_off(true)) return;
    flaw.answers_late = false;
    ASSERT_TRUE(world->wait(both, 5s)) << "it has its answer";
    EXPECT_TRUE(stands(5s));
    EXPECT_TRUE(stands(a2, 5s));
}

/// The order is one of an axis that does not move by it: its loss concerns those that do.
TEST_P(JointStartLaws, AClientThatIsLostLeavesNoOtherAxisMovingByAnOrderOfOneThatRests) {
    if (!set_off(true, false)) return;
    flaw.answers_late = false;
    ASSERT_TRUE(world->wait(both, 5s)) << "it has its answer";
    EXPECT_TRUE(stands(a2, 5s));
    EXPECT_LT(mechanics(a2).position, 390'000) << "it was stopped on its way";
}

TEST_P(JointStartLaws, AStartThatWasAnsweredAsFailedAndBeginsIsStoppedOnEachAxis) {
    if (!set_off()) return;
    for (Result& r : flaw.held) {
        r.outcome = Outcome::failed;
        r.reason = Reason::no_answer;
    }
    flaw.answers_late = false;
    ASSERT_TRUE(world->wait(both, 5s)) << "it has its answer";
    EXPECT_TRUE(stands(5s));
    EXPECT_TRUE(stands(a2, 5s));
    EXPECT_EQ(std::ranges::count_if(world->events, [](const Event& v) { return v.kind == "motion" && v.severity == Severity::alarm; }), 2);
}

TEST_P(StubbornLaws, AStopThatTheDriveDoesNotAcknowledgeIsGivenAgain) {
    begin({1, 1, true});
    turn(a1);
    flaw.stops = 0;
    flaw.stops_unheard = 3;
    const Result* r = ask(a1, QuickStop{}, false);
    ASSERT_TRUE(r);
    EXPECT_FALSE(good(*r)) << "nobody has acknowledged it";
    EXPECT_TRUE(stands(5s));
    EXPECT_GT(flaw.stops, 3);
    const int given = flaw.stops;
    world->run_for(2s);
    EXPECT_EQ(flaw.stops, given) << "what was acknowledged is not said again";
}

/// It stays enabled, because the drive does not hear that it shall switch off, and its client stays silent: that is one loss.
TEST_P(StubbornLaws, ASilentClientOfAnAxisAtRestIsLostOnce) {
    const auto fit = [](AxisSpec& a) {
        a.fail_safe.of(modbus::loss_silent) = FailSafeAction::disable;
        a.fail_safe.watchdog_ms = 400;
    };
    begin(fit, {1, 1, false});
    const Ticket on = give(a1, Enable{}, plc);
    ASSERT_TRUE(world->wait(on, 5s));
    flaw.stops_unheard = 1000;
    world->run_for(10s);
    ASSERT_LT(flaw.stops_unheard, 1000) << "it was to be switched off";
    EXPECT_EQ(events("fail_safe"), 1);
    EXPECT_EQ(world->engine.losses(modbus::loss_silent), 1u);
}

/// A program of the drive pauses while the stop for the loss of its client is unheard, and goes on: it is stopped for that loss again.
TEST_P(StubbornLaws, AProgramThatGoesOnBehindALossIsStoppedForItAgain) {
    const auto& program = facts_of(e).at("motions").as_object().at("program").as_object();
    if (program.contains("lacks")) return;
    begin([](AxisSpec& a) {
        a.fail_safe.of(modbus::loss_silent) = FailSafeAction::halt;
        a.fail_safe.watchdog_ms = 2'000;
    });
    const auto say = [&](const boost::json::value& fact) {
        const auto& o = fact.as_object();
        CommandBody body;
        if (const auto* text = o.if_contains("send")) {
            body = Native{{text->as_string().begin(), text->as_string().end()}, true};
        } else {
            body = Action{std::string(o.at("action").as_string()), std::string(o.at("argument").as_string()), {}};
        }
        const Result* r = world->wait(give(a1, std::move(body), plc), 10s);
        ASSERT_TRUE(r && good(*r)) << published(r);
    };
    for (const auto& before : program.at("before").as_array())
        say(before);
    say(program.at("begin"));
    ASSERT_TRUE(world->run_until_true([&] { return moving(a1) && speed(a1) > 1'000; }, 1s));
    world->run_for(300ms);
    flaw.stops_unheard = 1'000;
    ASSERT_TRUE(world->run_until_true([&] { return events("fail_safe") == 1; }, 5s));
    flaw.shows_rest = true;
    world->run_for(3s);
    flaw.shows_rest = false;
    flaw.stops_unheard = 0;
    EXPECT_TRUE(stands(3s));
    EXPECT_EQ(events("fail_safe"), 2);
}

TEST_P(StubbornLaws, AStreamThatTheDriveLeavesEndsInAHalt) {
    begin({1, 1, true});
    if (!e.catalogue->offers_mode(cia402::mode_of(SetPoint::Mode::velocity))) return;  // StreamLaws: it says so
    const auto say = [&] {
        SetPoint p;
        p.axis = a1;
        p.mode = SetPoint::Mode::velocity;
        p.value = 3'000;
        p.acceleration = p.deceleration = 20'000;
        p.good_for = 5s;
        p.at = world->now;
        p.origin = bert;
        return world->engine.on_set_point(p, world->now);
    };
    for (int i = 0; i < 50; ++i) {
        EXPECT_FALSE(say());
        world->run_for(20ms);
    }
    ASSERT_GT(speed(a1), 1'000);
    flaw.leaves_stream = true;
    (void)say();
    EXPECT_TRUE(stands(3s)) << "well before the set-point is too old";
    EXPECT_FALSE(now().streaming);
}

INSTANTIATE_TEST_SUITE_P(Families, JointStartLaws, testing::ValuesIn(law_subjects()), name_of_subject);
INSTANTIATE_TEST_SUITE_P(Families, StubbornLaws, testing::ValuesIn(law_subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
