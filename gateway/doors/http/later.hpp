// Later: what moves nothing waits here for the turn of what commands. Between two looks at the sockets some of it is done, at most 15 us
// and one job more: so a command that has come is taken up before the requests that came before it and that nothing moves by. In: jobs of
// this thread. Out: their calls, in order, from the io_context. Bound: one job for each connection and one for the live feed, kept by those
// who give them.
#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>

namespace axisgate::http {

class Later : public std::enable_shared_from_this<Later> {
public:
    /// Between two looks at the sockets; a job that has begun is ended.
    static constexpr std::chrono::microseconds most_at_once{15};

    explicit Later(boost::asio::io_context& context) : context_(context) {}
    Later(const Later&) = delete;
    Later& operator=(const Later&) = delete;
    /// To be called once, soon, unless this object is gone by then. The job keeps nobody alive who keeps this object.
    void put(std::function<void()> job);

private:
    void wake();
    void turn();

    boost::asio::io_context& context_;
    std::deque<std::function<void()>> jobs_;
    bool awake_ = false;
};

}  // namespace axisgate::http
