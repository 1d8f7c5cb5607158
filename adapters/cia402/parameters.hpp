// Parameters of a drive that its maker has described (EDS, DCF): its own catalogue, and who it should be.
// In: the family's page, the file. Out: a catalogue in which the file has the last word; the identity that 1018h is compared with.
// Never gives a hand on what the gateway itself sets: its PDOs, heartbeat and what commands and streams write can only be read.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/family.hpp"
#include "gateway/protocols/canopen/eds.hpp"

namespace axisgate::cia402_drive {

/// The page's objects as the file has them: type, limits, default, access; those that the file does not have are not there. Behind them
/// all other objects of the file, each subindex a parameter "2010h:03" with the file's words as its name. Domains have no value that is a
/// parameter, and are left out. Nothing is made without a description.
[[nodiscard]] OwnCatalogue own_catalogue(const CatalogueWish& wish);

/// The description that such a catalogue was made of; nothing: it was made of none.
[[nodiscard]] std::optional<canopen::Eds> description_of(const Catalogue& catalogue);

/// 1018h: vendor, product, revision.
using Identity = std::array<std::optional<std::uint32_t>, 3>;
struct ExpectedIdentity {
    std::string description;  ///< its name; empty: the catalogue is the family's page
    Identity numbers;         ///< what the file says
};
[[nodiscard]] ExpectedIdentity expected_identity(const Catalogue& catalogue);
/// Empty where they agree, or one of them does not say. Of the revision the upper 16 bits count: the lower ones change without a change of
/// what the drive does on the bus (CiA 301, 1018h).
[[nodiscard]] std::string differs(const ExpectedIdentity& expected, const Identity& drive);

}  // namespace axisgate::cia402_drive
