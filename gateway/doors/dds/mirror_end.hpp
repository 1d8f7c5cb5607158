// The socket of a mirror line at the fleet's side, on the service thread. If the hot loop does not read, at most `waits_most` bytes wait;
// then the end is closed, and the line opens again.
#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <string>

#include "gateway/doors/dds/mirror.hpp"

namespace axisgate::dds {

class MirrorEnd {
public:
    static constexpr std::size_t waits_most = std::size_t{1} << 20;  ///< bytes

    MirrorEnd(boost::asio::io_context& context, int fd, Fleet& fleet, std::function<std::int64_t()> unix_ns,
              std::function<Instant()> clock);
    ~MirrorEnd();
    MirrorEnd(const MirrorEnd&) = delete;
    MirrorEnd& operator=(const MirrorEnd&) = delete;

    void on_axis(std::string_view gateway, std::string_view axis) {
        if (is_open()) mirror_.on_axis(gateway, axis, unix_ns_());
    }
    void on_turn() {
        if (is_open()) mirror_.on_turn(unix_ns_(), clock_());
    }
    [[nodiscard]] bool is_open() const { return socket_.is_open(); }

private:
    void read();
    void write();
    void close();

    boost::asio::local::stream_protocol::socket socket_;
    std::function<std::int64_t()> unix_ns_;
    std::function<Instant()> clock_;
    std::array<char, 4096> in_;
    std::string waits_, sending_;
    std::shared_ptr<char> alive_ = std::make_shared<char>();  // later handlers see that it was destroyed
    Mirror mirror_;
};

}  // namespace axisgate::dds
