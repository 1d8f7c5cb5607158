// The registers of a Schneider Lexium drive with MCode in front of any axis: each register is a variable or an instruction of the language.
// Reference: the MCode manual, per instruction "networking protocol equivalents"; the word order is a setting, because the manual leaves it
// open. A refusal is answered twice: by the door to the client, and in EF and ER as the drive itself would. An instruction acts with every
// write, as in the drive. After a stop by another client a merely repeated instruction does not act: a controller that writes its registers
// in cycles would undo the stop.
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
    /// The present value of ER: the language's own error, otherwise a fault of the axis.
    [[nodiscard]] int error() const;
    [[nodiscard]] Move move(Move::Kind kind, double counts) const;

    std::vector<Meaning> meanings_;                                           // by row
    std::vector<bool> said_;                                                  // by row: written since the start
    std::vector<std::uint32_t> values_;                                       // by row, of the settings
    std::size_t acceleration_ = 0, deceleration_ = 0, maximum_velocity_ = 0;  // indices of rows
    double run_ = 0;                                                          // the last written SL
    double ordered_speed_ = 0;  // of the last SL, if no other order followed and it was not refused
    Instant ordered_at_{};
    int error_ = 0;
    std::vector<Written> acting_;  // of the present write; kept, so that no memory is allocated for it
    bool received_ = false;        // true if a register was written since the start while the axis was online
    std::uint32_t source_ = 0;     // the serving side at the last write; 0: none yet
    bool held_ = false;            // another client has stopped the axis, and its client has written no fresh instruction since
    bool unheard_ = false;         // the client had written nothing before the stop, so that its first words may be as old as the motion
    bool held_told_ = false;
};

}  // namespace axisgate::registers
