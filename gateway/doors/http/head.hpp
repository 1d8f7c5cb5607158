// Finds the end of a request's head, and checks that its framing is unambiguous: a head that two programs in sequence could read
// differently is refused, because a second request could be hidden between them. Bodies are not read.
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
    std::size_t empty_lines = 0;  ///< bytes of empty lines before it, which are skipped (RFC 9112 2.2)
    std::size_t bytes = 0;        ///< if complete: length of the head, including its last empty line
};
/// `most` is the limit of a head, including its last empty line. More than two empty lines before it are refused.
[[nodiscard]] HeadScan scan_head(std::string_view bytes, std::size_t most) noexcept;

struct FramingFault {
    unsigned status = 400;  ///< or 501
    std::string text;
};
/// Checks that the length of the body is unambiguous, and that no field that may occur once occurs twice. After such a fault the connection
/// cannot be used, because the begin of the next request is unknown.
[[nodiscard]] std::optional<FramingFault> framing_fault(const Headers& headers, bool http_1_0);

}  // namespace axisgate::http
