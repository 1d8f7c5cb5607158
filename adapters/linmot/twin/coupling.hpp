// What follows the master encoder of a simulated drive: cams, a cam on a trigger, winding.
// In: definitions of 06h, 11h, 12h, 30h and 31h, the encoder's count. Out: the place that belongs to it, when a count matters.
// Never moves because an encoder turns, unless it has been begun.
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
    /// What a step has brought: nothing, the end of the cam that a trigger started, the end of "cam enabled".
    enum class Passed : std::uint8_t { nothing, shot_over, released };
    struct Step {
        Passed what = Passed::nothing;
        std::optional<double> place;  ///< where it rests then; nothing: where the demand is
    };

    Coupling(Memory& memory, const MasterEncoder& master, const Curves& curves, const Winding& winding)
        : memory_(memory), master_(master), curves_(curves), winding_(winding) {}

    [[nodiscard]] Mode mode() const noexcept { return mode_; }
    /// Whether the demand belongs to the count: cams do so while "cam enabled" is set.
    [[nodiscard]] bool active() const noexcept { return mode_ == Mode::cams ? memory_.ram(0x1BA9) != 0 : mode_ != Mode::none; }
    [[nodiscard]] bool cams_used() const noexcept { return cams_[0].used() || cams_[1].used(); }
    /// While it is active. Nothing: the count is not there yet, or a curve has gone; the demand rests.
    [[nodiscard]] std::optional<Point> at(Instant now) const;
    /// The place that belongs to a count.
    [[nodiscard]] std::optional<Followed> place(double count) const;
    /// The next instant at which a count matters: the start of a cam on which something waits, the end of one that a trigger started.
    [[nodiscard]] Instant due(Instant now) const;

    void power_on() noexcept { cams_ = {}; }
    void begin(Mode mode, Instant now) noexcept { mode_ = mode, count_ = master_.count(now); }
    void end() noexcept { mode_ = Mode::none; }
    /// What the way from the last look to now has passed.
    [[nodiscard]] Step step(Instant now);
    /// The count has another name: nothing was passed.
    void renamed(Instant now) noexcept { count_ = master_.count(now); }

    // --- definitions; with an error nothing is defined ---
    /// 1y0..1y8 of cam 0 or 1; `actual`: where the slider is, 0.1 um.
    [[nodiscard]] Fault define(std::size_t cam, std::uint8_t sub, const Bytes& b, double actual);
    /// 069..06E: curve and delay go into their parameters, from where each edge takes them.
    [[nodiscard]] Fault preset(std::uint8_t sub, const Bytes& b);
    /// The cam that a trigger starts, or 064 at once; `here`: the demand, 0.1 um.
    [[nodiscard]] Fault prepare_shot(std::uint8_t sub, const Bytes& b, double here, Instant now);
    /// 300, 310 at once, 301, 311 from a revolution on [L3128-3160].
    [[nodiscard]] Fault prepare_winding(std::uint16_t header, const Bytes& b, Instant now);
    /// 304, 305: the adaptation of ends and disturbance is held, and goes on.
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
    double count_ = 0;       ///< at the last look
    double wound_from_ = 0;  ///< count at which winding begins
    std::uint16_t wound_curve_ = 0;
    double adaptation_lost_ = 0;  ///< counts in which adaptation stood still
    std::optional<double> adaptation_held_;
};

}  // namespace axisgate::linmot::twin
