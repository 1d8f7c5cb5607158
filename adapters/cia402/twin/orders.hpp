// Orders carries out the targets of the modes 1, 3, 4, 7, 8, 9 and 10 of a simulated servo, and sets the mode-specific bits of the status
// word. The caller makes sure that the servo is enabled. The state of the servo is never changed here.
#pragma once

#include <optional>

#include "adapters/cia402/twin/mechanics.hpp"
#include "adapters/cia402/twin/units.hpp"

namespace axisgate::cia402_drive::twin {

class Orders {
public:
    Orders(AxisObjects& objects, UserUnits& units, Mechanics& mechanics) : o_(objects), u_(units), m_(mechanics) {}
    Orders(const Orders&) = delete;  // it refers to other members of the servo
    Orders& operator=(const Orders&) = delete;

    [[nodiscard]] int mode() const noexcept { return mode_; }
    void reset(int mode);
    void forget();              ///< no target is in progress
    void enabled(unsigned cw);  ///< takes halt and acknowledgement from the control word
    void taken_off();           ///< without power, nothing is halted either
    /// True: the mode has changed.
    bool set_mode(int mode);

    void act(Instant now);  ///< carries out the targets in the present mode
    void set_point(bool relative, bool at_once, Instant now);
    void sync(unsigned cw, Instant now);
    void halt(bool on, Instant now);
    /// Bit 4 of the control word is 0: the next set-point is accepted.
    void released() { acknowledged_ = buffered_.has_value(); }
    [[nodiscard]] bool buffers() const noexcept { return buffered_.has_value(); }
    void limit_switch() {
        limited_ = true;
        target_.reset();
    }

    /// The positioning has ended: the target is reached, or the buffered one begins.
    void arrive(unsigned cw, Instant at);
    /// When the positioning ends; empty: none is in progress.
    [[nodiscard]] std::optional<Instant> arrival() const;

    [[nodiscard]] bool halted() const noexcept { return halted_; }
    [[nodiscard]] bool acknowledged() const noexcept { return acknowledged_; }
    [[nodiscard]] bool limited() const noexcept { return limited_; }
    [[nodiscard]] bool reached() const { return reached_ && (!m_.held() || settles()); }
    /// If set, "target reached" is determined by two readings that are the window time (6068h) apart and differ by less than this,
    /// increments; else, as in CiA 402, by a position within the window for that time.
    std::optional<double> readings_within;
    [[nodiscard]] bool reads() const noexcept { return reading_.has_value(); }
    void set_reached(bool reached) noexcept { reached_ = reached; }
    /// The present torque in 1/1000 of the rated torque.
    [[nodiscard]] double torque(Instant now) const { return m_.pushed(now) / per_mille; }
    /// 7, 8, 9 or 10, and not halted: it waits for targets.
    [[nodiscard]] bool cyclic() const noexcept { return mode_ >= 7 && !halted_; }
    /// Time between two targets by 60C2h, in seconds.
    [[nodiscard]] double target_time() const;
    /// Time between two SYNCs: 1006h, or that between the last two; zero before there were two.
    [[nodiscard]] Duration sync_time() const;
    bool knows_target_time = true;  ///< there is a 60C2h; otherwise each SYNC has a target

private:
    static constexpr double per_mille = 50;  ///< acceleration of this load by 1/1000 of the rated torque, increments/s^2
    void go(Instant now);
    [[nodiscard]] bool settles() const;
    [[nodiscard]] bool in_window(Instant at) const;
    void take_reading(Instant at);
    void take_look(Instant at);
    [[nodiscard]] Duration window_time() const { return std::chrono::milliseconds(o_.get(0x6068)); }
    AxisObjects& o_;
    UserUnits& u_;
    Mechanics& m_;
    int mode_ = 1;
    bool halted_ = false, reached_ = false, acknowledged_ = false, limited_ = false;
    std::optional<double> target_;    ///< of the positioning in progress, mechanical
    std::optional<double> buffered_;  ///< the next one, mechanical
    struct Step {
        double to;
        Instant at;
    };
    std::optional<Step> step_;       ///< the last step of a cyclic mode
    std::optional<double> reading_;  ///< the first of two readings
    Instant reading_at_{};
    Instant looked_at_{};            ///< a shaft that differs from its demand: when its position was compared with the window
    std::optional<Instant> inside_;  ///< since when it has been within the window
    Instant sync_at_ = never;
    Duration between_syncs_{};
};

}  // namespace axisgate::cia402_drive::twin
