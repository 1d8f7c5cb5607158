// The resources of the process, under the names that Prometheus' own clients use. A value that cannot be read has no line.
#pragma once

#include <string>

namespace axisgate {

[[nodiscard]] std::string process_metrics();

}  // namespace axisgate
