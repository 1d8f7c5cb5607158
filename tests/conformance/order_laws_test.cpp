// Laws of orders that change the meaning of a position, and of the family's own orders, for every family and wire: homing, set position,
// every action of the catalogue, an answer for each of them; the decoder names the order. Judged by the twins' mechanics.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class OrderLaws : public Laws {
protected:
    World& w = *world;

    /// Without the decimal point: 1.234 turns are 1234 increments.
    static std::string digits_of(std::string text) {
        std::erase(text, '.');
        return text;
    }
    void enabled() {
        start();
        order(a1, Enable{});
        w.run_for(300ms);
    }
};

TEST_P(OrderLaws, HomingEndsAtRestWithAKnownZeroOrSaysWhyNot) {
    enabled();
    const Result* r = ask(a1, Home{}, true, 120s);
    ASSERT_TRUE(r) << "a search has an end";
    if (r->outcome == Outcome::done) {
        EXPECT_EQ(speed(a1), 0) << "done, and it turns";
        w.run_for(1s);
        EXPECT_NE(now().flags & flag_referenced, 0);
        EXPECT_NE(now().statusword & cia402::sw_referenced, 0);
        EXPECT_EQ(speed(a1), 0);
        const auto home = now().position;
        order(a1, move_to(home + 2000));
        w.run_for(500ms);
        EXPECT_EQ(now().position, home + 2000) << "the zero that was found holds";
        EXPECT_NE(now().flags & flag_referenced, 0);
    } else {
        EXPECT_FALSE(r->text.empty()) << "why, in words";
        EXPECT_NE(r->outcome, Outcome::accepted) << "asked until done";
        w.run_for(1s);
        EXPECT_EQ(speed(a1), 0) << "a search that has failed does not go on";
    }
}

TEST_P(OrderLaws, ARefusedHomingIsTheLastOne) {
    enabled();
    const std::int16_t ways[] = {0, 35, 37};
    const auto way = std::ranges::find_if(ways, [&](std::int16_t method) {
        const Result* r = ask(a1, Home{method}, true, 120s);
        return r && r->outcome == Outcome::done;
    });
    ASSERT_NE(way, std::end(ways)) << "no way to a zero";
    w.run_for(500ms);
    EXPECT_NE(now().statusword & cia402::sw_mode_12, 0) << "attained";
    EXPECT_EQ(now().statusword & cia402::sw_mode_13, 0);
    for (const std::int16_t unknown : {std::int16_t{99}, std::int16_t{-128}}) {
        const Result* r = ask(a1, Home{unknown});
        ASSERT_TRUE(r);
        EXPECT_EQ(r->outcome, Outcome::refused) << published(r);
        EXPECT_FALSE(r->text.empty());
        w.run_for(1s);
        EXPECT_EQ(now().statusword & cia402::sw_mode_12, 0) << "an older one is not shown as its success";
        EXPECT_NE(now().statusword & cia402::sw_mode_13, 0);
        EXPECT_NE(now().flags & flag_referenced, 0) << "the zero is where it was";
        order(a1, Home{*way});
        w.run_for(500ms);
        EXPECT_EQ(now().statusword & cia402::sw_mode_13, 0);
        EXPECT_NE(now().statusword & cia402::sw_mode_12, 0);
    }
}

