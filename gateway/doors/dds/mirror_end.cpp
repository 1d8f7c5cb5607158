// One read and one write at a time. Any fault closes the socket.
#include "gateway/doors/dds/mirror_end.hpp"

#include <unistd.h>

#include <boost/asio/write.hpp>

namespace axisgate::dds {

MirrorEnd::MirrorEnd(boost::asio::io_context& context, int fd, Fleet& fleet, std::function<std::int64_t()> unix_ns,
                     std::function<Instant()> clock)
    : socket_(context), unix_ns_(std::move(unix_ns)), clock_(std::move(clock)), mirror_(fleet, [this](const std::string& text) {
          if (!is_open()) return;
          if (waits_.size() + text.size() > waits_most) return close();
          waits_ += text;
          write();
      }) {
    boost::system::error_code error;
    socket_.assign({}, fd, error);
    if (error) {
        ::close(fd);
        return;
    }
    read();
}

MirrorEnd::~MirrorEnd() { close(); }

void MirrorEnd::close() {
    boost::system::error_code ignored;
    socket_.close(ignored);
}

void MirrorEnd::read() {
    socket_.async_read_some(boost::asio::buffer(in_),
                            [this, alive = std::weak_ptr<char>(alive_)](const boost::system::error_code& error, std::size_t n) {
                                if (alive.expired()) return;
                                if (error) return close();
                                mirror_.receive({in_.data(), n}, unix_ns_(), clock_());
                                if (is_open()) read();
                            });
}

void MirrorEnd::write() {
    if (!sending_.empty() || waits_.empty()) return;
    sending_.swap(waits_);
    boost::asio::async_write(socket_, boost::asio::buffer(sending_),
                             [this, alive = std::weak_ptr<char>(alive_)](const boost::system::error_code& error, std::size_t) {
                                 if (alive.expired()) return;
                                 sending_.clear();
                                 if (error) return close();
                                 write();
                             });
}

}  // namespace axisgate::dds
