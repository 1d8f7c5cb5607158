// Feedback and Errors: what is known of one drive's axis: what its polls show, what its own commands add to that, and its error codes.
// In: answers to polls and to ER, motions that this gateway began. Out: one AxisFeedback per reading; notices of errors.
// Never calls a target reached that the position has not reached, and never asks ER but when EF says that there is one: reading clears it
// [L2587].
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "adapters/mcode/demand.hpp"
#include "adapters/mcode/drive_part.hpp"
#include "gateway/core/sample.hpp"

namespace axisgate::mcode {

/// Codes of ER that stop an axis until they are reset; the others say that a line was refused.
[[nodiscard]] bool is_fault_code(int code) noexcept;

class Errors : public Part {
public:
    using Part::Part;

    /// EF is 1: ER is asked next. `ours`: a line of this gateway was refused, that is no news.
    void ask(bool ours) noexcept { wanted_ = true, ours_ = ours; }
    void stop_asking() noexcept { wanted_ = false; }
    [[nodiscard]] bool wanted() const noexcept { return wanted_; }
    void answered(Verdict v, const std::string& data, Turn& t);

    [[nodiscard]] int last() const noexcept { return last_; }
    void clear_last() noexcept { last_ = 0; }
    [[nodiscard]] int fault() const noexcept { return fault_; }  ///< code that must be reset; 0: none
    void clear_fault() noexcept { fault_ = 0; }
    /// An input of type 5 has ended a motion (91) or a program (48) [L776]: its level cannot be read, so it counts until the axis is
    /// enabled.
    [[nodiscard]] bool stopped_by_input() const noexcept { return stopped_by_input_; }
    void clear_input_stop() noexcept { stopped_by_input_ = false; }
    /// Looking for it may have raised an error in it: that one is no news.
    void raised_by_search() noexcept { by_search_ = true; }
    /// "error 24, ..."
    [[nodiscard]] std::string text_of(int code) const;

private:
    void learn(int code, bool ours, Turn& t);
    bool wanted_ = false, ours_ = false, by_search_ = false, stopped_by_input_ = false;
    int tries_ = 0;  ///< answers to ER that were none
    int fault_ = 0, last_ = 0;
};

class Feedback : public Part {
public:
    using Part::Part;

    /// As last read.
    struct Flags {
        bool mv = false, mp = false, vc = false, de = false, ef = false, by = false;
        bool stalled = false, locked = false;  ///< ST, LR
        bool input = false;                    ///< IF: a program waits for a number (IV)
    };
    /// What moves take, in the drive's own units; 0: not known.
    struct Values {
        std::int64_t vi = 0, user_vi = 0, vm = 0, a = 0, d = 0;  ///< user_vi: VI but for what a slow move has left of it
        bool encoder = false;                                    ///< EE
    };
    /// What the model has.
    struct Has {
        bool hmt = false;           ///< LMD closed loop: LR is there
        bool encoder = true;        ///< ST and EE can be read
        bool input = false;         ///< IF can be read
        bool old_firmware = false;  ///< below firmware 6: linear ramps and no backlash [L1030, L1031]
    };

    // --- the questions and their answers ------------------------------------------------------------------------------------
    [[nodiscard]] std::string poll_items(Instant now);
    [[nodiscard]] bool learn_poll(const std::string& data, Turn& t);
    /// Perhaps because of LL, which is a luxury: a drive that does not answer such polls is asked without it, before it counts as away.
    void poll_missed(Instant now) noexcept;
    [[nodiscard]] bool asks_lag() const noexcept { return asks_lag_; }
    [[nodiscard]] std::string value_items() const;
    void learn_values(std::string_view data);
    void learn_value(std::string_view word, std::int64_t value) noexcept;
    /// The drive has scaled them, or what is set is not known: read anew.
    void values_unknown() noexcept;

