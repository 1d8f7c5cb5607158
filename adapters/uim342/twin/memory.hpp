// Registers of the drive and their storage classes: RAM, EEPROM (written only with the driver off) and FLASH (protocol parameters).
// In: values that were checked. Out: values; the non-volatile part as named values and back.
// Never decides whether an instruction is allowed now: that is the instructions' business.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "gateway/core/twin.hpp"

namespace axisgate::uim342::twin {

/// Motion values of one MF group [L425]. Group 0 serves normal motion: there SP, PR and PA are volatile and live in the device.
struct Group {
    std::uint32_t ac = 10'000;  ///< pulse/s^2, or ms with IC[4] = 1
    std::uint32_t dc = 10'000;
    std::int32_t sp = 0;  ///< pulse/s
    std::int32_t pr = 0;  ///< pulse
    std::int32_t pa = 0;  ///< pulse
    bool operator==(const Group&) const = default;
};

inline constexpr std::size_t group_count = 8;  ///< MF = 0, 2..7; 1 is reserved [L1306-1324]

/// Everything of the EEPROM class, with the factory values that the twin ships with: the manual gives IC[1] = 1 and IL[3] = 0 only,
/// the others follow its examples.
struct Settings {
    std::array<std::uint16_t, 8> ic{0, 1, 0, 0, 0, 0, 1, 0};
    std::array<std::uint16_t, 4> ie{1, 1, 1, 1};  ///< IE[0], IE[1], IE[2], IE[8]
    std::array<std::uint16_t, 5> qe{1000, 100, 17, 1, 3200};
    std::array<std::uint16_t, 4> mt{16, 28, 50, 0};
    std::array<std::uint16_t, 4> il{0x8080, 0x8080, 0x8080, 0};  ///< low byte: falling edge, high byte: rising edge
    std::array<std::uint16_t, 3> tg{0, 0, 0};
    std::uint32_t ss = 0;          ///< pulse/s
    std::uint32_t sd = 1'600'000;  ///< pulse/s^2
    std::uint32_t bl = 0;          ///< pulse
    std::array<Group, group_count> group{};
    bool operator==(const Settings&) const = default;
};

/// FLASH: written by each SET, acting after a reboot [L1064].
struct Protocol {
    std::uint8_t bit_rate = 2;  ///< PP[5]: 0..4 = 1000, 800, 500, 250, 125 kbit/s
    std::uint8_t node = 5;      ///< PP[7]
    std::uint8_t group = 10;    ///< PP[8]
    bool operator==(const Protocol&) const = default;
};

// What each register takes; the index is known to exist.
[[nodiscard]] bool pp_takes(std::uint8_t index, std::uint16_t value) noexcept;
[[nodiscard]] bool qe_takes(std::size_t index, std::uint16_t value) noexcept;  ///< QE[3] is a status: takes nothing
[[nodiscard]] bool mt_takes(std::size_t index, std::uint16_t value) noexcept;
[[nodiscard]] bool il_takes(std::size_t index, std::uint16_t value) noexcept;
[[nodiscard]] bool tg_takes(std::uint16_t value) noexcept;
[[nodiscard]] bool ramp_takes(std::uint32_t value, bool as_time) noexcept;  ///< AC, DC
[[nodiscard]] bool bl_takes(std::uint32_t value) noexcept;

/// Position of IE[index] in Settings::ie; nothing if there is no such index.
[[nodiscard]] std::optional<std::size_t> ie_slot(std::uint8_t index) noexcept;

class Memory {
public:
    Memory(Protocol factory, std::uint32_t serial, const Settings& factory_settings) noexcept
        : factory_(factory),
          factory_serial_(serial),
          factory_settings_(factory_settings),
          flash_(factory),
          serial_(serial),
          eeprom_(factory_settings),
          ram_(factory_settings) {}

    [[nodiscard]] const Settings& ram() const noexcept { return ram_; }
    /// As configured; a change of IC[5] is always kept and acts at the next boot, when the counter begins at the encoder's place or at 0.
    [[nodiscard]] bool has_absolute_encoder() const noexcept { return ram().ic[5] == 1; }
    [[nodiscard]] const Protocol& flash() const noexcept { return flash_; }
    [[nodiscard]] std::uint32_t serial() const noexcept { return serial_; }
    [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

    /// Changes a setting with `change(Settings&)`: in RAM, and in the EEPROM too if `keep`.
    template <class F>
    void set(bool keep, F&& change) {
        change(ram_);
        if (!keep) return;
        const Settings before = eeprom_;
        change(eeprom_);
        if (!(before == eeprom_)) ++revision_;
    }
    template <class F>
    void set_flash(F&& change) {
        const Protocol before = flash_;
        change(flash_);
        if (!(before == flash_)) ++revision_;
    }
    /// A state of the drive outside its registers that outlives a power-off has changed (the absolute encoder's position).
    void touch() noexcept { ++revision_; }

    /// RAM from EEPROM.
    void reboot() noexcept { ram_ = eeprom_; }
    /// SY[2]: everything but the protocol parameters and the serial number, in RAM and EEPROM.
    void restore_factory() noexcept;

    /// The non-volatile part by the manual's names: "PP[7]", "IC[0]", "AC", "MF2.SP", "IL[0]", "SN".
    void save(NonVolatile& to) const;
    /// From such names; missing and impossible values are the factory's. RAM follows with `reboot`.
    void load(const NonVolatile& from);

private:
    Protocol factory_;
    std::uint32_t factory_serial_;
    Settings factory_settings_;
    Protocol flash_;
    std::uint32_t serial_;
    Settings eeprom_;
    Settings ram_;
    std::uint64_t revision_ = 0;
};

}  // namespace axisgate::uim342::twin
