// Doorbell: how other threads wake the one of an io_context.
// In: calls that are rung, from any thread. Out: the answer of each that was rung, on the receiver's thread.
// Why not asio::post: it wakes the receiver while it holds the io_context's mutex. A receiver that goes first takes the processor from
// whoever woke it, and then waits for that mutex until the other one has its turn again: on a busy machine for milliseconds. Here nobody
// holds anything: a word that both write, and a descriptor of the kernel's.
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
    /// Throws std::system_error where the process has no descriptor left, as the io_context itself does.
    explicit Doorbell(boost::asio::io_context& receiver);
    Doorbell(const Doorbell&) = delete;
    Doorbell& operator=(const Doorbell&) = delete;
    ~Doorbell();

    /// One reason to be woken. Made and ended on the receiver's thread, or while that does not run; it does not outlive its bell.
    class Call {
    public:
        Call(Doorbell& bell, std::function<void()> answer);
        ~Call();
        Call(const Call&) = delete;
        Call& operator=(const Call&) = delete;
        /// Any thread. What is rung again before it was answered is answered once, and sees all that was done before either.
        void ring() noexcept {
            if (!rung_.exchange(true, std::memory_order_acq_rel)) bell_.wake();
        }

    private:
        friend class Doorbell;
        Doorbell& bell_;
        std::function<void()> answer_;
        std::atomic<bool> rung_{false};
    };

    /// Receiver's thread: what has been rung is answered now.
    void answer();
    /// Receiver's thread: nothing is answered by itself any more, and the io_context need not wait for it.
    void end();

private:
    void wake() noexcept;
    void listen();

    boost::asio::posix::stream_descriptor descriptor_;
    int fd_;
    std::uint64_t rings_ = 0;  ///< what the kernel has counted; nobody looks at it
    bool ended_ = false;
    std::vector<Call*> calls_;  ///< few: a mailbox each
};

}  // namespace axisgate
