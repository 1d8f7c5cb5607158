// The CAN kernel interface over SocketCAN raw sockets and rtnetlink. No call waits.
#include "gateway/lines/can_kernel.hpp"

#include <fmt/core.h>
#include <linux/can/raw.h>
#include <linux/net_tstamp.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "gateway/lines/error_text.hpp"

namespace axisgate {
namespace {

/// The smallest send buffer that the kernel allows: about six frames. Frames in the kernel's queue can no longer be overtaken by a stop.
constexpr int send_buffer = 1;
constexpr int receive_buffer = 512 * 1024;

template <class T>
bool set(int fd, int level, int name, const T& value) noexcept {
    return ::setsockopt(fd, level, name, &value, sizeof value) == 0;
}

class LinuxCan final : public CanKernel {
public:
    CanOpened open_can(const std::string& interface, std::span<const CanFilter> filters) const override {
        CanOpened r;
        const int fd = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
        if (fd < 0) {
            r.fault = can_open_fault(interface, "socket", errno);
            return r;
        }
        const char* step = set_up(fd, interface, filters, r.index);
        if (step != nullptr) {
            r.fault = can_open_fault(interface, step, errno);
            ::close(fd);
            return r;
        }
        r.fd = fd;
        return r;
    }

    CanOpened open_links() const override {
        CanOpened r;
        const int fd = ::socket(AF_NETLINK, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, NETLINK_ROUTE);
        sockaddr_nl address{};
        address.nl_family = AF_NETLINK;
        address.nl_groups = RTMGRP_LINK;
        if (fd < 0 || ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
            r.fault = fmt::format("cannot hear of changes of network interfaces: {}", error_text(errno));
            if (fd >= 0) ::close(fd);
            return r;
        }
        r.fd = fd;
        return r;
    }

    int send(int fd, const ::can_frame& frame) const override {
        for (;;) {
            if (::send(fd, &frame, sizeof frame, MSG_NOSIGNAL) >= 0) return 0;
            if (errno != EINTR) return errno;
        }
    }

    bool is_echo(const ::can_frame&, int message_flags) const override { return (message_flags & MSG_CONFIRM) != 0; }

private:
    /// Returns nullptr, or the name of the call that failed, with errno set.
    static const char* set_up(int fd, const std::string& interface, std::span<const CanFilter> filters, int& index) {
        ifreq request{};
        std::strncpy(request.ifr_name, interface.c_str(), IFNAMSIZ - 1);
        if (::ioctl(fd, SIOCGIFINDEX, &request) != 0) return "interface";
        index = request.ifr_ifindex;
        if (::ioctl(fd, SIOCGIFFLAGS, &request) != 0) return "interface";
        if ((request.ifr_flags & IFF_UP) == 0) {
            errno = ENETDOWN;
            return "interface";
        }
        const auto kernel_filters = to_kernel(filters);
        if (::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, kernel_filters.data(),
                         static_cast<socklen_t>(kernel_filters.size() * sizeof(::can_filter))) != 0) {
            return "filter";
        }
        const can_err_mask_t classes = can_error_classes();
        if (!set(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, classes)) return "error filter";
        if (!set(fd, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, 1)) return "own messages";
        (void)set(fd, SOL_SOCKET, SO_SNDBUF, send_buffer);
        (void)set(fd, SOL_SOCKET, SO_RCVBUF, receive_buffer);
        (void)set(fd, SOL_SOCKET, SO_RXQ_OVFL, 1);
        if (!set(fd, SOL_SOCKET, SO_TIMESTAMPING, SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE)) {
            (void)set(fd, SOL_SOCKET, SO_TIMESTAMPNS, 1);
        }
        sockaddr_can address{};
        address.can_family = AF_CAN;
        address.can_ifindex = index;
        return ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? nullptr : "bind";
    }
};

}  // namespace

const CanKernel& linux_can() noexcept {
    static const LinuxCan kernel;
    return kernel;
}

std::string can_open_fault(const std::string& interface, const char* step, int error) {
    switch (error) {
        case EAFNOSUPPORT:
        case EPROTONOSUPPORT:
            return fmt::format("this kernel has no CAN ({}): load the modules can, can_raw",
                               error == EAFNOSUPPORT ? "address family not supported" : "protocol not supported");
        case ENODEV:
        case ENXIO:
            return fmt::format("there is no network interface {0}: is the adapter plugged in and its driver loaded (ip link show {0})?",
                               interface);
        case ENETDOWN:
            return fmt::format("{0} is down: ip link set {0} up type can bitrate 1000000", interface);
        case EPERM:
        case EACCES:
            return fmt::format("{}: not permitted ({}): the service needs the right to use CAN sockets", interface, step);
        default:
            return fmt::format("cannot open {} ({}): {}", interface, step, error_text(error));
    }
}

}  // namespace axisgate
