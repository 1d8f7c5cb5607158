// The door's counters in the text format of Prometheus.
#include "gateway/doors/modbus/counters.hpp"

#include <fmt/core.h>

namespace axisgate::modbus {

std::string metrics_text(const Counters& c) {
    std::string s;
    const auto put = [&](std::string_view name, std::string_view type, std::string_view help, std::uint64_t value) {
        s += fmt::format("# HELP axisgate_modbus_{0} {1}\n# TYPE axisgate_modbus_{0} {2}\naxisgate_modbus_{0} {3}\n", name, help, type,
                         value);
    };
    put("requests_total", "counter", "Requests taken for an answer.", c.requests.value());
    put("connections", "gauge", "Connections open now.", c.connections_open.value());
    put("connections_accepted_total", "counter", "Connections accepted.", c.connections_accepted.value());
    put("connections_refused_total", "counter", "Connections refused at the limit.", c.connections_refused.value());
    put("connections_not_allowed_total", "counter", "Connections closed at once: not on the allow list.",
        c.connections_not_allowed.value());
    put("connections_evicted_total", "counter", "Idle connections closed to make room.", c.connections_evicted.value());
    put("closed_not_modbus_total", "counter", "Connections closed for bytes that were not Modbus.", c.closed_not_modbus.value());
    put("received_bytes_total", "counter", "Bytes received.", c.bytes_received.value());
    put("sent_bytes_total", "counter", "Bytes sent.", c.bytes_sent.value());
    s += "# HELP axisgate_modbus_exceptions_total Exception answers by code.\n# TYPE axisgate_modbus_exceptions_total counter\n";
    for (const int code : {1, 2, 3, 4, 6, 10, 11}) {
        s +=
            fmt::format("axisgate_modbus_exceptions_total{{code=\"{}\"}} {}\n", code, c.exceptions[static_cast<std::size_t>(code)].value());
    }
    s += metric_head("axisgate_modbus_request_duration_seconds", "histogram", "From a request to its answer, drives included.");
    s += metric_lines("axisgate_modbus_request_duration_seconds", c.request_times.read());
    return s;
}

}  // namespace axisgate::modbus
