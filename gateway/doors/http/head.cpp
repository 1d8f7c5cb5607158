// Examines each byte of a complete head once, and an incomplete one only for its end. Folded lines and bare line ends are refused.
#include "gateway/doors/http/head.hpp"

#include <fmt/core.h>

#include <array>

#include "gateway/doors/http/text.hpp"

namespace axisgate::http {
namespace {
constexpr std::size_t most_empty_bytes = 4;  // two empty lines

/// Fields of which a request has at most one (RFC 9110 5.3), because it would be unclear which one counts.
constexpr std::array<std::string_view, 13> single{
    "host",     "content-length", "transfer-encoding", "content-type",      "authorization",         "origin",        "x-csrf-token",
    "x-client", "expect",         "upgrade",           "sec-websocket-key", "sec-websocket-version", "sec-fetch-site"};

/// A line that continues on the next one (obs-fold), a line end that is not CR LF, or a NUL.
bool has_odd_lines(std::string_view head) noexcept {
    for (std::size_t i = 0; i < head.size(); ++i) {
        const char c = head[i];
        if (c == '\0') return true;
        if (c == '\n' && (i == 0 || head[i - 1] != '\r')) return true;
        if (c != '\r') continue;
        if (i + 1 >= head.size() || head[i + 1] != '\n') return true;
        if (i + 2 < head.size() && (head[i + 2] == ' ' || head[i + 2] == '\t')) return true;
    }
    return false;
}

bool begins_a_request(char c) noexcept {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
           std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}
}  // namespace

HeadScan scan_head(std::string_view bytes, std::size_t most) noexcept {
    HeadScan scan;
    while (bytes.substr(scan.empty_lines).starts_with("\r\n"))
        scan.empty_lines += 2;
    if (scan.empty_lines > most_empty_bytes) {
        scan.verdict = HeadScan::Verdict::malformed;
        return scan;
    }
    bytes.remove_prefix(scan.empty_lines);
    if (bytes.empty() || bytes == "\r") return scan;
    if (!begins_a_request(bytes.front())) {  // these bytes cannot be a request, so their end is not awaited
        scan.verdict = HeadScan::Verdict::malformed;
        return scan;
    }
    const auto end = bytes.substr(0, most).find("\r\n\r\n");
    if (end == std::string_view::npos) {
        if (bytes.size() >= most) scan.verdict = HeadScan::Verdict::too_large;
        return scan;
    }
    scan.bytes = end + 4;
    scan.verdict = has_odd_lines(bytes.substr(0, scan.bytes)) ? HeadScan::Verdict::malformed : HeadScan::Verdict::whole;
    return scan;
}

std::optional<FramingFault> framing_fault(const Headers& headers, bool http_1_0) {
    for (const auto name : single) {
        if (headers.count(name) > 1) return FramingFault{400, fmt::format("the header {} stands twice", name)};
    }
    if (headers.count("Transfer-Encoding") == 0) return std::nullopt;
    if (http_1_0) return FramingFault{400, "HTTP/1.0 has no Transfer-Encoding"};
    if (headers.count("Content-Length") != 0)
        return FramingFault{400, "Transfer-Encoding and Content-Length are both there: send one of them"};
    const auto coding = headers.get("Transfer-Encoding");
    if (lower(coding) == "chunked") return std::nullopt;
    return FramingFault{
        501, fmt::format("Transfer-Encoding: {} is not served: send the body as it is, with Content-Length, or chunked", coding)};
}

}  // namespace axisgate::http
