// Exchange: one request on its way and the wait for its answer, with its repeats; and what may still come of requests that were given up.
// In: requests, answers, time. Out: whether it is to be sent again or over, and when to look again.
// Never sends by itself, never decides whether an answer fits: both are the family's. Nothing is allocated for an exchange.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "gateway/core/adapter.hpp"

namespace axisgate::drive {

/// What the passing of time means for an exchange.
enum class Late : std::uint8_t {
    no,      ///< not yet
    repeat,  ///< to be sent again now; its deadline is new
    over     ///< it has ended without an answer
};

/// `Request` is the family's: what is sent, and why (so that the answer finds who asked).
template <class Request>
class Exchange {
public:
    [[nodiscard]] bool active() const noexcept { return active_; }
    /// Of the present one, or of the one that ended last.
    [[nodiscard]] const Request& request() const noexcept { return request_; }
    [[nodiscard]] Request& request() noexcept { return request_; }
    [[nodiscard]] Instant sent() const noexcept { return sent_; }  ///< for the first time
    [[nodiscard]] int tries() const noexcept { return tries_; }
    [[nodiscard]] Instant deadline() const noexcept { return active_ ? deadline_ : never; }

    /// `patience`: until the answer counts as lost, the time on the wire included. Whatever was active before is forgotten.
    void begin(Request request, Instant now, Duration patience, int retries) {
        request_ = std::move(request);
        active_ = true;
        sent_ = now;
        patience_ = patience;
        deadline_ = now + patience;
        tries_ = 1;
        left_ = retries;
    }
    /// An answer has begun: the rest of it may take until `until`. Never sooner than it was.
    void extend(Instant until) noexcept { deadline_ = std::max(deadline_, until); }
    /// It must not be sent again, though its answer is still waited for (a stop has overtaken it).
    void no_repeats() noexcept { left_ = 0; }
    [[nodiscard]] bool repeatable() const noexcept { return left_ > 0; }

    /// Its answer is here. Returns it as it was, so that the next may begin while this one is worked on.
    Request answered(AdapterCounters& counters) {
        ++counters.exchanges;
        active_ = false;
        return request_;
    }
    /// Counts the time-out and the repeat.
    [[nodiscard]] Late on_deadline(Instant now, AdapterCounters& counters) noexcept {
        if (!active_ || now < deadline_) return Late::no;
        ++counters.timeouts;
        if (left_ <= 0) {
            active_ = false;
            return Late::over;
        }
        --left_;
        ++tries_;
        ++counters.retries;
        deadline_ = now + patience_;
        return Late::repeat;
    }
    /// Ends without an answer and without a count: the line went down, the drive was removed.
    void drop() noexcept { active_ = false; }

private:
    Request request_{};
    bool active_ = false;
    Instant sent_{}, deadline_ = never;
    Duration patience_{};
    int tries_ = 0, left_ = 0;
};

/// Where answers carry a mark (command word and index, object index and subindex, a sequence number): the marks of requests that were given
/// up, or sent twice, and may still be answered. A request with such a mark waits behind another exchange with the same drive: a drive
/// answers in order, so what comes after that one's answer is new; then `clear`. Full: the drive has been silent for so long that it counts
/// as absent; one more is not kept.
template <class Mark, std::size_t limit = 8>
class LateMarks {
public:
    void add(const Mark& mark) noexcept {
        if (!has(mark) && size_ < limit) marks_[size_++] = mark;
    }
    [[nodiscard]] bool has(const Mark& mark) const noexcept {
        return std::find(marks_.begin(), marks_.begin() + static_cast<std::ptrdiff_t>(size_), mark) !=
               marks_.begin() + static_cast<std::ptrdiff_t>(size_);
    }
    [[nodiscard]] bool none() const noexcept { return size_ == 0; }
    void clear() noexcept { size_ = 0; }

private:
    std::array<Mark, limit> marks_{};
    std::size_t size_ = 0;
};

/// Where answers carry no mark: until when a late one may still come, on one line or from one drive. What cannot be told from it waits.
class LateTime {
public:
    /// A request was given up at `now`; its answer may come for `time` more.
    void missed(Instant now, Duration time) noexcept { until_ = std::max(until_, now + time); }
    /// Whatever was late has come: an answer proved it (a drive answers in order), or the line was down.
    void settled() noexcept { until_ = Instant{}; }
    [[nodiscard]] bool over(Instant now) const noexcept { return now >= until_; }
    [[nodiscard]] Instant until() const noexcept { return until_; }

private:
    Instant until_{};
};

}  // namespace axisgate::drive
