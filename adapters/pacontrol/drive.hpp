// Drive: one PA-CONTROL on its serial port: finding it, one exchange at a time, polls, its operating mode, its axes.
// In: commands, acknowledgements, the passing of time. Out: frames, feedback, samples, results, links, notices.
// Never has two commands on the line, and while end of processing is outstanding sends nothing but polls and the stops that pass.
// Written in several files: drive.cpp whose turn it is, drive_exchange.cpp one exchange and its failures, start.cpp finding and losing,
// feedback.cpp what the control says, demand.cpp where axes should be, polls.cpp, power.cpp ONLINE and AUTOMATIC, motion.cpp, stop.cpp,
// parameters.cpp, actions.cpp.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "adapters/pacontrol/drive_axis.hpp"
#include "gateway/drive/notices.hpp"
#include "gateway/drive/presence.hpp"
#include "gateway/drive/timing.hpp"

namespace axisgate::pacontrol {

/// What all of a line have in common.
struct LineForm {
    drive::Timing timing;  ///< its reply_timeout counts besides the time that the bytes take
    std::uint32_t bit_rate = 0;
    std::uint8_t bits_per_byte = 9;  ///< 7N1
    CheckMode check = CheckMode::learn;
    bool strict = false;
};

/// The drive's options of the site (README.md).
struct DriveOptions {
    bool online_auto = true;       ///< online = auto: enable starts ONLINE; manual: it must run already
    bool give_back_auto = true;    ///< give_back = auto: the last disable returns a control that the gateway brought into ONLINE
    bool parameters_wait = false;  ///< when = wait: system and axis parameters wait for home position
    Duration wait_limit = std::chrono::seconds(30);         ///< when_timeout_ms
    Duration processing_limit = std::chrono::seconds(120);  ///< processing_timeout_ms: end of processing must come within
    bool set_by_g26 = false;                                ///< set_position = g26
    bool release = false;                                   ///< reference = release: enable releases an axis without a run (0A83)
    std::vector<int> reference_order;
    std::vector<std::string> faults;  ///< options that could not be read
};
[[nodiscard]] DriveOptions drive_options(const DriveSetup& setup);

class Drive {
public:
    static constexpr std::size_t stop_limit = 32;  ///< urgent commands that wait; one more is refused as busy

    Drive(const Catalogue& catalogue, const Elements& elements, AdapterCounters& counters, const LineForm& line, const DriveSetup& setup);
    Drive(const Drive&) = delete;
    Drive& operator=(const Drive&) = delete;

    void line_up(Turn& t);
    void line_down(Turn& t, std::string_view why);
    /// Other axes of the same control: those that stay go on undisturbed.
    void set_axes(const DriveSetup& setup, Turn& t);
    void submit(const Command& command, Turn& t);
    void on_bytes(std::span<const std::uint8_t> bytes, Turn& t);
    void on_deadline(Turn& t);
    [[nodiscard]] Instant deadline(Instant now) const noexcept;
    /// Sends what is due. Every call from outside ends with it.
    void pump(Turn& t);

    [[nodiscard]] const DriveSetup& setup() const noexcept { return setup_; }

private:
    using Phase = drive::Presence::Phase;
    enum class Purpose : std::uint8_t { none, probe, barrier, look, job, processing, stop, renew, give_back, poll };
    enum class PollKind : std::uint8_t { running, position, speed, status, extended, referenced, following, parameter };
    struct Poll {
        PollKind kind = PollKind::running;
        std::size_t axis = 0;
        std::uint8_t parameter = 0;  ///< Aim::Parameter
    };
    struct Exchange {
        Purpose purpose = Purpose::none;
        std::size_t axis = 0;
        Request request;
        bool eot = false;
        Poll poll;
        std::uint64_t number = 0;
        Instant sent{};
        Instant deadline = never;
        [[nodiscard]] bool active() const noexcept { return purpose != Purpose::none; }
    };
    /// A command whose end of processing is outstanding.
    struct Processing {
        bool active = false;
        bool foreign = false;   ///< nobody here knows of it
        bool hidden = false;    ///< a stop of another axis took the poll's answer: the axis' status tells
        std::size_t axis = 0;   ///< that moves
        std::size_t owner = 0;  ///< whose job it is: another one when one axis has the others referenced
        std::uint16_t code = 0;
        Instant next_poll{};
        Instant limit = never;
    };
    struct Stop {
        enum class Kind : std::uint8_t { quick, halt, off };
        Kind kind = Kind::quick;
        std::size_t axis = 0;
        Ticket ticket = no_ticket;
        bool until_done = false;
        std::uint8_t tries = 0;
        std::uint8_t level = 0;  ///< 0: the axis; 1: 0600 stops all; 2: 0A81
        bool blind = false;      ///< sent while answers could not be told apart: sent again afterwards
        bool stopped = false;    ///< off during processing: 0A93 has passed, 0A98 has to wait
        bool by_supervision = false;
        Instant limit = never;  ///< off in home position: of the start of ONLINE
    };

