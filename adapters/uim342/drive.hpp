// Drive: one drive: its start-up, its polls, its queue of commands, its one exchange at a time, and what is known of its axis.
// In: commands, messages from the drive, the passing of time, a place in the line's window. Out: frames, feedback, samples, results.
// Never asks two things at once (stops excepted), never sends before it was given a place (stops excepted).
// Written in several files: drive.cpp the exchanges, start.cpp finding and reading the drive, feedback.cpp what it says of itself,
// stop.cpp what overtakes, motion.cpp the verbs of CiA 402, homing.cpp the search for a switch, parameters.cpp parameters and native,
// demand.cpp where the axis should be.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "adapters/uim342/adapter_bus.hpp"
#include "gateway/axis/demand.hpp"
#include "gateway/drive/command_queue.hpp"
#include "gateway/drive/exchange.hpp"
#include "gateway/drive/notices.hpp"
#include "gateway/drive/polls.hpp"
#include "gateway/drive/presence.hpp"
#include "gateway/drive/tickets.hpp"

namespace axisgate::uim342 {

/// The drive's options of the site, read once (README.md).
struct DriveOptions {
    bool notify = false;          ///< notify = on: RT 0x29 is switched on (in RAM, while the driver is on)
    bool absolute_known = false;  ///< referenced = absolute: with an absolute encoder the zero counts as known
    std::uint8_t home_input = 0;  ///< 1..3; 0: none
    bool home_high = true;        ///< level of the active switch
    std::uint32_t home_velocity = 0;
    Duration home_timeout = std::chrono::seconds(60);
    std::vector<std::string> faults;  ///< options that could not be read
};
[[nodiscard]] DriveOptions drive_options(const DriveSetup& setup);

class Drive {
public:
    static constexpr int channels = 1;
    static constexpr std::size_t queue_limit = 64;  ///< waiting commands; one more is refused as busy
    static constexpr std::size_t urgent_limit = 4;  ///< stops on their way at once; one more waits in the queue's place or is refused
    static constexpr std::size_t wait_limit = 16;   ///< commands that wait for "done"

    Drive(Bus& bus, const DriveSetup& setup, std::uint8_t address, std::size_t slot);
    Drive(const Drive&) = delete;
    Drive& operator=(const Drive&) = delete;

    // --- from the adapter -----------------------------------------------------------------------------------------------
    void line_up(Turn& t);
    void line_down(Turn& t, std::string_view why);
    /// Ends everything with `reason`; the node is about to be destroyed.
    void remove(Turn& t, std::string_view why);
    void submit(const Command& command, Turn& t);
    void look(const DriveSetup& setup) noexcept {
        if (pace_.take(setup)) poll_.hurry();
    }
    void on_message(const Message& m, Turn& t);
    void on_deadline(Turn& t);
    /// Of what it waits for: an answer, a stop's acknowledgement, the end of a supervised ramp or search.
    [[nodiscard]] Instant deadline() const noexcept;
    /// When it will want a place without being asked: its next poll or probe.
    [[nodiscard]] Instant wish() const noexcept;
    /// What it would send now if it were given a place.
    [[nodiscard]] drive::Want wants(Instant now) const noexcept;
    /// A place in the window: sends the next thing.
    void go(Turn& t);

    // --- joint orders, run by the adapter -------------------------------------------------------------------------------
    /// Ready for a joint start: online, on, not locked. Empty, or what is missing.
    [[nodiscard]] std::string not_startable() const;
    [[nodiscard]] bool prepared() const noexcept { return prepared_; }
    /// Stands in the queue like a command, so that order is kept; the adapter is told by part_ready when its turn has come.
    /// False: the queue is full.
    bool join();
    /// The joint start has been sent: find out what became of it; the adapter is told by part_done.
    void begun_by_group(bool until_done, Turn& t);
    /// The joint start will not be: goes on with what waits.
    void leave(Turn& t);
    /// An ST to all has been sent: send one of its own and tell the adapter by part_done.
    void stopped_by_all(Turn& t);

    // --- plain facts ----------------------------------------------------------------------------------------------------
    [[nodiscard]] std::uint8_t address() const noexcept { return address_; }
    [[nodiscard]] std::size_t slot() const noexcept { return slot_; }
    [[nodiscard]] AxisId axis() const noexcept { return axis_; }
    [[nodiscard]] const std::string& name() const noexcept { return setup_.name; }
    [[nodiscard]] const DriveSetup& setup() const noexcept { return setup_; }
    [[nodiscard]] bool online() const noexcept { return presence_.online(); }
    [[nodiscard]] bool ever_seen() const noexcept { return presence_.ever_found(); }
    [[nodiscard]] std::optional<std::uint8_t> group() const noexcept { return group_; }  ///< in force, as far as known

private:
    using Phase = drive::Presence::Phase;
    using Want = drive::Want;

