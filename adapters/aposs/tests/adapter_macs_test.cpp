// A MACS behind the adapter, on a simulated bus: two axes of one node, parameters by scope and axis, the protection of its EPROM, a node
// without CiA 402.
#include "adapters/aposs/family.hpp"
#include "adapters/aposs/tests/macs.hpp"
#include "adapters/cia402/tests/line_bench.hpp"

namespace axisgate::aposs::test {
namespace {
using namespace std::chrono_literals;

struct Line : cia402_drive::test::LineBench {
    explicit Line(std::unique_ptr<Twin> twin = macs(), std::map<std::string, std::string> options = {})
        : LineBench(page(), 2, std::move(options)) {
        bus->add(DriveId{0}, std::move(twin), {}, now);
        open();
        run(2s);
    }
    Result read(std::string_view id, int axis = 0) { return ask(ReadParameter{point(id)}, 10s, axis); }
    Result write(std::string_view id, std::int64_t v, int axis = 0) { return ask(WriteParameter{point(id), Value{v}}, 10s, axis); }
    static Point point(std::string_view id) {
        const auto all = page().parameters();
        for (std::size_t i = 0; i < all.size(); ++i)
            if (all[i].id == id) return {static_cast<std::uint16_t>(i), all[i].first};
        ADD_FAILURE() << id;
        return {};
    }
    Result store() { return ask(Action{"store_parameters", ""}); }
};

TEST(ApossAdapter, TwoAxesOfOneNodeAreTwoAxes) {
    Line b;
    ASSERT_TRUE(b.link.online) << b.link.text;
    EXPECT_NE(b.link.text.find("MACS controller"), std::string::npos) << b.link.text;
    ASSERT_TRUE(good(b.ask(Enable{}, 10s, 1)));
    EXPECT_EQ(b.of_axis[AxisId{1}].statusword.value_or(0) & 0x6F, 0x27);
    EXPECT_EQ(b.of_axis[AxisId{0}].statusword.value_or(0) & 0x6F, 0x40) << "the other one stays off";
    ASSERT_TRUE(good(b.ask(Enable{}, 10s, 0)));
    ASSERT_TRUE(good(b.ask(Line::to(4000), 10s, 0)));
    ASSERT_TRUE(good(b.ask(Line::to(-2000), 10s, 1)));
    b.run(3s);
    EXPECT_EQ(b.of_axis[AxisId{0}].position, 4000);
    EXPECT_EQ(b.of_axis[AxisId{1}].position, -2000);
    EXPECT_TRUE(b.of_axis[AxisId{0}].target_reached && b.of_axis[AxisId{1}].target_reached);
}

TEST(ApossAdapter, AStopOfOneAxisLeavesTheOtherMoving) {
    Line b;
    for (const int axis : {0, 1}) {
        ASSERT_TRUE(good(b.ask(Enable{}, 10s, axis)));
        ASSERT_TRUE(good(b.ask(Line::to(1'000'000), 10s, axis)));
    }
    b.run(200ms);
    ASSERT_TRUE(good(b.ask(Halt{}, 10s, 1)));
    b.run(1s);
    EXPECT_FALSE(b.of_axis[AxisId{1}].moving);
    EXPECT_TRUE(b.of_axis[AxisId{0}].moving);
}

TEST(ApossAdapter, AParameterIsThatOfItsScopeAndAxis) {
    Line b;
    ASSERT_TRUE(good(b.write("JERKMIN3", 77, 1)));
    EXPECT_EQ(as_integer(b.read("JERKMIN3", 1).value), 77);
    EXPECT_EQ(as_integer(b.read("JERKMIN3", 0).value), 0);
    EXPECT_EQ(as_integer(b.read("CANBAUD", 0).value), 5);
    EXPECT_EQ(as_integer(b.read("CANBAUD", 1).value), 5) << "the controller's, whichever axis asks";
    EXPECT_EQ(as_integer(b.read("VELMAXQC", 1).value), 2'184'533);
    const Result refused = b.write("SYNCFACTM", 0, 1);
    EXPECT_FALSE(good(refused));
    EXPECT_EQ(refused.reason, Reason::drive_refused) << refused.text;
}

TEST(ApossAdapter, TheEpromIsNotWrittenInACircle) {
    Line b;
    const Result first = b.store();
    ASSERT_TRUE(good(first)) << first.text;
    EXPECT_NE(first.text.find("write 1"), std::string::npos) << first.text;
    EXPECT_EQ(b.reported("eprom"), 1) << "the journal counts them";
    const Result second = b.store();
    EXPECT_FALSE(good(second));
    EXPECT_NE(second.text.find("EPROM"), std::string::npos) << second.text;
    b.run(61s);
    EXPECT_TRUE(good(b.store()));
    EXPECT_EQ(b.reported("eprom"), 2);
}

TEST(ApossAdapter, AnErrorNumberOfTheManualIsToldAsThatNumber) {
    Line b;
    ASSERT_TRUE(good(b.ask(Enable{})));
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "inject_error", Value{std::int64_t{98}}, b.now), "");
    b.run(500ms);
    EXPECT_TRUE(b.of_axis[AxisId{0}].fault);
    EXPECT_EQ(b.of_axis[AxisId{0}].error_code, 98);
    EXPECT_FALSE(b.of_axis[AxisId{1}].fault);
}