    // drive_exchange.cpp
    void send(Purpose purpose, const Request& request, std::size_t axis, Priority priority, Turn& t);
    void send_poll(Purpose purpose, std::size_t axis, Priority priority, Turn& t);
    void send_raw(std::vector<std::uint8_t> bytes, Purpose purpose, std::size_t axis, Turn& t);
    void begin_exchange(Purpose purpose, std::size_t axis, std::size_t bytes, Turn& t);
    void on_text(std::string_view text, std::string_view digits, Turn& t);
    void garbled(std::string_view what, Turn& t);
    void answered(const Reply& reply, Turn& t);
    void answered_with_frame_error(const Reply& reply, Turn& t);
    void silent(Turn& t);
    void in_step();
    [[nodiscard]] CheckForm request_form() const noexcept;
    [[nodiscard]] Duration reply_limit(std::size_t bytes) const noexcept;

    // start.cpp
    void found(Turn& t);
    void count_silence(Turn& t);
    void fail_all(Reason reason, const std::string& text, Turn& t);
    void fail_axis(Axis& a, Reason reason, const std::string& text, Turn& t);
    void forget();

    // feedback.cpp
    void learn(const Reply& reply, Turn& t);
    void ask_whose_fault(Turn& t);
    [[nodiscard]] bool in_trouble() const noexcept;
    /// The axis whose malfunction it is (1910, 1921); nothing: nobody's, or not read yet.
    [[nodiscard]] const Axis* culprit() const noexcept;
    [[nodiscard]] bool fault_of_all(Instant now) const noexcept;
    [[nodiscard]] std::string error_text() const;
    /// Why the control has ended what `a` was doing, as far as its status and its error tell; empty: they tell nothing.
    [[nodiscard]] std::string what_ended(const Axis& a) const;
    void mode_changed(int before, Turn& t);
    void left_online(int before, Turn& t);
    void learn_running(std::uint32_t mask, Turn& t);
    void learn_status(Axis& a, int status, Turn& t);
    void learn_position(Axis& a, double units, Turn& t);
    void derive(Axis& a, Instant now);
    void emit(Axis& a, Turn& t);
    void emit_all(Turn& t);
    [[nodiscard]] bool shown_by_axes() const;
    void begin_motion(Axis& a, Motion motion, Turn& t);
    void end_motion(Axis& a, bool reached, Reason reason, const std::string& text, Turn& t);
    void check_waits(Axis& a, Turn& t);
    void end_waits(Axis& a, Reason reason, const std::string& text, Turn& t, bool motions_only = true);
    void add_wait(Axis& a, Wait wait);
    void accepted(Axis& a, const Command& c, Wait::For what, std::int64_t value, std::string text, Turn& t);
    void result(Axis& a, Ticket ticket, Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code = 0, Value value = {},
                std::vector<std::uint8_t> bytes = {});
    void notice(Severity severity, std::string_view kind, std::int32_t code, std::string text, Turn& t, AxisId axis = no_axis);
    void sample(const Axis& a, Point point, const Value& value, Turn& t);

