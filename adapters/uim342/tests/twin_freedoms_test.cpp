// The freedoms of the UIM342: the simulated drive does each of them. Those that all families share are tested in
// tests/unit/wire/specimen_twin_test.cpp, the mechanics in twin_freedoms_mechanics_test.cpp.
#include <gmock/gmock.h>

#include <fstream>
#include <set>

#include "adapters/uim342/tests/twin_bench.hpp"
#include "gateway/core/specimen.hpp"

namespace axisgate::uim342::test::specimens {
namespace {
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

TwinSetup specimen(FreedomValues freedoms) {
    TwinSetup s = can_setup();
    s.freedoms = std::move(freedoms);
    s.seed = 3;
    return s;
}
const Catalogue& page() {
    static const Catalogue c = [] {
        std::ifstream f(AXISGATE_SOURCE_DIR "/schema/families/uim342.json");
        std::stringstream s;
        s << f.rdbuf();
        std::vector<std::string> faults;
        auto parsed = Catalogue::parse(s.str(), faults);
        for (const auto& fault : faults)
            ADD_FAILURE() << fault;
        return *std::move(parsed);
    }();
    return c;
}
const std::string arrived_at_3200 = "5A 29 00 00 00 80 0C 00 00";

/// Driver on, and a motion of 1.13 s to 3200 begins.
void move_3200(Bench& b) { b.setup({"95 01", "A0 " + le32(3200), "9E " + le32(10000), "96"}); }
constexpr double whole_move_ms = 1131.4;

TEST(Uim342Freedoms, ThePageListsThemAndSeedZeroIsToday) {
    EXPECT_GE(page().freedoms().size(), 12u);
    EXPECT_THAT(specimen_in_words(page(), specimen_values(page(), "0")), IsEmpty());
    std::set<FreedomValues> all{specimen_values(page(), "0")};
    for (const auto name : named_specimens)
        EXPECT_TRUE(all.insert(specimen_values(page(), name)).second) << name;
    Bench manual, zero(specimen(specimen_values(page(), "0")));
    for (Bench* b : {&manual, &zero}) {
        move_3200(*b);
        EXPECT_THAT(b->pass_ms(2000), ElementsAre(arrived_at_3200));
        EXPECT_EQ(b->drive().deadline(), never);
    }
    EXPECT_EQ(manual.last_instant(), zero.last_instant());
    EXPECT_EQ(manual.drive().non_volatile(), zero.drive().non_volatile());
}

TEST(Uim342Freedoms, RestartTakesTime) {
    Bench b(specimen({{"restart_ms", 80}}));
    EXPECT_EQ(b.ask("95"), "15 00") << "the boot after power-on is another freedom";
    EXPECT_THAT(b.send("7E 01"), IsEmpty());
    b.pass_ms(79.9);
    EXPECT_THAT(b.send("95"), IsEmpty());
    b.pass_ms(0.1);
    EXPECT_EQ(b.ask("95"), "15 00");
}

TEST(Uim342Freedoms, TheDriverIsOnLate) {
    Bench b(specimen({{"driver_on_ms", 300}}));
    EXPECT_EQ(b.ask("95 01"), "15 01") << "acknowledged at once";
    b.setup({"9D " + le32(1000)});
    b.pass_ms(200);
    EXPECT_EQ(b.ask("95"), "15 00");
    EXPECT_EQ(b.status1() & 4u, 0u);
    EXPECT_EQ(b.ask("96"), "0F 00 3E 96 00 00 00");
    EXPECT_EQ(b.ask("95 01"), "15 01") << "repeated, it does not begin anew";
    b.pass_ms(100);
    EXPECT_EQ(b.ask("95"), "15 01");
    EXPECT_EQ(b.ask("96"), "16 00 00 00 00");
    b.setup({"95 00", "95 01"});
    b.pass_ms(100);
    b.setup({"95 00"});
    b.pass_ms(1000);
    EXPECT_EQ(b.ask("95"), "15 00") << "MO = 0 before it was on";
}

TEST(Uim342Freedoms, StatusFlagsAreLate) {
    Bench b(specimen({{"status_late_ms", 300}}));
    b.pass_ms(1000);
    move_3200(b);
    EXPECT_TRUE(b.stopped()) << "it moves, and shows that it stands";
    EXPECT_EQ(b.status1() & 5u, 0u) << "JOG, and off";
    b.pass_ms(299);
    EXPECT_TRUE(b.stopped());
    EXPECT_GT(b.position(), 400);
    b.pass_ms(1);
    EXPECT_FALSE(b.stopped());
    EXPECT_EQ(b.status1() & 5u, 5u);
    b.pass_ms(whole_move_ms - 300);
    EXPECT_EQ(b.position(), 3200);
    EXPECT_FALSE(b.stopped()) << "it stands, and shows that it moves";
    EXPECT_FALSE(b.in_position());
    b.pass_ms(300);
    EXPECT_TRUE(b.stopped() && b.in_position());
    b.setup({"96"});
    EXPECT_TRUE(b.in_position()) << "of the motion before";
    b.pass_ms(301);
    b.inputs(1);
    b.pass_ms(299);
    EXPECT_EQ(b.status1() & 8u, 0u);
    EXPECT_EQ(b.ask("B7"), "37 01 00 00 00") << "DI is not late";
    b.pass_ms(2);
    EXPECT_EQ(b.status1() & 8u, 8u);
}

TEST(Uim342Freedoms, ManyChangesOfTheStatusAreBounded) {
    Bench b(specimen({{"status_late_ms", 1000}}));
    b.setup({"95 01"});
    for (int i = 0; i < 500; ++i) {
        b.setup({i % 2 ? "B7 00 01 00 00" : "B7 01 01 00 00"});
        b.pass_ms(1);
    }
    b.pass_ms(2000);
    EXPECT_EQ(b.status1() & 0x44u, 4u) << "the last change is shown";
}

TEST(Uim342Freedoms, InPositionFollowsTheEndOfTheMotion) {
    Bench b(specimen({{"in_position_ms", 200}}));
    move_3200(b);
    EXPECT_THAT(b.pass_ms(whole_move_ms + 199), IsEmpty());
    EXPECT_TRUE(b.stopped());
    EXPECT_FALSE(b.in_position()) << "it stands, and is not in position";
    EXPECT_THAT(b.pass_ms(1), ElementsAre(arrived_at_3200));
    EXPECT_TRUE(b.in_position());
    b.setup({"A0 " + le32(0), "96"});
    b.pass_ms(whole_move_ms + 100);
    b.setup({"A0 " + le32(100), "96"});
    EXPECT_THAT(b.pass_ms(150), IsEmpty()) << "the next motion ends the wait for the one before";
    b.pass_ms(2000);
    b.setup({"A0 " + le32(0), "96"});
    b.pass_ms(310);
    EXPECT_TRUE(b.stopped());
    b.setup({"95 00"});
    EXPECT_THAT(b.pass_ms(2000), IsEmpty()) << "and so does the driver";
}

TEST(Uim342Freedoms, NotificationsAreLate) {
    Bench b(specimen({{"notification_late_ms", 500}}));
    move_3200(b);
    EXPECT_THAT(b.pass_ms(whole_move_ms + 499), IsEmpty());
    EXPECT_TRUE(b.in_position()) << "the flag is not late";
    EXPECT_THAT(b.pass_ms(1), ElementsAre(arrived_at_3200));
    b.inputs(1);
    b.pass_ms(100);
    EXPECT_THAT(b.hand("inject_error", 0x1D), IsEmpty()) << "alarms are late, too";
    EXPECT_THAT(b.pass_ms(1000), ElementsAre("5A 02", "5A 00 1D 00 00 00")) << "in their order";
}

TEST(Uim342Freedoms, NotificationsAreLost) {
    Bench none(specimen({{"notification_lost_per_mille", 1000}})), some(specimen({{"notification_lost_per_mille", 500}}));
    move_3200(none);
    EXPECT_THAT(none.pass_ms(3000), IsEmpty());
    EXPECT_TRUE(none.in_position());
    std::size_t sent = 0;
    for (int i = 0; i < 100; ++i) {
        sent += some.inputs(i % 2).size() + some.pass_ms(2).size();
    }
    EXPECT_GT(sent, 30u);
    EXPECT_LT(sent, 70u);
}

TEST(Uim342Freedoms, TheNotificationComesFirst) {
    for (const std::int64_t first : {0, 1}) {
        Bench b(specimen({{"notification_first", first}}));
        b.setup({"95 01", "A0 " + le32(0), "9E " + le32(1000)});
        const Lines lines = b.send("96");
        const std::string arrived = "5A 29 00 00 00 00 00 00 00", begun = "16 00 00 00 00";
        if (first)
            EXPECT_THAT(lines, ElementsAre(arrived, begun));
        else
            EXPECT_THAT(lines, ElementsAre(begun, arrived));
    }
}

TEST(Uim342Freedoms, NotificationsToEveryDevice) {
    for (const std::int64_t to : {0, 4}) {
        const auto twin = make(specimen({{"notification_to", to}}));
        Out out;
        const Instant now = time_zero + std::chrono::seconds(1);
        twin->power_on({}, now, out);
        EXPECT_EQ(twin->set_hand("inject_error", Value{std::int64_t{0x1D}}, now, out), "");
        ASSERT_THAT(out.frames, SizeIs(1));
        const std::uint32_t id = out.frames[0].frame.id;
        EXPECT_EQ(((id >> 19) & 0x1Fu) | ((id >> 9) & 0x60u), static_cast<std::uint32_t>(to));
    }
}

TEST(Uim342Freedoms, NotificationsAreOffAtTheFactory) {
    Bench b(specimen({{"notifications_at_factory", 0}}));
    for (const auto* i : {"00", "01", "02", "08"})
        EXPECT_EQ(b.ask(std::string("87 ") + i), std::string("07 ") + i + " 00 00");
    move_3200(b);
    EXPECT_THAT(b.pass_ms(3000), IsEmpty());
    b.setup({"95 00", "87 08 01 00"});
    (void)b.send("7E 01");
    EXPECT_EQ(b.ask("87 08"), "07 08 01 00") << "a value that was set stays";
    (void)b.send("7E 02");
    EXPECT_EQ(b.ask("87 08"), "07 08 00 00") << "SY[2] sets the factory's";
}

TEST(Uim342Freedoms, StatusUnasked) {
    Bench b(specimen({{"unasked_status_ms", 200}}));
    const Lines lines = b.pass_ms(650);
    EXPECT_THAT(lines, SizeIs(3));
    EXPECT_THAT(lines, testing::Each("11 00 00 01 00 00 00 00 00"));
    b.hand("power", false);
    EXPECT_THAT(b.pass_ms(1000), IsEmpty());
    b.hand("power", true);
    EXPECT_THAT(b.pass_ms(200), SizeIs(1));
}

TEST(Uim342Freedoms, ItTellsThatItHasBooted) {
    Bench b(specimen({{"boot_notice", 1}, {"restart_ms", 50}, {"firmware_version", 0x0123}}));
    EXPECT_THAT(b.send("7E 01"), IsEmpty());
    EXPECT_THAT(b.pass_ms(50), ElementsAre("0B 20 0A 11 00 23 01 00 00"));
    EXPECT_EQ(b.ask("8B"), "0B 20 0A 11 00 23 01 00 00") << "with the firmware's version";
}

TEST(Uim342Freedoms, BroadcastsAreNotAcknowledged) {
    Bench b(specimen({{"broadcast_acknowledge", 0}}));
    EXPECT_THAT(b.send_to(0, "95 01"), IsEmpty());
    EXPECT_THAT(b.send_to(10, "8B"), IsEmpty());
    EXPECT_EQ(b.ask("95"), "15 01") << "it was carried out";
    EXPECT_THAT(b.send_to(0, "A1 01"), SizeIs(1)) << "an error is told all the same";
    Bench ordinary;
    EXPECT_THAT(ordinary.send_to(0, "95 01"), SizeIs(1));
}

TEST(Uim342Freedoms, ErrorsWithoutBit7AreNotReported) {
    Bench b(specimen({{"unasked_errors", 0}}));
    EXPECT_THAT(b.send("16"), IsEmpty());
    EXPECT_TRUE(b.error());
    EXPECT_EQ(b.ask("8F 00"), "0F 00 3E 16 00 00 00") << "it is in the history";
    EXPECT_EQ(b.ask("96"), "0F 00 3E 96 00 00 00");
}

TEST(Uim342Freedoms, ErrorsLoseBit7) {
    Bench b(specimen({{"error_keeps_bit7", 0}}));
    EXPECT_EQ(b.ask("96"), "0F 00 3E 16 00 00 00");
    EXPECT_EQ(b.ask("8F 0A"), "0F 0A 3E 16 00 00 00");
}

TEST(Uim342Freedoms, EightErrorsAreKept) {
    Bench b(specimen({{"error_slots", 8}})), ordinary;
    for (Bench* x : {&b, &ordinary}) {
        for (int i = 0; i < 12; ++i)
            (void)x->send("96");
    }
    EXPECT_EQ(b.ask("8F 11"), "0F 11 3E 96 00 00 00");
    EXPECT_EQ(b.ask("8F 12"), "0F 00 34 8F 12 00 00");
    EXPECT_EQ(ordinary.ask("8F 12"), "0F 12 3E 96 00 00 00");
    (void)b.send("7E 01");
    EXPECT_EQ(b.ask("8F 12"), "0F 00 34 8F 12 00 00") << "after a restart, too";
}

TEST(Uim342Freedoms, ShortValuesAreRefused) {
    Bench b(specimen({{"short_values", 0}}));
    for (const auto* i : {"99 F4 01", "9D 10 27", "9F 80 0C", "AD 01"})
        EXPECT_EQ(b.ask(i), "0F 00 32 " + std::string(i, 2) + " 00 00 00") << i;
    EXPECT_EQ(b.ask("99 F4 01 00 00"), "19 F4 01 00 00");
    EXPECT_EQ(b.ask("95 01"), "15 01");
    EXPECT_EQ(Bench().ask("99 F4 01"), "19 F4 01 00 00");
}

TEST(Uim342Freedoms, SettingsAtRestOnly) {
    for (const std::int64_t rest : {0, 1}) {
        Bench b(specimen({{"settings_at_rest", rest}}));
        b.setup({"95 01", "9D " + le32(1000), "96"});
        for (const auto* i :
             {"99 F4 01 00 00", "9A F4 01 00 00", "9B 00 00 00 00", "9C 00 6A 18 00", "AD 00 00 00 00", "87 08 01 00", "B5 00 00 00"})
            EXPECT_EQ(b.ask(i).substr(0, 8) == "0F 00 3D", rest != 0) << i;
        EXPECT_EQ(b.ask("9D " + le32(500)).substr(0, 2), "2E") << "the values of the next motion are accepted";
        EXPECT_EQ(b.ask("99").substr(0, 2), "19") << "and questions";
        b.setup({"97"});
        b.pass_ms(1000);
        EXPECT_EQ(b.ask("99 F4 01 00 00"), "19 F4 01 00 00");
    }
}

TEST(Uim342Freedoms, RestoringRestarts) {
    Bench b(specimen({{"restore_restarts", 1}, {"restart_ms", 50}}));
    b.setup({"95 01"});
    EXPECT_THAT(b.send("7E 02"), IsEmpty());
    EXPECT_THAT(b.send("95"), IsEmpty());
    b.pass_ms(50);
    EXPECT_EQ(b.ask("95"), "15 00");
    Bench ordinary;
    ordinary.setup({"95 01"});
    (void)ordinary.send("7E 02");
    EXPECT_EQ(ordinary.ask("95"), "15 01");
}

TEST(Uim342Freedoms, TheCounterStartsElsewhere) {
    Bench b(specimen({{"counter_start_increments", -700}}));
    EXPECT_EQ(b.position(), -700);
    EXPECT_EQ(b.relative(), 0);
    b.setup({"95 01", "9F " + le32(100), "9E " + le32(1000), "96"});
    b.pass_ms(2000);
    EXPECT_EQ(b.position(), -600);
    (void)b.send("7E 01");
    EXPECT_EQ(b.position(), -700) << "at each start of an incremental encoder";
    b.setup({"86 05 01 00"});
    (void)b.send("7E 01");
    EXPECT_EQ(b.position(), -700) << "an absolute encoder goes on where the shaft is";
    b.setup({"95 01", "9F " + le32(100), "9E " + le32(1000), "96"});
    b.pass_ms(2000);
    (void)b.send("7E 01");
    EXPECT_EQ(b.position(), -600);
}

TEST(Uim342Freedoms, InputsAreSeenLate) {
    Bench b(specimen({{"input_late_ms", 50}}));
    b.inputs(1);
    EXPECT_THAT(b.pass_ms(49), IsEmpty());
    EXPECT_THAT(b.pass_ms(2), SizeIs(1));
    EXPECT_EQ(b.status1() & 8u, 8u);
    b.inputs(0);
    b.pass_ms(30);
    b.inputs(1);
    EXPECT_THAT(b.pass_ms(200), IsEmpty()) << "a level that does not stand so long is not seen";
    b.inputs(5);
    b.pass_ms(30);
    b.inputs(4);
    EXPECT_THAT(b.pass_ms(49), IsEmpty());
    EXPECT_THAT(b.pass_ms(2), SizeIs(2));
}

}  // namespace
}  // namespace axisgate::uim342::test::specimens
