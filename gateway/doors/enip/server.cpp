// Received bytes go to the adapter, and its output is sent at once; one timer has its next deadline. The adapter is never called from
// within one of its own calls.
#include "gateway/doors/enip/server.hpp"

#include <fmt/core.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/basic_waitable_timer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <span>
#include <unordered_map>
#include <utility>

#include "gateway/core/event_rows.hpp"
#include "gateway/doors/enip/counters.hpp"
#include "gateway/doors/enip/host_facts.hpp"
#include "gateway/doors/enip/tcp_session.hpp"
#include "gateway/doors/enip/words.hpp"
#include "gateway/lines/poller.hpp"
#include "gateway/lines/spare_descriptor.hpp"
#include "gateway/site/site_state.hpp"

namespace axisgate::enip {
namespace {
namespace asio = boost::asio;
using tcp = asio::ip::tcp;
using udp = asio::ip::udp;
using Acceptor = asio::basic_socket_acceptor<tcp, asio::io_context::executor_type>;
using UdpSocket = asio::basic_datagram_socket<udp, asio::io_context::executor_type>;

constexpr Duration sweep_period = std::chrono::seconds(1);
constexpr std::uint64_t first_session = std::uint64_t{1} << 32;  ///< numbers of sessions begin after the ids of connections

struct BindAddress {
    std::uint32_t address = 0;
    std::uint16_t port = 0;
    std::string fault;
};
BindAddress parse_bind(const std::string& text) {
    BindAddress b;
    const auto colon = text.rfind(':');
    const std::string host = text.substr(0, colon == std::string::npos ? 0 : colon) == "localhost" ? "127.0.0.1" : text.substr(0, colon);
    boost::system::error_code ec;
    const auto address = asio::ip::make_address_v4(host, ec);
    const char* const end = text.data() + text.size();
    if (colon == std::string::npos || ec || std::from_chars(text.data() + colon + 1, end, b.port).ptr != end) {
        b.fault = fmt::format("[enip] bind \"{}\": write ADDRESS:PORT with an IPv4 address of this host, such as 127.0.0.1:44818", text);
        return b;
    }
    b.address = address.to_uint();
    return b;
}

cip::Endpoint endpoint_of(const sockaddr_in& a) { return {ntohl(a.sin_addr.s_addr), ntohs(a.sin_port)}; }
sockaddr_in sockaddr_of(cip::Endpoint e) {
    sockaddr_in a{};
    a.sin_family = AF_INET;
    a.sin_addr.s_addr = htonl(e.address);
    a.sin_port = htons(e.port);
    return a;
}
}  // namespace

class Server::Impl final : public HotDoor, public cip::Output, public std::enable_shared_from_this<Server::Impl> {
public:
    Impl(asio::io_context& io, DoorPort& port, registers::RegisterImage& image, ServerSettings settings)
        : port_(port),
          settings_(settings),
          values_(port, image, settings.lease_s),
          adapter_(values_, *this, settings.incarnation),
          poller_(io, [this](std::span<const epoll_event> events) { on_ready(events); }),
          acceptor_(io.get_executor()),
          explicit_(io.get_executor()),
          implicit_(io.get_executor()),
          timer_(io) {
        values_.use([this](cip::Token token, cip::General general, cip::View value, std::uint16_t extended) {
            adapter_.answered(token, general, value, extended);
        });
        values_.use_number(port_.attach(*this));
    }
    ~Impl() override { port_.detach(*this); }

    // --- HotDoor
    [[nodiscard]] std::span<const WayIn> ways_in() const override { return ways_of_clients; }
    [[nodiscard]] std::string_view name() const override { return "enip"; }
    [[nodiscard]] std::vector<std::string> addresses() const override {
        return open_ ? std::vector<std::string>{fmt::format("{}:{}", address_text(bound_), facts_.port)} : std::vector<std::string>{};
    }
    void on_result(const Result& result) override {
        values_.on_result(result);
        arm();
    }
    void on_site(const SiteState& site) override;
    [[nodiscard]] std::vector<std::uint64_t> closed_by(const SiteState& wanted) const override;
    [[nodiscard]] std::optional<Instant> last_received(const AuthorityClient& client) const override;
    [[nodiscard]] std::vector<DoorConnection> connections() const override;
    bool close_connection(std::uint64_t number) override;
    bool serve_now() override { return poller_.serve_now(); }
    [[nodiscard]] std::string metrics() const override { return metrics_text(adapter_, values_.counters(), accepts_postponed_); }

