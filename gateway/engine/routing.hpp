// Routing calls the adapters, and distributes their output and that of their lines: frames to the line; links, feedback, samples, notices,
// results and ends of streams to the parts that handle them. It never blocks, and its loops are bounded by the output of one call.
#pragma once

#include <deque>

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Routing {
public:
    Routing(Machine& machine, Publisher& publisher, Presences& presences, Orders& orders, Clients& clients, Motions& motions,
            Supervisor& supervisor, LossOfCommand& loss, Streams& streams)
        : machine_(machine),
          publisher_(publisher),
          presences_(presences),
          orders_(orders),
          clients_(clients),
          motions_(motions),
          supervisor_(supervisor),
          loss_(loss),
          streams_(streams) {}
    /// Makes one call of an adapter and distributes its output.
    template <class F>
    void ask(Speaker& by, Instant now, F&& call) {
        const Spare spare(*this);
        call(spare.out);
        drain(by, spare.out, now);
    }
    // Calls of a line to its side.
    void received(Side& side, const Frame& frame);
    void sent(Side& side, const Frame& frame);
    void line_state(Side& side, bool up, const std::string& why);
    /// The time from the acceptance of a command to the transmission of its first frame on a real line; any thread.
    [[nodiscard]] const Histogram& write_to_frame() const noexcept { return write_to_frame_; }

private:
    void drain(Speaker& by, Out& out, Instant now);
    void feedback(Side& side, AxisId axis, const AxisFeedback& value, Instant now);
    /// An Out for one call. Calls can be nested, so there is one for each depth; they are kept to avoid allocations.
    struct Spare {
        explicit Spare(Routing& r) : depth(r.depth_), out(depth < r.outs_.size() ? r.outs_[depth] : r.outs_.emplace_back()) { ++depth; }
        ~Spare() {
            out.clear();
            --depth;
        }
        Spare(const Spare&) = delete;
        Spare& operator=(const Spare&) = delete;
        std::size_t& depth;
        Out& out;
    };

    Machine& machine_;
    Publisher& publisher_;
    Presences& presences_;
    Orders& orders_;
    Clients& clients_;
    Motions& motions_;
    Supervisor& supervisor_;
    LossOfCommand& loss_;
    Streams& streams_;
    std::deque<Out> outs_;
    std::size_t depth_ = 0;
    Histogram write_to_frame_;
};

}  // namespace axisgate::engine
