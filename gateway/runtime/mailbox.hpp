// Mailbox: a bounded ring from one thread to another, emptied by the receiver's io_context in batches.
// In: items, pushed by one thread and announced once per turn. Out: one call of the receiver's handler with each, on its executor.
// Never blocks and never grows: a full ring says so to the sender, who decides what that means.
#pragma once

#include <atomic>
#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/post.hpp>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

namespace axisgate {

template <class T>
class Mailbox {
public:
    /// `handler` runs on `receiver`. The mailbox outlives every handler that it posts (the owner stops the receiver first).
    Mailbox(std::size_t capacity, boost::asio::any_io_executor receiver, std::function<void(T&&)> handler)
        : ring_(capacity), receiver_(std::move(receiver)), handler_(std::move(handler)) {}

    /// Sender's thread. False: full; the item is left as it was.
    [[nodiscard]] bool push(T&& item) {
        // spsc_queue moves only on success when the write is available.
        if (ring_.write_available() == 0) {
            full_.fetch_add(1, std::memory_order_relaxed);
            return false;
        }
        ring_.push(std::make_unique<T>(std::move(item)).release());
        unannounced_ = true;
        return true;
    }
    /// Sender's thread: something was pushed since the last announcement.
    [[nodiscard]] bool unannounced() const noexcept { return unannounced_; }
    /// Sender's thread, once per turn: wakes the receiver if something new is there and no wake-up is on its way.
    void announce() {
        if (!unannounced_) return;
        unannounced_ = false;
        if (!on_its_way_.exchange(true, std::memory_order_acq_rel)) boost::asio::post(receiver_, [this] { empty(); });
    }
    /// Receiver's thread: the handler is called with each item that is there now. Done by itself after an announcement; called by the owner
    /// where what was pushed must be seen although its announcement is still on its way.
    void empty() {
        // An exchange, not a store: a sender that found it true has pushed before, and its item is seen below.
        (void)on_its_way_.exchange(false, std::memory_order_acq_rel);
        T* item = nullptr;
        // Bounded: what arrives meanwhile is announced anew.
        for (std::size_t n = ring_.read_available(); n > 0 && ring_.pop(item); --n) {
            const std::unique_ptr<T> owned(item);
            handler_(std::move(*owned));
        }
        if (ring_.read_available() > 0 && !on_its_way_.exchange(true, std::memory_order_acq_rel)) {
            boost::asio::post(receiver_, [this] { empty(); });
        }
    }

    /// Items that found the ring full, since the start.
    [[nodiscard]] std::uint64_t full() const noexcept { return full_.load(std::memory_order_relaxed); }

    ~Mailbox() {
        T* item = nullptr;
        while (ring_.pop(item))
            delete item;
    }
    Mailbox(const Mailbox&) = delete;
    Mailbox& operator=(const Mailbox&) = delete;

private:
    boost::lockfree::spsc_queue<T*> ring_;
    boost::asio::any_io_executor receiver_;
    std::function<void(T&&)> handler_;
    std::atomic<bool> on_its_way_{false};
    std::atomic<std::uint64_t> full_{0};
    bool unannounced_ = false;
};

}  // namespace axisgate
