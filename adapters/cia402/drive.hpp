// Drive is one CANopen node: its presence, its SDO channel, and its axes, which use the channel in turns. drive.cpp chooses the next
// request; feedback.cpp evaluates PDOs, EMCY and heartbeats. Parts: start.hpp, drive_exchange.hpp. Axes: drive_axis.hpp.
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

    /// The site has changed the axes of the node. Axes that remain are not disturbed.
    void set_axes(const DriveSetup& setup, Turn& t);
    void line_up(Turn& t) { node.presence.begin(t.now); }
    void line_down(std::string_view why, Turn& t);
    void submit(const Command& command, Turn& t);
    void follow(const SetPoint& set_point);
    /// The site has changed how closely axes are observed, or their limits; changed limits are written to the drive again.
    void look(const DriveSetup& setup);
    void on_frame(const Frame& frame, Turn& t);
    void before_sync(Turn& t);  ///< sends the next targets
    void after_sync() noexcept;
    // called by drive::settle, serve and wake
    [[nodiscard]] drive::Want wants(Instant now) const noexcept;
    [[nodiscard]] Instant deadline() const noexcept { return std::min(exchanges.deadline(), heartbeat_.deadline()); }
    [[nodiscard]] Instant wish() const noexcept;
    void go(Turn& t);
    void on_deadline(Turn& t);

    [[nodiscard]] const DriveSetup& setup() const noexcept { return node.setup; }
    [[nodiscard]] std::size_t slot() const noexcept { return slot_; }
    [[nodiscard]] int listeners() const noexcept;
    /// The node waits for its PDOs, or for the cycle in which they begin.
    [[nodiscard]] bool beats_wanted() const noexcept {
        return !node.only_reads && (listeners() > 0 || (node.presence.is(Presence::Phase::starting) && start.at_end()));
    }
    [[nodiscard]] bool quick() const noexcept;
    /// An axis follows set-points, or rests in a cyclic mode: the SYNC keeps its period, because the drive may monitor it.
    [[nodiscard]] bool streams() const noexcept;
    /// Within which it expects the gateway's heartbeat; zero: it does not monitor it, or does not answer.
    [[nodiscard]] Duration watch_time() const noexcept {
        if (!node.presence.online()) return {};
        return node.presence.watchdog().state == DriveWatchdog::State::armed ? node.watch.time : start.watched();
    }
    /// The gateway's node number has changed: the node is set up again, and remains in operation meanwhile.
    void watch_anew() {
        if (node.presence.is(Presence::Phase::ready) && !axes.empty()) start.begin();
    }
    [[nodiscard]] const drive::Pace& pace() const noexcept { return pace_; }

    // --- for its parts --------------------------------------------------------------------------------------------------
    void forget(Reason reason, std::string_view why, Turn& t);
    /// A notice of the node, or of its first axis if it has one.
    void notice(Severity severity, std::string_view kind, std::int32_t code, std::string text, Turn& t);
    /// An SDO answer arrived that was not requested, or for the second time.
    void stray() noexcept { double_answer_.stray(); }
    /// The node sends heartbeats with this period from now on; zero: it has refused.
    void beats(Duration period) noexcept { double_beat_.begin(period); }
    /// All values that commands need are known, and the node is set up.
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
    std::size_t turn_ = 0;  ///< the axis that may use the SDO channel next
    drive::Pace pace_;
    Duration heartbeat_period_ = std::chrono::milliseconds(500);
    canopen::HeartbeatWatch heartbeat_;
    canopen::EmergencyGate gate_;
    DoubleAnswer double_answer_;
    DoubleBeat double_beat_;
    bool two_nodes_reported_ = false;  ///< since the line came up
    Instant check_at_ = never;         ///< for a node without an axis whose PDOs are expected
};

}  // namespace axisgate::cia402_drive
