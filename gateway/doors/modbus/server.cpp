// Connections are found by number; the deadlines of all of them are in one array, so that a sweep reads little memory. A connection is
// never destroyed within one of its own calls.
#include "gateway/doors/modbus/server.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "gateway/core/places.hpp"
#include "gateway/doors/modbus/connection.hpp"
#include "gateway/doors/modbus/endpoint.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "gateway/lines/spare_descriptor.hpp"

namespace axisgate::modbus {
namespace {
namespace asio = boost::asio;
using tcp = asio::ip::tcp;

constexpr auto sweep_period = std::chrono::milliseconds(250);
constexpr int accepts_per_turn = 64;
constexpr int backlog = 1024;
constexpr int socket_buffer = 64 * 1024;  // bytes in each direction, so that a client that does not read occupies a bounded amount of
                                          // kernel memory

void set_option(int fd, int level, int name, int value) { (void)::setsockopt(fd, level, name, &value, sizeof value); }

constexpr std::size_t most_commanders = 64;  // addresses that are remembered because they have commanded
constexpr PlaceHolder nobody = 0;

PlaceHolder holder_of(const asio::ip::address& a) {
    if (a.is_v6()) return place_holder(a.to_v6().to_bytes());
    return place_holder(asio::ip::make_address_v6(asio::ip::v4_mapped, a.to_v4()).to_bytes());
}

bool someone_waits(int listening) {
    pollfd p{listening, POLLIN, 0};
    return ::poll(&p, 1, 0) > 0;
}

/// No delay, because an answer is a complete segment. Keep-alive detects a peer without power within about a minute.
void prepare(int fd) {
    set_option(fd, IPPROTO_TCP, TCP_NODELAY, 1);
    set_option(fd, SOL_SOCKET, SO_KEEPALIVE, 1);
    set_option(fd, IPPROTO_TCP, TCP_KEEPIDLE, 30);
    set_option(fd, IPPROTO_TCP, TCP_KEEPINTVL, 10);
    set_option(fd, IPPROTO_TCP, TCP_KEEPCNT, 3);
}
}  // namespace

class Server::Impl final : public ConnectionHost, public HotDoor, public std::enable_shared_from_this<Server::Impl> {
public:
    Impl(asio::io_context& io, DoorPort& port, registers::RegisterImage& image, ServerSettings settings)
        : io_(io),
          port_(port),
          settings_(std::move(settings)),
          responder_(port, image, settings_.responder),
          poller_(io, [this](std::span<const epoll_event> events) { on_ready(events); }),
          timer_(io) {
        partial_timeout = settings_.partial_timeout;
        stall_timeout = settings_.stall_timeout;
        places_.resize(settings_.max_connections + kept_places());
        times_.resize(places_.size());
        for (std::size_t i = places_.size(); i-- > 0;)
            free_.push_back(i);
        responder_.writer().use_number(port_.attach(*this));
    }
    ~Impl() override { port_.detach(*this); }

    // --- HotDoor
    [[nodiscard]] std::span<const WayIn> ways_in() const override { return tcp_ways; }
    [[nodiscard]] std::string_view name() const override { return "modbus"; }
    void on_result(const Result& result) override { responder_.writer().on_result(result); }
    [[nodiscard]] std::optional<Instant> last_received(const AuthorityClient& client) const override {
        return client.door == clients ? received(client.name) : std::nullopt;
    }
    [[nodiscard]] std::vector<DoorConnection> connections() const override {
        std::vector<DoorConnection> list;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const Connection* const c = places_[i].connection.get();
            if (c) list.push_back({c->token(), "modbus_tcp", c->peer(), places_[i].since, times_[i].last_request, {}, c->has_commanded()});
        }
        return list;
    }
    bool close_connection(std::uint64_t number) override {
        Connection* const c = place_of(number) < places_.size() ? find(number) : nullptr;
        if (!c) return false;
        c->close(&counters().closed_by_operator);
        bury();
        return true;
    }
    bool serve_now() override { return poller_.serve_now(); }
    [[nodiscard]] std::string metrics() const override { return metrics_text(std::as_const(responder_).counters()); }

    std::string open(std::span<const std::string> binds) {
        if (!poller_.good()) return "[modbus] no file descriptor is left: raise the limit (LimitNOFILE= of the unit, ulimit -n)";
        for (const auto& text : binds) {
            std::string fault = listen(text);
            if (fault.empty()) continue;
            close();
            return fault;
        }
        for (const auto& l : listeners_)
            accept_on(l);
        return {};
    }

