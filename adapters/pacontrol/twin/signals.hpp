// Inputs, outputs, flags, N and R as the control has them: with the wire of the external stop, the outputs that tell of readiness and
// malfunction, and a memory.
// In: values, memory. Out: values. Never does what a change of them causes: that is the control's.
#pragma once

#include "adapters/pacontrol/twin/elements.hpp"
#include "adapters/pacontrol/twin/memory.hpp"
#include "adapters/pacontrol/twin/parameters.hpp"
#include "adapters/pacontrol/twin/system_error.hpp"

namespace axisgate::pacontrol::twin {

class Signals {
public:
    /// `made`: how many of each there are. `system` names the input of the external stop and the two outputs.
    /// `scan`: inputs and outputs are shown as they were at its last multiple; 0: as they are.
    Signals(const Elements& made, const SystemParameters& system, const SystemError& error, Duration scan = {})
        : elements_(made), system_(system), error_(error), period_(scan), inputs_(made.inputs.count()), outputs_(made.outputs.count()) {}

    [[nodiscard]] const Elements& elements() const noexcept { return elements_; }
    /// Input `n` as the control sees it: its level, and for the stop input the wire of the external stop.
    [[nodiscard]] bool input(std::int64_t n) const noexcept;
    [[nodiscard]] bool output(std::int64_t n) const noexcept;
    /// As the commands tell them, as of the last `scan`.
    [[nodiscard]] bool shown_input(std::int64_t n) const noexcept { return period_ == Duration::zero() ? input(n) : inputs_.get(n); }
    [[nodiscard]] bool shown_output(std::int64_t n) const noexcept { return period_ == Duration::zero() ? output(n) : outputs_.get(n); }
    /// To be called before inputs and outputs change, and before they are shown.
    void scan(Instant now) noexcept;
    [[nodiscard]] bool external_stop_wire() const noexcept { return external_stop_; }
    /// A stop input is defined and carries power.
    [[nodiscard]] bool external_stop_powered() const noexcept;
    /// A stop input is defined and carries none.
    [[nodiscard]] bool external_stop_open() const noexcept;

    void set_input(std::int64_t n, bool on) noexcept { elements_.inputs.set(n, on); }
    void set_external_stop(bool powered) noexcept { external_stop_ = powered; }
    void set_output(std::int64_t n, bool on) noexcept { elements_.outputs.set(n, on); }
    void set_output_word(std::int64_t n, std::uint16_t word) noexcept { elements_.outputs.set_word_of(n, word); }
    void set_flag(std::int64_t n, bool on) noexcept;
    void set_flag_word(std::int64_t n, std::uint16_t word) noexcept;
    void set_n(std::int64_t n, std::int32_t v) noexcept;
    void set_r(std::int64_t n, float v) noexcept;

    // --- memory: flags, N and R ---
    void keep(Memory& memory) const;
    /// False: it is not one of these.
    bool restore(std::string_view name, const Value& value);
    /// All but the inputs and the wire, which are outside, are as at first.
    void forget();
    [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

private:
    Elements elements_;
    const SystemParameters& system_;
    const SystemError& error_;
    bool external_stop_ = true;
    std::uint64_t revision_ = 0;
    Duration period_;
    Instant scanned_ = Instant::min();
    Bits inputs_, outputs_;  ///< at the last scan
};

}  // namespace axisgate::pacontrol::twin
