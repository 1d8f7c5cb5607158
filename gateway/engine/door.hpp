// Door: what a protocol server on the hot thread sees of the gateway, and what the gateway tells every one of them.
// In: commands with an origin. Out: the image; one result per ticket, sites, samples, to each door of the hot loop's list.
// Never used from another thread: those have the services' ports.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/axis/authority.hpp"
#include "gateway/axis/guard.hpp"
#include "gateway/axis/image.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/core/command.hpp"
#include "gateway/core/sample.hpp"
#include "gateway/site/fail_safe.hpp"
#include "gateway/site/ways_in.hpp"

namespace axisgate {

struct Event;
struct SiteState;

/// Place of a door in its thread's list. Tickets carry it in their upper bits, so that a result finds its way back without a table.
using DoorNumber = std::uint8_t;
inline constexpr DoorNumber first_service_door = 0x80;  ///< from here on: doors of the service thread; below: of the hot thread, from 1
inline constexpr DoorNumber engine_itself = 0xFF;       ///< the engine's own orders: their results come to no door

[[nodiscard]] constexpr Ticket make_ticket(DoorNumber door, std::uint64_t sequence) noexcept {
    return (static_cast<Ticket>(door) << 56) | (sequence & 0x00FF'FFFF'FFFF'FFFFull);
}
[[nodiscard]] constexpr DoorNumber door_of(Ticket ticket) noexcept { return static_cast<DoorNumber>(ticket >> 56); }

/// One connection of a client, as other doors show it and close it.
struct DoorConnection {
    std::uint64_t number = 0;     ///< within its door; another one of the same door never gets it
    std::string_view kind;        ///< "modbus_tcp", "session", "messages", "exclusive_owner", "input_only", "listen_only"
    std::string peer;             ///< "192.0.2.7:51123"
    Instant since{}, received{};  ///< opened; its last sign of life
    std::vector<AxisId> axes;     ///< that it owns
    bool commands = false;        ///< its client has commanded by it
};

/// A protocol server on the hot thread, or something else there that gives commands. All calls come from that thread, between two turns'
/// handlers, unless it says otherwise.
class HotDoor {
public:
    virtual ~HotDoor() = default;
    /// As the log and `ready` call it: "modbus".
    [[nodiscard]] virtual std::string_view name() const = 0;
    /// By which somebody can set an axis in motion here, each with the losses that end it; none: it only shows.
    [[nodiscard]] virtual std::span<const WayIn> ways_in() const = 0;
    /// What it listens on; empty: on nothing that has an address.
    [[nodiscard]] virtual std::vector<std::string> addresses() const { return {}; }
    /// Of one of its tickets; never from inside DoorPort::submit.
    virtual void on_result(const Result& result) = 0;
    /// A site is in force: ids must be looked up anew.
    virtual void on_site(const SiteState& /*site*/) {}
    /// A drive has told a parameter's value, asked for or not.
    virtual void on_sample(const Sample& /*sample*/) {}
    /// When a client of this door was last heard; nothing: it has no connection here, or the door does not watch.
    [[nodiscard]] virtual std::optional<Instant> last_received(const AuthorityClient& /*client*/) const { return std::nullopt; }
    /// Who is connected, in no order; empty where the door has no connections.
    [[nodiscard]] virtual std::vector<DoorConnection> connections() const { return {}; }
    /// Ends one of them as if its network had: whoever commanded by it is lost. False: there is none of this number.
    virtual bool close_connection(std::uint64_t /*number*/) { return false; }
    /// Numbers of connections that it would close if this site were put in force: those whose own bytes would be others.
    [[nodiscard]] virtual std::vector<std::uint64_t> closed_by(const SiteState& /*wanted*/) const { return {}; }
    /// Serves what is there at this moment, for a loop that polls instead of sleeping; false: there was nothing.
    virtual bool serve_now() { return false; }
    /// Its counters as Prometheus text. Any thread.
    [[nodiscard]] virtual std::string metrics() const { return {}; }
};

struct DoorPort {
    [[nodiscard]] virtual Instant now() const = 0;
    [[nodiscard]] virtual const Image& image() const = 0;
    /// Catalogue of an axis' drive; nullptr if the axis is not configured.
    [[nodiscard]] virtual const Catalogue* catalogue(AxisId axis) const = 0;
    /// Takes a command whose ticket was made with the door's number. The result comes to the door: never from inside this call (so that a
    /// door need not be re-entrant), at the end of the same turn at the earliest.
    virtual void submit(Command command) = 0;
    /// Hands on a streamed set-point (SetPoint): no ticket. Nothing: it is on its way to the drive; what becomes of it is in the image.
    /// Else why it is refused, which is in the image as well.
    virtual std::optional<Refusal> set_point(const SetPoint& set_point) = 0;
    /// Puts a door into the list; it gets all that HotDoor has until it is detached, which it must be before it ends.
    [[nodiscard]] virtual DoorNumber attach(HotDoor& door) = 0;
    virtual void detach(HotDoor& door) = 0;
    /// The last connection of a client has ended: what it commanded is treated as the axes' site entries say.
    virtual void client_lost(const AuthorityClient& /*who*/, LossCause /*cause*/) {}
    /// Something that a door wants to be kept and streamed; id, time and, where there is an axis, its name are filled in.
    virtual void note(Event&& /*event*/, AxisId /*axis*/) {}
    virtual ~DoorPort() = default;
};

}  // namespace axisgate
