// Feedback turns the default response of a drive (status word, StateVar, position) into the feedback of the axis, into alarms, and into
// samples of the drive's own values. The velocity is the change of the position during the last 100 ms.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "adapters/linmot/drive_part.hpp"

namespace axisgate::linmot {

class Feedback : public Part {
public:
    using Part::Part;

    void learn(const Status& status, Turn& t);
    void publish(Turn& t);
    /// The line went down or the drive was lost: reported values are no longer valid.
    void unknown() noexcept { known_ = placed_ = false; }
    void forget() noexcept;
    void homing_begins() noexcept { fb_.homing_attained = fb_.homing_error = false; }
    void homing_attained() noexcept { fb_.homing_attained = true; }
    void homing_failed() noexcept { fb_.homing_error = true; }

    [[nodiscard]] bool known() const noexcept { return known_; }
    [[nodiscard]] const Status& status() const noexcept { return status_; }
    [[nodiscard]] const AxisFeedback& fb() const noexcept { return fb_; }
    /// An error that the drive showed while it decelerated and shows no more, because its power was removed before it entered its error
    /// state. It is kept here until a reset.
    [[nodiscard]] bool error_kept() const noexcept { return kept_; }
    void error_reset() noexcept { kept_ = braked_ = false; }
    [[nodiscard]] bool in_error() const noexcept { return status_.state() == state::error || status_.state() == state::setup_error; }
    [[nodiscard]] std::string error_text() const;
    [[nodiscard]] std::string state_text() const;
    [[nodiscard]] std::string error_or_state() const { return in_error() ? error_text() : state_text(); }

private:
    void watch_errors(Turn& t);
    void watch_power(Turn& t);
    void keep_error() noexcept;
    [[nodiscard]] bool power_taken(Instant now) noexcept;
    [[nodiscard]] DriveRates rates() const noexcept;
    void track(const Status& status, Instant now);
    void judge_motion(Instant now);
    void sample(std::string_view id, Value value, Turn& t);

    bool known_ = false;
    bool placed_ = false;  ///< the position is known, too
    Status status_;
    AxisFeedback fb_;
    std::uint8_t reported_error_ = 0;
    bool braked_ = false;                                 ///< it decelerates because of an error
    bool kept_ = false;                                   ///< that error has disappeared from the status without a reset
    bool operated_ = false;                               ///< it was enabled, and its control word was not withdrawn since
    std::optional<Instant> asked_at_;                     ///< when bit 1 of the control word was requested
    bool power_shown_ = false;                            ///< status bit 4 has been set since then
    std::deque<std::pair<Instant, std::int32_t>> track_;  ///< positions of the last 100 ms
};

}  // namespace axisgate::linmot
