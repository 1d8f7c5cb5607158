// Stream request: what a live-feed client asks for, read from one text message.
// In: the text. Out: topics and a period, or why it is not a request.
// Never knows which topics exist: that is the hub's.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::http {

struct StreamRequest {
    std::vector<std::string> subscribe, unsubscribe;
    boost::json::object set_point{};  ///< as it was written; empty: none (see read_set_point)
    std::int64_t period_ms = 100;     ///< 10..10000, a multiple of 10 (rounded up), so that clients share their scans
};

inline constexpr std::size_t most_topics_per_request = 1100;

/// On nothing: `fault` says what is wrong and what to write.
[[nodiscard]] std::optional<StreamRequest> read_stream_request(std::string_view text, std::string& fault);

}  // namespace axisgate::http
