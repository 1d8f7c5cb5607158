// Numbers as EDS and DCF files contain them: those that CiA 306-1 allows, and the forms that makers' tools write besides.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/protocols/canopen/data_type.hpp"

namespace axisgate::canopen {

/// A number as in C: decimal, 0x hex or 0 octal, each with an optional sign. A comment (`;`) may follow it.
struct EdsNumber {
    bool negative = false;
    std::uint64_t size = 0;
    bool hex = false;
    bool unusual = false;  ///< read from a form that CiA 306-1 does not have; a reader tells it
};
/// Besides the standard's forms, as unusual ones: a suffix of C or a unit ("10UL", "100 ms"), hex digits with the suffix h ("1Fh"), a
/// decimal number without a fraction ("100.0"), a decimal number with leading zeros that is no octal one ("08"). Nothing for other text.
[[nodiscard]] std::optional<EdsNumber> eds_number(std::string_view text);

/// A whole number from 0 to `most`.
[[nodiscard]] std::optional<std::uint64_t> eds_whole(std::string_view text, std::uint64_t most);

/// A whole number of the type. Hex digits may be the bit pattern of a negative number: 0xFFFF is -1 for an INTEGER16.
[[nodiscard]] std::optional<std::int64_t> eds_whole_of(DataType type, const EdsNumber& number);

/// The text without the node number: "0x180" for "$NODEID+0x180", "0x180 + $nodeid" and "NODEID+0x180"; "0" for "$NODEID". Nothing if the
/// text does not depend on the node number.
[[nodiscard]] std::optional<std::string> without_node(std::string_view text);

/// The text before a comment (`;`), without blanks at its ends: for keys whose values are words or numbers.
[[nodiscard]] std::string_view without_comment(std::string_view text);

}  // namespace axisgate::canopen
