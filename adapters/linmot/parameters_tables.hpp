// Command table entries and curves as texts for people and as the bytes in the drive. Every text that is made here reads back to the same
// bytes. A text with a fault gives no bytes, and the fault has its place.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/linmot/motion_commands.hpp"

namespace axisgate::linmot {

inline constexpr std::size_t entry_size = 64, curve_info_size = 70, most_points = 16'383;

/// Bytes of an entry, or its fault. No bytes: the text is empty, and so is the entry.
struct EntryBytes {
    std::vector<std::uint8_t> bytes;
    std::string fault;
};
/// "VAI Go To Pos: position=50 velocity=1 acceleration=10 deceleration=10; next=6; name=out", values in the catalogue's units. An entry
/// without such a text (an unknown header) is "hex=" with all 64 bytes.
[[nodiscard]] std::string entry_text(const Motions& motions, std::span<const std::uint8_t> entry);
[[nodiscard]] EntryBytes entry_of(const Motions& motions, std::string_view text);
/// From its parts, as in an action; `next` 0: none.
[[nodiscard]] EntryBytes entry_of(const Motions& motions, std::string_view command, std::string_view arguments, std::uint16_t next,
                                  std::string_view name);

/// Both blocks of a curve (empty for none), or its fault with the number of the point.
struct CurveBytes {
    std::vector<std::uint8_t> info, data;
    std::string fault;
};
/// "name=sine; x=time; length=0.5; points=0 2.5 10": length in s, or in counts with x=encoder; points in mm. If the info block contains
/// further values, it follows as "info=" in hex.
[[nodiscard]] std::string curve_text(std::uint16_t id, std::span<const std::uint8_t> info, std::span<const std::uint8_t> data);
[[nodiscard]] CurveBytes curve_of(std::uint16_t id, std::string_view text);

}  // namespace axisgate::linmot
