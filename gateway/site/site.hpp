// Site is the document of the connected equipment and its mapping: lines, drives, axes, mappings (JSON, schema/site.schema.json). Reading
// gives checked values, or all faults at once, each with place and remedy. A site is a value: no hardware and no file is accessed here.
#pragma once

#include <boost/json/object.hpp>
#include <boost/json/value.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/family.hpp"
#include "gateway/core/setup.hpp"
#include "gateway/site/assembly.hpp"
#include "gateway/site/authority_mode.hpp"
#include "gateway/site/descriptions.hpp"
#include "gateway/site/fail_safe.hpp"
#include "gateway/site/profile.hpp"
#include "gateway/site/stored_parameters.hpp"

namespace axisgate {

enum class PresenceRule : std::uint8_t {
    device,    ///< the real drive only; absent means offline
    twin,      ///< the embedded model only
    automatic  ///< the real drive if it answers, otherwise the twin ("auto" in the document)
};
[[nodiscard]] std::string_view name_of(PresenceRule rule) noexcept;

struct LineSpec {
    std::string name;
    std::string uri;            ///< CONTRACT's line URIs; "twin": a bus with embedded drives only
    std::string family;         ///< of drives that name no family; empty on a CAN line whose drives all name theirs
    std::uint32_t bitrate = 0;  ///< bit/s; 0: from the URI or the family's default
    std::map<std::string, std::string> options;
    LineTiming timing;  ///< "timing": {"reply_timeout_ms": ..., "poll_period_ms": ..., ...}
    bool operator==(const LineSpec&) const;
};

struct DriveSpec {
    std::string name;
    std::string line;
    std::string family;   ///< empty: the line's
    std::string address;  ///< number or text in the document; text here
    PresenceRule presence = PresenceRule::automatic;
    std::map<std::string, std::string> options;
    std::string description{};  ///< name of the manufacturer's description (EDS, DCF) that is its catalogue; empty: none
    bool operator==(const DriveSpec&) const = default;
};

struct AxisSpec {
    std::string name;
    std::string drive;
    int channel = 1;                     ///< 1-based, within the drive
    int number = 0;                      ///< 1..1024: place in the register map
    std::string group{};                 ///< the machine section that it belongs to, for the user: "infeed"; at most 64 bytes; empty: none
    std::string unit;                    ///< for the user: "mm", "deg"; empty: increments
    double increments_per_unit = 1.0;    ///< > 0
    std::optional<double> position_min;  ///< software limits of the gateway, in `unit`
    std::optional<double> position_max;
    std::optional<double> velocity_max;  ///< unit/s, > 0
    std::optional<double> acceleration_max;
    /// unit/s^2, > 0: the lowest deceleration that its drive may use, for calculations when the drive does not report its own.
    std::optional<double> deceleration_min{};
    bool unread_statements = true;  ///< native statements and actions that may begin a motion that cannot be determined beforehand are
                                    ///< accepted
    AuthorityMode authority_mode = AuthorityMode::free;  ///< "lease": a command reserves the axis for some time, and others are refused
    StoredParameters stored_parameters = StoredParameters::ignore;  ///< whether written parameters are compared or written when the drive
                                                                    ///< answers
    FailSafe fail_safe;                                             ///< the action when the client that commands it is lost
    bool trend_on_disk = false;                                     ///< its trends are kept over a restart of the gateway
    bool operator==(const AxisSpec&) const = default;
};

/// The answer to reads of a unit 2..254 of the Modbus door at unmapped addresses.
enum class MapGaps : std::uint8_t {
    zero,   ///< 0, if the same request includes a mapped address: clients that read in blocks need this
    refuse  ///< exception 2 for the whole request
};
[[nodiscard]] std::string_view name_of(MapGaps gaps) noexcept;
[[nodiscard]] std::optional<MapGaps> map_gaps_named(std::string_view name) noexcept;

struct Mapping;

struct Site {
    std::vector<LineSpec> lines;
    std::vector<DriveSpec> drives;
    std::vector<AxisSpec> axes;
    std::shared_ptr<const std::vector<Mapping>> mappings;  ///< checked, in the order of the document; null: none
    [[nodiscard]] const std::vector<Mapping>& map() const noexcept;
    std::vector<ProfileSpec> profiles;     ///< units with the registers of another device
    std::vector<AssemblySpec> assemblies;  ///< EtherNet/IP instances of the site, in addition to those of axes and profiles
    std::map<std::uint8_t, MapGaps> gaps;  ///< "modbus_units": by unit 2..254, if it differs from `[modbus] gaps`

