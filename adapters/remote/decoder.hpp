// The decoder of the remote family: one sentence per telegram, "hall-2/feeder is asked: move_absolute p=1500". A recording may begin and
// end within a telegram; text that is not a telegram is shown unchanged.
#pragma once

#include "gateway/drive/text_lines.hpp"
#include "gateway/protocols/mirror/telegram.hpp"

namespace axisgate::remote {

class LineDecoder final : public drive::TextDecoder {
public:
    LineDecoder() : TextDecoder({'\n', "", mirror::longest}) {}

private:
    [[nodiscard]] std::optional<std::string> sentence(std::string_view line) const override;
};

}  // namespace axisgate::remote
