// Door: what a protocol server on the hot thread sees of the gateway.
// In: commands with an origin. Out: the image, and one result per ticket through the door's own sink.
// Never used from another thread: those have the services' gateway.hpp.
#pragma once

#include <optional>
#include <string_view>

#include "gateway/axis/authority.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/core/command.hpp"
#include "gateway/site/fail_safe.hpp"
#include "gateway/axis/image.hpp"

namespace axisgate {

struct Event;

/// Tickets carry their door in the upper bits, so that a result finds its way back without a table.
[[nodiscard]] constexpr Ticket make_ticket(Door door, std::uint64_t sequence) noexcept {
    return (static_cast<Ticket>(door) << 56) | (sequence & 0x00FF'FFFF'FFFF'FFFFull);
}
[[nodiscard]] constexpr Door door_of(Ticket ticket) noexcept { return static_cast<Door>(ticket >> 56); }

struct ResultSink {
    virtual void on_result(const Result& result) = 0;
    /// When a client of this door was last heard, by its stable name; nothing: none of that name is connected, or the door does not watch.
    [[nodiscard]] virtual std::optional<Instant> heard(std::string_view /*client*/) const { return std::nullopt; }
    virtual ~ResultSink() = default;
};

struct DoorPort {
    [[nodiscard]] virtual Instant now() const = 0;
    [[nodiscard]] virtual const Image& image() const = 0;
    /// Catalogue of an axis' family; nullptr if the axis is not configured.
    [[nodiscard]] virtual const Catalogue* catalogue(AxisId axis) const = 0;
    /// Takes a command whose ticket the door made with make_ticket. The result comes to the door's sink: never from inside this
    /// call (so that a door need not be re-entrant), at the end of the same turn at the earliest.
    virtual void submit(Command command) = 0;
    /// Results for tickets of `door` go to `sink`, which outlives the port's use or is withdrawn with nullptr.
    virtual void attach(Door door, ResultSink* sink) = 0;
    /// The last connection of a client has ended: what it commanded is treated as the axes' site entries say.
    virtual void client_lost(const AuthorityClient& /*who*/, LossCause /*cause*/) {}
    /// Something that a door wants to be kept and streamed; id, time and, where there is an axis, its name are filled in.
    virtual void note(Event&& /*event*/, AxisId /*axis*/) {}
    virtual ~DoorPort() = default;
};

}  // namespace axisgate
