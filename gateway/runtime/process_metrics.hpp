// Process metrics: what the process itself uses, under the names that Prometheus' own clients give them.
// In: /proc/self and the kernel's account of it. Out: Prometheus text. Never waits for a disk; what cannot be read has no line.
#pragma once

#include <string>

namespace axisgate {

[[nodiscard]] std::string process_metrics();

}  // namespace axisgate
