// Limits: the soft limits LS and what holds a direction; and Cams: the switches that the tester's hand puts beside the axis.
// In: places, LS, inputs. Out: which direction is closed, instants at which a limit or a switch is met.
// Never stops a motion: that is the answer of LM.
#pragma once

#include <array>
#include <optional>

#include "adapters/mcode/twin/io.hpp"
#include "adapters/mcode/twin/shaft.hpp"

namespace axisgate::mcode::twin {

class Limits {
public:
    Limits(const Shaft& shaft, const Inputs& inputs) : shaft_(shaft), inputs_(inputs) {}

    /// LS=n,position,on: 0 minus, 1 plus.
    [[nodiscard]] int set_up(std::span<const std::int64_t> fields);
    [[nodiscard]] std::string text() const;
    void factory() noexcept { soft_ = {}; }
    void save(NonVolatile& m) const;
    void load(const NonVolatile& m);

    /// The error of a motion in this direction (1, -1) from here; 0: it is free.
    [[nodiscard]] int held(int way, Instant now) const noexcept;
    /// When the present motion meets a soft limit.
    [[nodiscard]] Instant crossing(Instant now) const noexcept;

private:
    struct Soft {
        double position = 0;
        bool on = false;
    };
    const Shaft& shaft_;
    const Inputs& inputs_;
    std::array<Soft, 2> soft_{};  ///< minus, plus
};

class Cams {
public:
    static constexpr std::array types{InputType::limit_minus, InputType::limit_plus, InputType::home};

    /// `hysteresis`, in turns: a closed switch opens this much behind the place where it has closed.
    Cams(const Shaft& shaft, Inputs& inputs, double hysteresis);

    /// Where the switch of this type begins, in turns of the shaft; nothing: there is none.
    [[nodiscard]] std::optional<double> place(std::size_t cam) const noexcept { return cams_[cam].turns; }
    void place(std::size_t cam, std::optional<double> turns, Instant now);
    [[nodiscard]] bool active(std::size_t cam, Instant now) const noexcept;
    /// Switches that stand beside the axis hold their input from now on, also where an open one would be active.
    void hold(Instant now);
    void judge(Instant now);
    /// The inputs have forgotten what they were.
    void anew(Instant now);
    [[nodiscard]] Instant crossing(Instant now) const noexcept;

private:
    struct Cam {
        std::optional<double> turns;
        bool was = false;
    };
    const Shaft& shaft_;
    Inputs& inputs_;
    double gap_;
    std::array<Cam, types.size()> cams_{};
};

}  // namespace axisgate::mcode::twin
