// TCP session: a request costs one recv and one send; only what the kernel does not take waits for the socket.
// In: readiness. Out: bytes. Never reads on while its answers wait.
#include "gateway/doors/enip/tcp_session.hpp"

#include <sys/socket.h>

#include <array>
#include <cerrno>

namespace axisgate::enip {
namespace {
bool would_block() noexcept { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }
}  // namespace

void TcpSession::read() {
    socket_.async_wait(Socket::wait_read, [self = shared_from_this()](boost::system::error_code ec) {
        if (ec || !self->open_) return self->end();
        std::array<std::uint8_t, 4096> bytes;
        const auto n = ::recv(self->socket_.native_handle(), bytes.data(), bytes.size(), 0);
        if (n == 0 || (n < 0 && !would_block())) return self->end();
        if (n > 0) self->arrived_({bytes.data(), static_cast<std::size_t>(n)});
        if (!self->open_) return self->end();
        if (self->unsent_.empty()) self->read();  // else when it has taken its answers
    });
}

void TcpSession::send(cip::View bytes) {
    if (!open_) return;
    std::size_t taken = 0;
    if (unsent_.empty()) {
        const auto n = ::send(socket_.native_handle(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (n < 0 && !would_block()) {
            open_ = false;
            return;
        }
        taken = n > 0 ? static_cast<std::size_t>(n) : 0;
        if (taken == bytes.size()) return;
    }
    if (unsent_.size() + bytes.size() - taken > most_unsent_) {
        hang_up();
        return;
    }
    const bool idle = unsent_.empty();
    cip::put_bytes(unsent_, bytes.subspan(taken));
    if (idle) write();
}

void TcpSession::write() {
    socket_.async_wait(Socket::wait_write, [self = shared_from_this()](boost::system::error_code ec) {
        if (ec || !self->open_) return self->end();
        const auto n = ::send(self->socket_.native_handle(), self->unsent_.data(), self->unsent_.size(), MSG_NOSIGNAL);
        if (n < 0 && !would_block()) return self->end();
        if (n > 0) self->unsent_.erase(self->unsent_.begin(), self->unsent_.begin() + n);
        self->unsent_.empty() ? self->read() : self->write();
    });
}

void TcpSession::hang_up() {
    if (!open_) return;
    open_ = false;
    boost::system::error_code ignored;
    socket_.shutdown(Socket::shutdown_both, ignored);  // wakes the read that waits
}

void TcpSession::end() {
    open_ = false;
    boost::system::error_code ignored;
    socket_.close(ignored);
    if (const auto ended = std::exchange(ended_, nullptr)) ended();
}

}  // namespace axisgate::enip
