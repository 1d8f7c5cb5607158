// The force limits of 38h: a motion continues until the measured force exceeds a limit; from then on the force is controlled.
#pragma once

#include <cstdint>
#include <optional>

#include "adapters/linmot/twin/bytes.hpp"
#include "adapters/linmot/twin/order.hpp"

namespace axisgate::linmot::twin {

/// Forces in 0.1 N.
class ForceWatch {
public:
    /// The controlled force; empty: the position is controlled.
    [[nodiscard]] std::optional<double> held() const noexcept { return controls_ ? std::optional(target_) : std::nullopt; }
    void end() noexcept { watches_ = controls_ = false; }
    void end_watch() noexcept { watches_ = false; }
    void retarget(double force) noexcept {
        if (controls_) target_ = force;
    }
    /// 380, 383 from below, 384, 385 from above; 383 and 385 control another force than the limit.
    void watch(std::uint8_t sub, const Bytes& b) {
        higher_ = sub == 0 || sub == 3;
        limit_ = at16(b, 14);
        target_ = sub == 3 || sub == 5 ? at16(b, 16) : limit_;
        watches_ = true;
        controls_ = false;
    }
    /// Whether the limit is exceeded; if so, the force is controlled from now on.
    bool reached(double force) noexcept {
        if (!watches_ || (higher_ ? force < limit_ : force > limit_)) return false;
        watches_ = false;
        return controls_ = true;
    }

private:
    bool watches_ = false, higher_ = true, controls_ = false;
    double limit_ = 0, target_ = 0;
};

}  // namespace axisgate::linmot::twin