    // demand.cpp
    void follow(const Exchange& exchange, const Reply& reply, Turn& t);
    void not_acknowledged(const Request& request);
    void ordered(Axis& a, double start, double target, Turn& t);
    void brake(Axis& a, Turn& t);
    void doubt(Axis& a);
    void guide(Axis& a);
    void show_demand(Axis& a, Instant now);
    void seen_running(Axis& a, Turn& t);
    void seen_standing(Axis& a);
    void rest(Axis& a, std::int64_t position);
    [[nodiscard]] static std::int64_t following_error(const Axis& a) noexcept;
    [[nodiscard]] static bool tells_following_error(const Axis& a) noexcept;
    /// By more than two full steps: the shaft is held, or has lost steps.
    [[nodiscard]] static bool stands_behind(const Axis& a) noexcept;
    void following_answered(Axis& a, double microsteps_behind, Turn& t);
    void following_refused(Axis& a, const Reply& reply);
    [[nodiscard]] bool parameters_readable(Instant now) const noexcept;
    void parameters_may_have_changed();
    void plan_parameters(Turn& t);
    void parameter_answered(Axis& a, std::uint8_t which, const Reply& reply, Turn& t);

    // polls.cpp
    void plan_cycle(Turn& t);
    void poll_standing(Axis& a);
    void plan_standing(bool crowded);
    void plan_slow(Turn& t);
    [[nodiscard]] PollKind status_poll(const Axis& a) const noexcept { return a.extended_missing ? PollKind::status : PollKind::extended; }
    [[nodiscard]] bool poll_wanted(Instant now) const noexcept;
    void send_next_poll(Turn& t);
    void poll_answered(const Poll& poll, const Reply& reply, Turn& t);
    /// Before the cycle's other polls. What waits already moves to the front: the queue never holds more than each poll once besides a
    /// cycle's.
    void poll_soon(PollKind kind, const Axis& a);

    // drive.cpp: queues and turns
    [[nodiscard]] Axis* axis_of(AxisId id) noexcept;
    [[nodiscard]] std::size_t place(const Axis& a) const noexcept { return static_cast<std::size_t>(&a - axes_.data()); }
    void take_next(Axis& a, Turn& t);
    void start_job(Axis& a, Turn& t);
    bool send_job(Turn& t);
    bool send_native_poll(Turn& t);
    void job_answered(Axis& a, const Reply& reply, Turn& t);
    void job_silent(Axis& a, Turn& t);
    void run_waiting(Turn& t);
    void run(Axis& a, const Reply* reply, Turn& t);
    void job_late(Axis& a, Turn& t);
    void job_over(Axis& a, Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code = 0, Value value = {},
                  std::vector<std::uint8_t> bytes = {});
    void refuse(Axis& a, Reason reason, std::string text, Turn& t) { job_over(a, Outcome::refused, reason, std::move(text), t); }
    void ask(Axis& a, std::uint16_t code, std::uint32_t parameter, Turn& t);
    void ask_real(Axis& a, std::uint16_t code, std::uint32_t parameter, std::string data, Turn& t);
    void ask(Axis& a, Request request);
    void wait(Axis& a, Instant limit);
    /// A step's answer is QUIT: ends the job with it. False: QUIT was 0.
    bool ended_by_quit(Axis& a, const Reply& reply, Turn& t, std::string_view advice = {}, Reason reason = Reason::drive_refused);
    void processing_over(const Reply& reply, Turn& t);

    // power.cpp
    void run_enable(Axis& a, const Reply* reply, Turn& t);
    void run_reset(Axis& a, const Reply* reply, Turn& t);
    void run_mode(Axis& a, const Reply* reply, Turn& t);
    void start_mode(Axis& a, std::uint16_t code, Turn& t);
    void consider_give_back(Turn& t);
    [[nodiscard]] std::string why_not_online() const;

