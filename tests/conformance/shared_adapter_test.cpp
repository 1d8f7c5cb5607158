// Families with one adapter: MACS controllers and CiA 402 drives on one CAN line, beside a UIM342. Resources that a CANopen line has once
// are shared, and a scan distinguishes the drives.
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "gateway/wire/frame_log.hpp"
#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;
namespace json = boost::json;

struct SharedAdapter : testing::Test {
    World world{1, std::make_shared<Plant>(), families()};
    std::shared_ptr<const SiteState> site;

    void start() {
        const auto drive = [](const char* name, const char* family, int address) {
            return json::value{{"name", name}, {"line", "line"}, {"family", family}, {"address", address}, {"presence", "device"}};
        };
        const auto axis = [](const char* name, const char* drive_name, int channel, int number) {
            return json::value{{"name", name},     {"drive", drive_name}, {"channel", channel},
                               {"number", number}, {"unit", "u"},         {"increments_per_unit", 100}};
        };
        const json::value doc{
            {"lines", {{{"name", "line"}, {"uri", "can:sim"}, {"bitrate", 1000000}, {"timing", {{"poll_period_ms", 20}}}}}},
            {"drives", {drive("uim", "uim342", 5), drive("macs", "aposs", 7), drive("one", "cia402", 2), drive("two", "cia402", 3)}},
            {"axes",
             {axis("uim", "uim", 1, 1), axis("x", "macs", 1, 2), axis("y", "macs", 2, 3), axis("one", "one", 1, 4),
              axis("two", "two", 1, 5)}},
            {"mappings", json::array{}}};
        std::vector<SiteFault> faults;
        auto parsed = parse_site(doc, families(), faults);
        for (const auto& f : faults)
            ADD_FAILURE() << f.pointer << ": " << f.text;
        ASSERT_TRUE(parsed);
        site = world.apply(std::move(*parsed));
        plug_in("uim342", 5);
        plug_in("aposs", 7, 2);
        plug_in("cia402", 2);
        plug_in("cia402", 3);
        ASSERT_TRUE(world.run_until_true([&] { return std::ranges::all_of(site->axis_ids, [&](AxisId a) { return online(a); }); }, 20s));
        world.run_for(1s);
    }
    void plug_in(std::string_view family, int address, int channels = 1) {
        world.plug_in("line", DriveId{static_cast<std::uint16_t>(address)}, families().find(family), std::to_string(address), LineKind::can,
                      {}, channels);
    }
    [[nodiscard]] bool online(AxisId a) const { return (world.picture(a).flags & flag_online) && world.picture(a).ever_seen; }
    void order(AxisId a, CommandBody body) {
        const Result* r = world.wait(world.command(a, std::move(body), true), 30s);
        ASSERT_TRUE(r && good(*r)) << published(r);
    }
    /// The instants at which frames with this identifier were on the line in this time, ns.
    std::vector<std::int64_t> crossing(std::uint32_t id, Duration time) {
        const auto log = world.engine.frame_log(site->line_ids[0]);
        std::uint64_t at = log->next_sequence();
        std::vector<std::int64_t> seen;
        for (const Instant end = world.now + time; world.now < end;) {
            world.run_for(50ms);
            const auto read = log->read(at, 4096, 0);
            EXPECT_EQ(read.missed, 0u);
            for (const auto& e : read.entries)
                if (!e.frame.extended && e.frame.id == id) seen.push_back(e.at_unix_ns);
            at = read.next;
        }
        return seen;
    }
    static void expect_gaps(const std::vector<std::int64_t>& seen, Duration least, Duration most) {
        for (std::size_t i = 1; i < seen.size(); ++i) {
            EXPECT_GE(Duration(seen[i] - seen[i - 1]), least) << i;
            EXPECT_LE(Duration(seen[i] - seen[i - 1]), most) << i;
        }
    }
};

TEST_F(SharedAdapter, OneSyncAndOneHeartbeatWhoeverMoves) {
    ASSERT_NO_FATAL_FAILURE(start());
    for (const std::size_t i : {1u, 3u})
        ASSERT_NO_FATAL_FAILURE(order(site->axis_ids[i], Enable{}));
    for (const std::size_t i : {1u, 3u}) {
        Move turn;
        turn.kind = Move::Kind::velocity;
        turn.target = 500;
        (void)world.command(site->axis_ids[i], turn, true);
        world.run_for(500ms);
        const auto syncs = crossing(0x80, 2s);
        EXPECT_NEAR(static_cast<double>(syncs.size()), 100, 1) << "one producer, in the beat that the site asks for";
        expect_gaps(syncs, 19ms, 21ms);
    }
    const auto beats = crossing(0x700 + 127, 2s);
    EXPECT_NEAR(static_cast<double>(beats.size()), 40, 1);
    expect_gaps(beats, 45ms, 55ms);
}

TEST_F(SharedAdapter, ASearchTellsTheFamiliesApart) {
    ASSERT_NO_FATAL_FAILURE(start());
    plug_in("aposs", 9);
    plug_in("cia402", 10);
    ScanWish wish;
    wish.limit = 600s;
    wish.to = "12";
    ASSERT_EQ(world.engine.start_scan(site->line_ids[0], wish, world.now), "");
    const auto scan = [&] { return world.engine.scan_report(site->line_ids[0]); };
    ASSERT_TRUE(world.run_until_true([&] { return scan().state != ScanReport::State::running; }, 600s));
    EXPECT_EQ(scan().state, ScanReport::State::done) << scan().text;
    std::map<std::string, std::string> found;
    for (const auto& f : scan().found)
        EXPECT_TRUE(found.emplace(f.address + " " + f.family, f.known_as).second) << f.family << " " << f.address << " is found twice";
    EXPECT_EQ(found.count("9 aposs"), 1u);
    EXPECT_EQ(found.count("10 cia402"), 1u);
    EXPECT_EQ(found.count("10 aposs"), 0u);
    EXPECT_EQ(found["7 aposs"], "macs");
    EXPECT_EQ(found["2 cia402"], "one");
    for (const auto& part : scan().parts)
        EXPECT_EQ(part.asked, part.of) << part.family;
    EXPECT_TRUE(std::ranges::all_of(site->axis_ids, [&](AxisId a) { return online(a); })) << "the site's own were served all the time";
}

}  // namespace
}  // namespace axisgate::test
