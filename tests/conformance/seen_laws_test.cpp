// Cases from real machines, for every family: an axis moved, or did not react, although each order for itself was right. Control words are
// written as a controller does, beside commands of people. Judged by the drive's mechanics.
#include <gtest/gtest.h>

#include "gateway/doors/modbus/words.hpp"
#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class SeenLaws : public Laws {
protected:
    const Origin plc{modbus::clients, std::make_shared<const std::string>("192.0.2.7:50000"), {}};
    std::uint64_t tickets = 1;

    void begin(FailSafe fail_safe = {}, std::optional<std::int64_t> limit = {}) {
        world = fresh();
        Site s = world->twins(e);
        AxisSpec& a = s.axes.at(0);
        a.fail_safe = fail_safe;
        if (limit) {
            a.position_max = static_cast<double>(*limit) / a.increments_per_unit;
            a.position_min = -*a.position_max;
        }
        start(std::move(s));
    }
    Ticket give(CommandBody body, const Origin& by) {
        Command c;
        c.ticket = make_ticket(1, tickets++);
        c.axis = a1;
        c.body = std::move(body);
        c.origin = by;
        const Ticket t = c.ticket;
        world->engine.on_command(std::move(c), world->now);
        return t;
    }
    Result words(const ProcessData& d) {
        const Result* r = world->wait(give(d, plc), 15s);
        EXPECT_TRUE(r) << "no answer";
        return r ? *r : Result{};
    }
    Result word(int cw) {
        ProcessData d;
        d.controlword = static_cast<std::uint16_t>(cw);
        return words(d);
    }
    void enable_by_words(std::int16_t mode) {
        ProcessData d;
        d.mode = mode;
        d.profile_velocity = 2000;
        d.profile_acceleration = d.profile_deceleration = 20'000;
        ASSERT_TRUE(good(words(d)));
        for (const int cw : {0x06, 0x07, 0x0F})
            ASSERT_TRUE(good(word(cw))) << std::hex << cw;
        ASSERT_EQ(power_state_of(now().statusword), PowerState::operation_enabled);
    }
    /// The furthest distance of its shaft in this time, in either direction.
    double farthest_in(Duration time) {
        double most = 0;
        for (const Instant end = world->now + time; world->now < end;) {
            world->run_for(10ms);
            most = std::max(most, std::fabs(mechanics(a1).position));
        }
        return most;
    }
    bool rests(Duration limit = 10s) {
        return world->run_until_true([&] { return speed(a1) < 1; }, limit);
    }
    /// The first parameter that this drive accepts while it moves, and its present value.
    [[nodiscard]] std::optional<std::pair<Point, Value>> some_setting() {
        for (const Parameter& p : e.catalogue->parameters()) {
            if (!p.writable() || !p.readable()) continue;
            const Point at = first_point(static_cast<std::uint16_t>(&p - e.catalogue->parameters().data()));
            const Result* read = ask(a1, ReadParameter{at}, false);
            if (!read || !good(*read)) continue;
            const Value v = read->value;
            const Result* written = ask(a1, WriteParameter{at, v}, false);
            if (written && good(*written)) return std::pair{at, v};
        }
        return std::nullopt;
    }
};

/// While halt (bit 8) is set, or a quick stop is active, neither a word nor a command begins a homing, and nothing turns.
TEST_P(SeenLaws, ASearchBeginsNeitherUnderAHaltNorOutOfAQuickStop) {
    begin();
    enable_by_words(cia402::mode_homing);
    ASSERT_TRUE(good(word(0x10F)));
    (void)word(0x11F);
    const Result* homed = world->wait(give(Home{}, plc), 15s);
    ASSERT_TRUE(homed);
    EXPECT_EQ(homed->outcome, Outcome::refused) << published(homed);
    EXPECT_EQ(farthest_in(2s), 0) << "it searches under a halt";
    (void)word(0x0F);
    ASSERT_TRUE(good(word(0x0B)));
    world->run_for(500ms);
    ASSERT_NE(power_state_of(now().statusword), PowerState::operation_enabled) << "a drive without a quick stop of its own is off";
    homed = world->wait(give(Home{}, plc), 15s);
    ASSERT_TRUE(homed);
    EXPECT_EQ(homed->outcome, Outcome::refused) << published(homed);
    EXPECT_EQ(farthest_in(2s), 0) << "it searches out of a quick stop";
}

