// TcpListenLine: accepts clients and carries bytes between them and the line.
// The line does not go down when a client disconnects; only the port itself can fail.
#include "gateway/lines/tcp_listen_line.hpp"

#include <fmt/core.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

#include "gateway/lines/tcp_socket.hpp"

namespace axisgate {

using asio::ip::tcp;

namespace {

constexpr int reads_per_turn = 4;

std::string listen_fault(const std::string& where, const boost::system::error_code& error) {
    std::string s = fmt::format("cannot listen on {}: {}", where, error.message());
    if (error == asio::error::address_in_use) s += ": another program has this port, choose another";
    if (error == asio::error::access_denied) s += ": ports below 1024 need the right to bind them";
    if (error.value() == EADDRNOTAVAIL) s += ": this machine does not have that address";
    return s;
}

}  // namespace

struct TcpListenLine::Client {
    explicit Client(tcp::socket s) : socket(std::move(s)) {}
    tcp::socket socket;
    std::vector<std::uint8_t> unsent;  // valid from index `done`
    std::size_t done = 0;
    bool write_waits = false;

    [[nodiscard]] std::size_t backlog() const noexcept { return unsent.size() - done; }
};

TcpListenLine::TcpListenLine(const LineBase& base, std::string host, std::uint16_t port)
    : RealLine(base), host_(std::move(host)), port_number_(port), accept_pause_(base.io) {}

void TcpListenLine::start() {
    const std::string where =
        host_.find(':') == std::string::npos ? fmt::format("{}:{}", host_, port_number_) : fmt::format("[{}]:{}", host_, port_number_);
    boost::system::error_code error;
    const auto address = host_ == "localhost" ? asio::ip::address(asio::ip::address_v4::loopback()) : asio::ip::make_address(host_, error);
    if (error) return went_down(fmt::format("cannot listen on {}: say an address of this machine, 127.0.0.1 or 0.0.0.0", where));
    acceptor_.emplace(io());
    const tcp::endpoint endpoint(address, port_number_);
    acceptor_->open(endpoint.protocol(), error);
    if (!error) acceptor_->set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_->bind(endpoint, error);
    if (!error) acceptor_->listen(static_cast<int>(most_clients), error);
    if (!error) acceptor_->non_blocking(true, error);
    if (error) return went_down(listen_fault(where, error));
    const auto bound = acceptor_->local_endpoint(error);
    bound_port_ = bound.port();
    address_ = host_.find(':') == std::string::npos ? fmt::format("{}:{}", bound.address().to_string(), bound_port_)
                                                    : fmt::format("[{}]:{}", bound.address().to_string(), bound_port_);
    if (came_up(up_text())) accept();
}

void TcpListenLine::stop() {
    acceptor_.reset();
    accept_pause_.cancel();
    clients_.clear();  // pending handlers own their client and find it closed
    address_.clear();
    bound_port_ = 0;
}

std::string TcpListenLine::up_text() const {
    return fmt::format("listening on {}, {} client{}", address_, clients_.size(), clients_.size() == 1 ? "" : "s");
}

void TcpListenLine::accept() {
    acceptor_->async_accept(guarded([this](const boost::system::error_code& error, tcp::socket socket) {
        if (!error) {
            let_in(std::move(socket));
            return accept();
        }
        if (error == asio::error::operation_aborted) return;
        // No descriptor is left, or the client disconnected before it was accepted: the port itself still works.
        ++status_.errors;
        accept_pause_.expires_after(std::chrono::milliseconds(100));
        accept_pause_.async_wait(guarded([this](const boost::system::error_code& cancelled) {
            if (!cancelled) accept();
        }));
    }));
}

void TcpListenLine::let_in(tcp::socket socket) {
    boost::system::error_code error;
    if (clients_.size() >= most_clients) {
        ++counters_.turned_away;
        socket.close(error);
        return;
    }
    set_up_connection(socket.native_handle());
    socket.native_non_blocking(true, error);
    if (error) return;
    ++counters_.accepted;
    clients_.push_back(std::make_shared<Client>(std::move(socket)));
    begin_reading(clients_.back());
}

void TcpListenLine::begin_reading(const std::shared_ptr<Client>& client) {
    client->socket.async_wait(tcp::socket::wait_read,
                              guarded([this, weak = std::weak_ptr<Client>(client)](const boost::system::error_code& error) {
                                  if (const auto c = weak.lock(); c && !error) on_readable(c);
                              }));
}

void TcpListenLine::on_readable(const std::shared_ptr<Client>& client) {
    for (int i = 0; i < reads_per_turn; ++i) {
        const ssize_t n = ::recv(client->socket.native_handle(), buffer_.data(), buffer_.size(), 0);
        if (n > 0) {
            if (!hand_up(client, static_cast<std::size_t>(n))) return;
            if (!client->socket.is_open()) return;
            if (static_cast<std::size_t>(n) < buffer_.size()) break;
            continue;
        }
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) break;
        return drop(client);  // closed or failed: treated as unplugged
    }
    begin_reading(client);
}

