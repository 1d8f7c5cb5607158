// Exchange is one outstanding request with its time-out and its repetitions; LateMarks and LateTime remember which answers to abandoned
// requests may still arrive. An exchange does not send and does not decide whether an answer fits: the family does both. An exchange
// allocates no memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "gateway/core/adapter.hpp"

namespace axisgate::drive {

/// The state of an exchange after some time has passed.
enum class Late : std::uint8_t {
    no,      ///< the time-out has not expired
    repeat,  ///< the request is to be sent again now; the new deadline is set
    over     ///< the exchange has ended without an answer
};

/// `Request` is a type of the family: the message, and its purpose (so that the answer finds the requester).
template <class Request>
class Exchange {
public:
    [[nodiscard]] bool active() const noexcept { return active_; }
    /// The outstanding request, or the last one if none is outstanding.
    [[nodiscard]] const Request& request() const noexcept { return request_; }
    [[nodiscard]] Request& request() noexcept { return request_; }
    [[nodiscard]] Instant sent() const noexcept { return sent_; }  ///< first transmission
    [[nodiscard]] int tries() const noexcept { return tries_; }
    [[nodiscard]] Instant deadline() const noexcept { return active_ ? deadline_ : never; }

    /// `patience` is the time after which the answer counts as lost, including the transmission time. A request that was outstanding before
    /// is forgotten.
    void begin(Request request, Instant now, Duration patience, int retries) {
        request_ = std::move(request);
        active_ = true;
        sent_ = now;
        patience_ = patience;
        deadline_ = now + patience;
        tries_ = 1;
        left_ = retries;
    }
    /// The first bytes of the answer have arrived; the rest may take until `until`. The deadline never becomes earlier.
    void extend(Instant until) noexcept { deadline_ = std::max(deadline_, until); }
    /// The request must not be repeated, but its answer is still expected (a stop has overtaken it).
    void no_repeats() noexcept { left_ = 0; }
    [[nodiscard]] bool repeatable() const noexcept { return left_ > 0; }

    /// Ends the exchange because its answer has arrived. Returns the request, so that the next exchange can begin while the answer is
    /// evaluated.
    Request answered(AdapterCounters& counters) {
        ++counters.exchanges;
        active_ = false;
        return request_;
    }
    /// Counts time-outs and repetitions.
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
    /// Ends the exchange without an answer and without counting it: the line went down or the drive was removed.
    void drop() noexcept { active_ = false; }

private:
    Request request_{};
    bool active_ = false;
    Instant sent_{}, deadline_ = never;
    Duration patience_{};
    int tries_ = 0, left_ = 0;
};

/// For protocols whose answers carry a mark (command word and index, object index and subindex, sequence number): the marks of requests
/// that were abandoned or sent twice and may still be answered. A request with such a mark waits until another exchange with the same drive
/// has ended: the drive answers in order, so all later answers are new, and `clear` is called. If the list is full, the mark is not stored;
/// by then the drive has been silent for so long that it counts as absent.
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

/// For protocols whose answers carry no mark: the time until which a late answer may arrive, on a line or from a drive. Requests whose
/// answers cannot be distinguished from it wait until then.
class LateTime {
public:
    /// A request was abandoned at `now`; its answer may arrive during the following `time`.
    void missed(Instant now, Duration time) noexcept { until_ = std::max(until_, now + time); }
    /// No late answer can arrive any more: an answer has proved it (the drive answers in order), or the line was down.
    void settled() noexcept { until_ = Instant{}; }
    [[nodiscard]] bool over(Instant now) const noexcept { return now >= until_; }
    [[nodiscard]] Instant until() const noexcept { return until_; }

private:
    Instant until_{};
};

}  // namespace axisgate::drive