/// A gateway that has just started sends each stopping word while the axis turns, whatever state it shows; the answer comes after the
/// drive's.
TEST_P(SeenLaws, WordsThatStopReachAnAxisThatTurnedBeforeTheGatewayCameUp) {
    for (const int cw : {0x0000, 0x0002, 0x000B, 0x010F, 0x0006}) {
        SCOPED_TRACE(testing::Message() << "control word " << std::hex << cw);
        auto plant = std::make_shared<Plant>();
        World before(1, plant);
        Site wanted = before.make_site(e, e.cable(), 1, "device");
        wanted.axes.at(0).fail_safe.of(LossCause::motion_unowned) = FailSafeAction::nothing;  // the word itself must stop the axis
        site = before.apply(wanted);
        a1 = site->axis_ids.at(0);
        before.plug_in("line", DriveId{0}, e, addresses(e, 1).at(0), e.kind());
        ASSERT_TRUE(before.run_until_true([&] { return (before.picture(a1).flags & flag_online) && before.picture(a1).ever_seen; }, 30s));
        before.run_for(1s);
        const Result* on = before.wait(before.command(a1, Enable{}, true), 20s);
        ASSERT_TRUE(on && good(*on)) << published(on);
        const Result* r = before.wait(before.command(a1, move_to(4000, Move::Kind::velocity), false), 20s);
        ASSERT_TRUE(r);
        if (r->reason == Reason::not_supported) return lacks_velocity(*r);
        const auto shaft = [&](const World& w) { return plant->buses.at("line")->twin(DriveId{0})->mechanics(1, w.now); };
        ASSERT_TRUE(before.run_until_true([&] { return shaft(before).velocity > 3000; }, 10s));

        World next(2, plant);
        next.now = before.now + 300ms;
        site = next.apply(wanted);
        ASSERT_TRUE(next.run_until_true([&] { return (next.picture(a1).flags & flag_online) != 0; }, 20s));
        if (shaft(next).velocity < 3000) {
            EXPECT_TRUE(e.catalogue->document().at("drive_watchdog").as_object().contains("stops_velocity_moves"))
                << "it has ended by itself, and its page names no watchdog that does so";
            return;
        }
        Command c;
        c.ticket = make_ticket(1, 1);
        c.axis = a1;
        ProcessData d;
        d.controlword = static_cast<std::uint16_t>(cw);
        c.body = d;
        c.origin = plc;
        const Ticket t = c.ticket;
        next.engine.on_command(std::move(c), next.now);
        EXPECT_FALSE(next.result(t)) << "answered, and sent to nobody";
        EXPECT_TRUE(next.run_until_true([&] { return std::fabs(shaft(next).velocity) < 1; }, 15s)) << "it goes on";
    }
}

/// Drives count a distance from the actual position, from the target, or from the position at which the order arrives; the guard counts
/// like the drive.
TEST_P(SeenLaws, ARelativeMoveOutOfAVelocityMoveKeepsTheLimit) {
    constexpr std::int64_t limit = 130'000;  // room for a drive that turns only by positions
    begin({}, limit);
    order(a1, Enable{});
    turn(a1);
    const std::int64_t room = limit - now().position;
    for (const std::int64_t distance : {room + 10, room - 100, room - 2000}) {
        Move m = move_to(distance, Move::Kind::relative);
        m.acceleration = m.deceleration = 20'000;
        const Result* r = ask(a1, m, false);
        ASSERT_TRUE(r);
        if (distance > room) EXPECT_EQ(r->outcome, Outcome::refused) << published(r);
    }
    EXPECT_LE(farthest_in(45s), limit + 300);
    EXPECT_TRUE(rests());
}

