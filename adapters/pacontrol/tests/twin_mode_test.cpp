// Twin, the operating mode: who may do what when, transitions with their transitional states, errors by class, programs.
// In: commands, hand, time. Out: operating status, command errors, PA-CONTROL errors as told on the wire.
#include <functional>
#include <set>

#include "adapters/pacontrol/tests/twin_bench.hpp"
#include "adapters/pacontrol/twin/commands.hpp"

namespace axisgate::pacontrol::twin::test {
namespace {

/// Every operating status that is seen while time passes, in order.
std::vector<int> seen(Bench& b, Duration d, Duration step = 1ms) {
    std::vector<int> all;
    const auto look = [&] {
        const int s = b.control().status();
        if (all.empty() || all.back() != s) all.push_back(s);
    };
    look();
    for (Duration t{}; t < d; t += step) {
        b.pass(step);
        look();
    }
    return all;
}

TEST(TwinMode, StartOnlineTellsItselfInItsAcknowledgement) {
    Bench b;
    const Instant asked = b.now;
    EXPECT_TRUE(b.bytes(frame("0603;0;0;0")).empty());
    EXPECT_EQ(b.control().status(), 30);
    b.pass(10ms);
    ASSERT_EQ(b.raw.size(), 1u);
    EXPECT_EQ(b.when[0] - asked, 8ms);
    EXPECT_EQ(b.poll(), "0;1;31;0;0;0");
}

// T-11: a slow start is acknowledged at once with BE = 0 and the transitional state.
TEST(TwinMode, ASlowStartIsPolled) {
    Bench b(setup(1, {{"start_ms", "500"}}));
    EXPECT_EQ(b.ask("0603;0;0;0"), "0;0;30;0;0;0");
    EXPECT_EQ(b.poll(), "0;0;30;0;0;0");
    b.pass(600ms);
    EXPECT_EQ(b.poll(), "0;1;31;0;0;0");
    EXPECT_EQ(b.poll(), "0;1;31;0;0;0");
}

TEST(TwinMode, TransitionsOfOnline) {
    Bench b;
    b.bytes(frame("0603;0;0;0"));
    EXPECT_EQ(seen(b, 20ms), (std::vector<int>{30, 31}));
    b.good("0A94;1;1;1000");
    b.pass(1s);
    EXPECT_EQ(b.ask("0600;0;0;0"), "0;0;32;0;0;0");
    EXPECT_EQ(seen(b, 2s), (std::vector<int>{32, 35}));
    EXPECT_EQ(b.poll(), "0;1;35;0;0;0");
    EXPECT_EQ(b.quit("0A94;2;1;10"), 21) << "nothing begins in a stopped ONLINE";
    EXPECT_EQ(b.ask("0603;0;0;0"), "0;1;31;0;0;0") << "E-20: goes on";
    EXPECT_EQ(b.axis_status(1), 1) << "what was interrupted goes on";
    b.stand(1);
    EXPECT_EQ(b.position(1), 1000);
    b.good("0A94;1;1;0");
    b.pass(500ms);
    EXPECT_EQ(b.get("0A81;0;0;0").end, 0) << "axes must stand first";
    b.stand(1);
    EXPECT_EQ(b.ask("190B;0;0;0"), "0;1;1;0;0;1");
    EXPECT_GT(b.position(1), 0) << "the present position is taken over";
}

TEST(TwinMode, TransitionsOfAutomatic) {
    Bench b(setup(1, {{"programs", "START:1000"}}));
    b.bytes(frame("0602;0;0;0"));
    EXPECT_EQ(seen(b, 300ms), (std::vector<int>{10, 11}));
    EXPECT_EQ(b.poll(), "0;1;11;0;0;0");
    EXPECT_EQ(b.get("0600;0;0;0").end, 0) << "STOP program first";
    EXPECT_EQ(seen(b, 300ms), (std::vector<int>{13, 15}));
    b.pass(10s);
    EXPECT_EQ(b.status(), 15) << "a stopped program does not run on";
    EXPECT_EQ(b.get("0602;0;0;0").end, 0);
    EXPECT_EQ(seen(b, 2s), (std::vector<int>{16, 11, 1})) << "the rest of its second, then home position";
    b.good("0602;0;0;0");
    b.good("0A41;0;0;0");
    EXPECT_EQ(b.status(), 1);
}

TEST(TwinMode, AProgramThatFails) {
    Bench b(setup(1, {{"programs", "START:100:510,GOOD:100"}}));
    b.bytes(frame("0602;0;0;0"));
    EXPECT_EQ(seen(b, 500ms), (std::vector<int>{10, 11, 18, 19})) << "17 lasts while axes move: none does";
    EXPECT_EQ(b.value("1909;0;0;0"), 510);
    EXPECT_EQ(b.quit("0602;0;0;0"), 20) << "not from 19";
    b.good("0A41;0;0;0");
    EXPECT_EQ(b.ask("190B;0;0;0"), "0;1;1;0;0;1") << "errors of class 3 go on the way home";
    b.hand("program", std::string("GOOD"));
    b.good("0602;0;0;0");
    b.pass(1s);
    EXPECT_EQ(b.ask("1909;0;0;0"), "0;1;1;0;0;0");
}

TEST(TwinMode, AnErrorWhileAxesMoveIsRecognisedFirst) {
    Bench b;
    b.online();
    b.good("0A94;1;1;5000");
    b.pass(1s);
    b.hand("inject_error", std::int64_t{510});
    EXPECT_EQ(b.control().status(), 37);
    EXPECT_EQ(seen(b, 2s), (std::vector<int>{37, 39}));
    EXPECT_EQ(b.ask("1909;0;0;0"), "0;1;39;510;0;510");
    EXPECT_EQ(b.quit("0603;0;0;0"), 20);
    b.good("0A81;0;0;0");
    EXPECT_EQ(b.status(), 1);
}

TEST(TwinMode, AutomaticWithAnErrorWhileAnAxisBrakes) {
    Mode m{ModeTimes{}};
    ASSERT_TRUE(m.start_automatic({"P", 1s, 0}, time_zero));
    EXPECT_EQ(m.step(time_zero + 8ms, true), Mode::Entered::automatic);
    ASSERT_TRUE(m.malfunction(time_zero + 10ms));
    EXPECT_EQ(m.step(time_zero + 11ms, false), Mode::Entered::nothing);
    EXPECT_EQ(m.status(), 17);
    EXPECT_EQ(m.step(time_zero + 12ms, true), Mode::Entered::other);
    EXPECT_EQ(m.status(), 18);
    EXPECT_EQ(m.step(time_zero + 111ms, true), Mode::Entered::nothing);
    EXPECT_EQ(m.step(time_zero + 112ms, true), Mode::Entered::other);
    EXPECT_EQ(m.status(), 19);
}

/// The machine as a table: every event in every lasting state.
TEST(TwinMode, Table) {
    enum Event { start_auto, start_online, stop, resume_auto, resume_online, malfunction, cancel };
    struct Row {
        int from;
        std::array<int, 7> to;  // by Event; 0: refused
    };
    const std::vector<Row> table{
        {1, {10, 30, 0, 0, 0, 0, 1}}, {2, {0, 0, 0, 0, 0, 0, 1}},    {10, {0, 0, 12, 0, 0, 17, 1}}, {11, {0, 0, 12, 0, 0, 17, 1}},
        {12, {0, 0, 0, 0, 0, 17, 1}}, {13, {0, 0, 0, 0, 0, 17, 1}},  {15, {0, 0, 0, 16, 0, 17, 1}}, {16, {0, 0, 12, 0, 0, 17, 1}},
        {17, {0, 0, 0, 0, 0, 0, 1}},  {19, {0, 0, 0, 0, 0, 0, 1}},   {30, {0, 0, 32, 0, 0, 37, 1}}, {31, {0, 0, 32, 0, 0, 37, 1}},
        {32, {0, 0, 0, 0, 0, 37, 1}}, {35, {0, 0, 0, 0, 31, 37, 1}}, {37, {0, 0, 0, 0, 0, 0, 1}},   {39, {0, 0, 0, 0, 0, 0, 1}}};
    const auto reach = [](int s) {
        Mode m{ModeTimes{}};
        Instant t = time_zero;
        const auto steps = [&](Duration d) { t += d, (void)m.step(t, true); };
        if (s == 2) m.leave(2), (void)m.step(t, true);
        if (s >= 10 && s < 20) (void)m.start_automatic({"P", 100s, 0}, t);
        if (s >= 11 && s < 20) steps(8ms);
        if (s == 12 || s == 13 || s == 15 || s == 16) m.stop(t);
        if (s == 13 || s == 15 || s == 16) steps(0ms);
        if (s == 15 || s == 16) steps(100ms);
        if (s == 16) m.resume_automatic(t);
        if (s == 17 || s == 19) m.malfunction(t);
        if (s == 19) steps(0ms), steps(100ms);
        if (s >= 30) (void)m.start_online(t);
        if (s >= 31) steps(8ms);
        if (s == 32 || s == 35) m.stop(t);
        if (s == 35) steps(0ms);
        if (s == 37 || s == 39) m.malfunction(t);
        if (s == 39) steps(0ms);
        return m;
    };
    for (const Row& row : table) {
        for (int e = start_auto; e <= cancel; ++e) {
            Mode m = reach(row.from);
            ASSERT_EQ(m.status(), row.from);
            bool taken = true;
            const Instant t = time_zero + 10s;
            switch (e) {
                case start_auto:
                    taken = m.start_automatic({"P", 1s, 0}, t);
                    break;
                case start_online:
                    taken = m.start_online(t);
                    break;
                case stop:
                    taken = m.stop(t);
                    break;
                case resume_auto:
                    taken = m.resume_automatic(t);
                    break;
                case resume_online:
                    taken = m.resume_online();
                    break;
                case malfunction:
                    taken = m.malfunction(t);
                    break;
                default:
                    m.leave(status::home);
                    EXPECT_EQ(m.step(t, false), Mode::Entered::nothing) << "not before the axes stand";
                    (void)m.step(t, true);
                    break;
            }
            const int want = row.to[static_cast<std::size_t>(e)];
            EXPECT_EQ(taken, want != 0) << row.from << " event " << e;
            EXPECT_EQ(m.status(), want == 0 ? row.from : want) << row.from << " event " << e;
        }
    }
}

/// Brings a control into a column of the manual's table.
void bring(Bench& b, std::uint8_t column) {
    if (column == gate::manual) b.hand("panel", std::string("manual"));
    if (column == gate::automatic) b.good("0602;0;0;0");
    if (column == gate::online) b.online();
}

// The gate of every command in every column [L215-225]; T-27: parameters in home position only.
TEST(TwinMode, GatesOfAllCommands) {
    ASSERT_EQ(command_rows().size(), 66u);
    const std::map<std::string, std::uint8_t> gates{{"06", 0}, {"07", 1},  {"17", 1},  {"08", 1},
                                                    {"18", 1}, {"09", 15}, {"19", 15}, {"0A", 8}};
    const std::map<int, std::uint8_t> own{{0x0600, 12}, {0x0602, 5}, {0x0603, 9}, {0x0909, 1}, {0x0A41, 4}, {0x0AA0, 12}, {0x0AA1, 12}};
    for (const CommandRow& row : command_rows()) {
        char code[8];
        std::snprintf(code, sizeof code, "%04X", row.code);
        const auto special = own.find(row.code);
        const std::uint8_t want = special != own.end() ? special->second : gates.at(std::string(code).substr(0, 2));
        for (const std::uint8_t column : {gate::home, gate::manual, gate::automatic, gate::online}) {
            Bench b(setup(1));
            bring(b, column);
            // Parameter and data are wrong on purpose: a command that passes the gate gets as far as its own checks.
            const int quit = b.quit(std::string(code) + ";9999;0;-99999");
            if ((want & column) == 0) {
                EXPECT_EQ(quit, 20) << code << " column " << int{column};
            } else if (row.code != 0x0602 && row.code != 0x0603) {
                EXPECT_NE(quit, 20) << code << " column " << int{column};
                EXPECT_NE(quit, 19) << code;
            }
        }
    }
}

// T-25: no ONLINE without a defined and powered external stop.
TEST(TwinMode, ExternalStop) {
    Bench b;
    b.hand("external_stop", false);
    EXPECT_EQ(b.quit("0603;0;0;0"), 44);
    b.hand("external_stop", true);
    b.good("0700;4;0;0");
    EXPECT_EQ(b.quit("0603;0;0;0"), 44) << "not defined";
    b.good("0700;4;0;7");
    b.online();
    b.good("0A94;1;1;1000");
    b.pass(500ms);
    b.hand("external_stop", false);
    b.pass(2s);
    EXPECT_EQ(b.status(), 35) << "the contact stops what runs";
    EXPECT_EQ(b.quit("0603;0;0;0"), 44);
    b.hand("external_stop", true);
    b.good("0603;0;0;0");
    EXPECT_EQ(b.axis_status(1), 1);
}

// T-11, T-12: an error in home position is status 9; 0909 by class and mode.
TEST(TwinMode, ErrorClassesAndReset) {
    struct Case {
        int error;
        int quit;
        int data;
    };
    for (const Case& c : {Case{42, 21, 42}, Case{99, 21, 99}, Case{100, 0, 0}, Case{499, 0, 0}, Case{205, 21, 205}, Case{525, 0, 0}}) {
        Bench b;
        b.hand("inject_error", std::int64_t{c.error});
        const Fields f = b.get("190B;0;0;0");
        EXPECT_EQ(f.status, 9);
        EXPECT_EQ(f.data, 9);
        EXPECT_EQ(f.error, c.error);
        EXPECT_EQ(b.quit("0603;0;0;0"), 21) << "not with an error";
        const Fields r = b.get("0909;0;0;0");
        EXPECT_EQ(r.quit, c.quit) << c.error;
        EXPECT_EQ(r.data, c.data) << c.error;
        EXPECT_EQ(b.status(), c.quit == 0 ? 1 : 9) << c.error;
    }
    Bench b;
    b.online();
    EXPECT_EQ(b.quit("0909;0;0;0"), 20) << "home position only [L2776]";
    b.hand("inject_error", std::int64_t{210});
    EXPECT_EQ(b.status(), 39);
    b.good("0A81;0;0;0");
    EXPECT_EQ(b.status(), 9) << "class 2 stays on the way home";
    b.good("0909;0;0;0");
    EXPECT_EQ(b.status(), 1);
    b.hand("inject_error", std::int64_t{7});
    b.hand("power", false);
    b.hand("power", true);
    EXPECT_EQ(b.status(), 1) << "class 1 goes with the power";
}

TEST(TwinMode, TheOperatorSwitchesTheMode) {
    Bench b;
    b.online();
    b.good("0A94;1;1;1000");
    b.pass(500ms);
    b.hand("panel", std::string("manual"));
    EXPECT_EQ(b.control().status(), 31) << "axes stand first";
    b.pass(2s);
    EXPECT_EQ(b.status(), 2);
    EXPECT_EQ(b.quit("0A94;1;1;0"), 20);
    b.hand("jog", std::int64_t{1});
    EXPECT_EQ(b.status(), 3);
    b.hand("jog", std::int64_t{0});
    b.pass(1s);
    EXPECT_EQ(b.status(), 2);
    b.hand("panel", std::string("winpac"));
    EXPECT_EQ(b.status(), 20);
    b.hand("panel", std::string("home"));
    EXPECT_EQ(b.status(), 1);
    b.hand("panel", std::string("automatic"));
    b.pass(100ms);
    EXPECT_EQ(b.status(), 11);
    b.refused("panel", std::string("automatic"));
    b.refused("panel", std::string("flying"));
}

// An end of processing that the operator cut off: BE = 1, the status says why, the position is where it stands.
TEST(TwinMode, AMoveThatTheOperatorEnded) {
    Bench b;
    b.online();
    EXPECT_EQ(b.get("0A87;1;1;5000").end, 0);
    b.pass(500ms);
    b.hand("panel", std::string("home"));
    b.pass(3s);
    const Fields f = b.get_poll();
    EXPECT_EQ(f.end, 1);
    EXPECT_EQ(f.status, 1);
    EXPECT_LT(f.data, 5000);
    EXPECT_EQ(f.data, b.position(1));
}

TEST(TwinMode, EmergencyStop) {
    Bench b;
    b.online();
    b.good("0A94;1;1;1000");
    b.pass(500ms);
    b.hand("emergency_stop", true);
    b.pass(3s);
    EXPECT_EQ(b.status(), 39);
    EXPECT_EQ(b.axis_status(1), 2);
}

TEST(TwinMode, StartAndStopInputsAndAutostart) {
    Bench b;
    b.good("0700;3;0;2");
    b.hand("I2", true);
    b.pass(20ms);
    EXPECT_EQ(b.status(), 11);
    b.good("0A41;0;0;0");
    EXPECT_EQ(b.status(), 1) << "the level does not start again";
    b.hand("I2", false);
    b.good("0700;8;0;1");
    b.hand("power", false);
    b.hand("power", true);
    b.pass(20ms);
    EXPECT_EQ(b.status(), 11);
}

// Entering ONLINE checks the parameters [L4084].
TEST(TwinMode, InconsistentParameters) {
    const std::vector<std::pair<const char*, int>> cases{
        {"0800;264;1;20000", 51}, {"0800;260;1;60", 102}, {"0800;261;1;600", 104}};  // area, creep, start-stop
    for (const auto& [write, quit] : cases) {
        Bench b;
        b.good(write);
        EXPECT_EQ(b.quit("0603;0;0;0"), quit) << write;
        EXPECT_EQ(b.quit("0602;0;0;0"), quit) << write;
        EXPECT_EQ(b.status(), 1);
    }
}

}  // namespace
}  // namespace axisgate::pacontrol::twin::test
