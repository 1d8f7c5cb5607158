// Prometheus text, exposition format 0.0.4. No label contains text of a client.
#include "gateway/doors/http/counters.hpp"

#include <fmt/core.h>

namespace axisgate::http {

void Counters::answered(std::string_view route, std::string_view method, unsigned status, double duration_s) {
    ++requests[{route, method, status}];
    std::size_t i = 0;
    while (i < bucket_limits.size() && duration_s > bucket_limits[i])
        ++i;
    ++buckets[i];
    duration_sum_s += duration_s;
}

std::string Counters::text() const {
    std::string s;
    const auto head = [&s](std::string_view name, std::string_view type, std::string_view help) {
        s += fmt::format("# HELP axisgate_http_{} {}\n# TYPE axisgate_http_{} {}\n", name, help, name, type);
    };
    const auto plain = [&s, &head](std::string_view name, std::string_view type, std::string_view help, std::uint64_t value) {
        head(name, type, help);
        s += fmt::format("axisgate_http_{} {}\n", name, value);
    };
    head("requests_total", "counter", "Requests answered, by route, method and status.");
    for (const auto& [key, n] : requests) {
        const auto& [route, method, status] = key;
        s += fmt::format("axisgate_http_requests_total{{route=\"{}\",method=\"{}\",status=\"{}\"}} {}\n", route, method, status, n);
    }
    head("request_duration_seconds", "histogram", "Time from a whole request to its answer.");
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < buckets.size(); ++i) {
        sum += buckets[i];
        s += fmt::format("axisgate_http_request_duration_seconds_bucket{{le=\"{}\"}} {}\n",
                         i < bucket_limits.size() ? fmt::format("{}", bucket_limits[i]) : std::string("+Inf"), sum);
    }
    s += fmt::format("axisgate_http_request_duration_seconds_sum {}\naxisgate_http_request_duration_seconds_count {}\n", duration_sum_s,
                     sum);
    plain("connections", "gauge", "Open connections, live-feed clients included.", connections);
    plain("connections_accepted_total", "counter", "Connections accepted.", connections_accepted);
    plain("connections_refused_total", "counter", "Connections refused because too many were open.", connections_refused);
    plain("connections_gave_way_total", "counter", "Connections closed to make room for others.", connections_gave_way);
    plain("connections_timed_out_total", "counter", "Connections closed because a client was too slow or idle.", connections_timed_out);
    plain("malformed_total", "counter", "Requests that were not HTTP, or over a bound.", malformed);
    plain("refusals_counted_only_total", "counter", "Refusals (401, 403, 409) that have no event of their own: a rate bounds those.",
          refusals_counted_only);
    plain("tls_handshakes_total", "counter", "TLS handshakes that came to their end.", tls_handshakes);
    plain("tls_handshakes_failed_total", "counter", "TLS handshakes that failed or took too long.", tls_handshakes_failed);
    plain("received_bytes_total", "counter", "Bytes received.", bytes_in);
    plain("sent_bytes_total", "counter", "Bytes sent.", bytes_out);
    plain("stream_clients", "gauge", "Live-feed clients.", stream_clients);
    plain("stream_frames_sent_total", "counter", "Messages sent to live-feed clients.", stream_frames_sent);
    plain("stream_states_replaced_total", "counter", "States that were replaced by a newer one before a slow client took them.",
          stream_states_replaced);
    plain("stream_requests_wrong_total", "counter", "Live-feed requests answered with an error.", stream_requests_wrong);
    head("stream_closed_total", "counter", "Live-feed clients closed, by close code.");
    for (const auto& [code, n] : stream_closed)
        s += fmt::format("axisgate_http_stream_closed_total{{code=\"{}\"}} {}\n", code, n);
    return s;
}

}  // namespace axisgate::http
