// Configuration against this host: what the text of the configuration does not show: a log file that cannot be opened, a processor that is
// not there. In: a Config. Out: faults, and warnings for what `serve` goes on without. Leaves no file behind.
// Never starts anything: `serve` and `axisgate check` say the same by it.
#pragma once

#include <vector>

#include "gateway/runtime/config.hpp"

namespace axisgate {

[[nodiscard]] std::vector<ConfigFault> check_host(const Config& config);

}  // namespace axisgate
