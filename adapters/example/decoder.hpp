// The decoder of the example drive: one sentence per telegram, "drive 5 axis 1: R21 = 1500". A recording may begin and end within a
// telegram; text that is not a telegram is shown unchanged.
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
