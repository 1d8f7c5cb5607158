// SendQueue: the bounded queue of frames that wait for their line.
// In: frames with a priority, a sender and the instant at which they came. Out: the next one to send: urgent before command before poll,
// the senders' in turn. Never grows past its bound: a full queue refuses, except that an urgent frame pushes out the youngest of the least
// urgent ones, and a sender with less than its share the youngest of who has most.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gateway/core/frame.hpp"

namespace axisgate {

class SendQueue {
public:
    /// 256 frames of at most 256 bytes: 64 KiB.
    static constexpr std::size_t default_capacity = 256;
    /// Frame::sender beyond it counts as the last one.
    static constexpr std::size_t most_senders = 8;

    struct Entry {  // the frame last: what is read of a short one lies together
        Instant queued_at{};
        Priority priority = Priority::command;
        Frame frame;
    };

    explicit SendQueue(std::size_t capacity = default_capacity) noexcept : capacity_(capacity) {}

    /// False: full, the frame is not taken. `now` must not go backwards. Room is allocated as it is first needed and then kept.
    bool push(const Frame& frame, Priority priority, Instant now);
    /// The next frame to send among those that came at or before `t`; nullptr if there is none. Valid until the next push.
    [[nodiscard]] const Entry* front(Instant t = never) const noexcept;
    /// Removes what front(t) shows.
    void pop(Instant t = never) noexcept;
    /// Removes it, and `to` is its frame; there must be one.
    void take(Frame& to, Instant t) noexcept;
    /// The frames as they would leave, at most as many as `to` holds; returns how many. Valid until the next push.
    [[nodiscard]] std::size_t collect(std::span<const Entry*> to) const noexcept;
    /// When the first of the waiting frames came; `never` if none waits.
    [[nodiscard]] Instant earliest() const noexcept;
    /// Throws away what came before `t`, and returns how many that were.
    std::size_t drop_older_than(Instant t) noexcept;
    void clear() noexcept;

    [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    /// Frames pushed out by urgent ones, or by other senders', ever.
    [[nodiscard]] std::uint64_t displaced() const noexcept { return displaced_; }

private:
    using Index = std::uint32_t;
    static constexpr Index none = 0xFFFFFFFF;
    static constexpr std::size_t priorities = 3;
    struct Slot {
        Index next = none;
        Index previous = none;
        Entry entry;
    };
    struct List {
        Index head = none;
        Index tail = none;
    };

    [[nodiscard]] static std::size_t sender_of(const Frame& frame) noexcept;
    /// The sender of a priority from which to take at this turn of the senders.
    [[nodiscard]] std::size_t in_turn(std::size_t priority, std::size_t k) const noexcept {
        const std::size_t place = turn_[priority] + k;  // both below the number of senders
        return place < senders_ ? place : place - senders_;
    }
    [[nodiscard]] Index best(Instant t) const noexcept;
    void remove(Index i) noexcept;
    void unlink(Index i) noexcept;
    [[nodiscard]] bool make_room(Priority priority, std::size_t sender) noexcept;
    [[nodiscard]] bool push_out(std::size_t sender) noexcept;

    std::vector<Slot> slots_;
    std::size_t size_ = 0;
    std::size_t senders_ = 1;                              // seen so far
    std::array<std::uint32_t, priorities> of_priority_{};  // frames that wait
    std::array<std::uint32_t, priorities> turn_{};         // whose turn it is
    std::array<std::array<List, most_senders>, priorities> lists_;
    std::array<std::size_t, most_senders> waiting_{};  // by sender
    Index free_ = none;
    std::size_t capacity_;
    std::uint64_t displaced_ = 0;
};

}  // namespace axisgate
