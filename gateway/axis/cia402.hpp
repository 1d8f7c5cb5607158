// The state machine of CiA 402 (IEC 61800-7-201) for any drive: power states, control word, status word, modes 1, 3, 6 and, for streamed
// set-points, 8 to 10. It gets control words, set-points and commands, the drive's feedback and the results of orders, and returns orders
// for the adapter and the status word. A refused request changes nothing.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/axis/authority.hpp"
#include "gateway/axis/guard.hpp"
#include "gateway/axis/image.hpp"
#include "gateway/core/command.hpp"
#include "gateway/core/sample.hpp"

namespace axisgate {

enum class PowerState : std::uint8_t {
    not_ready_to_switch_on,  ///< no drive answers
    switch_on_disabled,
    ready_to_switch_on,
    switched_on,
    operation_enabled,
    quick_stop_active,
    fault_reaction_active,
    fault
};
[[nodiscard]] std::string_view name_of(PowerState state) noexcept;
/// The state in a status word, by the masks of the state coding table of IEC 61800-7-201.
[[nodiscard]] PowerState power_state_of(std::uint16_t statusword) noexcept;

namespace cia402 {
// control word bits
inline constexpr std::uint16_t cw_switch_on = 1u << 0, cw_enable_voltage = 1u << 1, cw_quick_stop = 1u << 2 /* low active */,
                               cw_enable_operation = 1u << 3, cw_new_setpoint = 1u << 4 /* mode 6: start homing */,
                               cw_change_immediately = 1u << 5, cw_relative = 1u << 6, cw_fault_reset = 1u << 7, cw_halt = 1u << 8;
// status word bits
inline constexpr std::uint16_t sw_ready = 1u << 0, sw_switched_on = 1u << 1, sw_operation_enabled = 1u << 2, sw_fault = 1u << 3,
                               sw_voltage = 1u << 4, sw_quick_stop = 1u << 5 /* low active */, sw_switch_on_disabled = 1u << 6,
                               sw_warning = 1u << 7, sw_simulated = 1u << 8, sw_remote = 1u << 9, sw_target_reached = 1u << 10,
                               sw_internal_limit = 1u << 11, sw_mode_12 = 1u << 12 /* set-point acknowledged, speed 0, homing attained */,
                               sw_mode_13 = 1u << 13 /* mode 6: homing error */, sw_stale = 1u << 14, sw_referenced = 1u << 15;
inline constexpr std::int16_t mode_none = 0, mode_profile_position = 1, mode_profile_velocity = 3, mode_homing = 6, mode_profile_torque = 4,
                              mode_interpolated_position = 7, mode_cyclic_position = 8, mode_cyclic_velocity = 9, mode_cyclic_torque = 10;
/// The mode of operation in which an axis follows streamed set-points of this kind.
[[nodiscard]] constexpr std::int16_t mode_of(SetPoint::Mode m) noexcept {
    return m == SetPoint::Mode::position ? mode_cyclic_position : m == SetPoint::Mode::velocity ? mode_cyclic_velocity : mode_cyclic_torque;
}
/// The substitute if a drive does not have that mode: interpolated position for cyclic position, profile torque for cyclic torque.
[[nodiscard]] constexpr std::int16_t older_mode_of(SetPoint::Mode m) noexcept {
    return m == SetPoint::Mode::position ? mode_interpolated_position : m == SetPoint::Mode::torque ? mode_profile_torque : mode_none;
}
/// Modes that follow streamed set-points: the first set-point enters them, the last one leaves them.
[[nodiscard]] constexpr bool is_streamed(std::int16_t mode) noexcept {
    return mode == mode_profile_torque || (mode >= mode_interpolated_position && mode <= mode_cyclic_torque);
}
/// For example "profile position"; "of the maker" for negative numbers.
[[nodiscard]] std::string_view text_of_mode(std::int16_t mode) noexcept;
}  // namespace cia402

class Cia402Axis {
public:
    /// The decision about a request. `orders` go to the adapter in this order; if there are none and no refusal, the request is done
    /// already.
    struct Decision {
        std::vector<CommandBody> orders;
        /// A set-point that was buffered behind the running one; on_feedback returns it when its turn has come.
        std::optional<Move> waits;
        bool refused = false;
        Reason reason = Reason::none;
        std::string text;
    };

