// Feedback: what the drive says of itself, turned into the axis' picture; and the motion that the picture is compared with.
// In: answers, notifications (RT). Out: feedback, samples, notices.
// Never invents: PAIF alone says that a target was reached, STOP that the axis stands, SON that it is on.
#pragma once

#include <string>

#include "adapters/uim342/drive_part.hpp"

namespace axisgate::uim342 {

/// The motion that was begun last, as far as this gateway knows it.
struct Motion {
    enum class Kind : std::uint8_t { none, absolute, relative, velocity, unknown };
    Kind kind = Kind::none;
    std::int64_t target = 0;
    std::int64_t speed = 0;   ///< absolute and relative: SP as sent, pulse/s; 0: not known
    bool seen_moving = true;  ///< STOP = 0 was seen since its BG
    Instant begun{};
    Instant stood_since = never;  ///< standing, not (yet) in position
};

class Feedback : public Part {
public:
    using Part::Part;

    // --- what the drive says ------------------------------------------------------------------------------------------------
    /// Everything that an answer tells, whoever asked for it. `samples`: also as values of points.
    void learn(const Message& request, const Message& answer, std::uint8_t mf, bool samples, Turn& t);
    void on_notification(const Message& m, Turn& t);

    // --- what was ordered ---------------------------------------------------------------------------------------------------
    /// The drive has acknowledged the start of a motion, or may have started one.
    void begin_motion(const Motion& motion, Turn& t);
    void no_motion() noexcept { motion_ = {}; }
    void slows_down(Instant now) noexcept;  ///< by JV=0 and BG
    /// OG was acknowledged. `homed`: that was the homing.
    void origin_set(bool homed, Turn& t);
    void homing_begins() noexcept { fb_.homing_attained = fb_.homing_error = false; }
    void homing_ended(bool good, Turn& t);
    void fault_reset() noexcept { fb_.homing_error = false; }

    // --- how it came and went -----------------------------------------------------------------------------------------------
    void found() noexcept;
    void zero_lost() noexcept { fb_.referenced = fb_.homing_attained = false; }
    void zero_known() noexcept { fb_.referenced = true; }
    void power_as_found() noexcept { power_expected_ = status_.on; }

    // --- the picture --------------------------------------------------------------------------------------------------------
    void derive(Turn& t);
    void emit(Turn& t);
    void update(Turn& t) {
        derive(t);
        emit(t);
    }
    [[nodiscard]] const AxisFeedback& fb() const noexcept { return fb_; }
    [[nodiscard]] const Status& status() const noexcept { return status_; }
    [[nodiscard]] Instant status_at() const noexcept { return status_at_; }
    [[nodiscard]] const Motion& motion() const noexcept { return motion_; }
    [[nodiscard]] bool status_known() const noexcept { return status_known_; }
    [[nodiscard]] bool position_known() const noexcept { return position_known_; }

private:
    void on_status(const Message& m, Turn& t);
    void on_speed(const Message& m, Turn& t);
    void on_input(const Notification& n, Turn& t);
    void on_finished(const Notification& n, Turn& t);
    void set_bit(std::uint32_t bit, bool on) noexcept { status_.raw = on ? status_.raw | bit : status_.raw & ~bit; }
    void suspect_restart(std::string why, Turn& t);

    Status status_;
    AxisFeedback fb_;
    Motion motion_;
    bool status_known_ = false, position_known_ = false;
    Instant status_at_{}, position_at_{};  ///< when MS[0] and MS[1] were said last
    bool rest_unread_ = false;             ///< it stands, but the last MS[1] is from when it moved
    bool power_expected_ = false;          ///< SON as our last command left it
};

}  // namespace axisgate::uim342
