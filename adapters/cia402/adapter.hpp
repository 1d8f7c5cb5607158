// Adapter of CiA 402 drives: the CAN line: who is on it, whose turn it is, what arrives, and the SYNC of all of them.
// In: setup, line state, commands, set-points, frames, time. Out: frames; feedback, results, links, notices.
// Never sends a message to all nodes but the SYNC and its own heartbeat.
#pragma once

#include "adapters/cia402/drive.hpp"
#include "gateway/drive/roster.hpp"
#include "gateway/protocols/canopen/sync.hpp"

namespace axisgate::cia402_drive {

class LineAdapter final : public Adapter {
public:
    /// `catalogue` is the family's page, for drives whose setup names none.
    explicit LineAdapter(const Catalogue& catalogue) : line_(catalogue) {}
    void configure(const LineSetup& setup, Instant now, Out& out) override;
    void on_line(bool up, Instant now, Out& out) override;
    void on_command(const Command& command, Instant now, Out& out) override;
    void on_set_point(const SetPoint& set_point, Instant now, Out& out) override;
    void on_frame(const Frame& frame, Instant now, Out& out) override;
    void on_deadline(Instant now, Out& out) override;
    [[nodiscard]] Instant deadline() const override {
        return std::min({line_.turns.deadline(), sync_.deadline(), targets_at_, heartbeat_.deadline()});
    }
    [[nodiscard]] AdapterCounters counters() const override { return line_.counters; }

private:
    void end(Turn& t);
    /// Which drive tells in which beats, by the drives of the site; an axis that is led keeps the beat that it was told to reckon with.
    void plan_beats(Turn& t);
    [[nodiscard]] Duration wished_beat() const;
    /// Between two SYNCs: the beat of the plan, longer at rest, shorter where somebody looks closely and the bus has room; zero: nobody
    /// listens.
    [[nodiscard]] Duration period() const;
    void plan_sync(Instant now);
    void send_targets(Turn& t);
    void send_sync(Turn& t);
    void choose_own_node(const LineSetup& setup);
    /// As long as a drive that watches it answers. One that is alone and does not answer any more is left to its watchdog.
    void plan_heartbeat(Instant now);
    Line line_;
    drive::Roster<Drive> drives_;
    std::array<Drive*, 128> by_node_{};
    bool up_ = false;
    Duration wished_{};  ///< the beat that the plan was made for
    canopen::SyncProducer sync_;
    Instant targets_at_ = never;            ///< so long before the SYNC that they are there with it
    std::uint64_t targets_for_ = 0;         ///< the beat whose targets went out last
    canopen::HeartbeatProducer heartbeat_;  ///< the gateway's own
    Duration heartbeat_period_{};
};

}  // namespace axisgate::cia402_drive