    // motion.cpp
    void start_move(Axis& a, const Move& move, Turn& t);
    void run_move(Axis& a, const Reply* reply, Turn& t);
    void next_of_move(Axis& a, Turn& t);
    void run_home(Axis& a, const Reply* reply, Turn& t);
    void home_aborted(Axis& a, std::string text, std::int32_t code, Turn& t);
    void run_origin(Axis& a, const Reply* reply, Turn& t);
    void start_together(Axis& a, const StartTogether& what, Turn& t);
    void run_together(Axis& a, const Reply* reply, Turn& t);
    [[nodiscard]] std::string why_not_movable(const Axis& a) const;

    // stop.cpp
    void submit_stop(Axis& a, const Command& command, Turn& t);
    void interrupt_motions(Axis& a, std::string_view by, bool power_off, Turn& t);
    [[nodiscard]] bool stop_ready() const noexcept;
    void send_stop(Turn& t);
    void stop_answered(const Reply& reply, Turn& t);
    void stop_silent(Turn& t);
    void stop_over(Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code = 0);
    void supervise(Turn& t);
    [[nodiscard]] bool powered_at_home(const Axis& a) const noexcept;
    [[nodiscard]] bool goes_online_to_switch_off(const Axis& a) const noexcept;
    void stop_found_standing(Turn& t);
    void keep_off(Turn& t);

    // parameters.cpp
    void run_value(Axis& a, const Reply* reply, Turn& t);
    void start_native(Axis& a, const Native& native, Turn& t);
    void run_native(Axis& a, const Reply* reply, Turn& t);

    // actions.cpp
    void start_action(Axis& a, const Action& action, Turn& t);
    void start_single(Axis& a, const CommandInfo& info, std::string_view argument, Turn& t);
    void run_single(Axis& a, const Reply* reply, Turn& t);
    void start_reference(Axis& a, std::string_view argument, Turn& t);
    void start_until_input(Axis& a, std::string_view argument, Turn& t);
    void start_manual(Axis& a, std::string_view argument, Turn& t);

    const Catalogue& catalogue_;
    const Elements& elements_;
    AdapterCounters& counters_;
    const LineForm& line_;
    DriveSetup setup_;
    DriveOptions options_;
    std::vector<Axis> axes_;  ///< by channel - 1; those that the site does not have carry no_axis

    drive::Presence presence_;
    drive::Notices notices_;

    // the exchange
    Framer framer_;
    Exchange exchange_;
    std::uint64_t exchanges_ = 0;
    bool out_of_step_ = false;  ///< an answer may still come late: a barrier tells late ones from new ones
    bool heard_in_barrier_ = false;
    bool look_due_ = false;  ///< the barrier was refused: a poll tells whether something is being processed
    Instant quiet_until_{};
    CheckForm form_ = CheckForm::text;
    bool form_proved_ = false;
    std::uint8_t check_refusals_ = 0;
    std::array<std::uint8_t, 66> misfits_{};  ///< by command: answers in a row whose type was not the table's
    std::optional<CheckForm> reply_form_;     ///< what acknowledgements carry, once seen
    Instant next_protocol_notice_{};
    std::vector<std::uint8_t> raw_reply_;

    // the control
    int mode_ = -1;
    Instant mode_at_{};
    std::uint16_t error_ = 0;
    Instant trouble_at_{};        ///< since when an error or a malfunction is shown: statuses from before do not tell whose it is
    bool started_by_us_ = false;  ///< this gateway brought it into ONLINE
    bool leaving_ = false;        ///< this gateway has told it to leave
    bool give_back_due_ = false;
    bool system_flags_missing_ = false;
    Processing processing_;
    std::deque<Stop> stops_;
    Instant supervise_at_ = never;
    std::size_t supervised_ = 0;
    bool wake_ = false;        ///< something changed that a waiting job may want to see
    bool first_cycle_ = true;  ///< nothing has been read yet: the first cycle reads everything of every axis

    // turns
    std::deque<Poll> polls_;
    Instant cycle_at_{};
    Instant cycle_began_{};
    Duration cycle_time_{};  ///< of the cycle before
    std::size_t slow_at_ = 0, idle_at_ = 0, job_at_ = 0;
    Instant parameters_at_{};  ///< not before: the control has just refused to tell them
    std::uint8_t commands_in_a_row_ = 0;
};

}  // namespace axisgate::pacontrol
