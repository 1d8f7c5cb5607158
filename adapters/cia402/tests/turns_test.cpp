// SYNC cycles: 32 axes at 2 ms on one bus of 1 Mbit/s, nodes that count SYNCs differently, and sites that change during a stream. The tests
// observe each frame on the simulated bus: the time of SYNC, the load of a cycle, the age of feedback, and the motion of axes that follow
// set-points.
#include <fmt/core.h>

#include <cmath>

#include "adapters/cia402/tests/line_bench.hpp"
#include "gateway/core/wire_time.hpp"
#include "gateway/protocols/canopen/nmt.hpp"

namespace axisgate::cia402_drive::test {
namespace {

/// The frames between one SYNC and the next.
struct Beat {
    Instant sync{};
    std::uint64_t pdo_bits = 0, bits = 0;
    std::map<std::uint32_t, int> frames;
};

class TurnsBench : public LineBench {
public:
    std::vector<Beat> beats;
    std::map<AxisId, std::vector<Instant>> pictures;

    explicit TurnsBench(int nodes, Duration beat = 2ms) : LineBench(page(), 1) {
        setup.timing.poll_period = beat;
        setup.drives.clear();
        add(nodes);
        crossed = [this](const Frame& f) { note(f); };
    }
    void add(int nodes) {
        for (int i = 0; i < nodes; ++i) {
            const auto n = static_cast<std::uint16_t>(setup.drives.size());
            DriveSetup d;
            d.id = DriveId{n};
            d.name = fmt::format("servo{}", n + 1);
            d.address = std::to_string(n + 1);
            d.axes = {{AxisId{n}, 1}};
            setup.drives.push_back(d);
            TwinSetup t;
            t.address = d.address;
            t.kind = LineKind::can;
            bus->add(d.id, made(twin::make_twin(t)), {}, now);
        }
    }
    std::function<std::unique_ptr<Twin>(std::unique_ptr<Twin>)> made = [](auto twin) { return twin; };

