// Inputs, outputs, flags, N and R registers of the twin, single and by words of 16.
// In: numbers from 1, values. Out: values; whether there is such an element.
// Never knows the system views SM, SN, SR: those are computed by the control.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>

namespace axisgate::pacontrol::twin {

inline constexpr std::size_t elements = 1024;  ///< of each kind [L2430]

/// Bits numbered from 1; word k = bits 16(k-1)+1..16k, bit 0 lowest [L2439].
class Bits {
public:
    explicit Bits(std::size_t count) : count_(count) {}
    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] bool has(std::int64_t n) const noexcept { return n >= 1 && n <= static_cast<std::int64_t>(count_); }
    [[nodiscard]] bool get(std::int64_t n) const noexcept { return has(n) && bits_[static_cast<std::size_t>(n - 1)]; }
    void set(std::int64_t n, bool on) noexcept {
        if (has(n)) bits_[static_cast<std::size_t>(n - 1)] = on;
    }
    /// The word in which element `n` lies. Elements past the count read 0.
    [[nodiscard]] std::uint16_t word_of(std::int64_t n) const noexcept {
        std::uint16_t w = 0;
        const std::int64_t first = (n - 1) / 16 * 16 + 1;
        for (int b = 0; b < 16; ++b)
            w = static_cast<std::uint16_t>(w | (get(first + b) ? 1u << b : 0u));
        return w;
    }
    /// Replaces all 16 [L2513].
    void set_word_of(std::int64_t n, std::uint16_t w) noexcept {
        const std::int64_t first = (n - 1) / 16 * 16 + 1;
        for (int b = 0; b < 16; ++b)
            set(first + b, ((w >> b) & 1u) != 0);
    }
    void clear() noexcept { bits_.reset(); }

private:
    std::size_t count_;
    std::bitset<elements> bits_;
};

template <class T>
class Registers {
public:
    explicit Registers(std::size_t count) : count_(count) {}
    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] bool has(std::int64_t n) const noexcept { return n >= 1 && n <= static_cast<std::int64_t>(count_); }
    [[nodiscard]] T get(std::int64_t n) const noexcept { return has(n) ? values_[static_cast<std::size_t>(n - 1)] : T{}; }
    void set(std::int64_t n, T v) noexcept {
        if (has(n)) values_[static_cast<std::size_t>(n - 1)] = v;
    }

private:
    std::size_t count_;
    std::array<T, elements> values_{};
};

struct Elements {
    Bits inputs{elements}, outputs{elements}, flags{elements};
    Registers<std::int32_t> n{elements};
    Registers<float> r{elements};
};

}  // namespace axisgate::pacontrol::twin
