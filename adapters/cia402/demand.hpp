// SetPointStream: the way of a streamed set-point into a drive that follows one target per SYNC.
// In: the newest set-point, the cycle. Out: the next target, within the speed and the ramps of the set-point; RPDOs.
// Never gives a drive a step that its ramps do not allow: in a cyclic mode nobody else would plan the way.
#pragma once

#include <optional>

#include "adapters/cia402/drive_node.hpp"
#include "adapters/cia402/drive_steps.hpp"
#include "gateway/drive/lead.hpp"
#include "gateway/drive/part.hpp"

namespace axisgate::cia402_drive {
class Axis;

class SetPointStream : public drive::Part<Axis> {
public:
    using Part::Part;

    void follow(const SetPoint& set_point);
    void end() noexcept;
    void before_sync(Duration cycle, Turn& t);
    /// A set-point is here, and its mode is not begun.
    [[nodiscard]] bool waits() const noexcept { return newest_ && state_ == State::none; }
    /// The steps into its mode.
    [[nodiscard]] Job begin();
    /// They are done; it stood at `here`.
    void begun(std::int64_t here);
    [[nodiscard]] bool on() const noexcept { return newest_ || state_ != State::none; }
    /// It gives targets that move the axis.
    [[nodiscard]] bool moves() const noexcept { return state_ >= State::position && led_.velocity() != 0; }

private:
    enum class State : std::uint8_t { none, starting, position, velocity, torque };
    State state_ = State::none;
    std::optional<SetPoint> newest_;
    drive::Lead led_;
};

}  // namespace axisgate::cia402_drive
