// Connection manager: the connections of originators with this device, their data, time-outs and ends.
// Forward_Open and similar requests, implicit datagrams and time come in; answers come out, implicit datagrams go to `Carrier` and events
// to `Values`. At most `most_connections` are open (then 0x0113; `most_explicit` of explicit messages, then 0x011A), and no address can
// take all of them. Data from a wrong address, old data and data of a wrong size are dropped and counted.
#pragma once

#include <array>
#include <memory>
#include <utility>

#include "gateway/core/counter.hpp"
#include "gateway/core/places.hpp"
#include "gateway/protocols/cip/encapsulation.hpp"
#include "gateway/protocols/cip/forward_open.hpp"
#include "gateway/protocols/cip/objects.hpp"

namespace axisgate::cip {

/// Sends datagrams to originators.
struct Carrier {
    /// Sends a datagram of implicit data, marked with `dscp`.
    virtual void implicit(Endpoint to, View datagram, std::uint8_t dscp) = 0;
    virtual ~Carrier() = default;
};

struct Connection {
    enum class Kind : std::uint8_t { exclusive_owner, input_only, listen_only, explicit_messages };
    Kind kind = Kind::exclusive_owner;
    std::uint16_t number = 0;  ///< number of its place, from 1
    OpenRequest request;
    IoPlan plan;
    Peer peer;            ///< the originator's address, and the id by which Values know the connection
    Endpoint produce_to;  ///< destination of its data
    SessionKey session = 0;
    std::uint32_t ot_id = 0, to_id = 0;
    bool sends = false;   ///< of a multicast group, one connection sends
    Duration interval{};  ///< interval of sending
    Duration look{};      ///< interval of checking for a change; zero: cyclic
    Instant since{}, last_received{};
    Instant expires = never, next = never, next_look = never;
    std::uint32_t sent = 0;
    std::uint16_t sent_count = 0;
    std::uint64_t sent_revision = 0;
    bool received_any = false, running = false;
    std::uint32_t received = 0;
    std::uint16_t received_count = 0;
    std::uint16_t asked = 0;  ///< class 3: sequence count of the newest request ...
    bool asked_any = false;
    Bytes answered;  ///< ... and its answer, for a repetition

    /// Records that data have arrived.
    void touch(Instant now) noexcept {
        last_received = now;
        expires = now + request.time_out();
    }
    [[nodiscard]] bool is_io() const noexcept { return kind != Kind::explicit_messages; }
    [[nodiscard]] bool multicasts() const noexcept { return is_io() && request.to.type == Half::Type::multicast; }
};

/// "exclusive_owner", "input_only", "listen_only", "messages".
[[nodiscard]] std::string_view name_of(Connection::Kind kind) noexcept;

class ConnectionManager final : public Object, public Connections {
public:
    static constexpr std::size_t most_connections = 128;
    static constexpr std::size_t most_explicit = 64;  ///< so that explicit messages never take the last place of an owner
    /// A quarter of each is kept for owners, or for sessions that command: for them, a connection that never carried data gives way, or one
    /// of the address that has most, if it has more than an eighth (gateway/core/places.hpp). An owner never gives way.
    static constexpr std::size_t kept = most_connections / 4, kept_explicit = most_explicit / 4;
    static constexpr std::uint16_t most_message = 4002;               ///< bytes of a connection of explicit messages in one direction
    static constexpr Duration first_data = std::chrono::seconds(10);  ///< until the first datagram, whatever the time-out is

    struct Counters {
        Counter opened, open_format, open_resource, open_other, closed, close_format, close_other, timed_out;
        Counter evicted;
        Counter received, sent, from_wrong_address, stale, wrong_size, unknown_connection;
    };

    /// `marks`: the DSCP values of the datagrams. `incarnation`: a new number after each start, so that old connection ids are not valid.
    ConnectionManager(Values& values, Carrier& carrier, const QosObject& marks, std::uint16_t incarnation);

    [[nodiscard]] std::uint32_t class_id() const noexcept override { return class_id::connection_manager; }
    [[nodiscard]] std::uint16_t last_attribute() const override { return 8; }
    [[nodiscard]] std::span<const std::uint16_t> all(std::uint32_t instance) const override;
    [[nodiscard]] General get(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to) override;
    [[nodiscard]] Response other(std::uint8_t service, std::uint32_t instance, View data, Context& context) override;

    void on_implicit(View datagram, Endpoint from, Instant now);
    void on_deadline(Instant now);
    [[nodiscard]] Instant deadline() const;
    /// For a TCP connection that has ended: its explicit connections are closed; implicit ones are independent of it.
    void on_session_gone(SessionKey session);

    /// The connection of explicit messages with this id on this session; nullptr if there is none.
    [[nodiscard]] Connection* explicit_connection(std::uint32_t ot_id, SessionKey session);
    [[nodiscard]] bool uses(SessionKey session) const;

    [[nodiscard]] std::size_t open() const override;
    [[nodiscard]] std::size_t most() const override { return most_connections; }
    [[nodiscard]] std::vector<std::uint16_t> numbers() const override;
    [[nodiscard]] bool io_open() const override;
    [[nodiscard]] bool owned() const override;
    [[nodiscard]] bool running() const override;
    [[nodiscard]] bool owned_by_other(std::uint32_t output, const Peer& than) const override;
    void close_all(End why, Instant now) override;
    /// Closes the connections for which `goes` returns true, and returns their number.
    template <class Goes>
    std::size_t close_those(Goes&& goes, End why, Instant now) {
        std::size_t closed = 0;
        for (auto& c : places_) {
            if (!c || !goes(std::as_const(*c))) continue;
            close(*c, why, now);
            ++closed;
        }
        return closed;
    }
    /// Whether a connection of this address commands.
    [[nodiscard]] bool owns(std::uint32_t address) const;

    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] const Connection* at(std::size_t place) const noexcept { return places_[place].get(); }

private:
    [[nodiscard]] Response open_one(const OpenRequest& request, Context& context);
    [[nodiscard]] Response open_null(const OpenRequest& request);
    [[nodiscard]] Response open_io(const OpenRequest& request, Context& context);
    [[nodiscard]] Response open_explicit(const OpenRequest& request, Context& context);
    [[nodiscard]] Response forward_open(View data, bool large, Context& context);
    [[nodiscard]] Response forward_close(View data, const Context& context);
    [[nodiscard]] Response connection_data(std::uint8_t service, View data) const;
    [[nodiscard]] std::optional<Extended> wrong_owner(const IoPlan& plan, const Peer& who, Instant now) const;
    /// Makes room for one more of this kind; false if there is none and no connection may be closed for it.
    [[nodiscard]] bool make_room(const Peer& newcomer, bool known, bool messages, Instant now);
    [[nodiscard]] Connection* place_for(const OpenRequest& request, const Context& context);
    [[nodiscard]] Connection* find(const Triad& triad) const;
    void join_group(Connection& connection, Context& context);
    void close(Connection& connection, End why, Instant now);
    void consume(Connection& connection, View data, Instant now);
    void produce(Connection& connection, Instant now);
    void look(Connection& connection, Instant now);

    Values& values_;
    Carrier& carrier_;
    const QosObject& marks_;
    std::uint16_t generation_;
    std::array<std::unique_ptr<Connection>, most_connections> places_;
    std::size_t used_ = 0;  // places from here on have never been used
    Counters counters_;
    Bytes data_, datagram_;  // kept for their capacity
};

}  // namespace axisgate::cip
