// The registers of another device as data (schema/profiles/*.json): address, type, name, and the meaning of each, with its error codes. A
// page is read once at the start and is also shown to people as the list of registers. It knows no axis.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate::registers {

/// The place of a value on EtherNet/IP.
struct ObjectPlace {
    std::uint16_t class_id = 0, attribute = 0;
};

struct LanguageRow {
    std::uint16_t address = 0;
    bool holding = true, input = true;  ///< the tables of registers that contain it
    MapType type = MapType::u16;        ///< u16, i16, u32, i32 or f32
    bool readable = true, writable = false;
    std::string name;       ///< as in the device's manual
    std::string meaning;    ///< the key for the translator of the language
    std::uint8_t axis = 0;  ///< 1..8: only if the profile has such an axis; 0: always
    std::optional<double> min, max;
    double initial = 0;
    std::optional<ObjectPlace> object;
    std::string description;
    [[nodiscard]] std::uint16_t width() const noexcept { return type == MapType::u16 || type == MapType::i16 ? 1 : 2; }
    [[nodiscard]] std::uint32_t end() const noexcept { return std::uint32_t{address} + width(); }
};

struct Language {
    std::string name, title, description, source;
    MapWordOrder word_order = MapWordOrder::high_first;
    std::vector<LanguageRow> rows;      ///< by address; for equal addresses the holding register first
    std::map<std::string, int> errors;  ///< the device's number for a Reason, and for conditions that the translator names
    /// The device's number for a refusal; the number of "internal" if the page has none.
    [[nodiscard]] int error_of(std::string_view what) const;
    [[nodiscard]] int error_of(Reason reason) const { return error_of(name_of(reason)); }
};

/// All four languages; absent ones are not served.
using Languages = std::array<std::shared_ptr<const Language>, profile_language_count>;

/// Reads one page. Returns null and a fault for unknown members, overlapping rows, or a type that no register has.
[[nodiscard]] std::shared_ptr<const Language> read_language(std::string_view text, std::string& fault);

}  // namespace axisgate::registers
