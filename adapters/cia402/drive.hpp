// Drive: one CiA 402 node: presence, one SDO transfer at a time, a queue, stops, what its PDOs tell, and what it is led with.
// In: commands, set-points, frames, the passing of time, a place on the line. Out: frames, feedback, results, links, notices.
// Written in: drive.cpp what it sends next, start.cpp how it is found and set up, feedback.cpp what it learns, motion.cpp and native.cpp
// commands as steps, demand.cpp the way of a streamed set-point.
#pragma once

#include <array>
#include <optional>

#include "adapters/cia402/parameters.hpp"
#include "adapters/cia402/wire.hpp"
#include "gateway/core/wire_time.hpp"
#include "gateway/drive/command_queue.hpp"
#include "gateway/drive/exchange.hpp"
#include "gateway/drive/lead.hpp"
#include "gateway/drive/notices.hpp"
#include "gateway/drive/turns.hpp"
#include "gateway/protocols/canopen/emergency.hpp"
#include "gateway/protocols/canopen/nmt.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"

namespace axisgate::cia402_drive {
using drive::Presence;
using drive::Turn;

/// What the drives of one line share.
struct Line {
    explicit Line(const Catalogue& of_family) : catalogue(of_family) {}
    void take(const LineSetup& setup);
    const Catalogue& catalogue;
    drive::Timing timing;
    drive::Turns turns;
    AdapterCounters counters;
    std::uint32_t bit_rate = 0;
    Duration cycle = std::chrono::milliseconds(20);  ///< between two SYNCs now
};

class Drive {
public:
    static constexpr int channels = 1;
    Drive(Line& line, const DriveSetup& setup, std::size_t slot);

    void line_up(Turn& t);
    void line_down(std::string_view why, Turn& t);
    void submit(const Command& command, Turn& t);
    void follow(const SetPoint& set_point);
    void on_frame(const Frame& frame, Turn& t);
    void before_sync(Duration cycle, Turn& t);  ///< the next target goes out
    void after_sync(Instant now);
    // asked by drive::settle, serve and wake
    [[nodiscard]] drive::Want wants(Instant now) const noexcept;
    [[nodiscard]] Instant deadline() const noexcept { return std::min(sdo_.deadline(), heartbeat_.deadline()); }
    [[nodiscard]] Instant wish() const noexcept;
    void go(Turn& t);
    void on_deadline(Turn& t);

    [[nodiscard]] const DriveSetup& setup() const noexcept { return setup_; }
    [[nodiscard]] std::uint8_t node() const noexcept { return node_; }
    [[nodiscard]] std::size_t slot() const noexcept { return slot_; }
    [[nodiscard]] bool listens() const noexcept { return presence_.is(Presence::Phase::ready) && axis_ != no_axis; }
    [[nodiscard]] bool quick() const noexcept { return listens() && (fb_.moving || stream_ != Stream::none || job_ || !stops_.empty()); }

private:
    struct Step {
        enum class Kind : std::uint8_t { read, write, until, nmt } kind = Kind::read;
        Address address;
        std::vector<std::uint8_t> bytes;              ///< what is written
        std::uint32_t mask = 0, want = 0;             ///< until: the value under the mask is this one
        bool optional = false;                        ///< a refusal is no reason to stop
        bool from_here = false;                       ///< write: the bytes are a distance from the position that the step before read
        Duration patience = std::chrono::seconds(2);  ///< until
        canopen::NmtCommand nmt = canopen::NmtCommand::start;
    };
    /// A command taken apart.
    struct Job {
        Command command;
        std::vector<Step> steps;
        std::size_t at = 0;
        Instant wait_until{};  ///< the next look
        Instant give_up = never;
        bool stream = false;
        std::int64_t here = 0;  ///< what was read last
        std::vector<std::uint8_t> data;
    };
    struct Stop {
        Command command;
        std::optional<Job> job;
    };
    struct Ask {
        enum class Why : std::uint8_t { probe, start, check, error, flush, step, stop } why = Why::probe;
        Step step;
        Ticket ticket = no_ticket;
        int left = 0;  ///< repeats
    };
    enum class Stream : std::uint8_t { none, starting, position, velocity, torque };

