// Bus: what one node sees of its line: how to send, the times in force, who else is there; and the small types they share.
// In: calls by nodes. Out: frames in the turn's Out, counters. Implemented by the adapter alone.
// Never lets one node look into another: questions about others are asked here, by ID.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "adapters/uim342/parameters_points.hpp"
#include "adapters/uim342/wire_instructions.hpp"
#include "gateway/core/adapter.hpp"
#include "gateway/drive/timing.hpp"
#include "gateway/drive/turn.hpp"
#include "gateway/drive/turns.hpp"

namespace axisgate::uim342 {

using drive::Turn;

class Drive;

/// How one node's part of a joint order (StartTogether, global stop) ended.
struct Part {
    bool good = false;
    Reason reason = Reason::none;
    std::int32_t code = 0;
    std::string text;
};

struct Bus {
    Bus(const Catalogue& c, LineKind k) : catalogue(c), points(c), kind(k) {}
    Bus(const Bus&) = delete;
    Bus& operator=(const Bus&) = delete;

    /// Sends now. Not for urgent frames alone: a place in the window must have been given for the others.
    virtual void transmit(const Message& m, Priority priority, Turn& t) = 0;
    /// A node that joined has come to the joint order in its queue.
    virtual void part_ready(Drive& node, Turn& t) = 0;
    /// One node's part of the joint order in progress has come to its end (or to "begun").
    virtual void part_done(Drive& node, Part part, Turn& t) = 0;
    /// Name of the drive of this line that has `id` as its node ID or, as far as known, its group ID; empty: nobody.
    [[nodiscard]] virtual std::string user_of(std::uint8_t id, const Drive& but) const = 0;

    const Catalogue& catalogue;
    const Points points;
    const LineKind kind;
    drive::Timing timing;
    AdapterCounters counters;
    std::uint32_t bit_rate = 0;
    drive::Turns turns;  ///< a node says there when an exchange begins and ends

protected:
    ~Bus() = default;
};

}  // namespace axisgate::uim342
