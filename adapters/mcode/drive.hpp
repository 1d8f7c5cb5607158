// Drive: one drive: finding it, setting its link, its polls, its queue of commands and their steps, and what is known of its axis.
// In: commands, the outcome of its exchanges, time. Out: the next request when it has the line; feedback, results, links, notices.
// Never sends by itself: the line asks it, and gives it one exchange at a time.
// Written in: drive.cpp (exchanges, presence), polls.cpp (what is sent), feedback.cpp (its axis), stop.cpp (stops, results, notices),
// drive_mode.cpp (out of program mode), start_rate.cpp (its bit rate), motion.cpp (commands as steps), actions.cpp (parameters, native,
// programs), actions_end.cpp (a program that is waited for); demand.cpp is where its axis should be.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "adapters/mcode/demand.hpp"
#include "adapters/mcode/drive_trouble.hpp"
#include "adapters/mcode/native_program.hpp"
#include "adapters/mcode/wire.hpp"
#include "adapters/mcode/wire_reply.hpp"
#include "gateway/core/adapter.hpp"
#include "gateway/core/catalogue.hpp"

namespace axisgate::mcode {

/// One call of the adapter from outside.
struct Turn {
    Instant now;
    Out& out;
};

/// LineManners and line options with this family's own defaults filled in.
struct Manners {
    Duration reply_timeout = std::chrono::milliseconds(120);
    Duration poll_period = std::chrono::milliseconds(20);
    Duration pause{};
    int retries = 2;
    int silent_limit = 3;
    Duration pause_min = std::chrono::milliseconds(200);
    Duration pause_max = std::chrono::seconds(5);
    int em = 1;                      ///< echo mode wanted
    int ck = 1;                      ///< checksum mode wanted
    bool ethernet = false;           ///< MCode/TCP: no CK, no names [L1173-1191]
    bool reset_hits_others = false;  ///< another drive of this line has CE = 1: a CTRL+C for one restarts that too
    int rate_code = 0;               ///< BD of the line's rate; 0: not known, or none of BD's [L1585]
};

/// bit/s of a BD code, 0 if there is none [L1585-1590, E-1]; and the code of a rate.
[[nodiscard]] std::uint32_t rate_of(int code) noexcept;
[[nodiscard]] int code_of(std::uint32_t rate) noexcept;

/// What a node wants to send.
struct Request {
    enum class Purpose : std::uint8_t { probe, link, startup, stop, confirm, error, step, poll, leave };
    Purpose purpose = Purpose::poll;
    std::string text;  ///< without address, checksum, terminator; query: without the mark
    std::string raw;   ///< bytes as they are, instead of text
    Expect::Kind kind = Expect::Kind::query;
    bool end_mark = false;
    bool ends = false;  ///< block: its end is proven by a question behind it
    bool urgent = false;
    bool wake = false;    ///< a LF goes before: wakes a party line, ends half a line [L5002]
    Duration patience{};  ///< beyond the reply time-out
};

/// A program that was started by a command that is answered when it has ended.
struct StartedProgram {
    Command command;
    std::string ended_by;  ///< a line that ends programs, taken since
    int code = 0;          ///< the last error since its start
};

class Drive {
public:
    static constexpr std::size_t queue_limit = 64;                       ///< waiting commands; one more is refused as busy
    static constexpr std::size_t urgent_limit = 16;                      ///< waiting stops; one more is refused as busy
    static constexpr Duration restart_limit = std::chrono::seconds(20);  ///< a restarted drive that is not back by then has failed
    static constexpr int link_round_limit = 8;  ///< lines that set its link in a row; what it has then is used as it is

    /// `next_listing`: of the line, shared by its nodes: a listing keeps the line to itself, so there is one in a second at most.
    Drive(const Catalogue& catalogue, const Manners& manners, AdapterCounters& counters, const DriveSetup& setup, Instant& next_listing);

    void line_up(Turn& t);
    void line_down(Turn& t, std::string_view why);
    void remove(Turn& t, std::string_view why);
    void submit(const Command& command, Turn& t);