    /// Why something was asked; decides what its answer does.
    enum class Purpose : std::uint8_t {
        probe,     ///< ML: is anybody there
        startup,   ///< a value read after a drive was found
        poll,      ///< MS[0] or MS[1]
        error,     ///< ER[0], because ERR appeared
        barrier,   ///< any read: separates late answers from new ones
        clear_mf,  ///< MF=0 after a group exchange whose end is not known
        job,       ///< a step of the present job
        confirm,   ///< a stop repeated behind a motion that it may have overtaken
        orphan     ///< its job has been ended by a stop; the answer is only taken off the line
    };
    struct Request {
        Message message;
        Purpose purpose = Purpose::poll;
        std::uint8_t mf = 0;  ///< group that the value belongs to
    };

    // --- jobs: a command taken apart into exchanges ---------------------------------------------------------------------
    enum class JobKind : std::uint8_t { enable, reset, origin, move, begin, together, search, read, write, native, system, restore };
    struct Step {
        Message message;
        std::uint8_t mf = 0;  ///< > 0: belongs to this group; the step before it selects it
        bool select = false;  ///< this is that MF
        bool check = false;   ///< a read behind an instruction without acknowledgement: a refusal would come before its answer
    };
    struct Job {
        bool active = false;
        bool waiting = false;  ///< no exchange until the drive has done something (homing)
        bool again = false;    ///< the pair of MF and value begins anew: something got between them
        JobKind kind = JobKind::read;
        Command command;
        std::array<Step, 8> steps;
        std::uint8_t count = 0, at = 0;
        std::uint8_t rounds = 0;  ///< times the group pair has been begun anew
        std::string text;         ///< what will be said in the result
        std::vector<std::uint8_t> bytes;
        const Binding* binding = nullptr;
        std::int64_t wanted = 0;
        Message last;  ///< answer to the last step
        void restep() noexcept { count = at = 0; }
        void add(const Message& m, std::uint8_t mf = 0, bool select = false) {
            if (count < steps.size()) steps[count++] = {m, mf, select};
        }
    };

    // --- stops ----------------------------------------------------------------------------------------------------------
    enum class StopKind : std::uint8_t { quick, off, halt };
    struct Stop {
        StopKind kind = StopKind::quick;
        bool waiting = false;  ///< halt: the exchange of a motion in progress has to end first
        bool soft = false;     ///< halt by JV=0 and BG, not (yet) by ST
        std::uint8_t step = 0;
        drive::Exchange<Message> exchange;
        bool by_supervision = false;
        bool part = false;  ///< belongs to a joint stop: the adapter is told
        Ticket ticket = no_ticket;
        bool until_done = false;
    };

    // --- "done" ---------------------------------------------------------------------------------------------------------
    enum class WaitFor : std::uint8_t { target, speed, standstill, on, off, boot, part };
    struct Wait {
        WaitFor what = WaitFor::target;
        Ticket ticket = no_ticket;
        std::int64_t value = 0;
        Instant since{};
    };
    struct Motion {
        enum class Kind : std::uint8_t { none, absolute, relative, velocity, unknown };
        Kind kind = Kind::none;
        std::int64_t target = 0;
        bool seen_moving = true;  ///< STOP = 0 was seen since its BG
        Instant begun{};
        Instant stood_since = never;  ///< standing, not (yet) in position
        std::int64_t speed = 0;       ///< absolute and relative: SP as sent, pulse/s; 0: not known
    };
    /// What homing changed in RAM and will put back.
    struct Restore {
        bool pending = false;
        std::uint8_t input = 0;  ///< 0..2
        std::uint16_t il = 0, tg = 0;
        std::uint32_t dc_rising = 0, dc_falling = 0;
    };
    enum class Cause : std::uint8_t { none, own, foreign };  ///< of the ERR flag

    // drive.cpp: exchanges
    void send_exchange(const Message& m, Purpose p, std::uint8_t mf, int retries, Priority priority, Turn& t);
    [[nodiscard]] Request end_exchange();
    void abandon_job_exchange() noexcept;
    void exchange_answered(const Message& m, Turn& t);
    void exchange_refused(const Message& m, Turn& t);
    void exchange_silent(Turn& t);
    void go_barrier(Turn& t);
    void count_silence(Turn& t);
    void result(Ticket ticket, Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code = 0, Value value = {},
                std::vector<std::uint8_t> bytes = {});
    void fail_all(Reason reason, const std::string& text, Turn& t);
    void notice(Severity severity, std::string_view kind, std::int32_t code, std::string text, Turn& t);
    void poll_now(Turn& t) noexcept;

    // start.cpp: finding and reading
    void begin_probing(Turn& t);
    void probe_answered(const Message& m, Turn& t);
    void stop_polls() noexcept;
    void went_absent(Turn& t, std::string why);
    void startup_next(Turn& t);
    void startup_step_done(Turn& t);
    void core_known(Turn& t);
    void begin_reading(Turn& t, bool from_nothing);
    void reboot_begun(Turn& t);

