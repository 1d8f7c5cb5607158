// Reads pcapng captures, as frame_export.hpp, Wireshark and `tcpdump -i can0` write them: CAN frames in the form of SocketCAN and runs of
// bytes. A capture may have any origin; one that is cut or damaged is named with its place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "gateway/core/frame.hpp"

namespace axisgate {

struct CapturedFrame {
    std::string_view interface;  ///< its name in the capture; "interface N" where it has none
    std::int64_t at_unix_ns = 0;
    std::optional<bool> to_drive;  ///< the packet flags' direction: outbound is to the drive; empty: the capture does not contain it
    Frame frame;                   ///< a run of bytes that is longer than a Frame is split
};

struct CaptureEvents {
    std::function<void(const CapturedFrame&)> frame;
    /// `packet` is the 1-based number of the packet that cannot be used; 0: the file as a whole, which is not read further.
    std::function<void(std::size_t packet, const std::string& text)> fault;
};

[[nodiscard]] bool is_pcapng(std::string_view bytes) noexcept;
/// All packets of all sections, in their order. Several captures may follow each other, as .axr recordings have them.
void read_pcapng(std::string_view bytes, const CaptureEvents& events);

}  // namespace axisgate
