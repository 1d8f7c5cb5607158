// Decoder of MCode: a recorded line as one readable line per message.
// In: runs of bytes in order, with their direction if it is known; a recording may begin and end within a line, and nothing but a checksum
// proves the first one of a direction whole. Out: text; what is not the language is said to be so.
// Never changes anything; keeps at most one line of each direction.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gateway/core/family.hpp"

namespace axisgate::mcode {

class LineDecoder final : public Decoder {
public:
    std::vector<std::string> on_frame(const Frame& frame, std::optional<bool> to_drive) override;
    std::vector<std::string> finish() override;

private:
    static constexpr std::size_t longest = 256;  ///< a line without an end is written out here
    void put(std::size_t direction, char c, std::vector<std::string>& lines);
    void flush(std::size_t direction, std::string_view end, std::vector<std::string>& lines);
    std::array<std::string, 3> held_;  // from the drive, to the drive, not known
    std::array<bool, 3> begun_{};      ///< a line or a control symbol has ended: what follows is a line from its beginning
};

}  // namespace axisgate::mcode
