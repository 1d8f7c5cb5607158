// Coupling is the part of a simulated drive that follows the master encoder: cams, a cam that a trigger starts, and winding (definitions of
// 06h, 11h, 12h, 30h and 31h). It gives the position that belongs to the encoder's count, and the instants at which a count has an effect.
// It is inactive until a command starts it. Errors 0062h and 0089h.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "adapters/linmot/twin/curves.hpp"
#include "adapters/linmot/twin/master.hpp"

namespace axisgate::linmot::twin {

class Coupling {
public:
    enum class Mode : std::uint8_t { none, cams, shot, winding };
    /// The result of a step: none, the end of the cam that a trigger has started, the end of "cam enabled".
    enum class Passed : std::uint8_t { nothing, shot_over, released };
    struct Step {
        Passed what = Passed::nothing;
        std::optional<double> place;  ///< the position at which it rests; empty: the present demand
    };

    Coupling(Memory& memory, const MasterEncoder& master, const Curves& curves, const Winding& winding)
        : memory_(memory), master_(master), curves_(curves), winding_(winding) {}

    [[nodiscard]] Mode mode() const noexcept { return mode_; }
    /// Whether the demand depends on the count: with cams, while "cam enabled" is set.
    [[nodiscard]] bool active() const noexcept { return mode_ == Mode::cams ? memory_.ram(0x1BA9) != 0 : mode_ != Mode::none; }
    [[nodiscard]] bool cams_used() const noexcept { return cams_[0].used() || cams_[1].used(); }
    /// While it is active. Empty: the count is not known yet, or a curve was deleted; the demand rests.
    [[nodiscard]] std::optional<Point> at(Instant now) const;
    /// The position that belongs to a count.
    [[nodiscard]] std::optional<Followed> place(double count) const;
    /// The next instant at which a count has an effect: the start of a cam that a command waits for, or the end of a cam that a trigger has
    /// started.
    [[nodiscard]] Instant due(Instant now) const;

    void power_on() noexcept { cams_ = {}; }
    void begin(Mode mode, Instant now) noexcept { mode_ = mode, count_ = master_.count(now); }
    void end() noexcept { mode_ = Mode::none; }
    /// The effects of the counts between the last step and now.
    [[nodiscard]] Step step(Instant now);
    /// The count was redefined; no count was passed.
    void renamed(Instant now) noexcept { count_ = master_.count(now); }

    // --- definitions; with an error nothing is defined ---
    /// 1y0..1y8 of cam 0 or 1; `actual`: the position of the slider, 0.1 um.
    [[nodiscard]] Fault define(std::size_t cam, std::uint8_t sub, const Bytes& b, double actual);
    /// 069..06E: curve and delay are stored in their parameters, from which each edge takes them.
    [[nodiscard]] Fault preset(std::uint8_t sub, const Bytes& b);
    /// The cam that a trigger starts, or 064 which starts at once; `here`: the demand, 0.1 um.
    [[nodiscard]] Fault prepare_shot(std::uint8_t sub, const Bytes& b, double here, Instant now);
    /// 300, 310 start at once, 301, 311 at a revolution [L3128-3160].
    [[nodiscard]] Fault prepare_winding(std::uint16_t header, const Bytes& b, Instant now);
    /// 304, 305: holds and continues the adaptation of ends and disturbance.
    void hold_adaptation(bool hold, Instant now);
    [[nodiscard]] static bool rising(std::uint8_t sub) noexcept { return sub == 9 || sub == 0x0A || sub == 0x0D; }

private:
    static constexpr std::size_t shot = 2;  ///< the cam that a trigger starts
    [[nodiscard]] std::span<const Cam> cams() const noexcept;
    [[nodiscard]] CamRange range() const noexcept { return CamRange::of(cams(), memory_.ram(0x1527) != 0); }
    [[nodiscard]] double per_turn() const noexcept;
    [[nodiscard]] static Fault lay(Cam& cam, const Curve& of, double from, double to) noexcept;

    Memory& memory_;
    const MasterEncoder& master_;
    const Curves& curves_;
    const Winding& winding_;
    Mode mode_ = Mode::none;
    std::array<Cam, 3> cams_{};
    double count_ = 0;       ///< at the last step
    double wound_from_ = 0;  ///< count at which winding begins
    std::uint16_t wound_curve_ = 0;
    double adaptation_lost_ = 0;  ///< counts during which the adaptation was held
    std::optional<double> adaptation_held_;
};

}  // namespace axisgate::linmot::twin
