// Every transition of the state machine by table, in virtual time; clearing; shelves and doubts that end; the bound.
#include "gateway/services/alarms/alarm.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

namespace axisgate {
namespace {
constexpr std::int64_t second = 1'000'000'000;

struct World {
    AlarmList list;
    std::uint64_t id = 0;
    std::int64_t now = 100 * second;
    Event event(std::string kind, Severity severity, std::int32_t code = 0) {
        Event e;
        e.id = ++id;
        e.at_unix_ns = now;
        e.severity = severity;
        e.kind = std::move(kind);
        e.axis = "x";
        e.drive = "d";
        e.line = "l";
        e.code = code;
        e.text = fmt::format("{} {}", e.kind, e.id);
        return e;
    }
    bool fault(std::int32_t code = 7) { return list.on_event(event("fault", Severity::alarm, code)); }
    bool cleared() { return list.on_event(event("fault_cleared", Severity::info, 7)); }
    bool presence(std::string by) {
        Event e = event("presence", Severity::info);
        e.axis.clear();
        e.new_value = std::move(by);
        return list.on_event(e);
    }
    bool loss(const std::string& kind, bool lost) {
        Event e = event(kind, lost ? Severity::warning : Severity::info);
        e.axis.clear();
        if (kind == "line") e.drive.clear();
        return list.on_event(e);
    }
    void later(std::int64_t s) {
        now += s * second;
        (void)list.on_time(now);
    }
    std::uint64_t first() const { return list.all().empty() ? 0 : list.all().begin()->first; }
    std::string state() const { return list.all().empty() ? "normal" : std::string(name_of(list.all().begin()->second.state())); }
    /// One letter per event. Returns whether it was accepted.
    bool act(char what) {
        switch (what) {
            case 'R':
                return fault();
            case 'C':
                return cleared();
            case 'A':
                return list.acknowledge(first(), "anna", "seen", now).empty();
            case 'S':
                return list.shelve(first(), 60, "anna", "known", now).empty();
            case 'U':
                return list.unshelve(first()).empty();
            default:
                later(61);
                return true;
        }
    }
};

struct Row {
    const char* before;
    char what;
    bool taken;
    const char* state;
};
class Transitions : public ::testing::TestWithParam<Row> {};

TEST_P(Transitions, LeadWhereTheTableSays) {
    World w;
    for (const char* c = GetParam().before; *c != 0; ++c)
        ASSERT_TRUE(w.act(*c)) << *c;
    EXPECT_EQ(w.act(GetParam().what), GetParam().taken);
    EXPECT_EQ(w.state(), GetParam().state);
}

constexpr auto ua = "unacknowledged_active";
constexpr auto aa = "acknowledged_active";
constexpr auto uc = "unacknowledged_cleared";
constexpr auto sh = "shelved";
// R raised, C cleared, A acknowledged, S shelved for 60 s, U unshelved, T 61 s pass
INSTANTIATE_TEST_SUITE_P(
    Alarm, Transitions,
    ::testing::Values(Row{"", 'R', true, ua}, Row{"", 'C', false, "normal"}, Row{"", 'A', false, "normal"}, Row{"", 'S', false, "normal"},
                      Row{"", 'U', false, "normal"}, Row{"", 'T', true, "normal"}, Row{"R", 'R', true, ua}, Row{"R", 'C', true, uc},
                      Row{"R", 'A', true, aa}, Row{"R", 'S', true, sh}, Row{"R", 'U', false, ua}, Row{"R", 'T', true, ua},
                      Row{"RA", 'R', true, aa}, Row{"RA", 'C', true, "normal"}, Row{"RA", 'A', false, aa}, Row{"RA", 'S', true, sh},
                      Row{"RA", 'U', false, aa}, Row{"RA", 'T', true, aa}, Row{"RC", 'R', true, ua}, Row{"RC", 'C', false, uc},
                      Row{"RC", 'A', true, "normal"}, Row{"RC", 'S', true, sh}, Row{"RC", 'U', false, uc}, Row{"RC", 'T', true, uc},
                      Row{"RS", 'R', true, sh}, Row{"RS", 'C', true, sh}, Row{"RS", 'A', false, sh}, Row{"RS", 'S', true, sh},
                      Row{"RS", 'U', true, ua}, Row{"RS", 'T', true, ua}, Row{"RSC", 'U', true, uc}, Row{"RSC", 'T', true, uc},
                      Row{"RSC", 'R', true, sh}, Row{"RAS", 'C', true, sh}, Row{"RAS", 'U', true, aa}, Row{"RAS", 'T', true, aa},
                      Row{"RASC", 'U', true, "normal"}, Row{"RASC", 'T', true, "normal"}, Row{"RASC", 'R', true, sh},
                      Row{"RASCR", 'T', true, ua}));

TEST(Alarms, SayWhoAndCountHowOften) {
    World w;
    w.fault();
    w.fault();
    w.fault();
    const auto id = w.first();
    EXPECT_EQ(w.list.all().size(), 1u);
    EXPECT_EQ(w.list.find(id)->count, 3u);
    EXPECT_EQ(w.list.find(id)->text, "fault 3");
    EXPECT_EQ(w.list.unacknowledged(), 1u);
    ASSERT_EQ(w.list.acknowledge(id, "anna 192.0.2.7:1", "guard open", 5), "");
    EXPECT_EQ(w.list.find(id)->acknowledged_by, "anna 192.0.2.7:1");
    EXPECT_EQ(w.list.find(id)->comment, "guard open");
    EXPECT_EQ(w.list.find(id)->acknowledged_unix_ns, 5);
    EXPECT_EQ(w.list.unacknowledged(), 0u);
    EXPECT_NE(w.list.acknowledge(id, "ben", "", 6).find("anna"), std::string::npos);
    for (const std::int64_t wrong : {std::int64_t{59}, std::int64_t{86401}, std::int64_t{-1}})
        EXPECT_NE(w.list.shelve(id, wrong, "anna", "r", 0), "") << wrong;
}

TEST(Alarms, AreOnePerCodeAndTheFaultEndsThemAll) {
    World w;
    w.fault(7);
    w.fault(8);
    EXPECT_EQ(w.list.all().size(), 2u);
    w.later(3);
    w.list.on_event(w.event("alarm", Severity::alarm, 29));  // reported while the drive is in fault, but not with it: ends with the fault
    EXPECT_EQ(w.list.find(3)->state(), AlarmState::unacknowledged_active);
    EXPECT_FALSE(w.list.on_event(w.event("alarm", Severity::alarm, 8))) << "the drive's word about the fault 8";
    EXPECT_EQ(w.list.all().size(), 3u);
    w.cleared();
    for (const auto& [id, a] : w.list.all())
        EXPECT_EQ(a.state(), AlarmState::unacknowledged_cleared) << id;
}

TEST(Alarms, WhatComesWithAFaultIsPartOfIt) {
    World w;
    w.list.on_event(w.event("error", Severity::alarm, 29));  // 1: before the fault
    w.later(1);
    w.fault(7);                                              // 2
    w.list.on_event(w.event("alarm", Severity::alarm, 30));  // 3: after it
    w.list.on_event(w.event("alarm", Severity::alarm, 30));
    ASSERT_EQ(w.list.all().size(), 1u);
    EXPECT_EQ(w.list.find(2)->text, "fault 2; also: error 1; also: alarm 3; also: alarm 4");
    EXPECT_EQ(w.list.find(2)->count, 1u);
    // A report of the gateway is an alarm of its own; so are reports after the acknowledgement of the fault, of another axis, and another
    // fault.
    w.list.on_event(w.event("not_stored", Severity::alarm));
    EXPECT_EQ(w.list.all().size(), 2u);
    Event other = w.event("alarm", Severity::alarm, 30);
    other.axis = "y";
    w.list.on_event(other);
    EXPECT_EQ(w.list.all().size(), 3u);
    ASSERT_EQ(w.list.acknowledge(2, "anna", "", w.now), "");
    w.list.on_event(w.event("alarm", Severity::alarm, 31));
    EXPECT_EQ(w.list.all().size(), 4u);
    EXPECT_EQ(w.list.find(2)->text, "fault 2; also: error 1; also: alarm 3; also: alarm 4");
    w.fault(8);
    EXPECT_EQ(w.list.find(w.id)->text, fmt::format("fault {}", w.id));
    EXPECT_EQ(w.list.all().size(), 5u);
}

TEST(Alarms, WhatCameLongBeforeAFaultIsNoPartOfIt) {
    World w;
    w.list.on_event(w.event("error", Severity::alarm, 29));
    w.later(3);
    w.fault(7);
    EXPECT_EQ(w.list.all().size(), 2u);
    World b;  // nor an alarm that has occurred before, or was acknowledged
    b.list.on_event(b.event("error", Severity::alarm, 29));
    b.list.on_event(b.event("error", Severity::alarm, 29));
    b.fault(7);
    EXPECT_EQ(b.list.all().size(), 2u);
}

TEST(Alarms, WhatNothingTakesBackHasComeAndGone) {
    World w;
    for (const auto* kind : {"not_stored", "alarm"}) {
        w.list.on_event(w.event(kind, Severity::alarm));
        EXPECT_EQ(w.list.find(w.id)->state(), AlarmState::unacknowledged_cleared) << kind;
    }
    EXPECT_FALSE(w.list.on_event(w.event("write", Severity::info)));
    EXPECT_FALSE(w.list.on_event(w.event("hold", Severity::warning)));
    EXPECT_EQ(w.list.all().size(), 2u);
}

TEST(Alarms, LinesAndDrivesComeBackByThemselves) {
    World w;
    EXPECT_TRUE(w.loss("line", true));
    EXPECT_TRUE(w.loss("drive", true));
    EXPECT_EQ(w.list.all().size(), 2u);
    EXPECT_EQ(w.list.find(1)->severity, Severity::warning);
    EXPECT_TRUE(w.loss("line", false));
    EXPECT_FALSE(w.list.find(1)->active);
    EXPECT_TRUE(w.list.find(2)->active);
    w.presence("twin");
    EXPECT_TRUE(w.list.find(2)->active) << "a twin is not the drive";
    w.presence("device");
    EXPECT_FALSE(w.list.find(2)->active);
    w.loss("drive", true);
    EXPECT_TRUE(w.loss("drive", false));
    EXPECT_FALSE(w.list.find(2)->active);
}

TEST(Alarms, AFaultMustShowAgainAfterAChangeOfWhoServes) {
    World w;
    w.fault();
    ASSERT_EQ(w.list.acknowledge(1, "anna", "", w.now), "");
    w.presence("device");
    EXPECT_EQ(w.list.deadline(), w.now + AlarmList::settle_ns);
    w.later(9);
    w.fault();
    w.later(9);
    EXPECT_EQ(w.state(), aa) << "it goes on, acknowledged as it was";
    EXPECT_EQ(w.list.find(1)->count, 1u);
    w.list.on_start(w.now);
    w.later(10);
    EXPECT_EQ(w.state(), "normal");
    EXPECT_EQ(w.list.deadline(), std::nullopt);
}

TEST(Alarms, WhatLeavesTheSiteIsCleared) {
    World w;
    w.fault();
    Site site;
    site.lines.resize(1);
    site.lines[0].name = "l";
    site.drives.resize(1);
    site.drives[0].name = "d";
    site.axes.resize(1);
    site.axes[0].name = "x";
    EXPECT_FALSE(w.list.on_site(site, w.now));
    site.axes[0].name = "y";
    EXPECT_TRUE(w.list.on_site(site, w.now));
    EXPECT_EQ(w.state(), uc);
}

TEST(Alarms, AtTheBoundTheOneClearedFirstGoes) {
    World w;
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(AlarmList::most_alarms); ++i) {
        Event e = w.event("fault", Severity::alarm, i + 1);
        e.axis = fmt::format("axis{}", i);
        w.list.on_event(e);
    }
    w.fault();
    EXPECT_EQ(w.list.all().size(), AlarmList::most_alarms);
    EXPECT_EQ(w.list.dropped(), 1u) << "all are active: the new one is dropped and counted";
    for (const auto* axis : {"axis5", "axis3"}) {
        Event e = w.event("fault_cleared", Severity::info);
        e.axis = axis;
        e.at_unix_ns = ++w.now;
        w.list.on_event(e);
    }
    (void)w.list.take_changed();
    w.fault();
    EXPECT_EQ(w.list.all().size(), AlarmList::most_alarms);
    EXPECT_EQ(w.list.find(6), nullptr) << "axis5 was cleared first";
    EXPECT_NE(w.list.find(4), nullptr);
    EXPECT_EQ(w.list.take_changed(), (std::set<std::uint64_t>{6, w.id}));
}
}  // namespace
}  // namespace axisgate
