// Decoder of the example drive: recorded bytes to sentences; a recording may begin and end within a telegram.
// In: frames. Out: one line per telegram, "drive 5 axis 1: R21 = 1500". Never guesses: what is no telegram is shown as it came.
#pragma once

#include "adapters/example/wire.hpp"

namespace axisgate::example {

class LineDecoder final : public drive::TextDecoder {
public:
    LineDecoder() : TextDecoder(lines()) {}

private:
    [[nodiscard]] std::optional<std::string> sentence(std::string_view line) const override;
};

}  // namespace axisgate::example
