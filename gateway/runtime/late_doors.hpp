// Late doors: doors whose address or network interface is not there yet, as after a boot, or whose port another program has, wait for it
// and are opened when it has come.
// In: how each is opened, time. Out: what waits, in words. A door that waits never keeps another one or the gateway from starting.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <list>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate {

/// "ADDRESS:PORT" names an address that this host does not have at the moment. False for whatever else is wrong with it.
[[nodiscard]] bool address_is_late(std::string_view bind);
/// Another program has this port of it. `socket_type`: SOCK_STREAM or SOCK_DGRAM.
[[nodiscard]] bool address_is_taken(std::string_view bind, int socket_type);
/// There is no such network interface at the moment, or it is down, or it has no address yet.
[[nodiscard]] bool interface_is_late(const std::string& name);

class LateDoors {
public:
    static constexpr std::chrono::seconds again{1};

    /// On the thread of `context`, as everything here.
    explicit LateDoors(boost::asio::io_context& context) : timer_(context) {}

    struct Door {
        std::string name;               ///< as the log calls it
        std::string fault;              ///< why it could not be opened
        std::function<bool()> is_late;  ///< asked each second; it is opened when this says no
        /// Opens it, on whatever thread, and then calls back on this one; empty: it is open.
        std::function<void(std::function<void(std::string fault)>)> open;
        std::function<void()> opened{};  ///< called once, when it is open
    };
    void wait_for(Door door);
    /// One sentence for each door that waits.
    [[nodiscard]] std::vector<std::string> waiting() const;
    /// Nothing is opened any more.
    void stop();

private:
    void look();
    void arm();
    struct Waiting : Door {
        bool opening = false;
    };
    boost::asio::steady_timer timer_;
    std::list<Waiting> doors_;  // an element stays where it is while it is being opened
    bool stopped_ = false;
};

}  // namespace axisgate
