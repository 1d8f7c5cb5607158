// The servers of the Modbus benchmark: the door with eight moving axes, and the plain epoll server with which it is compared. Each has one
// thread on the given core, which sleeps while there is no request.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace axisgate::bench {

struct Address {
    std::uint32_t host = 0x7F000001;  ///< IPv4, host byte order
    std::uint16_t port = 0;
};

/// Processor time that a thread has used so far, s.
[[nodiscard]] double processor_seconds(std::thread& thread);

/// Keeps the calling thread on one core; without effect if the machine has fewer.
void pin(int cpu);

/// The Modbus door behind a port without an engine. Eight axes move: each gets a new picture every millisecond while anyone is connected.
class DoorServer {
public:
    DoorServer(int cpu, int spin_us);
    ~DoorServer();
    [[nodiscard]] Address address() const { return address_; }
    [[nodiscard]] double used_seconds() { return processor_seconds(thread_); }

private:
    struct State;
    std::unique_ptr<State> state_;
    Address address_;
    std::thread thread_;
};

/// epoll, recv, one send with the answers to all whole 12-byte requests that have arrived. The answer is a block of bytes of the right size
/// with the request's transaction and unit; nothing is checked, so this is the fastest server that still answers.
class PlainServer {
public:
    explicit PlainServer(int cpu);
    ~PlainServer();
    [[nodiscard]] Address address() const { return address_; }
    [[nodiscard]] double used_seconds() { return processor_seconds(thread_); }
    /// The number of registers in the following answers. Must be called while there is no request.
    void answer_with(std::uint16_t registers) { registers_.store(registers); }

private:
    void serve();
    int listening_ = -1;
    int stop_ = -1;
    Address address_;
    std::atomic<std::uint16_t> registers_{10};
    std::thread thread_;
};

}  // namespace axisgate::bench
