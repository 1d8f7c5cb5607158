// PositionStream: the drive's own position stream (031xh) for set-points over the lane, where the line can hold its period.
// In: the newest set-point. Out: one motion command each period, with place and speed on the way there; its answers say where the axis is,
// so nothing else is asked. The newest set-point is held when none comes: a stream that starves is an error of the drive (0083h), and who
// is silent is the engine's to judge. Never streams on a line without a bit rate, nor beside another drive: their periods cannot be kept.
#pragma once

#include <optional>
#include <string>

#include "adapters/linmot/drive_part.hpp"
#include "gateway/drive/lead.hpp"

namespace axisgate::linmot {

/// 0: this line cannot hold a stream.
[[nodiscard]] Duration stream_period(const Bus& bus) noexcept;

class PositionStream : public Part {
public:
    using Part::Part;

    /// False: it is not streamed, and a stream that runs is ended first.
    [[nodiscard]] bool take(const SetPoint& set_point);
    /// A command that moves or stops has come.
    void interrupt() noexcept;
    void begin(Turn& t);
    void send(Turn& t);
    void answered(Turn& t);
    /// It has ended already, or nothing of before counts: no end is sent.
    void forget() { state_ = {}; }

    [[nodiscard]] bool on() const noexcept { return state_.on; }
    [[nodiscard]] bool ending() const noexcept { return state_.ending; }
    [[nodiscard]] bool waits() const noexcept { return state_.newest.has_value(); }
    [[nodiscard]] Instant next() const noexcept { return state_.next; }
    /// For an answer, while it runs: its period alone. It goes on with its next set-point: the drive may have heard it all the same.
    [[nodiscard]] std::optional<Duration> patience() const noexcept;
    /// So short a silence is none.
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
