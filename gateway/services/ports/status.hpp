// Status port: the program as a whole: its open doors, how long it runs, whether it is ready, its metrics.
// In: nothing. Out: texts and addresses. Service thread only; never waits.
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
    /// Not ready: what is missing, one sentence each; empty: ready.
    [[nodiscard]] virtual std::vector<std::string> not_ready() const = 0;
    /// Prometheus text of everything but the asking door's own counters.
    [[nodiscard]] virtual std::string metrics() const = 0;
    /// The electronic data sheet by which EtherNet/IP tools know this gateway, as the site in force makes it; empty: that door is shut.
    [[nodiscard]] virtual std::string eds() const = 0;
};

}  // namespace axisgate