    enum class Want : std::uint8_t { nothing, urgent, other };
    [[nodiscard]] Want wants(Instant now) const noexcept;
    /// What it would send next is answered without a mark (a line, not a question), and is no stop.
    [[nodiscard]] bool wants_unmarked(Instant now) const noexcept;
    /// It gives a fresh drive its name: urgent, but behind stops.
    [[nodiscard]] bool naming() const noexcept { return job_.kind == JobKind::setup; }
    /// It could hear a line to all drives now, or later: else it is away.
    [[nodiscard]] bool in_reach() const noexcept { return phase_ != Phase::down && phase_ != Phase::absent; }
    /// The line of its first stop, sent or not; empty: none waits, or it cannot be said to all (program mode).
    [[nodiscard]] std::string_view stop_line() const noexcept;
    /// Its stop has a line that has not been sent, or it must be led out of program mode before that.
    [[nodiscard]] bool stop_unsent() const noexcept;
    /// Its stop's line has gone to all drives, who say nothing: reading tells what became of it.
    void told_by_all(Instant heard);
    /// When it will want something without being asked again.
    [[nodiscard]] Instant due() const noexcept;
    [[nodiscard]] Request next(Turn& t);
    /// The items of the question that closes a block: those of a poll.
    [[nodiscard]] std::string closing_items(Instant now) { return poll_text(now); }
    /// How the exchange ended. `waiting` as verdict: nobody answered.
    void ended(Verdict verdict, const ReplyReader& reader, Turn& t);
    /// Text that nobody asked for while this drive had the line.
    void foreign(std::string_view text, Turn& t);

    [[nodiscard]] const DriveSetup& setup() const noexcept { return setup_; }
    [[nodiscard]] const std::string& name() const noexcept { return setup_.name; }
    [[nodiscard]] AxisId axis() const noexcept { return axis_; }
    /// Text that nobody asked for may be its output: a program runs in it, or has run a moment ago.
    [[nodiscard]] bool may_print(Instant now) const noexcept { return running_ || now < prints_until_; }
    /// The line before its request: whether a LF of the gateway's own stands before it, so that nothing can be joined with it.
    void led(bool by_own_end) noexcept { led_ = by_own_end; }
    /// The line, as its request goes out: when the drive has all of it. Bytes of its echo or answer tell less: their number differs.
    void heard_at(Instant at) noexcept { heard_at_ = at; }
    /// Somebody on the line did not answer: the end of a line may be lost, so what has been seen of program mode proves nothing.
    void line_missed() noexcept { evidence_ = 0; }
    [[nodiscard]] bool away() const noexcept { return phase_ == Phase::absent; }
    /// A CTRL+C for another drive restarts this one too (CE = 1) [L2005].
    [[nodiscard]] bool hears_every_reset() const noexcept { return phase_ == Phase::ready && ce_ == 1; }
    /// An answer was late, cut, spoiled or lost, or came twice: told when it happens again and again.
    void trouble(Trouble::Kind kind, Turn& t);
    [[nodiscard]] bool prompts() const noexcept { return em_ == 0; }
    [[nodiscard]] bool sums() const noexcept { return sums_; }
    /// It takes lines without a word: EM = 2, or CK = 2 while a program runs [L2082, L2664].
    [[nodiscard]] bool quiet() const noexcept { return em_ == 2 || (ck_ == 2 && running_); }
    [[nodiscard]] Link link() const noexcept { return {setup_.address[0], sums_}; }
    void note(Severity severity, std::string_view kind, std::int32_t code, std::string text, Turn& t);

private:
    enum class Phase : std::uint8_t { down, probing, absent, linking, starting, ready };
    enum class JobKind : std::uint8_t {
        none,
        enable,
        reset,
        home,
        set_position,
        move,
        read,
        write,
        native,
        plain,
        list,
        upload,
        download,
        edit,     ///< program.edit, until what is replaced is gone; then it is a download
        setup,    ///< line.setup: the fresh drive gets its name
        named,    ///< line.setup: it is looked for by its name, then saves if asked
        factory,  ///< FD, then it is looked for and set up again
        clear,    ///< removes the half that a broken download has left
        relearn,  ///< reads VI, VM, A, D and EE again: the drive may have scaled them
        shape,    ///< reads what makes a motion another than a trapezoid
        survey,   ///< its user variables: which of them the site names, and which it does not
        tidy,     ///< removes the questions that were stored while it was in program mode
        restart
    };
    struct Step {
        enum class What : std::uint8_t {
            send,   ///< a line; then a confirming poll says whether the drive complained
            bare,   ///< a line, its ACK alone (program mode, where a poll would become part of the program)
            query,  ///< PR with a mark
            block,  ///< text of unknown length, closed by a question
            standstill
        };
        What what = What::send;
        std::string text;
        bool repeatable = true;
        bool end_mark = false;
        std::size_t line = 0;  ///< of the user's program text; 0: not from there
    };
    struct Job {
        JobKind kind = JobKind::none;
        Command command;
        std::vector<Step> steps;
        std::size_t at = 0;
        int tries = 0;
        bool confirming = false;
        Verdict said = Verdict::waiting;
        bool awaits_end = false;      ///< program.start: answered when the program has ended
        bool memory_touched = false;  ///< download: the program memory has been cleared
        std::vector<ProgramLine> program;
        std::string from;                  ///< edit: address from which on the program is replaced
        std::vector<ProgramLine> fresh;    ///< edit: what comes there
        std::vector<std::string> stays;    ///< edit: normal forms of what stands before it
        std::vector<std::string> globals;  ///< edit: user variables that the drive has
        std::size_t left = 0;              ///< edit, clear: lines that the last CP has found
        std::string text;
        std::string listing;              ///< block: what came, as it came
        std::vector<std::uint8_t> bytes;  ///< native: what came back
        Instant give_up = never;
        void add(Step::What what, std::string line, bool repeatable = true) {
            steps.push_back({what, std::move(line), repeatable, false, 0});
        }
    };
    struct Stop {
        Command command;
        std::vector<std::string> lines;
        std::size_t at = 0;
        int tries = 0;
        bool confirming = false;
        Verdict said = Verdict::waiting;
        bool to_all = false;                ///< the line went to every drive at once: nobody acknowledges it
        std::optional<std::int64_t> speed;  ///< to_all: read once since
    };

