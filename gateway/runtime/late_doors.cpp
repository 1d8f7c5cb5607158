// Addresses and interfaces are checked once a second. No name server is asked.
#include "gateway/runtime/late_doors.hpp"

#include <arpa/inet.h>
#include <fmt/core.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "gateway/doors/http/server.hpp"

namespace axisgate {

bool address_is_late(std::string_view bind) {
    std::string fault;
    const auto endpoint = http::parse_bind(bind, fault);
    if (!endpoint) return false;
    // Port 0 is always free, so the result of bind depends on the address only.
    const boost::asio::ip::tcp::endpoint any(endpoint->address(), 0);
    const int fd = ::socket(any.protocol().family(), SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (fd < 0) return false;
    const bool there = ::bind(fd, any.data(), static_cast<socklen_t>(any.size())) == 0;
    const int why = errno;
    (void)::close(fd);
    return !there && (why == EADDRNOTAVAIL || why == ENODEV || why == ENETDOWN);
}

bool address_is_taken(std::string_view bind, int socket_type) {
    std::string fault;
    const auto endpoint = http::parse_bind(bind, fault);
    if (!endpoint || endpoint->port() == 0) return false;
    const int fd = ::socket(endpoint->protocol().family(), socket_type | SOCK_CLOEXEC, 0);
    if (fd < 0) return false;
    const int on = 1;  // like the doors: an old connection that is still closing does not occupy the port
    if (socket_type == SOCK_STREAM) (void)::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    const bool taken = ::bind(fd, endpoint->data(), static_cast<socklen_t>(endpoint->size())) != 0 && errno == EADDRINUSE;
    (void)::close(fd);
    return taken;
}

bool interface_is_late(const std::string& name) {
    ifaddrs* list = nullptr;
    if (::getifaddrs(&list) != 0) return false;
    bool ready = false;
    for (const ifaddrs* i = list; i; i = i->ifa_next) {
        const bool up = (i->ifa_flags & (IFF_UP | IFF_RUNNING)) == (IFF_UP | IFF_RUNNING);
        const bool has_address = i->ifa_addr && (i->ifa_addr->sa_family == AF_INET || i->ifa_addr->sa_family == AF_INET6);
        ready = ready || (up && has_address && name == i->ifa_name);
    }
    ::freeifaddrs(list);
    return !ready;
}

void LateDoors::wait_for(Door door) {
    spdlog::warn("{}; the {} door waits for it", door.fault, door.name);
    doors_.push_back({std::move(door)});
    if (doors_.size() == 1) arm();
}

std::vector<std::string> LateDoors::waiting() const {
    std::vector<std::string> list;
    for (const auto& d : doors_)
        list.push_back(fmt::format("the {} door waits: {}", d.name, d.fault));
    return list;
}

void LateDoors::stop() {
    stopped_ = true;
    timer_.cancel();
}

void LateDoors::arm() {
    timer_.expires_after(again);
    timer_.async_wait([this](const boost::system::error_code& ec) {
        if (!ec && !stopped_) look();
    });
}

void LateDoors::look() {
    for (auto& door : doors_) {
        if (door.opening || door.is_late()) continue;
        door.opening = true;
        door.open([this, &door](std::string fault) {
            door.opening = false;
            if (!fault.empty()) {
                if (fault != door.fault) spdlog::warn("{}; the {} door is tried again", fault, door.name);
                door.fault = std::move(fault);
                return;
            }
            spdlog::info("the {} door is open now", door.name);
            const auto opened = std::move(door.opened);
            doors_.remove_if([&door](const Waiting& w) { return &w == &door; });
            if (opened) opened();
        });
        break;  // one at a time: a door that opens at once has left the list
    }
    if (!doors_.empty()) arm();
}

}  // namespace axisgate
