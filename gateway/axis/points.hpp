// Every value that the gateway shows of an axis, in one table: its type, how it is read from a picture, and the doors that show it. The
// HTTP document, the comparison of pictures in the live feed, the DDS sample, the recorder, user maps, metrics and recipes walk this table,
// so a new row appears in each of them. Formats that are fixed elsewhere (standard map, IDL, files of the recorder) are compared with the
// table by tests. Texts of a value belong to the picture and live as long as it does.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "gateway/axis/cia402.hpp"
#include "gateway/axis/image.hpp"
#include "gateway/core/value.hpp"
#include "gateway/site/axis_points.hpp"
#include "gateway/site/fail_safe.hpp"

namespace axisgate {

/// "none", "profile_position", "profile_velocity", "homing", "other".
[[nodiscard]] std::string_view mode_name(std::int16_t mode) noexcept;
[[nodiscard]] std::string_view name_of(Presence presence) noexcept;

/// monostate: unknown. Whole numbers of every width are int64 here.
using PointValue = std::variant<std::monostate, bool, std::int64_t, double, std::string_view>;

/// The unit of a value. `axis` and `axis_per_s`: the axis' own unit; such a value is read in increments.
enum class PointUnit : std::uint8_t { none, increments, increments_per_s, increments_per_s2, axis, axis_per_s, ms, s };
[[nodiscard]] constexpr bool is_axis_unit(PointUnit unit) noexcept { return unit == PointUnit::axis || unit == PointUnit::axis_per_s; }
/// For example "mm" and "mm/s" for values in the axis' unit, "increments" for others; empty: no unit.
[[nodiscard]] std::string text_of(PointUnit unit, std::string_view axis_unit);

/// `composed`: the document combines it from more than this value (a catalogue's text, the time of day, an object of several values).
enum class PointInDocument : std::uint8_t { no, value, composed };
/// When a condition of a recipe may use the value: while the drive answers with data that are not too old, or always.
enum class PointInRecipe : std::uint8_t { no, while_answering, always };

/// A place in a list that has an order and names of its own; 0: not in the list.
struct PointPlace {
    std::uint8_t place = 0;
    std::string_view name{}, text{};
};

struct AxisPointRow {
    /// Unique among all rows. In the axis' document and in recipes it is the name of the value.
    std::string_view name;

    // the value
    std::uint16_t flag = 0;                                  ///< the bit of AxisPicture::flags that is the value; 0: none
    PointValue (*read)(const AxisPicture&) = nullptr;        ///< null: the value is the flag, or is not in the picture
    std::string_view (*word)(const AxisPicture&) = nullptr;  ///< the value as a word for people; null: they read the number
    bool (*known)(const AxisPicture&) = nullptr;             ///< if false, the value is null for people and has no line in metrics; null:
                                                             ///< always known
    PointUnit unit = PointUnit::none;

