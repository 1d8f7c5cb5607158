// Motions: the motion commands of the catalogue as words: header, arguments packed behind it without gaps, and back.
// In: catalogue commands of kind motion_command, values in counts. Out: the bytes of the motion command buffer; words for people.
// Never sends; the count nibble is the caller's.
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
    bool inferred = false;     ///< its layout stands in no page of the maker that is known
    bool anywhere = false;     ///< may be sent in every state
};

class Motions {
public:
    explicit Motions(const Catalogue& catalogue);
    [[nodiscard]] const Motion* named(std::string_view id_or_name) const noexcept;
    [[nodiscard]] const Motion* of_header(std::uint16_t header) const noexcept;
    [[nodiscard]] std::size_t size() const noexcept { return by_header_.size(); }

    /// Header with `count` in its low nibble, then the values low byte first. As many values as the command has arguments.
    [[nodiscard]] static std::vector<std::uint8_t> pack(const Motion& motion, std::uint8_t count, std::span<const Value> values);
    /// "VAI Go To Pos, count 3: position 15 mm, velocity 1 m/s"; unknown headers are said to be so.
    [[nodiscard]] std::string describe(std::span<const std::uint8_t> buffer) const;
    /// Values in counts; nothing if bytes are missing. Surplus bytes are ignored, as a drive does.
    [[nodiscard]] static std::optional<std::vector<Value>> unpack(const Motion& motion, std::span<const std::uint8_t> buffer);

private:
    std::map<std::uint16_t, Motion> by_header_;
};

}  // namespace axisgate::linmot
