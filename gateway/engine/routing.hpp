// Routing: calls of adapters, and the way up of what they and their lines bring.
// In: a call of one adapter; frames, line states and sent frames of a side. Out: frames to the line; links, feedback, samples, notices,
// results and ends of streams to the parts that they concern.
// Never blocks and never loops over more than what one call brought.
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
    /// One call of an adapter, and what it gave back handed on.
    template <class F>
    void ask(Speaker& by, Instant now, F&& call) {
        const Spare spare(*this);
        call(spare.out);
        drain(by, spare.out, now);
    }
    // What a line tells its side.
    void received(Side& side, const Frame& frame);
    void sent(Side& side, const Frame& frame);
    void line_state(Side& side, bool up, const std::string& why);
    /// From a command's being taken to its first frame having left on a real line; any thread.
    [[nodiscard]] const Histogram& write_to_frame() const noexcept { return write_to_frame_; }

private:
    void drain(Speaker& by, Out& out, Instant now);
    void feedback(Side& side, AxisId axis, const AxisFeedback& value, Instant now);
    /// An Out for one call. Calls come from inside others, so there is one for each depth; kept for their room.
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