    // --- cip::Output
    void written(const cip::Values::OwnPlace& place, const cip::Peer& who, Instant now) override;
    void implicit(cip::Endpoint to, cip::View bytes, std::uint8_t dscp) override {
        if (std::exchange(dscp_, dscp) != dscp) mark(implicit_.native_handle(), dscp);
        send(implicit_, to, bytes);
    }
    void datagram(cip::Endpoint to, cip::View bytes) override {
        const std::uint8_t dscp = adapter_.marks().explicit_mark();
        if (std::exchange(explicit_dscp_, dscp) != dscp) mark(explicit_.native_handle(), dscp);
        send(explicit_, to, bytes);
    }
    void stream(cip::SessionKey key, cip::View bytes) override {
        if (const auto it = sessions_.find(key); it != sessions_.end()) it->second->send(bytes);
    }
    void hang_up(cip::SessionKey key) override {
        if (const auto it = sessions_.find(key); it != sessions_.end()) it->second->hang_up();
    }

    std::string open(const std::string& text);
    void close();
    [[nodiscard]] const cip::Adapter& adapter() const noexcept { return adapter_; }
    [[nodiscard]] const HostFacts& facts() const noexcept { return facts_; }
    [[nodiscard]] Instant deadline() const { return open_ ? std::min(adapter_.deadline(), next_sweep_) : never; }
    void on_deadline();

private:
    static void mark(int fd, std::uint8_t dscp) {
        const int tos = dscp << 2;
        (void)::setsockopt(fd, IPPROTO_IP, IP_TOS, &tos, sizeof tos);
    }
    static void send(UdpSocket& socket, cip::Endpoint to, cip::View bytes) {
        const sockaddr_in a = sockaddr_of(to);
        // If the queue is full, the datagram is dropped: the next one is newer.
        (void)::sendto(socket.native_handle(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                       reinterpret_cast<const sockaddr*>(&a), sizeof a);
    }
    std::string bind_udp(UdpSocket& socket, std::uint16_t& port);
    /// TCP and UDP with the same port number.
    std::string bind_explicit(std::uint16_t port, const std::string& text);
    void on_ready(std::span<const epoll_event> events);
    void accept();
    /// False: no descriptor is free, and a client waits in the listen queue.
    [[nodiscard]] bool admit();
    void listen(UdpSocket& socket, void (Impl::*take)(cip::View, cip::Endpoint, bool));
    void take_explicit(cip::View bytes, cip::Endpoint from, bool broadcast) { adapter_.on_datagram(bytes, from, broadcast, port_.now()); }
    void take_implicit(cip::View bytes, cip::Endpoint from, bool) { adapter_.on_implicit(bytes, from, port_.now()); }
    void arm();
    [[nodiscard]] Layout layout_of(const SiteState& site, std::uint32_t revision) const;
    /// Its bytes are the same in the new layout.
    [[nodiscard]] bool lives_on(const cip::Connection& c, const Layout& there) const;

    DoorPort& port_;
    ServerSettings settings_;
    EventRows writes_{[this](Event e, AxisId axis) { port_.note(std::move(e), axis); }, "writes"};  // for the device's own objects
    AxisValues values_;
    cip::Adapter adapter_;
    Poller poller_;
    Acceptor acceptor_;
    UdpSocket explicit_, implicit_;
    asio::steady_timer timer_;
    Instant armed_ = never, next_sweep_{};
    std::unordered_map<cip::SessionKey, std::unique_ptr<TcpSession>> sessions_;
    std::vector<std::unique_ptr<TcpSession>> ended_;  // until the end of the turn in which they ended
    cip::SessionKey newest_ = 0;
    HostFacts facts_;
    std::uint32_t bound_ = 0;
    std::uint8_t dscp_ = 0, explicit_dscp_ = 0;
    bool open_ = false;
    bool paused_ = false;  // no descriptor is free: repeated with the next sweep
    Counter accepts_postponed_;
    SpareDescriptor spare_;
    std::array<std::uint8_t, 65536> buffer_;
};

std::string Server::Impl::bind_udp(UdpSocket& socket, std::uint16_t& port) {
    boost::system::error_code ec;
    (void)socket.open(udp::v4(), ec);
    if (!ec) (void)socket.bind({asio::ip::address_v4(bound_), port}, ec);
    if (!ec) (void)socket.native_non_blocking(true, ec);
    if (!ec) port = socket.local_endpoint(ec).port();
    if (ec) {
        return fmt::format("[enip] UDP {}:{}: cannot listen: {}; stop the program that has this port, or choose another",
                           address_text(bound_), port, ec.message());
    }
    const int on = 1;
    (void)::setsockopt(socket.native_handle(), IPPROTO_IP, IP_PKTINFO, &on, sizeof on);
    return {};
}

std::string Server::Impl::bind_explicit(std::uint16_t port, const std::string& text) {
    boost::system::error_code ec;
    (void)acceptor_.open(tcp::v4(), ec);
    if (!ec) (void)acceptor_.set_option(Acceptor::reuse_address(true), ec);
    if (!ec) (void)acceptor_.bind({asio::ip::address_v4(bound_), port}, ec);
    if (!ec) (void)acceptor_.listen(256, ec);
    if (!ec) (void)acceptor_.native_non_blocking(true, ec);
    if (!ec) facts_.port = acceptor_.local_endpoint(ec).port();
    if (ec) return fmt::format("[enip] bind \"{}\": cannot listen: {}; choose another address or port", text, ec.message());
    return bind_udp(explicit_, facts_.port);
}

std::string Server::Impl::open(const std::string& text) {
    const BindAddress b = parse_bind(text);
    if (!b.fault.empty()) return b.fault;
    if (!poller_.good()) return "[enip] no file descriptor is left: raise the limit (LimitNOFILE= of the unit, ulimit -n)";
    bound_ = b.address;
    facts_ = host_facts(b.address);
    boost::system::error_code ec;
    std::string fault;
    // A port that the system chooses is free for TCP, but may be in use for UDP.
    for (int tries = b.port == 0 ? 16 : 1; tries > 0; --tries) {
        if (fault = bind_explicit(b.port, text); fault.empty()) break;
        (void)acceptor_.close(ec);
        (void)explicit_.close(ec);
    }
    if (!fault.empty()) return fault;
    facts_.io_port = settings_.io_port;
    if (fault = bind_udp(implicit_, facts_.io_port); !fault.empty()) {
        if (!settings_.another_io_port) return fault;
        implicit_.close(ec);
        facts_.io_port = 0;
        if (fault = bind_udp(implicit_, facts_.io_port); !fault.empty()) return fault;
    }
    const int several_hops = 1, priority = 6;
    (void)::setsockopt(implicit_.native_handle(), IPPROTO_IP, IP_MULTICAST_TTL, &several_hops, sizeof several_hops);
    (void)::setsockopt(implicit_.native_handle(), SOL_SOCKET, SO_PRIORITY, &priority, sizeof priority);
    open_ = true;
    accept();
    listen(explicit_, &Impl::take_explicit);
    listen(implicit_, &Impl::take_implicit);
    arm();
    return {};
}

void Server::Impl::close() {
    open_ = false;
    values_.forget_message_clients();
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    explicit_.close(ignored);
    implicit_.close(ignored);
    timer_.cancel();
    for (auto& [key, session] : std::exchange(sessions_, {})) {
        session->hang_up();
        adapter_.on_disconnected(key);
    }
}

std::optional<Instant> Server::Impl::last_received(const AuthorityClient& client) const {
    std::optional<Instant> newest;
    if (client.door != clients) return newest;
    for (const cip::SessionKey key : values_.message_clients().sessions_of(client)) {
        if (const auto at = adapter_.last_received(key)) newest = std::max(newest.value_or(*at), *at);
    }
    return newest;
}

std::vector<DoorConnection> Server::Impl::connections() const {
    std::vector<DoorConnection> list;
    for (const auto& s : adapter_.session_reports())
        list.push_back({first_session + s.key, "session", text_of(s.from), s.since, s.last_received, {}, values_.commands_by(s.key)});
    const cip::ConnectionManager& manager = adapter_.connections();
    for (std::size_t i = 0; i < cip::ConnectionManager::most_connections; ++i) {
        const cip::Connection* const c = manager.at(i);
        if (!c) continue;
        const bool owns = c->kind == cip::Connection::Kind::exclusive_owner;
        list.push_back({c->ot_id, cip::name_of(c->kind), text_of(c->peer.from), c->since, c->last_received,
                        owns ? values_.layout().axes_of(c->plan.consumed) : std::vector<AxisId>{}, owns && c->running});
    }
    return list;
}

bool Server::Impl::close_connection(std::uint64_t number) {
    bool closed = number >= first_session && adapter_.close_session(number - first_session);
    const auto is_it = [&](const cip::Connection& c) { return c.ot_id == number; };
    closed = adapter_.connections().close_those(is_it, cip::End::by_operator, port_.now()) > 0 || closed;
    arm();
    return closed;
}

Layout Server::Impl::layout_of(const SiteState& site, std::uint32_t revision) const {
    std::vector<LayoutAxis> axes;
    for (std::size_t i = 0; i < site.axis_ids.size(); ++i) {
        const AxisId id = site.axis_ids[i];
        axes.push_back({static_cast<std::uint16_t>(site.site.axes[i].number), id, site.site.axes[i].name, port_.catalogue(id)});
    }
    return Layout(std::move(axes), revision, facts_, windows_of(site), objects_of(site, values_.languages()));
}

bool Server::Impl::lives_on(const cip::Connection& c, const Layout& there) const {
    return !c.is_io() || (values_.layout().same_bytes(c.plan.consumed, there) && values_.layout().same_bytes(c.plan.produced, there));
}

void Server::Impl::on_site(const SiteState& site) {
    Layout layout = layout_of(site, port_.image().mapping_revision);
    adapter_.connections().close_those([&](const cip::Connection& c) { return !lives_on(c, layout); }, cip::End::by_gateway, port_.now());
    values_.use(std::move(layout));
    arm();
}

std::vector<std::uint64_t> Server::Impl::closed_by(const SiteState& wanted) const {
    std::vector<std::uint64_t> list;
    const Layout there = layout_of(wanted, 0);
    const cip::ConnectionManager& manager = adapter_.connections();
    for (std::size_t i = 0; i < cip::ConnectionManager::most_connections; ++i) {
        const cip::Connection* const c = manager.at(i);
        if (c && !lives_on(*c, there)) list.push_back(c->ot_id);
    }
    return list;
}

void Server::Impl::written(const cip::Values::OwnPlace& place, const cip::Peer& who, Instant now) {
    Event e;
    e.kind = "ethernet_ip";
    e.door = std::string(name_of(clients));
    e.who = text_of(who.from);
    e.text = place.attribute == 0
                 ? fmt::format("class {:02X}h instance {} was written as a whole, or reset", place.class_id, place.instance)
                 : fmt::format("class {:02X}h instance {} attribute {} was written", place.class_id, place.instance, place.attribute);
    writes_.add(address_text(who.from.address), no_axis, std::move(e), {}, now);
}

void Server::Impl::accept() {
    acceptor_.async_wait(Acceptor::wait_read, [weak = weak_from_this()](boost::system::error_code ec) {
        const auto self = weak.lock();
        if (!self || ec || !self->open_) return;
        // The socket stays readable while a client waits: immediate repetition would only occupy the processor of the hot thread.
        self->paused_ = !self->admit();
        self->arm();
        if (!self->paused_) self->accept();
    });
}

bool Server::Impl::admit() {
    sockaddr_in peer{};
    socklen_t length = sizeof peer;
    int fd = ::accept4(acceptor_.native_handle(), reinterpret_cast<sockaddr*>(&peer), &length, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd < 0) {
        if (!SpareDescriptor::none_left(errno)) return true;
        // The system may report this without a waiting client.
        pollfd queue{acceptor_.native_handle(), POLLIN, 0};
        if (::poll(&queue, 1, 0) <= 0) return true;
        // This client uses the reserved descriptor. If that is in use, an inactive connection is closed, and accepting is repeated when it
        // has ended, or with the next sweep.
        fd = spare_.accept(acceptor_.native_handle(), reinterpret_cast<sockaddr*>(&peer), &length);
        if (fd < 0) {
            (void)adapter_.give_way(port_.now());
            accepts_postponed_.add();
            return false;
        }
    }
    const int on = 1;
    (void)::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    (void)::setsockopt(fd, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
    mark(fd, adapter_.marks().explicit_mark());
    const cip::SessionKey key = ++newest_;
    const bool watched = poller_.add(fd, key, TcpSession::watched);
    if (!watched || !adapter_.on_connected(key, endpoint_of(peer), port_.now())) {
        ::close(fd);
        return true;
    }
    sessions_.emplace(key, std::make_unique<TcpSession>(
                               fd, poller_, key, most_unsent, [this, key](cip::View bytes) { adapter_.on_stream(key, bytes, port_.now()); },
                               [this, key] {
                                   if (auto it = sessions_.find(key); it != sessions_.end()) {
                                       ended_.push_back(std::move(it->second));
                                       sessions_.erase(it);
                                   }
                                   adapter_.on_disconnected(key);
                               }));
    return true;
}

/// Sessions make no calls by themselves. They live as long as this object; one that ends is kept until the end of the turn.
void Server::Impl::on_ready(std::span<const epoll_event> events) {
    // With few sessions each answer is sent at once, so that its receiver can continue in parallel. With many sessions the first answer
    // would wake a receiver that is then woken again for each further one, so they are sent together.
    const bool together = events.size() >= Server::answers_together;
    std::array<TcpSession*, Poller::events_per_turn> answered;
    std::size_t count = 0;
    for (const epoll_event& e : events) {
        const auto it = sessions_.find(std::uint64_t{e.data.u64});
        if (it == sessions_.end()) continue;
        TcpSession& session = *it->second;  // it is kept even if this call ends it
        session.on_ready(e.events);
        if (together)
            answered[count++] = &session;
        else
            session.flush();
    }
    for (TcpSession* session : std::span(answered).first(count))
        session->flush();
    const bool descriptor_is_free = !ended_.empty();
    ended_.clear();
    if (descriptor_is_free && std::exchange(paused_, false)) accept();
    arm();
}

void Server::Impl::listen(UdpSocket& socket, void (Impl::*take)(cip::View, cip::Endpoint, bool)) {
    socket.async_wait(UdpSocket::wait_read, [weak = weak_from_this(), &socket, take](boost::system::error_code ec) {
        const auto self = weak.lock();
        if (!self || ec || !self->open_) return;
        for (int i = 0; i < datagrams_per_turn; ++i) {
            sockaddr_in from{};
            alignas(cmsghdr) std::array<char, 128> control;
            iovec place{self->buffer_.data(), self->buffer_.size()};
            msghdr m{};
            m.msg_name = &from;
            m.msg_namelen = sizeof from;
            m.msg_iov = &place;
            m.msg_iovlen = 1;
            m.msg_control = control.data();
            m.msg_controllen = control.size();
            const auto n = ::recvmsg(socket.native_handle(), &m, MSG_DONTWAIT);
            if (n < 0) break;
            bool everybody = false;
            for (cmsghdr* c = CMSG_FIRSTHDR(&m); c; c = CMSG_NXTHDR(&m, c)) {
                if (c->cmsg_level != IPPROTO_IP || c->cmsg_type != IP_PKTINFO) continue;
                in_pktinfo info{};
                std::memcpy(&info, CMSG_DATA(c), sizeof info);
                everybody = info.ipi_addr.s_addr != info.ipi_spec_dst.s_addr;
            }
            if ((m.msg_flags & MSG_TRUNC) == 0)
                ((*self).*take)({self->buffer_.data(), static_cast<std::size_t>(n)}, endpoint_of(from), everybody);
        }
        self->arm();
        self->listen(socket, take);
    });
}

void Server::Impl::arm() {
    if (!open_ || settings_.owner_keeps_time) return;
    const Instant due = deadline();
    if (armed_ <= due) return;  // the timer may expire too early and is then set again, which costs less than a system call per request
    armed_ = due;
    timer_.expires_at(
        std::chrono::steady_clock::time_point(std::chrono::duration_cast<std::chrono::steady_clock::duration>(due.time_since_epoch())));
    timer_.async_wait([weak = weak_from_this()](boost::system::error_code ec) {
        const auto self = weak.lock();
        if (self && !ec) self->on_deadline();
    });
}

void Server::Impl::on_deadline() {
    armed_ = never;
    const Instant now = port_.now();
    adapter_.on_deadline(now);
    if (next_sweep_ <= now) {
        values_.sweep(now);
        writes_.flush(now);
        next_sweep_ = now + sweep_period;
        if (!paused_) (void)spare_.refill();  // waiting clients come first
        if (std::exchange(paused_, false)) accept();
    }
    arm();
}

Server::Server(asio::io_context& io, DoorPort& port, registers::RegisterImage& image, ServerSettings settings)
    : impl_(std::make_shared<Impl>(io, port, image, settings)) {}
Server::~Server() { impl_->close(); }
std::string Server::open(const std::string& bind) {
    std::string fault = impl_->open(bind);
    if (!fault.empty()) impl_->close();
    return fault;
}
std::vector<std::string> Server::addresses() const { return impl_->addresses(); }
const HostFacts& Server::facts() const noexcept { return impl_->facts(); }
void Server::close() { impl_->close(); }
Instant Server::deadline() const { return impl_->deadline(); }
void Server::on_deadline() { impl_->on_deadline(); }
const cip::Adapter& Server::adapter() const noexcept { return impl_->adapter(); }

}  // namespace axisgate::enip
