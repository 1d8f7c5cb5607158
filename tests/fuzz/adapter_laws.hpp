// One adapter, its twins, and a wire that the fuzzer controls: whatever frames arrive at whatever time, the laws of adapter.hpp hold; the
// program is aborted when one is broken. The protocol is known only to the target in adapters/<family>/fuzz.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

namespace axisgate::fuzz {

struct FamilyFrames {
    /// A frame as one of these drives might send it.
    std::function<Frame(FuzzedDataProvider&, LineKind, const std::vector<std::string>& addresses)> plausible;
    /// Empty if this frame may be sent to these drives, otherwise its fault.
    std::function<std::string(const Frame&, LineKind, const std::vector<std::string>& addresses)> wrong;
};

/// One run: twins at `addresses`, the adapter, and the events that the fuzzer's bytes determine.
void run_adapter(const FamilyEntry& entry, const FamilyFrames& frames, FuzzedDataProvider& in, std::vector<std::string> addresses);

}  // namespace axisgate::fuzz
