// Twin, the tester's hand and the memory: power, silence, refusals, what survives power off.
// In: hand, commands. Out: what the wire shows; the memory as named values.
#include "adapters/pacontrol/tests/twin_bench.hpp"

namespace axisgate::pacontrol::twin::test {
namespace {

TEST(TwinHand, WhatIsListedCanBeWrittenBack) {
    for (const int axes : {1, 3}) {
        Bench b(setup(axes));
        b.online();
        b.good("0A98;1;0;0");
        const auto items = b.twin().hand();
        EXPECT_EQ(items.size(), 9u + 12u * static_cast<unsigned>(axes));
        for (const HandItem& item : items) {
            EXPECT_FALSE(item.description.empty()) << item.name;
            const bool holds = item.name.ends_with("position") && item.name != "position";  // those axes are on
            const bool mode = item.name == "panel";
            if (item.writable && !holds && !mode) b.hand(item.name, item.value);
        }
    }
}

TEST(TwinHand, RefusalsSayWhatWouldBeRight) {
    Bench b;
    EXPECT_NE(b.refused("fly", true).find("limit_positive"), std::string::npos);
    EXPECT_NE(b.refused("axis5.stall", true).find("axis4"), std::string::npos);
    EXPECT_NE(b.refused("axis2.fly", true).find("stall"), std::string::npos);
    for (const char* flag : {"power", "silent", "stall", "limit_positive", "external_stop", "I5", "axis2.home_switch", "power_pack"})
        b.refused(flag, std::string("perhaps"));
    b.refused("inputs", std::int64_t{-1});
    b.refused("inject_error", std::int64_t{1000});
    b.refused("temperature", 900.0);
    b.refused("load", 2.0);
    b.refused("I1025", true);
    b.refused("I0", true);
    for (const char* bad : {"I33", "33=1", "I33=2", "I0=1", "I1025=0", "=1", "O3=1", "I=1"})
        b.refused("input", std::string(bad));
    b.refused("input", true);
    b.refused("program", std::string("NONE"));
    b.refused("position", std::int64_t{0});
    b.refused("panel", std::int64_t{1});
    b.hand("power", false);
    b.refused("panel", std::string("home"));
    b.refused("inject_error", std::int64_t{5});
    b.refused("axis2.inject_error", std::int64_t{5});
}

TEST(TwinHand, PowerAndSilence) {
    Bench b;
    b.good("0906;5;0;77");
    b.good("0902;3;0;1");
    b.hand("silent", true);
    EXPECT_TRUE(b.bytes(frame("0906;6;0;88")).empty());
    b.hand("silent", false);
    EXPECT_EQ(b.value("1906;6;0;0"), 88) << "heard and done";
    b.online();
    b.good("0A94;1;1;1000");
    b.pass(1s);
    b.hand("power", false);
    EXPECT_TRUE(b.bytes(frame("1906;5;0;0")).empty());
    EXPECT_EQ(b.twin().deadline(), never);
    EXPECT_FALSE(b.twin().mechanics(1, b.now).powered);
    const double stood = b.twin().mechanics(1, b.now).position;
    b.pass(10s);
    EXPECT_EQ(b.twin().mechanics(1, b.now).position, stood);
    b.hand("power", true);
    EXPECT_EQ(b.status(), 1);
    EXPECT_EQ(b.value("1906;5;0;0"), 77) << "battery-backed (E-65)";
    EXPECT_EQ(b.value("1902;3;0;0"), 0) << "outputs are not";
    EXPECT_NEAR(b.position(1) * 1000, stood, 1) << "absolute system";
}

TEST(TwinHand, InputsSurviveAndMasksAreBits) {
    Bench b;
    b.hand("inputs", std::int64_t{0x80000011});
    EXPECT_EQ(b.value("1900;1;0;0"), 1);
    EXPECT_EQ(b.value("1900;5;0;0"), 1);
    EXPECT_EQ(b.value("1900;32;0;0"), 1);
    EXPECT_EQ(b.value("1900;2;0;0"), 0);
    b.hand("I33", true);
    EXPECT_EQ(b.value("1901;40;0;0"), 1);
    b.hand("input", std::string("I1024=1"));
    EXPECT_EQ(b.value("1900;1024;0;0"), 1);
    b.hand("input", std::string("I1024=0"));
    EXPECT_EQ(b.value("1900;1024;0;0"), 0);
    b.hand("power", false);
    b.hand("power", true);
    EXPECT_EQ(b.value("1900;5;0;0"), 1) << "the world outside has not changed";
}

TEST(TwinHand, MemoryComesBackAsItWas) {
    Bench b(setup(3, {{"programs", "START:10,OTHER:20"}}));
    const std::uint64_t before = b.twin().non_volatile_revision();
    b.good("0906;5;0;-12");
    b.good("0907;1024;1;640.5");
    b.good("0904;1024;0;1");
    b.good("0905;1;0;3");
    b.good("0700;1;0;3");
    b.good("0800;774;1;123.25");
    b.hand("program", std::string("OTHER"));
    EXPECT_GE(b.twin().non_volatile_revision(), before + 7);
    b.online();
    b.good("0A94;2;1;12.5");
    b.stand(2);
    b.good("0A86;3;1;7");
    const NonVolatile memory = b.twin().non_volatile();
    EXPECT_EQ(memory.at("N5"), Value{std::int64_t{-12}});
    EXPECT_EQ(memory.at("R1024"), Value{640.5});
    EXPECT_EQ(memory.at("M1024"), Value{true});
    EXPECT_EQ(memory.at("axis3.parameter.6"), Value{123.25});
    EXPECT_EQ(memory.at("system.1"), Value{std::int64_t{3}});
    EXPECT_EQ(memory.at("axis2.position"), Value{12.5});

    Bench again(setup(3, {{"programs", "START:10,OTHER:20"}}), memory);
    EXPECT_EQ(again.twin().non_volatile(), memory);
    EXPECT_EQ(again.value("1907;1024;1;0"), 640.5);
    EXPECT_EQ(again.position(2), 12.5);
    EXPECT_EQ(again.position(3), 7);
    EXPECT_EQ(again.twin().mechanics(3, again.now).position, 0);
    again.online();
    EXPECT_EQ(again.quit("0A94;3;1;10006"), 0) << "the shift of G29 is kept with the position";
}

TEST(TwinHand, RevisionTellsOfEveryChange) {
    Bench b;
    std::uint64_t revision = b.twin().non_volatile_revision();
    NonVolatile memory = b.twin().non_volatile();
    const auto look = [&](const char* what, bool changes) {
        EXPECT_EQ(b.twin().non_volatile_revision() != revision, changes) << what;
        if (!changes) EXPECT_EQ(b.twin().non_volatile(), memory) << what;
        revision = b.twin().non_volatile_revision();
        memory = b.twin().non_volatile();
    };
    b.good("0906;5;0;1");
    look("N", true);
    b.good("0906;5;0;1");
    look("N again", false);
    b.good("0902;5;0;1");
    look("output", false);
    b.online();
    b.good("0A94;1;1;100");
    look("start", false);
    b.pass(200ms);
    look("under way", false);
    b.stand(1);
    look("end", true);
    b.good("0A98;1;0;0");
    b.pass(10ms);
    revision = b.twin().non_volatile_revision();
    b.hand("position", std::int64_t{5000});
    look("pushed", true);
}

TEST(TwinHand, WithoutAnAbsoluteSystemTheReferenceGoesWithThePower) {
    Bench b(setup(1, {{"absolute", "off"}}), {{"axis1.shaft", 25.0}, {"axis1.position", 25.0}});
    EXPECT_EQ(b.position(1), 0);
    EXPECT_EQ(b.value("1934;51;0;0"), 0);
    EXPECT_NEAR(b.twin().mechanics(1, b.now).position, 25000, 1e-6);
    const NonVolatile memory = b.twin().non_volatile();
    EXPECT_FALSE(memory.contains("axis1.position"));
}

TEST(TwinHand, ForeignMemoryIsLeftAtThat) {
    Bench b(setup(2), {{"N0", std::int64_t{1}},
                       {"N1025", std::int64_t{1}},
                       {"Nx", std::int64_t{1}},
                       {"R5", std::string("text")},
                       {"axis1.parameter.99", 1.0},
                       {"axis1.parameter.6", -5.0},
                       {"axis9.position", 1.0},
                       {"axis1.position", 1e300},
                       {"system.2", std::int64_t{99}},
                       {"program", std::string("NONE")},
                       {"", true}});
    EXPECT_EQ(b.value("1700;2;0;0"), 2);
    EXPECT_GT(b.value("1800;262;1;0"), 0) << "held to its limits";
    EXPECT_EQ(b.position(1), 1e9);
}

TEST(TwinHand, Temperature) {
    Bench b;
    b.hand("axis2.temperature", 71.5);
    EXPECT_EQ(b.value("1920;2;1;0"), 71.5);
    EXPECT_EQ(b.value("1920;1;1;0"), 35);
    b.hand("load", 1.0);
    b.online();
    b.good("0A94;1;1;5000");
    b.pass(2s);
    EXPECT_NEAR(b.value("1915;1;1;0"), 0.5 / 10 * 3200, 1) << "1 ms of the way at 500 AE/s";
}

TEST(TwinHand, OptionsThatCannotBeReadAreLeft) {
    Bench b(setup(99, {{"home_ms", "soon"},
                       {"start_ms", "-1"},
                       {"programs", "X,Y:z,:5,W:1:5000"},
                       {"check", "learn"},
                       {"switch_on_mode", "9"},
                       {"lasting_errors", "300,x,99999"}}));
    EXPECT_EQ(b.control().axes(), 16);
    EXPECT_EQ(b.control().programs().chosen().name, "START");
    EXPECT_EQ(b.quit("1900;1;0;0"), 0);
    b.hand("inject_error", std::int64_t{300});
    EXPECT_EQ(b.quit("0909;0;0;0"), 21);
}

}  // namespace
}  // namespace axisgate::pacontrol::twin::test
