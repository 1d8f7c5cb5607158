// TCP session: one originator's TCP connection: bytes in, bytes out, and what it does not read.
// In: a connected non-blocking socket. Out: bytes by a callback. Never keeps more unsent than its bound.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <functional>
#include <memory>

#include "gateway/protocols/cip/bytes.hpp"

namespace axisgate::enip {

class TcpSession : public std::enable_shared_from_this<TcpSession> {
public:
    using Socket = boost::asio::basic_stream_socket<boost::asio::ip::tcp, boost::asio::io_context::executor_type>;
    /// `arrived` gets what came; `ended` is called once, when the other end is gone or does not read.
    TcpSession(Socket socket, std::size_t most_unsent, std::function<void(cip::View)> arrived, std::function<void()> ended)
        : socket_(std::move(socket)), most_unsent_(most_unsent), arrived_(std::move(arrived)), ended_(std::move(ended)) {}
    void begin() { read(); }
    void send(cip::View bytes);
    /// What was sent still goes out, as far as the kernel takes it.
    void hang_up();

private:
    void read();
    void write();
    void end();
    Socket socket_;
    std::size_t most_unsent_;
    std::function<void(cip::View)> arrived_;
    std::function<void()> ended_;
    cip::Bytes unsent_;
    bool open_ = true;
};

}  // namespace axisgate::enip
