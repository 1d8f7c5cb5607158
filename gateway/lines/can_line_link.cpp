// CanLine, changes of the interface: bus-off and recovery, interface down, interface removed and added again.
// Netlink messages and the controller's error reports come in; the line's state changes and restart requests go out. A controller that
// restarts itself (restart-ms) is left to do so; where a restart is not permitted, the fault text names the command to type.
#include <fmt/core.h>
#include <linux/netlink.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include "gateway/lines/can_line.hpp"
#include "gateway/lines/error_text.hpp"

namespace axisgate {
namespace {

constexpr int datagrams_per_turn = 16;
constexpr std::size_t datagram_size = 32 * 1024;
/// A controller that has worked for this long since its last restart is restarted with the shortest pause again.
constexpr Duration settled_after = std::chrono::seconds(5);

}  // namespace

std::string CanLine::bus_off_text() const {
    std::string s = fmt::format("{} is bus-off after too many errors: check wiring, termination and bit rate", interface_);
    if (restart_ms_.value_or(0) > 0) return s + fmt::format("; the controller restarts by itself after {} ms", *restart_ms_);
    if (!restart_refused_.empty()) {
        return s +
               fmt::format("; it cannot be restarted from here ({}): ip link set {} type can restart-ms 100", restart_refused_, interface_);
    }
    return s + "; it is being restarted";
}

bool CanLine::bus_off() {
    if (state() == State::bus_off) return true;
    ++counters_.bus_off;
    can_state_ = CanState::bus_off;
    send_timer_.cancel();
    send_waits_ = true;  // no frame leaves until the controller is back
    in_flight_ = 0;
    drop_all();  // no caller expects these frames any more once the controller is back
    if (clock().now() - back_since_ > settled_after) restart_pause_.reset();
    ask_for_restart_later();
    return tell_state(State::bus_off, false, bus_off_text());
}

bool CanLine::back_from_bus_off() {
    if (state() != State::bus_off) return true;
    restart_timer_.cancel();
    send_waits_ = stalled_ = false;
    in_flight_ = 0;
    can_state_ = CanState::active;
    status_.tx_errors = status_.rx_errors = 0;
    back_since_ = clock().now();
    return came_up(up_text() + " again, after bus-off");
}

void CanLine::ask_for_restart_later() {
    restart_timer_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(restart_pause_.take()));
    restart_timer_.async_wait(guarded([this](const boost::system::error_code& error) {
        if (!error && state() == State::bus_off) ask_for_restart();
    }));
}

void CanLine::ask_for_restart() {
    if (restart_ms_.value_or(0) == 0) {
        ++counters_.restarts_asked;
        restart_sequence_ = ++sequence_;
        ask(restart_request(index_, restart_sequence_));
    }
    ask(link_request(index_, ++sequence_));  // in case the report of the restart was lost
    say(bus_off_text());
    ask_for_restart_later();
}

void CanLine::open_links() {
    if (links_) return;
    const CanOpened opened = kernel_.open_links();
    if (opened.fd < 0) return;  // without the socket, changes are noticed only at the next attempt
    boost::system::error_code error;
    links_.emplace(io());
    links_->assign(opened.fd, error);
    if (error) {
        ::close(opened.fd);
        links_.reset();
        return;
    }
    link_buffer_.resize(datagram_size);
    wait_for_links();
}

void CanLine::wait_for_links() {
    links_->async_wait(asio::posix::stream_descriptor::wait_read, guarded_while_open([this](const boost::system::error_code& error) {
                           if (!error) read_links();
                       }));
}

void CanLine::read_links() {
    for (int i = 0; i < datagrams_per_turn; ++i) {
        sockaddr_nl from{};
        socklen_t from_size = sizeof from;
        const ssize_t n = ::recvfrom(links_->native_handle(), link_buffer_.data(), link_buffer_.size(), MSG_DONTWAIT,
                                     reinterpret_cast<sockaddr*>(&from), &from_size);
        // After ENOBUFS some messages are lost; the next attempt or request makes up for them.
        if (n < 0 && (errno == EINTR || errno == ENOBUFS)) continue;
        if (n <= 0) {
            if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) break;
            links_.reset();
            return;
        }
        // The message does not come from the kernel.
        if (from_size >= sizeof from && from.nl_family == AF_NETLINK && from.nl_pid != 0) continue;
        for (const LinkNews& news : read_link_news(std::span(link_buffer_).first(static_cast<std::size_t>(n)))) {
            if (!on_news(news)) return;
        }
    }
    wait_for_links();
}

void CanLine::ask(const std::vector<std::uint8_t>& request) {
    if (!links_) {
        restart_refused_ = "no netlink";
        return;
    }
    if (::send(links_->native_handle(), request.data(), request.size(), MSG_DONTWAIT | MSG_NOSIGNAL) < 0) ++status_.errors;
}

void CanLine::on_answer(const LinkNews& answer) {
    if (answer.sequence != restart_sequence_ || restart_sequence_ == 0 || state() != State::bus_off) return;
    if (answer.error == EBUSY) return;  // the controller is no longer bus-off; its report is on the way
    restart_refused_ = answer.error == 0 ? std::string() : answer.error == EPERM ? std::string("not permitted") : error_text(answer.error);
    say(bus_off_text());
}

/// Returns false if the owner closed the line meanwhile.
bool CanLine::on_news(const LinkNews& n) {
    if (n.kind == LinkNews::Kind::answer) {
        on_answer(n);
        return true;
    }
    const std::weak_ptr<char> open = open_life();
    const bool connected = state() == State::up || state() == State::bus_off;
    if (!connected) {
        if (n.kind == LinkNews::Kind::link && n.up && n.name == interface_) try_now();
        return true;
    }
    if (n.index != index_) return true;
    if (n.kind == LinkNews::Kind::removed) {
        went_down(can_open_fault(interface_, "removed", ENODEV));
    } else if (!n.up) {
        went_down(can_open_fault(interface_, "set down", ENETDOWN));
    } else {
        if (n.bit_rate != 0) bit_rate_ = n.bit_rate;
        if (n.restart_ms) restart_ms_ = n.restart_ms;
        if (n.has_counters) {
            status_.tx_errors = n.tx_errors;
            status_.rx_errors = n.rx_errors;
        }
        if (n.state == CanState::bus_off) {
            (void)bus_off();
        } else if (n.state && state() == State::bus_off && *n.state <= CanState::passive) {
            (void)back_from_bus_off();
        } else if (n.state && *n.state <= CanState::passive) {
            can_state_ = *n.state;
        }
    }
    return !open.expired();
}

}  // namespace axisgate
