// Connects hub, router and listeners, and makes room when all connections are in use. A client that is refused gets one small answer 503,
// whose transmission is not awaited.
#include "gateway/doors/http/server.hpp"

#include <fmt/core.h>

#include <unordered_map>

#include "gateway/doors/http/connection.hpp"
#include "gateway/doors/http/session.hpp"
#include "gateway/lines/spare_descriptor.hpp"

namespace axisgate::http {
namespace asio = boost::asio;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

namespace {
PlaceHolder holder_of(const asio::ip::address& a) {
    if (a.is_v6()) return place_holder(a.to_v6().to_bytes());
    return place_holder(asio::ip::make_address_v6(asio::ip::v4_mapped, a.to_v4()).to_bytes());
}

std::string text_of(const tcp::endpoint& e) {
    return e.address().is_v6() ? fmt::format("[{}]:{}", e.address().to_string(), e.port())
                               : fmt::format("{}:{}", e.address().to_string(), e.port());
}
}  // namespace

struct Server::Parts : SessionHost, std::enable_shared_from_this<Server::Parts> {
    Settings own_settings;
    Counters own_counters;
    asio::io_context& context;
    Services& services;
    Router own_router;
    tcp::acceptor acceptor;
    asio::steady_timer hub_timer, pause_timer, stop_timer, audit_timer;
    StreamHub own_hub;     // after the timers, because it may request them at once
    bool telling = false;  // a part of the live feed's work is scheduled
    std::unordered_map<const Session*, std::shared_ptr<Session>> sessions;
    std::function<void()> done;
    SpareDescriptor spare;

    Parts(asio::io_context& c, const Ports& ports, Services& all, Settings s, AssetLookup asset)
        : SessionHost(own_settings, own_router, own_counters, own_hub, std::make_shared<Later>(c)),
          own_settings(std::move(s)),
          context(c),
          services(all),
          own_router(Context{ports, own_settings, std::move(asset),
                             [this] {
                                 own_counters.refusals_counted_only = own_router.audit().counted_only();
                                 return own_counters.text();
                             },
                             all.site_changes, all.recipes, all.jobs, all.access, all.alarms, all.rehearsals, all.recipe_rehearsals,
                             std::make_shared<AxisTexts>(), all.stages, std::make_shared<ClientsSeen>(), all.writes,
                             [this](std::function<void()> piece) { later->put(std::move(piece)); }}),
          acceptor(c),
          hub_timer(c),
          pause_timer(c),
          stop_timer(c),
          audit_timer(c),
          own_hub(ports, own_settings, own_counters, [this] { rearm(); }) {
        budget.most = own_settings.max_held_bytes;
        own_hub.recipes_now = [list = all.recipes] { return list->in_progress(); };
        own_hub.alarms_now = [list = all.alarms] { return list->document(); };
        services.listen(own_hub);
    }

    // --- sessions ------------------------------------------------------------------------------------------------------
    void add(std::shared_ptr<Session> session) override {
        const Session* key = session.get();
        sessions.emplace(key, std::move(session));
        own_counters.connections = sessions.size();
    }
    void remove(const Session* session) override {
        const auto it = sessions.find(session);
        if (it == sessions.end()) return;
        const auto kept = std::move(it->second);  // keeps it until the caller of this function has returned
        sessions.erase(it);
        own_counters.connections = sessions.size();
        asio::post(context, [self = weak_from_this()] {  // its descriptor is closed by then
            if (const auto me = self.lock()) me->refill_spare();
        });
        if (stopping && sessions.empty()) stopped();
    }

