// Counters: the EtherNet/IP door's counters in the text format of Prometheus.
// In: the adapter's and the values' counters. Out: text. Any thread: what is read here are Counters alone.
#pragma once

#include <string>

#include "gateway/doors/enip/axis_values.hpp"
#include "gateway/protocols/cip/adapter.hpp"

namespace axisgate::enip {

[[nodiscard]] std::string metrics_text(const cip::Adapter& adapter, const AxisValues::Counters& values);

}  // namespace axisgate::enip
