// One LinMot drive: how it is found, asked, commanded and stopped, put together from gateway/drive.
// In: commands, its answers, the passing of time, a place on the line. Out: telegrams, feedback, samples, results, links, notices.
// Every telegram may be repeated: control words and reads change nothing the second time, and a motion command with the same count is not
// executed twice. Never commands a motion that nobody asked for.
// Files: start.cpp, polls.cpp, feedback.cpp, power.cpp, motion.cpp, motion_stream.cpp, homing.cpp, stop.cpp, parameters.cpp,
// parameters_transfer.cpp, native.cpp, actions.cpp, demand.cpp.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "adapters/linmot/motion_commands.hpp"
#include "adapters/linmot/wire.hpp"
#include "gateway/axis/demand.hpp"
#include "gateway/core/adapter.hpp"
#include "gateway/drive/command_queue.hpp"
#include "gateway/drive/exchange.hpp"
#include "gateway/drive/lead.hpp"
#include "gateway/drive/notices.hpp"
#include "gateway/drive/polls.hpp"
#include "gateway/drive/presence.hpp"
#include "gateway/drive/set_points.hpp"
#include "gateway/drive/tickets.hpp"
#include "gateway/drive/timing.hpp"
#include "gateway/drive/turn.hpp"
#include "gateway/drive/turns.hpp"

namespace axisgate::linmot {
using drive::Turn;

/// UPIDs of the values that are read before a drive is served.
inline constexpr std::uint16_t core_values[] = {0x14BE, 0x14BF, 0x14C0};

/// What the drives of a line have in common.
struct Bus {
    explicit Bus(const Catalogue& of_family) : catalogue(of_family), motions(of_family) {}
    const Catalogue& catalogue;
    Motions motions;
    drive::Timing timing;
    AdapterCounters counters;
    ChecksumRule checksum;
    std::uint32_t bit_rate = 0;
    std::uint8_t bits_per_byte = 10;
    std::size_t drives = 0;  ///< on the line
    [[nodiscard]] Duration wire(std::size_t bytes) const noexcept;
};

class Drive {
public:
    static constexpr int channels = 1;

    Drive(Bus& bus, const DriveSetup& setup, std::uint8_t id, std::size_t slot);
    Drive(const Drive&) = delete;
    Drive& operator=(const Drive&) = delete;

    // --- from the adapter -----------------------------------------------------------------------------------------------
    void begin(Turn& t);  ///< says what was wrong in its options
    void line_up(Turn& t);
    void line_down(Turn& t, std::string_view why);
    void remove(Turn& t, std::string_view why);
    void submit(const Command& command, Turn& t);
    void look(const DriveSetup& setup) noexcept {
        if (pace_.take(setup)) poll_.hurry();
    }
    void follow(const SetPoint& set_point);
    [[nodiscard]] drive::Want wants(Instant now) const noexcept;
    [[nodiscard]] Instant deadline() const noexcept { return exchange_.deadline(); }
    [[nodiscard]] Instant wish() const noexcept;
    void go(Turn& t);
    [[nodiscard]] bool waiting() const noexcept { return exchange_.active(); }
    [[nodiscard]] bool answers(const Telegram& telegram) const noexcept;
    void on_telegram(const Telegram& telegram, Turn& t);
    void unasked(Turn& t) noexcept { presence_.heard(t.now); }
    void on_deadline(Turn& t);
    /// on_deadline has sent the same telegram again.
    [[nodiscard]] bool repeats(const Turn& t) const noexcept { return exchange_.active() && repeated_at_ == t.now; }

    [[nodiscard]] std::uint8_t id() const noexcept { return id_; }
    [[nodiscard]] std::size_t slot() const noexcept { return slot_; }
    [[nodiscard]] const std::string& name() const noexcept { return setup_.name; }
    [[nodiscard]] const DriveSetup& setup() const noexcept { return setup_; }

private:
    enum class Purpose : std::uint8_t { probe, core, poll, warn, job, stop, release, stream };
    struct Request {
        Telegram telegram;
        Purpose purpose = Purpose::poll;
        bool any_length = false;  ///< native: whatever comes from this ID is the answer
        bool once = false;        ///< not to be repeated by itself: the drive counts such telegrams
        bool quiet = false;       ///< its answer may take seconds: silence is none, and the line is not held
    };
    /// A command table entry (one block) or a curve (info and data) on its way.
    struct Transfer {
        bool active = false, curve = false, write = false;
        std::uint16_t id = 0;
        std::array<std::vector<std::uint8_t>, 2> blocks{}, seen{};  ///< to be written; read
        std::array<std::uint32_t, 2> sizes{};
        int step = 0;
        std::size_t at = 0;
        int tries = 0;
    };
    /// A command that is being carried out: exchanges one after the other, `step` counts them.
    struct Job {
        bool active = false;
        Command command;
        int step = 0;
        Instant not_before{};  ///< of the next exchange
        Instant limit = never;
        std::uint8_t count = 0;  ///< of a motion command that was sent
        std::uint8_t state_before = 0;
        std::int64_t number = 0;
        std::string text;
        std::vector<std::uint8_t> bytes;
        Transfer transfer;
    };
    struct Stop {
        Command command;
        int step = 0;
        int tries = 0;
        std::uint8_t count = 0;
    };

    /// The drive's own position stream: one set-point each period, without a gap.
    struct Stream {
        bool on = false, ending = false;
        Duration period{};
        Instant next = never, heard{};  ///< its next set-point; its last answer
        drive::Lead lead;
        std::optional<SetPoint> newest;
    };

