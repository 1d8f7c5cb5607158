// What the parts of one drive have in common: its line, its options, and how each part reaches the others.
// In: calls by drives and their parts. Out: frames in the turn's Out, counters. Bus is implemented by the adapter alone.
// Never lets one drive look into another: questions about others are asked of the bus, by ID.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "adapters/uim342/parameters_points.hpp"
#include "adapters/uim342/wire_instructions.hpp"
#include "gateway/drive/bus.hpp"
#include "gateway/drive/part.hpp"

namespace axisgate::uim342 {

using drive::Turn;

class Drive;

/// How one drive's share of a joint order (StartTogether, global stop) ended.
struct Share {
    bool good = false;
    Reason reason = Reason::none;
    std::int32_t code = 0;
    std::string text{};
};

struct Bus : drive::Bus {
    Bus(const Catalogue& c, LineKind k) : drive::Bus(c), points(c), kind(k) {}
    Bus(const Bus&) = delete;
    Bus& operator=(const Bus&) = delete;

    /// Sends now. Not for urgent frames alone: a place in the window must have been given for the others.
    virtual void transmit(const Message& m, Priority priority, Turn& t, Ticket order) = 0;
    /// A drive that joined has come to the joint order in its queue.
    virtual void share_ready(Drive& drive, Turn& t) = 0;
    /// One drive's share of the joint order in progress has come to its end (or to "begun").
    virtual void share_done(Drive& drive, Share share, Turn& t) = 0;
    /// Name of the drive of this line that has `id` as its node ID or, as far as known, its group ID; empty: nobody.
    [[nodiscard]] virtual std::string user_of(std::uint8_t id, const Drive& but) const = 0;

    const Points points;
    const LineKind kind;

protected:
    ~Bus() = default;
};

/// The drive's options of the site, read once (README.md).
struct DriveOptions {
    bool notify = false;          ///< notify = on: RT 0x29 is switched on (in RAM, while the driver is on)
    bool absolute_known = false;  ///< referenced = absolute: with an absolute encoder the zero counts as known
    std::uint8_t home_input = 0;  ///< 1..3; 0: none
    bool home_high = true;        ///< level of the active switch
    std::uint32_t home_velocity = 0;
    Duration home_timeout = std::chrono::seconds(60);
    std::vector<std::string> faults;  ///< options that could not be read
};
[[nodiscard]] DriveOptions drive_options(const DriveSetup& setup);

using Part = drive::Part<Drive>;

}  // namespace axisgate::uim342
