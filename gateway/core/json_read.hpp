// JSON read: a text of somebody else's as a value, or the one thing that is wrong with it and where.
// In: text of any origin and size. Out: a value, or a fault with line and JSON pointer. Bounded: depth 32; memory a multiple of the text.
// Never takes an object with two members of one name: which of them counts would be a guess (RFC 8259 4: "names SHOULD be unique").
#pragma once

#include <boost/json/value.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate {

struct JsonFault {
    std::string text;      ///< what is wrong: "the member \"command\" stands twice", or the parser's words
    std::string pointer;   ///< JSON pointer to the second member; of a very deep or long one only the beginning; empty: not JSON at all
    std::size_t line = 1;  ///< 1-based, where it was noticed
    bool twice = false;    ///< it is JSON, but a member stands twice
};

/// The whole text as one value (blanks around it allowed). Names are compared as they are meant: "a" and "\u0061" are one.
[[nodiscard]] std::optional<boost::json::value> read_json(std::string_view text, JsonFault& fault);

}  // namespace axisgate
