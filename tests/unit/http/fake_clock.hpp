// The clock and the status port for tests: the test sets the time and the missing conditions.
#pragma once

#include <string>
#include <vector>

#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/status.hpp"

namespace axisgate::http::test {

class FakeClock : public ClockPort {
public:
    std::int64_t now_ns = 1'767'323'045'678'901'234;  // 2026-01-02T03:04:05.678901234Z
    std::int64_t now_unix_ns() const override { return now_ns; }
    std::int64_t to_unix_ns(Instant i) const override { return 1'767'323'045'000'000'000 + ns_of(i); }
};

class FakeStatus : public StatusPort {
public:
    std::vector<std::string> missing;
    std::vector<DoorInfo> doors() const override { return {{"http", "127.0.0.1:8080"}, {"modbus", "127.0.0.1:1502"}}; }
    double uptime_s() const override { return 12.5; }
    std::vector<std::string> not_ready() const override { return missing; }
    std::string sheet = "[File]\r\n";
    std::string eds() const override { return sheet; }
    std::string metrics() const override { return "# HELP axisgate_up 1\n# TYPE axisgate_up gauge\naxisgate_up 1\n"; }
};

}  // namespace axisgate::http::test
