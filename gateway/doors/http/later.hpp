// Requests that move nothing wait here for commands. Between two polls of the sockets jobs run for at most 15 us and one job more, so that
// a new command is served before earlier requests that move nothing. Bound: one job for each connection and one for the live feed, which
// the callers keep.
#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>

namespace axisgate::http {

class Later : public std::enable_shared_from_this<Later> {
public:
    /// Between two polls of the sockets; a job that has begun is completed.
    static constexpr std::chrono::microseconds most_at_once{15};

    explicit Later(boost::asio::io_context& context) : context_(context) {}
    Later(const Later&) = delete;
    Later& operator=(const Later&) = delete;
    /// To be called once, soon, unless this object is gone by then. The job must not keep an owner of this object alive.
    void put(std::function<void()> job);

private:
    void wake();
    void turn();

    boost::asio::io_context& context_;
    std::deque<std::function<void()>> jobs_;
    bool awake_ = false;
};

}  // namespace axisgate::http
