// CAN wire: between the kernel's CAN structures and ours: frames, the controller's error reports, filters, what comes beside a frame.
// In: struct can_frame and control messages of a raw CAN socket. Out: Frame, CanReport, time stamps; and back.
// Never touches a socket: all of it can be tested on a machine without CAN.
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

/// A frame passes if (frame.id & mask) == (id & mask) and it has the form that `extended` says.
struct CanFilter {
    std::uint32_t id = 0;
    std::uint32_t mask = 0;
    bool extended = true;
    bool operator==(const CanFilter&) const = default;
};
/// The kernel takes no more than this; with more, everything is received.
inline constexpr std::size_t most_can_filters = 512;

/// States of a CAN controller, in order of badness; `stopped` and `sleeping` are the driver's.
enum class CanState : std::uint8_t { active, warning, passive, bus_off, stopped, sleeping };
[[nodiscard]] std::string_view name_of(CanState state) noexcept;

/// What an error frame says (linux/can/error.h).
struct CanReport {
    bool bus_off = false;
    bool restarted = false;
    bool tx_timeout = false;        ///< the driver gave up a transmission
    bool no_ack = false;            ///< nobody on the bus acknowledges
    bool overflow = false;          ///< the controller's own buffers were full: frames are lost
    std::optional<CanState> state;  ///< the new state, if the report is about that
    bool has_counters = false;
    std::uint8_t tx_errors = 0, rx_errors = 0;
    std::string text;  ///< for people: "bus-off", "no acknowledgement, error-passive"
};

/// The classes of error frames that a line asks for. Bus errors are not among them: a bad bus would flood us with them.
[[nodiscard]] std::uint32_t can_error_classes() noexcept;

[[nodiscard]] ::can_frame to_kernel(const Frame& frame) noexcept;
/// Data, remote and error frames; `at` is left to the caller. Lengths past 8 are cut.
[[nodiscard]] Frame from_kernel(const ::can_frame& frame) noexcept;
[[nodiscard]] CanReport read_report(const ::can_frame& frame);

/// For CAN_RAW_FILTER. No filters, or too many: one that lets everything pass.
[[nodiscard]] std::vector<::can_filter> to_kernel(std::span<const CanFilter> filters);
/// Whether the kernel would let this frame through: the echo of a frame that it would not will never be seen.
[[nodiscard]] bool passes(std::span<const CanFilter> filters, const Frame& frame) noexcept;

/// What the kernel says beside a received frame.
struct CanBeside {
    std::int64_t stamp_unix_ns = 0;         ///< when it was seen; 0: not said
    std::optional<std::uint32_t> overflow;  ///< frames lost since the socket was opened, because we were too slow
};
[[nodiscard]] CanBeside read_beside(const ::msghdr& message) noexcept;

/// The instant that belongs to a kernel time stamp, from the two clocks as they are now. A stamp from the future or older than a second
/// (the wall clock was set) counts as now.
[[nodiscard]] Instant instant_of_stamp(std::int64_t stamp_unix_ns, std::int64_t unix_now_ns, Instant now) noexcept;

}  // namespace axisgate
