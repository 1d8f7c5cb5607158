// An eventfd that the receiver's io_context reads. Neither side blocks.
#include "gateway/runtime/doorbell.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <cerrno>
#include <system_error>
#include <utility>

namespace axisgate {

Doorbell::Doorbell(boost::asio::io_context& receiver) : descriptor_(receiver), fd_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
    descriptor_.assign(fd_);
    listen();
}

Doorbell::~Doorbell() = default;

Doorbell::Call::Call(Doorbell& bell, std::function<void()> answer) : bell_(bell), answer_(std::move(answer)) {
    bell_.calls_.push_back(this);
}

Doorbell::Call::~Call() { std::erase(bell_.calls_, this); }

void Doorbell::wake() noexcept {
    const std::uint64_t one = 1;
    (void)!::write(fd_, &one, sizeof one);
}

void Doorbell::listen() {
    descriptor_.async_read_some(boost::asio::buffer(&rings_, sizeof rings_), [this](const boost::system::error_code& ec, std::size_t) {
        if (ec) return;
        answer();
        if (!ended_) listen();
    });
}

void Doorbell::answer() {
    // By index, because an answer may make another call.
    for (std::size_t i = 0; i < calls_.size(); ++i) {
        Call& c = *calls_[i];
        if (c.rung_.load(std::memory_order_relaxed) && c.rung_.exchange(false, std::memory_order_acq_rel)) c.answer_();
    }
}

void Doorbell::end() {
    ended_ = true;
    boost::system::error_code ignored;
    descriptor_.cancel(ignored);
}

}  // namespace axisgate
