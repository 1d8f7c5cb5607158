// CAN kernel: the few system calls that a CAN line needs, behind a seam, so that its rules can be tested without a CAN interface.
// In: interface names, frames. Out: descriptors to wait on, frames, errno values.
// Never decides anything: what to do about an error is CanLine's business.
#pragma once

#include <linux/can.h>
#include <sys/socket.h>

#include <cstdint>
#include <span>
#include <string>

#include "gateway/lines/can_wire.hpp"

namespace axisgate {

struct CanOpened {
    int fd = -1;        ///< non-blocking; belongs to the caller. -1: see `fault`
    int index = 0;      ///< of the interface
    std::string fault;  ///< why not, and what to do
};

struct CanKernel {
    /// A raw CAN socket on the interface, with filters, error reports, own frames coming back, time stamps and a short send queue.
    [[nodiscard]] virtual CanOpened open_can(const std::string& interface, std::span<const CanFilter> filters) const = 0;
    /// An rtnetlink socket that hears of every change of an interface.
    [[nodiscard]] virtual CanOpened open_links() const = 0;
    /// 0, or errno.
    [[nodiscard]] virtual int send(int fd, const ::can_frame& frame) const = 0;
    /// Whether a received frame is one of ours that has been sent.
    [[nodiscard]] virtual bool is_echo(const ::can_frame& frame, int message_flags) const = 0;
    virtual ~CanKernel() = default;
};

/// This machine's kernel.
[[nodiscard]] const CanKernel& linux_can() noexcept;

/// What to say and to advise when a CAN socket cannot be opened; `step` is the call that failed.
[[nodiscard]] std::string can_open_fault(const std::string& interface, const char* step, int error);

}  // namespace axisgate
