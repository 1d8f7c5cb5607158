// Assemblies: the EtherNet/IP assembly instances of a site: a range of registers of a unit, served as bytes in one direction.
// The entries of `assemblies` and the instances of the site's profiles are read and checked; all faults are reported at once, each with its
// place and the present user of an instance that is taken. The meaning of the bytes is in the map of the unit.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <boost/json/value.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/csv.hpp"

namespace axisgate {

enum class MapTable : std::uint8_t;
struct Site;
struct SiteFault;

/// Seen from the originator: it reads an `input` (target to originator) and renews an `output` (originator to target).
enum class AssemblyDirection : std::uint8_t { input, output };
/// little_endian: each value as a whole, lowest byte first, as in CIP, for any word order of its registers; texts in reading order.
/// registers: the registers one after another, the high byte of each first, as in Modbus.
enum class AssemblyOrder : std::uint8_t { little_endian, registers };
[[nodiscard]] std::string_view name_of(AssemblyDirection direction) noexcept;
[[nodiscard]] std::string_view name_of(AssemblyOrder order) noexcept;

inline constexpr std::size_t most_assemblies = 64;             ///< limit for the entries of a site; those of profiles are additional
inline constexpr std::uint16_t most_assembly_registers = 250;  ///< 500 bytes: a class 1 connection without Large_Forward_Open
inline constexpr std::uint16_t last_near_assembly = 40;        ///< axis numbers up to here have the instances 100+n and 150+n

struct AssemblySpec {
    std::uint16_t instance = 0;  ///< 1..65535, not used otherwise
    AssemblyDirection direction = AssemblyDirection::input;
    std::uint8_t unit = 2;        ///< 2..254
    MapTable table{};             ///< holding_registers, or input_registers for an input
    std::uint16_t address = 0;    ///< 0-based
    std::uint16_t registers = 1;  ///< 1..most_assembly_registers, two bytes each
    AssemblyOrder order = AssemblyOrder::little_endian;
    std::string comment;  ///< comment for the user, up to 64 bytes
    [[nodiscard]] std::uint16_t bytes() const noexcept { return static_cast<std::uint16_t>(2 * registers); }
    bool operator==(const AssemblySpec&) const = default;
};

/// The user of an instance that is fixed for every site: "axis 7 to the originator"; empty if there is none.
[[nodiscard]] std::string fixed_assembly(std::uint32_t instance);

/// Reads `assemblies` into the site.
void read_assemblies(const boost::json::value* list, Site& site, std::vector<SiteFault>& faults);
/// Finds conflicts of entries with each other and with the profiles and mappings of the site, which must have been read before. `called`
/// returns the name of the entry with this index for messages about another one, such as "row 3"; without it the entry's range is used.
/// With `called`, an instance that a profile also uses is a fault of the entry and not of the profile.
void check_assemblies(const Site& site, std::vector<SiteFault>& faults, const std::function<std::string(std::size_t index)>& called = {});
[[nodiscard]] boost::json::object to_json(const AssemblySpec& assembly);

/// The entries as CSV with a header line, and back, as rows_from_csv says.
[[nodiscard]] std::string assemblies_to_csv(std::span<const AssemblySpec> assemblies);
[[nodiscard]] std::optional<boost::json::array> assemblies_from_csv(std::string_view csv, std::vector<std::size_t>& lines,
                                                                    std::vector<CsvFault>& faults);

/// An assembly that is served: an entry of the site, or one of a profile.
struct SiteAssembly {
    AssemblySpec spec;
    std::vector<std::string> axes;  ///< axes that it shows or commands
    std::string name;               ///< text for the user: "pacontrol of unit 20 to the originator"
    std::uint16_t partner = 0;      ///< of an output: the input that an originator reads with it; 0: none
};
/// By instance.
[[nodiscard]] std::vector<SiteAssembly> assemblies_of(const Site& site);

}  // namespace axisgate
