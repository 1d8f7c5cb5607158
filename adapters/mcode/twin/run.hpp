// Run: the interpreter: registers, user variables, branches, calls, holds; everything else it hands to its host.
// In: compiled lines, values of words from the host, time. Out: changed values, jumps, calls of the host, MCode error codes.
// Never loops by itself: each call of `step` runs one statement, and how many are run is the host's decision.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "adapters/mcode/twin/program.hpp"
#include "gateway/core/instant.hpp"

namespace axisgate::mcode::twin {

/// What a statement asks of the drive around the interpreter.
struct Host {
    /// Value of a word that is no register; `error` stays 0 if it can be read.
    virtual Number read(Word word, int& error) = 0;
    /// Writes a word that is no register. MCode error code, 0 good.
    virtual int write(Word word, std::span<const Number> fields) = 0;
    /// Everything that is neither of the language nor a value: motion, I/O, printing, saving. Fields are already worked out.
    virtual int perform(const Statement& statement, std::span<const Number> fields) = 0;
    /// MV: motion, settling and hold delay are not over [E-21]; what H without number waits for.
    virtual bool moving() = 0;
    virtual ~Host() = default;
};

class Run {
public:
    static constexpr std::size_t stack_limit = 16;  ///< returns that are kept; the 17th is error 43. The manual gives no depth.
    static constexpr std::size_t field_limit = 8;

    enum class State : std::uint8_t { idle, running, hold_time, hold_motion };
    enum class CallKind : std::uint8_t { call, trip, error_handler };

    Run(Program& program, Host& host) : program_(program), host_(host) {}

    // --- registers
    [[nodiscard]] std::int32_t& integer(std::size_t i) noexcept { return integers_[i]; }
    [[nodiscard]] double& real(std::size_t i) noexcept { return reals_[i]; }

    /// LO has base 2, not e (E-15).
    void base_two(bool on) noexcept { base_two_ = on; }

    // --- expressions
    [[nodiscard]] Number value(const Expression& e, bool real, int& error);
    [[nodiscard]] bool holds(const Condition& c, int& error);
    /// Result of `write` for any operand that names a value: registers, user variables, words.
    [[nodiscard]] int store(Word word, const Number& n);
    [[nodiscard]] int store(SymbolId symbol, const Number& n);

    // --- a typed line: the same statements, without program counter. `program_only` ones must be refused before.
    [[nodiscard]] int execute(const Statement& s, Instant now);

    // --- program
    void start(std::size_t line);
    void stop() noexcept;
    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] bool idle() const noexcept { return state_ == State::idle; }
    [[nodiscard]] std::size_t line() const noexcept { return next_; }
    [[nodiscard]] Instant hold_until() const noexcept { return until_; }
    /// A hold that is over becomes `running`. True if the program can go on.
    bool awake(Instant now);
    /// Runs the next statement; its error code. At the end of memory the program ends.
    [[nodiscard]] int step(Instant now);
    /// Enters a subroutine from outside (trip, OE): the interrupted statement, a hold too, goes on after RT. Without a running program
    /// it starts one. 43 when the stack is full.
    [[nodiscard]] int interrupt(std::size_t line, CallKind kind);
    [[nodiscard]] bool handling_error() const noexcept;

private:
    struct Frame {
        std::uint32_t next = 0;
        State state = State::running;
        CallKind kind = CallKind::call;
        Instant until{};
        bool ends = false;  ///< there was no program: RT ends
    };

    [[nodiscard]] Number operand(const Operand& o, int& error);
    [[nodiscard]] int jump(const Statement& s, bool call);
    [[nodiscard]] int count(const Statement& s, int by);

    Program& program_;
    Host& host_;
    std::array<std::int32_t, 4> integers_{};
    std::array<double, 8> reals_{};
    bool base_two_ = false;
    State state_ = State::idle;
    std::size_t next_ = 0;
    Instant until_{};
    std::vector<Frame> stack_;  // bounded by stack_limit
};

}  // namespace axisgate::mcode::twin