    // feedback.cpp: what the drive says
    void learn(const Message& request, const Message& answer, std::uint8_t mf, bool samples, Turn& t);
    void on_status(const Message& m, Turn& t);
    void on_speed(const Message& m, Turn& t);
    void on_notification(const Message& m, Turn& t);
    void on_error_report(const Message& m, Turn& t);
    void on_latest_error(const Message& m, Turn& t);
    void derive(Turn& t);
    void emit(Turn& t);
    void suspect_restart(Turn& t, bool zero_lost, std::string why);
    void begin_motion(const Motion& motion, Turn& t);
    void begin_unknown_motion(Turn& t) { begin_motion(Motion{.kind = Motion::Kind::unknown}, t); }
    void check_waits(Turn& t);
    void end_waits(bool motions_only, Reason reason, const std::string& text, Turn& t);
    void add_wait(WaitFor what, Ticket ticket, std::int64_t value, Turn& t);
    void accepted(Ticket ticket, bool until_done, WaitFor what, std::int64_t value, std::string text, Turn& t);
    [[nodiscard]] bool moving_now() const noexcept;

    // stop.cpp: what overtakes
    void submit_stop(const Command& command, Turn& t);
    void add_stop(const Stop& wanted, Turn& t);
    void begin_stop(Stop& s, Turn& t);
    void send_stop(Stop& s, const Message& m, int retries, Turn& t);
    void stop_answered(Stop& s, const Message& m, Turn& t);
    void stop_refused(Stop& s, const Message& m, Turn& t);
    void stop_silent(Stop& s, Turn& t);
    void stop_finished(Stop& s, Outcome outcome, Reason reason, std::string text, std::int32_t code, Turn& t);
    void waiting_stops(Turn& t);
    void harden(Stop& s, std::string_view why, bool late_begin, Turn& t);
    void supervise(bool soft, Turn& t);
    void supervision_due(Turn& t);
    void interrupt_motions(std::string_view by, bool power_off, Turn& t);

    // demand.cpp: where the axis should be
    [[nodiscard]] std::optional<DemandRamps> demand_ramps(std::int64_t speed) const noexcept;
    void demand_begins(const Motion& motion, Instant now) noexcept;
    void demand_stops(bool soft, Instant now) noexcept;
    void demand_rests(std::int64_t position) noexcept;
    void forget_demand() noexcept;
    void demand_at_status(bool started_by_itself, Instant now) noexcept;
    void demand_at_position(Instant now) noexcept;

    // motion.cpp: the verbs, and the run of jobs
    void take_next(Turn& t);
    /// A place in a joint start, put into the queue by join(): a StartTogether of nobody.
    [[nodiscard]] static bool is_place(const Command& command) noexcept;
    void start_job(const Command& command, Turn& t);
    void begin_job(JobKind kind, const Command& command);
    void run_job(Turn& t);
    void job_answered(const Message& m, Turn& t);
    void job_refused(const Message& m, Turn& t);
    void job_silent(Turn& t);
    void job_done(Turn& t);
    void job_over(Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code = 0, Value value = {});
    void refuse_job(Reason reason, std::string text, Turn& t) { job_over(Outcome::refused, reason, std::move(text), t); }
    void plan_enable(Turn& t);
    void plan_reset(Turn& t);
    void plan_home(const Home& home, Turn& t);
    void plan_move(const Move& move, Turn& t);
    void done_move(Turn& t);
    void done_reset(Turn& t);
    void done_origin(Turn& t);
    [[nodiscard]] bool stopping() const noexcept { return !stops_.empty(); }
    [[nodiscard]] std::optional<std::uint32_t> ramp(std::int64_t rate, std::int64_t speed, std::string_view name, std::string& text,
                                                    std::string& fault) const;

    // homing.cpp
    void plan_search(std::int16_t method, Turn& t);
    void search_next(Turn& t);
    void search_arm(Turn& t);
    void search_check(Turn& t);
    [[nodiscard]] bool searching() const noexcept { return search_.stage != Search::Stage::idle; }
    [[nodiscard]] bool queue_ready() const noexcept;
    void search_status(Turn& t);
    [[nodiscard]] bool switch_active() const noexcept;
    [[nodiscard]] std::uint8_t edge_group(bool rising) const noexcept;
    void search_deadline(Turn& t);
    void search_over(bool good, Reason reason, std::string text, Turn& t);
    void plan_restore(Turn& t);
    [[nodiscard]] bool restore_due() const noexcept;

