// The adapter on a faulty or hostile line: PDOs of a wrong length, EMCY storms, restarts, silence, two nodes with one number, refusals.
// Each command must have exactly one result.
#include <fmt/core.h>

#include "adapters/cia402/tests/line_bench.hpp"

namespace axisgate::cia402_drive::test {
namespace {

Native native(std::string_view text) {
    Native n;
    n.send.assign(text.begin(), text.end());
    return n;
}
Frame data(std::uint32_t id, std::vector<std::uint8_t> bytes) { return canopen::data_frame(id, bytes); }

TEST(Cia402Adapter, FindsSetsUpAndTellsANode) {
    LineBench b;
    b.run(2s);
    EXPECT_TRUE(b.link.online) << b.link.text;
    EXPECT_NE(b.link.text.find("vendor"), std::string::npos) << b.link.text;
    EXPECT_FALSE(b.feedback.empty());
    ASSERT_TRUE(b.enable());
    EXPECT_EQ(b.axis.statusword.value_or(0) & 0x6F, 0x27) << "who hears enabled finds it shown";
}

Move run_at(std::int64_t speed) {
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = speed;
    m.acceleration = m.deceleration = 50'000;
    return m;
}
bool armed(const LineBench& b, Duration time, std::string_view action) {
    return b.link.watchdog == DriveWatchdog{DriveWatchdog::State::armed, time, std::string(action)};
}

TEST(Cia402Adapter, ADriveStopsByItselfWhenNothingOfTheGatewayReachesItAndStandsUntilItIsCommanded) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(armed(b, 1000ms, "quick_stop"));
    ASSERT_TRUE(good(b.ask(WriteParameter{*page().find("605Ah"), Value{std::int64_t{6}}}))) << "a quick stop stays";
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(run_at(10'000))));
    b.run(5s);
    ASSERT_EQ(b.speed(), 10'000) << "the gateway's heartbeat holds it";
    EXPECT_EQ(b.reported("emergency"), 0);
    b.deaf = true;
    const Instant cut = b.now;
    while (b.speed() == 10'000 && b.now < cut + 5s)
        b.run(1ms);
    EXPECT_GE(b.now - cut, 940ms);
    EXPECT_LE(b.now - cut, 1005ms);
    b.run(3s);
    EXPECT_EQ(b.speed(), 0);
    b.deaf = false;
    b.run(6s);
    EXPECT_TRUE(b.link.online) << b.link.text;
    EXPECT_TRUE(armed(b, 1000ms, "quick_stop")) << "and it watches again";
    EXPECT_EQ(b.speed(), 0) << "nothing moves because the line is back";
    EXPECT_EQ(b.axis.statusword.value_or(0) & 0x6F, 0x07);
    // A halt, as it follows the loss of a line, does not end the quick stop.
    ASSERT_TRUE(good(b.ask(Halt{})));
    b.run(1s);
    EXPECT_EQ(b.speed(), 0);
    EXPECT_EQ(b.axis.statusword.value_or(0) & 0x6F, 0x07);
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(run_at(10'000))));
    b.run(3s);
    EXPECT_EQ(b.speed(), 10'000);
}

TEST(Cia402Adapter, TheSiteSaysWhatItsDriveDoesAndAfterWhichTime) {
    for (const auto& [action, state] : {std::pair{"disable", 0x40u}, {"fault", 0x08u}}) {
        SCOPED_TRACE(action);
        LineBench b;
        b.setup.drives[0].options = {{"watchdog_action", action}, {"watchdog_ms", "150"}};
        b.configure();
        b.run(2s);
        ASSERT_TRUE(armed(b, 150ms, action));
        ASSERT_TRUE(b.enable());
        ASSERT_TRUE(good(b.ask(run_at(10'000))));
        b.run(2s);
        const int before = b.heartbeats;
        b.run(1s);
        EXPECT_NEAR(b.heartbeats - before, 1000.0 / 37.5, 2) << "four times in the watchdog's time";
        ASSERT_EQ(b.speed(), 10'000);
        b.deaf = true;
        b.run(1s);
        EXPECT_EQ(b.speed(), 0);
        b.deaf = false;
        b.run(6s);
        EXPECT_EQ(b.axis.statusword.value_or(0) & (state == 0x08 ? 0x4Fu : 0x6Fu), state);
    }
}

TEST(Cia402Adapter, AWatchThatTheSiteTakesBackIsTakenOutOfTheDriveAndNoHeartbeatIsSent) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(armed(b, 1000ms, "quick_stop"));
    b.setup.drives[0].options = {{"watchdog_action", "none"}};
    b.configure();
    b.run(2s);
    EXPECT_EQ(b.link.watchdog.state, DriveWatchdog::State::off);
    const int before = b.heartbeats;
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(run_at(10'000))));
    b.run(5s);
    EXPECT_EQ(b.speed(), 10'000);
    EXPECT_EQ(b.heartbeats, before);
    EXPECT_EQ(b.ask(native("1016:01?")).text, "0");
}

TEST(Cia402Adapter, TheGatewaysNodeNumberIsOneThatNoDriveOfTheSiteHas) {
    LineBench b;
    b.setup.options["gateway_node"] = "5";
    b.gateway_node = 4;
    b.configure();
    b.run(2s);
    EXPECT_GT(b.heartbeats, 10);
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(run_at(10'000))));
    // The site gets a drive with that number while the other drive moves: the moving drive monitors the next free number from then on.
    DriveSetup second = b.setup.drives[0];
    second.id = DriveId{1};
    second.name = "second";
    second.address = "4";
    second.axes = {{AxisId{1}, 1}};
    b.setup.drives.push_back(second);
    b.heartbeats = 0;
    b.gateway_node = 3;
    b.configure();
    b.run(5s);
    EXPECT_GT(b.heartbeats, 50);
    EXPECT_EQ(b.speed(), 10'000) << "and it does not miss the old one";
}

TEST(Cia402Adapter, ADriveThatTakesNoWatchdogIsServedAndSaidToHaveNone) {
    LineBench b;
    const std::string text =
        "[FileInfo]\nFileName=a.eds\n[DeviceInfo]\nVendorNumber=0x99\n[MandatoryObjects]\nSupportedObjects=1\n1=0x1000\n"
        "[1000]\nParameterName=Device type\nObjectType=0x7\nDataType=0x0007\nAccessType=ro\nDefaultValue=0x00020192\nPDOMapping=0\n"
        "[OptionalObjects]\nSupportedObjects=1\n1=0x1016\n"
        "[1016]\nParameterName=Consumer heartbeat time\nObjectType=0x8\nSubNumber=2\n"
        "[1016sub0]\nParameterName=Entries\nObjectType=0x7\nDataType=0x0005\nAccessType=const\nDefaultValue=1\nPDOMapping=0\n"
        "[1016sub1]\nParameterName=Entry\nObjectType=0x7\nDataType=0x0007\nAccessType=ro\nDefaultValue=0\nPDOMapping=0\n";
    std::vector<canopen::FileFault> faults, notes;
    const auto eds = canopen::read_eds(text, faults, notes);
    ASSERT_TRUE(eds) << (faults.empty() ? "" : faults[0].text);
    TwinSetup t;
    t.address = "5";
    t.kind = LineKind::can;
    b.bus->remove(DriveId{0});
    b.bus->add(DriveId{0}, twin::make_twin(t, &*eds), {}, b.now);
    b.run(6s);
    EXPECT_TRUE(b.link.online) << b.link.text;
    EXPECT_EQ(b.link.watchdog.state, DriveWatchdog::State::refused);
    EXPECT_EQ(b.reported("watchdog"), 1);
    const int before = b.heartbeats;
    ASSERT_TRUE(b.enable());
    b.run(1s);
    EXPECT_EQ(b.heartbeats, before) << "a heartbeat for nobody is not sent";
}

TEST(Cia402Adapter, APdoOfAWrongLengthIsCountedAndTellsNothing) {
    LineBench b;
    b.run(2s);
    const auto garbled = b.adapter.counters().garbled;
    const auto before = b.feedback.size();
    const auto position = b.axis.position;
    for (const std::size_t n : {0u, 1u, 6u, 8u})
        b.inject(data(0x185, std::vector<std::uint8_t>(n, 0xFF)));
    for (const std::size_t n : {0u, 4u, 7u})
        b.inject(data(0x285, std::vector<std::uint8_t>(n, 0xFF)));
    EXPECT_EQ(b.adapter.counters().garbled, garbled + 7);
    EXPECT_EQ(b.feedback.size(), before);
    EXPECT_EQ(b.axis.position, position);
    b.run(1s);
    EXPECT_TRUE(b.link.online);
}

TEST(Cia402Adapter, AStormOfEmergenciesIsToldInBounds) {
    LineBench b;
    b.run(2s);
    for (int i = 0; i < 10'000; ++i)
        b.inject(data(0x085, {0x10, 0x23, 0x03, 0, 0, 0, 0, static_cast<std::uint8_t>(i)}));
    EXPECT_LT(b.notices.size(), 50u);
    EXPECT_GE(b.reported("emergency"), 1);
    b.run(1s);
    EXPECT_TRUE(b.link.online) << "and it is served all the same";
    EXPECT_TRUE(b.enable());
}

TEST(Cia402Adapter, ANodeThatRebootsUnderWayEndsItsMotionAndIsSetUpAnew) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(LineBench::to(1'000'000))));
    b.run(200ms);
    ASSERT_TRUE(b.axis.moving);
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "power", Value{false}, b.now), "");
    b.run(50ms);
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "power", Value{true}, b.now), "");
    b.run(3s);
    EXPECT_TRUE(b.link.online) << b.link.text;
    EXPECT_FALSE(b.axis.moving);
    EXPECT_FALSE(b.axis.target_reached);
    EXPECT_NE(b.axis.statusword.value_or(0) & 0x6F, 0x27) << "nothing is enabled by itself";
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(LineBench::to(b.axis.position + 1000))));
    b.run(2s);
    EXPECT_TRUE(b.axis.target_reached);
}

TEST(Cia402Adapter, ANodeThatFallsSilentIsAskedAndLostAndFoundAgain) {
    LineBench b;
    b.run(2s);
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "silent", Value{true}, b.now), "");
    b.run(10s);
    EXPECT_FALSE(b.link.online);
    EXPECT_NE(b.link.text.find("does not answer"), std::string::npos) << b.link.text;
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "silent", Value{false}, b.now), "");
    b.run(10s);
    EXPECT_TRUE(b.link.online);
}

TEST(Cia402Adapter, TwoNodesOfOneNumberAnswerTwiceAndEachCommandEndsOnce) {
    LineBench b(2);
    b.run(3s);
    EXPECT_GT(b.adapter.counters().unexpected, 0u) << "the second answer to each question";
    (void)b.ask(Enable{});
    for (int i = 0; i < 10; ++i)
        (void)b.ask(LineBench::to(1000 * i));
    b.run(1s);
    EXPECT_EQ(b.reported("two_nodes"), 1) << "said once, and not with every question";
    for (const auto& [ticket, list] : b.results)
        EXPECT_EQ(list.size(), 1u);
}

TEST(Cia402Adapter, HeartbeatsInTheGapsOfOthersAreASecondNode) {
    LineBench b;
    b.run(3s);
    EXPECT_EQ(b.reported("two_nodes"), 0);
    for (int i = 0; i < 10; ++i) {  // from another node, with its own phase; on a real bus its answers would coincide with those of the
                                    // first
        b.run(500ms);
        b.inject(data(0x705, {0x05}));
    }
    EXPECT_EQ(b.reported("two_nodes"), 1);
    EXPECT_TRUE(b.link.online);
}

TEST(Cia402Adapter, AHeartbeatThatComesEarlyNowAndThenIsNoSecondNode) {
    DoubleBeat watch;
    Instant now = at_ns(0);
    watch.begin(500ms);
    for (int i = 0; i < 1000; ++i) {  // every third one is delayed, and the next follows shortly after it
        now += i % 3 == 0 ? 800ms : i % 3 == 1 ? 200ms : 500ms;
        EXPECT_FALSE(watch.beat(now)) << i;
    }
    int reported = 0;
    for (int i = 0; i < 20; ++i)
        reported += watch.beat(now += i % 2 ? 450ms : 50ms) ? 1 : 0;
    EXPECT_EQ(reported, 1);
    watch.begin(Duration::zero());
    for (int i = 0; i < 20; ++i)
        EXPECT_FALSE(watch.beat(now += 1ms)) << "it took no period from us";
}

TEST(Cia402Adapter, OneNodeIsNeverTakenForTwo) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(b.enable());
    for (int i = 0; i < 30; ++i) {
        b.inject(canopen::sdo_frame(0x585, 0x60, {0x6040, 0}));  // an occasional late answer
        (void)b.ask(LineBench::to(i));
        b.run(50ms);
    }
    EXPECT_EQ(b.reported("two_nodes"), 0);
}

TEST(Cia402Adapter, ReachedIsNotSaidByTheStatusOfTheMotionBefore) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(LineBench::to(1000))));
    b.run(2s);
    ASSERT_TRUE(b.axis.target_reached);
    ASSERT_TRUE(good(b.ask(LineBench::to(50'000))));
    b.feedback.clear();
    // Feedback from before the motion: bit 10 still set, at the old position.
    b.inject(data(0x185, {0x37, 0x16, 0xE8, 0x03, 0, 0, 1}));
    b.inject(data(0x285, {0, 0, 0, 0, 0xE8, 0x03, 0, 0}));
    ASSERT_FALSE(b.feedback.empty());
    for (const auto& f : b.feedback)
        EXPECT_FALSE(f.target_reached) << "at " << f.position;
    b.run(8s);
    EXPECT_TRUE(b.axis.target_reached);
    EXPECT_EQ(b.axis.position, 50'000);
}

TEST(Cia402Adapter, WhatTheDriveRefusesIsToldWithItsAbortCode) {
    LineBench b;
    b.run(2s);
    const Result r = b.ask(Native{{'1', '2', '3', '4', ':', '0', '0', '?'}, true});
    EXPECT_EQ(r.reason, Reason::drive_refused) << r.text;
    EXPECT_NE(r.text.find("0602"), std::string::npos) << r.text;
}

TEST(Cia402Adapter, FramesOfOthersAreNobodys) {
    LineBench b;
    b.run(2s);
    const auto before = b.feedback.size();
    for (const std::uint32_t id : {0x186u, 0x706u, 0x586u, 0x086u, 0x7FFu})
        b.inject(data(id, {1, 2, 3, 4, 5, 6, 7, 8}));
    Frame remote = data(0x185, {});
    remote.remote = true;
    b.inject(remote);
    EXPECT_EQ(b.feedback.size(), before);
    b.run(1s);
    EXPECT_TRUE(b.link.online);
}

TEST(Cia402Adapter, TheFirstEmergencyIsTheCauseAndWhatWasLeftOutIsCounted) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(b.enable());
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "inject_error", Value{std::int64_t{0x2310}}, b.now), "");
    b.inject(data(0x085, {0x10, 0x23, 0x03, 0, 0, 0, 0, 0}));
    b.inject(data(0x085, {0x10, 0x43, 0x09, 0, 0, 0, 0, 0}));  // the overtemperature that follows from the current
    b.run(200ms);
    ASSERT_TRUE(b.axis.fault);
    EXPECT_EQ(b.axis.error_code, 0x2310);
    const auto warnings =
        std::ranges::count_if(b.notices, [](const Notice& n) { return n.kind == "emergency" && n.severity == Severity::warning; });
    EXPECT_GE(warnings, 2);
    for (int i = 0; i < 100; ++i)
        b.inject(data(0x085, {0x10, 0x23, 0x03, 0, 0, 0, 0, static_cast<std::uint8_t>(i)}));
    b.run(2s);
    b.inject(data(0x085, {0x10, 0x23, 0x03, 0, 0, 0, 0, 0}));
    const auto text = b.notices.back().text;
    EXPECT_NE(text.find("before it were left out"), std::string::npos) << text;
}

/// A drive whose 6502h has these modes, as in the manufacturer's file.
std::unique_ptr<Twin> drive_with_modes(std::uint32_t modes) {
    std::ifstream in(AXISGATE_SOURCE_DIR "/adapters/cia402/tests/eds/plain.eds");
    std::stringstream text;
    text << in.rdbuf();
    std::string eds = text.str();
    const auto at = eds.find("0x000000A5");
    if (at == std::string::npos) ADD_FAILURE() << "the file's 6502h";
    eds.replace(at, 10, fmt::format("0x{:08X}", modes));
    std::vector<canopen::FileFault> faults, notes;
    const auto read = canopen::read_eds(eds, faults, notes);
    if (!read) ADD_FAILURE() << "the file";
    TwinSetup t;
    t.address = "5";
    t.kind = LineKind::can;
    return twin::make_twin(t, &*read);
}

TEST(Cia402Adapter, ADriveWithoutTheCyclicModeIsLedByTheOlderOne) {
    for (const auto& [modes, shown] : {std::pair{0xA5u, 8}, {0x65u, 7}}) {  // 1, 3, 6 and 8; 1, 3, 6 and 7
        LineBench b(page(), 1);
        b.bus->add(DriveId{0}, drive_with_modes(modes), {}, b.now);
        b.open();
        b.run(2s);
        ASSERT_TRUE(b.enable()) << shown;
        SetPoint p;
        p.axis = AxisId{0};
        p.velocity = 20'000;
        for (int i = 0; i < 100; ++i) {
            p.value = 100 * i;
            b.follow(p);
            b.run(10ms);
        }
        EXPECT_GT(b.axis.position, 8000) << "mode " << shown;
        EXPECT_EQ(b.ask(native("6061:00?")).text, std::to_string(shown));
        ASSERT_TRUE(good(b.ask(Halt{})));
        b.run(500ms);
        EXPECT_EQ(b.axis.velocity, 0);
        ASSERT_TRUE(good(b.ask(LineBench::to(0)))) << "and back to positioning";
        b.run(3s);
        EXPECT_EQ(b.axis.position, 0) << "mode " << shown;
    }
}

}  // namespace
}  // namespace axisgate::cia402_drive::test
