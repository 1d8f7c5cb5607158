// The bounded queue of frames that wait for their line. Urgent frames are sent before commands, commands before polls, and senders take
// turns. A full queue refuses a frame, with two exceptions: an urgent frame replaces the youngest of the least urgent ones, and a sender
// with less than its share replaces the youngest frame of the sender that has most.
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
    /// A Frame::sender beyond this counts as the last one.
    static constexpr std::size_t most_senders = 8;

    struct Entry {  // the frame is last, so that the bytes of a short one are close to the other members
        Instant queued_at{};
        Priority priority = Priority::command;
        Frame frame;
    };

    explicit SendQueue(std::size_t capacity = default_capacity) noexcept : capacity_(capacity) {}

    /// Returns false if the queue is full. `now` must not decrease. Memory is allocated when it is first needed and then kept.
    bool push(const Frame& frame, Priority priority, Instant now);
    /// The next frame to send among those that came at or before `t`; nullptr if there is none. Valid until the next push.
    [[nodiscard]] const Entry* front(Instant t = never) const noexcept;
    /// Removes the frame that front(t) returns.
    void pop(Instant t = never) noexcept;
    /// Removes it and copies it to `to`; there must be one.
    void take(Frame& to, Instant t) noexcept;
    /// The frames in the order of sending, at most as many as `to` holds; returns their number. Valid until the next push.
    [[nodiscard]] std::size_t collect(std::span<const Entry*> to) const noexcept;
    /// When the first of the waiting frames came; `never` if none waits.
    [[nodiscard]] Instant earliest() const noexcept;
    /// Removes frames that came before `t` and returns their number.
    std::size_t drop_older_than(Instant t) noexcept;
    void clear() noexcept;

    [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    /// Total number of frames replaced by urgent ones, or by those of other senders.
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
    /// The sender of a priority whose turn it is.
    [[nodiscard]] std::size_t in_turn(std::size_t priority, std::size_t k) const noexcept {
        const std::size_t place = turn_[priority] + k;  // both are below the number of senders
        return place < senders_ ? place : place - senders_;
    }
    [[nodiscard]] Index best(Instant t) const noexcept;
    void remove(Index i) noexcept;
    void unlink(Index i) noexcept;
    [[nodiscard]] bool make_room(Priority priority, std::size_t sender) noexcept;
    [[nodiscard]] bool push_out(std::size_t sender) noexcept;

    std::vector<Slot> slots_;
    std::size_t size_ = 0;
    std::size_t senders_ = 1;                              // number of senders so far
    std::array<std::uint32_t, priorities> of_priority_{};  // number of waiting frames
    std::array<std::uint32_t, priorities> turn_{};         // the sender whose turn it is
    std::array<std::array<List, most_senders>, priorities> lists_;
    std::array<std::size_t, most_senders> waiting_{};  // by sender
    Index free_ = none;
    std::size_t capacity_;
    std::uint64_t displaced_ = 0;
};

}  // namespace axisgate
