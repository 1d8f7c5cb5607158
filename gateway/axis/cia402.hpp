// CiA 402: the power state machine, control word, status word and modes 1, 3, 6 and, streamed, 8 to 10 (IEC 61800-7-201) over any drive.
// In: control words, set-points, commands; what the drive says; which orders it took. Out: orders for the adapter, the status word.
// Never knows a family, a clock or a door. A refused request changes nothing.
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
    not_ready_to_switch_on,  ///< nobody answers
    switch_on_disabled,
    ready_to_switch_on,
    switched_on,
    operation_enabled,
    quick_stop_active,
    fault_reaction_active,
    fault
};
[[nodiscard]] std::string_view name_of(PowerState state) noexcept;
/// State of a status word by the masks of IEC 61800-7-201, table of the state coding.
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
/// The one that serves where a drive has not that one: interpolated position for cyclic position, profile torque for cyclic torque.
[[nodiscard]] constexpr std::int16_t older_mode_of(SetPoint::Mode m) noexcept {
    return m == SetPoint::Mode::position ? mode_interpolated_position : m == SetPoint::Mode::torque ? mode_profile_torque : mode_none;
}
/// Modes that follow streamed set-points: entered by the first one, left with the last.
[[nodiscard]] constexpr bool is_streamed(std::int16_t mode) noexcept {
    return mode == mode_profile_torque || (mode >= mode_interpolated_position && mode <= mode_cyclic_torque);
}
/// "profile position"; "of the maker" for negative ones.
[[nodiscard]] std::string_view text_of_mode(std::int16_t mode) noexcept;
}  // namespace cia402

class Cia402Axis {
public:
    /// What is to be done about a request. `orders` go to the adapter in this order; with none and no refusal it is done already.
    struct Decision {
        std::vector<CommandBody> orders;
        /// A set-point that was buffered behind the running one: on_feedback gives it back when its turn has come.
        std::optional<Move> waits;
        bool refused = false;
        Reason reason = Reason::none;
        std::string text;
    };

    /// Looks at the orders of a request before anything is changed; a refusal leaves the axis as it was.
    using Look = std::function<std::optional<Refusal>(const Decision&)>;

    /// Registers 32..47: values are latched, then the control word is followed. Set-points act on edges, never on levels: edges of what
    /// this client has written itself. What was stopped, enabled or set in motion by somebody else since is not undone by words that are
    /// merely repeated: it takes a fresh edge (bit 4 rises, bit 8 falls, the enabling bits come back, another target velocity). Of a client
    /// that was not heard since a stop it is not known what it wrote before, so that its first words are no edge. A word that ends a motion
    /// or the power is followed even if something else in it cannot be, in whatever state the axis is shown while it moves or may move;
    /// without a drive that answers only such a word is sent. `by`: whose registers these are. A set-point moves with the target and the
    /// profile that its own client has written, never with another's; a profile velocity that this client has not written, or wrote as 0,
    /// is refused with the set-point.
    [[nodiscard]] Decision on_process_data(const ProcessData& data, const Origin& by = {}, const Look& look = {});
    /// The commands of POST /axes/{name}/commands (all bodies but ProcessData, parameters and the like).
    [[nodiscard]] Decision on_command(const CommandBody& body, const Origin& by = {});
    /// Whether a record of motion exists for the axis (the engine's word): it may be moving, whatever the drive says of its state.
    void on_motion(bool recorded) noexcept { s_.recorded = recorded; }
    /// Whether bit 8 (halt) is set, and keeps the axis from moving.
    [[nodiscard]] bool halted() const noexcept { return s_.halted; }
    /// Whether the axis may follow streamed set-points now: `refused` and why not, or not.
    [[nodiscard]] Decision may_follow() const;
    /// It follows this one: the mode is the set-point's until the stream ends. A motion under way is forgotten with the first.
    /// `mode`: in which the drive follows it.
    void follow(const SetPoint& set_point, std::int16_t mode);
    void follow(const SetPoint& set_point) { follow(set_point, cia402::mode_of(set_point.mode)); }
    /// The stream is over; the mode is again the one before it.
    void end_following();
    /// The drive took an order, or did not.
    void on_order_result(const CommandBody& order, bool good, Instant now);
    /// What the drive says. Gives back what is to be ordered because of it: a buffered set-point whose turn has come, or the stop of a
    /// drive that reports a fault and still moves (the fault reaction: asked for again every second until it stands or has no fault).
    [[nodiscard]] std::optional<CommandBody> on_feedback(const AxisFeedback& feedback, Instant now);
    /// Who answers now. A change forgets set-points and buffered motions: nothing moves because something started.
    void on_presence(Presence presence);

