// Adapter laws: one adapter, its twins, and a wire that the fuzzer holds: whatever frames come and whenever, the laws of adapter.hpp stand.
// In: a family, the fuzzer's bytes, how the family's own frames look. Out: nothing; stops the program when a law is broken.
// Never knows a protocol: that is for the target in adapters/<family>/fuzz.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

namespace axisgate::fuzz {

struct FamilyFrames {
    /// A frame as one of these drives might send it.
    std::function<Frame(FuzzedDataProvider&, LineKind, const std::vector<std::string>& addresses)> plausible;
    /// Empty if this frame may be sent to these drives, else what is wrong with it.
    std::function<std::string(const Frame&, LineKind, const std::vector<std::string>& addresses)> wrong;
};

/// One run: twins at `addresses`, the adapter, and whatever the fuzzer's bytes make of them.
void run_adapter(const FamilyEntry& entry, const FamilyFrames& frames, FuzzedDataProvider& in, std::vector<std::string> addresses);

}  // namespace axisgate::fuzz
