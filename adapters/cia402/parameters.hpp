// The catalogue and the expected identity of a drive whose manufacturer provides a description (EDS, DCF). The file takes precedence over
// the family's catalogue. Objects that the gateway writes itself (its PDOs, heartbeat, and those that commands and streams write) can only
// be read.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/family.hpp"
#include "gateway/protocols/canopen/eds.hpp"

namespace axisgate::cia402_drive {

/// The objects of the catalogue with the file's type, limits, default and access; objects that the file does not have are left out. After
/// them all other objects of the file, each subindex as a parameter "2010h:03" with the file's text as its name. Domains are left out,
/// because their value is not a parameter. Without a description, no catalogue is made.
[[nodiscard]] OwnCatalogue own_catalogue(const CatalogueWish& wish);

/// The description that this catalogue was made from; empty if it was made from none.
[[nodiscard]] std::optional<canopen::Eds> description_of(const Catalogue& catalogue);

/// 1018h: vendor, product, revision.
using Identity = std::array<std::optional<std::uint32_t>, 3>;
struct ExpectedIdentity {
    std::string description;  ///< its name; empty: the family's catalogue is used
    Identity numbers;         ///< as the file states them
};
[[nodiscard]] ExpectedIdentity expected_identity(const Catalogue& catalogue);
/// Empty if they agree, or one of them is unknown. Of the revision only the upper 16 bits count: the lower ones change without a change of
/// the behaviour on the bus (CiA 301, 1018h).
[[nodiscard]] std::string differs(const ExpectedIdentity& expected, const Identity& drive);

}  // namespace axisgate::cia402_drive