    // --- accepting -----------------------------------------------------------------------------------------------------
    void accept() {
        acceptor.async_accept([self = weak_from_this()](ErrorCode ec, tcp::socket socket) {
            const auto me = self.lock();
            if (!me || me->stopping) return;
            if (ec == asio::error::operation_aborted) return;
            if (ec) return me->accept_without(ec);  // no descriptor is free, or the client has closed already
            me->take(std::move(socket));
            me->accept();
        });
    }
    /// No descriptor is free: the client gets the reserved one. If that is in use, an inactive connection is closed, and accepting is
    /// repeated.
    void accept_without(const ErrorCode& why) {
        if (!SpareDescriptor::none_left(why.value())) return accept_later();
        const int fd = spare.accept(acceptor.native_handle(), nullptr, nullptr);
        if (fd >= 0) {
            ErrorCode ec;
            tcp::socket socket(context);
            socket.assign(acceptor.local_endpoint(ec).protocol(), fd, ec);
            if (ec)
                ::close(fd);
            else
                take(std::move(socket));
        } else if (errno == EMFILE) {
            (void)make_place(0, true);
        }
        accept_later();
    }
    void accept_later() {
        pause_timer.expires_after(std::chrono::milliseconds(100));
        pause_timer.async_wait([self = weak_from_this()](ErrorCode ec) {
            const auto me = self.lock();
            if (!ec && me && !me->stopping) me->accept();
        });
    }
    /// Reserves a descriptor again as soon as one is free: tried when a session ends, and while the door waits to accept.
    void refill_spare() { (void)spare.refill(); }
    void take(tcp::socket socket) {
        ErrorCode ec;
        const auto peer = socket.remote_endpoint(ec);
        if (ec) return;
        const PlaceHolder holder = holder_of(peer.address());
        if (!make_place(holder)) {
            ++own_counters.connections_refused;
            refuse(std::move(socket));
            return;
        }
        ++own_counters.connections_accepted;
        socket.set_option(tcp::no_delay(true), ec);
        auto connection = std::make_shared<Connection>(Transport(std::move(socket)), shared_from_this(), text_of(peer), holder);
        add(connection);
        connection->start();
    }
    /// `full`: descriptors are used up, not places; true then means that a connection was closed.
    bool make_place(PlaceHolder newcomer, bool full = false) {
        if (!full && sessions.size() < own_settings.max_connections) return true;  // a place is free
        std::vector<Session*> all;
        std::vector<Guest> guests;
        for (const auto& [key, session] : sessions) {
            all.push_back(session.get());
            guests.push_back(session->guest());
        }
        // A client is identified by its first request only: until then it counts as unknown.
        const auto verdict = find_place(guests, newcomer, false, {own_settings.max_connections, own_settings.max_connections / 8}, full);
        if (verdict.closes) {
            ++own_counters.connections_gave_way;
            all[*verdict.closes]->abort();
        }
        return verdict.let_in;
    }
    void refuse(tcp::socket socket) {
        // One small write into an empty socket buffer; its arrival is not verified.
        Response r = problem(503, "busy", fmt::format("{} connections are open already", own_settings.max_connections));
        const auto now_s = std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
        const std::string all = response_head(r, false, now_s) + r.body;
        ErrorCode ignored;
        if (tls) return;  // closed without an answer, because the client could not read plain text
        socket.non_blocking(true, ignored);
        socket.write_some(asio::buffer(all), ignored);
        socket.shutdown(tcp::socket::shutdown_send, ignored);
    }

    // --- the live feed's time --------------------------------------------------------------------------------------------
    void rearm() {
        const Instant due = own_hub.deadline();
        if (due == time_zero) return tell_later();
        if (due == never) {
            hub_timer.cancel();
            return;
        }
        hub_timer.expires_at(
            std::chrono::steady_clock::time_point(std::chrono::duration_cast<std::chrono::steady_clock::duration>(due.time_since_epoch())));
        hub_timer.async_wait([self = weak_from_this()](ErrorCode ec) {
            if (const auto me = self.lock(); !ec && me) me->tell_later();
        });
    }
    /// One part of it, in turn with other work that moves no axis.
    void tell_later() {
        if (std::exchange(telling, true)) return;
        later->put([self = weak_from_this()] {
            const auto me = self.lock();
            if (!me) return;
            me->telling = false;
            if (!me->own_hub.attached()) return;
            me->own_hub.on_deadline(steady_instant());
            me->rearm();
        });
    }

    /// Counted refusals are reported when their period is over, even without further requests.
    void tell_refusals_later() {
        audit_timer.expires_after(std::chrono::seconds(10));
        audit_timer.async_wait([self = weak_from_this()](ErrorCode ec) {
            const auto me = self.lock();
            if (ec || !me || me->stopping) return;
            me->own_router.audit().flush(steady_instant());
            me->tell_refusals_later();
        });
    }

