// RtuDoor is a Modbus RTU slave on one serial line, on the hot thread's io_context. The line opens its port again after a failure; events
// report when the port is lost and available again. One request is in progress at a time, and a frame has at most 256 bytes. It never
// blocks.
#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>
#include <vector>

#include "gateway/core/line.hpp"
#include "gateway/doors/modbus/pdu.hpp"
#include "gateway/doors/modbus/rtu_receiver.hpp"
#include "gateway/doors/modbus/rtu_session.hpp"

namespace axisgate::modbus {

struct RtuSettings {
    Responder::Settings responder;  ///< its allow list does not apply, because a serial line has no addresses of clients
    RtuTiming timing;
    std::uint8_t address = 1;  ///< 1..247
    std::string port;          ///< name for the user: "/dev/ttyUSB0"; also the master's name in events and authority
    std::string text;          ///< the URI of the line with bit rate and format, as in /about
};

class RtuDoor {
public:
    /// Adds itself to the port's list of doors. `io`, `port` and `image` must outlive it. All calls on the thread that runs `io`.
    RtuDoor(boost::asio::io_context& io, DoorPort& port, registers::RegisterImage& image, RtuSettings settings, std::unique_ptr<Line> line);
    ~RtuDoor();
    RtuDoor(const RtuDoor&) = delete;
    RtuDoor& operator=(const RtuDoor&) = delete;

    /// Begins to open the port. A failure is reported by an event, and opening is repeated.
    void open();
    void close();

    struct Report {
        bool up = false;
        std::string peer;
        std::uint64_t requests = 0, writes = 0, exceptions = 0;
        Instant since{};  ///< when the port was opened last
    };
    [[nodiscard]] Report report() const;
    [[nodiscard]] Responder& responder() noexcept;
    /// Any thread, while the door exists.
    [[nodiscard]] const RtuReceiverCounters& line_counters() const noexcept;
    [[nodiscard]] const RtuCounters& counters() const noexcept;

private:
    class Impl;
    std::shared_ptr<Impl> impl_;
};

}  // namespace axisgate::modbus