    /// Checks the orders of a request before anything is changed; a refusal leaves the axis as it was.
    using Look = std::function<std::optional<Refusal>(const Decision&)>;

    /// Applies registers 32..47: values are latched, then the control word is followed. Set-points act on edges, never on levels: on edges
    /// between words that this client has written itself. A stop, an enable or a motion by another client is not undone by words that are
    /// only repeated; this requires a fresh edge (bit 4 rises, bit 8 falls, the enabling bits return, another target velocity). If a client
    /// has written nothing since a stop, its previous word is unknown, so its first words are no edge. A word that ends a motion or the
    /// power is followed even if another value in it is refused, in whatever state the axis is shown while it moves or may move; to a drive
    /// that does not answer, only such a word is sent. `by` is the client whose registers these are: a set-point moves with the target and
    /// the profile that its own client has written, never with another client's. A profile velocity that this client has not written, or
    /// has written as 0, is refused with the set-point.
    [[nodiscard]] Decision on_process_data(const ProcessData& data, const Origin& by = {}, const Look& look = {});
    /// Applies the commands of POST /axes/{name}/commands (all bodies except ProcessData, parameters and the like).
    [[nodiscard]] Decision on_command(const CommandBody& body, const Origin& by = {});
    /// The engine reports whether a record of motion exists for the axis: it may then be moving whatever state the drive reports.
    void on_motion(bool recorded) noexcept { s_.recorded = recorded; }
    /// True if bit 8 (halt) is set and keeps the axis from moving.
    [[nodiscard]] bool halted() const noexcept { return s_.halted; }
    /// Checks whether the axis may follow streamed set-points now; if not, `refused` has the reason.
    [[nodiscard]] Decision may_follow() const;
    /// The axis follows this set-point: the mode is the set-point's until the stream ends. The first one discards a motion in progress.
    /// `mode` is the mode in which the drive follows it.
    void follow(const SetPoint& set_point, std::int16_t mode);
    void follow(const SetPoint& set_point) { follow(set_point, cia402::mode_of(set_point.mode)); }
    /// The stream has ended; the former mode is valid again.
    void end_following();
    /// The drive has accepted an order, or has refused it.
    void on_order_result(const CommandBody& order, bool good, Instant now);
    /// Applies the drive's feedback and returns the orders that follow from it: a buffered set-point whose turn has come, or the stop of a
    /// drive that reports a fault and still moves (the fault reaction, which is ordered again every second until the axis stands or has no
    /// fault).
    [[nodiscard]] std::optional<CommandBody> on_feedback(const AxisFeedback& feedback, Instant now);
    /// The side that serves the axis has changed. Set-points and buffered motions are discarded, so that nothing moves because something
    /// started.
    void on_presence(Presence presence);

