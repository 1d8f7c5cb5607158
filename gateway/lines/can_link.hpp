// CAN link: the netlink messages that report the state of a network interface and that restart a CAN controller.
// It decodes the bytes of an rtnetlink socket and encodes the requests. It touches no socket, and checks every length before using it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/lines/can_wire.hpp"

namespace axisgate {

/// One message about an interface, or the answer to a request.
struct LinkNews {
    enum class Kind : std::uint8_t { link, removed, answer };
    Kind kind = Kind::link;
    int index = 0;  ///< index of the interface
    std::string name;
    bool up = false;   ///< the interface has been set up (IFF_UP)
    std::string type;  ///< "can" or "vcan"; empty for slcan
    std::uint32_t bit_rate = 0;
    std::optional<CanState> state;
    std::optional<std::uint32_t> restart_ms;  ///< 0: the controller stays bus-off until it is restarted by a command
    bool has_counters = false;
    std::uint8_t tx_errors = 0, rx_errors = 0;
    std::uint32_t sequence = 0;  ///< in an answer: the sequence number of the request
    int error = 0;               ///< in an answer: 0 or errno
};

/// Asks for the present state of interface `index`; the kernel answers with one link message.
[[nodiscard]] std::vector<std::uint8_t> link_request(int index, std::uint32_t sequence);
/// Restarts a controller that is bus-off, as `ip link set IF type can restart` does; the kernel answers with an `answer`.
[[nodiscard]] std::vector<std::uint8_t> restart_request(int index, std::uint32_t sequence);

/// All messages of one datagram; messages that are not about links, or that are truncated, are left out.
[[nodiscard]] std::vector<LinkNews> read_link_news(std::span<const std::uint8_t> datagram);

}  // namespace axisgate
