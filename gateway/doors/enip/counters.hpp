// The EtherNet/IP door's counters in the text format of Prometheus. Any thread, because only Counters are read.
#pragma once

#include <string>

#include "gateway/doors/enip/axis_values.hpp"
#include "gateway/protocols/cip/adapter.hpp"

namespace axisgate::enip {

/// `accepts_postponed` counts TCP connections that had to wait for a descriptor.
[[nodiscard]] std::string metrics_text(const cip::Adapter& adapter, const AxisValues::Counters& values, const Counter& accepts_postponed);

}  // namespace axisgate::enip
