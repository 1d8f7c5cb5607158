// Decoder of the UIM342: recorded CAN frames or UIMessage bytes as one readable line per message.
// In: frames in order, with their direction if it is known; a recording of bytes may begin and end within a message. Out: text; what is
// not the protocol is said to be so.
// Never changes anything and never guesses silently: a direction that was inferred is named as such.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "adapters/uim342/wire_uimessage.hpp"
#include "gateway/core/family.hpp"

namespace axisgate::uim342 {

class LineDecoder final : public Decoder {
public:
    explicit LineDecoder(LineKind kind) : kind_(kind) {}
    std::vector<std::string> on_frame(const Frame& frame, std::optional<bool> to_drive) override;
    std::vector<std::string> finish() override;

private:
    /// Bytes of one direction. Every form of the frame is taken: CRC over 12 or 13 bytes, or none.
    struct Stream {
        UiFramer framer{CrcMode::none};
        std::vector<std::uint8_t> junk;  ///< at most 64 bytes, then a line is written
        bool begun = false;              ///< what is strange is no end of a message that began before the recording
    };
    static std::string can_line(const Frame& frame);
    static void flush_junk(Stream& s, std::vector<std::string>& lines);

    LineKind kind_;
    std::array<Stream, 3> streams_;  // from the drive, to the drive, not known
};

}  // namespace axisgate::uim342
