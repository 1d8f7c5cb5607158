// Coupling connects the axes with their masters: the master encoders and their substitutes, markers, and the synchronisation of each axis.
// It does not move an axis that does not take orders.
#pragma once

#include <array>
#include <string>

#include "adapters/aposs/twin/axis.hpp"
#include "adapters/aposs/twin/virtual_master.hpp"

namespace axisgate::aposs {

class Coupling {
public:
    using Axes = std::array<MacsAxis*, axes>;
    Coupling(const Axes& of, const Terminals& terminals) : axes_(of), terminals_(terminals) {}

    void power_on(Instant now);
    /// Empty, or why it is refused.
    [[nodiscard]] std::string synchronise(int axis, SyncMode mode, Instant now);
    void end(int axis) { sync_.at(static_cast<std::size_t>(axis)).end(); }
    [[nodiscard]] bool leads(int axis) const { return of(axis).mode() != SyncMode::none; }
    [[nodiscard]] const Synchronisation& of(int axis) const { return sync_.at(static_cast<std::size_t>(axis)); }
    [[nodiscard]] Synchronisation& of(int axis) { return sync_.at(static_cast<std::size_t>(axis)); }

    /// The counts of the axis' master in whole qc. The master is the simulation, the command position of another axis, the virtual master
    /// while it runs, or an encoder: that of another axis (MENCODERTYPE 10, 20), or its own, which at the second axis is turned by the
    /// shaft of the first one. A change of the source makes the position jump; with MENCCONTROL bit 0 it continues from the previous
    /// position, as a linked command value does without it [L4800, L5889]. The virtual master replaces the encoder without a jump (E-81).
    [[nodiscard]] std::int64_t master(int axis, Instant now);
    /// DEFMORIGIN: the present position becomes 0. Without MENCCONTROL bit 1 the encoder itself is set to 0, for every axis that uses it
    /// [L5889-5925].
    void define_master_origin(int axis, Instant now);
    /// DEFORIGIN, in the same way with ENCCONTROL bit 1.
    void define_origin(int axis, Instant now);
    /// SET ENCODERTYPE: passed markers are forgotten [L4438].
    void forget_markers(int axis, Instant now);
    /// Turns of the master's encoder by hand, qc, in addition to its counts.
    std::array<std::int64_t, axes> by_hand{};

    void simulate(int axis, std::int64_t qc_per_ms, Instant now);  ///< SYSVAR 4105 was written
    [[nodiscard]] std::int64_t simulated(int axis, Instant now) const;
    void stop_simulation(Instant now);
    [[nodiscard]] VirtualMaster& virtual_master() noexcept { return virtual_; }

    [[nodiscard]] bool ticks() const;
    void tick(Instant at);

private:
    enum class Source : std::uint8_t { encoder, simulation, command, virtual_master };
    struct Origin {
        Source source = Source::encoder;
        int number = 0;  ///< encoder: that of this axis, 0 or 3: its own input; command value: that axis
        bool operator==(const Origin&) const = default;
    };
    struct Master {
        Origin from;
        std::int64_t count = 0, seen = 0;
        std::int64_t before = 0;  ///< position at the previous step, for markers
        std::int64_t zero = 0;    ///< of its own encoder: the position that was set to 0
    };
    /// Markers that are known without SYNCM.
    struct Known {
        double from = 0;  ///< position when markers were forgotten
        std::optional<std::int64_t> master;
        std::optional<double> slave;
    };
    struct Simulation {
        std::int64_t place = 0, speed = 0;  ///< qc, qc per ms
        Instant since{};
    };
    [[nodiscard]] Origin source_of(int axis) const;
    [[nodiscard]] std::int64_t raw(const Origin& from, int axis, Instant now) const;
    [[nodiscard]] std::int64_t turned(int axis, Instant now) const;  ///< its own encoder, turned by the shafts and by hand
    [[nodiscard]] SyncInput input(int axis, Instant at);
    [[nodiscard]] bool watches(int axis) const;
    [[nodiscard]] double master_index(int axis) const;
    [[nodiscard]] double slave_index(int axis) const;
    void remember(int axis, SyncInput& here) const;
    /// Whether a marker of this kind has passed since the last step: an index pulse between two positions, or the edge of an input.
    [[nodiscard]] bool edge(const MarkerCode& code, int own_input) const;

    Axes axes_;
    const Terminals& terminals_;
    std::array<Synchronisation, axes> sync_;
    std::array<Master, axes> masters_;
    std::array<Simulation, axes> simulations_;
    std::array<double, axes> slave_before_{};
    std::array<Known, axes> known_;
    std::uint32_t inputs_before_ = 0;
    VirtualMaster virtual_;
};

/// The index pulse between two positions, if there was one; index pulses are at multiples of a distance.
[[nodiscard]] std::optional<double> index_between(double before, double after, double distance);

}  // namespace axisgate::aposs
