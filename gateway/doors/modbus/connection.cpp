// In the steady state a request costs one recv and one send, and no change of the epoll events. A client whose answers wait is not read
// from: TCP holds it back.
#include "gateway/doors/modbus/connection.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace axisgate::modbus {
namespace {
bool would_block() noexcept { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }
}  // namespace

Connection::Connection(int fd, Poller& poller, ConnectionHost& host, Responder& responder, ConnectionToken token, std::string who)
    : fd_(fd),
      poller_(poller),
      host_(host),
      counters_(responder.counters()),
      token_(token),
      events_(EPOLLIN),
      session_(responder, *this, std::make_shared<const std::string>(std::move(who))) {}

Connection::~Connection() {
    if (fd_ >= 0) ::close(fd_);
}

void Connection::close(Counter* why) {
    if (fd_ < 0) return;
    if (why) why->add();
    session_.abandon();
    ::close(std::exchange(fd_, -1));
    host_.closed(token_);
}

void Connection::wake(Session&) {
    if (fd_ < 0 || resuming_) return;
    resuming_ = true;
    host_.ready(token_);
}

void Connection::resume() {
    resuming_ = false;
    pump();
    choose_events();
}

void Connection::on_ready(std::uint32_t events) {
    if ((events & (EPOLLERR | EPOLLHUP)) != 0 && (events & EPOLLIN) == 0) return close();  // otherwise recv reports it
    if ((events & EPOLLIN) != 0) read();
    if ((events & EPOLLOUT) != 0 && !backlog_.empty()) write();
    choose_events();
}

void Connection::read() {
    const auto space = session_.input().space();
    if (space.empty()) return;
    const auto n = ::recv(fd_, space.data(), space.size(), 0);
    if (n > 0) {
        counters_.bytes_received.add(static_cast<std::uint64_t>(n));
        session_.input().filled(static_cast<std::size_t>(n));
    } else if (n == 0) {
        ended_ = true;
    } else if (!would_block()) {
        return close();
    }
    pump();
}

void Connection::write() {
    if (fd_ < 0) return;
    const auto n = ::send(fd_, backlog_.data() + sent_, backlog_.size() - sent_, MSG_NOSIGNAL);
    if (n < 0 && !would_block()) return close();
    if (n <= 0) return;
    sent_ += static_cast<std::size_t>(n);
    counters_.bytes_sent.add(static_cast<std::uint64_t>(n));
    if (sent_ < backlog_.size()) {
        host_.times(token_).deadline = host_.now() + host_.stall_timeout;
        return;
    }
    backlog_ = {};  // a client that was slow once does not keep 64 KiB
    sent_ = 0;
    host_.times(token_).deadline = never;
    pump();
}

void Connection::pump() {
    if (fd_ < 0 || !backlog_.empty()) return;
    const std::uint64_t before = session_.requests();
    AnswerBuffer& out = host_.scratch;
    Session::Work work;
    const Instant now = host_.now();
    do {
        out.size = 0;
        work = session_.work(now, out);
        const std::uint64_t answered = session_.answered_at_once();
        if (out.size > 0 && !send()) return close();
        if (answered > 0) counters_.request_times.observe(host_.now() - now, answered);
    } while (work == Session::Work::output_full && backlog_.empty());
    if (work == Session::Work::not_modbus) {
        // Unread bytes would make the close a reset, which may overtake the answers to the requests before the garbage.
        ::shutdown(fd_, SHUT_WR);
        [[maybe_unused]] const auto drained = ::recv(fd_, out.bytes.data(), out.bytes.size(), 0);
        return close(&counters_.closed_not_modbus);
    }
    if (ended_ && backlog_.empty() && session_.in_flight() == 0) return close();
    watch(before, work, now);
}

bool Connection::send() {
    const AnswerBuffer& out = host_.scratch;
    const auto n = ::send(fd_, out.bytes.data(), out.size, MSG_NOSIGNAL);
    if (n < 0 && !would_block()) return false;
    const std::size_t taken = n > 0 ? static_cast<std::size_t>(n) : 0;
    counters_.bytes_sent.add(taken);
    if (taken < out.size) backlog_.assign(out.bytes.data() + taken, out.bytes.data() + out.size);
    return true;
}

void Connection::watch(std::uint64_t requests_before, Session::Work work, Instant now) {
    const bool asked = session_.requests() != requests_before;
    const bool unsent = !backlog_.empty();
    const bool partial = work == Session::Work::need_bytes && session_.holds_partial() && !unsent;
    ConnectionTimes& times = host_.times(token_);
    if (asked) times.last_request = now;
    if (unsent) {
        times.deadline = now + host_.stall_timeout;
    } else if (!partial) {
        times.deadline = never;
    } else if (asked || !had_partial_) {
        times.deadline = now + host_.partial_timeout;
    }
    had_partial_ = partial;
}

void Connection::choose_events() {
    if (fd_ < 0) return;
    // With unsent answers, or a full input (the next request waits for results), TCP holds the client back.
    const bool full = session_.input().buffered() == AduFramer::capacity;
    const std::uint32_t wanted = !backlog_.empty() ? EPOLLOUT : ended_ || full ? 0u : EPOLLIN;
    if (wanted == events_) return;
    events_ = wanted;
    poller_.change(fd_, token_, wanted);
}

}  // namespace axisgate::modbus
