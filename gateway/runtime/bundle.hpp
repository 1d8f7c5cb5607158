// The data for remote support as one tar: configuration, database, and the gateway's own pages if it runs. It never contains users, tokens,
// sessions, certificates or keys, and every text passes scrub().
#pragma once

#include <string>

#include "gateway/runtime/config.hpp"

namespace axisgate {

/// The archive's bytes. Missing parts are listed in its README.txt and are no fault, because a gateway that does not start needs support
/// most.
[[nodiscard]] std::string make_bundle(const ConfigSources& sources, const Config& config);

}  // namespace axisgate
