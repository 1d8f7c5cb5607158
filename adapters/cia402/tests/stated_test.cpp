// The effect of object writes, parameter writes and actions as it is determined before they are sent; and the rates, the course and the
// power that an axis reports.
#include "adapters/cia402/family.hpp"
#include "adapters/cia402/tests/line_bench.hpp"

namespace axisgate::cia402_drive::test::before_sending {
namespace {
using Kind = Stated::Kind;

Native line(std::string_view text) {
    Native n;
    n.send.assign(text.begin(), text.end());
    return n;
}
Stated of(std::string_view text, int channel = 1) { return stated(page(), channel, line(text)); }
Stated of_write(std::string_view id, std::int64_t value) { return stated(page(), 1, WriteParameter{*page().find(id), Value{value}}); }

TEST(Cia402Stated, WritesOfObjects) {
    struct Row {
        const char* text;
        Kind kind;
    };
    for (const Row& r : {Row{"6064:00?", Kind::nothing},
                         {"6040:00=x0600", Kind::nothing},
                         {"6040:00=x0B00", Kind::nothing},
                         {"6040:00=x8000", Kind::nothing},
                         {"6040:00=x0F00", Kind::unread},
                         {"6040:00=x3F00", Kind::unread},
                         {"6040:00=x0F01", Kind::nothing},
                         {"6060:00=x01", Kind::nothing},
                         {"6060:00=x03", Kind::unread},
                         {"6060:00=x08", Kind::unread},
                         {"6071:00=x6400", Kind::unread},
                         {"6071:00=x0000", Kind::nothing},
                         {"60B1:00=x10000000", Kind::unread},
                         {"607D:01=x00000000", Kind::nothing},
                         {"2100:01=x01FF", Kind::unread},
                         {"1017:00=x0000", Kind::nothing},
                         {"6840:00=x0F00", Kind::unread},
                         {"nonsense", Kind::nothing}})
        EXPECT_EQ(of(r.text).kind, r.kind) << r.text;
}

TEST(Cia402Stated, TargetsAndRates) {
    Stated s = of("607A:00=x18FCFFFF");
    EXPECT_EQ(s.kind, Kind::motion);
    EXPECT_EQ(s.move.kind, Move::Kind::absolute);
    EXPECT_EQ(s.move.target, -1000);
    EXPECT_EQ(s.channel, 0);
    s = of("60FF:00=xD0070000");
    EXPECT_EQ(s.move.kind, Move::Kind::velocity);
    EXPECT_EQ(s.move.target, 2000);
    EXPECT_EQ(of("6081:00=x10270000").sets.velocity, 10'000);
    EXPECT_EQ(of("6083:00=1234").sets.acceleration, 1234);
    EXPECT_EQ(of_write("6084h", 500).sets.deceleration, 500);
    EXPECT_EQ(of_write("6085h", 900).sets.quick_stop, 900);
    EXPECT_EQ(of_write("6067h", 10).kind, Kind::nothing);
}

TEST(Cia402Stated, Actions) {
    for (const char* name : {"store_parameters", "restore_defaults", "nmt_start", "nmt_reset_node"})
        EXPECT_EQ(stated(page(), 1, Action{name, {}, {}}).kind, Kind::nothing) << name;
}

TEST(Cia402Rates, AreReadAtTheStartAndFollowOrdersAndWrites) {
    LineBench b;
    b.run(2s);
    const DriveRates first = b.axis.rates;
    EXPECT_GT(first.velocity, 0);
    EXPECT_GT(first.acceleration, 0);
    EXPECT_GT(first.deceleration, 0);
    EXPECT_GT(first.quick_stop, 0) << "6085h, by which it brakes where 605Ah is 2 or 6";
    ASSERT_TRUE(b.enable());
    Move m = LineBench::to(100'000);
    m.velocity = 4321;
    m.acceleration = 50'001;
    m.deceleration = 50'002;
    ASSERT_TRUE(good(b.ask(m)));
    b.run(100ms);
    EXPECT_EQ(b.axis.rates, (DriveRates{4321, 50'001, 50'002, first.quick_stop}));
    EXPECT_EQ(b.axis.course, Course::to_target);
    ASSERT_TRUE(good(b.ask(line("6081:00=777"))));
    EXPECT_EQ(b.axis.rates, DriveRates{}) << "unknown until they are read again";
    b.run(300ms);
    EXPECT_EQ(b.axis.rates.velocity, 777) << "asked again at once";
    EXPECT_EQ(b.axis.rates.deceleration, 50'002);
    ASSERT_TRUE(good(b.ask(WriteParameter{*page().find("6085h"), Value{std::int64_t{61'000}}})));
    b.run(300ms);
    EXPECT_EQ(b.axis.rates.quick_stop, 61'000);
    ASSERT_TRUE(good(b.ask(WriteParameter{*page().find("605Ah"), Value{std::int64_t{5}}})));
    b.run(300ms);
    EXPECT_EQ(b.axis.rates.quick_stop, 50'002) << "5: the quick stop brakes on 6084h";
}

TEST(Cia402Rates, AVelocityMoveIsEndless) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(b.enable());
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = 5'000;
    ASSERT_TRUE(good(b.ask(m)));
    b.run(200ms);
    EXPECT_TRUE(b.axis.moving);
    EXPECT_EQ(b.axis.course, Course::endless);
}

/// The status word of TPDO 1, as if the drive had lost its voltage.
TEST(Cia402Power, ADriveThatFallsFromOperationByItselfHasItsEnableTakenBack) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(b.enable());
    b.run(100ms);  // reports have shown it on
    std::vector<std::uint16_t> words;
    b.crossed = [&](const Frame& f) {
        const auto d = f.data();
        if (f.id == 0x605 && d.size() == 8 && d[1] == 0x40 && d[2] == 0x60) words.push_back(static_cast<std::uint16_t>(d[4] | d[5] << 8));
    };
    const std::vector<std::uint8_t> status{0x40, 0x02, 0, 0, 0, 0, 1}, motion{0, 0, 0, 0, 0, 0, 0, 0};
    for (int i = 0; i < 2; ++i) {
        b.inject(canopen::data_frame(0x185, status));
        b.inject(canopen::data_frame(0x285, motion));
    }
    EXPECT_TRUE(b.axis.safe_stop) << "no voltage (status bit 4), and nobody has ordered that";
    b.run(100ms);
    ASSERT_FALSE(words.empty());
    EXPECT_EQ(words.front(), 0x0000) << "the control word does not enable it any more";
    b.run(1s);
    EXPECT_EQ(b.axis.power, AxisFeedback::Power::off);
    EXPECT_FALSE(b.axis.safe_stop);
}

TEST(Cia402SetPosition, IsAnsweredWhenTheAxisShowsTheNewPosition) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(SetPosition{123'456})));
    EXPECT_NEAR(static_cast<double>(b.axis.position), 123'456, 2) << "shown before it is answered";
}

TEST(Cia402Limits, TheSitesLimitsGoIntoTheDrive) {
    LineBench b(page(), 1);
    TwinSetup t;
    t.address = "5";
    t.kind = LineKind::can;
    b.bus->add(DriveId{0}, twin::make_twin(t), {}, b.now);
    b.setup.drives[0].axes[0].position_min = -20'000;
    b.setup.drives[0].axes[0].position_max = 30'000;
    b.open();
    b.run(2s);
    EXPECT_EQ(b.link.limits.state, DriveLimits::State::armed) << b.link.limits.text;
    EXPECT_EQ(as_integer(b.ask(ReadParameter{*page().find("607Dh:01")}).value), -20'000);
    EXPECT_EQ(as_integer(b.ask(ReadParameter{*page().find("607Dh:02")}).value), 30'000);
    // The site changes: the drive stays in operation and is set up again.
    b.setup.drives[0].axes[0].position_max = 40'000;
    b.configure();
    b.run(2s);
    EXPECT_EQ(as_integer(b.ask(ReadParameter{*page().find("607Dh:02")}).value), 40'000);
}

TEST(Cia402Limits, NothingIsSentWithoutLimitsOrWithTheOptionOff) {
    for (const bool off : {false, true}) {
        LineBench b(page(), 1, off ? std::map<std::string, std::string>{{"drive_limits", "off"}} : std::map<std::string, std::string>{});
        TwinSetup t;
        t.address = "5";
        t.kind = LineKind::can;
        b.bus->add(DriveId{0}, twin::make_twin(t), {}, b.now);
        if (off) b.setup.drives[0].axes[0].position_max = 30'000;
        int writes = 0;
        b.crossed = [&](const Frame& f) {
            const auto d = f.data();
            if (f.id == 0x605 && d.size() == 8 && d[1] == 0x7D && d[2] == 0x60) ++writes;
        };
        b.open();
        b.run(2s);
        EXPECT_EQ(b.link.limits.state, off ? DriveLimits::State::off : DriveLimits::State::unknown);
        EXPECT_EQ(writes, 0);
    }
}

}  // namespace
}  // namespace axisgate::cia402_drive::test::before_sending
