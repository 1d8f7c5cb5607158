// Orders of a simulated servo: what each mode of operation does with its targets: 1, 3, 4, 7, 8, 9 and 10.
// In: objects, a mode, halts. Out: orders to the mechanics, and the bits of the status word that are the modes'. Whoever calls it has seen
// that the servo is enabled. Never changes a state.
#pragma once

#include <optional>

#include "adapters/cia402/twin/mechanics.hpp"
#include "adapters/cia402/twin/units.hpp"

namespace axisgate::cia402_drive::twin {

class Orders {
public:
    Orders(AxisObjects& objects, UserUnits& units, Mechanics& mechanics) : o_(objects), u_(units), m_(mechanics) {}
    Orders(const Orders&) = delete;  // it stands on its neighbours in the servo
    Orders& operator=(const Orders&) = delete;

    [[nodiscard]] int mode() const noexcept { return mode_; }
    void reset(int mode);
    void forget();              ///< no target is under way
    void enabled(unsigned cw);  ///< halt and acknowledge as the control word has them
    void taken_off();           ///< without power nothing is halted either
    /// True: the mode is another one.
    bool set_mode(int mode);

    void act(Instant now);  ///< what the mode does with its targets now
    void set_point(bool relative, bool at_once, Instant now);
    void sync(unsigned cw, Instant now);
    void halt(bool on, Instant now);
    /// Bit 4 of the control word is away: the next set-point may come.
    void released() { acknowledged_ = buffered_.has_value(); }
    void limit_switch() {
        limited_ = true;
        target_.reset();
    }

    /// At the end of its way a positioning is reached, or the buffered one begins.
    void arrive(unsigned cw, Instant at);
    /// When it arrives; nothing: there is nothing to arrive.
    [[nodiscard]] std::optional<Instant> arrival() const;

    [[nodiscard]] bool halted() const noexcept { return halted_; }
    [[nodiscard]] bool acknowledged() const noexcept { return acknowledged_; }
    [[nodiscard]] bool limited() const noexcept { return limited_; }
    [[nodiscard]] bool reached() const { return reached_ && (!m_.held() || settles()); }
    /// Reached is what two readings say that are the window's time (6068h) apart and differ by less than this, increments; nothing: what
    /// has been within the window for that time, as CiA 402 has it.
    std::optional<double> readings_within;
    [[nodiscard]] bool reads() const noexcept { return reading_.has_value(); }
    void set_reached(bool reached) noexcept { reached_ = reached; }
    /// 1/1000 of the rated torque that the drive pushes with.
    [[nodiscard]] double torque(Instant now) const { return m_.pushed(now) / per_mille; }

private:
    static constexpr double per_mille = 50;  ///< increments/s^2 that 1/1000 of the rated torque gives this load
    void go(Instant now);
    [[nodiscard]] bool settles() const;
    [[nodiscard]] bool in_window(Instant at) const;
    void take_reading(Instant at);
    [[nodiscard]] Duration window_time() const { return std::chrono::milliseconds(o_.get(0x6068)); }
    AxisObjects& o_;
    UserUnits& u_;
    Mechanics& m_;
    int mode_ = 1;
    bool halted_ = false, reached_ = false, acknowledged_ = false, limited_ = false;
    std::optional<double> target_;    ///< of the positioning under way, mechanical
    std::optional<double> buffered_;  ///< the next one, mechanical
    struct Step {
        double to;
        Instant at;
    };
    std::optional<Step> step_;       ///< of a cyclic mode, the last one
    std::optional<double> reading_;  ///< the first of two
    Instant reading_at_{};
};

}  // namespace axisgate::cia402_drive::twin
