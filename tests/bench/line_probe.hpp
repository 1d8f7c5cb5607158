// Line probe: what benchmarks use to stand at both ends of the real program: a drive on a TCP line, a Modbus client, the program itself.
// In: bytes. Out: bytes, and the instant at which they were there, as the kernel noted it: the prober's own waking up is not measured.
// Never waits by itself; what goes wrong ends the benchmark with its reason.
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
/// Connected to the loopback, without delay, never waiting, noting when bytes come.
[[nodiscard]] int connected_socket(std::uint16_t port);
void no_delay(int fd);
/// The kernel notes from now on when bytes come in.
void note_arrivals(int fd);

/// recv without waiting. `came_ns`: when the last of the bytes came in, by clock_ns().
[[nodiscard]] ssize_t receive(int fd, std::span<std::uint8_t> into, std::int64_t& came_ns);
/// Sleeps until one of them has something to read (negative ones are left out), at most so long.
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
    [[nodiscard]] int timeout_ms() const;                  ///< until the twin itself has something to do; at most 1000

    /// Does what there is to do. Returns the instant at which a frame was there whose function is not in `expected`, else 0.
    std::int64_t pump(const std::bitset<128>& expected);
    std::bitset<128> functions;  ///< of the frames that came
    /// Moves the shaft by hand; the next frame that tells of it is noted.
    void put(std::int32_t position);
    [[nodiscard]] std::int64_t left_at() const noexcept { return left_at_; }  ///< when that frame left; 0: not yet

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
    /// On the processors of `cpus`, with what `site` (JSON) says and these settings (NAME=VALUE).
    Program(const std::string& path, const std::string& folder, const std::string& site, const cpu_set_t& cpus,
            const std::vector<std::string>& settings);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    /// Whether it has said that it is ready.
    bool ready();
    /// Where a door of it listens; 0: it does not.
    [[nodiscard]] std::uint16_t port(const std::string& door) const;

private:
    pid_t pid_ = -1;
    int out_ = -1;
    std::string output_;
};

/// A Modbus client that never waits by itself, with one request under way.
class ModbusClient {
public:
    explicit ModbusClient(std::uint16_t port) : fd_(connected_socket(port)) {}
    ~ModbusClient();
    ModbusClient(const ModbusClient&) = delete;
    ModbusClient& operator=(const ModbusClient&) = delete;
    void write(std::uint16_t address, std::initializer_list<std::uint16_t> values);
    void read(std::uint16_t address, std::uint16_t count);
    /// When the whole answer was there; 0: it is not. An exception ends the benchmark.
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

/// The least that any gateway needs: a process that sleeps until bytes come on one connection and writes them to another. `cpu` < 0: on any
/// processor. `sleeping`: the prober sleeps as well.
class Relay {
public:
    Relay(int cpu, bool sleeping);
    ~Relay();
    Relay(const Relay&) = delete;
    Relay& operator=(const Relay&) = delete;
    /// What one message took.
    [[nodiscard]] double once_us();

private:
    bool sleeping_;
    int pid_ = 0, in_ = -1, out_ = -1;
};
/// Messages of a relay from a prober that does not sleep. `pause_ns` is waited between two, and up to four times as long again by chance.
[[nodiscard]] Distribution relay(int count, int cpu, std::int64_t pause_ns);

}  // namespace axisgate::bench
