// UdpLine: one datagram is one frame.
// Nothing blocks: a datagram that the kernel cannot accept now waits in the queue, one that it refuses is counted as an error.
#include "gateway/lines/udp_line.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

namespace axisgate {

UdpLine::UdpLine(const LineBase& base, std::string host, std::uint16_t port, Role role)
    : RealLine(base), host_(std::move(host)), port_number_(port), role_(role), resolver_(base.io) {
    one_wire_ = false;
}

std::string UdpLine::name() const {
    return host_.find(':') == std::string::npos ? fmt::format("{}:{}", host_, port_number_) : fmt::format("[{}]:{}", host_, port_number_);
}

std::uint16_t UdpLine::port() const {
    boost::system::error_code error;
    return socket_ && state() == State::up ? socket_->local_endpoint(error).port() : std::uint16_t{0};
}

void UdpLine::start() {
    boost::system::error_code error;
    if (const auto address = asio::ip::make_address(host_, error); !error) return use({address, port_number_});
    awaits_name_ = true;
    if (resolving_) return;  // the system's resolver cannot be cancelled; its answer serves this attempt too
    resolving_ = true;
    resolver_.async_resolve(
        host_, std::to_string(port_number_), udp::resolver::numeric_service,
        [this, alive = std::weak_ptr<char>(alive_)](const boost::system::error_code& e, const udp::resolver::results_type& found) {
            if (alive.expired()) return;
            resolving_ = false;
            resolved(e, found);
        });
}

void UdpLine::resolved(const boost::system::error_code& error, const udp::resolver::results_type& found) {
    if (!awaits_name_) return;  // closed meanwhile: the next attempt resolves again
    awaits_name_ = false;
    if (error) return went_down(fmt::format("cannot reach {}: the name {} is not known: {}", name(), host_, error.message()));
    if (found.empty()) return went_down(fmt::format("cannot reach {}: the name {} has no address", name(), host_));
    use(std::next(found.begin(), static_cast<std::ptrdiff_t>(address_turn_ % found.size()))->endpoint());
}

void UdpLine::use(const udp::endpoint& where) {
    socket_.emplace(io());
    boost::system::error_code error;
    socket_->open(where.protocol(), error);
    if (!error && role_ == Role::listens) socket_->bind(where, error);
    if (!error && role_ == Role::connects) socket_->connect(where, error);
    if (!error) socket_->non_blocking(true, error);  // not native_non_blocking, with which Asio itself would wait
    if (error && role_ == Role::listens) return went_down(fmt::format("cannot listen on {}: {}", name(), error.message()));
    if (error) return lost(error);
    // A socket that sends to a port of this machine in the range of outgoing ports can reach itself if no program listens there.
    if (role_ == Role::connects && socket_->local_endpoint(error) == where) return lost(asio::error::connection_refused);
    const std::string text = role_ == Role::listens ? fmt::format("up, listening on UDP port {}", socket_->local_endpoint(error).port())
                                                    : fmt::format("up, UDP to {}", name());
    if (came_up(text)) wait_readable();
}

void UdpLine::lost(const boost::system::error_code& error) {
    ++address_turn_;  // a name may have several addresses, and the drive only one of them
    went_down(error == asio::error::connection_refused
                  ? fmt::format("nobody listens at {}: is it switched on, and is the port right?", name())
                  : fmt::format("cannot reach {}: {}", name(), error.message()));
}

void UdpLine::stop() {
    awaits_name_ = false;
    socket_.reset();
    last_speaker_.reset();
    write_waits_ = false;
}

void UdpLine::wait_readable() {
    socket_->async_wait(udp::socket::wait_read, guarded([this](const boost::system::error_code& error) {
                            if (!error) on_readable();
                        }));
}

void UdpLine::on_readable() {
    for (int i = 0; i < datagrams_per_turn; ++i) {
        boost::system::error_code error;
        udp::endpoint from;
        const std::size_t n = socket_->receive_from(asio::buffer(buffer_), from, 0, error);
        if (error == asio::error::would_block) break;
        if (error) return lost(error);
        if (role_ == Role::listens) last_speaker_ = from;
        const Instant now = clock().now();
        auto rest = std::span(buffer_).first(n);
        while (!rest.empty()) {
            Frame f = Frame::run(rest.first(std::min(rest.size(), Frame::capacity)));
            f.at = now;
            rest = rest.subspan(f.size);
            count_received(1, f.size);
            if (!deliver(f)) return;
        }
    }
    wait_readable();
}

void UdpLine::flush() {
    if (state() != State::up || write_waits_ || !socket_) return;
    for (int i = 0; i < datagrams_per_turn; ++i) {
        drop_stale(clock().now());
        const SendQueue::Entry* next = queue_.front();
        if (next == nullptr) return;
        if (role_ == Role::listens && !last_speaker_) return drop_all();  // no peer is known yet
        boost::system::error_code error;
        const auto data = asio::buffer(next->frame.storage.data(), next->frame.size);
        if (role_ == Role::listens) {
            (void)socket_->send_to(data, *last_speaker_, 0, error);
        } else {
            (void)socket_->send(data, 0, error);
        }
        if (error == asio::error::would_block) {
            write_waits_ = true;
            socket_->async_wait(udp::socket::wait_write, guarded([this](const boost::system::error_code& e) {
                                    write_waits_ = false;
                                    if (!e) flush();
                                }));
            return;
        }
        const Frame sent = next->frame;
        queue_.pop();
        if (error) {
            ++status_.errors;
            if (role_ == Role::connects) return lost(error);
            continue;
        }
        if (!tell_sent(sent)) return;
    }
    if (!queue_.empty()) flush_soon();
}

}  // namespace axisgate