    [[nodiscard]] std::vector<std::string> addresses() const override {
        std::vector<std::string> texts;
        for (const auto& l : listeners_) {
            boost::system::error_code ignored;
            texts.push_back(to_text(l->acceptor.local_endpoint(ignored)));
        }
        return texts;
    }

    void close() {
        boost::system::error_code ignored;
        for (const auto& l : listeners_)
            l->acceptor.close(ignored);
        listeners_.clear();
        timer_.cancel();
        closing_ = true;
        for (const auto& place : places_) {
            if (place.connection) place.connection->close();
        }
        closing_ = false;
        bury();
    }

    void sweep() {
        const Instant at = port_.now();
        responder_.writer().sweep(at);
        for (std::size_t i = 0; i < places_.size(); ++i) {
            Connection* const c = places_[i].connection.get();
            if (!c) continue;
            if (c->has_commanded() && (commanders_.empty() || commanders_.back() != places_[i].holder)) note_commander(places_[i].holder);
            if (times_[i].deadline <= at) {
                c->close(c->has_unsent() ? &counters().closed_not_reading : &counters().closed_partial);
            } else if (at - times_[i].last_request >= settings_.idle_timeout && !c->commands_now(port_.image())) {
                c->close(&counters().closed_idle);
            }
        }
        bury();
        if (std::ranges::none_of(listeners_, [](const auto& l) { return l->paused; })) (void)spare_.refill();  // waiting clients come first
        for (const auto& l : listeners_) {
            if (std::exchange(l->paused, false)) accept_on(l);
        }
    }

    [[nodiscard]] std::vector<ConnectionReport> reports() const {
        std::vector<ConnectionReport> list;
        for (const auto& place : places_) {
            if (const Connection* c = place.connection.get())
                list.push_back({c->peer(), c->requests(), c->writes(), c->exceptions(), place.since});
        }
        return list;
    }
    [[nodiscard]] Counters& counters() noexcept { return responder_.counters(); }
    [[nodiscard]] Responder& responder() noexcept { return responder_; }

    // --- ConnectionHost
    Instant now() const override { return port_.now(); }
    ConnectionTimes& times(ConnectionToken token) override { return times_[place_of(token)]; }
    void ready(ConnectionToken token) override {
        // All results of a turn arrive before the posted function runs, so each connection sends its answers together.
        if (ready_.empty()) {
            asio::post(io_, [weak = weak_from_this()] {
                if (const auto self = weak.lock()) self->resume_ready();
            });
        }
        ready_.push_back(token);
    }
    void closed(ConnectionToken token) override {
        const std::size_t i = place_of(token);
        if (places_[i].connection->has_commanded()) note_commander(places_[i].holder);
        const std::string host = std::move(places_[i].host);
        buried_.push_back(std::move(places_[i].connection));  // it is still in one of its calls: bury() destroys it
        times_[i] = {};
        free_.push_back(i);
        counters().connections_open.remove();
        if (!closing_ && !received(host)) port_.client_lost({clients, host}, loss_closed);
    }

private:
    struct Listener {
        explicit Listener(asio::io_context& io) : acceptor(io.get_executor()) {}
        asio::basic_socket_acceptor<tcp, asio::io_context::executor_type> acceptor;
        bool paused = false;  // no descriptor is free: repeated with the next sweep
    };
    struct Place {
        std::unique_ptr<Connection> connection;
        std::uint32_t users = 0;
        std::string host;  // the client's permanent name: its address without the port
        Instant since{};
        PlaceHolder holder = 0;
    };
    [[nodiscard]] static std::size_t place_of(ConnectionToken token) noexcept { return static_cast<std::uint32_t>(token); }
    /// nullptr: that connection is closed, even if another one has its place now.
    [[nodiscard]] Connection* find(ConnectionToken token) const noexcept {
        Connection* const c = places_[place_of(token)].connection.get();
        return c && c->token() == token ? c : nullptr;
    }

    void on_ready(std::span<const epoll_event> events) {
        for (const auto& e : events) {
            if (Connection* const c = find(e.data.u64)) c->on_ready(e.events);
        }
        bury();
    }

    void resume_ready() {
        resuming_.swap(ready_);
        for (const ConnectionToken token : resuming_) {
            if (Connection* const c = find(token)) c->resume();
        }
        resuming_.clear();
        bury();
    }

    void bury() { buried_.clear(); }

