// The load generator of the Modbus benchmark: one thread, many connections, each with a fixed number of requests in flight. It returns
// answers per second and the 99th percentile of the time from request to answer. A server that does not answer for two seconds ends the run
// with a fault.
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
    /// It polls for answers without sleeping, so that only the wake-up time of the server is measured.
    void never_sleep() noexcept { never_sleeps_ = true; }
    Load(const Load&) = delete;
    Load& operator=(const Load&) = delete;

    /// Sends requests for this time, then waits for the answers in flight.
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
    int take(Connection& c);  // number of complete answers; -1: the connection is lost

    int poller_ = -1;
    int in_flight_;
    std::uint16_t registers_;
    std::size_t answer_size_;
    std::vector<Connection> connections_;
    std::vector<std::uint32_t> latencies_ns_;
    bool never_sleeps_ = false;
    std::string fault_;
};

/// Idle connections.
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