    // the doors that show it
    PointInDocument document = PointInDocument::no;  ///< HTTP and the live feed, in the order of the table
    PointInRecipe recipe = PointInRecipe::no;
    std::optional<AxisPoint> map{};  ///< its word in user maps
    std::string_view sample{};       ///< member of the DDS sample AxisState
    PointPlace metric{};             ///< axisgate_axis_<name>, with its help text
    PointPlace channel{};            ///< the recorder's name for it: trends, captures and their level triggers
    bool trigger = false;            ///< a flag whose change may trigger a capture
};

namespace point_readers {
template <auto member>
constexpr PointValue number(const AxisPicture& p) {
    return static_cast<std::int64_t>(p.*member);
}
template <auto member>
constexpr PointValue truth(const AxisPicture& p) {
    return p.*member;
}
template <auto member>
constexpr PointValue text(const AxisPicture& p) {
    return std::string_view((p.*member).data());
}
constexpr bool seen(const AxisPicture& p) { return p.ever_seen; }
constexpr bool demanded(const AxisPicture& p) { return p.ever_seen && p.demand_source != DemandSource::none; }
constexpr bool error_known(const AxisPicture& p) { return p.ever_seen && p.following_error_known(); }
constexpr PointValue following_error(const AxisPicture& p) { return p.following_error(); }

using A = AxisPicture;
using P = AxisPoint;
using U = PointUnit;
inline constexpr auto value = PointInDocument::value, composed = PointInDocument::composed;
inline constexpr auto while_answering = PointInRecipe::while_answering, always = PointInRecipe::always;

// A new value needs a member of AxisPicture, a row here, and, if user maps offer it, its word in gateway/site/axis_points.hpp.
inline constexpr auto table = std::to_array<AxisPointRow>({
    // the axis' document, in its order
    {.name = "line", .document = composed},
    {.name = "family", .document = composed},
    {.name = "online",
     .flag = flag_online,
     .document = value,
     .recipe = always,
     .map = P::online,
     .sample = "online",
     .metric = {6, "online", "1: the drive or its twin answers."},
     .trigger = true},
    {.name = "simulated",
     .flag = flag_simulated,
     .document = value,
     .recipe = always,
     .map = P::simulated,
     .sample = "simulated",
     .metric = {7, "simulated", "1: the embedded twin serves the axis."}},
    {.name = "stale",
     .flag = flag_stale,
     .document = value,
     .recipe = always,
     .map = P::stale,
     .sample = "stale",
     .metric = {8, "stale", "1: what is shown is too old to be trusted."}},
    {.name = "presence",
     .read = number<&A::presence>,
     .word = [](const A& p) { return name_of(p.presence); },
     .document = value,
     .recipe = always},
    {.name = "state",
     .read = [](const A& p) -> PointValue { return static_cast<std::int64_t>(power_state_of(p.statusword)); },
     .word = [](const A& p) { return name_of(power_state_of(p.statusword)); },
     .document = value,
     .recipe = while_answering,
     .metric = {5, "state", "1: the CiA 402 state that the axis is in."},
     .channel = {5, "state"}},
    {.name = "statusword",
     .read = number<&A::statusword>,
     .document = value,
     .recipe = while_answering,
     .map = P::statusword,
     .sample = "statusword"},
    {.name = "controlword", .read = number<&A::controlword>, .document = value, .recipe = while_answering, .map = P::controlword},
    {.name = "mode",
     .read = number<&A::mode_display>,
     .word = [](const A& p) { return mode_name(p.mode_display); },
     .document = value,
     .recipe = while_answering},
    {.name = "mode_number",
     .read = number<&A::mode_display>,
     .document = value,
     .recipe = while_answering,
     .map = P::mode_display,
     .sample = "mode"},
    {.name = "modes", .document = composed},
    {.name = "set_points", .document = composed},
    {.name = "moving",
     .flag = flag_moving,
     .document = value,
     .recipe = while_answering,
     .map = P::moving,
     .sample = "moving",
     .metric = {9, "moving", "1: the axis moves."},
     .trigger = true},
    {.name = "target_reached",
     .flag = flag_target_reached,
     .document = value,
     .recipe = while_answering,
     .map = P::target_reached,
     .sample = "target_reached",
     .trigger = true},
    {.name = "referenced",
     .flag = flag_referenced,
     .document = value,
     .recipe = while_answering,
     .map = P::referenced,
     .sample = "referenced",
     .metric = {10, "referenced", "1: the position has a known zero."},
     .trigger = true},
    {.name = "fault",
     .flag = flag_fault,
     .document = value,
     .recipe = while_answering,
     .map = P::fault,
     .sample = "fault",
     .metric = {11, "fault", "1: the axis is in fault."},
     .trigger = true},
    {.name = "warning",
     .flag = flag_warning,
     .document = value,
     .recipe = while_answering,
     .map = P::warning,
     .sample = "warning",
     .trigger = true},
    {.name = "internal_limit",
     .read = [](const A& p) -> PointValue { return (p.statusword & cia402::sw_internal_limit) != 0; },
     .document = value,
     .recipe = while_answering},
    {.name = "fail_safe_cause",
     .read = number<&A::fail_safe_cause>,
     .word = [](const A& p) { return name_of(static_cast<LossCause>(p.fail_safe_cause)); },
     .known = [](const A& p) { return p.fail_safe_cause != 0; },
     .document = value,
     .recipe = while_answering,
     .sample = "fail_safe_cause"},
    {.name = "stop_latch", .read = number<&A::stop_latch>, .document = value, .recipe = while_answering},
    {.name = "stop_latch_by",
     .read = text<&A::stop_latch_by>,
     .known = [](const A& p) { return p.stop_latch_by[0] != 0; },
     .document = value},
    {.name = "stop_latch_text", .document = composed},
    {.name = "position",
     .read = number<&A::position>,
     .known = seen,
     .unit = U::axis,
     .document = value,
     .recipe = while_answering,
     .map = P::position_units,
     .metric = {1, "position", "Actual position in the axis' unit."}},
    {.name = "demand_known",
     .read = [](const A& p) -> PointValue { return p.demand_source != DemandSource::none; },
     .document = value,
     .recipe = while_answering},
    {.name = "demand_source",
     .read = number<&A::demand_source>,
     .word = [](const A& p) { return name_of(p.demand_source); },
     .known = [](const A& p) { return p.demand_source != DemandSource::none; },
     .document = value,
     .recipe = while_answering,
     .sample = "demand_source"},
    {.name = "position_demand",
     .read = number<&A::position_demand>,
     .known = demanded,
     .unit = U::axis,
     .document = value,
     .recipe = while_answering},
    {.name = "following_error",
     .read = following_error,
     .known = error_known,
     .unit = U::axis,
     .document = value,
     .recipe = while_answering,
     .metric = {3, "following_error", "Demanded less actual position in the axis' unit."}},
    {.name = "velocity",
     .read = number<&A::velocity>,
     .known = seen,
     .unit = U::axis_per_s,
     .document = value,
     .recipe = while_answering,
     .map = P::velocity_units,
     .metric = {2, "velocity", "Actual velocity in the axis' unit per second."}},
    {.name = "target_position",
     .read = number<&A::target_position>,
     .known = seen,
     .unit = U::axis,
     .document = value,
     .recipe = while_answering},
    {.name = "target_velocity",
     .read = number<&A::target_velocity>,
     .known = seen,
     .unit = U::axis_per_s,
     .document = value,
     .recipe = while_answering},
    {.name = "position_increments",
     .read = number<&A::position>,
     .known = seen,
     .unit = U::increments,
     .document = value,
     .recipe = while_answering,
     .map = P::position,
     .sample = "position",
     .channel = {1, "position"}},
    {.name = "position_demand_increments",
     .read = number<&A::position_demand>,
     .known = demanded,
     .unit = U::increments,
     .document = value,
     .recipe = while_answering,
     .map = P::position_demand,
     .sample = "position_demand",
     .channel = {3, "demand"}},
    {.name = "following_error_increments",
     .read = following_error,
     .known = error_known,
     .unit = U::increments,
     .document = value,
     .recipe = while_answering,
     .map = P::following_error,
     .channel = {4, "following_error"}},
    {.name = "velocity_increments",
     .read = number<&A::velocity>,
     .known = seen,
     .unit = U::increments_per_s,
     .document = value,
     .recipe = while_answering,
     .map = P::velocity,
     .sample = "velocity",
     .channel = {2, "velocity"}},
    {.name = "target_position_increments",
     .read = number<&A::target_position>,
     .known = seen,
     .unit = U::increments,
     .document = value,
     .recipe = while_answering,
     .map = P::target_position},
    {.name = "error", .document = composed},
    {.name = "native", .read = number<&A::native_status>, .document = value, .recipe = while_answering, .map = P::native_status},
    {.name = "authority",
     .read = number<&A::authority>,
     .word = [](const A& p) { return name_of(p.authority); },
     .document = value,
     .recipe = while_answering,
     .map = P::authority,
     .sample = "authority"},
    {.name = "authority_holder", .read = text<&A::authority_holder>, .document = value, .sample = "authority_holder"},
    {.name = "authority_until", .read = [](const A& p) -> PointValue { return ns_of(p.authority_until); }, .document = composed},
    {.name = "setpoints_accepted",
     .read = number<&A::setpoints_accepted>,
     .document = value,
     .recipe = while_answering,
     .map = P::setpoints_accepted},
    {.name = "at", .document = composed},
    {.name = "age_ms",
     .unit = U::ms,
     .document = composed,
     .recipe = while_answering,
     .map = P::age_ms,
     .metric = {4, "age_seconds", "Time since the drive said what is shown."}},

    // members of objects in the document, and of the axis' place in the site
    {.name = "error_code", .read = number<&A::error_code>, .recipe = while_answering, .map = P::error_code, .sample = "error_code"},
    {.name = "number", .read = number<&A::number>, .recipe = always, .sample = "number"},
    {.name = "streaming", .read = truth<&A::streaming>, .sample = "streaming"},
    {.name = "stream_mode",
     .read = number<&A::stream_mode>,
     .word = [](const A& p) { return name_of(p.stream_mode); },
     .known = [](const A& p) { return p.streaming; }},
    {.name = "set_points_taken", .read = number<&A::set_points>, .sample = "set_points"},
    {.name = "set_points_refused", .read = number<&A::set_points_refused>, .sample = "set_points_refused"},
    {.name = "set_point_refusal",
     .read = number<&A::set_point_refusal>,
     .word = [](const A& p) { return name_of(p.set_point_refusal); },
     .sample = "set_point_refusal"},

    // values of registers only
    {.name = "flags", .read = number<&A::flags>, .map = P::flags},
    {.name = "fail_safe", .flag = flag_fail_safe, .trigger = true},
    {.name = "modes_of_operation", .read = number<&A::mode>, .map = P::mode},
    {.name = "profile_velocity", .read = number<&A::profile_velocity>, .unit = U::increments_per_s, .map = P::profile_velocity},
    {.name = "profile_acceleration",
     .read = number<&A::profile_acceleration>,
     .unit = U::increments_per_s2,
     .map = P::profile_acceleration},
    {.name = "profile_deceleration",
     .read = number<&A::profile_deceleration>,
     .unit = U::increments_per_s2,
     .map = P::profile_deceleration},
    {.name = "target_velocity_increments", .read = number<&A::target_velocity>, .unit = U::increments_per_s, .map = P::target_velocity},
    {.name = "homing_method", .read = number<&A::homing_method>, .map = P::homing_method},
    {.name = "family_number", .read = number<&A::family_number>, .map = P::family},
    {.name = "heartbeat", .unit = U::s, .map = P::heartbeat},
    {.name = "mapping_revision", .map = P::mapping_revision},
});
}  // namespace point_readers

inline constexpr const auto& axis_point_table = point_readers::table;
using AxisPointRows = std::span<const AxisPointRow>;

// --- reading --------------------------------------------------------------------------------------------------------

/// The value for registers, samples and metrics, known or not: a word by its number, in the axis' unit if the row says so.
[[nodiscard]] constexpr PointValue measured(const AxisPointRow& row, const AxisPicture& p, double increments_per_unit) {
    if (row.flag != 0) return (p.flags & row.flag) != 0;
    if (!row.read) return {};
    PointValue v = row.read(p);
    if (!is_axis_unit(row.unit)) return v;
    const auto* n = std::get_if<std::int64_t>(&v);
    return n ? PointValue(static_cast<double>(*n) / increments_per_unit) : v;
}
[[nodiscard]] constexpr bool known(const AxisPointRow& row, const AxisPicture& p) { return !row.known || row.known(p); }
/// The value for people: empty while it is unknown, a word if it has one.
[[nodiscard]] inline PointValue said(const AxisPointRow& row, const AxisPicture& p, double increments_per_unit) {
    if (!known(row, p)) return {};
    return row.word ? PointValue(row.word(p)) : measured(row, p, increments_per_unit);
}

// --- lookup ---------------------------------------------------------------------------------------------------------

/// Null if there is none.
[[nodiscard]] constexpr const AxisPointRow* point_named(std::string_view name, AxisPointRows rows = axis_point_table) noexcept {
    for (const auto& row : rows)
        if (row.name == name) return &row;
    return nullptr;
}
/// The row of a word of user maps.
[[nodiscard]] constexpr const AxisPointRow* row_of(AxisPoint point, AxisPointRows rows = axis_point_table) noexcept {
    for (const auto& row : rows)
        if (row.map == point) return &row;
    return nullptr;
}
static_assert(
    [] {
        for (const AxisPointInfo& i : axis_point_list)
            if (!row_of(i.point)) return false;
        return true;
    }(),
    "a word of user maps stands for a row of the table");

/// Members of the axis' document that describe its state: requests may contain them, and they are ignored there.
[[nodiscard]] constexpr bool is_document_member(std::string_view name, AxisPointRows rows = axis_point_table) noexcept {
    const auto* row = point_named(name, rows);
    return row && row->document != PointInDocument::no;
}
/// The points that a condition of a recipe can use, in the order of the table.
[[nodiscard]] std::vector<std::string_view> recipe_points(AxisPointRows rows = axis_point_table);
/// The rows of a list with an order of its own, in that order.
[[nodiscard]] std::vector<const AxisPointRow*> in_order(PointPlace AxisPointRow::*list, AxisPointRows rows = axis_point_table);

// --- comparison -----------------------------------------------------------------------------------------------------

/// True if all values of the table are equal, except for those that are not in the picture: the age, and the instant of the data.
template <const auto& rows>
[[nodiscard]] bool same_values(const AxisPicture& a, const AxisPicture& b) noexcept {
    const auto same = [&a, &b](const AxisPointRow& row) {
        return known(row, a) == known(row, b) && measured(row, a, 1) == measured(row, b, 1);
    };
    // The loop is unrolled, so that each reader is called directly and not through its pointer: pictures are compared at every turn of the
    // feed.
    return [&]<std::size_t... i>(std::index_sequence<i...>) { return (same(rows[i]) && ...); }
    (std::make_index_sequence<rows.size()>());
}
[[nodiscard]] bool same_but_time(const AxisPicture& a, const AxisPicture& b) noexcept;

}  // namespace axisgate
