// Load generator of the Modbus benchmark: one thread, many connections, each with a fixed number of requests in flight.
// In: an address and the shape of the load. Out: answers per second and the 99th percentile of the time from request to answer.
// Never waits longer than two seconds for an answer: a server that stands still ends the run with a fault.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/modbus_servers.hpp"

namespace axisgate::bench {

[[nodiscard]] bool parse_address(const std::string& text, Address& out);

struct LoadResult {
    double per_second = 0;
    double p99_us = 0;
    std::size_t answers = 0;
    bool good = false;  ///< every answer had the right size and transaction, and no connection was lost
};

class Load {
public:
    Load(Address address, int connections, int in_flight, std::uint16_t registers);
    ~Load();
    /// It looks for answers without ever sleeping: what is measured is then the server's wake-ups alone, and not the generator's own.
    void never_sleep() noexcept { never_sleeps_ = true; }
    Load(const Load&) = delete;
    Load& operator=(const Load&) = delete;

    /// Asks for that long, then waits for what is still in flight.
    [[nodiscard]] LoadResult run(double seconds);
    [[nodiscard]] const std::string& fault() const { return fault_; }

private:
    struct Connection {
        int fd = -1;
        std::uint16_t next = 0;             // transaction of the next request
        std::uint16_t expected = 0;         // of the next answer
        std::vector<std::int64_t> sent_at;  // by transaction % size
        std::size_t have = 0;
        std::vector<std::uint8_t> in;
    };
    void ask(Connection& c, int requests);
    int take(Connection& c);  // answers taken; -1: lost

    int poller_ = -1;
    int in_flight_;
    std::uint16_t registers_;
    std::size_t answer_size_;
    std::vector<Connection> connections_;
    std::vector<std::uint32_t> latencies_ns_;
    bool never_sleeps_ = false;
    std::string fault_;
};

/// Connections that do nothing.
class IdleConnections {
public:
    IdleConnections(Address address, int count);
    ~IdleConnections();
    IdleConnections(const IdleConnections&) = delete;
    IdleConnections& operator=(const IdleConnections&) = delete;
    [[nodiscard]] bool good() const;

private:
    std::vector<int> fds_;
    bool all_;
};

}  // namespace axisgate::bench
