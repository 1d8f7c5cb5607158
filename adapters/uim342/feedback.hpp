// Feedback and Errors: what the drive says of itself, turned into the axis' picture; the motion that the picture is compared with; what its
// error flag stands for. In: answers, notifications (RT), error reports. Out: feedback, samples, notices.
// Never invents: PAIF alone says that a target was reached, STOP that the axis stands, SON that it is on.
#pragma once

#include <optional>
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
    bool from_rest = false;              ///< the last MS[0] before its BG has shown STOP: the next one without it is of this motion
    std::int64_t from = 0;               ///< place at its BG
    std::optional<std::int64_t> goal{};  ///< where it ends; nothing: it has no end, it was told to stop, or that place is not known
};

/// How late a status may be is not in the manual [L869-922]. A status that contradicts speed and position is not believed for this time.
inline constexpr Duration status_doubt = std::chrono::seconds(2);

class Errors : public Part {
public:
    using Part::Part;

    void on_report(const Message& m, Turn& t);  ///< CW 0F that nobody has asked for
    void on_latest(const Message& m, Turn& t);  ///< ER[0]
    void on_alarm(std::uint8_t code, Turn& t);
    void on_status(const Status& s, bool err_is_new) noexcept;
    /// The drive has refused something of ours.
    void refused_ours(const Message& m) noexcept;
    void cleared() noexcept { cause_ = Cause::none, alarm_ = latest_ = 0; }
    /// `ours`: a flag that stood before a silence was for something that it had refused: it is no fault after it. A restart clears the
    /// flag, and then it says nothing.
    void found(bool ours) noexcept { cause_ = ours ? Cause::own : Cause::none, alarm_ = 0; }

    [[nodiscard]] bool to_read() const noexcept { return to_read_; }
    void read(Turn& t);
    void read_again() noexcept { to_read_ = true; }
    void no_read() noexcept { to_read_ = false; }

    [[nodiscard]] bool ours() const noexcept { return cause_ == Cause::own; }
    [[nodiscard]] bool any_latest() const noexcept { return latest_ != 0; }
    [[nodiscard]] bool fault(const Status& s) const noexcept;
    [[nodiscard]] bool warning(const Status& s) const noexcept { return !fault(s) && (s.err || alarm_ != 0); }
    [[nodiscard]] bool at_limit() const noexcept { return alarm_ == 0x1A || alarm_ == 0x1B; }
    [[nodiscard]] std::uint16_t code(const Status& s) const noexcept { return alarm_ != 0 ? alarm_ : s.err ? latest_ : std::uint16_t{0}; }

private:
    enum class Cause : std::uint8_t { none, own, foreign };  ///< of the ERR flag
    Cause cause_ = Cause::none;
    std::uint8_t alarm_ = 0;   ///< last alarm that stands, 0: none
    std::uint8_t latest_ = 0;  ///< code of ER[0] as last read
    bool to_read_ = false;
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
    /// The motion was told to stop, or was refused.
    void no_goal() noexcept { motion_.goal.reset(); }
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
    [[nodiscard]] const Motion& motion() const noexcept { return motion_; }
    [[nodiscard]] bool status_known() const noexcept { return status_known_; }
    [[nodiscard]] bool position_known() const noexcept { return position_known_; }
    /// When the drive has said its speed and position last.
    [[nodiscard]] Instant position_at() const noexcept { return position_at_; }

private:
    void on_status(const Message& m, Turn& t);
    void on_speed(const Message& m, Turn& t);
    void on_input(const Notification& n, Turn& t);
    void on_finished(const Notification& n, Turn& t);
    void set_bit(std::uint32_t bit, bool on) noexcept { status_.raw = on ? status_.raw | bit : status_.raw & ~bit; }
    [[nodiscard]] Course course() const noexcept;
    [[nodiscard]] bool safe_stop() const noexcept;
    [[nodiscard]] bool status_is_older(Instant now) const noexcept;
    void suspect_restart(std::string why, Turn& t);

    Status status_;
    AxisFeedback fb_;
    Motion motion_;
    bool status_known_ = false, position_known_ = false;
    Instant status_at_{}, position_at_{};  ///< when MS[0] and MS[1] were said last
    bool stop_shown_ = false;              ///< by the last MS[0]
    bool rest_unread_ = false;             ///< it stands, but the last MS[1] is from when it moved
    Instant off_at_{};                     ///< our last command left SON off then; none: it left it on
    bool power_expected_ = false;          ///< MS[0] has shown SON since our last command left it on
};

}  // namespace axisgate::uim342
