// The interface of everything that carries frames: a cable, a twin bus, a replayed trace, a fault injector. Received frames and changes of
// state are reported through LineEvents. Real lines (gateway/lines) call their events from the hot loop; pure lines only from on_deadline
// and send.
#pragma once

#include <cstdint>
#include <string>

#include "gateway/core/frame.hpp"

namespace axisgate {

/// The reports of a line to its owner. Called on the hot thread only, never from inside the owner's own send().
struct LineEvents {
    virtual void on_frame(const Frame& frame) = 0;
    /// `up` false: nothing can be sent (cable disconnected, interface down, bus-off, connection lost); `why` is for people.
    virtual void on_line_state(bool up, const std::string& why) = 0;
    /// One frame was really sent (echoed by the CAN controller, written to the port); for the trace. A line need not report it.
    virtual void on_sent(const Frame& frame) = 0;
    virtual ~LineEvents() = default;
};

struct LineStatus {
    enum class State : std::uint8_t { closed, opening, up, down, bus_off };
    State state = State::closed;
    std::string text;             ///< for people: "up at 1000000 bit/s", "cannot open /dev/ttyUSB0: no such file"
    std::uint64_t frames_in = 0;  ///< CAN frames, or runs of bytes
    std::uint64_t frames_out = 0;
    std::uint64_t bytes_in = 0;
    std::uint64_t bytes_out = 0;
    std::uint64_t dropped = 0;   ///< frames that were dropped because the queue was full
    std::uint64_t errors = 0;    ///< controller errors, framing errors, failed writes
    std::uint64_t reopened = 0;  ///< number of times the line came back
    std::uint32_t queued = 0;    ///< frames waiting now
    double load = 0;             ///< share of the bit rate used in the last second, 0..1; 0 if there is no bit rate
    std::uint8_t tx_errors = 0;  ///< the CAN controller's counters, if it provides them
    std::uint8_t rx_errors = 0;
};
[[nodiscard]] std::string_view name_of(LineStatus::State state) noexcept;

struct Line {
    /// Begins to open; state changes are reported through `events`, which must outlive the line. It opens again by itself after every
    /// fault, with growing pauses, until it is closed.
    virtual void open(LineEvents& events, Instant now) = 0;
    virtual void close() = 0;
    /// Accepts a frame for sending. Urgent ones go before all waiting ones. False: the bounded queue is full or the line is down; the frame
    /// is dropped and counted.
    virtual bool send(const Frame& frame, Priority priority, Instant now) = 0;
    /// Pure lines work by deadline; real lines return `never` and use the loop's own timers.
    [[nodiscard]] virtual Instant deadline() const = 0;
    virtual void on_deadline(Instant now) = 0;
    [[nodiscard]] virtual LineStatus status(Instant now) const = 0;
    virtual ~Line() = default;
};

}  // namespace axisgate