    std::string listen(const std::string& text) {
        const auto bind = parse_endpoint(text);
        if (!bind.fault.empty()) return "[modbus] bind " + bind.fault;
        auto l = std::make_shared<Listener>(io_);
        boost::system::error_code ec;
        (void)l->acceptor.open(bind.endpoint.protocol(), ec);
        if (!ec) (void)l->acceptor.set_option(tcp::acceptor::reuse_address(true), ec);
        if (!ec && bind.endpoint.address().is_v6()) (void)l->acceptor.set_option(asio::ip::v6_only(true), ec);
        if (!ec) (void)l->acceptor.set_option(tcp::acceptor::send_buffer_size(socket_buffer), ec);  // accepted sockets inherit both
        if (!ec) (void)l->acceptor.set_option(tcp::acceptor::receive_buffer_size(socket_buffer), ec);
        if (!ec) (void)l->acceptor.bind(bind.endpoint, ec);
        if (!ec) (void)l->acceptor.listen(backlog, ec);
        if (!ec) (void)l->acceptor.native_non_blocking(true, ec);
        if (ec) {
            std::string fault = "[modbus] bind \"" + text + "\": cannot listen: " + ec.message();
            if (ec == asio::error::access_denied) {
                fault += "; ports below 1024 need the capability CAP_NET_BIND_SERVICE: grant it or choose a port above";
            } else if (ec == asio::error::address_in_use) {
                fault += "; stop the program that has this port, or choose another";
            } else {
                fault += "; choose an address that this host has";
            }
            return fault;
        }
        listeners_.push_back(std::move(l));
        return {};
    }

    void accept_on(const std::shared_ptr<Listener>& l) {
        l->acceptor.async_wait(tcp::acceptor::wait_read, [weak = weak_from_this(), l](boost::system::error_code ec) {
            const auto self = weak.lock();
            if (!self || ec || !l->acceptor.is_open()) return;
            self->accept_some(*l);
            self->bury();
            if (!l->paused) self->accept_on(l);
        });
    }

    void accept_some(Listener& l) {
        for (int i = 0; i < accepts_per_turn; ++i) {
            sockaddr_storage peer{};
            socklen_t length = sizeof peer;
            int fd = ::accept4(l.acceptor.native_handle(), reinterpret_cast<sockaddr*>(&peer), &length, SOCK_NONBLOCK | SOCK_CLOEXEC);
            if (fd >= 0) {
                admit(fd, peer, length);
            } else if (SpareDescriptor::none_left(errno)) {
                // The system may report this without a waiting client; then no connection is closed. If one waits, it stays in the listen
                // queue: an immediate repetition would only occupy the processor.
                if (!someone_waits(l.acceptor.native_handle())) return;
                if (make_place(nobody, true)) continue;
                fd = spare_.accept(l.acceptor.native_handle(), reinterpret_cast<sockaddr*>(&peer), &length);
                if (fd >= 0) admit(fd, peer, length);
                l.paused = true;
                watch_time();
                return;
            } else if (errno != EINTR && errno != ECONNABORTED && errno != EPROTO) {
                return;
            }
        }
    }

    void admit(int fd, const sockaddr_storage& peer, socklen_t length) {
        tcp::endpoint from;
        from.resize(std::min<std::size_t>(length, from.capacity()));
        std::memcpy(from.data(), &peer, from.size());
        if (!responder_.access().admits(to_text(from))) {
            counters().connections_not_allowed.add();
            ::close(fd);
            return;
        }
        const PlaceHolder holder = holder_of(from.address());
        if (!make_place(holder, false) || free_.empty()) {
            counters().connections_refused.add();
            ::close(fd);
            return;
        }
        const std::size_t i = free_.back();
        const ConnectionToken token = (std::uint64_t{++places_[i].users} << 32) | i;
        prepare(fd);
        if (!poller_.add(fd, token, EPOLLIN)) {
            counters().connections_refused.add();
            ::close(fd);
            return;
        }
        free_.pop_back();
        times_[i] = {port_.now(), never};
        places_[i].since = port_.now();
        Origin origin;
        origin.door = clients;
        origin.who = std::make_shared<const std::string>(to_text(from));
        places_[i].host = AuthorityClient::of(origin).name;
        places_[i].holder = holder;
        places_[i].connection = std::make_unique<Connection>(fd, poller_, *this, responder_, token, to_text(from));
        counters().connections_accepted.add();
        counters().connections_open.add();
        watch_time();
    }

