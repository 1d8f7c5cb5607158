// Both ends of the real program for benchmarks: a drive on a TCP line, a Modbus client, and the program itself. Received bytes have the
// kernel's time stamp, so that the wake-up time of the prober is not measured. A fault ends the benchmark with its reason.
#pragma once

#include <sched.h>
#include <sys/types.h>

#include <bitset>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "adapters/uim342/wire_uimessage.hpp"
#include "gateway/core/family.hpp"
#include "gateway/site/site.hpp"

namespace axisgate::bench {

/// CLOCK_MONOTONIC, ns.
[[nodiscard]] std::int64_t clock_ns();
[[noreturn]] void give_up(const std::string& why);

[[nodiscard]] int listening_socket(std::uint16_t& port);
/// A non-blocking socket to the loopback without delay, with time stamps of received bytes.
[[nodiscard]] int connected_socket(std::uint16_t port);
void no_delay(int fd);
/// Enables the kernel's time stamps of received bytes.
void note_arrivals(int fd);

/// recv without waiting. `came_ns` is the arrival of the last byte, by clock_ns().
[[nodiscard]] ssize_t receive(int fd, std::span<std::uint8_t> into, std::int64_t& came_ns);
/// Sleeps until one of them is readable (negative ones are ignored), at most this time.
void wait_for(std::initializer_list<int> fds, int timeout_ms);

/// The drive at the end of the line: the twin of UIM342 as device 5, answering at once.
class Drive {
public:
    explicit Drive(const FamilyEntry& e);
    ~Drive();
    Drive(const Drive&) = delete;
    Drive& operator=(const Drive&) = delete;
    [[nodiscard]] std::uint16_t port() const noexcept { return port_; }
    [[nodiscard]] int fd() const noexcept { return fd_; }  ///< -1: the program has not connected
    [[nodiscard]] int timeout_ms() const;                  ///< until the twin's next deadline; at most 1000

    /// Handles everything that is ready. Returns the instant at which a frame arrived whose function is not in `expected`, otherwise 0.
    std::int64_t pump(const std::bitset<128>& expected);
    std::bitset<128> functions;  ///< of the frames that came
    /// Moves the shaft by hand; the next frame with the new position is noted.
    void put(std::int32_t position);
    [[nodiscard]] std::int64_t left_at() const noexcept { return left_at_; }  ///< when that frame was sent; 0: not yet

private:
    void send(const Out& out);
    int listener_ = -1, fd_ = -1;
    std::uint16_t port_ = 0;
    std::unique_ptr<Twin> twin_;
    uim342::UiFramer framer_;
    std::int32_t put_ = 0;
    std::int64_t left_at_ = 1;
};

/// The gateway as a process of its own.
class Program {
public:
    /// On the processors of `cpus`, with the site `site` (JSON) and these settings (NAME=VALUE).
    Program(const std::string& path, const std::string& folder, const std::string& site, const cpu_set_t& cpus,
            const std::vector<std::string>& settings);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    /// True if it has reported that it is ready.
    bool ready();
    /// The port of one of its doors; 0: the door is closed.
    [[nodiscard]] std::uint16_t port(const std::string& door) const;

private:
    pid_t pid_ = -1;
    int out_ = -1;
    std::string output_;
};

/// A non-blocking Modbus client with one request in progress.
class ModbusClient {
public:
    explicit ModbusClient(std::uint16_t port) : fd_(connected_socket(port)) {}
    ~ModbusClient();
    ModbusClient(const ModbusClient&) = delete;
    ModbusClient& operator=(const ModbusClient&) = delete;
    void write(std::uint16_t address, std::initializer_list<std::uint16_t> values);
    void read(std::uint16_t address, std::uint16_t count);
    /// When the answer was complete; 0: it is not. An exception response ends the benchmark.
    std::int64_t answered();
    [[nodiscard]] int fd() const noexcept { return fd_; }

private:
    void send(std::span<const std::uint8_t> request);
    int fd_;
    std::uint8_t transaction_ = 0;
    std::vector<std::uint8_t> answer_;
};

struct Distribution {
    std::vector<double> us;
    [[nodiscard]] double at(double share);  ///< 1: the longest
};

/// The minimum for any gateway: a process that sleeps until bytes arrive on one connection and writes them to another. `cpu` < 0: on any
/// processor. `sleeping`: the prober sleeps as well.
class Relay {
public:
    Relay(int cpu, bool sleeping);
    ~Relay();
    Relay(const Relay&) = delete;
    Relay& operator=(const Relay&) = delete;
    /// The time of one message.
    [[nodiscard]] double once_us();

private:
    bool sleeping_;
    int pid_ = 0, in_ = -1, out_ = -1;
};
/// Messages through a relay from a prober that does not sleep. The pause between two is `pause_ns`, and up to four times as long at random.
[[nodiscard]] Distribution relay(int count, int cpu, std::int64_t pause_ns);

}  // namespace axisgate::bench