    // parameters.cpp
    void plan_read(const ReadParameter& read, Turn& t);
    void plan_write(const WriteParameter& write, Turn& t);
    void plan_native(const Native& native, Turn& t);
    void plan_action(const Action& action, Turn& t);
    void plan_messages(const std::vector<Message>& messages, Turn& t);
    [[nodiscard]] std::string id_conflict(std::uint8_t index, std::int64_t value) const;
    void done_write(const Message& m, Turn& t);
    void done_read(const Message& m, Turn& t);
    void native_answered(const Step& step, const Message* answer, Turn& t);
    void done_native(Turn& t);
    [[nodiscard]] std::string storage_note(const Instruction& i, std::uint8_t index) const;

    [[nodiscard]] Message msg_get(std::uint8_t cw, std::uint8_t index = 0) const noexcept { return get(address_, cw, index); }
    [[nodiscard]] Message msg_set(std::uint8_t cw, std::int64_t v, std::uint8_t index = 0) const noexcept {
        return set(address_, cw, v, index);
    }
    [[nodiscard]] Message msg_act(std::uint8_t cw) const noexcept { return act(address_, cw); }

    Bus& bus_;
    DriveSetup setup_;
    DriveOptions options_;
    AxisId axis_ = no_axis;
    std::uint8_t address_;
    std::size_t slot_;

    // presence
    drive::Presence presence_;
    drive::Reading reading_;
    std::string identity_;

    // exchanges
    drive::Exchange<Request> exchange_;
    drive::LateMarks<std::uint16_t> late_;  ///< of instructions that were given up, or sent twice
    bool mf_unknown_ = false;               ///< a group may still be selected in the drive: MF=0 goes first
    drive::StopLane<Stop, urgent_limit> stops_;
    Job job_;
    drive::CommandQueue queue_{queue_limit};
    drive::Tickets tickets_;
    std::vector<Wait> waits_;
    std::optional<std::uint8_t> blind_;  ///< function of an instruction without acknowledgement whose refusal may still come
    std::optional<StopKind> confirm_;    ///< repeat this stop behind the exchange in progress
    Instant broadcast_until_{};          ///< a BG to a group may still be on its way until then
    bool part_pending_ = false;          ///< a joint start waits for this node's first status
    bool part_until_done_ = false;

    // polls
    drive::PollTimer poll_;
    drive::Pace pace_;
    bool poll_speed_ = false;      ///< next is MS[1]
    bool commanded_last_ = false;  ///< a command has begun since the last poll
    bool startup_turn_ = false;    ///< next is a value of the start-up, though a poll is due
    bool read_error_ = false;      ///< ER[0] is to be read

    // what is known
    Status status_;
    bool status_known_ = false, position_known_ = false;
    Instant status_at_{}, position_at_{};  ///< when MS[0] and MS[1] were said last
    bool rest_unread_ = false;             ///< it stands, but the last MS[1] is from when it moved
    AxisFeedback fb_;
    Motion motion_;
    Cause cause_ = Cause::none;
    std::uint8_t alarm_ = 0;         ///< last alarm that stands, 0: none
    std::uint8_t latest_error_ = 0;  ///< code of ER[0] as last read
    bool stop_ramp_ = false;         ///< an ST was acknowledged and the axis has not stood since
    bool prepared_ = false;
    Motion prepared_motion_;
    Instant supervise_at_ = never;  ///< a stop must have ended by then
    bool supervise_soft_ = false;
    bool power_expected_ = false;  ///< SON as our last command left it
    struct Before {                ///< last seen before a silence, to tell a broken cable from a restart
        bool known = false, on = false, referenced = false;
        std::int64_t position = 0;
        bool own_error = false;  ///< its error flag stood for something that it had refused to this gateway
    } before_;
    std::optional<std::uint32_t> ac_, dc_, ss_, sd_;
    std::optional<bool> time_ramps_;  ///< IC[4] = 1: AC and DC are ms
    std::optional<bool> auto_on_, absolute_encoder_, battery_ok_, notifies_;
    std::optional<bool> closed_loop_;  ///< IC[6]
    Demand demand_;
    std::optional<std::uint8_t> group_;
    std::array<std::optional<std::uint16_t>, 3> il_, tg_;
    std::optional<std::uint32_t> ptp_speed_;

    // homing search (homing.cpp)
    struct Search {
        enum class Stage : std::uint8_t { idle, save, approach, final };
        Stage stage = Stage::idle;
        Command command;         ///< the Home that asked for it; its ticket is answered by search_over
        bool running = false;    ///< the axis moves; other values may be read meanwhile
        bool check_due = false;  ///< it stands; IL[i] is to be read to see whether the input has done its work ...
        bool checking = false;   ///< ... and is being read
        int direction = 0;       ///< of the final move
        bool entering = false;   ///< the final edge is that of the switch becoming active
        Instant give_up = never;
    } search_;
    Restore restore_;

    drive::Notices notices_;
};

}  // namespace axisgate::uim342
