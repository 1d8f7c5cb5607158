// The Profibus process image of the twin: CMD interface, CTRL interface, and up to eight module or axis interfaces; the Interbus image
// is its CMD interface alone, with its own rule for zeros.
// In: the master's bytes of one cycle, time. Out: the control's bytes.
// Never holds a state of the control: what moves, counts or is stored is in the twin's Control.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "adapters/pacontrol/twin/control.hpp"
#include "gateway/core/instant.hpp"

namespace axisgate::pacontrol::twin {

struct ImageShape {
    bool ctrl = false;           ///< first extension
    std::size_t modules = 0;     ///< 0..8, needs `ctrl` [L358-L384]
    bool wide_n = false;         ///< fields of a module 2/2/4/4 instead of 4/2/2/4 (E-09)
    std::size_t error_word = 2;  ///< word of the CTRL interface that carries the system error number, 1..3 (E-08)
    bool interbus = false;       ///< 8 bytes alone; all zeros are an emergency stop once commands have come [L1776]

    /// 8, 16, 28 .. 112.
    [[nodiscard]] std::size_t bytes() const noexcept;
};

/// The four states of the Interbus diagnosis [L1773-L1776].
struct InterbusDiagnosis {
    bool active = false;        ///< the master transfers new data
    bool time_out = false;      ///< it has sent none for more than 10 s
    bool command_data = false;  ///< it has given commands
    bool emergency_stop = false;
    bool operator==(const InterbusDiagnosis&) const = default;
};

/// True if the command carries a real (IEEE 754 single), always so in the CMD interface.
[[nodiscard]] bool carries_real(std::uint16_t code) noexcept;

class Image {
public:
    explicit Image(const ImageShape& shape);

    /// One cycle. `in` of another length than shape.bytes() changes nothing: the answer of the cycle before is given again.
    std::span<const std::uint8_t> exchange(Control& control, std::span<const std::uint8_t> in, Instant now);
    [[nodiscard]] bool integers() const noexcept { return integers_; }
    /// New data are bytes that differ from those of the cycle before; nothing holds before the first of them has come.
    [[nodiscard]] InterbusDiagnosis diagnosis(Instant now) const noexcept;

private:
    struct Module {
        std::uint32_t control = 0;
        bool active = false;
        std::uint16_t command_error = 0;
        std::uint16_t own_error = 0;  ///< axis error that the interface itself has found
        std::uint16_t speed = 0;
    };
    void command(Control& control, Instant now);
    void control_word(Control& control, Instant now);
    void elements(Control& control, std::size_t k, Instant now);
    void axis(Control& control, std::size_t k, Instant now);
    void start(Control& control, std::size_t k, Module& m, std::uint32_t word, Instant now);
    [[nodiscard]] double real_at(std::size_t at) const noexcept;
    void put_real(std::size_t at, double v) noexcept;

    ImageShape shape_;
    std::vector<std::uint8_t> in_, out_;
    std::array<Module, 8> modules_{};
    bool sf_ = false, running_ = false, integers_ = false, commanded_ = false, stopped_by_zeros_ = false;
    Instant changed_ = never;      ///< when the master's bytes were last new
    std::uint16_t ctrl_ = 0x0007;  ///< the resting image: nothing demanded
};

}  // namespace axisgate::pacontrol::twin
