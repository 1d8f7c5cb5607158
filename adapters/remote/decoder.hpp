// Decoder of the remote family: recorded telegrams of a mirror line to sentences; a recording may begin and end within a telegram.
// In: frames. Out: one line per telegram, "hall-2/feeder is asked: move_absolute p=1500". Never guesses: what is none is shown as it came.
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