    static constexpr std::string_view escape_key = "ESC";         ///< Stop::lines: the character, not a line
    static constexpr std::string_view reset_key = "CTRL+C";       ///< Step::text: the character, not a line
    static constexpr std::string_view already_typed = "error 6";  ///< Job::text of a write that the drive answered so

    // drive_mode.cpp
    [[nodiscard]] bool leaving() const noexcept;
    [[nodiscard]] Request next_leave();
    void note_mode_line(std::string_view line);
    void mode_line_ended(Verdict v);
    void leave_ended(Verdict v, const ReplyReader& r, Turn& t);
    [[nodiscard]] bool probe_tells_mode(Verdict v, const ReplyReader& r, Turn& t);
    void found_in_program();
    [[nodiscard]] bool proven(int questions) const noexcept { return sums_ || evidence_ >= questions; }
    void clear_if_half(std::string_view listing, Turn& t);
    void led_out(Turn& t);
    void tidy_up(std::string_view listing, Turn& t);
    // drive.cpp
    void begin_probing(Turn& t);
    void go_absent(Turn& t, std::string why);
    void came(Turn& t);
    void count_silence(Turn& t);
    [[nodiscard]] std::string not_understood() const;
    [[nodiscard]] std::string rate_trouble() const;
    [[nodiscard]] std::string factory_hint() const;
    void probe_ended(Verdict v, const std::string& data, Turn& t);
    void startup_ended(Verdict v, const std::string& data, Turn& t);
    void stop_ended(Verdict v, const ReplyReader& r, Turn& t);
    void error_read(Verdict v, const std::string& data, Turn& t);
    [[nodiscard]] bool learn_poll(const std::string& data, Turn& t);
    [[nodiscard]] std::string poll_text(Instant now);
    [[nodiscard]] std::string values_text() const;
    void learn_error(int code, bool ours, Turn& t);
    void emit(Turn& t);
    void derive(Turn& t);
    /// Units are encoder counts: with hMT they are step pulses, whatever EE says [L696].
    [[nodiscard]] bool encoder_mode() const noexcept { return encoder_flag_ && hmt_mode_ == 0; }
    void watch_program(Turn& t);
    void restart_over(Outcome o, Reason r, std::string_view what, Turn& t);
    void program_told(std::string_view line);
    void program_lost(Reason reason, const std::string& why, Turn& t);
    void take_demand(std::optional<std::int64_t> lag);
    void demand_lost() noexcept;
    void step_said(const Step& step, Verdict v);
    void lag_missed(Instant now) noexcept;
    void result(const Command& c, Outcome o, Reason r, std::string text, Turn& t, std::int32_t code = 0, Value value = {});
    void fail_all(Reason reason, const std::string& text, Turn& t);
    void link_state(bool online, std::string text, Turn& t);
    [[nodiscard]] std::optional<bool> heard_all(Stop& s, const std::string& line) const;
    void stop_over(Outcome o, Reason r, std::string text, Turn& t, std::int32_t code = 0);
    [[nodiscard]] std::string_view stop_at_once() const noexcept;
    [[nodiscard]] std::vector<std::string> stop_of_torque() const;
    // motion.cpp
    void cancel_motions(std::string_view by, bool power_off, Turn& t);
    [[nodiscard]] bool ended_by_stop(const CommandBody& b, bool power_off) const;
    void take_next(Turn& t);
    void plan(const Command& c, Turn& t);
    void plan_move(const Move& m, Turn& t);
    void plan_home(const Home& h, Turn& t);
    void step_ended(Verdict v, const ReplyReader& r, Turn& t);
    void confirmed(Turn& t);
    void step_done(Turn& t);
    void job_over(Outcome o, Reason r, std::string text, Turn& t, std::int32_t code = 0, Value value = {});
    void began_motion(Turn& t);
    // actions.cpp
    void plan_read(const ReadParameter& r, Turn& t);
    void plan_write(const WriteParameter& w, Turn& t);
    void plan_native(const Native& n, Turn& t);
    void plan_rate(const Action& a, Turn& t);
    void plan_action(const Action& a, Turn& t);
    void query_answered(const std::string& data, Turn& t);
    void block_came(Verdict v, const ReplyReader& r, Turn& t);
    void block_ended(Turn& t);
    void download_failed(std::string why, Turn& t);
    void setting_refused(const std::string& why, Turn& t);
    void plan_download(const Action& a, Turn& t);
    // actions_edit.cpp
    void plan_edit(const Action& a, Turn& t);
    void edit_listed(const std::string& text, Turn& t);
    [[nodiscard]] bool begin_edit(const std::vector<ListedLine>& rows, Turn& t);
    [[nodiscard]] bool clear_from(const std::vector<ListedLine>& rows, Turn& t);
    [[nodiscard]] std::string memory_is_half() const;
    /// A listing is due: at rest, when nothing else is wanted; what a program prints would stand within it.
    [[nodiscard]] bool surveys(Instant now) const noexcept {
        return survey_ && now >= survey_at_ && seen_ && !running_ && !mv_ && job_.kind == JobKind::none && queue_.empty();
    }
    void variables_listed(std::string_view listing, Turn& t);
    [[nodiscard]] std::string variable_hint() const;
    [[nodiscard]] bool wait_for_rest(Turn& t);
    void keep_half();
    void learn_values(std::string_view data);
    [[nodiscard]] std::string word(const Parameter& p) const;
    [[nodiscard]] std::optional<Value> value_of(const Parameter& p, std::string_view text) const;