    [[nodiscard]] PowerState state() const noexcept { return s_.state; }
    [[nodiscard]] const AxisFeedback& feedback() const noexcept { return s_.feedback; }
    [[nodiscard]] bool commanded() const noexcept;  ///< enabled, stopping, or about to be enabled: a twin must not take over now
    /// The end position of the running absolute or relative motion in increments; empty if none runs or the axis has arrived.
    [[nodiscard]] std::optional<std::int64_t> active_target() const noexcept;
    [[nodiscard]] bool at_rest() const noexcept { return !s_.feedback.moving && !s_.feedback.homing; }
    /// Writes all values of this class into the picture (stale and authority are the engine's).
    void fill(AxisPicture& picture) const noexcept;

private:
    /// The values that one client has written into registers 32..47. They are kept per client, so that the values of one client never move
    /// the axis for another.
    struct Words {
        std::optional<std::uint16_t> controlword;  // absent: unknown, because a stop came between
        std::optional<std::int16_t> mode;
        std::int32_t target_position = 0;
        bool target_known = false;                                       // since the last enable
        bool target_pending = false;                                     // written, and no set-point has used it yet
        std::uint32_t velocity = 0, acceleration = 0, deceleration = 0;  // 0: never written, or written as 0
        std::int32_t target_velocity = 0;
        bool velocity_known = false;           // false: unknown, because a stop came between
        std::uint64_t velocity_forgotten = 0;  // State::forgotten when the target velocity was written
        std::uint64_t enables = 0;             // State::enables to which `target_known` refers
        std::uint64_t turn = 0;                // State::turn that this client has seen, or caused
    };
    struct Client {
        AuthorityClient who;
        Words words;
        std::uint64_t used = 0;
    };
    static constexpr std::size_t most_clients = 32;  // the client that has not written for the longest time is removed; its values are
                                                     // unknown then
    /// The cause for which values of a request are discarded.
    enum class Cause : std::uint8_t {
        motion_ends,     ///< power on or off, a stop, another serving drive, the begin of a stream
        fault,           ///< the drive has a fault
        halt_command,    ///< Halt by command
        halt_bit,        ///< bit 8 of the control word
        mode_left,       ///< while the axis turned at a speed
        new_mode,        ///< an old speed must not start the axis in it
        stream_ends,     ///< and the former mode is valid again
        set_point,       ///< a set-point that takes effect at once
        motion_asked,    ///< by command
        homing_asked,    ///< by command
        homing_taken,    ///< the axis does not turn at that speed any more: the same speed is a new order
        velocity_taken,  ///< the motion has no target
        position_set,    ///< the target was a position of the old count
        arrival          ///< the motion has ended
    };
    struct State {
        void forget(Cause cause);
        void leave_stream();
        void take_motion(const CommandBody& body);
        void end_turn() noexcept;
        [[nodiscard]] bool runs() const noexcept;
        [[nodiscard]] bool reached() const noexcept;
        [[nodiscard]] PowerState state_when_off() const noexcept;
        [[nodiscard]] std::uint16_t mode_bits() const noexcept;

        PowerState state = PowerState::not_ready_to_switch_on;
        Presence presence = Presence::offline;
        AxisFeedback feedback;
        bool seen = false;                      // since the present side serves the axis
        Presence received = Presence::offline;  // the side whose feedback is stored; offline: none
        std::uint16_t controlword = 0;
        std::int16_t mode = cia402::mode_none;
        std::uint64_t enables = 0;    // increases when the axis is enabled: targets written by other clients become invalid
        bool ordered_on = false;      // a client has enabled it since this gateway, or another serving side, found it
        std::uint64_t forgotten = 0;  // increases when a target velocity is discarded
        std::uint64_t turn = 1;       // increases with each event that repeated words of other clients must not undo
        bool stopped = true;          // the last turn was a stop, a loss or a start, and not a client's order to move or enable
        bool recorded = false;        // the argument of on_motion
        // As registers 34..41 show it: the value written last, or the value in force since the last motion that a drive accepted, of any
        // client.
        std::int32_t target_position = 0;
        std::uint32_t profile_velocity = 0;
        std::uint32_t profile_acceleration = 0;
        std::uint32_t profile_deceleration = 0;
        std::int32_t target_velocity = 0;
        std::int16_t homing_method = 0;
        std::uint16_t setpoints_accepted = 0;
        std::uint16_t virtual_step = 0;  // 0 switch on disabled, 1 ready, 2 switched on (where the drive knows only "off"); 3 enabled by
                                         // the gateway
        std::int8_t power_pending = -1;  // -1 none, 0 off ordered, 1 on ordered
        Instant power_known_at{};        // feedback up to this instant may be older than the acknowledged power order
        bool quick_stopped = false;      // quick stop active until a control word or command leaves it
        bool setpoint_acknowledged = false;  // bit 12 in mode 1
        int repeated_moves = 0;              // number of moves on their way to the drive that are no new set-points: after a halt, or
                                             // buffered before
        int asked_motions = 0;               // number of moves by command while another motion runs, not yet answered by the drive
        bool halted = false;
        bool homing_refused = false;  // the last homing was refused: bit 13 is set, and an older "attained" is not shown
        bool reacting = false;        // the stop of the present fault is on its way, or was accepted
        Instant reaction_at{};
        std::int64_t ordered_velocity = 0;           // mode 3: the last velocity given to the drive
        std::optional<std::int64_t> asked_velocity;  // mode 3: a velocity from control words, on its way to the drive
        bool following = false;                      // streamed set-points are followed in a mode of their own
        std::int16_t mode_before = cia402::mode_none;
        std::optional<Move> active;    // the motion that a halt interrupts and its end continues (absolute target)
        std::optional<Move> buffered;  // one set-point that waits for the running one
    };

