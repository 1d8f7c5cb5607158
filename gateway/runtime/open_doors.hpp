// The doors of the running program: makes them from their descriptors, opens them or waits for their addresses, informs them of changes,
// and closes them. No door is named here.
#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gateway/runtime/door_descriptor.hpp"
#include "gateway/runtime/late_doors.hpp"
#include "gateway/services/ports/status.hpp"

namespace axisgate {

class OpenDoors {
public:
    OpenDoors(boost::asio::io_context& service, Hot& hot, WarmPorts& ports) : service_(service), hot_(hot), ports_(ports), late_(service) {}
    ~OpenDoors();
    OpenDoors(const OpenDoors&) = delete;
    OpenDoors& operator=(const OpenDoors&) = delete;

    /// Makes and opens the doors that the configuration wants, before threads start. Returns the exit code; faults have been reported.
    [[nodiscard]] int open(const DoorHouse& house, std::span<const DoorDescriptor* const> doors);
    /// One sentence for each door that waits for its address or interface.
    [[nodiscard]] std::vector<std::string> waiting() const { return late_.waiting(); }
    /// URL of the gateway's page; empty if no door serves it now.
    [[nodiscard]] std::string page() const;
    void on_change();
    /// Gives the end of a socket pair to a door that carries mirror lines, or closes it.
    void take_mirror(int fd);
    /// Ends all further attempts to open a door.
    void stop_waiting() { late_.stop(); }
    /// Closes all doors; runs the work of the service thread meanwhile, for a bounded time.
    void stop();
    /// After stop(): true if a thread of a library is left that cannot be ended.
    [[nodiscard]] bool hang() const;

private:
    [[nodiscard]] bool open_or_wait(RunningDoor& door, std::vector<const RunningDoor*>& left_out);
    void open_late(RunningDoor& door, std::function<void(std::string)> then);
    [[nodiscard]] std::vector<DoorInfo> addresses_on_hot() const;
    void tell() const;
    [[nodiscard]] std::string metrics() const;

    boost::asio::io_context& service_;
    Hot& hot_;
    WarmPorts& ports_;
    std::vector<std::unique_ptr<RunningDoor>> doors_;
    std::vector<DoorInfo> on_hot_;  // newest addresses of the doors of the hot thread
    LateDoors late_;
};

}  // namespace axisgate
