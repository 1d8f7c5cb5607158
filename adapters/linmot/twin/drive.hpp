// A simulated drive without its wire: state machine, control and status words, motion command buffer, interpreter, mechanics.
// In: control words, motion commands, inputs, time. Out: StateVar, status and warn word, position, parameters.
// What happens inside happens at its own instant: advance() carries out, in order, all that was due since the last call.
// Written in several files: drive.cpp states and words, events.cpp what becomes due, commands.cpp the interpreter, table.cpp the
// command table, curves.cpp time curves, follow.cpp cams and winding, monitor.cpp supplies, temperatures, limits.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adapters/linmot/twin/cams.hpp"
#include "adapters/linmot/twin/master.hpp"
#include "adapters/linmot/twin/memory.hpp"
#include "adapters/linmot/twin/profile.hpp"
#include "adapters/linmot/twin/thermal.hpp"

namespace axisgate::linmot::twin {

enum State : std::uint8_t {
    not_ready = 0,
    switch_on_disabled = 1,
    ready_to_switch_on = 2,
    setup_error = 3,
    error = 4,
    hardware_tests = 5,
    ready_to_operate = 6,
    operation_enabled = 8,
    homing = 9,
    clearance = 10,
    to_initial = 11,
    aborting = 12,
    freezing = 13,
    quick_stop = 14,
    to_position = 15,
    jog_plus = 16,
    jog_minus = 17,
    linearizing = 18,
    phase_search = 19,
    special = 20
};
enum class Series : std::uint8_t { e1100, b1100 };

struct DriveSetup {
    Series series = Series::e1100;
    bool curve_key = true;
    bool force_key = true;
    std::uint16_t force_mask = 0;  ///< control word bits that a parameter forces ...
    std::uint16_t force_word = 0;  ///< ... and to what
    double trig_rise = 500'000;    ///< 0.1 um: target of the command that the run mode has configured for rising edges (0DExh) ...
    double trig_fall = 0;          ///< ... and for falling ones (0DFxh); choices, their parameters have no numbers
    Winding winding;
};

/// One entry of the command table: 64 bytes as the wire has them.
using TableEntry = std::array<std::uint8_t, 64>;

class Drive {
public:
    static constexpr Duration cycle = std::chrono::nanoseconds(312'500);   ///< of the interpreter and of conditions that are watched
    static constexpr Duration test_time = std::chrono::milliseconds(300);  ///< of the hardware tests [L128-130], exact by choice O-29

    static constexpr Duration sve_time = std::chrono::microseconds(500);  ///< [L4398]
    static constexpr Duration ptc_warn = std::chrono::milliseconds(100);  ///< a choice: the times of the PTC inputs have no UPID

    explicit Drive(const DriveSetup& setup) : setup_(setup) {}
    Drive(const Drive&) = delete;
    Drive& operator=(const Drive&) = delete;

    // --- power, software ------------------------------------------------------------------------------------------------
    void power_on(Instant now);
    void power_off(Instant now);
    void stop_software(Instant now);
    void start_software(Instant now);
    [[nodiscard]] bool software_runs() const noexcept { return running_; }

    // --- from the wire --------------------------------------------------------------------------------------------------
    void write_control_word(std::uint16_t word, Instant now);
    /// The bytes of a telegram go into the buffer; executed if its count is another than the last [L545-547].
    void write_motion_command(std::span<const std::uint8_t> bytes, Instant now);
    void advance(Instant now);
    /// The next instant at which something happens by itself; `never`.
    [[nodiscard]] Instant next_event() const;

    // --- what it shows, at the instant of the last advance --------------------------------------------------------------
    [[nodiscard]] std::uint16_t status_word() const;
    [[nodiscard]] std::uint16_t state_var() const;
    [[nodiscard]] std::uint16_t warn_word() const;
    [[nodiscard]] std::uint8_t state() const noexcept { return state_; }
    [[nodiscard]] std::uint16_t error_code() const noexcept { return error_; }
    [[nodiscard]] double actual() const { return actual_at(now_).position + offset_; }
    [[nodiscard]] double demand() const { return controlled() ? demand_at(now_).position : actual(); }
    [[nodiscard]] Point mechanics() const { return actual_at(now_); }
    [[nodiscard]] bool powered() const noexcept { return state_ >= operation_enabled; }
    [[nodiscard]] std::uint16_t control_word() const noexcept { return effective_; }
    [[nodiscard]] std::uint32_t ram(std::uint16_t upid) const;
    [[nodiscard]] std::uint16_t outputs_x4() const noexcept { return x4_outputs_; }
    [[nodiscard]] std::uint16_t outputs_x6() const noexcept { return x6_outputs_; }
    [[nodiscard]] std::uint64_t commands_done() const noexcept { return commands_done_; }
    /// The master encoder's count as the drive has it [L4403-4470].
    [[nodiscard]] double master() const { return master_.count(now_); }
    /// The force that is held, 0.1 N; nothing: the position is controlled.
    [[nodiscard]] std::optional<double> held_force() const { return force_control_ ? std::optional(force_target_) : std::nullopt; }
    [[nodiscard]] double encoder_edges() const { return master_.edges(now_); }

    // --- the tester's hand ----------------------------------------------------------------------------------------------
    struct Outside {
        bool stall = false;
        double lag_ms = 0;                 ///< the actual position follows the demand so late
        std::uint16_t x4_inputs = 0x0100;  ///< bit 0 = X4.3 ... ; X4.11 (SVE is apart)
        bool safe_voltage_enable = true;
        std::uint16_t x4_mask = 0;  ///< control word bits that come from X4 ...
        std::uint16_t x4_word = 0;
        std::uint16_t panel_mask = 0;  ///< control word bits that the PC tool has taken over ...
        std::uint16_t panel_word = 0;
        std::uint16_t copy_mask = 0xFFFF;                       ///< control word bits that the interface may set
        std::int64_t analog = 0;                                ///< X4.4
        std::int64_t encoder = 0;                               ///< edges of the master encoder, four to a period
        std::int64_t encoder_speed = 0;                         ///< edges/s
        std::int64_t force = 0;                                 ///< 0.1 N
        std::int64_t current = 0;                               ///< mA
        std::int64_t motor_supply = 7200, logic_supply = 2400;  ///< 10 mV
        std::int64_t temperature = 300;                         ///< controller, 0.1 deg C ...
        std::int64_t sensor = 0;                                ///< ... of this sensor, 1..8 in the order of 1BC6h..1BCDh; 0: of all
        bool motor_hot = false, ptc1_hot = false, ptc2_hot = false;
        bool limit_in = false, limit_out = false;
    };
    [[nodiscard]] const Outside& outside() const noexcept { return outside_; }
    void set_outside(const Outside& outside, Instant now);
    void trigger(bool rising, Instant now);
    void capture(Instant now);
    void move_by_hand(double physical, Instant now);
    void inject(std::uint16_t code, Instant now);

    Memory memory;
    std::map<std::uint16_t, TableEntry> table;
    std::map<std::uint16_t, Curve> curves;

    /// Whether this drive has the command; the header with count 0.
    [[nodiscard]] bool has(std::uint16_t header) const noexcept;
    [[nodiscard]] static bool listed(std::uint16_t header) noexcept;
    [[nodiscard]] static bool is_fatal(std::uint16_t code) noexcept;

private:
    using Bytes = std::array<std::uint8_t, 32>;
    struct Order {  ///< a VAI motion that begins later: after the running one, at an event
        std::uint8_t sub = 0;
        double value = 0;
        Ramps ramps;
    };
    struct Event {
        enum class Kind : std::uint8_t { none, rising, falling, upwards, downwards };
        enum class What : std::uint8_t { vai, table, curve, change, cam };
        Kind kind = Kind::none;
        What what = What::vai;
        Order order;
        double position = 0;
        std::uint16_t header = 0;
        Bytes bytes{};
    };
    struct Play {  ///< a time curve that runs
        bool active = false;
        std::uint16_t curve = 0;
        double offset = 0, scale = 1, seconds = 0;
        Instant begun{};
    };
    enum class Follow : std::uint8_t { none, cams, shot, winding };
    static constexpr std::size_t shot = 2;  ///< the cam that a trigger starts

    // drive.cpp
    void enter(std::uint8_t state, Instant now);
    void evaluate(Instant now);
    bool transit(Instant now);
    bool transit_enabled(Instant now);
    void raise(std::uint16_t code, Instant now);
    void unpower(Instant now);
    void compute_control_word(Instant now);
    [[nodiscard]] bool cw(int bit) const noexcept { return (effective_ >> bit & 1) != 0; }
    [[nodiscard]] bool controlled() const noexcept { return state_ >= operation_enabled; }
    [[nodiscard]] Point actual_at(Instant now) const;
    [[nodiscard]] Point demand_at(Instant now) const;
    [[nodiscard]] bool motion_active() const;
    [[nodiscard]] bool in_target() const;
    void freeze_mechanics(Instant now);
    // monitor.cpp
    void check_outside(Instant now);
    void warm(Instant now);
    void show_temperatures();
    [[nodiscard]] Instant monitor_due() const;
    [[nodiscard]] bool warms() const noexcept;
    [[nodiscard]] bool monitors() const noexcept;
    [[nodiscard]] bool hot_for(Instant since, Duration time) const noexcept { return since != never && now_ >= since + time; }
    [[nodiscard]] bool brakes_on_abort() const noexcept { return memory.ram(0x1717) != 0 && memory.ram(0x1718) != 0; }

    // follow.cpp
    [[nodiscard]] bool follows() const noexcept;
    [[nodiscard]] std::span<const Cam> cams() const noexcept;
    [[nodiscard]] CamRange cam_range() const noexcept { return CamRange::of(cams(), memory.ram(0x1527) != 0); }
    [[nodiscard]] std::optional<Followed> followed_at(double count) const;
    [[nodiscard]] Instant follow_due() const;
    void follow_step(Instant now);
    void follow_begin(Follow what, Instant now);
    void follow_end(Instant now);
    void cam_command(std::uint16_t header, const Bytes& b, Instant now);
    void define_cam(Cam& cam, std::uint8_t sub, const Bytes& b, Instant now);
    void arm_cam(std::uint8_t sub, const Bytes& b, Instant now);
    void start_shot(std::uint8_t sub, const Bytes& b, Instant now);
    void winding_command(std::uint16_t header, const Bytes& b, Instant now);
    [[nodiscard]] const Curve* curve_of(std::uint16_t id) const;
    void lay(Cam& cam, const Curve& of, double from, double to, Instant now);

    // events.cpp
    [[nodiscard]] Instant due() const;
    void handle(Instant now);
    void motion_over(Instant now);
    void fire(Instant now);
    void fire_trigger(bool rising, Instant now);
    [[nodiscard]] Instant lag_limit(Instant after) const;
    [[nodiscard]] Instant range_limit(Instant after) const;
    [[nodiscard]] bool watches() const noexcept;

    // commands.cpp
    void execute(std::uint16_t header, const Bytes& bytes, bool from_table, Instant now);
    void general(std::uint8_t sub, const Bytes& b, Instant now);
    void interpolator(std::uint16_t header, const Bytes& b, Instant now);
    void start(const Order& order, Instant now);
    void force_command(std::uint8_t sub, const Bytes& b, Instant now);
    void stream(std::uint8_t sub, const Bytes& b, Instant now);
    void stop_motion(double deceleration, Instant now);
    void stop_play(Instant now);
    [[nodiscard]] Ramps predefined() const;
    [[nodiscard]] double quick_deceleration() const noexcept { return 1e8; }  ///< 10 m/s2: the parameter has no UPID (E-44)
    void index(Instant now);

    // table.cpp
    void table_command(std::uint16_t header, const Bytes& b, bool from_table, Instant now);
    void start_entry(std::uint16_t id, Instant now);
    void step_table(Instant now);
    [[nodiscard]] bool wait_over(Instant now);
    void end_table() noexcept {
        entry_ = 0;
        waiting_ = 0;
    }
    [[nodiscard]] std::optional<double> watched(std::uint8_t sub) const;

    // curves.cpp
    void curve_command(std::uint16_t header, const Bytes& b, Instant now);
    void start_curve(std::uint8_t sub, const Bytes& b, Instant now);
    void modify_curve(std::uint8_t sub, const Bytes& b, Instant now);

    DriveSetup setup_;
    Instant now_{};
    bool on_ = false, running_ = false;
    std::uint8_t state_ = not_ready, sub_ = 0;
    Instant since_{};          ///< of the state
    std::uint16_t error_ = 0;  ///< of states 3, 4, and of 14 on its way there
    bool fatal_ = false;
    bool quick_by_error_ = false;
    std::uint16_t interface_word_ = 0, effective_ = 0, before_ = 0;
    Outside outside_;
    // motion
    double physical_ = 0;  ///< while nothing controls it
    double offset_ = 0;    ///< position = physical + offset
    Profile profile_;
    double target_ = 0;  ///< the former target of 2xh and Bxh commands
    bool homed_ = false;
    bool vai_ever_ = false;
    Ramps last_ramps_{};
    bool frozen_play_ = false;
    double frozen_target_ = 0;
    bool frozen_motion_ = false, frozen_endless_ = false;
    double frozen_direction_ = 1;
    double stalled_at_ = 0;
    double captured_ = 0;
    std::optional<Order> after_;
    Event event_;
    std::deque<std::pair<Instant, bool>> delayed_;  ///< trigger edges that are delayed; bounded by 16
    Instant inhibited_until_{};
    bool trigger_level_ = false;
    Play play_;
    bool indexing_ = false;
    double index_base_ = 0;
    Ramps index_ramps_{};
    // what follows the master encoder
    MasterEncoder master_{memory};
    Follow follow_ = Follow::none;
    std::array<Cam, 3> cams_{};
    double follow_count_ = 0;  ///< at the last look
    double wound_from_ = 0;    ///< count at which winding begins
    std::uint16_t wound_curve_ = 0;
    double adaptation_lost_ = 0;  ///< counts in which adaptation stood still
    std::optional<double> adaptation_held_;
    // monitoring
    Instant ptc1_since_ = never, ptc2_since_ = never, motor_hot_since_ = never, sve_low_since_ = never;
    HeatChain<2> resistor_;
    HeatChain<3> motor_;
    Instant warmed_{};
    bool regenerates_ = false;
    Instant abort_over_ = never;  ///< after the brake's release
    // force
    bool force_watch_ = false, force_higher_ = true, force_control_ = false;
    double force_limit_ = 0, force_target_ = 0;
    // streaming
    bool streaming_ = false;
    Instant stream_last_{};
    Duration stream_period_{};
    int stream_count_ = 0;
    bool stream_velocities_ = false;  ///< its set-points have velocities (031xh)
    std::deque<std::pair<Instant, Point>> stream_points_;
    // motion command interface
    Bytes buffer_{};
    std::uint8_t echo_ = 0;
    std::uint16_t last_header_ = 0;
    std::uint64_t commands_done_ = 0;
    std::uint16_t x4_outputs_ = 0, x6_outputs_ = 0;
    // command table
    std::uint16_t entry_ = 0;  ///< that runs; 0: none
    Instant step_at_ = never;
    std::uint16_t waiting_ = 0;  ///< header of the wait that holds it; 0: none
    Bytes wait_bytes_{};
    Instant wait_until_ = never;
    bool wait_edge_ = false;
    std::uint16_t branch_ = 0;  ///< entry that a branch has chosen
    int starts_ = 0;            ///< of entries by one another, at this instant
};

}  // namespace axisgate::linmot::twin