    void send(Ask ask, Turn& t);
    void transfer(Turn& t);
    void emit_frames(std::vector<Frame>& frames, Priority priority, Turn& t);
    void ended(const canopen::SdoEnd& end, Turn& t);
    void unanswered(Turn& t);
    void forget(Reason reason, std::string_view why, Turn& t);
    [[nodiscard]] const Catalogue& catalogue() const noexcept { return setup_.catalogue ? *setup_.catalogue : line_.catalogue; }
    // start.cpp
    void probed(const canopen::SdoEnd& end, Turn& t);
    void start(Turn& t);
    void started(const Step& step, const canopen::SdoEnd& end, Turn& t);
    void next_start(Turn& t);
    void set_up(std::vector<Step>& steps) const;
    // feedback.cpp
    void on_emergency(const canopen::Emergency& e, Turn& t);
    void on_heartbeat(const Frame& frame, Turn& t);
    void on_status(std::span<const std::uint8_t> bytes, Turn& t);
    void on_motion(std::span<const std::uint8_t> bytes, Turn& t);
    void learnt(Turn& t);
    void judge(Turn& t);
    void emit(Turn& t);
    // motion.cpp
    void begin(Command command, Turn& t);
    [[nodiscard]] std::string plan(Job& job, Reason& reason) const;
    [[nodiscard]] std::string plan_move(Job& job, const Move& move, Reason& reason) const;
    void plan_homing(Job& job, std::optional<std::int16_t> method) const;
    [[nodiscard]] Job stop_job(const Command& command) const;
    void step_done(Job& job, const canopen::SdoEnd& end, Turn& t);
    void finish(Job& job, Turn& t);
    [[nodiscard]] bool offers(int mode) const noexcept { return mode >= 1 && mode <= 32 && (modes_ >> (mode - 1) & 1u); }
    void word(Job& job, std::uint16_t cw) const;
    void write(Job& job, Address a, std::int64_t v, std::size_t size, bool optional = false) const;
    void enter_mode(Job& job, int mode) const;
    // native.cpp
    [[nodiscard]] std::string plan_native(Job& job, const Native& native, Reason& reason) const;
    [[nodiscard]] std::string plan_action(Job& job, const Action& action, Reason& reason) const;
    [[nodiscard]] std::string plan_parameter(Job& job, Reason& reason) const;
    // demand.cpp
    void end_stream() noexcept;
    [[nodiscard]] Job stream_job() const;
    void lead(Turn& t, Duration cycle);

    Line& line_;
    DriveSetup setup_;
    std::uint8_t node_;
    std::size_t slot_;
    AxisId axis_ = no_axis;
    bool keep_quick_stop_ = true;
    Duration heartbeat_period_ = std::chrono::milliseconds(500);
    Presence presence_;
    drive::CommandQueue queue_;
    drive::Tickets tickets_;
    drive::StopLane<Stop, 8> stops_;
    drive::LateMarks<Address, 8> late_;
    drive::Notices notices_;
    canopen::SdoClient sdo_;
    canopen::HeartbeatWatch heartbeat_;
    canopen::EmergencyGate gate_;
    Ask ask_;
    std::optional<Job> job_;
    std::vector<Step> start_;
    std::size_t start_at_ = 0;
    std::string identity_;
    ExpectedIdentity expected_;  ///< of the description, if the site names one
    Identity told_;

    AxisFeedback fb_;
    std::uint16_t cw_ = 0;  ///< as the drive has it
    int mode_ = 0;
    std::uint32_t modes_ = 0;
    std::int64_t homing_method_ = 0;
    std::array<std::int64_t, 3> profile_{10'000, 50'000, 50'000};  ///< 6081h, 6083h, 6084h
    enum class Order : std::uint8_t { none, position, velocity, homing } order_ = Order::none;
    bool status_new_ = false, motion_new_ = false, need_code_ = false;
    int fresh_ = 0;  ///< status words since a new set-point that do not tell of it yet
    Instant check_at_ = never;
    int deaf_ = 0;  ///< answers by SDO in a row without a PDO between them

    Stream stream_ = Stream::none;
    std::optional<SetPoint> newest_;
    drive::Lead led_;
};

}  // namespace axisgate::cia402_drive
