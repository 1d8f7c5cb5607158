// Motions packs the motion commands of the catalogue (header, arguments without gaps) into the motion command buffer, unpacks them, and
// describes them. The caller sets the count nibble.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/core/catalogue.hpp"

namespace axisgate::linmot {

struct Motion {
    const CatalogueCommand* command = nullptr;
    std::uint16_t header = 0;  ///< count 0
    bool inferred = false;     ///< no known page of the manufacturer describes its layout
    bool anywhere = false;     ///< permitted in every state
};

class Motions {
public:
    explicit Motions(const Catalogue& catalogue);
    [[nodiscard]] const Motion* named(std::string_view id_or_name) const noexcept;
    [[nodiscard]] const Motion* of_header(std::uint16_t header) const noexcept;
    [[nodiscard]] std::size_t size() const noexcept { return by_header_.size(); }

    /// Header with `count` in its low nibble, then the values, low byte first. The number of values must be that of the command's
    /// arguments.
    [[nodiscard]] static std::vector<std::uint8_t> pack(const Motion& motion, std::uint8_t count, std::span<const Value> values);
    /// "VAI Go To Pos, count 3: position 15 mm, velocity 1 m/s"; unknown headers are reported as such.
    [[nodiscard]] std::string describe(std::span<const std::uint8_t> buffer) const;
    /// Values in counts; empty if bytes are missing. Surplus bytes are ignored, as a drive does.
    [[nodiscard]] static std::optional<std::vector<Value>> unpack(const Motion& motion, std::span<const std::uint8_t> buffer);

private:
    std::map<std::uint16_t, Motion> by_header_;
};

}  // namespace axisgate::linmot