TEST_P(SeenLaws, AParameterThatIsWrittenMeanwhileLeavesTheGuardItsRamp) {
    constexpr std::int64_t limit = 130'000;
    begin({}, limit);
    order(a1, Enable{});
    turn(a1);
    const auto setting = some_setting();
    EXPECT_EQ(setting.has_value(), has_settings()) << "a drive with settings takes none of them while it moves";
    EXPECT_LE(farthest_in(45s), limit + 300) << "it was to be halted before the limit";
    EXPECT_TRUE(rests());
}

/// An order that was sent to a silent drive and answered as failed may have been accepted: it moves nothing later, or is stopped and
/// reported.
TEST_P(SeenLaws, AMoveThatWasAnsweredAsFailedDoesNotBeginWhenTheDriveIsHeardAgain) {
    begin();
    order(a1, Enable{});
    ASSERT_EQ(hand("silent", Value{true}), "");
    const Result* r = ask(a1, move_to(400'000), false, 30s);
    ASSERT_TRUE(r);
    EXPECT_FALSE(good(*r)) << "nobody has answered";
    ASSERT_EQ(hand("silent", Value{false}), "");
    ASSERT_TRUE(world->run_until_true([&] { return online(a1); }, 30s));
    world->run_for(8s);
    EXPECT_LT(speed(a1), 1) << "it is on its way to a place whose order has failed";
}

/// A controller that has gone with its halt bit set leaves an axis that people can move: the refusal says how, and that works.
TEST_P(SeenLaws, AHaltBitThatAControllerHasLeftIsNoDeadEnd) {
    begin();
    enable_by_words(cia402::mode_profile_position);
    ASSERT_TRUE(good(word(0x10F)));
    world->engine.on_client_lost(AuthorityClient::of(plc), modbus::loss_closed, world->now);
    world->run_for(2s);
    const Result* r = ask(a1, move_to(1000), false);
    ASSERT_TRUE(r);
    if (!good(*r)) {
        EXPECT_NE(r->text.find("enable"), std::string::npos) << "what to do is not said: " << r->text;
        order(a1, Enable{});
        order(a1, move_to(1000), false);
    }
    EXPECT_TRUE(world->run_until_true([&] { return now().position == 1000; }, 20s)) << now().position;
}

TEST_P(SeenLaws, APositionThatIsSetIsShownWhenItIsDone) {
    begin();
    order(a1, Enable{});
    const Result* r = ask(a1, SetPosition{700}, true);
    ASSERT_TRUE(r);
    if (r->reason == Reason::not_supported || r->reason == Reason::out_of_range) {  // a drive that can only set 0 says so
        EXPECT_FALSE(r->text.empty());
        r = ask(a1, SetPosition{0}, true);
        ASSERT_TRUE(r);
        if (good(*r)) EXPECT_NEAR(static_cast<double>(now().position), 0, 2) << "done, and not shown";
        return;
    }
    ASSERT_TRUE(good(*r)) << published(r);
    EXPECT_NEAR(static_cast<double>(now().position), 700, 2) << "done, and not shown";
}

INSTANTIATE_TEST_SUITE_P(Families, SeenLaws, testing::ValuesIn(law_subjects()), name_of_subject);

/// A unit in which no counter can be computed is refused where it is written, because limits in it would have no effect.
TEST(SeenInSites, IncrementsPerUnitThatDropTheLimitsAreRefused) {
    for (const double odd : {1e-320, 1e308, 0.0, -1.0}) {
        World w(1);
        const Site s = w.twins(wires_of(families().entries.front()).front());
        auto document = to_json(s);
        document.at("axes").as_array().at(0).as_object()["increments_per_unit"] = odd;
        std::vector<SiteFault> faults;
        EXPECT_FALSE(parse_site(document, families(), faults)) << odd;
        ASSERT_FALSE(faults.empty());
        EXPECT_NE(faults.front().text.find("increments_per_unit"), std::string::npos) << faults.front().text;
    }
}

}  // namespace
}  // namespace axisgate::test
