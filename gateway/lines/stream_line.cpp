// StreamLine: reading and writing for all lines that carry bytes.
// A frame that is half written is always completed first, even if an urgent frame waits.
#include "gateway/lines/stream_line.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "gateway/lines/error_text.hpp"

namespace axisgate {

StreamLine::StreamLine(const LineBase& base) : RealLine(base), write_timer_(base.io), read_timer_(base.io) {}

bool StreamLine::attach(int fd, bool is_socket, std::string& why) {
    is_socket_ = is_socket;
    port_.emplace(io());
    boost::system::error_code error;
    port_->assign(fd, error);
    if (!error) port_->native_non_blocking(true, error);
    if (!error) return true;
    why = error.message();
    if (!port_->is_open()) ::close(fd);
    port_.reset();
    return false;
}

void StreamLine::stop() {
    port_.reset();
    write_timer_.cancel();
    read_timer_.cancel();
    write_waits_ = false;
    partial_done_ = 0;
}

void StreamLine::begin_reading() {
    port_->async_wait(asio::posix::stream_descriptor::wait_read, guarded([this](const boost::system::error_code& error) {
                          if (!error) on_readable();
                      }));
}

void StreamLine::on_readable() {
    for (int i = 0; i < reads_per_turn; ++i) {
        const std::size_t room = std::min(room_to_read(), buffer_.size());
        if (room == 0) {
            read_timer_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(pause_before_read()));
            read_timer_.async_wait(guarded([this](const boost::system::error_code& error) {
                if (!error) on_readable();
            }));
            return;
        }
        const ssize_t n = ::read(fd(), buffer_.data(), room);
        const int failed = errno;
        if (n > 0) {
            const auto size = static_cast<std::size_t>(n);
            got(size, size == room);
            if (!hand_up(std::span(buffer_).first(size))) return;
            if (size < room) break;  // everything has been read: saves the read that would return nothing
            continue;
        }
        got(0, false);
        if (n == 0) {
            if (nothing_more_will_come()) return on_gone(0);
            break;
        }
        if (failed == EINTR) continue;
        if (failed == EAGAIN || failed == EWOULDBLOCK) break;
        return on_gone(failed);
    }
    begin_reading();
}

/// A terminal that returns at once reads 0 bytes if none are there, and also after a hang-up; this call distinguishes the two.
bool StreamLine::nothing_more_will_come() {
    if (is_socket_) return true;
    pollfd p{fd(), POLLIN, 0};
    return ::poll(&p, 1, 0) < 0 || (p.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
}

bool StreamLine::hand_up(std::span<std::uint8_t> data) {
    const Instant now = clock().now();
    load_in_.add(now, byte_time_ * static_cast<std::int64_t>(data.size()));
    auto rest = data.first(filter(data));
    while (!rest.empty()) {
        Frame f = Frame::run(rest.first(std::min(rest.size(), run())));
        rest = rest.subspan(f.size);
        f.at = crossed(rest.size());
        count_received(1, f.size);
        if (!deliver(f)) return false;
    }
    return true;
}

void StreamLine::on_gone(int error) { went_down(error == 0 ? std::string("the other side has closed the connection") : error_text(error)); }

void StreamLine::wait_writable() {
    write_waits_ = true;
    port_->async_wait(asio::posix::stream_descriptor::wait_write, guarded([this](const boost::system::error_code& error) {
                          if (error) return;
                          write_waits_ = false;
                          flush();
                      }));
}

void StreamLine::flush() {
    if (state() != State::up || write_waits_ || !port_) return;
    for (int i = 0; i < writes_per_turn; ++i) {
        drop_stale(clock().now());
        if (queue_.empty() && partial_done_ == 0) return;

        std::size_t room = std::min(room_to_write(), chunk);
        if (room == 0) {
            write_waits_ = true;
            write_timer_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(pause_before_write()));
            write_timer_.async_wait(guarded([this](const boost::system::error_code& error) {
                if (error) return;
                write_waits_ = false;
                flush();
            }));
            return;
        }
        // All waiting frames go out in one call: first the rest of a frame that was begun, then the queue in its order.
        std::array<iovec, frames_per_write + 1> parts{};
        std::array<const SendQueue::Entry*, frames_per_write> entries{};
        std::size_t count = 0, wanted = 0;
        const auto add = [&](const std::uint8_t* data, std::size_t size) {
            const std::size_t n = std::min(size, room);
            if (n == 0) return;
            parts[count++] = {const_cast<std::uint8_t*>(data), n};
            wanted += n;
            room -= n;
        };
        if (partial_done_ != 0) add(partial_.storage.data() + partial_done_, partial_.size - partial_done_);
        const std::size_t waiting = queue_.collect(entries);
        for (std::size_t k = 0; k < waiting; ++k)
            add(entries[k]->frame.storage.data(), entries[k]->frame.size);

        ssize_t n = 0;
        if (is_socket_) {
            msghdr message{};
            message.msg_iov = parts.data();
            message.msg_iovlen = count;
            n = ::sendmsg(fd(), &message, MSG_NOSIGNAL);
        } else {
            n = ::writev(fd(), parts.data(), static_cast<int>(count));
        }
        if (n < 0) {
            if (errno == EINTR) continue;
            if (errno == EAGAIN || errno == EWOULDBLOCK) return wait_writable();
            ++status_.errors;
            return on_gone(errno);
        }
        const auto written = static_cast<std::size_t>(n);
        if (!account_written(written, waiting)) return;
        if (written < wanted) return wait_writable();
    }
    flush_soon();  // the rest follows in the next turn
}

/// Removes the written bytes from the queue and reports every frame that is completely written to the owner.
bool StreamLine::account_written(std::size_t bytes, std::size_t frames) {
    const Instant now = clock().now();
    load_out_.add(now, byte_time_ * static_cast<std::int64_t>(bytes));
    sent_.clear();
    const std::size_t all = bytes;
    if (partial_done_ != 0) {
        const std::size_t n = std::min<std::size_t>(bytes, partial_.size - partial_done_);
        partial_done_ += n;
        bytes -= n;
        if (partial_done_ < partial_.size) {
            wrote(all, true);
            return true;
        }
        partial_done_ = 0;
        sent_.push_back(partial_);
    }
    for (std::size_t i = 0; i < frames; ++i) {
        const Frame& f = queue_.front()->frame;
        if (bytes < f.size) {
            if (bytes > 0) {
                partial_ = f;
                partial_done_ = bytes;
                queue_.pop();
            }
            break;
        }
        bytes -= f.size;
        sent_.push_back(f);
        queue_.pop();
    }
    wrote(all, partial_done_ != 0 || !queue_.empty());
    for (Frame& f : sent_) {
        f.at = now;
        if (!tell_sent(f)) return false;
    }
    return true;
}

}  // namespace axisgate
