// Decoder of the PA-CONTROL: recorded bytes as one readable line per frame or poll.
// In: runs of bytes in order, with their direction if it is known; a recording may begin and end within a frame. Out: text; the check
// is verified, and what it proves is said.
// Never changes anything and never guesses silently: a direction that was inferred is named as such.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "adapters/pacontrol/wire.hpp"
#include "gateway/core/family.hpp"

namespace axisgate::pacontrol {

class LineDecoder final : public Decoder {
public:
    std::vector<std::string> on_frame(const Frame& frame, std::optional<bool> to_drive) override;
    std::vector<std::string> finish() override;

private:
    static constexpr std::size_t junk_limit = 64;                      ///< strange bytes on one line
    static constexpr std::size_t tail_limit = Framer::text_limit + 5;  ///< of a frame without SOH and EOT: STX, text, ETX, 3 digits
    struct Stream {
        Framer framer;
        std::vector<std::uint8_t> junk;
        FrameFault fault = FrameFault::stray;
        bool begun = false;  ///< a frame or a poll was there: what is before it may be the end of a frame that was not recorded whole
    };
    static void flush(Stream& s, std::vector<std::string>& lines);
    void ended(Stream& s, std::optional<bool> to_drive, std::vector<std::string>& lines);
    std::array<Stream, 3> streams_;  // from the control, to it, not known
};

}  // namespace axisgate::pacontrol
