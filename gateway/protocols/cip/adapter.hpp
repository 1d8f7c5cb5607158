// Adapter: one EtherNet/IP device with its sessions, objects and connections. It has neither a socket nor a clock.
// Bytes from TCP and from both UDP ports, requested values and time come in; bytes go out through `Output`. Bounds: `most_sessions`
// (then an unregistered or idle session gives way, from the address that has most; `kept_sessions` of them are for addresses that
// command), `most_waiting` messages that wait for values (further ones get 0x02), `most_late` delayed answers to broadcasts.
#pragma once

#include <map>
#include <memory>
#include <unordered_map>
#include <vector>

#include "gateway/protocols/cip/connection_manager.hpp"
#include "gateway/protocols/cip/router.hpp"

namespace axisgate::cip {

struct Output : Carrier, DeviceListener {
    virtual void stream(SessionKey session, View bytes) = 0;
    /// Sends a datagram from the explicit port.
    virtual void datagram(Endpoint to, View bytes) = 0;
    /// Closes the TCP connection once all bytes have been sent. on_disconnected() follows, not from inside this call.
    virtual void hang_up(SessionKey session) = 0;
};

class Adapter {
public:
    static constexpr std::size_t most_sessions = 256, kept_sessions = most_sessions / 8, most_waiting = 256, most_late = 32;
    static constexpr Duration unregistered_time_out = std::chrono::seconds(10);

    struct Counters {
        Counter requests, wrong_packets, sessions_opened, sessions_refused, sessions_evicted, sessions_silent;
    };

    Adapter(Values& values, Output& output, std::uint16_t incarnation);
    Adapter(const Adapter&) = delete;
    Adapter& operator=(const Adapter&) = delete;

    /// `key`: any number but 0 that no other session has. Returns false if there is no room: close the connection.
    [[nodiscard]] bool on_connected(SessionKey key, Endpoint from, Instant now);
    /// Closes an idle session to make room: one that never registered, otherwise one that has been silent for at least a second. Returns
    /// false if all of them are active or command.
    [[nodiscard]] bool give_way(Instant now);
    void on_stream(SessionKey key, View bytes, Instant now);
    void on_disconnected(SessionKey key);
    /// A datagram on the explicit UDP port. `broadcast`: it was sent to all devices, which must not answer at once.
    void on_datagram(View bytes, Endpoint from, bool broadcast, Instant now);
    void on_implicit(View datagram, Endpoint from, Instant now) { manager_.on_implicit(datagram, from, now); }
    /// Delivers the value that was requested under this token, or the reason why there is none. After a write there is no value.
    /// `extended`: a word that follows a bad status; 0: none.
    void answered(Token token, General general, View value, std::uint16_t extended = 0);
    /// When the last bytes arrived on this session; nothing if there is no such session.
    [[nodiscard]] std::optional<Instant> last_received(SessionKey key) const;

    void on_deadline(Instant now);
    [[nodiscard]] Instant deadline() const;

    /// The sessions and connections as other doors show them, and closing them by an operator.
    struct SessionReport {
        SessionKey key = 0;
        Endpoint from;
        Instant since{}, last_received{};
        bool registered = false;
    };
    [[nodiscard]] std::vector<SessionReport> session_reports() const;
    /// False: there is no such session.
    bool close_session(SessionKey key);
    /// Connections are closed when the resource they use changes, and by an operator.
    [[nodiscard]] ConnectionManager& connections() noexcept { return manager_; }
    [[nodiscard]] const ConnectionManager& connections() const noexcept { return manager_; }
    [[nodiscard]] const QosObject& marks() const noexcept { return qos_; }
    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] std::size_t sessions() const noexcept { return sessions_.size(); }

private:
    struct Session {
        Framer framer;
        Endpoint from;
        std::uint32_t handle = 0;  ///< 0: not registered
        Instant since{}, last_received{};
        bool leaving = false;
    };
    /// The destination of an answer.
    struct Route {
        SessionKey session = 0;
        Header header;
        std::uint32_t connection = 0;  ///< O->T id of explicit messages; 0: unconnected
        std::uint16_t count = 0;
        Bytes items;  ///< items besides the two of every answer
        std::uint16_t extra = 0;
        std::size_t most = 0;
    };
    struct Waiting {
        Route route;
        Router::Parts parts;
    };
    struct Late {
        Instant due{};
        Endpoint to;
        Bytes bytes;
    };

    void packet_from(SessionKey key, Session& session, const Header& header, View data, Instant now);
    [[nodiscard]] bool listing(const Header& header, View data, Bytes& answer) const;
    void register_session(SessionKey key, Session& session, const Header& header, View data);
    void rr_data(SessionKey key, Session& session, const Header& header, View data, Instant now);
    void unit_data(SessionKey key, const Header& header, View data, Instant now);
    void message(View bytes, Route route, Context context);
    void answer(const Route& route, const Router::Parts& parts);
    void say(SessionKey key, const Header& header, PacketStatus status, View data = {});
    [[nodiscard]] bool make_room(Endpoint newcomer, Instant now);
    [[nodiscard]] bool find_room(Endpoint newcomer, bool full, Instant now);
    void hang_up(SessionKey key, Session& session);

    Values& values_;
    Output& output_;
    QosObject qos_;
    ConnectionManager manager_;
    IdentityObject identity_;
    AssemblyObject assembly_;
    ParameterObject parameter_;
    OwnObject own_;
    TcpIpObject tcp_ip_;
    EthernetLinkObject ethernet_link_;
    ConnectionConfigurationObject configuration_;
    Router router_;
    std::unordered_map<SessionKey, Session> sessions_;
    std::map<std::uint64_t, Waiting> waiting_;  // keyed by the upper bits of their tokens
    std::vector<Late> late_;
    std::uint64_t exchanges_ = 0;
    std::uint32_t handles_;
    Instant next_look_ = never;  // next check for silent sessions
    Counters counters_;
    Bytes out_;  // the packet being written; kept for its capacity
};

}  // namespace axisgate::cip
