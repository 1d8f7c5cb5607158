// The setup of one adapter: the drives on its line, their axes, and the line's timing. The engine makes it from the site. It does not name
// the transport: an adapter knows frames or bytes and the bit rate, but not whether a twin or a cable is connected.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/ids.hpp"
#include "gateway/core/instant.hpp"

namespace axisgate {

class Catalogue;

enum class LineKind : std::uint8_t { can, bytes };

struct AxisSetup {
    AxisId id = no_axis;
    int channel = 1;  ///< 1-based axis within the drive
    /// Zero: polled at the line's period. Otherwise it is polled at this period for a while, as far as the line has capacity after the
    /// other drives. It does not make two setups of a drive different.
    Duration look_period{};
    /// The site's limits of position in increments, for a drive with software limits of its own. Absent: the site has none.
    std::optional<std::int64_t> position_min{}, position_max{};
};

struct DriveSetup {
    DriveId id = no_drive;
    std::string name;
    std::string address;  ///< in the family's own form, checked by Family::check_address
    std::vector<AxisSetup> axes;
    std::map<std::string, std::string> options;    ///< the drive's "options" of the site, values as text; see the family's README
    std::shared_ptr<const Catalogue> catalogue{};  ///< the catalogue that numbers its points; null: the family's page
};

/// Times and repeats on the line. A Duration of zero means the family's own default.
struct LineTiming {
    Duration reply_timeout{};  ///< time to wait for one answer
    Duration poll_period{};    ///< time between two polls of the same axis
    Duration pause{};          ///< silence between an answer and the next request
    int retries = -1;          ///< further attempts of a repeatable exchange; -1: the family's default
    int silent_limit = 3;      ///< number of exchanges without an answer after which a drive counts as absent
    Duration stale_after{};    ///< age from which feedback counts as stale; zero: 1 s on CAN, 3 s on byte lines
    Duration retry_pause_min = std::chrono::milliseconds(200);  ///< first pause before an absent drive is tried again
    Duration retry_pause_max = std::chrono::seconds(5);         ///< the pause doubles up to this
};

struct LineSetup {
    LineId id = no_line;
    std::string name;
    LineKind kind = LineKind::bytes;
    std::uint32_t bit_rate = 0;       ///< bit/s; 0: unknown (TCP)
    std::uint8_t bits_per_byte = 10;  ///< start, data, parity and stop bits of a byte on a serial line
    LineTiming timing;
    std::map<std::string, std::string> options;  ///< the line's "options" of the site
    std::vector<DriveSetup> drives;
};

/// Value of an option, or `fallback`.
[[nodiscard]] inline std::string option(const std::map<std::string, std::string>& options, const std::string& name,
                                        std::string_view fallback) {
    const auto it = options.find(name);
    return it == options.end() ? std::string(fallback) : it->second;
}

}  // namespace axisgate