    [[nodiscard]] PowerState state() const noexcept { return s_.state; }
    [[nodiscard]] const AxisFeedback& feedback() const noexcept { return s_.feedback; }
    [[nodiscard]] bool commanded() const noexcept;  ///< enabled, stopping, or about to be: a twin must not take over now
    /// Where the running absolute or relative motion ends, increments; nothing while none runs or the axis has arrived.
    [[nodiscard]] std::optional<std::int64_t> active_target() const noexcept;
    [[nodiscard]] bool at_rest() const noexcept { return !s_.feedback.moving && !s_.feedback.homing; }
    /// Writes everything that this class knows into the picture (stale and authority are the engine's).
    void fill(AxisPicture& picture) const noexcept;

private:
    /// What one client has written into registers 32..47. Kept apart, so that one client's values never move the axis for another.
    struct Words {
        std::optional<std::uint16_t> controlword;  // absent: not known, since a stop came between
        std::optional<std::int16_t> mode;
        std::int32_t target_position = 0;
        bool target_known = false;                                       // since the last enable
        bool target_pending = false;                                     // written, and no set-point has used it yet
        std::uint32_t velocity = 0, acceleration = 0, deceleration = 0;  // 0: never written, or written as 0
        std::int32_t target_velocity = 0;
        bool velocity_known = false;           // false: not known, since a stop came between
        std::uint64_t velocity_forgotten = 0;  // State::forgotten when the target velocity was written
        std::uint64_t enables = 0;             // State::enables that `target_known` belongs to
        std::uint64_t turn = 0;                // State::turn that this client has seen, or made
    };
    struct Client {
        AuthorityClient who;
        Words words;
        std::uint64_t used = 0;
    };
    static constexpr std::size_t most_clients = 32;  // the one that wrote longest ago makes room; it counts as not known then
    /// Why something that was asked for is forgotten.
    enum class Cause : std::uint8_t {
        motion_ends,     ///< power goes on or off, a stop, another drive serves, a stream begins
        fault,           ///< the drive has one
        halt_command,    ///< Halt by command
        halt_bit,        ///< bit 8 of the word
        mode_left,       ///< while the axis turned at a speed
        new_mode,        ///< an old speed must not start the axis in it
        stream_ends,     ///< and the mode before it is back
        set_point,       ///< one that takes place at once
        motion_asked,    ///< by command
        homing_asked,    ///< by command
        homing_taken,    ///< it does not turn at that speed any more: the same speed is an order again
        velocity_taken,  ///< it has no target
        position_set,    ///< the target was a place by the old count
        arrival          ///< the motion is over
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
        bool seen = false;                      // since the present presence began
        Presence received = Presence::offline;  // whose feedback is kept: offline, nobody's
        std::uint16_t controlword = 0;
        std::int16_t mode = cia402::mode_none;
        std::uint64_t enables = 0;    // grows when the axis is enabled: written targets of others are forgotten
        bool ordered_on = false;      // somebody has enabled it since this gateway, or another speaker, found it
        std::uint64_t forgotten = 0;  // grows when a target velocity is forgotten
        std::uint64_t turn = 1;       // grows with what the repeated words of other clients must not undo
        bool stopped = true;          // the last turn was a stop, a loss or a beginning, not somebody's order to move or to enable
        bool recorded = false;        // on_motion
        // As registers 34..41 show it: written last, or in force since the last motion that a drive took, whoever gave it.
        std::int32_t target_position = 0;
        std::uint32_t profile_velocity = 0;
        std::uint32_t profile_acceleration = 0;
        std::uint32_t profile_deceleration = 0;
        std::int32_t target_velocity = 0;
        std::int16_t homing_method = 0;
        std::uint16_t setpoints_accepted = 0;
        std::uint16_t virtual_step = 0;  // 0 switch on disabled, 1 ready, 2 switched on: where the drive only knows "off"; 3 enabled by us
        std::int8_t power_pending = -1;  // -1 none, 0 off ordered, 1 on ordered
        Instant power_known_at{};        // feedback up to here may be older than the acknowledged power order
        bool quick_stopped = false;      // quick stop active until left by a control word or command
        bool setpoint_acknowledged = false;  // bit 12 in mode 1
        int repeated_moves = 0;              // moves on their way to the drive that are no new set-points: after a halt, or buffered before
        int asked_motions = 0;               // by command while another motion runs; the drive has not answered yet
        bool halted = false;
        bool homing_refused = false;  // the last homing was not taken: bit 13, and an older "attained" is not shown
        bool reacting = false;        // the stop of the present fault is on its way, or was taken
        Instant reaction_at{};
        std::int64_t ordered_velocity = 0;           // mode 3: last velocity given to the drive
        std::optional<std::int64_t> asked_velocity;  // mode 3: of words, on its way to the drive
        bool following = false;                      // streamed set-points, in a mode of their own
        std::int16_t mode_before = cia402::mode_none;
        std::optional<Move> active;    // motion that a halt interrupts and its end continues (absolute target)
        std::optional<Move> buffered;  // one set-point that waits for the running one
    };

    [[nodiscard]] Decision refuse(Reason reason, std::string text) const;
    [[nodiscard]] Decision unreceived(const State& s) const;
    [[nodiscard]] Decision in_fault(const State& s) const;
    /// One block of registers while it is looked at: the word, this client's word before it, and what it asks for.
    struct Request {
        const ProcessData& data;
        Words& own;
        std::uint16_t before = 0;
        std::uint16_t word = 0;
        bool known = true;    // what this client wrote before is known
        bool current = true;  // nobody has stopped, enabled or moved the axis since; else only an edge acts
        bool fresh = false;   // its words ask for motion or power by an edge of their own
        [[nodiscard]] std::uint16_t rising() const noexcept { return word & static_cast<std::uint16_t>(~before); }
        [[nodiscard]] std::uint16_t falling() const noexcept { return before & static_cast<std::uint16_t>(~word); }
        /// A bit that stops by being 0 counts as falling where the word before is not known: a stop is never missed for that.
        [[nodiscard]] bool stops_by(std::uint16_t bit) const noexcept { return !(word & bit) && (!known || (before & bit)); }
        /// A bit that acts by being 1: its edge, or where the word before is not known its level.
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
