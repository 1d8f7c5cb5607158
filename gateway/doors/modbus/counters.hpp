// The counters of the Modbus door since it was opened, counted by the hot thread and read by any thread. Each number is correct; two of
// them may belong to slightly different instants.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "gateway/core/counter.hpp"
#include "gateway/core/histogram.hpp"
#include "gateway/doors/modbus/wire.hpp"

namespace axisgate::modbus {

struct Counters {
    Counter requests;                    ///< whole ADUs accepted for an answer
    std::array<Counter, 16> exceptions;  ///< answers, by exception code (index 1..0x0B)

    Histogram request_times;  ///< from the request to its answer, including the drives

    Counter connections_open;  ///< gauge
    Counter connections_accepted;
    Counter connections_refused;      ///< the limit is reached and no connection may be closed
    Counter connections_not_allowed;  ///< closed at once: the peer is not in the allow list
    Counter connections_evicted;      ///< closed for a new one: the one that was idle longest
    Counter closed_by_operator;       ///< a person has closed it over another door
    Counter closed_idle;              ///< no request for the idle time-out
    Counter closed_not_modbus;        ///< bad protocol id or length
    Counter closed_partial;           ///< half a request, and then nothing for the partial time-out
    Counter closed_not_reading;       ///< the client did not read its answers
    Counter bytes_received;
    Counter bytes_sent;

    void count(Exception e) noexcept { exceptions[static_cast<std::size_t>(e) & 15u].add(); }
};

/// For /metrics.
[[nodiscard]] std::string metrics_text(const Counters& counters);

}  // namespace axisgate::modbus
