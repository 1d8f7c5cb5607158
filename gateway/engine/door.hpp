// The interface between the engine and the protocol servers on the hot thread: DoorPort is the gateway as a door sees it, HotDoor is a door
// as the hot loop sees it. It must not be used on other threads, which have the ports of the services.
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

/// Number of a door in its thread's list. Tickets contain it in their upper bits, so that a result finds its door without a table.
using DoorNumber = std::uint8_t;
inline constexpr DoorNumber first_service_door = 0x80;  ///< from here on doors of the service thread; below it doors of the hot thread,
                                                        ///< from 1
inline constexpr DoorNumber engine_itself = 0xFF;       ///< for the engine's own orders, whose results go to no door

[[nodiscard]] constexpr Ticket make_ticket(DoorNumber door, std::uint64_t sequence) noexcept {
    return (static_cast<Ticket>(door) << 56) | (sequence & 0x00FF'FFFF'FFFF'FFFFull);
}
[[nodiscard]] constexpr DoorNumber door_of(Ticket ticket) noexcept { return static_cast<DoorNumber>(ticket >> 56); }

/// One connection of a client, for the list of connections and for closing it from another door.
struct DoorConnection {
    std::uint64_t number = 0;     ///< unique within its door; never used again
    std::string_view kind;        ///< "modbus_tcp", "session", "messages", "exclusive_owner", "input_only", "listen_only"
    std::string peer;             ///< "192.0.2.7:51123"
    Instant since{}, received{};  ///< when it was opened, and when data arrived last
    std::vector<AxisId> axes;     ///< the axes that it owns
    bool commands = false;        ///< its client has commanded over this connection
};

/// A protocol server or another source of commands on the hot thread. All calls come from that thread, between the handlers of two turns,
/// unless stated otherwise.
class HotDoor {
public:
    virtual ~HotDoor() = default;
    /// Name in the log and in `ready`, such as "modbus".
    [[nodiscard]] virtual std::string_view name() const = 0;
    /// The ways in which a client can set an axis in motion over this door, each with the causes of loss that end such a motion. Empty if
    /// the door only shows values.
    [[nodiscard]] virtual std::span<const WayIn> ways_in() const = 0;
    /// Address on which it listens; empty if it has no address.
    [[nodiscard]] virtual std::vector<std::string> addresses() const { return {}; }
    /// Reports the result of one of the door's tickets. Never called from inside DoorPort::submit.
    virtual void on_result(const Result& result) = 0;
    /// A new site is in force; the door must look up its ids again.
    virtual void on_site(const SiteState& /*site*/) {}
    /// A drive has reported the value of a parameter, with or without a request.
    virtual void on_sample(const Sample& /*sample*/) {}
    /// The time of the last message of a client. Empty if the client has no connection here, or if the door does not monitor its clients.
    [[nodiscard]] virtual std::optional<Instant> last_received(const AuthorityClient& /*client*/) const { return std::nullopt; }
    /// The open connections, in no order; empty if the door has none.
    [[nodiscard]] virtual std::vector<DoorConnection> connections() const { return {}; }
    /// Closes one connection as if its network had failed, so that the loss of its client is handled. Returns false if the number does not
    /// exist.
    virtual bool close_connection(std::uint64_t /*number*/) { return false; }
    /// Numbers of the connections that the door would close if this site came into force, because their own bytes would change.
    [[nodiscard]] virtual std::vector<std::uint64_t> closed_by(const SiteState& /*wanted*/) const { return {}; }
    /// Handles the data that are available at this moment, for a loop that polls instead of sleeping. Returns false if there were none.
    virtual bool serve_now() { return false; }
    /// Counters as Prometheus text. Called from any thread.
    [[nodiscard]] virtual std::string metrics() const { return {}; }
};

struct DoorPort {
    [[nodiscard]] virtual Instant now() const = 0;
    [[nodiscard]] virtual const Image& image() const = 0;
    /// Catalogue of the axis' drive; nullptr if the axis is not configured.
    [[nodiscard]] virtual const Catalogue* catalogue(AxisId axis) const = 0;
    /// Accepts a command whose ticket contains the door's number. The result is delivered at the end of the same turn at the earliest and
    /// never from inside this call, so that a door need not be re-entrant.
    virtual void submit(Command command) = 0;
    /// Passes on a streamed set-point, which has no ticket. Empty if it was passed on; its effect is visible in the image. Otherwise the
    /// refusal, which the image shows as well.
    virtual std::optional<Refusal> set_point(const SetPoint& set_point) = 0;
    /// Adds a door to the list. It receives all calls of HotDoor until it is detached, which must happen before its destruction.
    [[nodiscard]] virtual DoorNumber attach(HotDoor& door) = 0;
    virtual void detach(HotDoor& door) = 0;
    /// The last connection of a client has ended. The `fail_safe` entries of the axes that it commanded are applied.
    virtual void client_lost(const AuthorityClient& /*who*/, LossCause /*cause*/) {}
    /// Stores and publishes an event of the door. Id, time and, for an axis, its name are filled in.
    virtual void note(Event&& /*event*/, AxisId /*axis*/) {}
    virtual ~DoorPort() = default;
};

}  // namespace axisgate
