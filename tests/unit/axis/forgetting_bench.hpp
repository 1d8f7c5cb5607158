// An axis in every situation, every event, and the observed values. Every value is observed only through public calls: the picture,
// active_target, or the order of a copy of the axis.
#pragma once

#include <array>
#include <bit>
#include <initializer_list>
#include <string>
#include <vector>

#include "tests/unit/axis/cia402_bench.hpp"

namespace axisgate::forgetting {

/// The clients. "plc" has caused each situation and written all values; its words are known. "panel" gives the commands; it has written the
/// word 06 (shutdown) before, so that its next word is an edge. "stranger" has written nothing yet.
[[nodiscard]] Origin plc();
[[nodiscard]] Origin panel();
[[nodiscard]] Origin stranger();

/// The activity of the axis when the event comes. In each of them the client "plc" has written a target (3000) that no set-point has used
/// yet, speeds (200, 300, 400), a homing method (17) and, unless the mode moves the axis with it, a target velocity (55).
enum class Situation : std::uint8_t {
    switched_on,
    being_enabled,  // the drive has not answered yet
    standing,
    moving,           // to 1000; bit 4 is still set
    waiting,          // moving to 1000, and a set-point to 2000 waits behind it
    halted,           // as waiting, with the halt bit set
    turning,          // profile velocity, 500
    turning_halted,   // as turning, with the halt bit set
    searching,        // homing
    homing_refused,   // the drive refused the last homing
    following,        // streamed positions; before that it moved
    following_speed,  // streamed velocities
    quick_stopped,
    reacting,  // a fault while it moves
    faulty,    // a fault at rest
    being_disabled,
    unheard,  // another drive serves the axis and has not reported yet
    silent,   // offline
    count
};

enum class Event : std::uint8_t {
    // words of the client that has written the values
    halt_bit,
    end_of_halt_bit,
    set_point,
    set_point_at_once,        // with bit 5
    set_point_with_halt_bit,  // both edges in one word
    end_of_bit_4,
    quick_stop_bit,
    disable_voltage,
    shutdown,
    disable_operation,
    enable_operation,
    fault_reset_bit,
    // values
    same_mode,
    another_mode,
    another_mode_and_velocity,
    another_mode_and_back,
    target_velocity_zero,
    // of other clients
    target_of_another,
    speeds_of_another,
    enable_operation_by_another,     // "panel", whose word rises by this
    enable_operation_by_a_stranger,  // "stranger", whose previous word is unknown
    // commands that the drive accepts, and some that it refuses
    enable,
    disable,
    quick_stop,
    halt,
    reset_fault,
    home,
    home_refused,
    set_position,
    set_position_refused,
    move_absolute,
    move_relative,
    move_velocity,
    move_refused,
    start_together,
    // streams, begun if the axis may follow
    stream_position,
    stream_velocity,
    end_of_stream,
    // reports of the drive
    same_again,
    arrived,
    power_lost,
    fault,
    stopped_at_the_drive,
    // the serving side
    silence,
    another_drive,
    another_drive_that_is_on,  // and reports so, at rest
    same_presence,
    count
};

enum class Value : std::uint8_t {
    controlword,
    mode,
    mode_after_stream,
    shown_target,
    shown_velocity,
    shown_speeds,
    homing_method,
    set_points,  // the counter
    bit_12,      // if the mode allows no other value in it
    bit_13,
    active,            // the end of the running motion
    waiting,           // the set-point that starts behind it
    end_of_halt,       // the order at the end of a halt
    ordered_velocity,  // in profile velocity
    halt,              // it causes motions to be refused
    quick_stop,
    target,  // of the next set-point of "plc"
    speeds,  // of the same
    referenced,
    position,
    commanded,
    count
};

constexpr std::array<const char*, static_cast<std::size_t>(Situation::count)> situation_names{
    "switched_on",   "being_enabled",  "standing",  "moving",         "waiting",   "halted",
    "turning",       "turning_halted", "searching", "homing_refused", "following", "following_speed",
    "quick_stopped", "reacting",       "faulty",    "being_disabled", "unheard",   "silent"};
constexpr std::array<const char*, static_cast<std::size_t>(Event::count)> event_names{"halt_bit",
                                                                                      "end_of_halt_bit",
                                                                                      "set_point",
                                                                                      "set_point_at_once",
                                                                                      "set_point_with_halt_bit",
                                                                                      "end_of_bit_4",
                                                                                      "quick_stop_bit",
                                                                                      "disable_voltage",
                                                                                      "shutdown",
                                                                                      "disable_operation",
                                                                                      "enable_operation",
                                                                                      "fault_reset_bit",
                                                                                      "same_mode",
                                                                                      "another_mode",
                                                                                      "another_mode_and_velocity",
                                                                                      "another_mode_and_back",
                                                                                      "target_velocity_zero",
                                                                                      "target_of_another",
                                                                                      "speeds_of_another",
                                                                                      "enable_operation_by_another",
                                                                                      "enable_operation_by_a_stranger",
                                                                                      "enable",
                                                                                      "disable",
                                                                                      "quick_stop",
                                                                                      "halt",
                                                                                      "reset_fault",
                                                                                      "home",
                                                                                      "home_refused",
                                                                                      "set_position",
                                                                                      "set_position_refused",
                                                                                      "move_absolute",
                                                                                      "move_relative",
                                                                                      "move_velocity",
                                                                                      "move_refused",
                                                                                      "start_together",
                                                                                      "stream_position",
                                                                                      "stream_velocity",
                                                                                      "end_of_stream",
                                                                                      "same_again",
                                                                                      "arrived",
                                                                                      "power_lost",
                                                                                      "fault",
                                                                                      "stopped_at_the_drive",
                                                                                      "silence",
                                                                                      "another_drive",
                                                                                      "another_drive_that_is_on",
                                                                                      "same_presence"};
/// Each value's name, and its form when it is forgotten.
constexpr std::array<std::array<const char*, 2>, static_cast<std::size_t>(Value::count)> value_names{{{"controlword", "0"},
                                                                                                      {"mode", "0"},
                                                                                                      {"mode_after_stream", "0"},
                                                                                                      {"shown_target", "70"},
                                                                                                      {"shown_velocity", "0"},
                                                                                                      {"shown_speeds", "0 0 0"},
                                                                                                      {"homing_method", "0"},
                                                                                                      {"set_points", "0"},
                                                                                                      {"bit_12", "0"},
                                                                                                      {"bit_13", "0"},
                                                                                                      {"active", "none"},
                                                                                                      {"waiting", "none"},
                                                                                                      {"end_of_halt", "none"},
                                                                                                      {"ordered_velocity", "none"},
                                                                                                      {"halt", "0"},
                                                                                                      {"quick_stop", "0"},
                                                                                                      {"target", "70"},
                                                                                                      {"speeds", "0 0 0"},
                                                                                                      {"referenced", "0"},
                                                                                                      {"position", "0"},
                                                                                                      {"commanded", "0"}}};

/// A few of an enumeration.
template <class E>
class Some {
public:
    constexpr Some() = default;
    constexpr Some(E e) : bits_(std::uint64_t{1} << static_cast<unsigned>(e)) {}
    constexpr Some(std::initializer_list<E> all) {
        for (const E e : all)
            *this = *this | e;
    }
    [[nodiscard]] constexpr bool has(E e) const { return (bits_ & Some(e).bits_) != 0; }
    [[nodiscard]] constexpr bool empty() const { return bits_ == 0; }
    [[nodiscard]] constexpr Some operator|(Some o) const { return of(bits_ | o.bits_); }
    [[nodiscard]] constexpr Some but(Some o) const { return of(bits_ & ~o.bits_); }
    [[nodiscard]] static constexpr Some all() { return of((std::uint64_t{1} << static_cast<unsigned>(E::count)) - 1); }

private:
    [[nodiscard]] static constexpr Some of(std::uint64_t bits) {
        Some s;
        s.bits_ = bits;
        return s;
    }
    std::uint64_t bits_ = 0;
};

/// The observed values, as text.
using Seen = std::array<std::string, static_cast<std::size_t>(Value::count)>;

/// An axis with its drive, and orders that the drive has not answered yet.
struct Subject : cia402_bench::Bench {
    std::vector<CommandBody> open;

    explicit Subject(Situation situation);
    void apply(Event event);
    [[nodiscard]] Seen look() const;

private:
    Cia402Axis::Decision write(const ProcessData& data, const Origin& by);
    Cia402Axis::Decision control(std::uint16_t word);
    void values();
    void enabled(std::int16_t mode);
    void run_to(std::int32_t target);
    void answer(const Cia402Axis::Decision& decision, bool good = true);
    void answer_open();
    void choose(std::int16_t mode, const Origin& by);
    void enable_again();
    [[nodiscard]] std::string first_order(const Cia402Axis::Decision& decision) const;
};

}  // namespace axisgate::forgetting
