// A request costs one recv and one send; only bytes that the kernel does not accept wait for the socket. Reading stops while answers wait.
#include "gateway/doors/enip/tcp_session.hpp"

#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace axisgate::enip {
namespace {
bool would_block() noexcept { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }
}  // namespace

void TcpSession::on_ready(std::uint32_t events) {
    if (!open_) return end();
    if (!unsent_.empty()) {
        // A peer that has closed while answers wait is not watched for reading; its end is reported together with these.
        if (events & (EPOLLOUT | EPOLLERR | EPOLLHUP)) write();
    } else if (events & (EPOLLIN | EPOLLRDHUP | EPOLLERR | EPOLLHUP)) {
        read((events & (EPOLLRDHUP | EPOLLERR | EPOLLHUP)) != 0);
    }
}

/// Readiness is reported when bytes arrive, and not as long as bytes are available, which saves the kernel a second check of the socket for
/// each request. If a read may have left bytes, it is scheduled again, behind the other ready sockets.
void TcpSession::read(bool other_end_gone) {
    std::array<std::uint8_t, 4096> bytes;
    const auto n = ::recv(fd_, bytes.data(), bytes.size(), 0);
    if (n == 0 || (n < 0 && !would_block())) return end();
    gathers_ = true;
    asks_again_ = n <= 0 || static_cast<std::size_t>(n) == bytes.size() || other_end_gone;
    if (n > 0) arrived_({bytes.data(), static_cast<std::size_t>(n)});
    if (!open_) end();
}

/// A peer that waits is woken by the first answer. If all answers of a turn are sent together, it finds the others at once instead of being
/// woken for each.
void TcpSession::flush() {
    const bool again = std::exchange(asks_again_, false);
    release();
    if (!open_) {
        if (ended_) end();
    } else if (again && unsent_.empty()) {
        poller_.change(fd_, token_, watched);
    }
}

/// Sends the collected bytes; those that the kernel does not accept wait.
void TcpSession::release() {
    if (!std::exchange(gathers_, false) || !open_ || unsent_.empty()) return;
    push();
    if (open_ && !unsent_.empty()) poller_.change(fd_, token_, EPOLLOUT);
}

void TcpSession::send(cip::View bytes) {
    if (!open_) return;
    if (gathers_ && unsent_.size() + bytes.size() > most_gathered) release();
    const bool waits = gathers_ || !unsent_.empty();
    if (unsent_.size() + bytes.size() > most_unsent_) return hang_up();
    cip::put_bytes(unsent_, bytes);
    if (waits) return;
    push();
    if (open_ && !unsent_.empty()) poller_.change(fd_, token_, EPOLLOUT);
}

void TcpSession::push() {
    const auto n = ::send(fd_, unsent_.data(), unsent_.size(), MSG_NOSIGNAL);
    if (n < 0 && !would_block()) open_ = false;
    if (n > 0) unsent_.erase(unsent_.begin(), unsent_.begin() + n);
}

void TcpSession::write() {
    push();
    if (!open_) return end();
    if (unsent_.empty()) poller_.change(fd_, token_, watched);
}

void TcpSession::hang_up() {
    if (!open_) return;
    release();
    open_ = false;
    (void)::shutdown(fd_, SHUT_RDWR);  // the poller reports it, and the session ends then
}

void TcpSession::end() {
    open_ = false;
    close();
    if (const auto ended = std::exchange(ended_, nullptr)) ended();
}

void TcpSession::close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
}

}  // namespace axisgate::enip
