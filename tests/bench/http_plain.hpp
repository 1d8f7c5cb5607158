// Plain HTTP server of the benchmark: Boost.Beast and nothing behind it: each request gets the same answer, as it was given.
// In: the core to run on, the head and the body of an answer. Out: an address on loopback. One thread, as the program's door has one.
// Never checks anything and has no timers, so nothing made with Beast is much faster that still answers.
#pragma once

#include <memory>
#include <string>
#include <thread>

#include "tests/bench/modbus_servers.hpp"

namespace axisgate::bench {

class PlainHttpServer {
public:
    /// `head`: status line and fields of the answer to be given, without its empty line. `nice`: what the thread stands back by.
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
