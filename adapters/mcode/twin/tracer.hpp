// Tracer: how a stored program is run: at once, shown line by line, or step by step, with one break point.
// In: the modes of EX, BP, the keys space and enter. Out: which lines are shown, and where the program waits.
// Never runs a line.
#pragma once

#include <algorithm>

#include "adapters/mcode/twin/comm.hpp"
#include "adapters/mcode/twin/errors.hpp"
#include "adapters/mcode/twin/program.hpp"

namespace axisgate::mcode::twin {

class Tracer {
public:
    enum class Mode : std::uint8_t { normal, trace, step };

    Tracer(const Program& program, Comm& comm) : program_(program), comm_(comm) {}

    void run_as(Mode mode) noexcept {
        mode_ = mode;
        comm_.stepping(mode == Mode::step);
    }
    void step(bool now) noexcept { step_now_ = now; }
    [[nodiscard]] bool shows() const noexcept { return mode_ != Mode::normal; }
    [[nodiscard]] bool steps() const noexcept { return mode_ == Mode::step; }
    /// For the key of the next step.
    [[nodiscard]] bool waits() const noexcept { return steps() && !step_now_; }

    /// BP with a place: 0 takes it out.
    [[nodiscard]] int set_break(const Target& at, std::span<const Number> fields) {
        int error = 0;
        if (at.label == no_symbol && at.address == 0 && !at.missing_name) {
            break_at_.reset();
            return 0;
        }
        if (program_.find(at, error) < 0) return error;
        break_at_ = at;
        break_count_ = fields.empty() ? 1 : std::max<std::int64_t>(fields[0].as_integer(), 1);
        return 0;
    }
    void clear_break() noexcept { break_at_.reset(); }
    /// The break point is reached before this line: single steps from here.
    [[nodiscard]] bool breaks_at(std::size_t line) {
        int unknown = 0;
        if (!break_at_ || mode_ != Mode::trace || program_.find(*break_at_, unknown) != static_cast<std::int32_t>(line)) return false;
        if (--break_count_ > 0) return false;
        run_as(Mode::step);
        return true;
    }

private:
    const Program& program_;
    Comm& comm_;
    Mode mode_ = Mode::normal;
    bool step_now_ = false;
    std::optional<Target> break_at_;
    std::int64_t break_count_ = 0;
};

}  // namespace axisgate::mcode::twin
