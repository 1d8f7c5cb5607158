// Head: where the head of a request ends in a run of bytes, and whether its framing means one thing only.
// In: bytes; header fields. Out: how many bytes the head has, or what is wrong. Never reads a body.
// What two programs in a row could read in two ways is refused: between them a second request could be hidden.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/doors/http/message.hpp"

namespace axisgate::http {

struct HeadScan {
    enum class Verdict : std::uint8_t { incomplete, whole, too_large, malformed };
    Verdict verdict = Verdict::incomplete;
    std::size_t empty_lines = 0;  ///< bytes of empty lines in front of it, which are passed over (RFC 9112 2.2)
    std::size_t bytes = 0;        ///< whole: of the head, its last empty line included
};
/// `most`: bytes that a head may have, its last empty line included. More than two empty lines in front are no HTTP.
[[nodiscard]] HeadScan scan_head(std::string_view bytes, std::size_t most) noexcept;

struct FramingFault {
    unsigned status = 400;  ///< or 501
    std::string text;
};
/// Whether the length of the body is beyond doubt, and no field that may stand once stands twice. After such a fault the connection is
/// worthless: nobody knows where the next request begins.
[[nodiscard]] std::optional<FramingFault> framing_fault(const Headers& headers, bool http_1_0);

}  // namespace axisgate::http
