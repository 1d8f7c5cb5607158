#include "adapters/linmot/twin/memory.hpp"

#include <fmt/core.h>

#include <charconv>

namespace axisgate::linmot::twin {
namespace {
// Voltages in 10 mV, temperatures in 0.1 deg C, times in ms, positions in 0.1 um: choices, because the manual gives no scales (O-22).
constexpr std::uint16_t variable = 0x1001, set_variable = 0x1103;
constexpr ParameterFacts table[] = {{0x100E, type_s32, 2000},
                                    {0x1010, type_s32, 2800},
                                    {0x1018, type_s32, 2400},
                                    {0x1019, type_s32, 8500},
                                    {0x101A, type_s32, 2000},
                                    {0x101B, type_s32, 9000},
                                    {0x101D, type_s32, 0},
                                    {0x101E, type_s32, 8800},
                                    {0x101F, type_s32, 8600},
                                    {0x1022, type_s32, 10},
                                    {0x1024, type_s32, 1000},
                                    {0x1025, type_s32, 1200},
                                    {0x1026, type_s32, 50},
                                    {0x1027, type_s32, 1},
                                    {0x1028, type_s32, 200},
                                    {0x1029, type_s32, 2},
                                    {0x102A, type_s32, 250},
                                    {0x102C, type_s32, 500},
                                    {0x102D, type_s32, 800},
                                    {0x102E, type_s32, 100},
                                    {0x1040, type_s32, 700},
                                    {0x1041, type_s32, 850},
                                    {0x11F2, type_s32, 0},
                                    {0x11F4, type_s32, 0},
                                    {0x11FB, type_s32, 0},
                                    {0x120C, type_s32, 20},
                                    {0x1210, type_s32, 2},
                                    {0x1211, type_s32, 200},
                                    {0x1212, type_s32, 1},
                                    {0x1213, type_s32, 1000},
                                    {0x1214, type_s32, 1},
                                    {0x121B, type_s32, 2},
                                    {0x1221, type_s32, 0},
                                    {0x1266, type_s32, 0},
                                    {0x128E, type_s32, 2},
                                    {0x128F, type_s32, 2},
                                    {0x1290, type_s32, 0},
                                    {0x1291, type_s32, 4000},
                                    {0x1293, type_s32, 10},
                                    {0x13A2, type_u16, 9},
                                    {0x13A6, type_u16, 3000},
                                    {0x13BA, type_u16, 3000},
                                    {0x13C7, type_s32, 0},
                                    {0x13CA, type_s32, 0},
                                    {0x146E, type_s32, -100'000'000},
                                    {0x146F, type_s32, 100'000'000},
                                    {0x1473, type_s32, 50'000},
                                    {0x1475, type_s32, 20'000},
                                    {0x14BE, type_u32, 100'000},
                                    {0x14BF, type_u32, 100'000},
                                    {0x14C0, type_u32, 100'000},
                                    {0x14E6, type_s32, 2},
                                    {0x1527, type_s32, 0},
                                    {0x1528, type_s32, 1},
                                    {0x154A, type_u16, 1},
                                    {0x154B, type_u16, 1},
                                    {0x154C, type_s32, 0},
                                    {0x154D, type_s32, 0},
                                    {0x170C, type_s32, 1},
                                    {0x170D, type_s32, 0},
                                    {0x170E, type_s32, 0},
                                    {0x170F, type_s32, 0},
                                    {0x1710, type_s32, 0},
                                    {0x1716, type_bool, 0},
                                    {0x1717, type_bool, 0},
                                    {0x1718, type_bool, 0},
                                    {0x171B, type_s32, 20},
                                    {0x171C, type_s32, 20},
                                    {0x172A, type_s32, 1},
                                    {0x1B93, type_s32, 0, variable},
                                    {0x1BA9, type_s32, 0, set_variable},
                                    {0x1BC6, type_s32, 300, variable},
                                    {0x1BC7, type_s32, 300, variable},
                                    {0x1BC8, type_s32, 300, variable},
                                    {0x1BC9, type_s32, 300, variable},
                                    {0x1BCA, type_s32, 300, variable},
                                    {0x1BCB, type_s32, 300, variable},
                                    {0x1BCC, type_s32, 300, variable},
                                    {0x1BCD, type_s32, 300, variable},
                                    {0x1BCE, type_s32, 300, variable},
                                    {0x1C0D, type_s32, 250, variable},
                                    {0x1C1B, type_s32, 0, variable},
                                    {0x1DB0, type_u16, 0, variable},
                                    {0x1E72, type_s32, 0, set_variable},
                                    {0x1E73, type_s32, 0, set_variable},
                                    {0x2008, type_bit, 1, 0x000D},
                                    {0x2080, type_u16, 0, 0x000D},
                                    {0x2136, type_u16, 0, variable},
                                    {0x6300, type_s32, 0}};
}  // namespace

Memory::Memory() {
    for (const auto& f : table) {
        facts_.emplace(f.upid, f);
        rom_[f.upid] = fit(f.type, static_cast<std::uint32_t>(f.factory));
    }
    restart();
}
void Memory::restart() { ram_ = rom_; }

const ParameterFacts* Memory::facts(std::uint16_t upid) const noexcept {
    const auto it = facts_.find(upid);
    return it == facts_.end() ? nullptr : &it->second;
}
const ParameterFacts* Memory::from(std::uint16_t upid) const noexcept {
    const auto it = facts_.lower_bound(upid);
    return it == facts_.end() ? nullptr : &it->second;
}

std::uint32_t Memory::fit(std::uint8_t type, std::uint32_t raw) noexcept {
    switch (type) {
        case type_bool:
        case type_bit:
            return raw & 1;
        case type_u16:
            return raw & 0xFFFF;
        case type_s16:
            return static_cast<std::uint32_t>(static_cast<std::int32_t>(static_cast<std::int16_t>(raw)));
        default:
            return raw;
    }
}
std::uint32_t Memory::lowest(std::uint8_t type) noexcept { return type == type_s32 ? 0x8000'0000u : type == type_s16 ? 0xFFFF'8000u : 0u; }
std::uint32_t Memory::highest(std::uint8_t type) noexcept {
    switch (type) {
        case type_bool:
        case type_bit:
            return 1;
        case type_u16:
            return 0xFFFF;
        case type_s16:
            return 0x7FFF;
        case type_u32:
            return 0xFFFF'FFFFu;
        default:
            return 0x7FFF'FFFFu;
    }
}

std::uint32_t Memory::ram(std::uint16_t upid) const noexcept {
    const auto it = ram_.find(upid);
    return it == ram_.end() ? 0 : it->second;
}
std::uint32_t Memory::rom(std::uint16_t upid) const noexcept {
    const auto it = rom_.find(upid);
    return it == rom_.end() ? 0 : it->second;
}
double Memory::number(std::uint16_t upid) const noexcept {
    const auto* f = facts(upid);
    const std::uint32_t raw = ram(upid);
    return f && (f->type == type_s32 || f->type == type_s16) ? static_cast<double>(static_cast<std::int32_t>(raw))
                                                             : static_cast<double>(raw);
}
void Memory::set_ram(std::uint16_t upid, std::uint32_t raw) noexcept {
    const auto it = ram_.find(upid);
    if (it != ram_.end()) it->second = fit(facts(upid)->type, raw);
}
void Memory::set_rom(std::uint16_t upid, std::uint32_t raw) {
    const auto it = rom_.find(upid);
    if (it == rom_.end()) return;
    it->second = fit(facts(upid)->type, raw);
    ++revision;
}

void Memory::load(const NonVolatile& memory) {
    for (const auto& [upid, f] : facts_)
        rom_[upid] = fit(f.type, static_cast<std::uint32_t>(f.factory));
    for (const auto& [name, value] : memory) {
        unsigned upid = 0;
        const auto [end, ec] = std::from_chars(name.data(), name.data() + name.size(), upid, 16);
        const auto v = as_integer(value);
        if (ec != std::errc{} || end != name.data() + name.size() || name.size() != 4 || !v) continue;
        const auto* f = facts(static_cast<std::uint16_t>(upid));
        if (f && f->in_rom()) rom_[f->upid] = fit(f->type, static_cast<std::uint32_t>(*v));
    }
    restart();
}
void Memory::save(NonVolatile& into) const {
    for (const auto& [upid, f] : facts_) {
        const bool factory = rom(upid) == fit(f.type, static_cast<std::uint32_t>(f.factory));
        if (f.in_rom() && !factory) into[fmt::format("{:04X}", upid)] = std::int64_t{rom(upid)};
    }
}

}  // namespace axisgate::linmot::twin
