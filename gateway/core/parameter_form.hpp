// The meaning of a parameter's number: its bit fields, the meanings of ranges of values, and the unit and range that apply while another
// parameter has a certain value (members `fields`, `meanings` and `alternate` of the catalogue). The caller provides the known values of
// other parameters.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/core/catalogue.hpp"

namespace axisgate {

/// Bits of a whole number that have a meaning by themselves.
struct ParameterField {
    std::string name;  ///< snake_case
    unsigned low_bit = 0;
    unsigned bits = 1;
    std::vector<std::pair<std::int64_t, std::string>> allowed;  ///< the only values, with their meaning; empty: all that the bits can hold
    [[nodiscard]] std::int64_t of(std::int64_t whole) const noexcept { return (whole >> low_bit) & ((std::int64_t{1} << bits) - 1); }
};
/// The meaning of a range of values.
struct ParameterMeaning {
    std::int64_t from = 0;
    std::int64_t through = 0;
    std::string text;
};
/// Unit and range of a parameter while another one, `of`, has the value `equals`. The range lies within the parameter's own, which is
/// checked if the other's value is unknown. Without `of`: for written values, where reading gives more.
struct ParameterAlternate {
    std::optional<Point> of;
    std::int64_t equals = 0;
    std::string unit;
    double min = 0;
    double max = 0;
};
/// The unit and range that apply now.
struct ParameterForm {
    std::string unit;
    std::optional<double> min;
    std::optional<double> max;
};
/// The last known value of another parameter of the same axis; unknown if there is none.
using KnownValue = std::function<Value(Point)>;

/// The parameter's own object in the catalogue's document, for members that are shown unchanged; nullptr if the parameter does not exist.
[[nodiscard]] const boost::json::object* entry_of(const Catalogue& catalogue, Point point);
[[nodiscard]] std::vector<ParameterField> fields_of(const Catalogue& catalogue, Point point);
[[nodiscard]] std::vector<ParameterMeaning> meanings_of(const Catalogue& catalogue, Point point);
[[nodiscard]] std::optional<ParameterAlternate> alternate_of(const Catalogue& catalogue, Point point);
/// True if the alternate form applies now: to a value that is read, or (`writing`) to one that is written.
[[nodiscard]] bool in_force(const ParameterAlternate& alternate, const KnownValue& known_value, bool writing);
[[nodiscard]] ParameterForm form_now(const Catalogue& catalogue, Point point, const KnownValue& known_value);
/// The value in words ("falling_edge_action: origin, then stop; ..."); empty if the catalogue has none.
[[nodiscard]] std::string value_in_words(const Catalogue& catalogue, Point point, const Value& value);

/// As Catalogue::check_write, and the range that applies now ("AC: 70000 is outside 1..60000 ms, because IC[4] is 1").
[[nodiscard]] Catalogue::Checked check_write_now(const Catalogue& catalogue, Point point, const Value& value,
                                                 const KnownValue& known_value);
/// The first field of `value` with an illegal value, with the legal ones; empty: correct.
[[nodiscard]] std::string wrong_field(const Catalogue& catalogue, Point point, std::int64_t value);
/// The faults of the three members in a whole catalogue, each with its place.
void check_forms(const Catalogue& catalogue, std::vector<std::string>& faults);

}  // namespace axisgate
