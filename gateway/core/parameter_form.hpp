// Parameter forms: what a parameter's number means: its bit fields, the meaning of ranges of values, and the unit and range that hold while
// another parameter has a certain value. In: the catalogue's members `fields`, `meanings` and `alternate`, values. Out: words, checks with
// the legal values in the message, the form in force. Never keeps a value: who calls says what is known of other parameters.
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

/// Some bits of a whole number that mean something by themselves.
struct ParameterField {
    std::string name;  ///< snake_case
    unsigned low_bit = 0;
    unsigned bits = 1;
    std::vector<std::pair<std::int64_t, std::string>> allowed;  ///< the only values, with their meaning; empty: all that the bits hold
    [[nodiscard]] std::int64_t of(std::int64_t whole) const noexcept { return (whole >> low_bit) & ((std::int64_t{1} << bits) - 1); }
};
/// What a range of values means.
struct ParameterMeaning {
    std::int64_t from = 0;
    std::int64_t through = 0;
    std::string text;
};
/// Unit and range of a parameter while another one, `of`, has the value `equals`. The range lies within the parameter's own, which is what
/// is checked where nobody knows the other's value. Without `of`: of what is written, where reading gives more.
struct ParameterAlternate {
    std::optional<Point> of;
    std::int64_t equals = 0;
    std::string unit;
    double min = 0;
    double max = 0;
};
/// Unit and range as they are now.
struct ParameterForm {
    std::string unit;
    std::optional<double> min;
    std::optional<double> max;
};
/// The last known value of another parameter of the same axis; unknown if there is none.
using KnownValue = std::function<Value(Point)>;

/// The parameter's own object in the catalogue's document, for members that are shown as they are; nullptr: there is no such parameter.
[[nodiscard]] const boost::json::object* entry_of(const Catalogue& catalogue, Point point);
[[nodiscard]] std::vector<ParameterField> fields_of(const Catalogue& catalogue, Point point);
[[nodiscard]] std::vector<ParameterMeaning> meanings_of(const Catalogue& catalogue, Point point);
[[nodiscard]] std::optional<ParameterAlternate> alternate_of(const Catalogue& catalogue, Point point);
/// Whether the alternate form holds now: for a value that is read, or (`writing`) for one that is written.
[[nodiscard]] bool in_force(const ParameterAlternate& alternate, const KnownValue& known_value, bool writing);
[[nodiscard]] ParameterForm form_now(const Catalogue& catalogue, Point point, const KnownValue& known_value);
/// The value in words ("falling_edge_action: origin, then stop; ..."); empty where the catalogue has none.
[[nodiscard]] std::string value_in_words(const Catalogue& catalogue, Point point, const Value& value);

/// As Catalogue::check_write, and the range in force ("AC: 70000 is outside 1..60000 ms, because IC[4] is 1").
[[nodiscard]] Catalogue::Checked check_write_now(const Catalogue& catalogue, Point point, const Value& value,
                                                 const KnownValue& known_value);
/// The first field of `value` that has no legal value, with the legal ones; empty: good.
[[nodiscard]] std::string wrong_field(const Catalogue& catalogue, Point point, std::int64_t value);
/// What is wrong with the three members in a whole catalogue, each with its place.
void check_forms(const Catalogue& catalogue, std::vector<std::string>& faults);

}  // namespace axisgate
