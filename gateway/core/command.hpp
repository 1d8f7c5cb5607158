// A command for one axis (or drive), and its one answer, the Result. Doors make commands of the requests of their protocols; the engine and
// (except for ProcessData and Hand) the adapters carry them out. Positions, velocities and accelerations are in the axis' increments;
// details of a door's or drive's protocol are not included.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gateway/core/ids.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/core/value.hpp"

namespace axisgate {

/// The door of a client, as the number in register 17 (command authority). Each door brings its own number and name
/// (gateway/core/door_names.hpp); `none` and `internal`, the gateway itself, are not doors of clients.
enum class Door : std::uint8_t { none = 0, internal = 5 };
[[nodiscard]] std::string_view name_of(Door door) noexcept;
[[nodiscard]] constexpr bool has_clients(Door door) noexcept { return door != Door::none && door != Door::internal; }

/// The client: the door and a text for events ("192.0.2.7:51123", "token commissioning").
struct Origin {
    Door door = Door::internal;
    std::shared_ptr<const std::string> who;
    /// The stable part of the name, by which a client holds an axis ("anna", "192.0.2.7 panel"); absent: `who` without its port.
    std::shared_ptr<const std::string> client{};
    [[nodiscard]] std::string text() const { return std::string(name_of(door)) + (who ? " " + *who : std::string()); }
};

// --- bodies -----------------------------------------------------------------------------------------------------------

struct Enable {};     ///< to CiA 402 operation enabled; the actual position becomes the first target, the target velocity 0
struct Disable {};    ///< power off
struct QuickStop {};  ///< stop on the quick-stop ramp, then CiA 402 quick stop active
struct Halt {};       ///< stop on the profile ramp, stay enabled
struct ResetFault {};
struct Home {
    std::int16_t method = 0;  ///< CiA 402 homing method; 0: the drive's own
};
struct SetPosition {
    std::int64_t position = 0;  ///< the new value of the present position, increments
};
/// A motion. For absent values the drive uses its present ones.
struct Move {
    enum class Kind : std::uint8_t { absolute, relative, velocity };
    Kind kind = Kind::absolute;
    std::int64_t target = 0;                   ///< increments, or increments/s (signed) for `velocity`
    std::optional<std::int64_t> velocity;      ///< increments/s, > 0; not used by Kind::velocity
    std::optional<std::int64_t> acceleration;  ///< increments/s^2, > 0
    std::optional<std::int64_t> deceleration;  ///< increments/s^2, > 0
    bool prepare_only = false;                 ///< prepare only; StartTogether starts it
    /// Dead-man time of a velocity move, ms (100..10000): the axis is halted when it has passed without the same command again. The
    /// repetition causes no exchange with the drive.
    std::optional<std::int64_t> hold_ms;
    /// With hold_ms: only renews a held move and never starts one; refused if the axis does not move by this held move any more. A renewal
    /// that arrives after the stop that follows it then starts nothing.
    bool renew_only = false;
};
/// Starts several prepared axes of one line at the same instant. Command::axis is the first of them.
struct StartTogether {
    std::vector<AxisId> axes;
};
struct ReadParameter {
    Point point;
};
/// `value` was checked against the catalogue's type and range before it reaches an adapter.
struct WriteParameter {
    Point point;
    Value value;
};
/// One exchange in the drive's own language. The answer is in the Result's `text` (and `bytes`).
struct Native {
    std::vector<std::uint8_t> send;
    bool is_text = true;  ///< the client gave text (`{"send": ...}`), which the family completes (terminator, checksum, address)
};
/// A function of one family beyond the common ones, by its catalogue name ("program.download", "start_group").
struct Action {
    std::string name;
    std::string argument;
    /// For a command with typed arguments: one value per argument of the catalogue, in its order, in the drive's counts; checked before.
    std::vector<Value> values{};
};
/// Sets one of the twin's external conditions ("stall", "power", "inputs"). Only for simulated drives.
struct Hand {
    std::string name;
    Value value;
};
/// Registers 32..47 of the standard map: those present are applied together, the control word last.
struct ProcessData {
    std::optional<std::uint16_t> controlword;
    std::optional<std::int16_t> mode;
    std::optional<std::int32_t> target_position;
    std::optional<std::uint32_t> profile_velocity;
    std::optional<std::uint32_t> profile_acceleration;
    std::optional<std::uint32_t> profile_deceleration;
    std::optional<std::int32_t> target_velocity;
    std::optional<std::int16_t> homing_method;
};
/// Not a command to the drive: takes, renews, releases or hands over the lease by which only one client commands the axis.
struct HoldAxis {
    enum class Kind : std::uint8_t { take, release, hand_over };
    Kind kind = Kind::take;
    std::int64_t lease_s = 30;  ///< 1..3600
    bool take_over = false;     ///< take the lease from another client; the door has checked that this one may
    std::string to;             ///< hand_over: the next holder, "modbus 192.0.2.7"
};

using CommandBody = std::variant<Enable, Disable, QuickStop, Halt, ResetFault, Home, SetPosition, Move, StartTogether, ReadParameter,
                                 WriteParameter, Native, Action, Hand, ProcessData, HoldAxis>;

struct Command {
    Ticket ticket = no_ticket;
    AxisId axis = no_axis;
    CommandBody body;
    /// false: the Result comes when the drive has acknowledged. true: when the command is done (target reached, homed, powered). An adapter
    /// gets true only for actions whose completion in the catalogue is `reported`.
    bool until_done = false;
    Origin origin;
};

/// Stop, quick stop and disable overtake every queue.
[[nodiscard]] inline bool is_urgent(const CommandBody& b) noexcept {
    return std::holds_alternative<QuickStop>(b) || std::holds_alternative<Halt>(b) || std::holds_alternative<Disable>(b);
}

/// The position or speed of an axis for as long as this is renewed, for clients that send it in cycles. It has no ticket and no answer; the
/// newest one counts, and an older one that was not sent yet is dropped. The first one begins a stream, whose begin and end are one event
/// each; accepted and refused set-points, and the reason, are state of the axis (AxisPicture). One client streams to an axis at a time.
struct SetPoint {
    enum class Mode : std::uint8_t { position, velocity, torque };  ///< CiA 402 modes 8, 9 and 10
    static constexpr Duration good_for_min = std::chrono::milliseconds(20), good_for_max = std::chrono::seconds(10);
    AxisId axis = no_axis;
    Mode mode = Mode::position;
    std::int64_t value = 0;                    ///< increments; increments/s; 1/1000 of the rated torque
    std::optional<std::int64_t> velocity;      ///< the highest speed of the motion, increments/s, > 0; not used by Mode::velocity
    std::optional<std::int64_t> acceleration;  ///< increments/s^2, > 0; absent (as for all three): the drive's present value
    std::optional<std::int64_t> deceleration;  ///< increments/s^2, > 0
    /// If no further one arrives for this time, its client counts as lost (LossCause::set_points_silent).
    Duration good_for = std::chrono::milliseconds(500);
    Instant at{};  ///< when the client's message arrived; a set-point older than good_for is refused when its turn comes
    Origin origin;
    /// The motion that it requests, for the comparison with the axis' limits. Not for torque.
    [[nodiscard]] Move as_move() const {
        Move m;
        m.kind = mode == Mode::velocity ? Move::Kind::velocity : Move::Kind::absolute;
        m.target = value;
        if (mode != Mode::velocity) m.velocity = velocity;
        m.acceleration = acceleration;
        m.deceleration = deceleration;
        return m;
    }
};
/// "position", "velocity", "torque".
[[nodiscard]] std::string_view name_of(SetPoint::Mode mode) noexcept;
[[nodiscard]] std::optional<SetPoint::Mode> set_point_mode_of(std::string_view name) noexcept;

/// The name of the command in messages: "move_absolute", "enable", ... (the names of POST /axes/{name}/commands).
[[nodiscard]] std::string_view name_of(const CommandBody& body) noexcept;

// --- the answer -------------------------------------------------------------------------------------------------------

enum class Outcome : std::uint8_t {
    accepted,  ///< the drive acknowledged it
    done,      ///< the drive acknowledged it, and it is finished
    refused,   ///< nothing reached the drive, or the drive refused; nothing changed
    failed     ///< it was begun and did not come to its end, or its end is unknown
};
[[nodiscard]] std::string_view name_of(Outcome outcome) noexcept;

/// The reason of a refusal or failure. Doors map it to Modbus exceptions and HTTP status codes.
enum class Reason : std::uint8_t {
    none,
    out_of_range,   ///< a value outside its type or range: Modbus exception 3, HTTP 422
    unknown_point,  ///< no such parameter, element or function: 2, 404
    not_writable,   ///< read only: 2, 409
    wrong_state,    ///< the state of the axis does not allow it (not enabled, fault, moving): 4, 409
    not_supported,  ///< this drive cannot do that: 4, 409
    drive_refused,  ///< the drive answered with an error, which is in `code`: 4, 409
    busy,           ///< a queue or the parameter channel is full: 6, 503
    line_down,      ///< the line is down, or the axis is not configured: 0x0A, 503
    no_answer,      ///< the drive did not answer: 0x0B, 504
    interrupted,    ///< another command, a stop or a fault ended it: 4, 409
    authority,      ///< another client holds the axis: 6, 409
    not_stored,     ///< the drive accepted it but the database could not store it: 4, 507
    internal        ///< a fault of the gateway itself: 4, 500
};
[[nodiscard]] std::string_view name_of(Reason reason) noexcept;

struct Result {
    Ticket ticket = no_ticket;
    AxisId axis = no_axis;
    Outcome outcome = Outcome::done;
    Reason reason = Reason::none;
    std::int32_t code = 0;            ///< the drive's own error code, 0 if it has none
    std::string text;                 ///< for people: what happened, why, and the remedy; or the answer to a Native command
    Value value;                      ///< ReadParameter: the value; WriteParameter: the value that the drive accepted
    std::vector<std::uint8_t> bytes;  ///< Native: the raw answer
};

[[nodiscard]] inline bool good(const Result& r) noexcept { return r.outcome == Outcome::accepted || r.outcome == Outcome::done; }

}  // namespace axisgate
