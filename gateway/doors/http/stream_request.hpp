// The request of a live-feed client, read from one text message: topics and a period, or a fault. The hub knows which topics exist.
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
    boost::json::object set_point{};  ///< as received; empty: none (see read_set_point)
    std::int64_t period_ms = 100;     ///< 10..10000, a multiple of 10 (rounded up), so that clients share their scans
};

inline constexpr std::size_t most_topics_per_request = 1100;

/// If empty, `fault` has the fault and the correct form.
[[nodiscard]] std::optional<StreamRequest> read_stream_request(std::string_view text, std::string& fault);

}  // namespace axisgate::http
