// Counters: what the Modbus door has done since it was opened, for /metrics.
// In: counted by the hot thread alone. Out: read by any thread at any time; every number by itself is right, two of them may be a moment
// apart. Never goes back.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "gateway/core/counter.hpp"
#include "gateway/core/histogram.hpp"
#include "gateway/doors/modbus/wire.hpp"

namespace axisgate::modbus {

struct Counters {
    Counter requests;                    ///< whole ADUs taken for an answer
    std::array<Counter, 16> exceptions;  ///< answers, by exception code (index 1..0x0B)

    Histogram request_times;  ///< from the request to its answer, drives included

    Counter connections_open;  ///< gauge
    Counter connections_accepted;
    Counter connections_refused;      ///< the limit is reached and no connection is idle
    Counter connections_not_allowed;  ///< closed at once: the peer is not on the allow list
    Counter connections_evicted;      ///< closed, the longest idle one, to make room
    Counter closed_by_operator;       ///< a person has closed it by another door
    Counter closed_idle;              ///< no request for the idle time-out
    Counter closed_not_modbus;        ///< bad protocol id or length
    Counter closed_partial;           ///< half a request, and then nothing for the partial time-out
    Counter closed_not_reading;       ///< the client did not take its answers
    Counter bytes_received;
    Counter bytes_sent;

    void count(Exception e) noexcept { exceptions[static_cast<std::size_t>(e) & 15u].add(); }
};

/// For /metrics.
[[nodiscard]] std::string metrics_text(const Counters& counters);

}  // namespace axisgate::modbus
