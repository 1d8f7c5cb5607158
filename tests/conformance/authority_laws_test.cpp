// Laws of authority, for every family: a client that holds an axis is its only commander, for every kind of order and every part of one;
// every client may stop an axis, and such an order may do nothing else.
#include <gtest/gtest.h>

#include "gateway/axis/cia402.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class AuthorityLaws : public Laws {
protected:
    const Origin bert{http::clients, std::make_shared<const std::string>("bert"), {}};
    const Origin plc{modbus::clients, std::make_shared<const std::string>("192.0.2.7:50000"), {}};
    std::uint64_t tickets = 1;

    Ticket give(AxisId axis, CommandBody body, const Origin& by, bool until_done = false) {
        Command c;
        c.ticket = make_ticket(1, tickets++);
        c.axis = axis;
        c.body = std::move(body);
        c.origin = by;
        c.until_done = until_done;
        const Ticket t = c.ticket;
        world->engine.on_command(std::move(c), world->now);
        return t;
    }
    Result say(AxisId axis, CommandBody body, const Origin& by) {
        const Result* r = world->wait(give(axis, std::move(body), by), 20s);
        EXPECT_TRUE(r) << "no answer";
        return r ? *r : Result{};
    }
    static ProcessData word(int controlword) {
        ProcessData d;
        d.controlword = static_cast<std::uint16_t>(controlword);
        return d;
    }
    void holds(AxisId axis, const Origin& who) { ASSERT_TRUE(good(say(axis, HoldAxis{HoldAxis::Kind::take, 3600, false, {}}, who))); }
    void is_barred(CommandBody body) {
        const std::string what(name_of(body));
        const Result r = say(a1, std::move(body), plc);
        EXPECT_EQ(r.outcome, Outcome::refused) << what;
        EXPECT_EQ(r.reason, Reason::authority) << what << ": " << r.text;
        EXPECT_NE(r.text.find("bert"), std::string::npos) << "who holds it is said: " << r.text;
    }
    [[nodiscard]] PowerState state() const { return power_state_of(now().statusword); }
};

