// CAN kernel: the few system calls that a CAN line needs, behind an interface, so that CanLine can be tested without CAN hardware.
// It opens sockets, sends frames and returns errno values. How to react to an error is decided in CanLine.
#pragma once

#include <linux/can.h>
#include <sys/socket.h>

#include <cstdint>
#include <span>
#include <string>

#include "gateway/lines/can_wire.hpp"

namespace axisgate {

struct CanOpened {
    int fd = -1;        ///< non-blocking, owned by the caller; -1 on failure, then see `fault`
    int index = 0;      ///< of the interface
    std::string fault;  ///< why opening failed, and what the user can do about it
};

struct CanKernel {
    /// A raw CAN socket on the interface, with filters, error reports, own frames coming back, time stamps and a short send queue.
    [[nodiscard]] virtual CanOpened open_can(const std::string& interface, std::span<const CanFilter> filters) const = 0;
    /// An rtnetlink socket that receives every change of a network interface.
    [[nodiscard]] virtual CanOpened open_links() const = 0;
    /// 0, or errno.
    [[nodiscard]] virtual int send(int fd, const ::can_frame& frame) const = 0;
    /// Whether a received frame is the echo of a frame that this socket sent.
    [[nodiscard]] virtual bool is_echo(const ::can_frame& frame, int message_flags) const = 0;
    virtual ~CanKernel() = default;
};

/// The implementation that calls the kernel of this machine.
[[nodiscard]] const CanKernel& linux_can() noexcept;

/// The message for the user when a CAN socket cannot be opened; `step` is the call that failed.
[[nodiscard]] std::string can_open_fault(const std::string& interface, const char* step, int error);

}  // namespace axisgate