    // --- what has happened to it --------------------------------------------------------------------------------------------
    void found() noexcept;  ///< and set up
    void lost() noexcept;
    void line_lost() noexcept;
    void restarted(Turn& t);
    void powered(Turn& t);
    struct Motion {
        enum class Kind : std::uint8_t { none, position, velocity, home };
        Kind kind = Kind::none;
        std::int64_t target = 0;
        bool ended = true;
        Instant until = never;  ///< MV may show only then that it goes
        bool shown = false;     ///< MV has shown it
    };
    void began(Motion motion, Turn& t);
    void homed(bool here, Turn& t);  ///< P was set: by a homing that takes this place, behind a search, or for itself
    void error_read() noexcept { flags_.ef = false; }
    void stopped(bool power_off, Turn& t);
    void show(Turn& t);  ///< what is known now, once more

    // --- what is known ------------------------------------------------------------------------------------------------------
    Has has;
    Values values;
    [[nodiscard]] const Flags& flags() const noexcept { return flags_; }
    [[nodiscard]] bool seen() const noexcept { return seen_; }
    [[nodiscard]] bool running() const noexcept { return flags_.by; }
    [[nodiscard]] bool at_rest() const noexcept { return seen_ && !flags_.by && !flags_.mv; }  ///< and no program runs
    [[nodiscard]] bool moving() const noexcept { return fb_.moving; }
    [[nodiscard]] std::int64_t position() const noexcept { return fb_.position; }
    [[nodiscard]] std::int64_t velocity() const noexcept { return fb_.velocity; }
    /// AS = 3: the drive presses on by itself, and SL does not end that.
    [[nodiscard]] bool torque() const noexcept { return hmt_mode_ == 3; }
    /// Units are encoder counts: with hMT they are step pulses, whatever EE says [L696].
    [[nodiscard]] bool encoder_mode() const noexcept { return values.encoder && hmt_mode_ == 0; }
    /// It moves by something that does not end by itself soon.
    [[nodiscard]] bool goes() const noexcept;
    /// A search has found home: the position becomes zero next. `take_zero`: somebody sees to it.
    [[nodiscard]] bool wants_zero() const noexcept { return zero_wanted_; }
    [[nodiscard]] bool take_zero() noexcept { return std::exchange(zero_wanted_, false); }
    void no_zero() noexcept { zero_after_home_ = zero_wanted_ = false; }
    [[nodiscard]] bool may_print(Instant now) const noexcept { return flags_.by || now < prints_until_; }
    void program_starts(Instant now) noexcept { prints_until_ = now + std::chrono::seconds(3); }
    /// VI, VM, A, D or EE may be others than is known.
    bool relearn = false;

    // --- its demand ---------------------------------------------------------------------------------------------------------
    AxisDemand demand;
    Instant received_at{};       ///< when the drive has all of the present request: bytes of its echo or answer tell less
    bool shape_refused = false;  ///< it does not tell what makes a motion another than a trapezoid
    [[nodiscard]] bool wants_shape() const noexcept { return demand.wants_shape() && !shape_refused; }
    void program_ran() noexcept { program_ran_ = true; }

private:
    void derive();
    void emit(Turn& t);
    [[nodiscard]] Course course() const noexcept;
    void read_demand(std::optional<std::int64_t> lag);
    void demand_lost() noexcept;

    AxisFeedback fb_;
    Flags flags_;
    int hmt_mode_ = 0;   ///< AS
    Instant read_at_{};  ///< of the last poll: the drive had the whole question
    bool seen_ = false;
    bool enabled_ = false;   ///< by this gateway, since the drive was found
    bool stopping_ = false;  ///< a stop was accepted, and rest has not been seen since
    Motion motion_;
    bool zero_after_home_ = false, zero_wanted_ = false;
    bool program_ran_ = false;  ///< it may have set VI, VM, A, D or EE
    bool asks_lag_ = false;     ///< LL is in the poll in flight
    int lag_misses_ = 0;        ///< such polls in a row without an answer: two, and LL is left out for a while
    Instant lag_again_{};
    Instant prints_until_{};  ///< output of a program may still come
};

}  // namespace axisgate::mcode
