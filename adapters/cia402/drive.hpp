// Drive: one CANopen node: presence, one SDO transfer at a time, and its axes, who take turns with it.
// In: commands, set-points, frames, the passing of time, a place on the line. Out: frames, feedback, results, links, notices.
// Written in: drive.cpp what it sends next, feedback.cpp PDOs, EMCY and heartbeats. Its parts: start.hpp, drive_exchange.hpp. Its axes:
// drive_axis.hpp.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "adapters/cia402/drive_axis.hpp"
#include "adapters/cia402/drive_double.hpp"
#include "adapters/cia402/drive_exchange.hpp"
#include "adapters/cia402/drive_nmt.hpp"
#include "adapters/cia402/start.hpp"
#include "gateway/drive/polls.hpp"
#include "gateway/protocols/canopen/emergency.hpp"
#include "gateway/protocols/canopen/nmt.hpp"

namespace axisgate::cia402_drive {

class Drive {
public:
    static constexpr int channels = most_axes;
    Drive(Line& line, const DriveSetup& setup, std::size_t slot);
    Drive(const Drive&) = delete;
    Drive& operator=(const Drive&) = delete;

    /// Other axes of the same node: those that stay go on undisturbed.
    void set_axes(const DriveSetup& setup, Turn& t);
    void line_up(Turn& t) { node.presence.begin(t.now); }
    void line_down(std::string_view why, Turn& t);
    void submit(const Command& command, Turn& t);
    void follow(const SetPoint& set_point);
    /// The same drive in another site: how closely its axes are looked at, and their limits, which are set up anew if they are others.
    void look(const DriveSetup& setup);
    void on_frame(const Frame& frame, Turn& t);
    void before_sync(Turn& t);  ///< the next targets go out
    void after_sync() noexcept;
    // asked by drive::settle, serve and wake
    [[nodiscard]] drive::Want wants(Instant now) const noexcept;
    [[nodiscard]] Instant deadline() const noexcept { return std::min(exchanges.deadline(), heartbeat_.deadline()); }
    [[nodiscard]] Instant wish() const noexcept;
    void go(Turn& t);
    void on_deadline(Turn& t);

    [[nodiscard]] const DriveSetup& setup() const noexcept { return node.setup; }
    [[nodiscard]] std::size_t slot() const noexcept { return slot_; }
    [[nodiscard]] int listeners() const noexcept;
    /// Its PDOs are waited for, or the beat in which they begin.
    [[nodiscard]] bool beats_wanted() const noexcept {
        return listeners() > 0 || (node.presence.is(Presence::Phase::starting) && start.at_end());
    }
    [[nodiscard]] bool quick() const noexcept;
    [[nodiscard]] bool streams() const noexcept;
    /// It watches the gateway's heartbeat, and answers.
    [[nodiscard]] bool watches() const noexcept {
        return node.presence.online() && node.presence.watchdog().state == DriveWatchdog::State::armed;
    }
    /// The gateway has another number on the line: it is set up anew, and goes on meanwhile.
    void watch_anew() {
        if (node.presence.is(Presence::Phase::ready) && !axes.empty()) start.begin();
    }
    [[nodiscard]] const drive::Pace& pace() const noexcept { return pace_; }

    // --- for its parts --------------------------------------------------------------------------------------------------
    void forget(Reason reason, std::string_view why, Turn& t);
    /// Of the node, or of its first axis where it has one.
    void notice(Severity severity, std::string_view kind, std::int32_t code, std::string text, Turn& t);
    /// An answer to an SDO that was not asked, or was answered before.
    void stray() noexcept { double_answer_.stray(); }
    /// It sends heartbeats in this rhythm from now on; zero: it has refused.
    void beats(Duration period) noexcept { double_beat_.begin(period); }
    /// What commands rest on is known, and it is set up.
    void made_ready(Turn& t);
    [[nodiscard]] Duration heartbeat_period() const noexcept { return heartbeat_period_; }

    Node node;
    std::vector<std::unique_ptr<Axis>> axes;
    Exchanges exchanges;
    Start start;
    NmtWatch nmt;

private:
    [[nodiscard]] Axis* of(AxisId id) noexcept;
    void fit_axes();
    void ended(const canopen::SdoEnd& end, Turn& t);
    void tell_two_nodes(std::string_view sign, Turn& t);
    void heed(Axis::News news, Turn& t);
    void unanswered(bool cut, Turn& t);
    void look_soon(Instant now) noexcept;
    // feedback.cpp
    void on_emergency(const canopen::Emergency& e, Turn& t);
    void on_heartbeat(const Frame& frame, Turn& t);
    [[nodiscard]] bool on_pdo(const Frame& frame, Turn& t);

    std::size_t slot_;
    std::size_t turn_ = 0;  ///< whose turn it is among the axes
    drive::Pace pace_;
    Duration heartbeat_period_ = std::chrono::milliseconds(500);
    canopen::HeartbeatWatch heartbeat_;
    canopen::EmergencyGate gate_;
    DoubleAnswer double_answer_;
    DoubleBeat double_beat_;
    bool two_nodes_reported_ = false;  ///< since the line is up
    Instant check_at_ = never;         ///< of a node without an axis that listens
};

}  // namespace axisgate::cia402_drive
