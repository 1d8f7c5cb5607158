// The parameters, commands and error codes of one family, read once from schema/families/<name>.json and constant afterwards, with lookups
// by id and range checks whose message names the range. Values are kept elsewhere, in image and store.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/value.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "gateway/core/freedom.hpp"
#include "gateway/core/ids.hpp"
#include "gateway/core/value.hpp"

namespace axisgate {

enum class Access : std::uint8_t { read, write, read_write };

struct Parameter {
    std::string id;    ///< as in the manual
    std::string name;  ///< snake_case, unique in the family
    std::string group;
    ValueType type = ValueType::i32;
    std::string unit;           ///< empty: none
    std::optional<double> min;  ///< absent: the manual is silent; the type's range applies
    std::optional<double> max;
    Value factory_default;  ///< unknown: the manual is silent
    Access access = Access::read;
    std::string storage;  ///< "eeprom", "ram", ...
    /// The drive is reached by it: its address, name or group, or the speed and form of its line. Snapshots and tables are written back
    /// without it unless requested: a copied address would give two drives that cannot be distinguished, or one that cannot be found.
    bool addressing = false;
    /// It acts at once instead of configuring: a switch, set-point, counter, selector, output or latched status that can be written, or a
    /// variable of the user's program. Snapshots and tables are written back without it unless requested, and comparisons do not count it
    /// as a difference.
    bool live = false;
    std::string description;
    std::vector<std::pair<std::int64_t, std::string>> allowed;  ///< the only values, with their meaning; empty: min..max decides
    std::uint16_t first = 0;                                    ///< arrays: number of the first element
    std::uint16_t count = 0;                                    ///< number of elements; 0: not an array
    boost::json::object wire;  ///< the family's own keys ("cw", "index"), which its adapter reads once at the start

    [[nodiscard]] bool readable() const noexcept { return access != Access::write; }
    [[nodiscard]] bool writable() const noexcept { return access != Access::read; }
};

/// The condition by which a command of the catalogue is complete: a client that waits for the end is answered `done` then, and not before.
enum class Completion : std::uint8_t {
    acknowledged,    ///< the drive has acknowledged it
    target_reached,  ///< the axis has arrived at the target of the command
    standstill,      ///< the axis stands
    powered,         ///< the axis is enabled
    online_again,    ///< the drive has fallen silent and answers again: a restart
    reported         ///< the drive reports it in its own way, and its adapter passes it on
};
/// "acknowledged", "target_reached", "standstill", "powered", "online_again", "reported".
[[nodiscard]] std::string_view name_of(Completion completion) noexcept;

/// A named argument of a command; command_arguments.hpp has the check and the form for adapters.
struct CommandArgument {
    std::string name;                 ///< snake_case, unique in the command
    ValueType type = ValueType::i32;  ///< of the drive's count
    std::string unit;                 ///< of the value that a client gives, and of min, max and default; empty: none
    double scale = 1;                 ///< units per count: 0.0001 if the drive counts 0.1 um and clients use mm
    std::optional<double> min;        ///< absent: the type's range, scaled
    std::optional<double> max;
    Value fallback;  ///< the default; unknown: the argument is required
    std::string description;
};

struct CatalogueCommand {
    std::string id;
    std::string name;
    std::string description;
    Completion completes = Completion::acknowledged;
    std::vector<CommandArgument> arguments{};  ///< empty: it has no named arguments (perhaps one text)
};

struct ErrorCode {
    std::int32_t code = 0;
    std::string kind;  ///< "error", "alarm", "notification", ...
    std::string name;
    std::string text;
    std::string cause;
    std::string remedy;
    std::int32_t through = 0;  ///< of a range of codes: the last one; 0: `code` alone
};

class Catalogue {
public:
    /// Reads the JSON text. On failure: every fault found, each with its place ("parameters[3].type: ...").
    [[nodiscard]] static std::optional<Catalogue> parse(std::string_view json, std::vector<std::string>& faults);

    /// A copy with further parameters behind its own, so that the points of its own keep their numbers. On failure as parse().
    [[nodiscard]] std::optional<Catalogue> with(const boost::json::array& parameters, std::vector<std::string>& faults) const;

    [[nodiscard]] const std::string& family() const noexcept { return family_; }
    [[nodiscard]] std::uint16_t number() const noexcept { return number_; }
    [[nodiscard]] std::span<const Parameter> parameters() const noexcept { return parameters_; }
    [[nodiscard]] std::span<const CatalogueCommand> commands() const noexcept { return commands_; }
    [[nodiscard]] std::span<const ErrorCode> errors() const noexcept { return errors_; }
    /// In the page's order ("freedoms"); empty if it is absent.
    [[nodiscard]] std::span<const Freedom> freedoms() const noexcept { return freedoms_; }
    /// How many axes one drive can have: the page's "channels"; 1 if it is absent.
    [[nodiscard]] int most_channels() const noexcept;
    /// CiA 402 modes of operation that its drives offer, in the page's order ("modes"; 1, 3 and 6 if it is absent).
    [[nodiscard]] std::span<const std::int16_t> modes() const noexcept { return modes_; }
    [[nodiscard]] bool offers_mode(std::int16_t mode) const noexcept;
    /// The document itself, for doors that show more than the fields above.
    [[nodiscard]] const boost::json::object& document() const noexcept { return document_; }

    [[nodiscard]] const Parameter* parameter(Point point) const noexcept;
    /// By id or by name, with the element in brackets for arrays: "AC", "acceleration", "N[17]".
    [[nodiscard]] std::optional<Point> find(std::string_view id) const;
    /// The number by which registers name a point: the parameter's position, with the element of an array in the upper 16 bits. Empty for
    /// texts, bytes and unknown parameters, which registers cannot carry.
    [[nodiscard]] std::optional<std::uint32_t> selector(Point point) const noexcept;
    /// The id of a point, with its element for an array.
    [[nodiscard]] std::string id_of(Point point) const;
    /// A command by its id or name; nullptr: there is none.
    [[nodiscard]] const CatalogueCommand* command(std::string_view id_or_name) const noexcept;
    /// The first entry with this code, or a range that includes it (and this kind, if given), in the order of the document: entries for
    /// faults come before those for refusals of a command with the same number.
    [[nodiscard]] const ErrorCode* error(std::int32_t code, std::string_view kind = {}) const noexcept;

    /// The value in the parameter's own type, or the reason why it cannot be written, with the range ("AC: 0 is below 1; allowed
    /// 1..65000000 pulse/s^2"). This check uses min, max and allowed; `alternate` ranges are checked elsewhere.
    struct Checked {
        Value value;
        std::string fault;  ///< empty: good
    };
    [[nodiscard]] Checked check_write(Point point, const Value& value) const;

private:
    void add_parameter(const boost::json::value& entry, std::vector<std::string>& faults);

    std::string family_;
    std::uint16_t number_ = 0;
    std::vector<Parameter> parameters_;
    std::vector<CatalogueCommand> commands_;
    std::vector<ErrorCode> errors_;
    std::vector<Freedom> freedoms_;
    std::vector<std::int16_t> modes_{1, 3, 6};
    std::unordered_map<std::string, std::uint16_t> by_id_;
    boost::json::object document_;
};

/// "freedoms" of a page; each fault is appended with its place.
[[nodiscard]] std::vector<Freedom> read_freedoms(const boost::json::object& page, std::vector<std::string>& faults);

}  // namespace axisgate
