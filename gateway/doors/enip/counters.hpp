// Counters: the EtherNet/IP door's counters in the text format of Prometheus.
// In: the adapter's, the values' and the server's counters. Out: text. Any thread: what is read here are Counters alone.
#pragma once

#include <string>

#include "gateway/doors/enip/axis_values.hpp"
#include "gateway/protocols/cip/adapter.hpp"

namespace axisgate::enip {

/// `accepts_postponed`: how often a TCP connection had to wait for a descriptor.
[[nodiscard]] std::string metrics_text(const cip::Adapter& adapter, const AxisValues::Counters& values, const Counter& accepts_postponed);

}  // namespace axisgate::enip
