// Loss of command: an axis whose commander is gone, or silent for too long, is halted, stopped or switched off as its site entry says.
// In: doors' word that a client is gone, the instant at which a client was heard last. Out: the action, an event, register 22, a count.
// A loss concerns the motion of the client that is lost, whoever has spoken to the axis since; and an axis at rest that it commanded last.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class LossOfCommand {
public:
    LossOfCommand(Machine& machine, Pending& pending, EngineHost& host, Publisher& publisher, Orders& orders, Streams& streams)
        : machine_(machine), pending_(pending), host_(host), publisher_(publisher), orders_(orders), streams_(streams) {}
    void on_client_lost(const AuthorityClient& who, LossCause cause, Instant now);
    /// What the axis' site entry says to this cause. `lost`: who is lost, where that need not be the owner of its motion.
    void act(Axis& axis, LossCause cause, Instant now, const AuthorityClient* lost = nullptr);
    /// It moves, and nobody has ordered it: what the site says to that, told either way.
    void unowned(Axis& axis, Instant now);
    void check_watchdog(Axis& axis, Instant now);
    /// Stops every axis that is not at rest: the gateway's own end is a loss of command.
    void shut_down(Instant now);
    [[nodiscard]] static AtLoss at_loss(const Axis& axis);
    /// What the silence of a client that streams set-points is called.
    [[nodiscard]] static LossCause silence_of(const AuthorityClient& who) noexcept {
        return who.door == Door::dds ? LossCause::dds_deadline : LossCause::set_points_silent;
    }
    [[nodiscard]] std::uint64_t losses(LossCause cause) const noexcept { return losses_[static_cast<std::size_t>(cause)]; }

private:
    Machine& machine_;
    Pending& pending_;
    EngineHost& host_;
    Publisher& publisher_;
    Orders& orders_;
    Streams& streams_;
    std::array<std::uint64_t, loss_causes.size() + 1> losses_{};
};

}  // namespace axisgate::engine
