// Drive: one CANopen node: presence, one SDO transfer at a time, and its axes, who take turns with it.
// In: commands, set-points, frames, the passing of time, a place on the line. Out: frames, feedback, results, links, notices.
// Written in: drive.cpp what it sends next, start.cpp how it is found and set up, feedback.cpp EMCY and heartbeats. Its axes:
// drive_axis.hpp.
#pragma once

#include <memory>

#include "adapters/cia402/drive_axis.hpp"
#include "adapters/cia402/drive_double.hpp"
#include "adapters/cia402/parameters.hpp"
#include "gateway/drive/exchange.hpp"
#include "gateway/drive/polls.hpp"
#include "gateway/protocols/canopen/emergency.hpp"
#include "gateway/protocols/canopen/nmt.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"

namespace axisgate::cia402_drive {

class Drive {
public:
    static constexpr int channels = most_axes;
    Drive(Line& line, const DriveSetup& setup, std::size_t slot);
    Drive(const Drive&) = delete;
    Drive& operator=(const Drive&) = delete;

    /// Other axes of the same node: those that stay go on undisturbed.
    void set_axes(const DriveSetup& setup, Turn& t);
    void line_up(Turn& t) { node_.presence.begin(t.now); }
    void line_down(std::string_view why, Turn& t);
    void submit(const Command& command, Turn& t);
    void follow(const SetPoint& set_point);
    void look(const DriveSetup& setup) noexcept { (void)pace_.take(setup); }
    void on_frame(const Frame& frame, Turn& t);
    void before_sync(Duration cycle, Turn& t);  ///< the next targets go out
    void after_sync() noexcept;
    // asked by drive::settle, serve and wake
    [[nodiscard]] drive::Want wants(Instant now) const noexcept;
    [[nodiscard]] Instant deadline() const noexcept { return std::min(sdo_.deadline(), heartbeat_.deadline()); }
    [[nodiscard]] Instant wish() const noexcept;
    void go(Turn& t);
    void on_deadline(Turn& t);

    [[nodiscard]] const DriveSetup& setup() const noexcept { return node_.setup; }
    [[nodiscard]] std::uint8_t node() const noexcept { return node_.number; }
    [[nodiscard]] std::size_t slot() const noexcept { return slot_; }
    [[nodiscard]] int listeners() const noexcept;
    [[nodiscard]] bool quick() const noexcept;
    /// It watches the gateway's heartbeat, and answers.
    [[nodiscard]] bool watches() const noexcept {
        return node_.presence.online() && node_.presence.watchdog().state == DriveWatchdog::State::armed;
    }
    [[nodiscard]] Duration watch_time() const noexcept { return node_.watch.time; }
    /// The gateway has another number on the line: it is set up anew, and goes on meanwhile.
    void watch_anew() {
        if (node_.presence.is(Presence::Phase::ready) && !axes_.empty()) start();
    }
    [[nodiscard]] bool streams() const noexcept;
    [[nodiscard]] const drive::Pace& pace() const noexcept { return pace_; }

private:
    [[nodiscard]] Axis* of(AxisId id) noexcept;
    void fit_axes();
    [[nodiscard]] AxisId first_axis() const noexcept { return axes_.empty() ? no_axis : axes_.front()->id(); }
    void send(Ask ask, Turn& t);
    void transfer(Turn& t);
    void emit_frames(std::vector<Frame>& frames, Priority priority, Turn& t);
    void ended(const canopen::SdoEnd& end, Turn& t);
    void watch_for_twins(Turn& t);
    void tell_two_nodes(std::string_view sign, Turn& t);
    void heed(Axis::News news, Turn& t);
    void unanswered(Turn& t);
    void forget(Reason reason, std::string_view why, Turn& t);
    // start.cpp
    void probed(const canopen::SdoEnd& end, Turn& t);
    void start();  ///< all of it anew
    void start_axes();
    void started(const canopen::SdoEnd& end, Turn& t);
    void next_start(Turn& t);
    void set_up();
    void set_up_watch();
    void watch_set(const Step& step, const canopen::SdoEnd& end, Turn& t);
    // feedback.cpp
    void on_emergency(const canopen::Emergency& e, Turn& t);
    void on_heartbeat(const Frame& frame, Turn& t);
    [[nodiscard]] bool on_pdo(const Frame& frame, Turn& t);

    Node node_;
    std::size_t slot_;
    std::vector<std::unique_ptr<Axis>> axes_;
    std::size_t turn_ = 0;  ///< whose turn it is among them
    drive::Pace pace_;
    Duration heartbeat_period_ = std::chrono::milliseconds(500);
    drive::LateMarks<Address, 8> late_;
    canopen::SdoClient sdo_;
    canopen::HeartbeatWatch heartbeat_;
    canopen::EmergencyGate gate_;
    bool answered_twice_ = false;  ///< the question before this one
    int twice_in_a_row_ = 0;
    bool two_nodes_told_ = false;  ///< since the line is up
    Ask ask_;
    struct StartStep {
        Step step;
        Axis* axis = nullptr;  ///< nullptr: of the node
    };
    std::vector<StartStep> start_;
    std::size_t start_at_ = 0;
    Instant check_at_ = never;  ///< of a node without an axis that listens
    std::string identity_;
    ExpectedIdentity expected_;  ///< of the description, if the site names one
    Identity told_;
    DoubleBeat double_beat_;
    std::uint32_t watched_ = 0;  ///< 1016h:01 as it was found
};

}  // namespace axisgate::cia402_drive