    // --- the end -------------------------------------------------------------------------------------------------------
    void stop(std::function<void()> then) {
        if (stopping) return;
        stopping = true;
        done = std::move(then);
        ErrorCode ignored;
        acceptor.close(ignored);
        pause_timer.cancel();
        audit_timer.cancel();
        std::vector<std::shared_ptr<Session>> all;
        for (const auto& [key, session] : sessions)
            all.push_back(session);
        for (const auto& session : all)
            session->stop();
        if (sessions.empty()) return stopped();
        stop_timer.expires_after(own_settings.stop_limit);
        stop_timer.async_wait([self = weak_from_this()](ErrorCode ec) {
            if (const auto me = self.lock(); !ec && me) me->abort_all();
        });
    }
    void abort_all() {
        std::vector<std::shared_ptr<Session>> all;
        for (const auto& [key, session] : sessions)
            all.push_back(session);
        for (const auto& session : all)
            session->abort();
    }
    void stopped() {
        stop_timer.cancel();
        hub_timer.cancel();
        if (done) asio::post(context, std::exchange(done, nullptr));
    }
};

std::optional<tcp::endpoint> parse_bind(std::string_view bind, std::string& fault) {
    const auto colon = bind.rfind(':');
    const auto port = colon == std::string_view::npos ? std::nullopt : parse_whole(bind.substr(colon + 1), 0, 65535);
    if (!port) {
        fault = fmt::format("{} is not ADDRESS:PORT: write 127.0.0.1:8080", bind);
        return std::nullopt;
    }
    std::string_view host = bind.substr(0, colon);
    if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
    if (host == "localhost") host = "127.0.0.1";
    if (host.empty() || host == "*") host = "0.0.0.0";
    ErrorCode ec;
    const auto address = asio::ip::make_address(std::string(host), ec);
    if (ec) {
        fault = fmt::format("{} is not an IP address: write 127.0.0.1, [::1], or 0.0.0.0 for every address", host);
        return std::nullopt;
    }
    return tcp::endpoint(address, static_cast<std::uint16_t>(*port));
}

Server::Server(asio::io_context& context, const Ports& ports, Services& services, Settings settings, AssetLookup asset)
    : parts_(std::make_shared<Parts>(context, ports, services, std::move(settings), std::move(asset))) {}

Server::~Server() {
    ErrorCode ignored;
    parts_->stopping = true;
    parts_->done = nullptr;
    parts_->acceptor.close(ignored);
    parts_->pause_timer.cancel();
    parts_->stop_timer.cancel();
    parts_->hub_timer.cancel();
    parts_->audit_timer.cancel();
    parts_->services.unlisten(parts_->own_hub);
    parts_->abort_all();
    parts_->own_hub.detach();  // handlers in the io_context may keep the parts longer than the ports exist
}

void Server::use_tls(std::shared_ptr<TlsIdentity> identity) { parts_->tls = std::move(identity); }

bool Server::secure() const noexcept { return parts_->tls != nullptr; }

std::string Server::start() {
    std::string fault;
    const auto endpoint = parse_bind(parts_->own_settings.bind, fault);
    if (!endpoint) return "HTTP: " + fault;
    auto& acceptor = parts_->acceptor;
    ErrorCode ec;
    acceptor.open(endpoint->protocol(), ec);
    if (!ec) acceptor.set_option(tcp::acceptor::reuse_address(true), ec);
    if (!ec) acceptor.bind(*endpoint, ec);
    if (!ec) acceptor.listen(asio::socket_base::max_listen_connections, ec);
    if (ec) {
        ErrorCode ignored;
        acceptor.close(ignored);
        return fmt::format("HTTP: cannot listen on {}: {}; choose another [http] bind, or end what listens there",
                           parts_->own_settings.bind, ec.message());
    }
    parts_->accept();
    parts_->tell_refusals_later();
    return {};
}

std::string Server::address() const {
    ErrorCode ec;
    const auto endpoint = parts_->acceptor.local_endpoint(ec);
    return ec ? std::string() : text_of(endpoint);
}

void Server::stop(std::function<void()> done) { parts_->stop(std::move(done)); }

const Counters& Server::counters() const noexcept { return parts_->own_counters; }

}  // namespace axisgate::http
