// A bounded ring from one thread to another. The sender announces new items once per turn, and the receiver's handler is called with each
// on its own thread when the doorbell wakes it. It never blocks and never grows: the sender is informed of a full ring and decides what to
// do.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "gateway/runtime/doorbell.hpp"

namespace axisgate {

template <class T>
class Mailbox {
public:
    /// `handler` runs on the receiver's thread, which must be stopped before the mailbox is destroyed.
    Mailbox(std::size_t capacity, Doorbell& receiver, std::function<void(T&&)> handler)
        : ring_(capacity), spare_(capacity), handler_(std::move(handler)), call_(receiver, [this] { empty(); }) {}

    /// Sender's thread. False: full; the item is unchanged.
    [[nodiscard]] bool push(T&& item) {
        // spsc_queue moves only on success when the write is available.
        if (ring_.write_available() == 0) {
            full_.fetch_add(1, std::memory_order_relaxed);
            return false;
        }
        T* place = nullptr;
        if (spare_.pop(place)) {
            *place = std::move(item);
        } else {
            place = std::make_unique<T>(std::move(item)).release();
        }
        ring_.push(place);
        unannounced_ = true;
        return true;
    }
    /// Sender's thread: an item was pushed since the last announcement.
    [[nodiscard]] bool unannounced() const noexcept { return unannounced_; }
    /// Sender's thread, once per turn: wakes the receiver if there are new items and no wake-up is on its way.
    void announce() {
        if (!unannounced_) return;
        unannounced_ = false;
        call_.ring();
    }
    /// Receiver's thread: calls the handler with each present item. This happens automatically after an announcement; the owner calls it
    /// where items must be seen although their announcement is still on its way.
    void empty() {
        T* item = nullptr;
        // Bounded: items that arrive meanwhile are announced again.
        for (std::size_t n = ring_.read_available(); n > 0 && ring_.pop(item); --n) {
            std::unique_ptr<T> place(item);
            T owned(std::move(*place));
            if (spare_.push(place.get())) (void)place.release();
            handler_(std::move(owned));
        }
        if (ring_.read_available() > 0) call_.ring();
    }

    /// Number of items that found the ring full, since the start.
    [[nodiscard]] std::uint64_t full() const noexcept { return full_.load(std::memory_order_relaxed); }

    ~Mailbox() {
        T* item = nullptr;
        while (ring_.pop(item) || spare_.pop(item))
            delete item;
    }
    Mailbox(const Mailbox&) = delete;
    Mailbox& operator=(const Mailbox&) = delete;

private:
    boost::lockfree::spsc_queue<T*> ring_;
    boost::lockfree::spsc_queue<T*> spare_;  ///< the other direction: emptied places, so that no thread waits for another one's memory
    std::function<void(T&&)> handler_;
    std::atomic<std::uint64_t> full_{0};
    bool unannounced_ = false;
    Doorbell::Call call_;
};

}  // namespace axisgate
