// Collects the rows since the last write into one transaction, writes it, and reports the result. It never holds more than its mailboxes'
// bounds plus one batch.
#include "gateway/runtime/cold.hpp"

#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/threads.hpp"

namespace axisgate {
namespace {
// With 64 commands per axis and 64 axes this is more than the possible number of outstanding writes; beyond it a write fails with a reason.
constexpr std::size_t hot_ring = 8192;
constexpr std::size_t service_ring = 1024;  // only events
// A batch of this many rows is written without further waiting.
constexpr std::size_t gathered_at_most = 1024;
}  // namespace

Cold::Cold(Store& store, Answers answers)
    : store_(store),
      answers_(std::move(answers)),
      from_hot_(hot_ring, bell_, [this](ColdJob&& job) { take(std::move(job)); }),
      from_service_(service_ring, bell_, [this](ColdJob&& job) { take(std::move(job)); }) {
    if (const auto last = store_.last_event_id()) next_event_id_ = *last + 1;
}

Cold::~Cold() { stop(); }

void Cold::start() {
    thread_ = std::thread([this] {
        enter_thread("axisgate-cold", cold_stands_back);
        take_short_turns(cold_turn_ns);  // giving way costs the rest of a turn
        io_.run();
    });
}

void Cold::stop() {
    if (!thread_.joinable()) return;
    boost::asio::post(io_, [this] {  // collected rows are written at once
        stopping_ = true;
        bell_.answer();
        bell_.end();
        if (write_at_ != never) write_at(monotonic_now());
    });
    work_.reset();  // jobs that were posted already are still carried out
    thread_.join();
}

void Cold::run(std::function<void(Store&)> job) {
    boost::asio::post(io_, [this, job = std::move(job)] { job(store_); });
}

void Cold::flush(std::function<void()> then) {
    boost::asio::post(io_, [this, then = std::move(then)] {
        from_hot_.empty();
        from_service_.empty();
        if (write_at_ != never) write_batch();
        then();
    });
}

void Cold::take(ColdJob&& job) {
    bool urgent = stopping_;
    if (auto* o = std::get_if<StoreOrder>(&job)) orders_.push_back(std::move(*o));
    if (auto* e = std::get_if<EventAt>(&job)) {
        urgent = urgent || e->event.severity != Severity::info;
        events_.push_back(std::move(*e));
    }
    if (auto* s = std::get_if<ParameterSeen>(&job)) seen_.push_back(std::move(*s));
    if (auto* t = std::get_if<TwinMemory>(&job)) twins_.push_back(std::move(*t));
    // A client waits for a parameter; a twin's memory is a drive's EEPROM; a warning is for the page: these are written at once, together
    // with the collected rows.
    urgent = urgent || !orders_.empty() || !twins_.empty() || events_.size() + seen_.size() >= gathered_at_most;
    write_at(urgent ? Instant{} : written_ + cold_gathers);
}

/// Sets the one timer, or advances it: everything that the mailbox delivers at once is one batch even if it is due at once.
void Cold::write_at(Instant when) {
    if (write_at_ <= when) return;
    write_at_ = when;
    timer_.expires_at(
        std::chrono::steady_clock::time_point(std::chrono::duration_cast<std::chrono::steady_clock::duration>(when.time_since_epoch())));
    timer_.async_wait([this](const boost::system::error_code& moved) {
        if (!moved && write_at_ <= monotonic_now()) write_batch();  // otherwise the timer had expired already when it was moved
    });
}

void Cold::write_batch() {
    write_at_ = never;
    auto orders = std::move(orders_);
    auto events_at = std::move(events_);
    auto seen = std::move(seen_);
    auto twins = std::move(twins_);
    orders_.clear();
    events_.clear();
    seen_.clear();
    twins_.clear();
    const Instant begun = monotonic_now();
    written_ = begun;

    std::vector<ParameterWrite> writes;
    writes.reserve(orders.size());
    for (const auto& o : orders) {
        writes.push_back(
            {o.axis_name, o.parameter, o.value, o.previous, o.origin.door, o.origin.who ? *o.origin.who : "", unix_now_ns(), o.storage});
    }
    std::vector<Event> events;
    events.reserve(events_at.size());
    for (auto& e : events_at) {
        e.event.at_unix_ns = unix_ns_of(e.at);
        events.push_back(std::move(e.event));
    }
    std::string fault;
    const auto failed = [&](const StoreError& e) {
        faults_.fetch_add(1, std::memory_order_relaxed);
        healthy_.store(false, std::memory_order_relaxed);
        if (answers_.fault) answers_.fault(e.text);
    };
    // A client waits for parameter writes, so their failure must be reported; events and reported values may be lost on a full disk.
    bool good = true;
    if (const auto done = store_.commit(StoreBatch{writes, events, seen}); done) {
        if (!events.empty()) next_event_id_ = *done;
    } else {
        good = false;
        fault = done.error().text;
        failed(done.error());
    }
    for (const auto& t : twins) {
        if (const auto done = store_.save_twin(t.drive, t.memory); !done) {
            good = false;
            failed(done.error());
        }
    }
    if (good) healthy_.store(true, std::memory_order_relaxed);
    for (auto it = events.rbegin(); it != events.rend(); ++it) {
        const auto back = static_cast<std::uint64_t>(it - events.rbegin());
        it->id = fault.empty() ? next_event_id_ - back : 0;  // 0: streamed, but not stored
    }
    batches_.fetch_add(1, std::memory_order_relaxed);
    const Duration took = monotonic_now() - begun;
    write_ns_.fetch_add(static_cast<std::uint64_t>(took.count()), std::memory_order_relaxed);
    batch_times_.observe(took);
    if (!orders.empty()) {
        std::vector<Stored> stored;
        for (const auto& o : orders)
            stored.push_back({o.ticket, fault});
        answers_.stored(std::move(stored));
    }
    if (!events.empty()) answers_.events(std::move(events));
}

}  // namespace axisgate