    /// By drive, if it differs from the family's catalogue: made by parse_site from the document and the descriptions that it names.
    std::map<std::string, std::shared_ptr<const Catalogue>, std::less<>> own_catalogues;

    [[nodiscard]] const LineSpec* line(std::string_view name) const noexcept;
    [[nodiscard]] const DriveSpec* drive(std::string_view name) const noexcept;
    [[nodiscard]] const AxisSpec* axis(std::string_view name) const noexcept;
    /// The family of the drive, or of its line; empty if neither names one.
    [[nodiscard]] std::string_view family_of(const DriveSpec& drive) const noexcept;
    /// The families of a line, each once: that of the line first, then those of its drives in the order of the document.
    [[nodiscard]] std::vector<std::string> families_on(const LineSpec& line) const;
};

struct SiteFault {
    std::string pointer;    ///< JSON pointer into the document: "/axes/2/number"
    std::string text;       ///< the fault
    std::string remedy;     ///< the remedy
    bool conflict = false;  ///< the place is in use: one of the two entries must change
};

struct FamilyEntry {
    const Family* family = nullptr;
    const Catalogue* catalogue = nullptr;
};
/// Looks a family up by name; an entry of nullptrs if there is none. Also lists the names for messages.
struct Families {
    std::vector<FamilyEntry> entries;
    std::shared_ptr<DescriptionShelf> descriptions{};  ///< that drives of a site may name; nullptr: none
    [[nodiscard]] FamilyEntry find(std::string_view name) const noexcept;
    [[nodiscard]] std::string names() const;
};

/// Families that may share a CAN line.
inline constexpr std::size_t most_families_on_a_line = 4;

/// The kind of a line: by its URI or, if that is "twin", by its family and its option "kind". A twin line without a family is CAN.
[[nodiscard]] LineKind kind_of(const LineSpec& line, const Families& families);

/// The catalogue of a drive of the site: its own, or that of its family, which outlives every site; nullptr: the family does not exist.
[[nodiscard]] std::shared_ptr<const Catalogue> catalogue_of(const Site& site, const DriveSpec& drive, const Families& families);

/// Reads and checks a whole document. Unknown keys are faults. A site is returned only if there is no fault.
[[nodiscard]] std::optional<Site> parse_site(const boost::json::value& document, const Families& families, std::vector<SiteFault>& faults);
/// The document of a site; parse_site(to_json(s)) == s.
[[nodiscard]] boost::json::object to_json(const Site& site);
[[nodiscard]] boost::json::object to_json(const LineSpec& line);
[[nodiscard]] boost::json::object to_json(const DriveSpec& drive);
[[nodiscard]] boost::json::object to_json(const AxisSpec& axis);
/// 1-based line of the value that a JSON pointer names in `text`; the nearest existing parent's line if it is missing.
[[nodiscard]] std::size_t line_of_pointer(std::string_view text, std::string_view pointer);

/// One sentence per difference: "axis feeder: unit mm -> deg", "drive slide: removed".
[[nodiscard]] std::vector<std::string> differences(const Site& from, const Site& to);
/// Register 18: hash over everything that changes the meaning of a register.
[[nodiscard]] std::uint32_t mapping_revision(const Site& site) noexcept;

}  // namespace axisgate
