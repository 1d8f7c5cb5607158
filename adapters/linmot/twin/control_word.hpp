// ControlWord is the control word that is in force in the drive: the source of each bit, and the bits that have risen. The effect of a bit
// is defined elsewhere.
#pragma once

#include "adapters/linmot/twin/setup.hpp"

namespace axisgate::linmot::twin {

class ControlWord {
public:
    [[nodiscard]] std::uint16_t value() const noexcept { return value_; }
    [[nodiscard]] bool bit(int n) const noexcept { return (value_ >> n & 1) != 0; }
    [[nodiscard]] bool rises(int n) const noexcept { return bit(n) && (before_ >> n & 1) == 0; }

    void write(std::uint16_t word) noexcept { interface_ = word; }
    /// State 0 is left when bit 0 is seen low: a complete control word at power-on starts nothing [L105-107].
    void power_on() noexcept { interface_ = 0x0001; }
    void start_software() noexcept { interface_ |= 1; }

    /// Per bit, in order of priority: forced by parameter, control panel, X4 inputs, interface [L276-283]. Edges remain until `seen`.
    void gather(const Outside& o, const DriveSetup& setup, bool unsafe) noexcept {
        auto word = static_cast<std::uint16_t>(interface_ & o.copy_mask);
        word = pick(o.x4_mask, o.x4_word, word);
        word = pick(o.panel_mask, o.panel_word, word);
        word = pick(setup.force_mask, setup.force_word, word);
        if (unsafe) word = static_cast<std::uint16_t>(word & ~0x0002);  // X4.12 is always mapped to bit 1
        before_ = value_;
        value_ = word;
    }
    void seen() noexcept { before_ = value_; }
    /// An edge has one effect.
    void use_edge(int n) noexcept { before_ = static_cast<std::uint16_t>(before_ | 1u << n); }

private:
    [[nodiscard]] static std::uint16_t pick(std::uint16_t mask, std::uint16_t high, std::uint16_t low) noexcept {
        return static_cast<std::uint16_t>((high & mask) | (low & ~mask));
    }
    std::uint16_t interface_ = 0, value_ = 0, before_ = 0;
};

}  // namespace axisgate::linmot::twin
