// The CAN line of CiA 402 drives: the drives of the line, the received frames, and the common SYNC. The adapter sends no message to all
// nodes other than SYNC and its own heartbeat.
#pragma once

#include "adapters/cia402/drive.hpp"
#include "gateway/drive/roster.hpp"
#include "gateway/protocols/canopen/sync.hpp"

namespace axisgate::cia402_drive {

class LineAdapter final : public Adapter {
public:
    /// `catalogue` is the family's, for drives whose setup names none.
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
    /// Distributes the drives of the site over the SYNC cycles. An axis that follows set-points keeps the cycle that it was configured
    /// with.
    void plan_beats(Turn& t);
    [[nodiscard]] Duration wished_beat() const;
    /// Time between two SYNCs: the cycle of the plan, longer at standstill, shorter while an axis is observed closely and the bus has
    /// capacity. Zero: no drive uses SYNC.
    [[nodiscard]] Duration period() const;
    void plan_sync(Instant now);
    void send_targets(Turn& t);
    void send_sync(Turn& t);
    void choose_own_node(const LineSetup& setup);
    /// The heartbeat is sent as long as a drive that monitors it answers. If none answers any more, it stops, so that the drives' own
    /// monitoring acts.
    void plan_heartbeat(Instant now);
    Line line_;
    drive::Roster<Drive> drives_;
    std::array<Drive*, 128> by_node_{};
    bool up_ = false;
    Duration wished_{};  ///< the cycle for which the plan was made
    canopen::SyncProducer sync_;
    Instant targets_at_ = never;            ///< time before the SYNC at which the targets are sent, so that they arrive before it
    std::uint64_t targets_for_ = 0;         ///< the cycle whose targets were sent last
    canopen::HeartbeatProducer heartbeat_;  ///< of the gateway
    Duration heartbeat_period_{};
};

}  // namespace axisgate::cia402_drive
