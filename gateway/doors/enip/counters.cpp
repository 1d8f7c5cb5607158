// One line for each question of an installer: refused clients, dropped data, time-outs.
#include "gateway/doors/enip/counters.hpp"

#include <fmt/core.h>

namespace axisgate::enip {

std::string metrics_text(const cip::Adapter& adapter, const AxisValues::Counters& v, const Counter& accepts_postponed) {
    std::string s;
    const auto put = [&](std::string_view name, std::string_view help, const Counter& value) {
        s += fmt::format("# HELP axisgate_enip_{0} {1}\n# TYPE axisgate_enip_{0} counter\naxisgate_enip_{0} {2}\n", name, help,
                         value.value());
    };
    const auto& a = adapter.counters();
    const auto& c = adapter.connections().counters();
    put("requests_total", "Packets of sessions and of the explicit UDP port.", a.requests);
    put("wrong_packets_total", "Packets that were none, or had a wrong header.", a.wrong_packets);
    put("sessions_total", "TCP connections accepted.", a.sessions_opened);
    put("sessions_refused_total", "TCP connections refused at the limit.", a.sessions_refused);
    put("sessions_evicted_total", "TCP connections closed to make room.", a.sessions_evicted);
    put("sessions_silent_total", "TCP connections closed for their silence.", a.sessions_silent);
    put("accepts_postponed_total", "Times that a TCP connection had to wait because the process had no descriptor left.",
        accepts_postponed);
    put("connection_opens_total", "Forward_Open requests.", c.opened);
    put("connection_opens_refused_total", "Forward_Open requests refused for what they ask.", c.open_other);
    put("connection_opens_without_place_total", "Forward_Open requests refused at the limit.", c.open_resource);
    put("connection_opens_malformed_total", "Forward_Open requests that could not be read.", c.open_format);
    put("connection_closes_total", "Forward_Close requests carried out.", c.closed);
    put("connection_timeouts_total", "Connections whose originator was silent.", c.timed_out);
    put("connections_evicted_total", "Connections closed to make room for those of others.", c.evicted);
    put("implicit_received_total", "Implicit datagrams taken.", c.received);
    put("implicit_sent_total", "Implicit datagrams sent.", c.sent);
    put("implicit_from_wrong_address_total", "Implicit datagrams dropped: not from the originator.", c.from_wrong_address);
    put("implicit_stale_total", "Implicit datagrams dropped: older than the newest.", c.stale);
    put("implicit_wrong_size_total", "Implicit datagrams dropped: not as long as the assembly.", c.wrong_size);
    put("implicit_unknown_total", "Implicit datagrams dropped: of no open connection.", c.unknown_connection);
    put("commands_total", "Commands made of outputs.", v.commands);
    put("set_points_total", "Streamed set-points handed on.", v.set_points);
    put("set_points_refused_total", "Streamed set-points that were refused.", v.set_points_refused);
    put("parameters_total", "Parameters read or written.", v.parameters);
    return s;
}

}  // namespace axisgate::enip
