// Poller: an epoll descriptor inside the io_context's own, readable while one of its sockets is ready.
// Sockets that are ready again are served again in the same turn, up to a bound per turn.
#include "gateway/lines/poller.hpp"

#include <unistd.h>

#include <chrono>
#include <utility>

namespace axisgate {

struct Poller::State : std::enable_shared_from_this<State> {
    State(boost::asio::io_context& io, std::function<void(std::span<const epoll_event>)> ready, Clock now)
        : descriptor(io.get_executor()), on_ready(std::move(ready)), clock(now) {
        fd = ::epoll_create1(EPOLL_CLOEXEC);
        boost::system::error_code ignored;
        if (fd >= 0) (void)descriptor.assign(fd, ignored);
    }

    struct Ready {
        std::shared_ptr<State> self;
        void operator()(boost::system::error_code ec) {
            State& s = *self;
            if (ec || s.ended) return;
            (void)s.serve();
            if (!s.ended) s.arm(std::move(self));
        }
    };
    bool serve() {
        // A client that was answered sends its next request meanwhile: polling here once more costs less than a turn of the io_context.
        epoll_event events[events_per_turn];
        bool any = false;
        const auto until = clock() + asks_again;
        for (int room = events_per_turn, n = 1; room > 0 && n > 0 && !ended; room -= n) {
            if (any && clock() >= until) break;
            n = ::epoll_wait(fd, events, room, 0);
            if (n > 0) on_ready({events, static_cast<std::size_t>(n)});
            any = any || n > 0;
        }
        return any;
    }
    void arm(std::shared_ptr<State> self) { descriptor.async_wait(boost::asio::posix::descriptor_base::wait_read, Ready{std::move(self)}); }

    boost::asio::posix::basic_stream_descriptor<boost::asio::io_context::executor_type> descriptor;
    std::function<void(std::span<const epoll_event>)> on_ready;
    Clock clock;
    int fd = -1;
    bool ended = false;
};

Poller::Poller(boost::asio::io_context& io, std::function<void(std::span<const epoll_event>)> on_ready, Clock clock)
    : state_(std::make_shared<State>(io, std::move(on_ready), clock)) {
    if (good()) state_->arm(state_);
}

Poller::~Poller() {
    state_->ended = true;
    boost::system::error_code ignored;
    state_->descriptor.close(ignored);
}

bool Poller::good() const noexcept { return state_->fd >= 0; }

bool Poller::serve_now() {
    const auto kept = state_;  // the handler may destroy the server
    return kept->fd >= 0 && !kept->ended && kept->serve();
}

bool Poller::add(int fd, std::uint64_t token, std::uint32_t events) noexcept {
    epoll_event e{};
    e.events = events;
    e.data.u64 = token;
    return ::epoll_ctl(state_->fd, EPOLL_CTL_ADD, fd, &e) == 0;
}

void Poller::change(int fd, std::uint64_t token, std::uint32_t events) noexcept {
    epoll_event e{};
    e.events = events;
    e.data.u64 = token;
    (void)::epoll_ctl(state_->fd, EPOLL_CTL_MOD, fd, &e);
}

}  // namespace axisgate
