// Lexium: the registers of a Schneider Lexium drive with MCode in front of any axis: each is a variable or an instruction of the language.
// In: reads and writes of registers. Out: values of the axis in counts; commands. Reference: the MCode manual, per instruction "networking
// protocol equivalents"; word order is a setting since that manual leaves it open.
// A refusal is answered twice: to the client by its door, and in EF and ER as the drive itself would say it.
// An instruction acts with every write of it, as in the drive. After a stop of somebody else it does not while it is merely repeated: a
// controller that writes its registers in cycles would undo the stop.
#pragma once

#include <vector>

#include "gateway/registers/profiles/profile_map.hpp"

namespace axisgate::registers {

class LexiumMap final : public ProfileMap {
public:
    LexiumMap(const DoorPort& port, Setup setup);
    void on_own_result(std::uint32_t note, const Result& result) override;

private:
    enum class Meaning : std::uint8_t {
        acceleration,
        deceleration,
        maximum_velocity,
        velocity,
        position,
        counter,
        moving,
        moving_to_position,
        enable,
        error_flag,
        error,
        move_absolute,
        move_relative,
        move_velocity,
        home,
        home_index,
        nothing,
        kept,
        fixed,
        none
    };
    [[nodiscard]] static Meaning meaning_of(const LanguageRow& row);
    bool shown(std::size_t row, Instant now, std::uint32_t& bits) override;
    Verdict taken(std::span<const Written> rows, WritePlan& plan) override;
    void adopted(std::span<const Written> rows, WritePlan& plan) override;
    void instruct(const Written& w, Meaning meaning, WritePlan& plan);
    void out_of_range() override;
    Verdict refuse_with(Reason reason, std::string text);
    [[nodiscard]] bool turns_at(double counts) const;
    void look_for_a_stop() noexcept;
    [[nodiscard]] bool is_held(const Written& w) const;
    [[nodiscard]] static bool moves(Meaning meaning) noexcept;
    /// ER as it reads now: the language's own, else a fault of the axis.
    [[nodiscard]] int error() const;
    [[nodiscard]] Move move(Move::Kind kind, double counts) const;

    std::vector<Meaning> meanings_;                                           // by row
    std::vector<bool> said_;                                                  // by row: written since the start
    std::vector<std::uint32_t> values_;                                       // by row, of what is kept
    std::size_t acceleration_ = 0, deceleration_ = 0, maximum_velocity_ = 0;  // rows
    double run_ = 0;                                                          // SL as it was written last
    double ordered_speed_ = 0;  // of the last SL, if nothing was ordered behind it and it was not refused
    Instant ordered_at_{};
    int error_ = 0;
    std::vector<Written> acting_;  // of the write that is looked at; kept, so that nothing is allocated for it
    bool received_ = false;        // something was written since the start, to an axis that is heard
    std::uint32_t source_ = 0;     // who spoke for the axis when something was written last; 0: nobody yet
    bool held_ = false;            // somebody else has stopped the axis, and its client has given no fresh word since
    bool unheard_ = false;         // ... and it had said nothing before that: its first words may be as old as the motion
    bool held_told_ = false;
};

}  // namespace axisgate::registers
