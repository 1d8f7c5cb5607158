// Many live-feed clients with the subscriptions of the page. They count the received frames and the longest silence of each client, and do
// not read the texts.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/bench/modbus_servers.hpp"

namespace axisgate::bench {

/// CLOCK_MONOTONIC, s.
[[nodiscard]] double now_s();

class Crowd {
public:
    struct Client {
        int fd = -1;
        std::string in;
        std::size_t axes = 0, others = 0, bytes = 0;
        double received_s = 0, gap_s = 0;
    };
    /// All topics of the page, or only the axes.
    enum class Watches { page, axes };
    Crowd(Address address, std::size_t count, int period_ms, Watches what = Watches::page);
    ~Crowd();
    Crowd(const Crowd&) = delete;
    Crowd& operator=(const Crowd&) = delete;
    /// Reads for this time.
    void run(double seconds);
    void forget();
    [[nodiscard]] bool good() const { return good_; }  ///< no client was refused or closed
    [[nodiscard]] const std::vector<Client>& clients() const { return clients_; }

private:
    int poller_;
    std::vector<Client> clients_;
    bool good_ = true;
};

}  // namespace axisgate::bench
