// Manners: the choices that the manual leaves to a drive on its link and in its memory, and those of a firmware before 6.0.01. Each member
// has the name of its freedom in the page; the initial values are the drive as the manual shows it.
#pragma once

#include "gateway/core/freedom.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/core/shaft.hpp"

namespace axisgate::mcode::twin {

struct Manners {
    /// Where an acknowledgement (CR LF; ACK with CK on) stands with EM = 1 when data are printed (E-4).
    enum class Order : std::uint8_t { acknowledged_first, data_first, data_alone };

    int delivered_em = 0;     ///< EM and CK of a memory in which nothing was saved yet
    int delivered_ck = 0;     ///< 0..2; not over Ethernet
    bool echo_whole = false;  ///< EM = 0: the echo comes at the end of the line, in one piece
    bool echo_name = false;   ///< the echo of a party line begins with the name
    Order answer_order = Order::acknowledged_first;
    int number_form = 0;  ///< 0 digits alone, 1 real numbers fill the width of PF (E-12), 2 whole numbers from 0 have a blank in front, too
    int version = 6002;   ///< firmware: 5007, 5013, 6002; before 6000 without the words of 6.0.01
    bool version_alone = false;  ///< VR without product and hardware
    bool lists = true;           ///< PR AL and PR UV are answered; else error 35
    bool sign_on = false;        ///< a notice and a prompt at power-up and after CTRL+C, in single mode
    bool memory_deaf = false;    ///< what comes during memory_ms is lost
    int chatter_ms = 0;          ///< ms between two lines that the program of the factory prints; 0: there is none

    Duration prompt_late{};                             ///< the prompt behind the rest of its answer, EM = 0
    Duration party_gap{};                               ///< between acknowledgement and data on a party line
    Duration listing_pause{};                           ///< between two lines of one answer
    Duration error_late{};                              ///< EF, ER, the prompt and OE know of an error of the motor this much later
    Duration memory{};                                  ///< S, IP and FD take so long, and typed lines wait
    Duration store{};                                   ///< so does a line in program mode, and what comes meanwhile is lost
    Duration turnaround{};                              ///< deaf behind an answer
    Duration escape{};                                  ///< from the escape character to the stop
    Duration execution = std::chrono::milliseconds(1);  ///< of a typed line: the short end of the 1-5 ms of the manual [L6821]

    [[nodiscard]] bool before_6() const noexcept { return version < 6000; }
};

/// The same of the motor, its encoder and its mechanics.
struct MotorManners {
    ShaftFreedoms shaft{};  ///< in microsteps of 51200 on a turn
    std::uint64_t seed = 0;
    std::int64_t switch_hysteresis = 0;   ///< in the same microsteps
    std::int64_t counter_start = 0;       ///< C1 at power-up and after CTRL+C
    std::int64_t encoder_start = 0;       ///< C2
    int encoder_lines = 1000;             ///< of an LMD; an LMM has EL
    Duration moving_late{};               ///< MV and MP show the motion this much later
    bool moving_ends_with_steps = false;  ///< MV does not last until MT and HT are over (E-21)
};

/// Both are read by the names of the page. `seed`: of the noise.
[[nodiscard]] Manners manners_of(const FreedomValues& values);
[[nodiscard]] MotorManners motor_manners_of(const FreedomValues& values, std::uint64_t seed);

}  // namespace axisgate::mcode::twin
