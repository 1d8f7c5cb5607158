// SetPointStream sends streamed set-points to a drive that follows one target per cycle. In a cyclic mode the drive has no profile
// generator, so each target is calculated here within the speed and the ramps of the set-point.
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
    /// Sends the target if the axis has its place in the cycle that the next SYNC begins.
    void before_sync(Turn& t);
    /// A set-point has arrived and its mode has not been entered.
    [[nodiscard]] bool waits() const noexcept { return newest_ && state_ == State::none; }
    /// The steps into the mode of the stream. Empty: the cycles have no free place, and the stream has ended.
    [[nodiscard]] std::optional<Job> begin(Turn& t);
    /// The drive has refused the interpolation time. True: it uses another one, and would not move evenly.
    [[nodiscard]] bool has_another_time() const noexcept;
    /// The steps are done; the axis stood at `here`.
    void begun(std::int64_t here);
    /// The drive shows its mode (6061h). If it differs from the stream's mode several times in succession, the stream ends: the drive would
    /// cover targets that it did not follow in one step.
    void mode_shown(int mode, Turn& t);
    [[nodiscard]] bool on() const noexcept { return newest_ || state_ != State::none; }
    /// True while the targets move the axis.
    [[nodiscard]] bool moves() const noexcept { return state_ >= State::position && led_.velocity() != 0; }

private:
    enum class State : std::uint8_t { none, starting, position, velocity, torque };
    void give_back() noexcept;
    void send(std::int64_t target, Turn& t);
    [[nodiscard]] Duration cycle() const noexcept;

    static constexpr int sure = 3;  ///< feedback in succession; one may be older than the change of mode
    State state_ = State::none;
    int astray_ = 0;
    std::optional<canopen::TargetTurns::Place> place_{};  ///< in the cycles of the line; kept while the axis follows set-points
    std::optional<SetPoint> newest_;
    drive::Lead led_;
};

}  // namespace axisgate::cia402_drive
