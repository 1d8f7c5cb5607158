// CAN link: the netlink messages by which the kernel tells of a network interface and takes the order to restart a CAN controller.
// In: bytes of an rtnetlink socket. Out: what they say; and the requests as bytes.
// Never touches a socket, and never believes a length that it has not checked.
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
    int index = 0;  ///< of the interface
    std::string name;
    bool up = false;   ///< set up by somebody (IFF_UP)
    std::string type;  ///< "can", "vcan", "slcan" has none
    std::uint32_t bit_rate = 0;
    std::optional<CanState> state;
    std::optional<std::uint32_t> restart_ms;  ///< 0: the controller stays bus-off until somebody restarts it
    bool has_counters = false;
    std::uint8_t tx_errors = 0, rx_errors = 0;
    std::uint32_t sequence = 0;  ///< answer: of the request
    int error = 0;               ///< answer: 0 or errno
};

/// Asks what `index` is now; answered by one link message.
[[nodiscard]] std::vector<std::uint8_t> link_request(int index, std::uint32_t sequence);
/// Restarts a controller that is bus-off, as `ip link set IF type can restart` does; answered by an `answer`.
[[nodiscard]] std::vector<std::uint8_t> restart_request(int index, std::uint32_t sequence);

/// Everything in one datagram; what is not about links, or is cut off, is left out.
[[nodiscard]] std::vector<LinkNews> read_link_news(std::span<const std::uint8_t> datagram);

}  // namespace axisgate
