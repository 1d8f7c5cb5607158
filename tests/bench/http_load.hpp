// The load generator of the HTTP benchmark: one thread, many open connections with one request in flight each. It returns answers per
// second and the 99th percentile of the time from request to answer. An answer that takes longer than two seconds, or is not 200 with a
// Content-Length, ends the run with a fault.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/modbus_load.hpp"

namespace axisgate::bench {

/// A connected blocking socket without delay; -1 on failure.
[[nodiscard]] int connect_blocking(Address address);

/// A request with all headers that the program's HTTP door requires.
[[nodiscard]] std::string http_request(Address address, const std::string& method, const std::string& path, const std::string& body);

/// One answer to one request on a connection of its own; the head is empty if there was none.
struct HttpAnswer {
    std::string head, body;
};
[[nodiscard]] HttpAnswer ask_once(Address address, const std::string& path);

class HttpLoad {
public:
    /// A non-empty `body` is sent as JSON.
    HttpLoad(Address address, const std::string& path, int connections, const std::string& method = "GET", const std::string& body = {});
    ~HttpLoad();
    HttpLoad(const HttpLoad&) = delete;
    HttpLoad& operator=(const HttpLoad&) = delete;
    /// Sends requests for this time, then waits for the answers in flight.
    [[nodiscard]] LoadResult run(double seconds);
    [[nodiscard]] const std::string& fault() const { return fault_; }

private:
    struct Connection {
        int fd = -1;
        std::int64_t sent_at = 0;
        std::size_t wanted = 0;  // size of the present answer; 0: its head is incomplete
        std::string in;
    };
    void ask(Connection& c);
    bool take(Connection& c);  // the answer is complete

    int poller_ = -1;
    std::string request_;
    std::vector<Connection> connections_;
    std::vector<std::uint32_t> latencies_ns_;
    std::string fault_;
};

}  // namespace axisgate::bench
