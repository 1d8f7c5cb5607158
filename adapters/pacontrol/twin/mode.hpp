// The operating mode of the twin: home position, manual, AUTOMATIC, ONLINE with their transitional states [L3991-4019].
// In: what was commanded, whether all axes stand, time. Out: the operating status; what was entered, so that the control can act.
// Never moves an axis.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/core/instant.hpp"

namespace axisgate::pacontrol::twin {

namespace status {
inline constexpr std::uint8_t none = 0;
inline constexpr std::uint8_t home = 1;
inline constexpr std::uint8_t manual = 2;
inline constexpr std::uint8_t manual_moves = 3;
inline constexpr std::uint8_t home_error = 9;
inline constexpr std::uint8_t auto_started = 10;
inline constexpr std::uint8_t automatic = 11;
inline constexpr std::uint8_t auto_stop = 12;
inline constexpr std::uint8_t auto_stop_program = 13;
inline constexpr std::uint8_t auto_stopped = 15;
inline constexpr std::uint8_t auto_after_stop = 16;
inline constexpr std::uint8_t auto_malfunction = 17;
inline constexpr std::uint8_t auto_malfunction_program = 18;
inline constexpr std::uint8_t auto_malfunction_stopped = 19;
inline constexpr std::uint8_t winpac = 20;
inline constexpr std::uint8_t online_started = 30;
inline constexpr std::uint8_t online = 31;
inline constexpr std::uint8_t online_stop = 32;
inline constexpr std::uint8_t online_stopped = 35;
inline constexpr std::uint8_t online_malfunction = 37;
inline constexpr std::uint8_t online_malfunction_stopped = 39;
}  // namespace status

/// The four columns of the manual's table of what is allowed when [L215-225].
namespace gate {
inline constexpr std::uint8_t home = 1;
inline constexpr std::uint8_t manual = 2;
inline constexpr std::uint8_t automatic = 4;
inline constexpr std::uint8_t online = 8;
inline constexpr std::uint8_t all = 15;
}  // namespace gate
[[nodiscard]] std::uint8_t column_of(std::uint8_t status) noexcept;

/// One traverse of a program, `A1:=100` [L3437].
struct ProgramMove {
    int axis = 1;
    double target = 0;  ///< AE
};

/// A program of the AUTOMATIC mode: it takes its time and ends well (error 0) or with a system error (E-37). Meanwhile it does its moves,
/// one after the other, again and again.
struct Program {
    std::string name;
    Duration duration{};
    std::uint16_t error = 0;
    std::vector<ProgramMove> moves{};
};

struct ModeTimes {
    Duration start = std::chrono::milliseconds(8);                  ///< status 10 and 30
    Duration stop_program = std::chrono::milliseconds(100);         ///< 13
    Duration start_after_stop = std::chrono::milliseconds(100);     ///< 16
    Duration malfunction_program = std::chrono::milliseconds(100);  ///< 18
    Duration home{};                                                ///< from the standstill of all axes to home position
    Duration initialise{};                                          ///< 0 after power on
};

class Mode {
public:
    enum class Entered : std::uint8_t { nothing, other, home, manual, automatic, online, program_ended };

    explicit Mode(const ModeTimes& times) : times_(times) {}
    /// Power on: home position.
    void reset() noexcept;
    /// Power on: status 0, and home position after the time of initialisation.
    void initialise(Instant now) noexcept;

    /// Without 9 and 3, which depend on what is elsewhere.
    [[nodiscard]] std::uint8_t status() const noexcept { return status_; }
    [[nodiscard]] std::uint8_t column() const noexcept { return column_of(status_); }
    /// On the way to home position (or manual) as soon as all axes stand.
    [[nodiscard]] bool leaving() const noexcept { return leaving_; }
    [[nodiscard]] const Program& program() const noexcept { return program_; }

    // Commands; false: not from this state.
    bool start_automatic(const Program& program, Instant now);
    bool resume_automatic(Instant now);
    bool start_online(Instant now);
    bool resume_online() noexcept;
    /// 11 and 16 -> 12, 31 -> 32.
    bool stop(Instant now) noexcept;
    /// A system error: 10..16 -> 17, 30..35 -> 37.
    bool malfunction(Instant now) noexcept;
    /// To `target` (home, manual, winpac) when all axes stand.
    void leave(std::uint8_t target) noexcept;

    /// One transition that is due, with its own instant being `now`; nothing if none is.
    Entered step(Instant now, bool all_stand);
    [[nodiscard]] Instant deadline() const noexcept { return until_; }

private:
    Entered enter(std::uint8_t s) noexcept;
    void keep_program_time(Instant now) noexcept;

    ModeTimes times_;
    std::uint8_t status_ = status::home;
    std::uint8_t target_ = status::home;
    bool leaving_ = false;
    Instant until_ = never;
    Program program_;
    Duration left_{};
};

}  // namespace axisgate::pacontrol::twin
