// BusManners stands between the line and the node of a simulated MACS: it delays, refuses and adds frames as a real controller may. The
// node behind it is that of CiA 402 drives and answers at once.
#pragma once

#include <deque>

#include "adapters/aposs/twin/manners.hpp"
#include "adapters/cia402/twin/node.hpp"

namespace axisgate::aposs {

class BusManners {
public:
    BusManners(const Manners& manners, std::uint8_t node);

    void power_on(Instant now);
    void power_off();
    /// A frame of the line; it reaches the node now, later or not at all.
    void receive(cia402_drive::twin::Node& node, const Frame& frame, Instant now, Out& out);
    /// Everything that is due until `now`, each at its instant, and the node's own events.
    void run(cia402_drive::twin::Node& node, Instant now, Out& out);
    [[nodiscard]] Instant deadline() const;
    /// Frames that the node has sent; `by_itself`: no frame of the line was their cause.
    void pass(const Out& from_node, Instant now, Out& out, bool by_itself = false);

private:
    static constexpr std::size_t most_requests = 8, most_waiting = 1024;  ///< further ones are lost
    struct Waiting {
        Instant at;
        Frame frame;
    };
    [[nodiscard]] bool happens(std::string_view what, std::int64_t share) const;
    [[nodiscard]] bool lacks(canopen::Address address) const;
    /// The refusal of a request that the node itself would carry out; Abort::none: it gets it.
    [[nodiscard]] canopen::Abort refusal(const canopen::Dictionary& dictionary, const Frame& request) const;
    [[nodiscard]] canopen::Abort refused_setup(const canopen::Dictionary& dictionary, canopen::Address address, std::uint32_t value) const;
    void serve(cia402_drive::twin::Node& node, const Frame& request, Instant at, Out& out);
    void wait(const Frame& frame, Instant at);
    void speak_foreign(Instant at, Out& out);

    Manners manners_;
    std::uint8_t node_;
    bool plain_;                    ///< everything passes as it is
    std::deque<Waiting> requests_;  ///< in order; each is answered when the one before is
    std::deque<Waiting> waiting_;   ///< frames to the line, in order of time
    Instant foreign_at_ = never;
    canopen::NmtState state_ = canopen::NmtState::pre_operational;
    std::uint64_t requests_seen_ = 0, beats_ = 0, foreign_sent_ = 0;
};

}  // namespace axisgate::aposs
