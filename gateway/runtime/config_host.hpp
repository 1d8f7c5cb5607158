// Checks the configuration against this host: a log file that cannot be opened, a processor that does not exist. There are faults, and
// warnings that `serve` tolerates; `serve` and `axisgate check` report the same. No file is left behind.
#pragma once

#include <cstdint>
#include <vector>

#include "gateway/runtime/config.hpp"

namespace axisgate {

[[nodiscard]] std::vector<ConfigFault> check_host(const Config& config);
/// Faults of the files that the settings of doors name, such as certificates.
[[nodiscard]] std::vector<ConfigFault> check_door_files(const Config& config, std::int64_t now_unix_s);

}  // namespace axisgate
