// Reads recorded lines: candump logs, lines of hex bytes, the trace documents and trace texts of the API. The result is frames in order
// with stamp and direction; faults are reported with their place, and reading continues.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/frame.hpp"

namespace axisgate {

struct RecordedFrame {
    std::string stamp;             ///< as written; empty if there was none
    Frame frame;                   ///< a run of bytes that is longer than a Frame is split
    std::optional<bool> to_drive;  ///< empty: the recording does not contain it
};

enum class RecordingFormat : std::uint8_t {
    candump,  ///< `(1.5) can0 04280095#01`, candump's screen form, and the API's trace text
    hex,      ///< `> AA 05 95`: bytes to the drive, `<` from it, neither: unknown; and the API's trace text
    trace     ///< the JSON of GET /api/v1/lines/{name}/trace, or only its list of frames
};
[[nodiscard]] std::optional<RecordingFormat> recording_format_named(std::string_view name) noexcept;

struct RecordingEvents {
    std::function<void(const RecordedFrame&)> frame;
    /// `place` is a 1-based line, or the number of the entry; 0: the document as a whole.
    std::function<void(std::size_t place, const std::string& text)> fault;
};

/// Reads a whole recording. Empty lines and lines that begin with # are ignored.
void read_recording(std::string_view text, RecordingFormat format, const RecordingEvents& events);

}  // namespace axisgate
