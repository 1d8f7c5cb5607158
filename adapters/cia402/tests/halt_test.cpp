// A halt is released before the next order, and no mode is changed under it; the interrupted motion is never continued.
#include <cmath>
#include <string>

#include "adapters/cia402/tests/manners_bench.hpp"

namespace axisgate::cia402_drive::test {
namespace {

struct Halted : Manners {
    double stood = 0;    ///< where the axis stands under the halt
    bool loose = false;  ///< friction keeps the shaft an increment from its target
    [[nodiscard]] double looseness() const { return loose ? 2 : 0; }

    explicit Halted(const Options& of_twin, Options of_drive = {})
        : Manners(of_twin, std::move(of_drive)), loose(of_twin.contains("friction_increments")) {
        run(2s);
        EXPECT_TRUE(enable());
    }
    void halt() {
        run(150ms);
        EXPECT_TRUE(axis.moving);
        ASSERT_TRUE(good(ask(Halt{})));
        run(2s);
        ASSERT_FALSE(axis.moving);
        stood = place();
    }
    void expect_stands(const char* what) {
        for (int i = 0; i < 30; ++i) {
            run(100ms);
            EXPECT_NEAR(place(), stood, 1) << what;
            if (std::fabs(place() - stood) > 1) return;
        }
        EXPECT_FALSE(axis.moving) << what;
    }
};
void begin_move(Halted& b) { EXPECT_TRUE(good(b.ask(LineBench::to(static_cast<std::int64_t>(b.place()) + 1'000'000)))) << "mode 1"; }
void begin_velocity(Halted& b) { EXPECT_TRUE(good(b.ask(speed(8'000)))) << "mode 3"; }
void begin_stream(Halted& b) {
    b.follow(led_to(static_cast<std::int64_t>(b.place()) + 1'000'000, 8'000));
    b.run(900ms);
}
void begin_homing(Halted& b) { EXPECT_TRUE(good(b.ask(Home{33}))) << "mode 6"; }

std::string told(const Options& of_twin) {
    std::string text;
    for (const auto& [name, value] : of_twin)
        text += ", " + name + " " + value;
    return text;
}

/// What a drive may do with a change of mode, and how late it shows things.
const Options manners[] = {{},
                           {{"mode_refusal", "1"}},
                           {{"mode_refusal", "3"}},
                           {{"mode_refusal", "3"}, {"mode_shown_ms", "300"}},
                           {{"mode_refusal", "3"}, {"control_sample_ms", "10"}},
                           {{"mode_refusal", "3"}, {"acknowledge_ms", "100"}},
                           {{"mode_refusal", "2"}, {"mode_refusal_silent", "1"}},
                           {{"mode_refusal", "3"}, {"mode_refusal_silent", "1"}, {"friction_increments", "1"}, {"damping_percent", "60"}}};
constexpr std::pair<const char*, void (*)(Halted&)> motions[] = {
    {"move", begin_move}, {"velocity", begin_velocity}, {"stream", begin_stream}, {"homing", begin_homing}};

TEST(Cia402Halt, AnOrderOfAnotherModeIsTakenAndTheInterruptedMotionIsNotContinued) {
    for (const Options& of_twin : manners)
        for (const auto& [name, begin] : motions) {
            if (of_twin.contains("friction_increments") && begin != begin_stream) continue;  // what it is about
            SCOPED_TRACE(std::string(name) + told(of_twin));
            Halted b(of_twin);
            begin(b);
            b.halt();
            ASSERT_TRUE(good(b.ask(SetPosition{5'000})));  // a homing that does not move
            b.stood = b.place();
            b.expect_stands("position was set");
            begin(b);
            b.halt();
            const auto to = static_cast<std::int64_t>(b.axis.position) + 3'000;
            ASSERT_TRUE(good(b.ask(LineBench::to(to))));
            b.run(5s);
            EXPECT_NEAR(static_cast<double>(b.axis.position), static_cast<double>(to), b.looseness());
            EXPECT_FALSE(b.axis.moving);
            begin(b);
            b.halt();
            ASSERT_TRUE(good(b.ask(speed(-4'000))));
            b.run(2s);
            EXPECT_NEAR(b.speed(), -4'000, 1);
            b.halt();
            begin_stream(b);
            EXPECT_GT(b.speed(), 1'000) << (b.stream_ends.empty() ? "" : b.stream_ends.back().text);
        }
}

TEST(Cia402Halt, AnEnableReleasesTheHaltAndMovesNothing) {
    for (const Options& of_twin : manners)
        for (const auto& [name, begin] : motions)
            for (const bool restarted : {false, true}) {
                if (of_twin.contains("friction_increments") && begin != begin_stream) continue;
                SCOPED_TRACE(std::string(name) + told(of_twin) + (restarted ? ", restarted" : ""));
                Halted b(of_twin);
                begin(b);
                b.halt();
                if (restarted) {
                    b.restart_gateway();
                    b.run(3s);
                    b.expect_stands("found again");
                }
                b.words.clear();
                ASSERT_TRUE(b.enable());
                b.expect_stands("enabled");
                ASSERT_FALSE(b.words.empty());
                EXPECT_EQ(b.words.back(), 0x0F) << "no halt";
                const auto to = static_cast<std::int64_t>(b.axis.position) + 3'000;
                ASSERT_TRUE(good(b.ask(LineBench::to(to))));
                b.run(5s);
                EXPECT_NEAR(static_cast<double>(b.axis.position), static_cast<double>(to), b.looseness());
            }
}

TEST(Cia402Halt, AHaltBesideAQuickStopIsReleasedWithoutPower) {
    Halted b({{"mode_refusal", "3"}}, {{"quick_stop_stays", "yes"}});
    begin_move(b);
    b.run(400ms);
    ASSERT_TRUE(good(b.ask(QuickStop{})));
    ASSERT_TRUE(good(b.ask(Halt{})));
    b.run(2s);
    b.stood = b.place();
    ASSERT_TRUE(b.enable());
    b.expect_stands("enabled");
    ASSERT_TRUE(good(b.ask(speed(4'000))));
    b.run(1s);
    EXPECT_NEAR(b.speed(), 4'000, 1);
}

}  // namespace
}  // namespace axisgate::cia402_drive::test
