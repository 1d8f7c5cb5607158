// Drive is a simulated drive without its line: it connects its parts, and advance() carries out, in order, all events that were due since
// the last call. States: states.hpp; motion commands: commands.hpp; demand and its sources: demand.hpp; slider: follower.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "adapters/linmot/twin/commands.hpp"

namespace axisgate::linmot::twin {

class Drive {
public:
    using Outside = twin::Outside;

    explicit Drive(const DriveSetup& setup) : body_(setup, memory, table, curves) {}
    Drive(const Drive&) = delete;
    Drive& operator=(const Drive&) = delete;

    // --- power, software ------------------------------------------------------------------------------------------------
    void power_on(Instant now);
    void stop_software(Instant now);
    void start_software(Instant now);
    [[nodiscard]] bool software_runs() const noexcept { return states_.running(); }

    // --- from the line --------------------------------------------------------------------------------------------------
    void write_control_word(std::uint16_t word, Instant now);
    /// Writes the bytes of a telegram into the buffer; the command is executed if its count differs from the last one [L545-547].
    void write_motion_command(std::span<const std::uint8_t> bytes, Instant now);
    void advance(Instant now);
    /// The next instant at which the state changes without a request, or `never`.
    [[nodiscard]] Instant next_event() const;

    /// The earliest instant after the last advance at which status word, StateVar or warn word may change without a request; `look` is the
    /// period of changes that have no closed form.
    [[nodiscard]] Instant words_due(Duration look) const;

    // --- state, at the instant of the last advance ----------------------------------------------------------------------
    [[nodiscard]] std::uint16_t status_word() const { return states_.status_word(now_); }
    [[nodiscard]] std::uint16_t state_var() const { return states_.state_var(now_); }
    [[nodiscard]] std::uint16_t warn_word() const { return states_.warn_word(now_); }
    [[nodiscard]] std::uint8_t state() const noexcept { return states_.state(); }
    [[nodiscard]] std::uint16_t error_code() const noexcept { return states_.error_code(); }
    [[nodiscard]] double actual() const { return body_.follower.actual(now_).position; }
    [[nodiscard]] double demand() const { return states_.demand(now_); }
    [[nodiscard]] Point mechanics() const { return body_.follower.place(now_); }
    [[nodiscard]] bool powered() const noexcept { return states_.powered(); }
    [[nodiscard]] std::uint16_t control_word() const noexcept { return states_.control_word(); }
    [[nodiscard]] std::uint32_t ram(std::uint16_t upid) const;
    [[nodiscard]] std::uint16_t outputs_x4() const noexcept { return commands_.outputs_x4(); }
    [[nodiscard]] std::uint16_t outputs_x6() const noexcept { return commands_.outputs_x6(); }
    [[nodiscard]] std::uint64_t commands_done() const noexcept { return commands_.commands_done(); }
    /// The count of the master encoder in the drive [L4403-4470].
    [[nodiscard]] double master() const { return body_.master.count(now_); }
    /// The controlled force, 0.1 N; empty: the position is controlled.
    [[nodiscard]] std::optional<double> held_force() const { return body_.force.held(); }
    [[nodiscard]] double encoder_edges() const { return body_.master.edges(now_); }

    // --- the simulated hand ---------------------------------------------------------------------------------------------
    [[nodiscard]] const Outside& outside() const noexcept { return body_.outside; }
    void set_outside(const Outside& outside, Instant now);
    void trigger(bool rising, Instant now);
    void capture(Instant now);
    void move_by_hand(double physical, Instant now);
    void inject(std::uint16_t code, Instant now);

    Memory memory;
    TableEntries table;
    Curves curves;

    /// Whether this drive has the command; the count in the header is 0.
    [[nodiscard]] bool has(std::uint16_t header) const noexcept { return commands_.has(header); }
    [[nodiscard]] static bool listed(std::uint16_t header) noexcept { return Interpreter::listed(header); }

private:
    [[nodiscard]] Instant due() const;
    [[nodiscard]] bool crossed(Instant now) const;
    [[nodiscard]] double shown_current() const;  ///< mA
    void handle(Instant now);
    [[nodiscard]] Fault limit_passed(Instant now) const;

    Body body_;
    States states_{body_};
    Interpreter commands_{body_, states_};
    Instant now_{};
    double current_from_ = 0;  ///< mA
    Instant current_since_{};
};

}  // namespace axisgate::linmot::twin
