// The counters of the HTTP door, incremented by the router, the server and the live feed on the service thread. Labels are bounded: routes
// as in the description.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <tuple>

namespace axisgate::http {

struct Counters {
    /// By route, method and status; the words are those of the router's table and live as long as the program.
    std::map<std::tuple<std::string_view, std::string_view, unsigned>, std::uint64_t> requests;
    /// Time from the whole request to its answer, seconds; the last bucket is +Inf.
    static constexpr std::array<double, 7> bucket_limits{0.001, 0.005, 0.025, 0.1, 0.5, 2.5, 10.0};
    std::array<std::uint64_t, 8> buckets{};
    double duration_sum_s = 0;

    std::uint64_t connections_accepted = 0, connections_refused = 0, connections_timed_out = 0, connections_gave_way = 0;
    std::uint64_t malformed = 0;                                  ///< requests that were not HTTP, or exceeded a bound
    std::uint64_t tls_handshakes = 0, tls_handshakes_failed = 0;  ///< failed: including those that did not end in time
    std::uint64_t refusals_counted_only = 0;                      ///< without an event of their own
    std::uint64_t bytes_in = 0, bytes_out = 0;
    std::uint64_t connections = 0;     ///< open now, including live-feed clients
    std::uint64_t stream_clients = 0;  ///< open now
    std::uint64_t stream_frames_sent = 0;
    std::uint64_t stream_states_replaced = 0;  ///< a newer state replaced a waiting one
    std::uint64_t stream_requests_wrong = 0;
    std::map<std::uint16_t, std::uint64_t> stream_closed;  ///< by close code sent

    /// `route` and `method` must live as long as the program.
    void answered(std::string_view route, std::string_view method, unsigned status, double duration_s);
    [[nodiscard]] std::string text() const;
};

}  // namespace axisgate::http
