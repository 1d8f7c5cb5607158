// Messages and commands that no known page of the manufacturer describes. The option `inferred` of a drive decides whether they may be
// sent.
#pragma once

#include <cstdint>
#include <string_view>

#include "gateway/core/catalogue.hpp"

namespace axisgate::linmot {

/// The layout of this message is inferred from its neighbours, from other buses of the family or from public programs. Messages that such
/// programs prove on drives (00h/01h, RAM reads) are not inferred. Motion commands are marked in the catalogue.
[[nodiscard]] bool inferred(std::uint8_t main, std::uint8_t sub) noexcept;
/// The mark of a command, by its id.
[[nodiscard]] bool inferred(const Catalogue& catalogue, std::string_view command);

}  // namespace axisgate::linmot
