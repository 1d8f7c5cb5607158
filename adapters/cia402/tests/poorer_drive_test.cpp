// The adapter with drives that have less than the profile: no PDOs, fixed ones, no velocity, demand, mode display or list of modes. Each is
// served with the parts that it has, and the missing ones are reported once.
#include <cmath>
#include <set>

#include "adapters/cia402/tests/line_bench.hpp"

namespace axisgate::cia402_drive::test {
namespace {

/// A twin behind a filter that refuses objects, as a drive without them does.
class PoorerTwin final : public Twin {
public:
    PoorerTwin(std::unique_ptr<Twin> twin, std::set<std::uint16_t> missing, std::uint32_t pdo_abort)
        : twin_(std::move(twin)), missing_(std::move(missing)), pdo_abort_(pdo_abort) {}

    void on_frame(const Frame& f, Instant now, Out& out) override {
        const auto d = f.data();
        const unsigned command = d.size() == 8 ? d[0] >> 5 : 0u;
        const bool read = command == 2, write = command == 1;
        if (f.id != 0x605 || (!read && !write)) return twin_->on_frame(f, now, out);
        const auto index = static_cast<std::uint16_t>(d[1] | d[2] << 8);
        if (busy_in > 0 && ++requests_ % busy_in != 0) return refuse(f, busy_abort, out);
        if (missing_.contains(index)) return refuse(f, 0x06020000, out);
        if (write && pdo_abort_ != 0 && index >= 0x1400 && index < 0x1C00) return refuse(f, pdo_abort_, out);
        const bool mapping = write && index >= 0x1600 && index < 0x1C00 && d[3] > 0;
        if (mapping && missing_.contains(static_cast<std::uint16_t>(d[6] | d[7] << 8))) return refuse(f, 0x06040041, out);
        twin_->on_frame(f, now, out);
    }
    void on_deadline(Instant now, Out& out) override { twin_->on_deadline(now, out); }
    [[nodiscard]] Instant deadline() const override { return twin_->deadline(); }
    void power_on(const NonVolatile& memory, Instant now, Out& out) override { twin_->power_on(memory, now, out); }
    [[nodiscard]] NonVolatile non_volatile() const override { return twin_->non_volatile(); }
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return twin_->non_volatile_revision(); }
    [[nodiscard]] std::vector<HandItem> hand() const override { return twin_->hand(); }
    [[nodiscard]] std::string set_hand(const std::string& n, const Value& v, Instant now, Out& out) override {
        return twin_->set_hand(n, v, now, out);
    }
    [[nodiscard]] TwinMechanics mechanics(int channel, Instant now) const override { return twin_->mechanics(channel, now); }