    // start.cpp
    void find(const Telegram& telegram, Turn& t);
    void core_answered(const Telegram& telegram, Turn& t);
    void lost(Turn& t, std::string why);
    [[nodiscard]] std::string title() const;
    // polls.cpp
    void send(Request request, Turn& t);
    void silence(Turn& t);
    // feedback.cpp
    void learn(const Status& status, Turn& t);
    void tell(Turn& t);
    [[nodiscard]] std::string error_text() const;
    [[nodiscard]] std::string state_text() const;
    [[nodiscard]] bool in_error() const noexcept;
    void sample(std::string_view id, Value value, Turn& t);
    // the verbs: each sends its next telegram, or ends; each answer brings it further
    void begin_job(Turn& t);
    [[nodiscard]] std::optional<Telegram> job_request(Turn& t);
    [[nodiscard]] std::optional<Telegram> motion_request(Turn& t);
    void job_answered(const Telegram& telegram, Turn& t);
    void job_failed_silent(Turn& t);
    void end_job(Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code = 0, Value value = {});
    // power.cpp
    [[nodiscard]] std::optional<Telegram> power_request(Turn& t);
    [[nodiscard]] std::optional<Telegram> reset_request(Turn& t);
    [[nodiscard]] Telegram control(std::uint16_t word);
    // motion.cpp
    void begin_move(const Move& move, Turn& t);
    void begin_motion(const Motion& motion, std::vector<Value> values, Turn& t);
    [[nodiscard]] Telegram motion_telegram(const Motion& motion, std::uint8_t count, std::span<const Value> values) const;
    [[nodiscard]] std::uint8_t next_count() noexcept;
    void motion_answered(Turn& t);
    // motion_stream.cpp
    [[nodiscard]] Duration stream_period() const noexcept;
    void begin_stream(Turn& t);
    void send_stream(Turn& t);
    void stream_answered(Turn& t);
    void end_stream(Reason reason, std::string why, Turn& t);
    // homing.cpp
    void begin_home(const Home& home, Turn& t);
    [[nodiscard]] std::optional<Telegram> home_request(Turn& t);
    void watch_homing(Turn& t);
    // stop.cpp
    void begin_stop(const Command& command, Turn& t);
    [[nodiscard]] std::optional<Telegram> stop_request(Turn& t);
    void stop_answered(Turn& t);
    void end_stop(Outcome outcome, Reason reason, std::string text, Turn& t);
    // parameters.cpp
    [[nodiscard]] std::optional<Telegram> parameter_request(Turn& t);
    void parameter_answered(const Telegram& telegram, Turn& t);
    [[nodiscard]] bool begin_table_parameter(const Parameter& parameter, Point point, Turn& t);
    // parameters_transfer.cpp
    void begin_transfer(bool curve, bool write, std::uint16_t id, std::vector<std::uint8_t> first = {},
                        std::vector<std::uint8_t> second = {});
    [[nodiscard]] std::optional<Telegram> transfer_request();
    [[nodiscard]] bool transfer_answered(const Telegram& telegram, Turn& t);
    [[nodiscard]] bool transfer_again();
    [[nodiscard]] std::string transfer_text() const;
    // native.cpp
    [[nodiscard]] std::optional<Telegram> native_request(Turn& t);
    void native_answered(const Telegram& telegram, Turn& t);
    // actions.cpp
    void begin_action(Turn& t);
    [[nodiscard]] std::optional<Telegram> action_request(Turn& t);
    void action_answered(const Telegram& telegram, Turn& t);
    void rows_answered(const Telegram& telegram, Turn& t);
    [[nodiscard]] std::string refusal(std::uint8_t code) const;
    // demand.cpp
    void demand_moves(Turn& t);
    void demand_stops(Turn& t);
    void demand_at_status(Turn& t);

    Bus& bus_;
    DriveSetup setup_;
    std::uint8_t id_;
    std::size_t slot_;
    AxisId axis_ = no_axis;
    bool warn_inferred_ = false, inferred_ = true, stop_by_off3_ = false;
    std::vector<std::string> option_faults_;

    drive::Presence presence_;
    drive::Exchange<Request> exchange_;
    drive::CommandQueue queue_;
    drive::SetPoints set_points_;
    bool streams_ = false;  ///< by the drive option set_points
    Stream stream_;
    drive::Tickets tickets_;
    drive::Notices notices_;
    drive::PollTimer poll_;
    drive::Pace pace_;
    drive::LateTime late_;
    drive::Reading reading_;
    Instant repeated_at_ = Instant::min();
    std::string not_ours_;  ///< why a drive that answers cannot be served
    Job job_;
    std::deque<Stop> stops_;  ///< bounded: one more ends with the last

    // what is known
    bool status_known_ = false;
    Status status_;
    AxisFeedback fb_;
    std::uint16_t cw_ = cw_off;  ///< last written, or read off the status word
    bool cw_known_ = false;
    std::uint8_t count_ = 0;                              ///< of the last motion command, as the drive shows it in state 8
    std::optional<std::uint32_t> vmax_, acc_, dec_;       ///< 14BEh, 14BFh, 14C0h in the drive's counts
    std::uint32_t move_v_ = 0, move_a_ = 0, move_d_ = 0;  ///< of the last move; 0: the drive's own
    bool motion_fresh_ = false;                           ///< taken, and not yet seen by a poll
    bool to_target_ = false;                              ///< the last motion has a target
    bool release_home_ = false;                           ///< homing has ended: the bit is to be taken back
    bool homing_ = false;
    std::uint8_t told_error_ = 0;
    std::uint8_t told_state_ = 0xFF;
    std::deque<std::pair<Instant, std::int32_t>> track_;  ///< places of the last 100 ms
    Demand demand_;
    Move demand_move_;
    Instant job_sent_{};
};

}  // namespace axisgate::linmot
