// Decoder of the remote family: recorded telegrams of a mirror line to sentences.
// In: frames. Out: one line per telegram, "hall-2/feeder is asked: move_absolute p=1500". Never guesses: what is none is shown as bytes.
#pragma once

#include "gateway/core/family.hpp"
#include "gateway/protocols/mirror/telegram.hpp"

namespace axisgate::remote {

class LineDecoder final : public Decoder {
public:
    std::vector<std::string> on_frame(const Frame& frame, std::optional<bool> to_drive) override;
    std::vector<std::string> finish() override { return {}; }

private:
    mirror::Framer framers_[2];  ///< one for each direction
};

}  // namespace axisgate::remote
