// CAN wire: converts between the kernel's CAN structures and ours: frames, error reports, filters and control messages.
// It touches no socket, so all of it can be tested on a machine without CAN.
#pragma once

#include <linux/can.h>
#include <sys/socket.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/core/frame.hpp"

namespace axisgate {

/// A frame passes if (frame.id & mask) == (id & mask) and its format is the one that `extended` selects.
struct CanFilter {
    std::uint32_t id = 0;
    std::uint32_t mask = 0;
    bool extended = true;
    bool operator==(const CanFilter&) const = default;
};
/// The kernel accepts no more filters than this; with more, the line receives everything.
inline constexpr std::size_t most_can_filters = 512;

/// States of a CAN controller, from best to worst; `stopped` and `sleeping` are reported by the driver.
enum class CanState : std::uint8_t { active, warning, passive, bus_off, stopped, sleeping };
[[nodiscard]] std::string_view name_of(CanState state) noexcept;

/// The content of an error frame (linux/can/error.h).
struct CanReport {
    bool bus_off = false;
    bool restarted = false;
    bool tx_timeout = false;        ///< the driver gave up a transmission
    bool no_ack = false;            ///< no node on the bus acknowledges
    bool overflow = false;          ///< the buffers of the controller were full and frames are lost
    std::optional<CanState> state;  ///< the new state, if the report contains one
    bool has_counters = false;
    std::uint8_t tx_errors = 0, rx_errors = 0;
    std::string text;  ///< text for the user: "bus-off", "no acknowledgement, error-passive"
};

/// The classes of error frames that a line asks for. Bus errors are not among them, because a bad bus would produce a flood of them.
[[nodiscard]] std::uint32_t can_error_classes() noexcept;

[[nodiscard]] ::can_frame to_kernel(const Frame& frame) noexcept;
/// Converts data, remote and error frames; the caller sets `at`. Lengths above 8 are cut to 8.
[[nodiscard]] Frame from_kernel(const ::can_frame& frame) noexcept;
[[nodiscard]] CanReport read_report(const ::can_frame& frame);

/// The filters for CAN_RAW_FILTER. If there are none or too many, one filter that lets everything pass.
[[nodiscard]] std::vector<::can_filter> to_kernel(std::span<const CanFilter> filters);
/// Whether the kernel would deliver this frame to us. If not, the echo of such a frame never arrives.
[[nodiscard]] bool passes(std::span<const CanFilter> filters, const Frame& frame) noexcept;

/// The control messages that the kernel delivers with a received frame.
struct CanBeside {
    std::int64_t stamp_unix_ns = 0;         ///< when the frame was received; 0: not given
    std::optional<std::uint32_t> overflow;  ///< frames lost since the socket was opened, because we read too slowly
};
[[nodiscard]] CanBeside read_beside(const ::msghdr& message) noexcept;

/// The instant that belongs to a kernel time stamp, computed from the present values of both clocks. A stamp from the future or older
/// than a second (the wall clock was set) counts as now.
[[nodiscard]] Instant instant_of_stamp(std::int64_t stamp_unix_ns, std::int64_t unix_now_ns, Instant now) noexcept;

}  // namespace axisgate
