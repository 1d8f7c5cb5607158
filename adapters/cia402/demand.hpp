// SetPointStream: the way of a streamed set-point into a drive that follows one target in each cycle of its own.
// In: the newest set-point, beats. Out: the next target, within the speed and the ramps of the set-point; RPDOs.
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
    ~SetPointStream() { give_back(); }

    void follow(const SetPoint& set_point);
    void end() noexcept;
    /// Its target, if it has its place in the beat that the next SYNC begins.
    void before_sync(Turn& t);
    /// A set-point is here, and its mode is not begun.
    [[nodiscard]] bool waits() const noexcept { return newest_ && state_ == State::none; }
    /// The steps into its mode; nothing: the beats have no room for one more, and the stream is over.
    [[nodiscard]] std::optional<Job> begin(Turn& t);
    /// The drive has refused the time between two targets. True: it has another one, and would go in jerks.
    [[nodiscard]] bool has_another_time() const noexcept;
    /// They are done; it stood at `here`.
    void begun(std::int64_t here);
    /// The mode that the drive shows: another one than that of the stream, again and again, ends it. Targets that nobody follows would be
    /// made up for in one step.
    void mode_shown(int mode, Turn& t);
    [[nodiscard]] bool on() const noexcept { return newest_ || state_ != State::none; }
    /// It gives targets that move the axis.
    [[nodiscard]] bool moves() const noexcept { return state_ >= State::position && led_.velocity() != 0; }

private:
    enum class State : std::uint8_t { none, starting, position, velocity, torque };
    void give_back() noexcept;
    [[nodiscard]] Duration cycle() const noexcept;

    static constexpr int sure = 3;  ///< pictures in a row: one may be older than the mode
    State state_ = State::none;
    int astray_ = 0;
    std::optional<canopen::TargetTurns::Place> place_{};  ///< in the line's beats; it stays while the axis is led
    std::optional<SetPoint> newest_;
    drive::Lead led_;
};

}  // namespace axisgate::cia402_drive
