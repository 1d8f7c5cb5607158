// The table of forgetting: which values each event discards and keeps, in every situation. One line is one rule with its name. If two rules
// name the same value, the later one applies. A value that no rule names must keep its exact value; a situation and event that no rule
// names is a hole in the table, and the test fails.
#pragma once

#include "tests/unit/axis/forgetting_bench.hpp"

namespace axisgate::forgetting {

/// A value that changes. "+1": one more than before.
struct Becomes {
    Value value = Value::count;
    const char* text = "";
};
struct Rule {
    const char* name;
    Some<Event> events;
    Some<Situation> situations;
    Some<Value> forgets{};
    std::vector<Becomes> becomes{};
    Some<Value> open{};   ///< values that the event sets itself and that other tests check
    Some<Value> keeps{};  ///< against an earlier rule
};

inline std::vector<Rule> rules() {
    using E = Event;
    using S = Situation;
    using V = Value;
    using Events = Some<Event>;
    using Situations = Some<Situation>;
    using Values = Some<Value>;
    const auto any = Situations::all();
    const Situations absent{S::unheard, S::silent}, faults{S::reacting, S::faulty}, streams{S::following, S::following_speed};
    const Situations turns{S::turning, S::turning_halted}, halts{S::halted, S::turning_halted}, homes{S::searching, S::homing_refused};
    const Situations enabled = Situations{S::standing, S::moving, S::waiting} | halts | turns | homes | streams;
    const Situations free = enabled.but(halts), at_rest{S::standing, S::halted, S::turning_halted, S::homing_refused};
    const Situations answering = any.but(absent | faults), homable = answering.but(halts | S::quick_stopped);
    const Events on_words{E::enable_operation, E::enable_operation_by_another, E::enable_operation_by_a_stranger};
    const Events rising_on_words = on_words.but(E::enable_operation_by_a_stranger);
    const Events own_words_without_halt{E::enable_operation, E::end_of_halt_bit};
    const Events off_words{E::disable_voltage, E::shutdown, E::disable_operation};
    const Events set_points{E::set_point, E::set_point_at_once};
    const Events halt_words{E::halt_bit, E::set_point_with_halt_bit};
    const Events words =
        on_words | off_words | set_points | halt_words | Events{E::end_of_halt_bit, E::end_of_bit_4, E::quick_stop_bit, E::fault_reset_bit};
    const Events positions{E::move_absolute, E::move_relative}, taken = positions | Events{E::move_velocity},
                                                                moves = taken | Events{E::move_refused};
    // A motion runs, so that an order which its drive refuses has another motion beside it.
    const Situations running{S::moving, S::waiting, S::turning, S::searching, S::following, S::following_speed, S::being_disabled};
    const Events quick_stops{E::quick_stop_bit, E::quick_stop, E::stopped_at_the_drive};
    const Events switch_off = off_words | Events{E::disable, E::power_lost}, homings{E::home, E::home_refused};
    const Events streamed{E::stream_position, E::stream_velocity}, served{E::silence, E::another_drive, E::another_drive_that_is_on};
    const Values motion{V::active, V::waiting, V::end_of_halt, V::bit_12, V::halt, V::ordered_velocity, V::shown_velocity};
    return {
        // ---- words ----
        {"a word by itself forgets nothing", words, any, {}, {}, V::controlword},
        {"a word that rises to an axis that is being enabled orders that again",
         off_words | Events{E::enable_operation_by_another, E::quick_stop_bit}, S::being_enabled, V::shown_velocity},
        {"a word that does not enable ends nothing twice", words.but(on_words), S::being_disabled, V::shown_velocity},
        {"a word that stops is followed though nobody is heard", words.but(on_words | Events{E::shutdown, E::disable_operation}), absent,
         V::shown_velocity},
        // bit 8
        {"the halt bit keeps the motion and what waits", halt_words, enabled, {}, {{V::halt, "1"}}},
        {"the end of a halt goes on with the motion", halt_words, {S::moving, S::waiting}, {}, {{V::end_of_halt, "to 1000"}}},
        {"or with the speed", halt_words, S::turning, V::ordered_velocity, {{V::end_of_halt, "velocity 500"}}},
        {"the end of a halt counts once, by who has set it", own_words_without_halt, halts, {V::end_of_halt, V::halt}},
        {"a speed that goes on is ordered",
         own_words_without_halt,
         S::turning_halted,
         {},
         {{V::ordered_velocity, "500"}, {V::set_points, "+1"}}},
        // bit 4
        {"bit 12 falls with bit 4, of who has set it or may have",
         Events{E::enable_operation, E::enable_operation_by_a_stranger, E::set_point_with_halt_bit, E::end_of_bit_4}, S::moving, V::bit_12},
        {"a set-point is counted and acknowledged", set_points, S::standing, {}, {{V::set_points, "+1"}, {V::bit_12, "1"}}},
        {"a set-point waits behind a motion", E::set_point, S::moving, {}, {{V::set_points, "+1"}, {V::waiting, "to 3000"}}},
        {"a set-point with bit 5 forgets the motion and what waits",
         E::set_point_at_once,
         {S::moving, S::waiting},
         V::waiting,
         {{V::set_points, "+1"}, {V::active, "3000"}, {V::bit_12, "1"}}},
        {"a homing that is taken forgets that one was refused", set_points, S::homing_refused, V::bit_13},
        // ---- stops and power ----
        {"a quick stop forgets all motion", quick_stops, enabled, motion, {{V::quick_stop, "1"}}},
        {"a quick stop ends the stream", quick_stops, streams, {}, {{V::mode, "1"}}},
        {"a quick stop by command comes before the answer to an enable", E::quick_stop, S::being_enabled, {}, {{V::quick_stop, "1"}}},
        {"an axis without power forgets all motion", switch_off, enabled, motion},
        {"an axis without power ends the stream", switch_off, streams, {}, {{V::mode, "1"}}},
        {"an axis without power that stands is not commanded", switch_off, at_rest, V::commanded},
        {"a word takes back an enable that is not answered", off_words | E::quick_stop_bit | E::disable, S::being_enabled, V::commanded},
        {"an axis without power is not in quick stop",
         {E::disable_voltage, E::disable, E::power_lost},
         S::quick_stopped,
         {V::quick_stop, V::commanded, V::shown_velocity}},
        {"stops by command forget the target velocity whatever the state", {E::halt, E::quick_stop, E::disable}, any, V::shown_velocity},
        {"commands that switch are shown as a word", {E::disable, E::quick_stop}, any, {}, {}, V::controlword},
        {"halt by command forgets the motion, the speed and what waits",
         E::halt,
         any,
         {V::active, V::waiting, V::end_of_halt, V::ordered_velocity}},
        {"bit 12 falls with what waited", E::halt, {S::waiting, S::halted}, V::bit_12},
        {"a word that stops is followed in fault while it moves", off_words | halt_words | E::quick_stop_bit, S::reacting,
         V::shown_velocity},
        // ---- enabling ----
        {"enable forgets the target velocity", rising_on_words | E::enable, {S::switched_on, S::quick_stopped}, V::shown_velocity},
        {"also once more while the enable is on its way, but by a repeated word",
         {E::enable, E::enable_operation_by_another},
         S::being_enabled,
         V::shown_velocity},
        {"enable leaves quick stop", rising_on_words | E::enable, S::quick_stopped, V::quick_stop},
        {"an axis that is being enabled is commanded", rising_on_words | E::enable, S::switched_on, {}, {{V::commanded, "1"}}},
        {"enable by another client forgets the target",
         {E::enable_operation_by_another, E::enable},
         {S::switched_on, S::being_enabled, S::quick_stopped},
         {V::target, V::shown_target}},
        {"enable is shown as a word", E::enable, answering.but(enabled), {}, {}, V::controlword},
        {"enable before a disable is answered begins anew", E::enable, S::being_disabled, {V::shown_velocity, V::target, V::shown_target}},
        {"enable changes nothing where it is enabled or in fault", E::enable, enabled | faults | absent},
        {"enable ends a halt bit, and nothing goes on for that",
         E::enable,
         halts,
         {V::halt, V::end_of_halt, V::active, V::waiting, V::bit_12, V::shown_velocity},
         {{V::controlword, "15"}}},
        {"a reset by command forgets nothing", E::reset_fault, any},
        // ---- values ----
        {"the same mode forgets nothing", E::same_mode, any},
        {"another mode forgets the speed and what waits",
         {E::another_mode, E::another_mode_and_velocity},
         any,
         {V::shown_velocity, V::waiting, V::end_of_halt, V::ordered_velocity, V::bit_12, V::bit_13},
         {{V::mode, "3"}, {V::mode_after_stream, "3"}}},
        {"another mode than velocity",
         {E::another_mode, E::another_mode_and_velocity},
         turns,
         {},
         {{V::mode, "1"}, {V::mode_after_stream, "1"}}},
        {"a speed that comes with its mode is kept", E::another_mode_and_velocity, any, {}, {{V::shown_velocity, "77"}}},
        {"a speed that comes with its mode moves the axis",
         E::another_mode_and_velocity,
         free.but(S::turning),
         V::active,
         {{V::set_points, "+1"}, {V::ordered_velocity, "77"}}},
        {"a speed that comes with its mode waits for the end of a halt",
         E::another_mode_and_velocity,
         S::halted,
         {},
         {{V::end_of_halt, "velocity 77"}}},
        {"another mode forgets the speed and what waits, though it is left again",
         E::another_mode_and_back,
         any,
         {V::shown_velocity, V::waiting, V::ordered_velocity}},
        {"bit 12 falls with the mode", E::another_mode_and_back, any.but(streams), V::bit_12},
        {"the end of a halt does not go on with an old speed", E::another_mode_and_back, S::turning_halted, V::end_of_halt},
        {"a mode that is chosen during a stream outlasts it", E::another_mode_and_back, S::following, {}, {{V::mode_after_stream, "8"}}},
        {"a mode that is chosen during a stream outlasts it",
         E::another_mode_and_back,
         S::following_speed,
         {},
         {{V::mode_after_stream, "9"}}},
        {"a target velocity is shown", E::target_velocity_zero, any, V::shown_velocity},
        {"a target velocity is ordered", E::target_velocity_zero, S::turning, V::ordered_velocity, {{V::set_points, "+1"}}},
        {"a target velocity under halt is what its end goes on with", E::target_velocity_zero, S::turning_halted, V::end_of_halt},
        {"a target is its client's alone", E::target_of_another, any, {}, {{V::shown_target, "4000"}}},
        {"speeds are their client's alone", E::speeds_of_another, any, {}, {{V::shown_speeds, "21 31 41"}}},
        // ---- commands ----
        {"an order that is refused leaves the motion of another as it is", {E::home_refused, E::move_refused}, running},
        {"homing forgets the motion and what waits",
         E::home,
         homable,
         {V::active, V::waiting, V::end_of_halt, V::bit_12},
         {{V::mode, "6"}, {V::mode_after_stream, "6"}, {V::homing_method, "35"}}},
        {"homing that is refused is shown, and its mode with it",
         E::home_refused,
         homable.but(running),
         {V::active, V::waiting, V::end_of_halt, V::bit_12},
         {{V::mode, "6"}, {V::mode_after_stream, "6"}, {V::homing_method, "35"}, {V::bit_13, "1"}}},
        {"homing forgets the speed when the drive has taken it", E::home, homable, {V::bit_13, V::ordered_velocity}},
        {"homing is refused in fault, under halt, in quick stop, and where nobody is heard", homings,
         absent | faults | halts | S::quick_stopped},
        {"set position is refused while the axis moves, and at rest there is nothing to forget", E::set_position, any},
        {"set position that is refused forgets nothing", E::set_position_refused, any},
        {"a motion forgets what waits", taken, free, V::waiting},
        {"bit 12 falls with what waited", taken, S::waiting, V::bit_12},
        {"a motion is refused under halt, in other states, and where nobody is heard", moves, any.but(free)},
        {"a motion to a place is of its mode",
         positions,
         free,
         V::bit_13,
         {{V::mode, "1"}, {V::mode_after_stream, "1"}, {V::shown_target, "600"}}},
        {"and at rest it is, too, where it is refused",
         E::move_refused,
         free.but(running),
         V::bit_13,
         {{V::mode, "1"}, {V::mode_after_stream, "1"}, {V::shown_target, "600"}}},
        {"a motion by a distance is shown by its end", E::move_relative, free, {}, {{V::shown_target, "670"}}},
        {"a motion that is taken is counted and forgets the speed", positions, free, V::ordered_velocity, {{V::set_points, "+1"}}},
        {"a motion to a place", E::move_absolute, free.but({S::standing, S::homing_refused}), {}, {{V::active, "600"}}},
        {"a motion by a distance", E::move_relative, free.but({S::standing, S::homing_refused}), {}, {{V::active, "670"}}},
        {"a motion that is taken while bit 4 is set sets bit 12", positions, homes, {}, {{V::bit_12, "1"}}},
        {"a motion with a speed forgets the place",
         E::move_velocity,
         free,
         {V::active, V::bit_12, V::bit_13},
         {{V::mode, "3"}, {V::mode_after_stream, "3"}, {V::shown_velocity, "600"}, {V::ordered_velocity, "600"}, {V::set_points, "+1"}}},
        {"a joint start forgets nothing", E::start_together, any},
        // ---- streams ----
        {"a stream forgets all motion", streamed, free, motion | V::bit_13, {{V::bit_12, "1"}}},
        {"a stream of positions", E::stream_position, free, {}, {{V::mode, "8"}, {V::shown_target, "41"}}},
        {"a stream of velocities", E::stream_velocity, free, {}, {{V::mode, "9"}, {V::shown_velocity, "91"}}},
        {"a stream is refused under halt, in other states, and where nobody is heard", streamed, any.but(free)},
        {"the end of a stream forgets its speed", E::end_of_stream, streams, {V::shown_velocity, V::bit_12}, {{V::mode, "1"}}},
        {"the end of no stream forgets nothing", E::end_of_stream, any.but(streams)},
        // ---- what the drive says ----
        {"the same again forgets nothing", E::same_again, any},
        {"the first word of a drive says where it is",
         {E::same_again, E::arrived, E::power_lost, E::fault, E::stopped_at_the_drive},
         S::unheard,
         {},
         {{V::referenced, "1"}, {V::commanded, "1"}, {V::position, "70"}}},
        {"a stop at the drive is seen from its first word on", E::stopped_at_the_drive, S::unheard, {}, {{V::quick_stop, "1"}}},
        {"a motion that has arrived is forgotten", E::arrived, any, V::active},
        {"what waits begins when the motion has arrived", E::arrived, S::waiting, {V::waiting, V::bit_12}},
        {"what has arrived is not gone on with", E::arrived, S::halted, V::end_of_halt},
        {"a fault at rest is commanded no more", E::arrived, S::reacting, V::commanded},
        {"power that is lost without our order forgets nothing where there is none", E::power_lost, any.but(enabled)},
        {"a fault forgets the motion and what waits", E::fault, any, {V::active, V::waiting, V::end_of_halt}},
        {"a fault is no halt and no quick stop", E::fault, halts | S::quick_stopped, {V::halt, V::quick_stop}},
        {"bit 12 falls with what waited", E::fault, {S::waiting, S::halted}, V::bit_12},
        {"a fault at rest is commanded no more", E::fault, at_rest | S::quick_stopped, V::commanded},
        {"a stop at the drive changes nothing without power or in fault", E::stopped_at_the_drive, any.but(enabled)},
        // ---- who serves the axis ----
        {"a change of presence forgets all motion", served, any, motion | Values{V::bit_13, V::quick_stop, V::controlword}},
        {"a change of presence forgets written targets", served, any, V::target},
        {"a change of presence forgets what the drive has said", served, any, {V::referenced, V::commanded}},
        {"silence keeps the last position, another drive begins with its own", E::another_drive, any, V::position},
        {"another drive is seen by what it says itself",
         E::another_drive_that_is_on,
         any,
         {},
         {{V::referenced, "1"}, {V::commanded, "1"}, {V::position, "70"}}},
        {"a change of presence ends the stream", served, streams, {}, {{V::mode, "1"}}},
        {"silence that goes on changes nothing", E::silence, S::silent, {}, {}, {}, V::shown_velocity},
        {"who serves it already changes nothing", E::same_presence, any},
    };
}

}  // namespace axisgate::forgetting