    /// Points are numbered by it. What the language is stands in the family's page: names of users are none of its words.
    [[nodiscard]] const Catalogue& drive_catalogue() const noexcept { return setup_.catalogue ? *setup_.catalogue : catalogue_; }

    const Catalogue& catalogue_;
    const Manners& manners_;
    AdapterCounters& counters_;
    Instant& next_listing_;  ///< of the line
    DriveSetup setup_;
    AxisId axis_ = no_axis;

    Phase phase_ = Phase::down;
    std::uint32_t silent_ = 0;
    bool babble_ = false;  ///< the last exchange without an answer was not without bytes
    int poll_refusals_ = 0;
    Duration retry_pause_{};
    Instant next_probe_ = never, next_poll_ = never;
    bool shown_online_ = false;
    bool sums_ = false;        ///< requests carry a checksum
    bool known_sums_ = false;  ///< they did when it answered last
    int em_ = 1, ck_ = 0, es_ = 1, ce_ = 1;
    int link_rounds_ = 0;
    std::string link_line_;  ///< EM=, CK= to be sent next
    std::size_t startup_at_ = 0;
    bool tells_input_ = false;      ///< IF can be read
    bool input_ = false;            ///< a program waits for a number (IV)
    bool hmt_ = false;              ///< LMD closed loop: LR is there
    bool encoder_ = true;           ///< ST and EE can be read
    bool knows_model_ = false;      ///< by its part number
    int bd_ = 0;                    ///< BD as the drive has it; it acts at the next restart
    bool at_factory_rate_ = false;  ///< FD was sent since it was heard last
    std::string identity_;
    Request::Purpose purpose_ = Request::Purpose::poll;

