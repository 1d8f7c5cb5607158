// A handler in the io_context's queue, posted again behind the ready ones as long as there are jobs. A job is never run inside `put`.
#include "gateway/doors/http/later.hpp"

#include <boost/asio/post.hpp>
#include <utility>

namespace axisgate::http {

void Later::put(std::function<void()> job) {
    jobs_.push_back(std::move(job));
    if (!awake_) wake();
}

// Posted twice: the io_context puts handlers of ready sockets behind waiting ones, so behind the first and before the second.
void Later::wake() {
    awake_ = true;
    boost::asio::post(context_, [self = weak_from_this()] {
        const auto me = self.lock();
        if (!me) return;
        boost::asio::post(me->context_, [self] {
            if (const auto again = self.lock()) again->turn();
        });
    });
}

void Later::turn() {
    const auto begun = std::chrono::steady_clock::now();
    do {
        const auto job = std::move(jobs_.front());
        jobs_.pop_front();
        job();
    } while (!jobs_.empty() && std::chrono::steady_clock::now() - begun < most_at_once);
    awake_ = false;
    if (!jobs_.empty()) wake();
}

}  // namespace axisgate::http
