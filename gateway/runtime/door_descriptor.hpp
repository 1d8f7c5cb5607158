// A door as a value: its name, its ways in with their causes of loss, its settings, and the function that makes it. The program knows a
// door by its descriptor alone. A new door is a folder, a descriptor, and one line in doors.cpp.
#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/registers/register_image.hpp"
#include "gateway/runtime/config.hpp"
#include "gateway/runtime/setting.hpp"
#include "gateway/site/ways_in.hpp"

namespace axisgate {

class Hot;
class Services;
class Store;
class WarmPorts;

/// The parts of the program that a door can use. All of them outlive the door.
struct DoorHouse {
    const Config& config;
    const Families& families;
    const registers::Languages& languages;
    Hot& hot;
    registers::RegisterImage& image;
    boost::asio::io_context& service;  ///< the service thread's
    WarmPorts& ports;
    Services& services;
    Store& store;
    std::function<std::string()> page;  ///< URL of the gateway's page; empty if there is none
};

/// A door of the running program. All functions are called on the service thread or before threads start, unless noted.
class RunningDoor {
public:
    virtual ~RunningDoor() = default;
    /// In messages: "Modbus".
    [[nodiscard]] virtual std::string name() const = 0;
    /// True if its protocol server belongs to the hot thread: it is opened there once that thread runs, and HotDoor has its addresses.
    [[nodiscard]] virtual bool on_hot() const { return false; }
    /// Returns an empty string if it is open now, otherwise the fault and its remedy; it may be called again.
    [[nodiscard]] virtual std::string open() = 0;
    /// True if its address or interface does not exist yet or is in use, so that another attempt may succeed.
    [[nodiscard]] virtual bool is_late() const = 0;
    /// Not empty if the configuration does not name the door: the gateway then runs without it when it cannot be opened, with this warning.
    [[nodiscard]] virtual std::string left_out() const { return {}; }
    virtual void opened() {}
    /// Address of a door of the service thread; empty while it is closed.
    [[nodiscard]] virtual std::string address() const { return {}; }
    /// URL of the gateway's page, if this door serves it.
    [[nodiscard]] virtual std::string page() const { return {}; }
    /// Called once, soon after the next change of an axis' picture, if the door has requested it (Hot::want_change).
    virtual void on_change() {}
    /// Takes over the other end of a mirror line; false if the door does not carry mirror lines.
    [[nodiscard]] virtual bool take_mirror(int /*fd*/) { return false; }
    /// Counters of a door of the service thread, as Prometheus text.
    [[nodiscard]] virtual std::string metrics() const { return {}; }
    /// Accepts no more clients, completes requests in progress within a bound, then calls `done`.
    virtual void stop(std::function<void()> done) { done(); }
    /// After stop(): true if a thread of its library is left that cannot be ended.
    [[nodiscard]] virtual bool hangs() const { return false; }
};

/// The place of the value in force of a key: "axisgate.toml:12".
using KeyPlace = std::function<std::string(std::string_view section, std::string_view name)>;

/// The number of clients of a door, each of which uses a file descriptor.
struct DoorClients {
    std::string_view key{};  ///< key of the configuration, such as "[modbus] max_connections"; empty: the number is fixed
    std::uint64_t (*most)(const Config&) = nullptr;  ///< 0: the door is closed
    void (*lessen)(Config&, std::uint64_t) = nullptr;
};

struct DoorDescriptor {
    std::string_view name;                     ///< "modbus"
    const DoorWords* words = nullptr;          ///< its clients, ways in and causes of loss
    std::span<const setting::Key> settings{};  ///< keys of its own tables in the configuration
    bool (*wanted)(const Config&) = nullptr;
    /// Returns nullptr with the reasons in `faults` if it cannot be made.
    std::unique_ptr<RunningDoor> (*make)(const DoorHouse&, std::vector<ConfigFault>& faults) = nullptr;
    DoorClients clients{};
    /// Checks settings that depend on each other, after all keys have been read.
    void (*check)(const Config&, const KeyPlace&, std::vector<ConfigFault>&) = nullptr;
    /// Warns of settings that let other machines in without protection.
    void (*warn)(const Config&, std::vector<ConfigFault>&) = nullptr;
    /// Checks the files that its settings name.
    std::vector<ConfigFault> (*check_files)(const Config&, std::int64_t now_unix_s) = nullptr;
    bool shows_page = false;       ///< its clients are users who sign in
    bool carries_mirrors = false;  ///< it can take over the other ends of mirror lines
};

}  // namespace axisgate
