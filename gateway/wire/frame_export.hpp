// Recorded frames as files for other tools: candump logs, pcapng captures, and lines for people. The entries (frame_log.hpp) contain the
// wall-clock time already. The meaning of a frame is not interpreted here; `axisgate decode` does that.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "gateway/core/frame.hpp"

namespace axisgate {

/// The log form of `candump -L`: `(1436509052.249713) can0 04280095#01`, one line per CAN frame, remote frames as `#R8`, reports of the
/// controller with the error flag in the identifier. Runs of bytes have no such form and are left out: use trace_text for byte lines.
[[nodiscard]] std::string candump_text(std::span<const TraceEntry> entries, std::string_view line);

/// One line per frame of any kind, with direction and side: `(1436509052.249713) ttyS1 device > AA 05 95`; `>` is to the drive.
[[nodiscard]] std::string trace_text(std::span<const TraceEntry> entries, std::string_view line);

inline constexpr std::uint16_t linktype_can_socketcan = 227;
inline constexpr std::uint16_t linktype_user0 = 147;  ///< runs of bytes as they are

/// A pcapng section, little endian, times in nanoseconds, direction in epb_flags (inbound: from the drive). The cable and the twin bus are
/// two interfaces, "LINE" and "LINE (twin)".
class Pcapng {
public:
    explicit Pcapng(std::string_view line);
    void add(std::span<const TraceEntry> entries);
    /// Returns the bytes of all added entries. Nothing may be added afterwards.
    [[nodiscard]] std::string take() { return std::move(bytes_); }

private:
    static constexpr std::uint32_t unused = 0xFFFFFFFF;
    std::string line_, bytes_;
    std::array<std::uint32_t, 4> interfaces_{unused, unused, unused,
                                             unused};  ///< one per link type and side, described before its first packet
    std::uint32_t count_ = 0;
};
[[nodiscard]] inline std::string pcapng(std::span<const TraceEntry> entries, std::string_view line) {
    Pcapng capture(line);
    capture.add(entries);
    return capture.take();
}

}  // namespace axisgate
