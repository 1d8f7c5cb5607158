// TcpLine: resolves a name, connects, and reconnects after a fault.
// Nothing blocks: names are resolved in Asio's own thread, and a numeric address is used without the resolver.
#include "gateway/lines/tcp_line.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/lines/error_text.hpp"
#include "gateway/lines/tcp_socket.hpp"

namespace axisgate {
namespace {

using asio::ip::tcp;
constexpr std::size_t most_addresses = 4;

std::string connect_fault(const boost::system::error_code& error) {
    if (error == asio::error::connection_refused) return "refused: nothing listens there, or its only place is taken";
    if (error == asio::error::host_unreachable || error == asio::error::network_unreachable)
        return "not reachable: check cable, address and netmask";
    return error.message();
}

}  // namespace

TcpLine::TcpLine(const LineBase& base, std::string host, std::uint16_t port, Duration connect_limit)
    : StreamLine(base), host_(std::move(host)), port_number_(port), connect_limit_(connect_limit), resolver_(base.io), limit_(base.io) {}

std::string TcpLine::name() const {
    return host_.find(':') == std::string::npos ? fmt::format("{}:{}", host_, port_number_) : fmt::format("[{}]:{}", host_, port_number_);
}

void TcpLine::start() {
    to_try_.clear();
    boost::system::error_code error;
    if (const auto address = asio::ip::make_address(host_, error); !error) {
        to_try_.emplace_back(address, port_number_);
        return connect_next({});
    }
    limit_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(connect_limit_));
    limit_.async_wait(guarded([this](const boost::system::error_code& cancelled) {
        if (!cancelled)
            went_down(fmt::format("cannot reach {}: the name {} is not resolved in time: use its address, or check the name server", name(),
                                  host_));
    }));
    if (resolving_) return;  // an earlier request is still pending; its answer serves this attempt too
    resolving_ = true;
    resolver_.async_resolve(
        host_, std::to_string(port_number_), tcp::resolver::numeric_service,
        [this, alive = std::weak_ptr<char>(alive_)](const boost::system::error_code& e, const tcp::resolver::results_type& found) {
            if (alive.expired()) return;
            resolving_ = false;
            resolved(e, found);
        });
}

void TcpLine::resolved(const boost::system::error_code& error, const tcp::resolver::results_type& found) {
    const bool waiting =
        (state() == State::opening || state() == State::down) && limit_.expiry() > std::chrono::steady_clock::now() && !connecting_;
    if (!waiting) return;  // closed or given up meanwhile: the next attempt resolves again
    limit_.cancel();
    if (error) return went_down(fmt::format("cannot reach {}: the name {} is not known: {}", name(), host_, error.message()));
    for (const auto& entry : found) {
        if (to_try_.size() < most_addresses) to_try_.push_back(entry.endpoint());
    }
    std::ranges::reverse(to_try_);
    connect_next({});
}

void TcpLine::connect_next(std::string why) {
    connecting_.reset();
    if (to_try_.empty())
        return went_down(fmt::format("cannot reach {}: {}", name(), why.empty() ? std::string("the name has no address") : why));
    const tcp::endpoint to = to_try_.back();
    to_try_.pop_back();
    connecting_.emplace(io());
    boost::system::error_code error;
    connecting_->open(to.protocol(), error);
    if (error) return connect_next(error.message());
    set_up_connection(connecting_->native_handle());  // before connecting, because the size of the send buffer is fixed with the connection
    limit_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(connect_limit_));
    // Each address has its own marker, so that a late time-out cannot affect the next one.
    const auto number = to_try_.size();
    limit_.async_wait(guarded([this, number](const boost::system::error_code& cancelled) {
        if (cancelled || !connecting_ || number != to_try_.size()) return;
        connect_next(fmt::format("no answer within {} ms: is it switched on, and is the address right?", milliseconds_of(connect_limit_)));
    }));
    connecting_->async_connect(to, guarded([this, number](const boost::system::error_code& e) {
                                   if (!connecting_ || number != to_try_.size() || e == asio::error::operation_aborted) return;
                                   limit_.cancel();
                                   if (e) return connect_next(connect_fault(e));
                                   connected();
                               }));
}

void TcpLine::connected() {
    boost::system::error_code error;
    const auto local = connecting_->local_endpoint(error);
    // A socket that connects to a port of this machine in the range of outgoing ports can connect to itself if no program listens there.
    if (!error && local == connecting_->remote_endpoint(error)) return connect_next("nothing listens there (connected to itself)");
    const int fd = connecting_->release(error);
    connecting_.reset();
    if (error) return went_down(fmt::format("cannot use the connection to {}: {}", name(), error.message()));
    std::string why;
    if (!attach(fd, true, why)) return went_down(fmt::format("cannot use the connection to {}: {}", name(), why));
    if (came_up(fmt::format("up, connected to {}", name()))) begin_reading();
}

void TcpLine::stop() {
    limit_.cancel();
    connecting_.reset();
    to_try_.clear();
    StreamLine::stop();
}

void TcpLine::on_gone(int error) {
    went_down(error == 0 ? fmt::format("{} has closed the connection", name())
                         : fmt::format("lost the connection to {}: {}", name(), error_text(error)));
}

}  // namespace axisgate
