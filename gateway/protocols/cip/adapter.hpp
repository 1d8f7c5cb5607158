// Adapter: one EtherNet/IP device: its sessions, its objects, its connections.
// In: what arrives on TCP and on the two UDP ports, values that were asked for, time. Out: bytes by `Output`; the next deadline.
// Never has a socket or a clock. Bounds: `most_sessions` (then one that is not registered, or else does nothing, gives way, from the
// address that has most; `kept_sessions` of them for addresses that command),
// `most_waiting` messages that wait for values (then 0x02), `most_late` answers to broadcasts that wait for their delay (then none).
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
    /// From the explicit port.
    virtual void datagram(Endpoint to, View bytes) = 0;
    /// Closes the TCP connection once what was sent is out. on_disconnected() follows, not from inside this call.
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

    /// `key`: any number but 0 that no other session has. False: there is no room; close it.
    [[nodiscard]] bool on_connected(SessionKey key, Endpoint from, Instant now);
    /// Hangs up a session that does nothing, for somebody else's sake: one that never registered, else one that
    /// has been silent, and for a second at least. False: all of them work, or command.
    [[nodiscard]] bool give_way(Instant now);
    void on_stream(SessionKey key, View bytes, Instant now);
    void on_disconnected(SessionKey key);
    /// On the explicit UDP port. `broadcast`: it was sent to everybody, whose answers shall not come at once.
    void on_datagram(View bytes, Endpoint from, bool broadcast, Instant now);
    void on_implicit(View datagram, Endpoint from, Instant now) { manager_.on_implicit(datagram, from, now); }
    /// The value that was asked for under this token, or why there is none. Of a written one: no value.
    /// `extended`: a word that follows a bad status; 0: none.
    void answered(Token token, General general, View value, std::uint16_t extended = 0);
    /// When something came on this session; nothing: there is no such session.
    [[nodiscard]] std::optional<Instant> last_received(SessionKey key) const;

    void on_deadline(Instant now);
    [[nodiscard]] Instant deadline() const;

    /// Sessions and connections as other doors show them, and their ends by a person.
    struct SessionReport {
        SessionKey key = 0;
        Endpoint from;
        Instant since{}, last_received{};
        bool registered = false;
    };
    [[nodiscard]] std::vector<SessionReport> session_reports() const;
    /// False: there is no such session.
    bool close_session(SessionKey key);
    /// Connections are closed by what they were opened for, and by hand.
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
    /// Where an answer goes.
    struct Route {
        SessionKey session = 0;
        Header header;
        std::uint32_t connection = 0;  ///< O->T id of explicit messages; 0: unconnected
        std::uint16_t count = 0;
        Bytes items;  ///< beside the two that every answer has
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
    std::map<std::uint64_t, Waiting> waiting_;  // by the upper bits of their tokens
    std::vector<Late> late_;
    std::uint64_t exchanges_ = 0;
    std::uint32_t handles_;
    Instant next_look_ = never;  // at sessions that are silent
    Counters counters_;
    Bytes out_;  // the packet that is being written; kept for its room
};

}  // namespace axisgate::cip