TEST_P(OrderLaws, AStopEndsAHoming) {
    enabled();
    for (const CommandBody& stop : {CommandBody{QuickStop{}}, CommandBody{Halt{}}})
        for (const std::int16_t method : {std::int16_t{0}, std::int16_t{33}}) {  // the drive's own, and the index pulse
            SCOPED_TRACE(testing::Message() << name_of(stop) << ", method " << method);
            order(a1, Enable{});
            (void)ask(a1, move_to(now().position + 300));  // away from the zero of the search before, if that was found
            w.run_for(1s);
            const Ticket search = w.command(a1, Home{method}, true);
            const bool began = w.run_until_true([&] { return speed(a1) > 0 || w.result(search) != nullptr; }, 20s);
            ASSERT_TRUE(began) << "neither a search nor a word why not";
            if (const Result* r = w.result(search)) {
                EXPECT_TRUE(r->outcome == Outcome::done || !r->text.empty()) << published(r);
                EXPECT_EQ(speed(a1), 0);
                continue;
            }
            order(a1, stop);
            EXPECT_EQ(speed(a1), 0);
            const Result* r = w.wait(search, 5s);
            ASSERT_TRUE(r);
            EXPECT_EQ(r->outcome, Outcome::failed) << published(r);
            EXPECT_EQ(r->reason, Reason::interrupted) << published(r);
            const double place = mechanics(a1).position;
            w.run_for(3s);
            EXPECT_EQ(speed(a1), 0);
            EXPECT_EQ(mechanics(a1).position, place) << "the rest of the search is forgotten";
            EXPECT_EQ(now().flags & flag_moving, 0) << "it stands, and is shown as moving";
            if (now().mode_display == cia402::mode_homing)
                EXPECT_EQ(now().statusword & cia402::sw_mode_12, 0) << "a zero that was not found is not attained";
            EXPECT_EQ(w.results[search].size(), 1u);
        }
}

