// Mechanism: what the language needs of the motor, its encoder and its inputs and outputs.
// In: words with worked-out fields, time. Out: values, MCode error codes, events in order.
// Never knows labels, programs or text lines: a trip is a condition here, and its subroutine is the language's.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adapters/mcode/twin/manners.hpp"
#include "adapters/mcode/twin/value.hpp"
#include "adapters/mcode/twin/words.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate::mcode::twin {

/// What kind of drive it is.
struct MechanismSetup {
    std::uint8_t product = lmdc;
    int frame_size = 23;  ///< NEMA 17, 23 or 34; 17 has fewer inputs and outputs [L6919]
    MotorManners manners{};
};

/// The trips, in the order of their bits in TE.
inline constexpr std::array trip_words{Word::TI, Word::TP, Word::TC, Word::TT, Word::TR, Word::TA, Word::TM};
/// Its place in `trip_words`; past the end: no trip.
[[nodiscard]] constexpr std::size_t trip_index(Word w) noexcept {
    return static_cast<std::size_t>(std::ranges::find(trip_words, w) - trip_words.begin());
}

struct MotorEvent {
    enum class Kind : std::uint8_t {
        error,        ///< `code` is raised
        finished,     ///< MA, MR, SL 0 or homing is over, settling and hold delay too
        trip,         ///< the condition of `word` (TI TP TR TC TA TM) is met
        end_program,  ///< soft stop input, or a limit with LM = 3 or 6
        pause,        ///< input of type 6 became active
        resume,       ///< and inactive again
        go,           ///< input of type 4: run the program at address 1
        reset         ///< input of type 11
    };
    Kind kind = Kind::error;
    int code = 0;
    Word word{};
};

struct Mechanism {
    virtual ~Mechanism() = default;
    /// Power comes back or the drive is reset: motion ends at once, counters and status begin at 0. `position`: the shaft stays.
    virtual void restart(Instant now) = 0;
    virtual void factory(Instant now) = 0;
    virtual void save(NonVolatile& memory) const = 0;
    virtual void load(const NonVolatile& memory, Instant now) = 0;

    virtual Number read(Word word, Instant now, int& error) = 0;
    /// Printed form of words of several fields or letters: IS, OS, LS, VT, IT, MD; nothing for plain numbers.
    virtual std::optional<std::string> text(Word word, Instant now) = 0;
    virtual int write(Word word, std::span<const Number> fields, Instant now) = 0;
    /// MA MR SL HM HI HF SC CF.
    virtual int start(Word word, std::span<const Number> fields, Instant now) = 0;
    /// Defines the condition of a trip.
    virtual int arm(Word trip, std::span<const Number> fields, Instant now) = 0;
    /// The trips that are enabled, as the bits of TE.
    virtual void enable_trips(int te, Instant now) = 0;
    /// A trip that the language times itself (TT): P goes to PC [L4726], and the trip output pulses.
    virtual void capture(Instant now) = 0;
    virtual void stop_at_once(Instant now) = 0;
    virtual void pause(Instant now) = 0;
    virtual void resume(Instant now) = 0;
    virtual bool moving(Instant now) = 0;
    /// Motion that S, FD, PG, IP and CP refuse: MA, MR, homing [L5265]; `any`: slewing too.
    virtual bool busy(bool any, Instant now) = 0;
    /// EF, for the output type 18, and whether a program runs, for the soft stop and pause inputs.
    virtual void tell(bool error_flag, bool program_running, Instant now) = 0;

    virtual void advance(Instant now) = 0;
    virtual Instant deadline() const = 0;
    virtual std::optional<MotorEvent> next_event() = 0;

    virtual std::vector<HandItem> hand(Instant now) const = 0;
    /// Nothing if there is no such name; the empty string when done.
    virtual std::optional<std::string> set_hand(const std::string& name, const Value& value, Instant now) = 0;
    virtual TwinMechanics mechanics(Instant now) const = 0;
};

/// The motor of a Lexium, in factory state.
[[nodiscard]] std::unique_ptr<Mechanism> make_mechanism(const MechanismSetup& setup);

}  // namespace axisgate::mcode::twin
