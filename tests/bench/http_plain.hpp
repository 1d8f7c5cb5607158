// The plain HTTP server of the benchmark: Boost.Beast with one thread, like the program's door, without checks and timers. Each request
// gets the same given answer, so no server made with Beast that still answers is much faster.
#pragma once

#include <memory>
#include <string>
#include <thread>

#include "tests/bench/modbus_servers.hpp"

namespace axisgate::bench {

class PlainHttpServer {
public:
    /// `head` contains the status line and the fields of the answer, without its empty line. `nice` is the thread's nice value.
    PlainHttpServer(int cpu, int nice, const std::string& head, std::string body);
    ~PlainHttpServer();
    PlainHttpServer(const PlainHttpServer&) = delete;
    PlainHttpServer& operator=(const PlainHttpServer&) = delete;
    [[nodiscard]] Address address() const { return address_; }
    [[nodiscard]] double used_seconds() { return processor_seconds(thread_); }

private:
    struct State;
    std::unique_ptr<State> state_;
    Address address_;
    std::thread thread_;
};

}  // namespace axisgate::bench
