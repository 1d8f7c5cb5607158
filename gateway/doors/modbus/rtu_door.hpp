// RTU door: Modbus RTU slave on one serial line, on the hot thread's io_context.
// In: a line, which opens its port again by itself; a DoorPort. Out: a served master; events when the port comes and goes; counters.
// Never blocks, never opens a port itself. One request at a time is all that a serial line has; frames are bounded by 256 bytes.
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
    Responder::Settings responder;  ///< its allow list does not apply: who is on the wire is on the wire
    RtuTiming timing;
    std::uint8_t address = 1;  ///< 1..247
    std::string port;          ///< as people know it: "/dev/ttyUSB0"; the master's name in events and authority
    std::string text;          ///< the line's URI, with bit rate and format: what /about shows
};

class RtuDoor {
public:
    /// Puts itself into the port's list of doors. `io`, `port` and `image` outlive it. Everything on the thread that runs `io`.
    RtuDoor(boost::asio::io_context& io, DoorPort& port, registers::RegisterImage& image, RtuSettings settings, std::unique_ptr<Line> line);
    ~RtuDoor();
    RtuDoor(const RtuDoor&) = delete;
    RtuDoor& operator=(const RtuDoor&) = delete;

    /// Begins to open the port. That it cannot be opened is told by an event, and it is tried again.
    void open();
    void close();

    struct Report {
        bool up = false;
        std::string peer;
        std::uint64_t requests = 0, writes = 0, exceptions = 0;
        Instant since{};  ///< when the port was opened, or opened again
    };
    [[nodiscard]] Report report() const;
    [[nodiscard]] Responder& responder() noexcept;
    /// May be read on any thread while the door lives.
    [[nodiscard]] const RtuReceiverCounters& line_counters() const noexcept;
    [[nodiscard]] const RtuCounters& counters() const noexcept;

private:
    class Impl;
    std::shared_ptr<Impl> impl_;
};

}  // namespace axisgate::modbus