    std::deque<Command> queue_;
    std::deque<Stop> stops_;
    Job job_;
    std::optional<StartedProgram> program_;
    std::optional<Command> restart_;  ///< reset: answered when the drive is set up again, also when it was away meanwhile
    Instant restart_until_{};
    bool need_error_ = false;
    int error_tries_ = 0;  ///< answers to ER that were none
    bool error_is_ours_ = false;
    /// Program mode, as far as this gateway has put the drive into it. It outlives absence: a drive that comes back may still be in it.
    enum class Mode : std::uint8_t { immediate, program, unknown };
    Mode mode_ = Mode::immediate;
    Mode mode_before_ = Mode::immediate;  ///< of the PG in flight
    bool mode_flight_ = false;            ///< a PG is in flight
    bool mode_doubt_ = false;             ///< an acknowledgement may be a late one: the mode is asked after
    bool purpose_was_question_ = false;   ///< leave: the exchange in flight asks for the mode
    int leave_rounds_ = 0;                ///< at 12 without success the drive is given up as absent
    bool suspected_ = false;              ///< a question was taken and not answered, and this gateway has sent no PG
    int evidence_ = 0;                    ///< questions since then that were taken and not answered, each behind a LF of our own
    bool led_ = false;                    ///< the one in flight is such a question
    bool found_ = false;                  ///< it is certain: somebody else has left it in program mode
    int stored_ = 0;                      ///< questions that it may have stored since
    bool tidy_ = false;                   ///< they are to be removed, at rest
    bool own_trouble_ = false;            ///< looking for it may have raised an error in it: that one is no news
    bool clear_half_ = false;             ///< a download broke off: CP removes what it left, behind every stop
    bool half_was_away_ = false;          ///< the drive was out of reach since: it may have restarted with another program
    std::string half_from_;               ///< ... from this address on; empty: all of it
    std::vector<std::string> half_;       ///< what that download had sent, as a listing is compared
    Instant survey_at_{};                 ///< its turn to do so
    bool survey_ = false;                 ///< its user variables have not been listed since it came
    bool relearn_ = false;                ///< VI, VM, A, D or EE may be others than is known
    bool stopping_ = false;               ///< a stop was accepted, and rest has not been seen since
    std::uint32_t lost_ = 0;              ///< questions without an answer since it was heard last
    Instant prints_until_{};              ///< output of a program may still come
    Trouble trouble_, twice_{1};

    // what is known
    AxisFeedback fb_;
    Instant read_at_{};  ///< of the last poll: the drive had the whole question
    bool seen_ = false;
    bool enabled_ = false;  ///< by this gateway, since the drive was found
    bool torque_ = false;   ///< AS = 3: the drive presses on by itself, and SL does not end that
    int hmt_mode_ = 0;      ///< AS
    bool de_ = false, mv_ = false, mp_ = false, vc_ = false, ef_ = false, running_ = false, stalled_ = false, locked_ = false;
    int fault_ = 0;  ///< code that must be reset
    int last_error_ = 0;
    std::int64_t vi_ = 0, user_vi_ = 0, vm_ = 0, a_ = 0, d_ = 0;
    bool encoder_flag_ = false;  ///< EE
    struct Motion {
        enum class Kind : std::uint8_t { none, position, velocity, home, foreign };
        Kind kind = Kind::none;
        std::int64_t target = 0;
        bool ended = true;
    } motion_;
    bool zero_after_home_ = false;
    AxisDemand demand_;
    Instant heard_at_{};
    bool program_ran_ = false;    ///< it may have set VI, VM, A, D or EE
    bool old_firmware_ = false;   ///< below 6: linear ramps and no backlash [L1030, L1031]
    bool shape_refused_ = false;  ///< it does not tell them
    bool asks_lag_ = false;       ///< LL is in the poll in flight
    int lag_misses_ = 0;          ///< such polls in a row without an answer: two, and LL is left out for a while
    Instant lag_again_{};
    int notice_tokens_ = 20;
    Instant notice_refilled_{};
};

/// Read one after the other when a drive was found; what it refuses is left unknown.
/// ER is not among them: reading clears it, so it is asked when EF says that there is something to be told.
inline constexpr std::array<std::string_view, 8> startup_items{"PN", "VR", "BY", "AS", "ST", "VI,\",\",VM,\",\",A,\",\",D", "IF", "BD"};

/// Codes of ER that stop an axis until they are reset; the others say that a line was refused.
[[nodiscard]] bool is_fault_code(int code) noexcept;

}  // namespace axisgate::mcode