    [[nodiscard]] Decision refuse(Reason reason, std::string text) const;
    [[nodiscard]] Decision unreceived(const State& s) const;
    [[nodiscard]] Decision in_fault(const State& s) const;
    /// One block of registers during its evaluation: the word, this client's previous word, and the request.
    struct Request {
        const ProcessData& data;
        Words& own;
        std::uint16_t before = 0;
        std::uint16_t word = 0;
        bool known = true;    // the client's previous values are known
        bool current = true;  // no other client has stopped, enabled or moved the axis since; otherwise only an edge acts
        bool fresh = false;   // its words request motion or power by an edge of their own
        [[nodiscard]] std::uint16_t rising() const noexcept { return word & static_cast<std::uint16_t>(~before); }
        [[nodiscard]] std::uint16_t falling() const noexcept { return before & static_cast<std::uint16_t>(~word); }
        /// A bit that stops by being 0 counts as falling if the previous word is unknown, so that a stop is never missed.
        [[nodiscard]] bool stops_by(std::uint16_t bit) const noexcept { return !(word & bit) && (!known || (before & bit)); }
        /// A bit that acts by being 1: its edge, or its level if the previous word is unknown.
        [[nodiscard]] bool begins(std::uint16_t bit) const noexcept {
            return data.controlword && (word & bit) && (!known || (rising() & bit));
        }
        [[nodiscard]] bool enables_anew() const noexcept;
        [[nodiscard]] bool is_fresh() const noexcept;
    };
    [[nodiscard]] Client& client(const AuthorityClient& who);
    void latch_values(State& s, const Request& r, Decision& d) const;
    [[nodiscard]] bool change_unreceived(State& s, const Request& r, Decision& d) const;
    void change_power(State& s, const Request& r, Decision& d) const;
    void stop_in_any_state(State& s, const Request& r, Decision& d) const;
    [[nodiscard]] bool change_motion(State& s, const Request& r, Decision& d) const;
    [[nodiscard]] bool change_without_power(State& s, const Request& r, Decision& d) const;
    void change_halt(State& s, const Request& r, Decision& d) const;
    [[nodiscard]] bool change_homing(State& s, const Request& r, bool starts, Decision& d) const;
    void change_velocity(State& s, const Request& r, Decision& d) const;
    [[nodiscard]] bool new_set_point(State& s, const Request& r, Decision& d) const;
    [[nodiscard]] Decision may_home(const State& s) const;
    void settle(State& s) const;
    static void enable(State& s, Words* own, Decision& d);
    static void order_on(State& s, Words* own, Decision& d);
    static void order_off(State& s, Decision& d);
    static void order_off_blindly(State& s, Decision& d);
    static void order_reset(State& s, Decision& d);
    static void ask_motion(State& s, const CommandBody& body);
    [[nodiscard]] static bool asked_beside_another(State& s, const CommandBody& order, bool good);
    State s_;
    std::vector<Client> clients_;
    std::uint64_t uses_ = 0;
};

}  // namespace axisgate