    /// Of so many SDO requests the twin refuses all but the last one, as a busy drive does. 0: none.
    int busy_in = 0;
    std::uint32_t busy_abort = 0x08000022;

private:
    int requests_ = 0;
    static void refuse(const Frame& request, std::uint32_t abort, Out& out) {
        std::array<std::uint8_t, 8> bytes{};
        std::ranges::copy(request.data().first(4), bytes.begin());
        bytes[0] = 0x80;
        for (std::size_t i = 0; i < 4; ++i)
            bytes[4 + i] = static_cast<std::uint8_t>(abort >> 8 * i);
        out.send(canopen::data_frame(0x585, bytes));
    }
    std::unique_ptr<Twin> twin_;
    std::set<std::uint16_t> missing_;
    std::uint32_t pdo_abort_;
};

struct Poorer : LineBench {
    int pdos = 0;
    PoorerTwin* drive = nullptr;  ///< owned by the bus
    explicit Poorer(std::set<std::uint16_t> missing, std::uint32_t pdo_abort = 0, int busy_in = 0) : LineBench(page(), 1) {
        TwinSetup t;
        t.address = "5";
        t.kind = LineKind::can;
        auto made = std::make_unique<PoorerTwin>(twin::make_twin(t), std::move(missing), pdo_abort);
        drive = made.get();
        drive->busy_in = busy_in;
        bus->add(DriveId{0}, std::move(made), {}, now);
        crossed = [this](const Frame& f) { pdos += f.id == 0x185 || f.id == 0x285; };
        open();
        run(2s);
    }
    [[nodiscard]] double place() { return bus->twin(DriveId{0})->mechanics(1, now).position; }
    [[nodiscard]] std::string lacks() const {
        const auto it = std::ranges::find(notices, "drive_lacks", &Notice::kind);
        return it == notices.end() ? std::string() : it->text;
    }
    void moves_and_stops() {
        ASSERT_TRUE(link.online) << link.text;
        ASSERT_TRUE(enable());
        Result r = ask(to(5'000));
        ASSERT_TRUE(good(r)) << r.text;
        EXPECT_TRUE(axis.moving) << "it is reported before the answer";
        run(200ms);
        EXPECT_TRUE(axis.moving);
        EXPECT_NEAR(static_cast<double>(axis.velocity), speed(), 3'000);
        run(3s);
        EXPECT_NEAR(place(), 5'000, 1);
        EXPECT_EQ(axis.position, 5'000);
        EXPECT_TRUE(axis.target_reached);
        EXPECT_FALSE(axis.moving);
        Move turn;
        turn.kind = Move::Kind::velocity;
        turn.target = 8'000;
        r = ask(turn);
        ASSERT_TRUE(good(r)) << r.text;
        run(500ms);
        EXPECT_NEAR(static_cast<double>(axis.velocity), 8'000, 400);
        ASSERT_TRUE(good(ask(QuickStop{})));
        run(1s);
        EXPECT_EQ(speed(), 0);
        EXPECT_EQ(axis.velocity, 0);
        EXPECT_FALSE(axis.moving);
    }
};

TEST(Cia402Poorer, ADriveWithoutPdosIsPolled) {
    Poorer b(
        {0x1400, 0x1401, 0x1402, 0x1403, 0x1600, 0x1601, 0x1602, 0x1603, 0x1800, 0x1801, 0x1802, 0x1803, 0x1A00, 0x1A01, 0x1A02, 0x1A03});
    b.moves_and_stops();
    EXPECT_NE(b.lacks().find("read by SDO"), std::string::npos) << b.lacks();
    EXPECT_EQ(b.reported("drive_lacks"), 1);
    SetPoint p;
    p.axis = AxisId{0};
    p.value = 6'000;
    p.velocity = 1'000;
    (void)b.enable();
    const double before = b.place();
    b.follow(p);
    b.run(1s);
    ASSERT_EQ(b.stream_ends.size(), 1u);
    EXPECT_EQ(b.stream_ends[0].reason, Reason::not_supported);
    EXPECT_EQ(b.place(), before);
}

TEST(Cia402Poorer, ADriveWithFixedPdosIsPolledAndTheyAreIgnored) {
    Poorer b({}, 0x06010002);  // "read only": in pre-operational as well
    b.moves_and_stops();
    EXPECT_NE(b.lacks().find("read by SDO"), std::string::npos) << b.lacks();
}

TEST(Cia402Poorer, ADriveThatFallsSilentIsNoticedByItsPolls) {
    Poorer b({}, 0x06010002);
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "silent", Value{true}, b.now), "");
    b.run(5s);
    EXPECT_FALSE(b.link.online);
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "silent", Value{false}, b.now), "");
    b.run(20s);
    EXPECT_TRUE(b.link.online) << b.link.text;
}

TEST(Cia402Poorer, WithoutADemandThePositionIsShown) {
    Poorer b({0x6062});
    b.moves_and_stops();
    EXPECT_GT(b.pdos, 100) << "its PDOs are used";
    EXPECT_EQ(b.axis.position_demand, b.axis.position);
    EXPECT_NE(b.lacks().find("6062h"), std::string::npos) << b.lacks();
}

TEST(Cia402Poorer, WithoutAVelocityItIsCalculatedFromPositions) {
    Poorer b({0x606C});
    b.moves_and_stops();
    EXPECT_GT(b.pdos, 100);
    EXPECT_NE(b.lacks().find("606Ch"), std::string::npos) << b.lacks();
}

TEST(Cia402Poorer, WithoutVelocityAndDemandTheStatusPdoIsEnough) {
    Poorer b({0x606C, 0x6062, 0x1801, 0x1A01});
    b.moves_and_stops();
    EXPECT_GT(b.pdos, 100);
}

TEST(Cia402Poorer, WithoutAModeDisplayTheOrderedModeIsShown) {
    Poorer b({0x6061});
    b.moves_and_stops();
    EXPECT_NE(b.lacks().find("6061h"), std::string::npos) << b.lacks();
}

TEST(Cia402Poorer, WithoutAListOfModesTheyAreTried) {
    Poorer b({0x6502});
    b.moves_and_stops();
}

TEST(Cia402Poorer, ADriveWithNothingOptionalAtAll) {
    Poorer b({0x6062, 0x606C, 0x6061, 0x6502, 0x605A, 0x1016, 0x60C2, 0x1010}, 0x06010002);
    b.moves_and_stops();
}

/// Its last report says that it is in a quick stop, which it has ended by itself since.
TEST(Cia402Poorer, AnEnableBehindAQuickStopThatTheDriveHasEndedBeginsAnew) {
    Poorer b({0x605A}, 0x06010002);
    for (int after_ms = 0; after_ms < 700; after_ms += 7) {
        Result r = b.ask(Enable{});
        ASSERT_TRUE(good(r)) << after_ms << " ms behind the quick stop: " << r.text;
        Move turn;
        turn.kind = Move::Kind::velocity;
        turn.target = 20'000;
        r = b.ask(turn);
        ASSERT_TRUE(good(r)) << after_ms << " ms behind the quick stop, enabled: " << r.text;
        b.run(500ms);
        ASSERT_TRUE(good(b.ask(QuickStop{})));
        b.run(std::chrono::milliseconds(after_ms));
    }
}

TEST(Cia402Poorer, ABusyDriveIsAskedAgain) {
    for (const std::uint32_t abort : {0x08000020u, 0x08000022u}) {
        SCOPED_TRACE(abort);
        Poorer b({});
        PoorerTwin& drive = *b.drive;
        drive.busy_abort = abort;
        drive.busy_in = 4;
        b.moves_and_stops();
        drive.busy_in = 1'000'000;
        const Instant before = b.now;
        const Result r = b.ask(Enable{});
        EXPECT_EQ(r.outcome, Outcome::refused) << "a drive that is busy for long";
        EXPECT_EQ(r.reason, Reason::drive_refused);
        EXPECT_LT(b.now - before, 1s);
    }
}

TEST(Cia402Poorer, ABusyDriveIsFoundWithItsPdos) {
    Poorer b({}, 0, 3);
    b.moves_and_stops();
    EXPECT_GT(b.pdos, 100);
    EXPECT_EQ(b.reported("drive_lacks"), 0) << b.lacks();
}

TEST(Cia402Poorer, AWholeDriveLacksNothing) {
    Poorer b({});
    b.moves_and_stops();
    EXPECT_EQ(b.reported("drive_lacks"), 0) << b.lacks();
}

}  // namespace
}  // namespace axisgate::cia402_drive::test
