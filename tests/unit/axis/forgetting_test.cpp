// Compares every event in every situation with the table of forgetting.
#include <fmt/core.h>

#include "tests/unit/axis/forgetting_table.hpp"

namespace axisgate::forgetting {
namespace {

/// The expected value after an event, and its rule.
struct Expected {
    std::string text;
    std::string rule = "no rule speaks of it: it is kept";
    bool open = false;
};

std::array<Expected, static_cast<std::size_t>(Value::count)> expected_of(const std::vector<const Rule*>& matching, const Seen& before) {
    std::array<Expected, static_cast<std::size_t>(Value::count)> expected;
    for (std::size_t v = 0; v < before.size(); ++v) {
        Expected& e = expected[v];
        e.text = before[v];
        for (const Rule* r : matching) {
            const auto value = static_cast<Value>(v);
            if (r->open.has(value)) e = {"", r->name, true};
            if (r->keeps.has(value)) e = {before[v], r->name, false};
            if (r->forgets.has(value)) e = {value_names[v][1], r->name, false};
            for (const Becomes& b : r->becomes) {
                if (b.value == value) e = {b.text == std::string("+1") ? std::to_string(std::stoi(before[v]) + 1) : b.text, r->name, false};
            }
        }
    }
    return expected;
}

TEST(Forgetting, EveryEventInEverySituationIsAsTheTableSays) {
    const std::vector<Rule> table = rules();
    for (unsigned s = 0; s < static_cast<unsigned>(Situation::count); ++s) {
        const Subject begin(static_cast<Situation>(s));
        const Seen before = begin.look();
        for (unsigned e = 0; e < static_cast<unsigned>(Event::count); ++e) {
            const std::string where = fmt::format("{} while {}", event_names[e], situation_names[s]);
            std::vector<const Rule*> matching;
            for (const Rule& r : table) {
                if (r.events.has(static_cast<Event>(e)) && r.situations.has(static_cast<Situation>(s))) matching.push_back(&r);
            }
            EXPECT_FALSE(matching.empty()) << where << ": no rule of the table speaks of it";
            Subject subject = begin;
            subject.apply(static_cast<Event>(e));
            const Seen after = subject.look();
            const auto expected = expected_of(matching, before);
            for (std::size_t v = 0; v < after.size(); ++v) {
                EXPECT_TRUE(expected[v].open || after[v] == expected[v].text)
                    << where << ": " << value_names[v][0] << " was " << before[v] << " and is " << after[v] << " instead of "
                    << expected[v].text << " (" << expected[v].rule << ")";
            }
        }
    }
}

/// A rule that changes nothing in any situation, although it says so, is not verified by anything.
TEST(Forgetting, EveryRuleIsSeenAtWork) {
    for (const Rule& r : rules()) {
        if (r.forgets.empty() && r.becomes.empty()) continue;
        bool seen = false;
        for (unsigned s = 0; s < static_cast<unsigned>(Situation::count) && !seen; ++s) {
            if (!r.situations.has(static_cast<Situation>(s))) continue;
            const Subject begin(static_cast<Situation>(s));
            const Seen before = begin.look();
            const auto expected = expected_of({&r}, before);
            for (std::size_t v = 0; v < before.size(); ++v)
                seen = seen || (!expected[v].open && expected[v].text != before[v]);
        }
        EXPECT_TRUE(seen) << r.name;
    }
}

/// A motion that continues after a halt is no new set-point. One that was on its way when another drive began to serve the axis is not
/// valid for that drive.
TEST(Forgetting, AMotionOnItsWayIsForgottenWithTheDriveThatWasToTakeIt) {
    for (const bool presence_changes : {false, true}) {
        Subject s(Situation::halted);
        ProcessData d;
        d.controlword = 0x0F;
        ASSERT_EQ(s.profile.on_process_data(d, plc()).orders.size(), 1u);
        const auto counted = s.picture().setpoints_accepted;
        if (presence_changes) s.apply(Event::another_drive);
        s.profile.on_order_result(Move{}, true, s.now);
        EXPECT_EQ(s.picture().setpoints_accepted - counted, presence_changes ? 1 : 0);
    }
}

/// Neither the value in register 34 nor the position itself is a distance.
TEST(Forgetting, ASetPointWithoutATargetOfItsClientStaysWhereTheAxisIs) {
    for (const Origin& by : {plc(), panel()}) {
        for (const bool relative : {false, true}) {
            Subject s(Situation::standing);
            s.apply(Event::another_drive_that_is_on);
            ProcessData d;
            d.profile_velocity = 200;
            d.controlword = 0x0F;
            (void)s.profile.on_process_data(d, by);
            d.controlword = relative ? 0x5F : 0x1F;
            const auto r = s.profile.on_process_data(d, by);
            ASSERT_EQ(r.orders.size(), 1u) << r.text;
            const auto& m = std::get<Move>(r.orders[0]);
            EXPECT_EQ(m.kind, relative ? Move::Kind::relative : Move::Kind::absolute);
            EXPECT_EQ(m.target, relative ? 0 : 70);
        }
    }
}

}  // namespace
}  // namespace axisgate::forgetting