/// Most drives continue an interrupted motion when halt is released (CiA 402-2): an Enable is no order of a motion, neither of the gateway
/// that has halted nor of the next one.
TEST_P(OrderLaws, AnEnableBehindAHaltContinuesNothing) {
    for (const Move::Kind kind : {Move::Kind::absolute, Move::Kind::velocity})
        for (const bool restarted : {false, true}) {
            SCOPED_TRACE(testing::Message() << (kind == Move::Kind::velocity ? "velocity" : "move") << (restarted ? ", restarted" : ""));
            auto plant = std::make_shared<Plant>();
            World before(1, plant);
            const Site wanted = before.make_site(e, e.cable(), 1, "device");
            site = before.apply(wanted);
            a1 = site->axis_ids.at(0);
            before.plug_in("line", DriveId{0}, e, addresses(e, 1).at(0), e.kind());
            ASSERT_TRUE(
                before.run_until_true([&] { return (before.picture(a1).flags & flag_online) && before.picture(a1).ever_seen; }, 30s));
            before.run_for(1s);
            const auto give = [&](World& of, CommandBody body, bool until_done) {
                const Result* r = of.wait(of.command(a1, std::move(body), until_done), 20s);
                EXPECT_TRUE(r);
                return r ? *r : Result{};
            };
            const auto shaft = [&](const World& of) { return plant->buses.at("line")->twin(DriveId{0})->mechanics(1, of.now); };
            ASSERT_TRUE(good(give(before, Enable{}, true)));
            const std::int64_t from = before.picture(a1).position;
            const Result r = give(before, move_to(kind == Move::Kind::velocity ? 2000 : from + 200'000, kind), false);
            if (r.reason == Reason::not_supported) continue;
            ASSERT_TRUE(good(r)) << published(&r);
            ASSERT_TRUE(before.run_until_true([&] { return std::fabs(shaft(before).velocity) > 1000; }, 10s));
            ASSERT_TRUE(good(give(before, Halt{}, true)));
            before.run_for(1s);
            const double place = shaft(before).position;

            World next(2, plant);
            if (restarted) {
                next.now = before.now + 300ms;
                (void)next.apply(wanted);
                ASSERT_TRUE(next.run_until_true([&] { return (next.picture(a1).flags & flag_online) && next.picture(a1).ever_seen; }, 30s));
                next.run_for(1s);
            }
            World& now = restarted ? next : before;
            const Result on = give(now, Enable{}, true);
            ASSERT_TRUE(good(on)) << published(&on);
            now.run_for(3s);
            EXPECT_NEAR(shaft(now).position, place, 1);
            EXPECT_EQ(now.picture(a1).flags & flag_moving, 0);
            const Result moved = give(now, move_to(now.picture(a1).position + 300), true);
            EXPECT_TRUE(good(moved)) << published(&moved);
            now.run_for(1s);
            EXPECT_NEAR(shaft(now).position, place + 300, 2) << "it takes the next order";
        }
}

TEST_P(OrderLaws, ASetPositionRenamesThePlaceAndMovesNothing) {
    enabled();
    order(a1, move_to(now().position + 1500));
    w.run_for(500ms);
    for (const std::int64_t name : {std::int64_t{0}, std::int64_t{700}}) {
        const std::int64_t was = now().position;
        const Ticket set = w.command(a1, SetPosition{name}, true);
        while (!w.result(set) && w.now < at_ns(600'000'000'000)) {
            EXPECT_EQ(speed(a1), 0);
            w.run_for(5ms);
        }
        const Result* r = w.result(set);
        ASSERT_TRUE(r);
        for (int i = 0; i < 100; ++i) {
            w.run_for(10ms);
            EXPECT_EQ(speed(a1), 0) << "a name was changed, and the shaft moves";
        }
        EXPECT_EQ(good(*r), name == 0 || fact("set_position")) << "each drive can call its place 0, most by any name: " << published(r);
        if (!good(*r)) {
            EXPECT_FALSE(r->text.empty()) << "why, in words";
            EXPECT_EQ(now().position, was) << "refused: nothing has changed";
            continue;
        }
        EXPECT_EQ(now().position, name);
        const double place = mechanics(a1).position;
        order(a1, move_to(name + 1000));
        w.run_for(500ms);
        EXPECT_EQ(now().position, name + 1000);
        EXPECT_NEAR(mechanics(a1).position - place, 1000, 1) << "as far as it says, by the shaft";
    }
}

TEST_P(OrderLaws, AtRestNothingMovesAndNobodyWaits) {
    const auto at_rest = [&] { return world->engine.at_rest(world->now); };
    ASSERT_NO_FATAL_FAILURE(start());
    EXPECT_TRUE(world->run_until_true(at_rest, 10s));
    ASSERT_NO_FATAL_FAILURE(order(a1, Enable{}));
    EXPECT_FALSE(at_rest()) << "right after a command";
    ASSERT_NO_FATAL_FAILURE(turn(a1));
    for (int i = 0; i < 50; ++i) {
        world->run_for(100ms);
        ASSERT_FALSE(at_rest()) << "it turns, nobody commands";
    }
    ASSERT_NO_FATAL_FAILURE(order(a1, Halt{}));
    EXPECT_TRUE(world->run_until_true(at_rest, 10s));
    EXPECT_FALSE(moving(a1));
}

TEST_P(OrderLaws, WhatSimulatedDrivesSayMayBeSeenLaterUnlessAnOrderIsOnItsWay) {
    const auto later = [&] { return world->engine.wake_at() - world->engine.deadline(); };
    ASSERT_NO_FATAL_FAILURE(start());
    ASSERT_NO_FATAL_FAILURE(order(a1, Enable{}));
    ASSERT_NO_FATAL_FAILURE(turn(a1));
    Duration most{};
    for (int i = 0; i < 2000; ++i) {
        world->run_for(100us);
        most = std::max(most, later());
        ASSERT_GE(later(), Duration::zero());
        ASSERT_LE(later(), Engine::twins_wait);
    }
    if (GetParam().wire != Wire::network) EXPECT_GT(most, Duration::zero()) << "on a network nothing is on its way";
    const Ticket t = world->command(a1, Halt{}, false);
    ASSERT_FALSE(world->results.contains(t)) << "on its way";
    for (int i = 0; i < 2000 && !world->results.contains(t); ++i) {
        ASSERT_EQ(later(), Duration::zero()) << "the drive's answer is waited for";
        world->run_for(100us);
    }
    EXPECT_TRUE(world->results.contains(t));
}

TEST_P(OrderLaws, EveryActionIsAnsweredOnce) {
    for (const auto& action : e.catalogue->commands()) {
        for (const char* argument : {"", "1", "x y z"}) {
            world = fresh();
            start();
            Action body;
            body.name = action.name;
            body.argument = argument;
            const Ticket t = world->command(a1, body, true);
            const Result* r = world->wait(t, 60s);
            ASSERT_TRUE(r) << action.name << " \"" << argument << "\": no answer in a minute";
            EXPECT_TRUE(good(*r) || !r->text.empty()) << action.name;
            EXPECT_EQ(good(*r), r->reason == Reason::none) << action.name << ": " << published(r);
            EXPECT_NE(r->reason, Reason::internal) << action.name << ": " << published(r);
            world->run_for(1s);
            EXPECT_EQ(world->results[t].size(), 1u) << action.name;
        }
    }
    start();
    Action unknown;
    unknown.name = "no_such_action";
    const Result* r = ask(a1, unknown);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->outcome, Outcome::refused);
    EXPECT_NE(r->text.find("no_such_action"), std::string::npos) << r->text;
}

TEST_P(OrderLaws, TheDecoderSaysWhatWasOrdered) {
    enabled();
    auto decoder = e.family->make_decoder(*e.catalogue, e.kind());
    std::uint64_t next = 1;
    // The sentences for the frames since the last call.
    const auto read = [&](bool orders_only = false) {
        std::string text;
        const auto log = w.engine.frame_log(site->line_ids[0])->read(next, 100'000, 0);
        next = w.engine.frame_log(site->line_ids[0])->next_sequence();
        for (const auto& entry : log.entries) {
            for (const auto& line : decoder->on_frame(entry.frame, entry.to_drive)) {
                if (entry.to_drive || !orders_only) text += line + "\n";
            }
        }
        return text;
    };
    (void)read();
    order(a1, move_to(now().position + 1234, Move::Kind::relative), false);
    const std::string move = read(true);  // not from the echo of its answer
    EXPECT_NE(digits_of(move).find("1234"), std::string::npos) << "a move, and nobody can read how far:\n" << move;
    order(a1, Halt{});
    EXPECT_FALSE(read().empty()) << "a stop, and nothing was said on the line";
    // A parameter that was read is shown with the value that the drive gave, or with its meaning: a model, a mask in hex.
    std::size_t asked = 0;
    std::string unsaid;
    std::size_t reported = 0;
    for (std::uint16_t i = 0; i < e.catalogue->parameters().size(); ++i) {
        const Parameter& p = e.catalogue->parameters()[i];
        if (!p.readable()) continue;
        (void)read();
        const auto counted = w.engine.line_report(site->line_ids[0], w.now).counters.exchanges;
        const Result* r = ask(a1, ReadParameter{first_point(i)}, false);
        ASSERT_TRUE(r) << p.id;
        const auto number = as_integer(r->value);
        if (!good(*r) || !number || w.engine.line_report(site->line_ids[0], w.now).counters.exchanges == counted) continue;
        ++asked;
        const std::string text = read();
        if (digits_of(text).find(std::to_string(std::llabs(*number))) != std::string::npos) {
            ++reported;
        } else {
            unsaid += p.id + " = " + std::to_string(*number) + ", shown as:\n" + text;
        }
    }
    EXPECT_GT(asked, 10u);
    EXPECT_GE(reported * 10, asked * 9) << unsaid;
}

/// A map may contain parameters, and a controller writes them in cycles: a target or a speed among them would undo the stop of another
/// client, so these are read only in the pages.
TEST_P(OrderLaws, NoParameterThatCanBeWrittenIsATargetOrASpeedToRunAt) {
    if (!e.family->stated) return;
    for (std::uint16_t i = 0; i < e.catalogue->parameters().size(); ++i) {
        const Parameter& p = e.catalogue->parameters()[i];
        for (const std::int64_t n : {-1'000, -1, 0, 1, 2, 15, 100, 1'000, 70'000}) {
            if (!p.writable()) continue;
            const auto checked = e.catalogue->check_write(first_point(i), Value{n});
            if (!checked.fault.empty()) continue;
            const Stated said = e.family->stated(*e.catalogue, 1, WriteParameter{first_point(i), checked.value});
            EXPECT_NE(said.kind, Stated::Kind::motion) << p.id << " = " << n;
            EXPECT_NE(said.kind, Stated::Kind::homing) << p.id << " = " << n;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Families, OrderLaws, testing::ValuesIn(law_subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
