// PositionStream uses the drive's position stream (031xh) for streamed set-points, if the line can keep its period: one motion command per
// period, whose answer reports the position, so that no other request is sent. Without a new set-point the last one is repeated, because
// the drive goes into error 0083h if the stream stops; the engine monitors the client. A line without a bit rate, or with a second drive,
// cannot keep the period.
#pragma once

#include <optional>
#include <string>

#include "adapters/linmot/drive_part.hpp"
#include "gateway/drive/lead.hpp"

namespace axisgate::linmot {

/// 0: this line cannot keep the period of a stream.
[[nodiscard]] Duration stream_period(const Bus& bus, std::size_t response = default_size) noexcept;

class PositionStream : public Part {
public:
    using Part::Part;

    /// False: the set-point is not streamed, and a stream in progress is ended first.
    [[nodiscard]] bool take(const SetPoint& set_point);
    /// A command that moves or stops the axis has arrived.
    void interrupt() noexcept;
    void begin(Turn& t);
    void send(Turn& t);
    void answered(Turn& t);
    /// The stream has ended already, or the drive was lost: its end is not sent.
    void forget() { state_ = {}; }

    [[nodiscard]] bool on() const noexcept { return state_.on; }
    [[nodiscard]] bool ending() const noexcept { return state_.ending; }
    [[nodiscard]] bool waits() const noexcept { return state_.newest.has_value(); }
    [[nodiscard]] Instant next() const noexcept { return state_.next; }
    /// Time-out of an answer during a stream: one period. The stream then continues with its next set-point, because the drive may have
    /// received the command.
    [[nodiscard]] std::optional<Duration> patience() const noexcept;
    /// A silence of this length does not count.
    [[nodiscard]] bool received_lately(Instant now) const noexcept;

private:
    struct State {
        bool on = false, ending = false;
        Duration period{};
        Instant next = never, received{};  ///< its next set-point; its last answer
        drive::Lead lead;
        std::optional<SetPoint> newest;
    };
    void end(Reason reason, std::string why, Turn& t);

    State state_;
};

}  // namespace axisgate::linmot
