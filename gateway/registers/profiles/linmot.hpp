// The control word, status word and motion command interface of a LinMot drive, in front of any axis whose unit is a length. Reference:
// E1100/B1100 motion control software: control word [L284], status word [L380], state machine [L105], motion commands by their count nibble
// [L545]. The power is switched on with bit 3, because the current in "ready to operate" is a setting of the real drive; the tests of state
// 5 last as long as the real drive takes to enable. Streaming, curves, events and the command table are refused.
#pragma once

#include <array>
#include <vector>

#include "gateway/registers/profiles/profile_map.hpp"

namespace axisgate::registers {

class LinMotMap final : public ProfileMap {
public:
    LinMotMap(const DoorPort& port, Setup setup);
    void on_own_result(std::uint32_t note, const Result& result) override;

private:
    static constexpr std::size_t parameter_words = 15;
    enum class Meaning : std::uint8_t {
        state_var,
        status_word,
        warn_word,
        position,
        position_demand,
        velocity,
        error,
        control_word,
        header,
        parameter
    };
    /// Main states of the drive with their numbers; state 8 and its sub-states apply while the axis is enabled.
    enum class State : std::uint8_t {
        locked = 0,
        switch_on_disabled = 1,
        ready_to_switch_on = 2,
        error = 4,
        tests = 5,
        ready_to_operate = 6,
        enabled = 8,
        homing = 9,
        aborting = 12,
        freezing = 13,
        quick_stop = 14,
        jog_plus = 16,
        jog_minus = 17
    };
    enum class Asked : std::uint8_t { enable, home, motion, nothing };

    [[nodiscard]] static Meaning meaning_of(const LanguageRow& row);
    bool shown(std::size_t row, Instant now, std::uint32_t& bits) override;
    Verdict taken(std::span<const Written> rows, WritePlan& plan) override;
    void adopted(std::span<const Written> rows, WritePlan& plan) override;
    /// The part of the state machine that follows the axis.
    [[nodiscard]] State state() const;
    [[nodiscard]] bool powered(State s) const noexcept { return s >= State::enabled; }
    [[nodiscard]] std::uint16_t state_var() const;
    [[nodiscard]] std::uint16_t status_word() const;
    [[nodiscard]] std::uint16_t warn_word() const;
    void take_control(std::uint16_t word, WritePlan& plan);
    void take_special(std::uint16_t before, WritePlan& plan);
    void take_command(std::uint16_t header, WritePlan& plan);
    void motion_command(std::uint16_t header, WritePlan& plan);
    void go(double target, std::optional<double> velocity, std::optional<double> acceleration, std::optional<double> deceleration,
            WritePlan& plan);
    void run(double velocity, WritePlan& plan);
    void give(CommandBody body, Asked asked, WritePlan& plan);
    /// Sets an error of the page and ends the motion; log() only records it.
    void fail(Reason why, WritePlan& plan);
    void log(Reason why, std::string text);
    void off(State to, WritePlan& plan);
    [[nodiscard]] double parameter(std::size_t byte) const;  ///< 32 bits, signed, at an offset from the header, counted as in the manual

    std::vector<Meaning> meanings_;
    std::array<std::uint16_t, parameter_words + 1> buffer_{};  ///< header and parameters
    State state_ = State::locked;
    std::uint16_t control_ = 0;
    std::uint8_t count_ = 0;
    bool power_asked_ = false;  ///< the power was requested through this map, and the request was not withdrawn
    bool homed_ = false;        ///< the homing that bit 11 started is finished
    std::uint32_t sequence_ = 0;
    std::uint16_t error_ = 0;  ///< the logged error; 0: none of its own
    double target_ = 0;
    bool target_known_ = false;
};

}  // namespace axisgate::registers
