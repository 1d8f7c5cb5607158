// The recorded telegrams with the simulated gateway as receiver; and the end of a velocity move that is not renewed.
#include <gtest/gtest.h>

#include <fstream>

#include "adapters/remote/twin/axis.hpp"
#include "adapters/remote/twin/twin.hpp"

namespace axisgate::remote::twin::test {
namespace {
using namespace std::chrono_literals;

TEST(RemoteTwin, AnswersAsTheVectorsSay) {
    TwinSetup setup;
    setup.address = "hall-2/feeder";
    const auto twin = make_twin(setup);
    Out out;
    const Instant now = time_zero + 1s;
    twin->power_on({}, now, out);
    std::ifstream f(AXISGATE_SOURCE_DIR "/adapters/remote/vectors.txt");
    std::string line, name;
    int answers = 0;
    while (std::getline(f, line)) {
        if (line.starts_with("case ")) name = line;
        if (line.starts_with("> ")) {
            out.clear();
            const std::string s = line.substr(2) + "\n";
            twin->on_frame(Frame::run({reinterpret_cast<const std::uint8_t*>(s.data()), s.size()}), now, out);
        }
        if (!line.starts_with("< ")) continue;
        ASSERT_EQ(out.frames.size(), 1u) << name;
        const Frame& a = out.frames[0].frame;
        EXPECT_EQ(std::string(reinterpret_cast<const char*>(a.data().data()), a.size), line.substr(2) + "\n") << name;
        ++answers;
    }
    EXPECT_GE(answers, 15);
}

TEST(RemoteTwin, AHeldMoveEndsAtItsInstantWheneverItIsAsked) {
    for (const Duration step : {Duration(1ms), Duration(10s)}) {
        Axis a;
        Instant now = time_zero + 1s;
        ASSERT_EQ(a.order({.verb = "enable"}, now).outcome, Outcome::accepted);
        ASSERT_EQ(a.order({.verb = "move_velocity", .velocity = 1000, .acceleration = 10000, .deceleration = 10000, .hold_ms = 2000}, now)
                      .outcome,
                  Outcome::accepted);
        ASSERT_EQ(a.order({.verb = "move_velocity", .hold_ms = 2000, .renew = true}, now + 1s).outcome, Outcome::accepted);
        for (const Instant end = now + 10s; now < end; a.advance(now += step))
            ;
        // 0.1 s acceleration, constant speed until 3 s after the start, 0.1 s deceleration.
        EXPECT_NEAR(a.mechanics(now).position, 3000 - 50 + 50, 1e-6);
        EXPECT_EQ(a.mechanics(now).velocity, 0);
    }
}

}  // namespace
}  // namespace axisgate::remote::twin::test