TEST_P(AuthorityLaws, WhoDoesNotHoldTheAxisCommandsNothingOfIt) {
    start();
    holds(a1, bert);
    const Move far = move_to(100'000);
    is_barred(Enable{});
    is_barred(ResetFault{});
    is_barred(Home{});
    is_barred(SetPosition{0});
    is_barred(far);
    is_barred(StartTogether{{a1}});
    for (const Parameter& p : e.catalogue->parameters()) {
        if (!p.writable() || !p.readable()) continue;
        const Point at = first_point(static_cast<std::uint16_t>(&p - e.catalogue->parameters().data()));
        const Result read = say(a1, ReadParameter{at}, plc);  // reading needs no lease
        if (!good(read) || !e.catalogue->check_write(at, read.value).fault.empty()) continue;
        is_barred(WriteParameter{at, read.value});
        break;
    }
    for (const int cw : {0x06, 0x07, 0x0F, 0x80}) {
        SCOPED_TRACE(testing::Message() << "control word " << std::hex << cw);
        is_barred(word(cw));
    }
    // The word that is a halt for an enabled axis would switch on one that is off.
    is_barred(word(0x10F));
    world->run_for(500ms);
    EXPECT_NE(state(), PowerState::operation_enabled);
    EXPECT_LT(speed(a1), 1);
    EXPECT_TRUE(good(say(a1, Enable{}, bert)));
    is_barred(word(0x1F));
    is_barred(far);
}

TEST_P(AuthorityLaws, ALeaseThatHasEndedEndsItsMotionAlthoughAnotherTakesTheAxisAtOnce) {
    // The other takes it at each instant between two housekeepings, before and behind the end of the first lease.
    for (int after = 1; after < 60; after += 7) {
        SCOPED_TRACE(testing::Message() << after << " ms behind its end");
        world = fresh();
        start(world->twins(e));
        const Origin anna{http::clients, std::make_shared<const std::string>("anna"), {}};
        ASSERT_TRUE(good(say(a1, Enable{}, anna)));
        const Result turns = say(a1, move_to(4000, Move::Kind::velocity), anna);
        if (turns.reason == Reason::not_supported) return lacks_velocity(turns);  // every motion of such a drive has an end of its own
        ASSERT_TRUE(good(turns)) << published(&turns);
        ASSERT_TRUE(world->run_until_true([&] { return speed(a1) > 800; }, 5s));
        ASSERT_TRUE(good(say(a1, HoldAxis{HoldAxis::Kind::take, 1, false, {}}, anna)));
        world->run_for(1s + std::chrono::milliseconds(after - 4));
        (void)say(a1, HoldAxis{HoldAxis::Kind::take, 3600, false, {}}, bert);
        world->run_for(3s);
        EXPECT_EQ(now().fail_safe_cause, static_cast<std::uint16_t>(LossCause::lease_ended));
        EXPECT_LT(speed(a1), 1) << "the motion of the former holder goes on";
    }
}

TEST_P(AuthorityLaws, AStopIsEverybodysAndCarriesNothingElse) {
    start();
    holds(a1, bert);
    const AxisPicture before = now();
    for (const int cw : {0x10F, 0x0B, 0x02, 0x00}) {
        SCOPED_TRACE(testing::Message() << "control word " << std::hex << cw);
        ASSERT_TRUE(good(say(a1, Enable{}, bert)));
        ProcessData d = word(cw);
        d.profile_velocity = before.profile_velocity + 77;
        d.target_position = 7777;
        d.target_velocity = 77;
        const Result r = say(a1, d, plc);
        EXPECT_TRUE(good(r)) << published(&r);
        EXPECT_EQ(now().profile_velocity, before.profile_velocity) << "the stop of somebody else has changed a speed";
        EXPECT_NE(now().target_position, 7777);
        EXPECT_NE(now().target_velocity, 77);
        world->run_for(200ms);
    }
    for (const CommandBody& stop : {CommandBody{Halt{}}, CommandBody{QuickStop{}}, CommandBody{Disable{}}}) {
        const Result r = say(a1, stop, plc);
        EXPECT_TRUE(good(r)) << name_of(stop) << ": " << published(&r);
    }
}

TEST_P(AuthorityLaws, AJointStartNeedsEachOfItsAxes) {
    const int channels = std::min(2, e.catalogue->most_channels());
    start(channels > 1 ? 1 : 2, channels);
    const AxisId a2 = site->axis_ids.at(1);
    holds(a2, bert);
    const Result r = say(a1, StartTogether{{a1, a2}}, plc);
    EXPECT_EQ(r.outcome, Outcome::refused);
    EXPECT_EQ(r.reason, Reason::authority) << r.text;
    EXPECT_NE(r.text.find(site->site.axes.at(1).name), std::string::npos) << "the axis that is held is named: " << r.text;
}

/// A client that waits for the end of its motion is informed when another motion has replaced it, and not when that one ends.
TEST_P(AuthorityLaws, AMotionThatAnotherOneReplacesHasAnEnd) {
    start();
    ASSERT_TRUE(good(say(a1, Enable{}, bert)));
    const Ticket far = give(a1, move_to(400'000), bert, true);
    ASSERT_TRUE(world->run_until_true([&] { return moving(a1); }, 20s));
    const Result next = say(a1, move_to(-400'000), plc);
    if (!good(next)) {  // a drive that accepts no other motion meanwhile must say so
        EXPECT_FALSE(next.text.empty());
        return;
    }
    EXPECT_TRUE(world->run_until_true([&] { return world->result(far) != nullptr; }, 2s)) << "it is waited for in vain";
    EXPECT_TRUE(moving(a1));
    if (const Result* ended = world->result(far)) EXPECT_FALSE(good(*ended)) << published(ended);
}

/// A client that waits for the end of its motion is informed by which stop it was ended, as soon as the stop is requested.
TEST_P(AuthorityLaws, AMotionThatIsStoppedIsToldToBeEndedByThatStop) {
    for (const CommandBody& stop : {CommandBody{Halt{}}, CommandBody{QuickStop{}}, CommandBody{Disable{}}}) {
        SCOPED_TRACE(name_of(stop));
        world = fresh();
        start();
        ASSERT_TRUE(good(say(a1, Enable{}, bert)));
        const Ticket far = give(a1, move_to(400'000), bert, true);
        ASSERT_TRUE(world->run_until_true([&] { return moving(a1); }, 20s));
        (void)give(a1, stop, plc);
        const Result* ended = world->result(far);
        ASSERT_TRUE(ended) << "it waits for the standstill";
        EXPECT_EQ(ended->reason, Reason::interrupted) << published(ended);
        EXPECT_NE(ended->text.find(name_of(stop)), std::string::npos) << published(ended);
    }
}

/// A held velocity move belongs to its client: no other client can renew it, and a stop ends the hold.
TEST_P(AuthorityLaws, AHoldIsRenewedByItsClientAloneAndEndsWithAStop) {
    start();
    ASSERT_TRUE(good(say(a1, Enable{}, bert)));
    Move held = move_to(4000, Move::Kind::velocity);
    held.hold_ms = 2000;
    held.acceleration = held.deceleration = 2000;  // two seconds to its speed, and to rest
    const Result r = say(a1, held, bert);
    if (r.reason == Reason::not_supported) return lacks_velocity(r);
    ASSERT_TRUE(good(r)) << published(&r);
    Move renewed = held;
    renewed.renew_only = true;
    const Result mine = say(a1, renewed, bert);
    EXPECT_TRUE(good(mine)) << published(&mine);
    const Result foreign = say(a1, renewed, plc);
    EXPECT_EQ(foreign.reason, Reason::wrong_state) << published(&foreign);
    EXPECT_NE(foreign.text.find("renew"), std::string::npos) << foreign.text;
    ASSERT_TRUE(world->run_until_true([&] { return speed(a1) > 3000; }, 1900ms));
    const Result stop = say(a1, Halt{}, plc);
    ASSERT_TRUE(good(stop)) << published(&stop);
    ASSERT_TRUE(world->run_until_true([&] { return speed(a1) < 1; }, 20s));
    world->run_for(4s);
    EXPECT_EQ(events("hold"), 0) << "a hold that nobody had to renew any more was missed";
}

/// The catalogue's range is checked before the drive is asked.
TEST_P(AuthorityLaws, AValueOutsideOfTheCataloguesRangeIsRefusedBeforeTheDriveIsAsked) {
    start();
    for (const Parameter& p : e.catalogue->parameters()) {
        if (!p.writable() || !p.max || *p.max >= 1e9) continue;
        const Point at = first_point(static_cast<std::uint16_t>(&p - e.catalogue->parameters().data()));
        const Value beyond{static_cast<std::int64_t>(*p.max) + 1};
        const Result r = say(a1, WriteParameter{at, beyond}, bert);
        EXPECT_EQ(r.outcome, Outcome::refused) << published(&r);
        EXPECT_EQ(r.reason, Reason::out_of_range) << published(&r);
        EXPECT_NE(r.text.find(e.catalogue->check_write(at, beyond).fault), std::string::npos) << published(&r);
        return;
    }
    EXPECT_FALSE(std::ranges::any_of(e.catalogue->parameters(), [](const Parameter& p) { return p.writable() && p.max && *p.max < 1e9; }));
}

INSTANTIATE_TEST_SUITE_P(Families, AuthorityLaws, testing::ValuesIn(law_subjects()), name_of_subject);
}  // namespace
}  // namespace axisgate::test
