// The recorded telegrams with the simulated drive as receiver, and the accuracy of its motion.
#include <gtest/gtest.h>

#include <fstream>

#include "adapters/example/twin/axis.hpp"
#include "adapters/example/twin/twin.hpp"

namespace axisgate::example::twin::test {
namespace {
using namespace std::chrono_literals;

TEST(ExampleTwin, AnswersAsTheVectorsSay) {
    TwinSetup setup;
    setup.address = "5";
    const auto twin = make_twin(setup);
    Out out;
    Instant now = time_zero + 1s;
    twin->power_on({}, now, out);
    std::ifstream f(AXISGATE_SOURCE_DIR "/adapters/example/vectors.txt");
    std::string line, name;
    int answers = 0;
    while (std::getline(f, line)) {
        if (line.starts_with("case ")) name = line;
        if (line.starts_with("> ")) {
            out.clear();
            const std::string s = line.substr(2) + "\r";
            twin->on_frame(Frame::run({reinterpret_cast<const std::uint8_t*>(s.data()), s.size()}), now, out);
        }
        if (!line.starts_with("< ")) continue;
        ASSERT_EQ(out.frames.size(), 1u) << name;
        const Frame& a = out.frames[0].frame;
        EXPECT_EQ(std::string(reinterpret_cast<const char*>(a.data().data()), a.size), line.substr(2) + "\r") << name;
        ++answers;
    }
    EXPECT_GE(answers, 14);
}

TEST(ExampleTwin, ATrapezoidEndsAtItsTarget) {
    Axis a;
    const Instant t0 = time_zero + 1s;
    ASSERT_EQ(a.write(20, 1, t0), 0);
    ASSERT_EQ(a.write(21, 8000, t0), 0);  // 4000/s, 20000/s2: 0.2 s up, 1.8 s, 0.2 s down
    EXPECT_NEAR(a.mechanics(t0 + 100ms).position, 100, 1e-6);
    EXPECT_NEAR(a.mechanics(t0 + 1200ms).position, 400 + 4000, 1e-6);
    EXPECT_NEAR(a.mechanics(t0 + 2100ms).position, 8000 - 100, 1e-6);
    EXPECT_EQ(a.state(t0 + 2200ms), "5,8000,0,8000,0");
    ASSERT_EQ(a.write(21, 0, t0 + 3s), 0);
    ASSERT_EQ(a.write(21, 9000, t0 + 4s), 0);  // reversed during the motion: it decelerates and returns
    EXPECT_EQ(a.state(t0 + 20s), "5,9000,0,9000,0");
    ASSERT_EQ(a.write(22, -1000, t0 + 20s), 0);
    EXPECT_NEAR(a.mechanics(t0 + 21s).velocity, -1000, 1e-6);
    ASSERT_EQ(a.write(23, 0, t0 + 21s), 0);
    EXPECT_EQ(a.mechanics(t0 + 22s).velocity, 0);
}

TEST(ExampleTwin, AHeldShaftIsAFaultAtTheInstantOfItsLimit) {
    Axis fine, late;
    const Instant t0 = time_zero + 1s;
    for (Axis* a : {&fine, &late}) {
        ASSERT_EQ(a->write(20, 1, t0), 0);
        ASSERT_EQ(a->write(22, 4000, t0), 0);
        a->hold(true, t0 + 1s);
    }
    for (int ms = 1; ms <= 251; ++ms)
        fine.advance(t0 + 1s + ms * 1ms);
    EXPECT_EQ(fine.mechanics(t0 + 1251ms).powered, false) << "1000 increments behind after 250 ms";
    EXPECT_EQ(fine.state(t0 + 2s), late.state(t0 + 2s)) << "asked late, it tells the same";
    EXPECT_EQ(late.write(20, 1, t0 + 2s), 14);
    EXPECT_EQ(late.write(24, 1, t0 + 2s), 0);
    EXPECT_EQ(late.write(20, 1, t0 + 2s), 0);
}

}  // namespace
}  // namespace axisgate::example::twin::test