    void run_all(double speed) {
        for (std::uint16_t n = 0; n < setup.drives.size(); ++n) {
            ASSERT_TRUE(good(ask(Enable{}, 10s, n))) << n;
            Move m;
            m.kind = Move::Kind::velocity;
            m.target = static_cast<std::int64_t>(speed) + n;
            m.acceleration = m.deceleration = 50'000;
            ASSERT_TRUE(good(ask(m, 10s, n))) << n;
        }
    }
    /// Records from the next complete cycle on.
    void watch(Duration d) {
        beats.clear();
        pictures.clear();
        feedback_from_ = feedback.size();
        run(d);
        ASSERT_GT(beats.size(), 2u);
        beats.erase(beats.begin());
        beats.pop_back();
    }
    [[nodiscard]] std::uint64_t most(std::uint64_t Beat::*what) const { return std::ranges::max(beats, {}, what).*what; }
    [[nodiscard]] Duration longest_gap() const {
        Duration longest{};
        for (std::size_t i = 1; i < beats.size(); ++i)
            longest = std::max(longest, beats[i].sync - beats[i - 1].sync);
        return longest;
    }
    /// The largest number of SYNCs between two status PDOs of a node; 0: it has sent at most one.
    [[nodiscard]] std::size_t turns(std::uint32_t node) const {
        std::size_t last = 0, most = 0;
        bool seen = false;
        for (std::size_t i = 0; i < beats.size(); ++i) {
            if (!beats[i].frames.contains(0x180 + node)) continue;
            if (seen) most = std::max(most, i - last);
            seen = true;
            last = i;
        }
        return most;
    }

private:
    void note(const Frame& f) {
        const std::uint64_t bits = can_bits(f) + can_intermission_bits;
        if (f.id == 0x80) beats.emplace_back().sync = f.at;
        if (beats.empty()) return;
        Beat& b = beats.back();
        b.bits += bits;
        if (f.id == 0x80 || (f.id >= 0x180 && f.id < 0x580)) b.pdo_bits += bits;
        ++b.frames[f.id];
    }
    std::size_t feedback_from_ = 0;
};

SetPoint set_point(int axis, std::int64_t place, std::int64_t speed = 40'000) {
    SetPoint p;
    p.axis = AxisId{static_cast<std::uint16_t>(axis)};
    p.mode = SetPoint::Mode::position;
    p.value = place;
    p.velocity = speed;
    p.acceleration = p.deceleration = 400'000;
    return p;
}
/// Moves axes evenly with one set-point each 2 ms. Records the lowest and the highest velocity of any axis in the middle of the way, and
/// whether an axis came to a standstill between two targets. `between` is called once, in the middle.
struct Led {
    double slowest = 1e9, fastest = 0;
};
std::vector<Led> lead(TurnsBench& b, const std::vector<int>& axes, Duration time, const std::function<void()>& between = {}) {
    constexpr double speed = 20'000;
    std::vector<Led> led(axes.size());
    std::vector<double> from;
    for (const int a : axes)
        from.push_back(static_cast<double>(b.of_axis[AxisId{static_cast<std::uint16_t>(a)}].position));
    const auto steps = time / 2ms;
    for (std::int64_t i = 0; i < steps; ++i) {
        for (std::size_t k = 0; k < axes.size(); ++k)
            b.follow(set_point(axes[k], static_cast<std::int64_t>(from[k] + speed * 0.002 * static_cast<double>(i))));
        if (between && i == steps / 2) between();
        for (int half = 0; half < 4; ++half) {
            b.run(500us);
            if (i < steps / 4) continue;
            for (std::size_t k = 0; k < axes.size(); ++k) {
                const double v = b.speed(axes[k]);
                led[k].slowest = std::min(led[k].slowest, v);
                led[k].fastest = std::max(led[k].fastest, v);
            }
        }
    }
    return led;
}

TEST(Cia402Turns, ThirtyTwoAxesAtTwoMilliseconds) {
    TurnsBench b(32);
    b.open();
    b.run(4s);
    for (const DriveSetup& d : b.setup.drives) {
        ASSERT_TRUE(b.of_drive[d.id].online) << d.name << ": " << b.of_drive[d.id].text;
        EXPECT_EQ(b.of_drive[d.id].beats, (DriveBeats{2ms, 16}));
    }
    b.run_all(10'000);
    EXPECT_EQ(b.reported("turns"), 0);
    b.watch(2s);
    EXPECT_NEAR(static_cast<double>(b.beats.size()), 1000, 3);
    EXPECT_LE(b.longest_gap(), 2ms + wire_time(canopen::most_bits(8), 1'000'000)) << "but for a frame that was on its way";
    EXPECT_LE(b.most(&Beat::pdo_bits), canopen::pdo_share(2ms, 1'000'000)) << "half of the bus is for others";
    EXPECT_LE(b.most(&Beat::bits), 2000u);
    for (std::uint32_t node = 1; node <= 32; ++node)
        EXPECT_EQ(b.turns(node), 16u) << "node " << node;
    for (const DriveSetup& d : b.setup.drives)
        EXPECT_LE(b.now - b.of_axis[d.axes[0].id].at, 32ms) << d.name;
}

TEST(Cia402Turns, AnAxisThatIsLedGetsATargetInEachBeatAndGoesSmoothly) {
    TurnsBench b(32);
    b.open();
    b.run(4s);
    b.run_all(10'000);
    ASSERT_TRUE(good(b.ask(Halt{}, 10s, 3)));
    b.run(1s);
    b.beats.clear();
    const Led l = lead(b, {3}, 1s)[0];
    EXPECT_NEAR(l.slowest, 20'000, 1'000) << "it does not stand between two targets";
    EXPECT_NEAR(l.fastest, 20'000, 1'000);
    EXPECT_TRUE(b.stream_ends.empty()) << b.stream_ends[0].text;
    b.beats.pop_back();
    for (std::size_t i = b.beats.size() / 2; i < b.beats.size(); ++i)
        ASSERT_EQ(b.beats[i].frames[0x204], 1) << "beat " << i;
    EXPECT_LE(b.most(&Beat::pdo_bits), canopen::pdo_share(2ms, 1'000'000));
    EXPECT_LE(b.longest_gap(), 2ms + wire_time(canopen::most_bits(8), 1'000'000)) << "targets do not hold the SYNC up";
    EXPECT_EQ(b.ask(Native{{'6', '0', 'C', '2', ':', '0', '1', '?'}, true}, 10s, 3).text, "2");
}

TEST(Cia402Turns, WhoIsLedLaterComesRoundMoreSeldomAndKnowsIt) {
    TurnsBench b(32);
    b.open();
    b.run(4s);
    std::vector<int> axes;
    for (int a = 0; a < 32; ++a) {
        ASSERT_TRUE(good(b.ask(Enable{}, 10s, a)));
        axes.push_back(a);
    }
    b.beats.clear();
    const auto led = lead(b, axes, 2s);
    ASSERT_TRUE(b.stream_ends.empty()) << b.stream_ends[0].text;
    std::map<std::string, int> times;
    for (const int a : axes) {
        EXPECT_NEAR(led[static_cast<std::size_t>(a)].slowest, 20'000, 1'500) << a;
        EXPECT_NEAR(led[static_cast<std::size_t>(a)].fastest, 20'000, 1'500) << a;
        ++times[b.ask(Native{{'6', '0', 'C', '2', ':', '0', '1', '?'}, true}, 10s, a).text];
    }
    EXPECT_EQ(times, (std::map<std::string, int>{{"2", 2}, {"16", 2}, {"32", 28}}));
    b.beats.erase(b.beats.begin(), b.beats.begin() + 300);  // until all have started
    EXPECT_LE(b.most(&Beat::pdo_bits), canopen::pdo_share(2ms, 1'000'000));
}

/// A node that misses SYNCs: the first ones after its start, or when the test requests it.
class Hard : public Twin {
public:
    Hard(std::unique_ptr<Twin> twin, std::uint8_t node, int late) : twin_(std::move(twin)), node_(node), late_(late) {}
    int misses = 0;
    void on_frame(const Frame& f, Instant now, Out& out) override {
        if (canopen::nmt_for(f, node_) == canopen::NmtCommand::start) misses = late_;
        if (canopen::is_data(f, 0x80) && misses > 0 && misses-- > 0) return;
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

private:
    std::unique_ptr<Twin> twin_;
    std::uint8_t node_;
    int late_;
};
/// 16 nodes, two in each cycle of the plan; `late` is the number of SYNCs that a node misses after its start.
struct HardBench : TurnsBench {
    std::vector<Hard*> nodes;
    explicit HardBench(const std::function<int(int)>& late) : TurnsBench(0) {
        made = [this, late](std::unique_ptr<Twin> twin) {
            const auto node = static_cast<std::uint8_t>(nodes.size() + 1);
            auto hard = std::make_unique<Hard>(std::move(twin), node, late(node));
            nodes.push_back(hard.get());
            return hard;
        };
        add(16);
        open();
        run(8s);
        run_all(10'000);
    }
    void each_in_its_beats() {
        watch(1s);
        EXPECT_EQ(reported("turns"), 0);
        for (std::size_t i = 0; i < beats.size(); ++i) {
            int pictures = 0;
            for (std::uint32_t node = 1; node <= 16; ++node)
                pictures += beats[i].frames.contains(0x180 + node) && beats[i].frames.contains(0x280 + node) ? 1 : 0;
            ASSERT_EQ(pictures, 2) << "beat " << i;
        }
        for (std::uint32_t node = 1; node <= 16; ++node)
            EXPECT_EQ(turns(node), 8u) << "node " << node;
    }
};

TEST(Cia402Turns, ANodeThatCountsOtherwiseIsMovedToItsBeats) {
    HardBench b([](int node) { return node % 4; });
    b.each_in_its_beats();
}

TEST(Cia402Turns, MissedSyncsAreMadeUpFor) {
    HardBench b([](int) { return 0; });
    b.each_in_its_beats();
    for (std::size_t i = 0; i < 5; ++i)
        b.nodes[i]->misses = 1 + static_cast<int>(i);
    b.run(2s);
    b.each_in_its_beats();
    b.deaf = true;  // and all of them miss three
    b.run(6ms);
    b.deaf = false;
    b.run(2s);
    b.each_in_its_beats();
}

TEST(Cia402Turns, DrivesThatComeToTheSiteChangeNothingForWhoIsLed) {
    TurnsBench b(2);
    b.open();
    b.run(2s);
    b.run_all(10'000);
    ASSERT_TRUE(good(b.ask(Halt{}, 10s, 1)));
    b.run(1s);
    EXPECT_EQ(b.of_drive[DriveId{0}].beats, (DriveBeats{2ms, 1}));
    const Led l = lead(b, {1}, 6s, [&] {
        b.add(30);
        b.setup.timing.poll_period = 5ms;  // and another cycle
        b.configure();
    })[0];
    EXPECT_TRUE(b.stream_ends.empty());
    EXPECT_NEAR(l.slowest, 20'000, 1'400) << "a SYNC may wait for a frame that is on its way: 135 us of 2 ms";
    EXPECT_NEAR(l.fastest, 20'000, 1'400);
    EXPECT_EQ(b.of_drive[DriveId{0}].beats, (DriveBeats{2ms, 16})) << "the beat stands while an axis is led";
    b.watch(500ms);
    EXPECT_LE(b.most(&Beat::pdo_bits), canopen::pdo_share(2ms, 1'000'000));
    ASSERT_TRUE(good(b.ask(Halt{}, 10s, 1)));
    b.run(4s);
    EXPECT_EQ(b.of_drive[DriveId{0}].beats, (DriveBeats{5ms, 5}));
    b.watch(1s);
    EXPECT_NEAR(static_cast<double>(b.beats.size()), 200, 3);
    EXPECT_LE(b.most(&Beat::pdo_bits), canopen::pdo_share(5ms, 1'000'000));
    for (std::uint32_t node = 1; node <= 32; ++node)
        EXPECT_EQ(b.turns(node), 5u) << "node " << node;
}

TEST(Cia402Turns, ATimeBetweenTargetsThatTheDriveRefusesEndsTheStream) {
    TurnsBench b(32);
    b.open();
    b.run(4s);
    b.run_all(10'000);
    b.follow(set_point(0, 1'000'000));  // it moves, and 60C2h is 20 ms as delivered
    b.run(500ms);
    ASSERT_EQ(b.stream_ends.size(), 1u);
    EXPECT_NE(b.stream_ends[0].text.find("60C2h"), std::string::npos) << b.stream_ends[0].text;
    EXPECT_EQ(b.speed(0), 10'000) << "it goes on as it was ordered";
}

TEST(Cia402Turns, AtRestAPictureIsAQuarterOfASecondOldAtMost) {
    TurnsBench b(32);
    b.open();
    b.run(4s);
    b.watch(2s);
    EXPECT_NEAR(seconds(b.longest_gap()), 0.008, 0.0003) << "a fourth of the beats";
    b.setup.timing.poll_period = 10ms;
    b.configure();
    b.run(4s);
    EXPECT_EQ(b.of_drive[DriveId{0}].beats, (DriveBeats{10ms, 2}));
    for (const DriveSetup& d : b.setup.drives)
        EXPECT_LE(b.now - b.of_axis[d.axes[0].id].at, 250ms) << d.name;
}

}  // namespace
}  // namespace axisgate::cia402_drive::test
