// The program as a whole: open doors, running time, readiness, metrics. Service thread only; never waits.
#pragma once

#include <string>
#include <vector>

namespace axisgate {

/// A door that is open.
struct DoorInfo {
    std::string name;     ///< "http", "modbus", ...
    std::string address;  ///< "127.0.0.1:1502"
};

class StatusPort {
public:
    virtual ~StatusPort() = default;
    [[nodiscard]] virtual std::vector<DoorInfo> doors() const = 0;
    [[nodiscard]] virtual double uptime_s() const = 0;
    /// If not ready: the reasons, one sentence each; empty: ready.
    [[nodiscard]] virtual std::vector<std::string> not_ready() const = 0;
    /// Prometheus text of everything except the asking door's own counters.
    [[nodiscard]] virtual std::string metrics() const = 0;
    /// The electronic data sheet of this gateway for EtherNet/IP tools, made from the site in force; empty if that door is closed.
    [[nodiscard]] virtual std::string eds() const = 0;
};

}  // namespace axisgate
