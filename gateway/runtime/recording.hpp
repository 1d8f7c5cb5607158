// Recording: recorded lines read back: candump logs, lines of hex bytes, the trace documents and trace texts of the API.
// In: text. Out: frames in order with stamp and direction; what cannot be read is said, with its place. Never stops at the first fault,
// never interprets a frame, opens nothing.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/frame.hpp"

namespace axisgate {

struct RecordedFrame {
    std::string stamp;             ///< as it was written; empty if there was none
    Frame frame;                   ///< a run of bytes that is longer than a Frame comes in pieces
    std::optional<bool> to_drive;  ///< nothing: the recording does not say
};

enum class RecordingFormat : std::uint8_t {
    candump,  ///< `(1.5) can0 04280095#01`, candump's screen form, and the API's trace text
    hex,      ///< `> AA 05 95`: bytes to the drive, `<` from it, neither: not known; and the API's trace text
    trace     ///< the JSON of GET /api/v1/lines/{name}/trace, or its list of frames alone
};
[[nodiscard]] std::optional<RecordingFormat> recording_format_named(std::string_view name) noexcept;

struct RecordingEvents {
    std::function<void(const RecordedFrame&)> frame;
    /// `place`: 1-based line, or number of the entry; 0: the document as a whole.
    std::function<void(std::size_t place, const std::string& text)> fault;
};

/// Reads a whole recording. Empty lines and lines that begin with # are left out.
void read_recording(std::string_view text, RecordingFormat format, const RecordingEvents& events);

}  // namespace axisgate
