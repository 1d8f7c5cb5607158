// Memory holds the parameters of a simulated drive: RAM and ROM values by UPID, with type, limits, default and usage. Values are raw 32-bit
// values, limited to the width of the parameter. A restart copies ROM to RAM. Types and factory values are choices where the manual is
// silent (README).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gateway/core/twin.hpp"

namespace axisgate::linmot::twin {

enum Type : std::uint8_t { type_bool = 0, type_u16 = 3, type_s16 = 4, type_u32 = 5, type_s32 = 6, type_bit = 10 };

struct ParameterFacts {
    std::uint16_t upid = 0;
    std::uint8_t type = type_s32;
    std::int32_t factory = 0;
    std::uint16_t usage = 0x010F;  ///< 1 RAM read, 2 RAM write, 4 and 8 ROM read and write, 100h live, 1000h variable
    [[nodiscard]] bool live() const noexcept { return (usage & 0x100) != 0; }
    [[nodiscard]] bool in_rom() const noexcept { return (usage & 0x0C) != 0; }
    [[nodiscard]] bool writable_rom() const noexcept { return (usage & 0x08) != 0; }
};

class Memory {
public:
    Memory();
    [[nodiscard]] const ParameterFacts* facts(std::uint16_t upid) const noexcept;
    /// The first parameter whose number is `upid` or higher.
    [[nodiscard]] const ParameterFacts* from(std::uint16_t upid) const noexcept;
    [[nodiscard]] static std::uint32_t fit(std::uint8_t type, std::uint32_t raw) noexcept;
    [[nodiscard]] static std::uint32_t lowest(std::uint8_t type) noexcept;
    [[nodiscard]] static std::uint32_t highest(std::uint8_t type) noexcept;

    [[nodiscard]] std::uint32_t ram(std::uint16_t upid) const noexcept;
    [[nodiscard]] double number(std::uint16_t upid) const noexcept;  ///< the RAM value with the sign of its type
    [[nodiscard]] std::uint32_t rom(std::uint16_t upid) const noexcept;
    void set_ram(std::uint16_t upid, std::uint32_t raw) noexcept;
    void set_rom(std::uint16_t upid, std::uint32_t raw);

    /// RAM is set to ROM; variables to their factory values.
    void restart();
    void load(const NonVolatile& memory);
    void save(NonVolatile& into) const;
    std::uint64_t revision = 0;  ///< incremented with each change of stored values

private:
    std::map<std::uint16_t, ParameterFacts> facts_;
    std::map<std::uint16_t, std::uint32_t> ram_, rom_;
};

}  // namespace axisgate::linmot::twin
