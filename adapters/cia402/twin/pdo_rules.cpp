#include "adapters/cia402/twin/pdo_rules.hpp"

#include <array>
#include <cstdio>
#include <tuple>

#include "gateway/protocols/canopen/pdo.hpp"

namespace axisgate::cia402_drive::twin {
using canopen::Abort;
using canopen::Address;
using canopen::PdoDirection;

namespace {
bool is_pdo(Address a) { return a.index >= 0x1400 && a.index < 0x1C00; }
bool is_mapping(Address a) { return (a.index >= 0x1600 && a.index < 0x1800) || (a.index >= 0x1A00 && a.index < 0x1C00); }
bool is_type(Address a) { return is_pdo(a) && !is_mapping(a) && a.sub == 2; }
bool is_identifier(Address a) { return (is_pdo(a) && !is_mapping(a) && a.sub == 1) || (a.index == 0x1014 && a.sub == 0); }
constexpr std::int64_t invalid_bit = 0x80000000, identifier_bits = 0x3FFFFFFF;
std::int64_t integer(const canopen::Dictionary& d, int index, int sub) {
    return d.integer({static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(sub)}).value_or(0);
}
}  // namespace

std::string memory_key(Address a) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "%04X:%02X", unsigned{a.index}, unsigned{a.sub});
    return text.data();
}

Abort fault_of_setup(const SetupState& s, Address a, std::int64_t value) {
    const PdoSetup rule = s.freedoms.pdo_setup;
    if (is_mapping(a) && rule == PdoSetup::fixed_mapping) return Abort::read_only;
    if (is_type(a) && s.freedoms.pdo_types_fixed) return Abort::read_only;
    const bool before_start = (rule == PdoSetup::before_start && is_pdo(a)) || (rule == PdoSetup::mapping_before_start && is_mapping(a));
    if (before_start && !s.pre_operational) return Abort::device_state;
    if (is_mapping(a) && s.freedoms.strict_mapping) {
        const bool on = (integer(s.dictionary, a.index - 0x200, 1) & invalid_bit) == 0;
        if (on || (a.sub > 0 && integer(s.dictionary, a.index, 0) != 0)) return Abort::device_state;
    }
    if (is_identifier(a) && s.freedoms.strict_cob_id > 0) {
        const std::int64_t has = integer(s.dictionary, a.index, a.sub);
        const bool changes = (has & invalid_bit) == 0 && ((has ^ value) & identifier_bits) != 0;
        if (changes && (s.freedoms.strict_cob_id == 2 || (value & invalid_bit) == 0)) return Abort::value;
    }
    return Abort::none;
}

Abort fault_of_mapping(const Freedoms& freedoms, const canopen::Dictionary& d, Address a, std::int64_t v) {
    const bool receive_map = a.index >= 0x1600 && a.index < 0x1600 + pdos, transmit_map = a.index >= 0x1A00 && a.index < 0x1A00 + pdos;
    if (!receive_map && !transmit_map) return Abort::none;
    if (a.sub == 0 && v > 8) return Abort::pdo_length;
    if (a.sub > 0 && v != 0) {
        const auto entry = canopen::mapped_entry(static_cast<std::uint32_t>(v));
        if (freedoms.lacks(entry.address.index)) return Abort::no_object;
        if (!freedoms.maps(entry.address.index)) return Abort::not_mappable;
        return canopen::fault_of({entry}, receive_map ? PdoDirection::receive : PdoDirection::transmit, d);
    }
    if (a.sub == 0 && v > 0) {
        canopen::PdoMapping all;
        for (int i = 1; i <= v; ++i)
            all.push_back(canopen::mapped_entry(static_cast<std::uint32_t>(integer(d, a.index, i))));
        if (canopen::bits_of(all) > canopen::pdo_bits) return Abort::pdo_length;
    }
    return Abort::none;
}

namespace {
/// CiA 402-5: status or control word alone, then with the mode, with the position, with the velocity.
void set_usual_mappings(const NonVolatile& memory, canopen::Dictionary& d) {
    constexpr std::uint32_t status = 0x60410010, control = 0x60400010;
    constexpr std::uint32_t transmit[] = {0, 0x60610008, 0x60640020, 0x606C0020}, receive[] = {0, 0x60600008, 0x607A0020, 0x60FF0020};
    for (std::uint16_t n = 0; n < pdos; ++n)
        for (const auto& [map, word, second] : {std::tuple{0x1A00 + n, status, transmit[n]}, {0x1600 + n, control, receive[n]}}) {
            const auto index = static_cast<std::uint16_t>(map);
            if (memory.contains(memory_key({index, 0}))) continue;
            (void)d.set({index, 1}, Value{std::int64_t{word}});
            (void)d.set({index, 2}, Value{std::int64_t{second}});
            (void)d.set({index, 0}, Value{std::int64_t{second == 0 ? 1 : 2}});
        }
}
}  // namespace

void shape_pdos(const Freedoms& freedoms, const NonVolatile& memory, canopen::Dictionary& d) {
    if (freedoms.usual_pdos) set_usual_mappings(memory, d);
    for (std::uint16_t n = 0; n < pdos; ++n)
        for (const int map : {0x1600 + n, 0x1A00 + n})
            for (int i = 1; i <= integer(d, map, 0); ++i) {
                const auto word = static_cast<std::uint32_t>(integer(d, map, i));
                if (!freedoms.maps(canopen::mapped_entry(word).address.index))
                    (void)d.set({static_cast<std::uint16_t>(map), 0}, Value{std::int64_t{0}});
            }
    constexpr std::int64_t event_ms = 50;
    for (std::uint16_t n = 1; n <= freedoms.extra_tpdos && n < pdos; ++n) {
        const auto index = static_cast<std::uint16_t>(0x1800 + n);
        const Address identifier{index, 1}, timer{index, 5};
        if (memory.contains(memory_key(identifier)) || memory.contains(memory_key(timer)) || integer(d, index + 0x200, 0) == 0) continue;
        (void)d.set(identifier, Value{integer(d, index, 1) & ~invalid_bit});
        (void)d.set(timer, Value{event_ms});
    }
}

}  // namespace axisgate::cia402_drive::twin
