// LossOfCommand halts, stops or disables an axis, as its site entry says, when the client that commands it is lost or silent for too long.
// A loss concerns the motion that the lost client owns, even if other clients have sent commands to the axis since, and an axis at rest
// that it commanded last.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class LossOfCommand {
public:
    LossOfCommand(Machine& machine, Pending& pending, EngineHost& host, Publisher& publisher, Orders& orders, Streams& streams)
        : machine_(machine), pending_(pending), host_(host), publisher_(publisher), orders_(orders), streams_(streams) {}
    void on_client_lost(const AuthorityClient& who, LossCause cause, Instant now);
    /// The lease of `holder` on this axis has expired.
    void on_lease_ended(Axis& axis, const AuthorityClient& holder, Instant now);
    /// The action of the axis' site entry for this cause. `lost` is the lost client, if it is not the owner of the motion.
    void act(Axis& axis, LossCause cause, Instant now, const AuthorityClient* lost = nullptr);
    /// The axis moves, and no order caused it: applies the site's action for this case and reports it in any case.
    void unowned(Axis& axis, Instant now);
    void check_watchdog(Axis& axis, Instant now);
    /// Stops every axis that is not at rest; the end of the gateway counts as a loss of command.
    void shut_down(Instant now);
    [[nodiscard]] static AtLoss at_loss(const Axis& axis);
    [[nodiscard]] std::uint64_t losses(LossCause cause) const noexcept { return losses_.at(static_cast<std::size_t>(cause)); }

private:
    /// Motions that a drive accepts from now on begin without their owner. `axis`: only those of this axis; null: of all.
    void orphan(const AuthorityClient& who, LossCause cause, const Axis* axis);
    Machine& machine_;
    Pending& pending_;
    EngineHost& host_;
    Publisher& publisher_;
    Orders& orders_;
    Streams& streams_;
    std::array<std::uint64_t, most_loss_causes> losses_{};
};

}  // namespace axisgate::engine
