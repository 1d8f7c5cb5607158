// The twin: each error code of the catalogue either has a case with its cause, or a reason why the model has no cause for it.
#include "adapters/linmot/tests/effect_trial.hpp"

namespace axisgate::linmot::test {
namespace {
using Causes = std::map<std::uint16_t, EffectCase>;

/// Codes that only the hand's inject_error causes, by the function that the model does not have.
const std::map<std::uint16_t, const char*>& without_cause() {
    static const std::map<std::uint16_t, const char*> all = [] {
        std::map<std::uint16_t, const char*> m;
        const auto lacks = [&](const char* what, std::initializer_list<int> codes) {
            for (const int c : codes)
                m[static_cast<std::uint16_t>(c)] = what;
        };
        lacks("wiring of the regeneration resistor", {0x05});
        lacks("a second position sensor, or signals of one", {0x09, 0x0A, 0x21, 0x25});
        lacks("currents of phases, their wires and bridges", {0x0D, 0x18, 0x19, 0x1A, 0x1B, 0x28, 0x29, 0x2A, 0x2B, 0x2C, 0x30, 0x31,
                                                              0x32, 0x33, 0x34, 0x35, 0x36, 0x37, 0x38, 0x39, 0x3A, 0x3B, 0x3C});
        lacks("fuses and output drivers", {0x0E, 0x1C, 0x1D, 0x1E, 0x40, 0x41, 0x42, 0x44});
        lacks("a slider that could be another or none, a motor with its own memory", {0x22, 0x45, 0x64, 0x67, 0x68, 0x69});
        lacks("a trigger in the manual: the reckoned resistor raises 0015h (E-31)", {0x24});
        lacks("wires of PTC inputs: an open one is 0006h (E-50)", {0x46, 0x47});
        lacks("other hardware and software than its own; a missing key is 0081h (choice O-04)", {0x50, 0x51});
        lacks("an action of which the manual says that it needs a homed motor", {0x80});
        return m;
    }();
    return all;
}

/// Streams `n` set-points with this interval.
void pour(Trial& t, int n, Duration apart) {
    for (int i = 1; i <= n; ++i) {
        t.motion("030xh", {i * 100});
        t.run(apart);
    }
}

void device_causes(Causes& all) {
    for (const auto& [code, volt] : {std::pair{0x01, 19.0}, {0x02, 29.0}})
        all[static_cast<std::uint16_t>(code)] = {[v = volt](Trial& t) { (void)t.hand("logic_supply", Value{v}); }};
    for (const auto& [code, volt] : {std::pair{0x03, 18.0}, {0x04, 95.0}})
        all[static_cast<std::uint16_t>(code)] = {[v = volt](Trial& t) { (void)t.hand("motor_supply", Value{v}); }};
    for (const auto& [code, input] : {std::pair{0x06, "ptc_1"}, {0x0F, "ptc_2"}, {0x20, "motor_hot"}})
        all[static_cast<std::uint16_t>(code)] = {[name = input](Trial& t) { (void)t.hand(name, Value{true}); }};
    for (int i = 0; i < 8; ++i)
        all[static_cast<std::uint16_t>(0x10 + i)] = {[i](Trial& t) {
            (void)t.hand("sensor", Value{std::int64_t{i + 1}});
            (void)t.hand("temperature", Value{90.0});
        }};
    all[0x23] = {[](Trial& t) {
        (void)t.hand("current", Value{std::int64_t{10'000}});
        t.run(60s);
    }};
    for (const auto& [code, on, off] : {std::tuple{0x60, 7100, 7000}, {0x61, 8840, 8800}}) {
        all[static_cast<std::uint16_t>(code)] = {[on = on, off = off](Trial& t) {
            for (const auto& [upid, v] : {std::pair{0x101D, 1}, {0x101E, on}, {0x101F, off}})
                t.drive().memory.set_rom(static_cast<std::uint16_t>(upid), static_cast<std::uint32_t>(v));
            (void)t.hand("power", Value{false});
            (void)t.hand("power", Value{true});
        }};
    }
    all[0x65] = {[](Trial& t) {
        t.drive().memory.set_rom(0x170C, 0);
        (void)t.hand("power", Value{false});
        (void)t.hand("power", Value{true});
    }};
}

void motion_causes(Causes& all) {
    for (const auto& [code, place] : {std::pair{0x07, -50'000}, {0x08, 50'000}}) {
        all[static_cast<std::uint16_t>(code)] = {[place = place](Trial& t) {
            t.motion("002xh", {0x146E, -40'000});
            t.motion("002xh", {0x146F, 40'000});
            t.motion("009xh", {0});
            t.to(place);
        }};
    }
    all[0x0B] = {[](Trial& t) {
        (void)t.hand("stall", Value{true});
        t.to(100'000);
    }};
    all[0x0C] = {[](Trial& t) {
        t.hold_apart();
        t.motion("002xh", {0x1473, 10'000});
    }};
    all[0x58] = {[](Trial& t) { t.motion("24Exh", {0x1E72}); }};  // a variable has no ROM value
    all[0x62] = {[](Trial& t) { t.motion("040xh", {9}); }};
    all[0x63] = {[](Trial& t) { t.motion("0C5xh", {1000, quick, steep, 0}); }};
    all[0x81] = {[](Trial& t) { (void)t.tell({0, 2, 0x51, 0x00}); }};
    all[0x82] = {[](Trial& t) {
        pour(t, 4, 2ms);
        pour(t, 8, 10us);
    }};
    all[0x83] = {[](Trial& t) { pour(t, 10, 3ms); }};
    all[0x84] = {[](Trial& t) { pour(t, 2, 1ms); }};
    all[0x85] = {[](Trial& t) { pour(t, 2, 6ms); }};
    all[0x86] = {[](Trial& t) {
        t.control(0x37);
        t.motion("010xh", {1000, quick, steep, steep});
    }};
    for (const auto& [code, limit] : {std::pair{0x87, "limit_negative"}, {0x88, "limit_positive"}}) {
        all[static_cast<std::uint16_t>(code)] = {[name = limit](Trial& t) {
            t.motion("009xh", {0});
            (void)t.hand(name, Value{true});
        }};
    }
    all[0x89] = {[](Trial& t) {
        t.draw(3, {0, 100}, 1000);
        t.motion("042xh", {3, 100'000});
    }};
    all[0x8A] = {[](Trial& t) { t.motion("200xh", {99}); }};
}

TEST(LinmotErrors, EveryCodeOfTheCatalogueByItsCauseOrByTheHand) {
    Causes causes;
    device_causes(causes);
    motion_causes(causes);
    std::size_t seen = 0;
    for (const auto& e : page().errors()) {
        const auto code = static_cast<std::uint16_t>(e.code);
        SCOPED_TRACE(fmt::format("{:04X}h {}", code, e.name));
        ++seen;
        const bool setup = code == 0x50 || code == 0x51;
        {
            Trial t({});
            t.enable();
            EXPECT_EQ(t.hand("inject_error", Value{std::int64_t{code}}), "");
            t.run(1s);
            EXPECT_EQ(t.drive().state_var(), 0x0400 | code) << (setup ? "rests in 3 until bit 0 is seen, which is set" : "");
            EXPECT_EQ(t.drive().status_word() >> 12 & 1, e.kind.starts_with("fatal") ? 1 : 0) << "fatal";
            EXPECT_NE(t.drive().status_word() & 0x08, 0) << "error";
        }
        const auto cause = causes.find(code);
        EXPECT_NE(cause != causes.end(), without_cause().contains(code)) << "is in one of the two lists";
        if (cause == causes.end()) continue;
        Trial t(cause->second.options);
        t.enable();
        EXPECT_EQ(t.drive().error_code(), 0);
        cause->second.run(t);
        t.run(2s);
        EXPECT_EQ(t.drive().state_var(), 0x0400 | code);
    }
    EXPECT_EQ(seen, 84u);
    EXPECT_EQ(causes.size() + without_cause().size(), seen) << "no list has a code that the catalogue has not";
}

}  // namespace
}  // namespace axisgate::linmot::test
