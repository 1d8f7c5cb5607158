// Decoder of the example drive: recorded bytes to sentences.
// In: frames. Out: one line per telegram, "drive 5 axis 1: R21 = 1500". Never guesses: what is no telegram is shown as bytes.
#pragma once

#include "adapters/example/wire.hpp"
#include "gateway/core/family.hpp"

namespace axisgate::example {

class LineDecoder final : public Decoder {
public:
    std::vector<std::string> on_frame(const Frame& frame, std::optional<bool> to_drive) override;
    std::vector<std::string> finish() override { return {}; }

private:
    Framer framers_[2];  ///< one for each direction
};

}  // namespace axisgate::example