bool TcpListenLine::hand_up(const std::shared_ptr<Client>& client, std::size_t size) {
    const std::span<const std::uint8_t> data = std::span(buffer_).first(size);
    // As on a wire, the other clients receive the bytes too. The list is copied, because sending may drop a client.
    if (clients_.size() > 1) {
        const auto others = clients_;
        for (const auto& other : others) {
            if (other != client) give(other, data);
        }
    }
    const Instant now = clock().now();
    auto rest = data;
    while (!rest.empty()) {
        Frame f = Frame::run(rest.first(std::min(rest.size(), Frame::capacity)));
        f.at = now;
        rest = rest.subspan(f.size);
        count_received(1, f.size);
        if (!deliver(f)) return false;
    }
    return true;
}

void TcpListenLine::flush() {
    const Instant now = clock().now();
    batch_.clear();
    sent_.clear();
    while (const SendQueue::Entry* e = queue_.front()) {
        Frame& f = sent_.emplace_back(e->frame);
        f.at = now;
        const auto data = f.data();
        batch_.insert(batch_.end(), data.begin(), data.end());
        queue_.pop();
    }
    if (!batch_.empty()) {
        const auto all = clients_;
        for (const auto& client : all)
            give(client, batch_);
    }
    for (const Frame& f : sent_) {
        if (!tell_sent(f)) return;
    }
}

void TcpListenLine::give(const std::shared_ptr<Client>& client, std::span<const std::uint8_t> data) {
    if (client->backlog() + data.size() > most_unsent) {
        ++counters_.slow_closed;
        ++status_.errors;
        return drop(client);
    }
    if (client->done > most_unsent / 2) {  // keeps the buffer from growing slowly
        client->unsent.erase(client->unsent.begin(), client->unsent.begin() + static_cast<std::ptrdiff_t>(client->done));
        client->done = 0;
    }
    client->unsent.insert(client->unsent.end(), data.begin(), data.end());
    if (!client->write_waits) write(client);
}

void TcpListenLine::write(const std::shared_ptr<Client>& client) {
    while (client->backlog() > 0) {
        const ssize_t n = ::send(client->socket.native_handle(), client->unsent.data() + client->done, client->backlog(), MSG_NOSIGNAL);
        if (n > 0) {
            client->done += static_cast<std::size_t>(n);
            continue;
        }
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && errno != EAGAIN && errno != EWOULDBLOCK) return drop(client);
        client->write_waits = true;
        client->socket.async_wait(tcp::socket::wait_write,
                                  guarded([this, weak = std::weak_ptr<Client>(client)](const boost::system::error_code& error) {
                                      const auto c = weak.lock();
                                      if (!c || error) return;
                                      c->write_waits = false;
                                      write(c);
                                  }));
        return;
    }
    client->unsent.clear();
    client->done = 0;
}

void TcpListenLine::drop(const std::shared_ptr<Client>& client) {
    boost::system::error_code error;
    client->socket.close(error);
    std::erase(clients_, client);
}

}  // namespace axisgate
