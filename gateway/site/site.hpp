// Site: what is connected and how it is mapped: lines, drives, axes, mappings, as one document.
// In: JSON (schema/site.schema.json). Out: checked values, or all faults at once, each with its place and a way to mend it.
// Never touches hardware and never reads a file: a site is a value.
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
    automatic  ///< the real drive if it answers, else the twin takes over ("auto" in the document)
};
[[nodiscard]] std::string_view name_of(PresenceRule rule) noexcept;

struct LineSpec {
    std::string name;
    std::string uri;            ///< CONTRACT's line URIs; "twin": a bus with embedded drives alone
    std::string family;         ///< of its drives that name none; empty on a CAN line whose drives all name theirs
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
    std::string description{};  ///< name of the maker's description (EDS, DCF) that is its catalogue; empty: none
    bool operator==(const DriveSpec&) const = default;
};

struct AxisSpec {
    std::string name;
    std::string drive;
    int channel = 1;                     ///< 1-based, within the drive
    int number = 0;                      ///< 1..1024: place in the register map
    std::string group{};                 ///< the machine part that it belongs to, for people: "infeed"; at most 64 bytes; empty: none
    std::string unit;                    ///< for people: "mm", "deg"; empty: increments
    double increments_per_unit = 1.0;    ///< > 0
    std::optional<double> position_min;  ///< software limits of the gateway, in `unit`
    std::optional<double> position_max;
    std::optional<double> velocity_max;  ///< unit/s, > 0
    std::optional<double> acceleration_max;
    /// unit/s^2, > 0: the weakest ramp that its drive may brake with, for what is reckoned where the drive does not tell its own.
    std::optional<double> deceleration_min{};
    bool unread_statements = true;  ///< native statements and actions that may begin a motion that nobody can read beforehand are taken
    AuthorityMode authority_mode = AuthorityMode::free;  ///< "lease": a command takes the axis for a while, and others are refused
    StoredParameters stored_parameters = StoredParameters::ignore;  ///< what was written is compared when the drive answers, or written
    FailSafe fail_safe;                                             ///< what happens when the client that commands it is lost
    bool trend_on_disk = false;                                     ///< its trends outlive the gateway
    bool operator==(const AxisSpec&) const = default;
};

/// What reads of a unit 2..254 of the Modbus door show at addresses where nothing is mapped.
enum class MapGaps : std::uint8_t {
    zero,   ///< 0, where the same request touches something that is mapped: clients that read in blocks need it
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
    std::vector<ProfileSpec> profiles;     ///< units that speak another device's language
    std::vector<AssemblySpec> assemblies;  ///< EtherNet/IP instances of its own, beside those of axes and profiles
    std::map<std::uint8_t, MapGaps> gaps;  ///< "modbus_units": by unit 2..254, where it is not as `[modbus] gaps` has it

    /// By drive, where it is not its family's page: made by parse_site, a function of the document and the descriptions that it names.
    std::map<std::string, std::shared_ptr<const Catalogue>, std::less<>> own_catalogues;

    [[nodiscard]] const LineSpec* line(std::string_view name) const noexcept;
    [[nodiscard]] const DriveSpec* drive(std::string_view name) const noexcept;
    [[nodiscard]] const AxisSpec* axis(std::string_view name) const noexcept;
    /// A drive's own family, or its line's; empty if neither names one.
    [[nodiscard]] std::string_view family_of(const DriveSpec& drive) const noexcept;
    /// Families of a line without repeats: its own first, then its drives' in the order of the document.
    [[nodiscard]] std::vector<std::string> families_on(const LineSpec& line) const;
};

struct SiteFault {
    std::string pointer;    ///< JSON pointer into the document: "/axes/2/number"
    std::string text;       ///< what is wrong
    std::string remedy;     ///< what to do
    bool conflict = false;  ///< a place is taken: either of two entries must give way
};

struct FamilyEntry {
    const Family* family = nullptr;
    const Catalogue* catalogue = nullptr;
};
/// Looks a family up by name; an entry of nullptrs if there is none. Also lists the names for messages.
struct Families {
    std::vector<FamilyEntry> entries;
    std::shared_ptr<DescriptionShelf> descriptions{};  ///< that drives of a site may name; null: none
    [[nodiscard]] FamilyEntry find(std::string_view name) const noexcept;
    [[nodiscard]] std::string names() const;
};

/// Families that may share a CAN line.
inline constexpr std::size_t most_families_on_a_line = 4;

/// What crosses a line: by its URI, and where that is "twin", by its family and its option "kind". A line without a family is CAN there.
[[nodiscard]] LineKind kind_of(const LineSpec& line, const Families& families);

/// The catalogue of a drive of the site: its own, or its family's page, which outlives every site; null: there is no such family.
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
