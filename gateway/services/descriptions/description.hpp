// Reads a maker's EDS or DCF file as a description that sites may name, and shows its content. The text may have any origin: it is accepted
// as a whole, or all faults are reported with their lines.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/records.hpp"
#include "gateway/protocols/canopen/eds.hpp"
#include "gateway/services/fault.hpp"
#include "gateway/site/descriptions.hpp"

namespace axisgate::descriptions {

inline constexpr std::size_t most_bytes = 1u << 20;    ///< of one file
inline constexpr std::size_t most_entries = 8'000;     ///< of one file; each entry is a parameter of every axis with this description
inline constexpr std::size_t most_descriptions = 200;  ///< of one gateway

/// Empty, or the fault in the name of a description: letters, digits, - _ and . , up to 64, with the ending .eds or .dcf.
[[nodiscard]] std::string check_name(std::string_view name);

struct Read {
    std::optional<canopen::Eds> eds;  ///< empty if there is a fault
    std::vector<canopen::FileFault> faults, notes;
};
/// Checks in addition to read_eds: too long, too many entries, and a device that is not a CiA 402 drive (by its 1000h, or because it has no
/// controlword and statusword).
[[nodiscard]] Read read(std::string_view text);
/// "line 12: ..." each; the remedy is the same for all.
[[nodiscard]] std::vector<Fault> faults_of(const Read& read);

/// Name, vendor, product, ..., PDO mapping, warnings; null if there are faults.
[[nodiscard]] std::shared_ptr<const boost::json::object> facts(const Description& d, const Read& read);

/// Its objects in order of index: number, name, type, access, limits, default, value of a DCF, and the line in the file. Empty if there are
/// faults.
[[nodiscard]] boost::json::array objects_of(const Read& read);

/// A DCF of one drive: its description with the values of a snapshot. `left_out` is the number of values that a DCF of this description
/// cannot contain.
struct Dcf {
    std::string text;
    std::vector<std::string> left_out;
};
[[nodiscard]] Dcf dcf_of(const canopen::Eds& eds, const Catalogue& catalogue, const AxisSnapshot& snapshot, std::uint8_t node,
                         std::string_view node_name, std::uint32_t bit_rate);

}  // namespace axisgate::descriptions
