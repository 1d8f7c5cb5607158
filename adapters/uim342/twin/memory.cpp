// Storage classes, value sets and the named image of the non-volatile memory.
// In: values. Out: values.
// Never acts on a value.
#include "adapters/uim342/twin/memory.hpp"

#include <algorithm>
#include <string>
#include <type_traits>

namespace axisgate::uim342::twin {
namespace {

constexpr std::array<std::uint8_t, 4> ie_indices{0, 1, 2, 8};

std::string indexed(std::string_view name, std::size_t i) { return std::string(name) + "[" + std::to_string(i) + "]"; }

/// Calls `f(name, field, takes)` for every value of the EEPROM class; `takes(n)` says whether the register accepts n.
template <class S, class F>
void for_each_setting(S& s, F&& f) {
    const auto flag = [](std::int64_t n) { return n == 0 || n == 1; };
    const auto u32 = [](std::int64_t n) { return n >= 0 && n <= 0xFFFFFFFFLL; };
    const auto i32 = [](std::int64_t n) { return n >= INT32_MIN && n <= INT32_MAX; };
    const auto u16 = [](auto check) {
        return [check](std::int64_t n) { return n >= 0 && n <= 0xFFFF && check(static_cast<std::uint16_t>(n)); };
    };
    const auto ramp = [](std::int64_t n) { return n >= 1 && n <= 65'000'000; };  // set in one unit, kept when IC[4] changes
    for (std::size_t i = 0; i < s.ic.size(); ++i)
        f(indexed("IC", i), s.ic[i], flag);
    for (std::size_t i = 0; i < s.ie.size(); ++i)
        f(indexed("IE", ie_indices[i]), s.ie[i], flag);
    for (std::size_t i = 0; i < s.qe.size(); ++i) {
        if (i != 3) f(indexed("QE", i), s.qe[i], u16([i](std::uint16_t n) { return qe_takes(i, n); }));  // [3] is a status
    }
    for (std::size_t i = 0; i < s.mt.size(); ++i)
        f(indexed("MT", i), s.mt[i], u16([i](std::uint16_t n) { return mt_takes(i, n); }));
    for (std::size_t i = 0; i < s.il.size(); ++i)
        f(indexed("IL", i), s.il[i], u16([i](std::uint16_t n) { return il_takes(i, n); }));
    for (std::size_t i = 0; i < s.tg.size(); ++i)
        f(indexed("TG", i), s.tg[i], u16([](std::uint16_t n) { return tg_takes(n); }));
    f("AC", s.group[0].ac, ramp);
    f("DC", s.group[0].dc, ramp);
    f("SS", s.ss, u32);
    f("SD", s.sd, u32);
    f("BL", s.bl, [](std::int64_t n) { return n >= 0 && n <= 65536; });
    for (std::size_t g = 2; g < s.group.size(); ++g) {
        const std::string name = "MF" + std::to_string(g) + ".";
        f(name + "AC", s.group[g].ac, ramp);
        f(name + "DC", s.group[g].dc, ramp);
        f(name + "SP", s.group[g].sp, i32);
        f(name + "PR", s.group[g].pr, i32);
        f(name + "PA", s.group[g].pa, i32);
    }
}

std::optional<std::int64_t> number(const NonVolatile& from, const std::string& name) {
    const auto it = from.find(name);
    return it == from.end() ? std::nullopt : as_integer(it->second);
}

}  // namespace

bool pp_takes(std::uint8_t index, std::uint16_t value) noexcept { return index == 5 ? value <= 4 : value >= 5 && value <= 126; }

bool qe_takes(std::size_t index, std::uint16_t value) noexcept {
    switch (index) {
        case 0:
            return value >= 1;
        case 1:
            return value >= 10;
        case 2:
            return value == 17 || value == 20;
        case 4:
            return value >= 200 && value <= 25600;
        default:
            return false;
    }
}

bool mt_takes(std::size_t index, std::uint16_t value) noexcept {
    switch (index) {
        case 0:
            return value >= 1 && value <= 64 && (value & (value - 1)) == 0;
        case 1:
            return value >= 5 && value <= 80;
        case 2:
            return value <= 100;
        case 3:
            return value <= 60000;
        default:
            return false;
    }
}

bool il_takes(std::size_t index, std::uint16_t value) noexcept {
    if (index == 3) return value <= 1;
    const auto known = [](unsigned byte) { return (byte & 0x7Fu) <= 0x0B; };
    return known(value & 0xFFu) && known(value >> 8);
}

bool tg_takes(std::uint16_t value) noexcept { return value <= 60001; }

bool ramp_takes(std::uint32_t value, bool as_time) noexcept { return value >= 1 && value <= (as_time ? 60'000u : 65'000'000u); }

bool bl_takes(std::uint32_t value) noexcept { return value <= 65536; }

std::optional<std::size_t> ie_slot(std::uint8_t index) noexcept {
    const auto* const it = std::ranges::find(ie_indices, index);
    if (it == ie_indices.end()) return std::nullopt;
    return static_cast<std::size_t>(it - ie_indices.begin());
}

void Memory::restore_factory() noexcept {
    if (!(eeprom_ == factory_settings_)) ++revision_;
    eeprom_ = ram_ = factory_settings_;
}

void Memory::save(NonVolatile& to) const {
    const auto put = [&to](const std::string& name, std::int64_t n) { to[name] = Value{n}; };
    put("PP[5]", flash_.bit_rate);
    put("PP[7]", flash_.node);
    put("PP[8]", flash_.group);
    put("SN", serial_);
    for_each_setting(eeprom_, [&put](const std::string& name, auto field, const auto&) { put(name, field); });
}

void Memory::load(const NonVolatile& from) {
    flash_ = factory_;
    const auto byte = [&from](std::uint8_t index, std::uint8_t& field) {
        const auto n = number(from, indexed("PP", index));
        if (n && *n >= 0 && *n <= 0xFF && pp_takes(index, static_cast<std::uint16_t>(*n))) field = static_cast<std::uint8_t>(*n);
    };
    byte(5, flash_.bit_rate);
    byte(7, flash_.node);
    byte(8, flash_.group);
    serial_ = factory_serial_;
    if (const auto n = number(from, "SN"); n && *n >= 0 && *n <= 0xFFFFFFFFLL) serial_ = static_cast<std::uint32_t>(*n);
    eeprom_ = factory_settings_;
    for_each_setting(eeprom_, [&from](const std::string& name, auto& field, const auto& takes) {
        const auto n = number(from, name);
        if (n && takes(*n)) field = static_cast<std::remove_reference_t<decltype(field)>>(*n);
    });
    ram_ = eeprom_;
}

}  // namespace axisgate::uim342::twin
