// Coupling: what leads the axes: their master encoders with all that can stand for one, markers, and the synchronisation of each.
// In: statements, terminals, milliseconds. Out: the way of a slave. Never moves an axis that does not take orders.
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
    /// Empty, or why not.
    [[nodiscard]] std::string synchronise(int axis, SyncMode mode, Instant now);
    void end(int axis) { sync_.at(static_cast<std::size_t>(axis)).end(); }
    [[nodiscard]] bool leads(int axis) const { return of(axis).mode() != SyncMode::none; }
    [[nodiscard]] const Synchronisation& of(int axis) const { return sync_.at(static_cast<std::size_t>(axis)); }
    [[nodiscard]] Synchronisation& of(int axis) { return sync_.at(static_cast<std::size_t>(axis)); }

    /// Counts of the axis' master, whole qc: of the simulation, of another axis' command, of the virtual master while it runs, or of an
    /// encoder: that of another axis (MENCODERTYPE 10, 20), or its own, which at the second axis is turned by the first one's shaft.
    /// Another source is what it is, or with MENCCONTROL bit 0 goes on from where the one before was, as a linked command value does
    /// without [L4800, L5889]; the virtual master takes the encoder's place and does not jump either (E-81).
    [[nodiscard]] std::int64_t master(int axis, Instant now);
    /// DEFMORIGIN: 0 from here on; without MENCCONTROL bit 1 it is the encoder that is set to 0, for whoever has it too [L5889-5925].
    void define_master_origin(int axis, Instant now);
    /// DEFORIGIN, likewise by ENCCONTROL bit 1.
    void define_origin(int axis, Instant now);
    /// SET ENCODERTYPE: which markers have passed is forgotten [L4438].
    void forget_markers(int axis, Instant now);
    /// The master's encoder turned by hand, qc, beside what it counts.
    std::array<std::int64_t, axes> by_hand{};

    void simulate(int axis, std::int64_t qc_per_ms, Instant now);  ///< SYSVAR 4105 written
    [[nodiscard]] std::int64_t simulated(int axis, Instant now) const;
    void stop_simulation(Instant now);
    [[nodiscard]] VirtualMaster& virtual_master() noexcept { return virtual_; }

    [[nodiscard]] bool ticks() const;
    void tick(Instant at);

private:
    enum class Source : std::uint8_t { encoder, simulation, command, virtual_master };
    struct Origin {
        Source source = Source::encoder;
        int number = 0;  ///< of an encoder: that of this axis, 0 or 3: its own input; of a command value: that axis
        bool operator==(const Origin&) const = default;
    };
    struct Master {
        Origin from;
        std::int64_t count = 0, seen = 0;
        std::int64_t before = 0;  ///< at the step before, for markers
        std::int64_t zero = 0;    ///< of its own encoder: where it was set to 0
    };
    /// What of markers is remembered without SYNCM.
    struct Known {
        double from = 0;  ///< place when it was forgotten
        std::optional<std::int64_t> master;
        std::optional<double> slave;
    };
    struct Simulation {
        std::int64_t place = 0, speed = 0;  ///< qc, qc per ms
        Instant since{};
    };
    [[nodiscard]] Origin source_of(int axis) const;
    [[nodiscard]] std::int64_t raw(const Origin& from, int axis, Instant now) const;
    [[nodiscard]] std::int64_t turned(int axis, Instant now) const;  ///< its own encoder, by the shafts and by hand
    [[nodiscard]] SyncInput input(int axis, Instant at);
    [[nodiscard]] bool watches(int axis) const;
    [[nodiscard]] double master_index(int axis) const;
    [[nodiscard]] double slave_index(int axis) const;
    void remember(int axis, SyncInput& here) const;
    /// Whether a marker of this kind has passed since the last step on the way between two places; the edge of an input.
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

/// The index pulse that was passed between two places, if one was: they are at multiples of a distance.
[[nodiscard]] std::optional<double> index_between(double before, double after, double distance);

}  // namespace axisgate::aposs
