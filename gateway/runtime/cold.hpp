// The thread that waits for the disk: it stores parameter writes, events, twin memories and sites for the hot and the service thread, and
// reports the result through mailboxes. Rows for which nobody waits are collected, so that a controller that sets a target every few
// milliseconds does not wear out the disk with a transaction each. Warnings are written at once, and a reader of events has them written
// first (`flush`).
#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "gateway/core/histogram.hpp"
#include "gateway/engine/engine.hpp"
#include "gateway/runtime/mailbox.hpp"
#include "gateway/store/store.hpp"

namespace axisgate {

struct EventAt {
    Event event;
    Instant at{};
};
struct TwinMemory {
    std::string drive;
    NonVolatile memory;
};
using ColdJob = std::variant<StoreOrder, EventAt, TwinMemory, ParameterSeen>;

struct Stored {
    Ticket order = no_ticket;
    std::string fault;  ///< empty: on the disk
};

/// The time between two transactions that contain only rows for which nobody waits (events, reported values); the first one after a quiet
/// time is written at once.
inline constexpr Duration cold_gathers = std::chrono::milliseconds(50);

class Cold {
public:
    struct Answers {
        std::function<void(std::vector<Stored>)> stored;  ///< called on the storage thread, once per batch
        std::function<void(std::vector<Event>)> events;   ///< with ids, whether they are on the disk or not
        std::function<void(std::string)> fault;           ///< the store failed: for the log
    };
    Cold(Store& store, Answers answers);
    ~Cold();

    /// One mailbox per sending thread.
    [[nodiscard]] Mailbox<ColdJob>& from_hot() noexcept { return from_hot_; }
    [[nodiscard]] Mailbox<ColdJob>& from_service() noexcept { return from_service_; }
    [[nodiscard]] boost::asio::io_context& context() noexcept { return io_; }
    /// Runs a function on the storage thread (called from the service thread: sites, backups).
    void run(std::function<void(Store&)> job);
    /// Writes all earlier rows, collected or not, then calls `then` on the storage thread. From any thread.
    void flush(std::function<void()> then);
    void start();
    /// Writes the remaining rows and ends the thread.
    void stop();
    [[nodiscard]] std::uint64_t batches() const noexcept { return batches_.load(std::memory_order_relaxed); }
    [[nodiscard]] std::uint64_t faults() const noexcept { return faults_.load(std::memory_order_relaxed); }
    [[nodiscard]] std::uint64_t write_ns() const noexcept { return write_ns_.load(std::memory_order_relaxed); }
    /// Durations of the transactions. Any thread.
    [[nodiscard]] const Histogram& batch_times() const noexcept { return batch_times_; }
    [[nodiscard]] bool healthy() const noexcept { return healthy_.load(std::memory_order_relaxed); }

private:
    void take(ColdJob&& job);
    void write_at(Instant when);
    void write_batch();

    Store& store_;
    Answers answers_;
    boost::asio::io_context io_{1};
    boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{io_.get_executor()};
    Doorbell bell_{io_};
    Mailbox<ColdJob> from_hot_, from_service_;
    std::vector<StoreOrder> orders_;
    std::vector<EventAt> events_;
    std::vector<ParameterSeen> seen_;
    std::vector<TwinMemory> twins_;
    boost::asio::steady_timer timer_{io_};
    Instant write_at_ = never;  ///< when the collected batch will be written
    Instant written_{};         ///< when the last one was written
    bool stopping_ = false;
    std::uint64_t next_event_id_ = 1;
    std::atomic<std::uint64_t> batches_{0}, faults_{0}, write_ns_{0};
    Histogram batch_times_;
    std::atomic<bool> healthy_{true};
    std::thread thread_;
};

}  // namespace axisgate