/// Answers for a node without a CiA 402 application: the profile's objects do not exist.
struct Bare final : Twin {
    std::unique_ptr<Twin> inner = macs();
    void on_frame(const Frame& f, Instant now, Out& out) override {
        if (f.id == 0x605 && f.size == 8 && (f.storage[2] & 0xF0) == 0x60) {
            Frame no = f;
            no.id = 0x585;
            no.storage[0] = 0x80;
            no.storage[4] = no.storage[5] = 0;
            no.storage[6] = 2;
            no.storage[7] = 6;
            no.at = now;
            return out.send(no);
        }
        inner->on_frame(f, now, out);
    }
    void on_deadline(Instant now, Out& out) override { inner->on_deadline(now, out); }
    [[nodiscard]] Instant deadline() const override { return inner->deadline(); }
    void power_on(const NonVolatile& memory, Instant now, Out& out) override { inner->power_on(memory, now, out); }
    [[nodiscard]] NonVolatile non_volatile() const override { return inner->non_volatile(); }
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return inner->non_volatile_revision(); }
    [[nodiscard]] std::vector<HandItem> hand() const override { return inner->hand(); }
    [[nodiscard]] std::string set_hand(const std::string& name, const Value& v, Instant now, Out& out) override {
        return inner->set_hand(name, v, now, out);
    }
    [[nodiscard]] TwinMechanics mechanics(int channel, Instant now) const override { return inner->mechanics(channel, now); }
};

TEST(ApossAdapter, AControllerWithoutCia402IsServedByItsParametersAlone) {
    Line b(std::make_unique<Bare>());
    ASSERT_TRUE(b.link.online) << b.link.text;
    EXPECT_EQ(as_integer(b.read("VELMAX").value), 1000);
    const Result r = b.ask(Enable{});
    EXPECT_EQ(r.reason, Reason::not_supported);
    EXPECT_NE(r.text.find("its own program moves it"), std::string::npos) << r.text;
    b.run(5s);
    EXPECT_TRUE(b.link.online);
}

TEST(ApossAdapter, ASiteMaySayWhereTheParametersStand) {
    Line b(macs(), {{"object_2200", "8960"}});  // a drive with its global parameters at 2300h
    EXPECT_EQ(as_integer(b.read("I_PRGSTART").value), 1000) << "2300h:104 of this controller is VELKILIM";
    EXPECT_EQ(as_integer(b.read("CANBAUD").value), 0) << "and 2300h:102 JERKMIN3";
}

TEST(ApossAdapter, ANodeThatIsNoMacsIsSaidToBeNone) {
    TwinSetup t;
    t.address = "5";
    t.kind = LineKind::can;
    Line b(cia402_drive::twin::make_twin(t));
    EXPECT_FALSE(b.link.online);
    EXPECT_NE(b.link.text.find("no MACS controller"), std::string::npos) << b.link.text;
}

TEST(ApossAdapter, TheDecoderNamesParametersAndTheSecondAxis) {
    const auto decoder = family_aposs().make_decoder(page(), LineKind::can);
    const auto line = [&](std::uint32_t id, std::vector<std::uint8_t> bytes) {
        return decoder->on_frame(canopen::data_frame(id, bytes), std::nullopt).at(0);
    };
    EXPECT_EQ(line(0x605, {0x40, 0x01, 0x23, 0x02, 0, 0, 0, 0}), "node 5: read 2301h:02 velmax of axis 2?");
    EXPECT_EQ(line(0x585, {0x43, 0x01, 0x23, 0x02, 0xE8, 3, 0, 0}), "node 5: read 2301h:02 velmax of axis 2 = 1000");
    EXPECT_EQ(line(0x605, {0x40, 0x64, 0x68, 0, 0, 0, 0, 0}), "node 5: read 6864h:00 position_actual_value of axis 2?");
}

}  // namespace
}  // namespace axisgate::aposs::test
