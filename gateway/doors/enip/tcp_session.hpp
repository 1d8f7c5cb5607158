// One originator's TCP connection: received bytes go to a callback, unsent bytes are kept up to a bound.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "gateway/lines/poller.hpp"
#include "gateway/protocols/cip/bytes.hpp"

namespace axisgate::enip {

class TcpSession {
public:
    static constexpr std::uint32_t watched = EPOLLIN | EPOLLRDHUP | EPOLLET;  ///< the events that the poller reports while nothing is
                                                                              ///< unsent

    /// Owns `fd`, which `poller` watches for `watched` under `token`. `arrived` gets the received bytes; `ended` is called once, when the
    /// other end is gone or does not read; it must not destroy the session, which is still working.
    TcpSession(int fd, Poller& poller, std::uint64_t token, std::size_t most_unsent, std::function<void(cip::View)> arrived,
               std::function<void()> ended)
        : fd_(fd), poller_(poller), token_(token), most_unsent_(most_unsent), arrived_(std::move(arrived)), ended_(std::move(ended)) {}
    ~TcpSession() { close(); }
    TcpSession(const TcpSession&) = delete;
    TcpSession& operator=(const TcpSession&) = delete;
    /// Answers given from within wait for `flush`, which must follow each call.
    void on_ready(std::uint32_t events);
    void flush();
    void send(cip::View bytes);
    /// Sent bytes are still transmitted, as far as the kernel accepts them.
    void hang_up();

private:
    static constexpr std::size_t most_gathered = 16 * 1024;  ///< of a turn's answers
    void read(bool other_end_gone);
    void release();
    void push();
    void write();
    void end();
    void close();
    int fd_;
    Poller& poller_;
    std::uint64_t token_;
    std::size_t most_unsent_;
    std::function<void(cip::View)> arrived_;
    std::function<void()> ended_;
    cip::Bytes unsent_;
    bool open_ = true;
    bool gathers_ = false;     // from a read to the end of its turn
    bool asks_again_ = false;  // the read may have left bytes
};

}  // namespace axisgate::enip
