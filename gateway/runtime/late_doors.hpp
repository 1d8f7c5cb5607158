// Doors whose address or network interface does not exist yet (for example after a boot), or whose port another program uses, wait here and
// are opened when it becomes available. A waiting door delays neither the other doors nor the start of the gateway.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <list>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate {

/// "ADDRESS:PORT" names an address that this host does not have at present. False for every other fault.
[[nodiscard]] bool address_is_late(std::string_view bind);
/// Another program uses this port. `socket_type`: SOCK_STREAM or SOCK_DGRAM.
[[nodiscard]] bool address_is_taken(std::string_view bind, int socket_type);
/// The network interface does not exist at present, or is down, or has no address yet.
[[nodiscard]] bool interface_is_late(const std::string& name);

class LateDoors {
public:
    static constexpr std::chrono::seconds again{1};

    /// All calls must be made on the thread of `context`.
    explicit LateDoors(boost::asio::io_context& context) : timer_(context) {}

    struct Door {
        std::string name;               ///< name for the log
        std::string fault;              ///< why it could not be opened
        std::function<bool()> is_late;  ///< called each second; the door is opened when this returns false
        /// Opens the door on any thread, and then calls back on this one; an empty text: it is open.
        std::function<void(std::function<void(std::string fault)>)> open;
        std::function<void()> opened{};  ///< called once, when it is open
    };
    void wait_for(Door door);
    /// One sentence for each waiting door.
    [[nodiscard]] std::vector<std::string> waiting() const;
    /// No door is opened any more.
    void stop();

private:
    void look();
    void arm();
    struct Waiting : Door {
        bool opening = false;
    };
    boost::asio::steady_timer timer_;
    std::list<Waiting> doors_;  // an element must not move while its door is being opened
    bool stopped_ = false;
};

}  // namespace axisgate
