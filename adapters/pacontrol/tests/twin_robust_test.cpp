// Twin, robustness: random requests, bytes, hands and times; the laws of twin.hpp hold. And the wire's honest time on a TwinBus.
// In: seeded random numbers. Out: whole acknowledgements, finite mechanics, a memory whose revision tells of every change.
#include <cmath>
#include <random>

#include "adapters/pacontrol/tests/twin_bench.hpp"
#include "adapters/pacontrol/twin/commands.hpp"
#include "gateway/wire/twin_bus.hpp"

namespace axisgate::pacontrol::twin::test {
namespace {

TEST(TwinRobust, LawsUnderRandomUse) {
    for (unsigned seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        const auto pick = [&](int least, int largest) { return std::uniform_int_distribution<int>(least, largest)(random); };
        std::map<std::string, std::string> options{{"switch_on_mode", std::to_string(seed % 5)}, {"programs", "A:50,B:20:510"}};
        if (seed % 3 == 0) options["absolute"] = "off";
        if (seed % 4 == 0) options["axis_modules"] = "on";
        if (seed % 5 == 0) options["position_every_ms"] = "3";
        Bench b(setup(3, options));
        std::uint64_t revision = b.twin().non_volatile_revision();
        NonVolatile memory = b.twin().non_volatile();
        for (int step = 0; step < 1500; ++step) {
            switch (pick(0, 9)) {
                case 0: {
                    Bytes noise;
                    for (int i = pick(1, 20); i > 0; --i)
                        noise.push_back(static_cast<std::uint8_t>(pick(0, 3) != 0 ? pick(0, 8) : pick(0, 255)));
                    b.bytes(noise);
                    break;
                }
                case 1:
                case 2:
                    b.pass(std::chrono::milliseconds(pick(0, 3) == 0 ? pick(0, 60'000) : pick(0, 300)));
                    break;
                case 3: {
                    const auto items = b.twin().hand();
                    const auto& item = items[static_cast<std::size_t>(pick(0, static_cast<int>(items.size()) - 1))];
                    if (item.name == "power" && pick(0, 3) != 0) break;
                    const std::vector<Value> values{true,
                                                    false,
                                                    std::int64_t{pick(-5, 999)},
                                                    std::int64_t{pick(-1, 1)},
                                                    0.5,
                                                    std::string("home"),
                                                    std::string("manual"),
                                                    std::string("B"),
                                                    std::monostate{}};
                    Out out;
                    (void)b.twin().set_hand(item.name, values[static_cast<std::size_t>(pick(0, 8))], b.now, out);
                    (void)b.twin().set_hand("silent", false, b.now, out);
                    break;
                }
                default: {
                    const auto rows = command_rows();
                    const auto& row = rows[static_cast<std::size_t>(pick(0, static_cast<int>(rows.size()) - 1))];
                    char code[8];
                    std::snprintf(code, sizeof code, "%04X", pick(0, 3) == 0 ? 0x0603 : row.code);
                    const int parameter = pick(0, 4) == 0 ? pick(0, 1100) : pick(0, 4);
                    b.bytes(frame(std::string(code) + ";" + std::to_string(parameter) + ";1;" + std::to_string(pick(-2000, 2000))));
                    break;
                }
            }
            for (int n = 1; n <= 3; ++n) {
                const auto m = b.twin().mechanics(n, b.now);
                ASSERT_TRUE(std::isfinite(m.position) && std::isfinite(m.velocity));
            }
            ASSERT_GE(b.twin().deadline(), b.now);
            if (b.twin().non_volatile_revision() == revision) {
                ASSERT_EQ(b.twin().non_volatile(), memory) << "step " << step;
            } else {
                ASSERT_GT(b.twin().non_volatile_revision(), revision);
                revision = b.twin().non_volatile_revision();
                memory = b.twin().non_volatile();
            }
            if (pick(0, 99) == 0) {
                Out out;
                b.twin().power_on(memory, b.now, out);
                ASSERT_EQ(b.twin().non_volatile(), memory) << "step " << step;
                revision = b.twin().non_volatile_revision();
            }
        }
        EXPECT_GT(b.raw.size(), 300u) << "it was talked with";
    }
}

/// The same calls, however time is cut into pieces, give the same bytes.
TEST(TwinRobust, TimeMayComeInAnyPieces) {
    const auto run = [](Duration piece) {
        Bench b(setup(2, {{"programs", "A:700:510"}}));
        b.online();
        b.good("0A94;1;1;800");
        b.good("0A90;2;1;300");
        std::vector<std::string> reported;
        for (int i = 0; i < 6; ++i) {
            for (Duration t{}; t < 600ms; t += piece)
                b.pass(piece);
            for (const char* text : {"190C;1;1;0", "190C;2;1;0", "1911;0;0;0", "190B;0;0;0"})
                reported.push_back(b.ask(text));
        }
        return reported;
    };
    const auto once = run(600ms);
    EXPECT_EQ(run(1ms), once);
    EXPECT_EQ(run(200ms), once);
}

class Ear final : public LineEvents {
public:
    std::vector<std::uint8_t> bytes;
    Instant last{};
    void on_frame(const Frame& f) override {
        bytes.insert(bytes.end(), f.data().begin(), f.data().end());
        last = f.at;
    }
    void on_line_state(bool, const std::string&) override {}
    void on_sent(const Frame&) override {}
};

/// 9600 baud 7N1: 9 bits a byte, both ways; the control itself takes no time unless it is told to.
TEST(TwinRobust, HonestWireTime) {
    static const Catalogue catalogue;
    TwinBus bus({LineKind::bytes, 9600, 9, true});
    Ear ear;
    const Instant start = time_zero + 1s;
    bus.add(DriveId{1}, make_twin(catalogue, setup(1)), {}, start);
    bus.open(ear, start);
    bus.on_deadline(start);
    const Bytes request = frame("0906;5;0;12345");
    ASSERT_TRUE(bus.send(Frame::run(request), Priority::command, start));
    for (int i = 0; i < 1000 && bus.deadline() <= start + 1s; ++i)
        bus.on_deadline(bus.deadline());
    ASSERT_FALSE(ear.bytes.empty());
    EXPECT_EQ(ear.bytes, hex("01 02 30 3B 31 3B 31 3B 30 3B 30 3B 31 32 33 34 35 03 35 37 04"));
    const double wanted = static_cast<double>((request.size() + ear.bytes.size()) * 9) / 9600;
    EXPECT_NEAR(seconds(ear.last - start), wanted, 1e-6);
}

}  // namespace
}  // namespace axisgate::pacontrol::twin::test
