// Motor: the motor of a Lexium, put together: its words, its inputs and outputs, its hand, and what happens when.
// In: words with worked-out fields, the tester's hand, time. Out: values, MCode error codes, a bounded queue of events.
// Never ticks: positions are evaluated in closed form when they are asked for, and deadline() is the next instant at which something
// happens. Never knows programs: a trip is a condition here.
// Error codes are those of appendix "Error codes" [L8452-8630].
#pragma once

#include "adapters/mcode/twin/delayed.hpp"
#include "adapters/mcode/twin/numbering.hpp"
#include "gateway/core/hand_table.hpp"

namespace axisgate::mcode::twin {

class Motor final : public Mechanism {
public:
    explicit Motor(const MechanismSetup& setup) : p_(setup) {}

    void restart(Instant now) override;
    void factory(Instant now) override;
    void save(NonVolatile& memory) const override;
    void load(const NonVolatile& memory, Instant now) override;

    Number read(Word word, Instant now, int& error) override;
    std::optional<std::string> text(Word word, Instant now) override;
    int write(Word word, std::span<const Number> fields, Instant now) override;
    int start(Word word, std::span<const Number> fields, Instant now) override;
    int arm(Word trip, std::span<const Number> fields, Instant now) override;
    void enable_trips(int te, Instant now) override;
    void capture(Instant now) override;
    void stop_at_once(Instant now) override;
    void pause(Instant now) override;
    void resume(Instant now) override;
    bool moving(Instant now) override;
    bool busy(bool any, Instant now) override;
    void tell(bool error_flag, bool program_running, Instant now) override;

    void advance(Instant now) override;
    Instant deadline() const override { return std::min(next_, rotor_tick_); }
    std::optional<MotorEvent> next_event() override { return p_.events.next(); }

    std::vector<HandItem> hand(Instant now) const override;
    std::optional<std::string> set_hand(const std::string& name, const Value& value, Instant now) override;
    TwinMechanics mechanics(Instant now) const override;

private:
    /// Instants at which the present motion meets something.
    struct Due {
        Instant soft = never, index = never, stall = never, lag = never, cam = never, wrap = never;
    };

    static const HandRow<Motor> conditions[];
    std::string set_supply(double& into, const HandWish& wish);
    void replan(Instant now);
    /// The real rotor up to this instant; false: up to an earlier one, because the motion has changed there.
    [[nodiscard]] bool follow(Instant until);
    void handle(Instant t);
    void edge(const InputEdge& e, Instant now);
    [[nodiscard]] bool output(std::size_t n, Instant now) const noexcept;
    void judge_supply(Instant now);
    void bridges_off(Instant now);
    int write_value(Word word, const Number& n, Instant now);
    int enable_drive(bool on, Instant now);
    /// What a new value changes in the motion that is going on.
    void apply(Word word, Instant now);
    /// AS = 1 or 2, and the rotor is not where the command is.
    [[nodiscard]] bool owes(Instant now) const noexcept;

    Parts p_;
    Course course_{p_};
    Homing homing_{p_, course_};
    Moves moves_{p_, course_, homing_};
    Numbering numbering_{p_, course_, moves_};
    bool error_flag_ = false;
    bool program_running_ = false;
    int output_fault_ = 0;
    std::int64_t clock_pulses_ = 0;
    Due due_;
    Delayed moving_{p_.settings.manners().moving_late}, to_position_{p_.settings.manners().moving_late};  ///< MV, MP
    Instant next_ = never;
    Instant rotor_tick_ = never;  ///< when the real rotor is to be looked at
    Instant last_{};
};

}  // namespace axisgate::mcode::twin
