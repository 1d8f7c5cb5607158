// Assemblies: EtherNet/IP assembly instances of the site's own: a range of registers of a unit, served as bytes in one direction.
// In: the entries of a site's `assemblies`, and the instances that its profiles name. Out: checked entries; all faults at once, each with
// its place and what holds an instance that is taken. Never knows what a byte means: that is the map behind the unit.
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

/// Seen from the originator: `input` is what it reads (target to originator), `output` what it renews (originator to target).
enum class AssemblyDirection : std::uint8_t { input, output };
/// little_endian: each value whole, its lowest byte first, as CIP has it, whatever the word order of its registers; texts as they are read.
/// registers: the registers one after another, the high byte of each first, as Modbus carries them.
enum class AssemblyOrder : std::uint8_t { little_endian, registers };
[[nodiscard]] std::string_view name_of(AssemblyDirection direction) noexcept;
[[nodiscard]] std::string_view name_of(AssemblyOrder order) noexcept;

inline constexpr std::size_t most_assemblies = 64;             ///< entries of a site; those of profiles come on top
inline constexpr std::uint16_t most_assembly_registers = 250;  ///< 500 bytes: a class 1 connection without Large_Forward_Open
inline constexpr std::uint16_t last_near_assembly = 40;        ///< axis numbers up to here have the instances 100+n and 150+n

struct AssemblySpec {
    std::uint16_t instance = 0;  ///< 1..65535, one that nothing else has
    AssemblyDirection direction = AssemblyDirection::input;
    std::uint8_t unit = 2;        ///< 2..254
    MapTable table{};             ///< holding_registers, or input_registers of an input
    std::uint16_t address = 0;    ///< 0-based
    std::uint16_t registers = 1;  ///< 1..most_assembly_registers, two bytes each
    AssemblyOrder order = AssemblyOrder::little_endian;
    std::string comment;  ///< up to 64 bytes, for people
    [[nodiscard]] std::uint16_t bytes() const noexcept { return static_cast<std::uint16_t>(2 * registers); }
    bool operator==(const AssemblySpec&) const = default;
};

/// What holds an instance whatever the site says: "axis 7 to the originator"; empty: nothing does.
[[nodiscard]] std::string fixed_assembly(std::uint32_t instance);

/// Reads `assemblies` into the site.
void read_assemblies(const boost::json::value* list, Site& site, std::vector<SiteFault>& faults);
/// Faults of entries against each other, the profiles and the mappings of the site, which must have been read. `called`: how people call
/// the entry with this index where another one is in its way, such as "row 3"; by its range where it is empty or gives nothing. With it, an
/// instance that a profile has, too, is the entry's fault and not the profile's.
void check_assemblies(const Site& site, std::vector<SiteFault>& faults, const std::function<std::string(std::size_t index)>& called = {});
[[nodiscard]] boost::json::object to_json(const AssemblySpec& assembly);

/// The entries as CSV with a header line, and back, as rows_from_csv says.
[[nodiscard]] std::string assemblies_to_csv(std::span<const AssemblySpec> assemblies);
[[nodiscard]] std::optional<boost::json::array> assemblies_from_csv(std::string_view csv, std::vector<std::size_t>& lines,
                                                                    std::vector<CsvFault>& faults);

/// One that is served: an entry of the site, or what a profile has for itself.
struct SiteAssembly {
    AssemblySpec spec;
    std::vector<std::string> axes;  ///< that it shows, or that it commands
    std::string name;               ///< for people: "pacontrol of unit 20 to the originator"
    std::uint16_t partner = 0;      ///< of an output: the input that an originator reads with it; 0: none
};
/// By instance.
[[nodiscard]] std::vector<SiteAssembly> assemblies_of(const Site& site);

}  // namespace axisgate
