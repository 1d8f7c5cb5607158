// Fuzz target for line URIs. Laws: a URI or one sentence; a written URI is read as the same.
#include "gateway/core/line_uri.hpp"

#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto r = parse_line_uri(text);
    if (!r.good()) {
        fuzz::require(r.fault.find('\n') == std::string::npos || text.find('\n') != std::string_view::npos, "a fault is one line");
        return 0;
    }
    const std::string written = to_text(r.uri);
    const auto again = parse_line_uri(written);
    // The written form contains all options, so it may be longer than the limit for reading.
    fuzz::require(again.good() || written.size() > 1024, "what was written can be read");
    if (again.good()) fuzz::require(again.uri == r.uri, "what was written reads back the same");
    return 0;
}
