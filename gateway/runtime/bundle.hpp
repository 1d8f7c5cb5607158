// Bundle: what somebody needs who is to help from afar, as one tar, without anything that opens a door.
// In: the configuration's sources, the data directory, the gateway's own pages where it runs. Out: the archive.
// Never holds users, tokens, sessions, certificates or keys; every text goes through scrub(). Never changes anything.
#pragma once

#include <string>

#include "gateway/runtime/config.hpp"

namespace axisgate {

/// The archive's bytes. What cannot be had is named in its README.txt, and is no fault: a gateway that does not start needs help most.
[[nodiscard]] std::string make_bundle(const ConfigSources& sources, const Config& config);

}  // namespace axisgate
