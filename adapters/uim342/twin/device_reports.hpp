// DeviceReports is the part of a Device that tells: alarms and notifications, error reports, the status word and the model. A specimen's
// notifications and status bits can be late or missing.
#pragma once

#include "adapters/uim342/twin/device.hpp"

namespace axisgate::uim342::twin {

class DeviceReports {
public:
    explicit DeviceReports(Device& device) noexcept : d_(device) {}

    void raise(Alarm alarm, Instant at, Out& out);
    void notify(std::initializer_list<std::uint8_t> data, Instant at, Out& out);
    void arrive(Instant at, Out& out);
    void keep_status(Instant at);
    void send_status(Instant at, Out& out) const;
    static void fill_model(const Device& d, Telegram& reply) noexcept;
    static void fill_status(const Device& d, Telegram& reply, Instant now) noexcept;
    void report(Fault fault, const Telegram& t, std::uint8_t sub, Instant now, Out& out);

private:
    [[nodiscard]] static std::array<std::uint8_t, 2> status_bits(const Device& d) noexcept;
    Device& d_;
};

}  // namespace axisgate::uim342::twin
