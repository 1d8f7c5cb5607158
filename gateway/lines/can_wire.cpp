// Converts SocketCAN's frames and error frames into ours. Data frames are converted without allocation.
#include "gateway/lines/can_wire.hpp"

#include <linux/can/error.h>
#include <linux/errqueue.h>
#include <time.h>

#include <algorithm>
#include <cstring>

#ifndef CAN_ERR_CNT
#define CAN_ERR_CNT 0x00000200U  // since Linux 6.0: data[6] and data[7] are the error counters
#endif

namespace axisgate {

std::string_view name_of(CanState state) noexcept {
    switch (state) {
        case CanState::active:
            return "error-active";
        case CanState::warning:
            return "error-warning";
        case CanState::passive:
            return "error-passive";
        case CanState::bus_off:
            return "bus-off";
        case CanState::stopped:
            return "stopped";
        case CanState::sleeping:
            return "sleeping";
    }
    return "stopped";
}

std::uint32_t can_error_classes() noexcept {
    return CAN_ERR_TX_TIMEOUT | CAN_ERR_CRTL | CAN_ERR_ACK | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_CNT;
}

::can_frame to_kernel(const Frame& f) noexcept {
    ::can_frame k{};
    k.can_id = f.extended ? (f.id & CAN_EFF_MASK) | CAN_EFF_FLAG : f.id & CAN_SFF_MASK;
    if (f.remote) k.can_id |= CAN_RTR_FLAG;
    k.len = static_cast<__u8>(std::min<std::uint16_t>(f.size, CAN_MAX_DLEN));
    if (!f.remote) std::memcpy(k.data, f.storage.data(), k.len);
    return k;
}

Frame from_kernel(const ::can_frame& k) noexcept {
    Frame f;
    f.kind = (k.can_id & CAN_ERR_FLAG) != 0 ? Frame::Kind::can_error : Frame::Kind::can;
    f.assign({k.data, std::min<std::size_t>(k.len, CAN_MAX_DLEN)});
    if (f.kind == Frame::Kind::can_error) {
        f.id = k.can_id & CAN_ERR_MASK;
        return f;
    }
    f.extended = (k.can_id & CAN_EFF_FLAG) != 0;
    f.remote = (k.can_id & CAN_RTR_FLAG) != 0;
    f.id = k.can_id & (f.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    return f;
}

CanReport read_report(const ::can_frame& k) {
    CanReport r;
    const std::uint32_t classes = k.can_id & CAN_ERR_MASK;
    const auto say = [&r](std::string_view words) {
        if (!r.text.empty()) r.text += ", ";
        r.text += words;
    };
    if ((classes & CAN_ERR_BUSOFF) != 0) {
        r.bus_off = true;
        r.state = CanState::bus_off;
        say("bus-off");
    }
    if ((classes & CAN_ERR_RESTARTED) != 0) {
        r.restarted = true;
        if (!r.bus_off) r.state = CanState::active;
        say("controller restarted");
    }
    if ((classes & CAN_ERR_TX_TIMEOUT) != 0) {
        r.tx_timeout = true;
        say("transmission timed out");
    }
    if ((classes & CAN_ERR_ACK) != 0) {
        r.no_ack = true;
        say("no acknowledgement");
    }
    if ((classes & CAN_ERR_CRTL) != 0) {
        const std::uint8_t c = k.data[1];
        if ((c & (CAN_ERR_CRTL_RX_OVERFLOW | CAN_ERR_CRTL_TX_OVERFLOW)) != 0) {
            r.overflow = true;
            say("controller buffer overflow");
        }
        std::optional<CanState> s;
        if ((c & CAN_ERR_CRTL_ACTIVE) != 0) s = CanState::active;
        if ((c & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) s = CanState::warning;
        if ((c & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) s = CanState::passive;
        if (s) say(name_of(*s));
        if (s && !r.state) r.state = s;
    }
    // Older drivers fill in the counters without setting the flag, but never leave random values there: two zeros carry no information.
    r.has_counters = (classes & CAN_ERR_CNT) != 0 || k.data[6] != 0 || k.data[7] != 0;
    r.tx_errors = k.data[6];
    r.rx_errors = k.data[7];
    if (r.text.empty()) say("error report");
    return r;
}

std::vector<::can_filter> to_kernel(std::span<const CanFilter> filters) {
    std::vector<::can_filter> k;
    if (filters.empty() || filters.size() > most_can_filters) {
        k.push_back({0, 0});
        return k;
    }
    for (const CanFilter& f : filters) {
        const std::uint32_t bits = f.extended ? CAN_EFF_MASK : CAN_SFF_MASK;
        // The frame format is part of the mask: otherwise an 11-bit identifier would match the low bits of a 29-bit one.
        k.push_back({(f.id & bits) | (f.extended ? CAN_EFF_FLAG : 0), (f.mask & bits) | CAN_EFF_FLAG});
    }
    return k;
}

bool passes(std::span<const CanFilter> filters, const Frame& frame) noexcept {
    if (filters.empty() || filters.size() > most_can_filters) return true;
    return std::ranges::any_of(filters,
                               [&](const CanFilter& f) { return f.extended == frame.extended && (frame.id & f.mask) == (f.id & f.mask); });
}

CanBeside read_beside(const ::msghdr& message) noexcept {
    CanBeside b;
    auto* m = const_cast<::msghdr*>(&message);
    for (cmsghdr* c = CMSG_FIRSTHDR(m); c != nullptr; c = CMSG_NXTHDR(m, c)) {
        if (c->cmsg_level != SOL_SOCKET || c->cmsg_len < CMSG_LEN(0)) continue;
        const std::size_t size = c->cmsg_len - CMSG_LEN(0);
        if (c->cmsg_type == SO_RXQ_OVFL && size >= sizeof(std::uint32_t)) {
            std::uint32_t v = 0;
            std::memcpy(&v, CMSG_DATA(c), sizeof v);
            b.overflow = v;
        } else if ((c->cmsg_type == SO_TIMESTAMPING || c->cmsg_type == SO_TIMESTAMPNS) && size >= sizeof(timespec)) {
            timespec t{};  // the first of SO_TIMESTAMPING's three stamps is the kernel's own
            std::memcpy(&t, CMSG_DATA(c), sizeof t);
            if (t.tv_sec != 0 || t.tv_nsec != 0) b.stamp_unix_ns = std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
        }
    }
    return b;
}

Instant instant_of_stamp(std::int64_t stamp_unix_ns, std::int64_t unix_now_ns, Instant now) noexcept {
    const std::int64_t age = unix_now_ns - stamp_unix_ns;
    if (stamp_unix_ns == 0 || age < 0 || age > 1'000'000'000) return now;
    return now - Duration{age};
}

}  // namespace axisgate
