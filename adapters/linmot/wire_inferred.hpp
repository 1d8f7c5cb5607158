// What no known page of the maker shows: the messages, and the commands of the catalogue that rest on them.
// In: a message's IDs, or a command. Out: whether it is concluded instead of read. Never decides whether it may be sent: the drive's option
// `inferred` does.
#pragma once

#include <cstdint>
#include <string_view>

#include "gateway/core/catalogue.hpp"

namespace axisgate::linmot {

/// A message to a drive whose layout is concluded from its neighbours, from other buses of the family or from public programs. What such
/// programs prove on drives (00h/01h, RAM reads) is none. Motion commands have their mark in the catalogue.
[[nodiscard]] bool inferred(std::uint8_t main, std::uint8_t sub) noexcept;
/// The mark of a command, by its id.
[[nodiscard]] bool inferred(const Catalogue& catalogue, std::string_view command);

}  // namespace axisgate::linmot
