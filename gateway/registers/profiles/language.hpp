// Language: a page of data that says which registers another device has: address, type, name, what each stands for.
// In: JSON (schema/profiles/*.json). Out: rows in order of their addresses, codes of errors; or the fault of the page.
// Never knows an axis. The page is read once at start, and is what people are shown as the list of registers.
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

/// Where a value stands on EtherNet/IP.
struct ObjectPlace {
    std::uint16_t class_id = 0, attribute = 0;
};

struct LanguageRow {
    std::uint16_t address = 0;
    bool holding = true, input = true;  ///< in which of the two tables of registers it stands
    MapType type = MapType::u16;        ///< u16, i16, u32, i32 or f32
    bool readable = true, writable = false;
    std::string name;       ///< as the device's manual writes it
    std::string meaning;    ///< by which the translator knows it; see each language
    std::uint8_t axis = 0;  ///< 1..8: there only if the profile has such an axis; 0: always there
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
    std::vector<LanguageRow> rows;      ///< by address; of one address the holding register first
    std::map<std::string, int> errors;  ///< the device's number for a Reason, and for what the translator names
    /// The device's number for a refusal; that of "internal" where the page names none.
    [[nodiscard]] int error_of(std::string_view what) const;
    [[nodiscard]] int error_of(Reason reason) const { return error_of(name_of(reason)); }
};

/// All four; absent entries are not served.
using Languages = std::array<std::shared_ptr<const Language>, profile_language_count>;

/// Reads one page; nothing and a fault if it is not as it should be: unknown members, rows that overlap, a type that no register has.
[[nodiscard]] std::shared_ptr<const Language> read_language(std::string_view text, std::string& fault);

}  // namespace axisgate::registers
