// Load generator of the HTTP benchmark: one thread, many kept-open connections with one request in flight each.
// In: an address, a path, a number of connections. Out: answers per second and the 99th percentile of the time from request to answer.
// Never waits longer than two seconds for an answer; an answer that is not 200 with a Content-Length ends the run with a fault.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/modbus_load.hpp"

namespace axisgate::bench {

/// A socket that is connected, without delay and blocking; -1 if it could not be.
[[nodiscard]] int connect_blocking(Address address);

/// A request with everything that the program's HTTP door asks for.
[[nodiscard]] std::string http_request(Address address, const std::string& method, const std::string& path, const std::string& body);

/// One answer to one request on a connection of its own; empty head if there was none.
struct HttpAnswer {
    std::string head, body;
};
[[nodiscard]] HttpAnswer ask_once(Address address, const std::string& path);

class HttpLoad {
public:
    /// `body`, if there is one, goes as JSON.
    HttpLoad(Address address, const std::string& path, int connections, const std::string& method = "GET", const std::string& body = {});
    ~HttpLoad();
    HttpLoad(const HttpLoad&) = delete;
    HttpLoad& operator=(const HttpLoad&) = delete;
    /// Asks for that long, then waits for what is still in flight.
    [[nodiscard]] LoadResult run(double seconds);
    [[nodiscard]] const std::string& fault() const { return fault_; }

private:
    struct Connection {
        int fd = -1;
        std::int64_t sent_at = 0;
        std::size_t wanted = 0;  // of the answer that is coming; 0: its head is not here yet
        std::string in;
    };
    void ask(Connection& c);
    bool take(Connection& c);  // the answer is whole

    int poller_ = -1;
    std::string request_;
    std::vector<Connection> connections_;
    std::vector<std::uint32_t> latencies_ns_;
    std::string fault_;
};

}  // namespace axisgate::bench
