// Reads recorded lines: candump logs, lines of hex bytes, the trace documents and trace texts of the API, pcapng captures, and the frames
// of recordings (.axr). The result is frames in order with stamp and direction; faults are reported with their place, and reading
// continues where that is possible. `axisgate decode` and `axisgate compare` share it.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/frame.hpp"

namespace axisgate {

struct RecordedFrame {
    std::string stamp;  ///< as written; empty if there was none
    std::string line;   ///< the interface or line; empty: the format does not contain it
    /// The stamp as nanoseconds, since 1970 or since an instant that only this recording knows; empty: no stamp, or one that is no time.
    std::optional<std::int64_t> at_ns;
    Frame frame;                   ///< a run of bytes that is longer than a Frame is split
    std::optional<bool> to_drive;  ///< empty: the recording does not contain it
};

enum class RecordingFormat : std::uint8_t {
    candump,  ///< `(1.5) can0 04280095#01`, candump's screen form, and the API's trace text
    hex,      ///< `(1.5) > AA 05 95`: bytes to the drive, `<` from it, neither: unknown; the time may be absent; and the API's trace text
    trace,    ///< the JSON of GET /api/v1/lines/{name}/trace, or only its list of frames
    pcapng,   ///< a capture of SocketCAN frames, or of bytes as the API writes them
    axr       ///< a recording of the gateway: its frames
};
[[nodiscard]] std::optional<RecordingFormat> recording_format_named(std::string_view name) noexcept;
/// By the first bytes: a binary format, JSON, or a text whose lines begin with an interface (candump) or not (hex).
[[nodiscard]] RecordingFormat recording_format_of(std::string_view bytes) noexcept;

struct RecordingEvents {
    std::function<void(const RecordedFrame&)> frame;
    /// `place` is a 1-based line, or the number of the entry or packet; 0: the document as a whole.
    std::function<void(std::size_t place, const std::string& text)> fault;
};

/// Reads a whole recording. Empty lines and lines that begin with # are ignored.
void read_recording(std::string_view text, RecordingFormat format, const RecordingEvents& events);
/// "FILE", "FILE:12", "FILE: frame 12" for a place of RecordingEvents::fault.
[[nodiscard]] std::string recording_place(const std::string& file, RecordingFormat format, std::size_t place);

}  // namespace axisgate