    /// The newest request of any connection of this host.
    [[nodiscard]] std::optional<Instant> received(std::string_view host) const {
        std::optional<Instant> newest;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            if (places_[i].connection && places_[i].host == host && (!newest || times_[i].last_request > *newest))
                newest = times_[i].last_request;
        }
        return newest;
    }

    /// Closes a connection to make room for one of `newcomer`; false: there is no room. `full`: descriptors are used up, not places.
    bool make_place(PlaceHolder newcomer, bool full) {
        if (!full && open_count() < settings_.max_connections) return true;  // a place is free
        const Instant at = port_.now();
        std::vector<std::size_t> indices;
        std::vector<Guest> guests;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const Connection* const c = places_[i].connection.get();
            if (!c) continue;
            indices.push_back(i);
            guests.push_back({places_[i].holder, standing_of(*c, at - times_[i].last_request), times_[i].last_request});
        }
        const auto verdict = find_place(guests, newcomer, has_commanded(newcomer), {settings_.max_connections, kept_places()}, full);
        if (verdict.closes) places_[indices[*verdict.closes]].connection->close(&counters().connections_evicted);
        return verdict.let_in;
    }
    [[nodiscard]] Standing standing_of(const Connection& c, Duration silent) const {
        if (c.commands_now(port_.image())) return Standing::stop_path;
        const bool works = silent < settings_.idle_before_eviction && c.has_asked() && !c.holds_half();
        if (c.has_commanded()) return works ? Standing::knowns_work : Standing::known;
        return works ? Standing::strangers_work : Standing::stranger;
    }
    [[nodiscard]] std::size_t open_count() const noexcept { return places_.size() - free_.size(); }
    [[nodiscard]] std::size_t kept_places() const noexcept { return settings_.max_connections / 8; }

    // A Modbus client is identified by its address, since it connects again from another port: a client that has commanded gets a place
    // again.
    void note_commander(PlaceHolder holder) {
        std::erase(commanders_, holder);
        commanders_.push_back(holder);
        if (commanders_.size() > most_commanders) commanders_.erase(commanders_.begin());
    }
    [[nodiscard]] bool has_commanded(PlaceHolder holder) const noexcept {
        return std::ranges::find(commanders_, holder) != commanders_.end();
    }

    void watch_time() {
        if (std::exchange(timing_, true)) return;
        timer_.expires_after(sweep_period);
        timer_.async_wait([weak = weak_from_this()](boost::system::error_code ec) {
            const auto self = weak.lock();
            if (!self) return;
            self->timing_ = false;
            if (!ec) self->sweep();
            // After close() the wait ends early, and clients of a new open() may already wait.
            const bool paused = std::any_of(self->listeners_.begin(), self->listeners_.end(), [](const auto& l) { return l->paused; });
            if (paused || self->free_.size() < self->places_.size() || self->responder_.writer().waits()) self->watch_time();
        });
    }

    asio::io_context& io_;
    DoorPort& port_;
    ServerSettings settings_;
    Responder responder_;
    Poller poller_;
    asio::steady_timer timer_;
    bool timing_ = false;
    bool closing_ = false;  // the gateway ends, or its addresses change: no client is lost
    std::vector<std::shared_ptr<Listener>> listeners_;
    std::vector<Place> places_;
    std::vector<ConnectionTimes> times_;
    std::vector<std::size_t> free_;
    std::vector<std::unique_ptr<Connection>> buried_;
    std::vector<ConnectionToken> ready_, resuming_;
    std::vector<PlaceHolder> commanders_;  // the newest is the last
    SpareDescriptor spare_;
};

Server::Server(asio::io_context& io, DoorPort& port, registers::RegisterImage& image, ServerSettings settings)
    : impl_(std::make_shared<Impl>(io, port, image, std::move(settings))) {}
Server::~Server() { impl_->close(); }
std::string Server::open(std::span<const std::string> binds) { return impl_->open(binds); }
std::vector<std::string> Server::addresses() const { return impl_->addresses(); }
void Server::close() { impl_->close(); }
std::vector<Server::ConnectionReport> Server::connections() const { return impl_->reports(); }
Responder& Server::responder() noexcept { return impl_->responder(); }
void Server::sweep() { impl_->sweep(); }
const Counters& Server::counters() const noexcept { return impl_->counters(); }
const registers::RegisterWriter::Counters& Server::write_counters() const noexcept { return impl_->responder().writer().counters(); }

}  // namespace axisgate::modbus
