// Wakes the thread of an io_context from other threads. asio::post is not used, because it wakes the receiver while it holds the
// io_context's mutex: a receiver of higher priority takes the processor from the sender and then waits for that mutex until the sender runs
// again, on a busy machine for milliseconds. Here no lock is held: both sides write one word, and the kernel provides the descriptor.
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cstdint>
#include <functional>
#include <vector>

namespace axisgate {

class Doorbell {
public:
    /// Throws std::system_error if the process has no descriptor left, like the io_context itself.
    explicit Doorbell(boost::asio::io_context& receiver);
    Doorbell(const Doorbell&) = delete;
    Doorbell& operator=(const Doorbell&) = delete;
    ~Doorbell();

    /// One reason for waking. Made and destroyed on the receiver's thread, or while that does not run; it must not outlive its bell.
    class Call {
    public:
        Call(Doorbell& bell, std::function<void()> answer);
        ~Call();
        Call(const Call&) = delete;
        Call& operator=(const Call&) = delete;
        /// Any thread. If it is rung again before it was answered, it is answered once, after everything that was done before either call.
        void ring() noexcept {
            if (!rung_.exchange(true, std::memory_order_acq_rel)) bell_.wake();
        }

    private:
        friend class Doorbell;
        Doorbell& bell_;
        std::function<void()> answer_;
        std::atomic<bool> rung_{false};
    };

    /// Receiver's thread: answers the calls that have been rung.
    void answer();
    /// Receiver's thread: ends the automatic answers, so that the io_context need not wait for them.
    void end();

private:
    void wake() noexcept;
    void listen();

    boost::asio::posix::stream_descriptor descriptor_;
    int fd_;
    std::uint64_t rings_ = 0;  ///< the kernel's count, which is not used
    bool ended_ = false;
    std::vector<Call*> calls_;  ///< few: one per mailbox
};

}  // namespace axisgate
