// Bench for the Profibus and Interbus images: a control, an image, cycles of 10 ms in virtual time.
// In: the master's words. Out: the control's. Fields are packed and taken apart here, by hand.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <vector>

#include "adapters/pacontrol/twin/image.hpp"

namespace axisgate::pacontrol::twin {

using namespace std::chrono_literals;

struct Rig {
    explicit Rig(ImageShape s = {}, int axes = 2) : shape(s), control(setup_of(s, axes)), image(s), in(s.bytes()) {
        control.power_on({}, now);
        if (s.ctrl) ctrl(0x0007);
        for (int n = 1; n <= axes; ++n)
            control.axis(n).set_referenced(true);
        cycle();
    }
    static ControlSetup setup_of(const ImageShape& s, int axes) {
        ControlSetup c;
        c.axes = axes;
        c.axis_modules = s.modules > 0;
        return c;
    }
    void put(std::size_t at, std::uint32_t v, int bytes) {
        for (int i = 0; i < bytes; ++i)
            in[at + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(v >> (8 * (bytes - 1 - i)));
    }
    [[nodiscard]] std::uint32_t get(std::size_t at, int bytes) const {
        std::uint32_t v = 0;
        for (int i = 0; i < bytes; ++i)
            v = v << 8 | out[at + static_cast<std::size_t>(i)];
        return v;
    }
    void put_real(std::size_t at, float v) { put(at, std::bit_cast<std::uint32_t>(v), 4); }
    [[nodiscard]] float real(std::size_t at) const { return std::bit_cast<float>(get(at, 4)); }
    void ctrl(std::uint16_t w) { put(8, w, 2); }
    void cycle(Duration d = 10ms) {
        now += d;
        const auto o = image.exchange(control, in, now);
        out.assign(o.begin(), o.end());
    }
    void run(Duration d) {
        for (const Instant end = now + d; now < end;)
            cycle();
    }
    /// A command: fills in and toggles. The flags word of the answer.
    std::uint32_t command(std::uint16_t code, std::uint16_t parameter, std::uint32_t data = 0) {
        sf = !sf;
        put(0, data, 4);
        put(4, parameter, 2);
        put(6, code | (sf ? 0x8000u : 0u), 2);
        cycle();
        return get(6, 2) ^ (sf ? 0x8000u : 0u);
    }
    void online() {
        ctrl(0x0017);
        run(100ms);
        ctrl(0x0007);
        cycle();
        ASSERT_EQ(control.status(), 31);
    }
    static std::size_t module(int n) { return 16 + 12 * static_cast<std::size_t>(n - 1); }
    /// Axis interface: control word, and the values with which a start goes.
    void axis(int n, std::uint32_t word, float position = 0, std::uint16_t speed = 1000, std::uint16_t acceleration = 1000) {
        put(module(n), word, 4);
        put(module(n) + 4, acceleration, 2);
        put(module(n) + 6, speed, 2);
        put_real(module(n) + 8, position);
    }
    [[nodiscard]] std::uint32_t status(int n) const { return get(module(n), 4); }
    void wait_for_rest(int n) {
        for (int i = 0; i < 6000 && control.axis(n).running(); ++i)
            cycle();
        ASSERT_FALSE(control.axis(n).running());
    }

    ImageShape shape;
    Control control;
    Image image;
    std::vector<std::uint8_t> in, out;
    bool sf = false;
    Instant now = Instant{} + 1s;
};

inline constexpr std::uint32_t on = 1, start = 4, g26 = 16, g29 = 32, absolute = 64, relative = 128;
inline constexpr std::uint32_t active = 1u << 7, referenced = 1u << 8, cmd_error = 1u << 14, axis_error = 1u << 15;

inline ImageShape with_modules(std::size_t n) {
    ImageShape s;
    s.ctrl = true;
    s.modules = n;
    return s;
}

inline std::uint32_t real_bits(float x) { return std::bit_cast<std::uint32_t>(x); }

}  // namespace axisgate::pacontrol::twin
