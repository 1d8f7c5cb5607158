// Reads JSON of any origin and size as a value, or reports one fault with line and JSON pointer. Bounds: depth 32; memory a multiple of the
// text. An object with two members of one name is refused, because which of them counts would be a guess (RFC 8259 4: "names SHOULD be
// unique").
#pragma once

#include <boost/json/value.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/value.hpp"

namespace axisgate {

struct JsonFault {
    std::string text;      ///< the fault: "the member \"command\" stands twice", or the parser's words
    std::string pointer;   ///< JSON pointer to the second member; only the beginning of a very long one; empty: not JSON at all
    std::size_t line = 1;  ///< 1-based, where it was noticed
    bool twice = false;    ///< it is JSON, but a member occurs twice
};

/// The whole text as one value (blanks around it allowed). Names are compared after decoding: "a" and "\u0061" are equal.
[[nodiscard]] std::optional<boost::json::value> read_json(std::string_view text, JsonFault& fault);

/// A number, text, true or false of JSON as a value; unknown for null, arrays and objects. A whole number above 2^63 - 1 becomes a double.
[[nodiscard]] Value value_of_json(const boost::json::value& value);

}  // namespace axisgate
