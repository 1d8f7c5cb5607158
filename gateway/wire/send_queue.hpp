// SendQueue: the bounded queue of frames that wait for their line.
// In: frames with a priority and the instant at which they came. Out: the next one to send, urgent before command before poll.
// Never grows past its bound: a full queue refuses, except that an urgent frame pushes out the youngest of the least urgent ones.
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

    struct Entry {
        Frame frame;
        Priority priority = Priority::command;
        Instant queued_at{};
    };

    explicit SendQueue(std::size_t capacity = default_capacity) noexcept : capacity_(capacity) {}

    /// False: full, the frame is not taken. `now` must not go backwards. Room is allocated as it is first needed and then kept.
    bool push(const Frame& frame, Priority priority, Instant now);
    /// The next frame to send among those that came at or before `t`; nullptr if there is none. Valid until the next push.
    [[nodiscard]] const Entry* front(Instant t = never) const noexcept;
    /// Removes what front(t) shows.
    void pop(Instant t = never) noexcept;
    /// The frames as they would leave, at most as many as `to` holds; returns how many. Valid until the next push.
    [[nodiscard]] std::size_t collect(std::span<const Entry*> to) const noexcept;
    /// When the first of the waiting frames came; `never` if none waits.
    [[nodiscard]] Instant earliest() const noexcept;
    /// Throws away what came before `t`, and returns how many that were.
    std::size_t drop_older_than(Instant t) noexcept;
    void clear() noexcept;

    [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    /// Frames pushed out by urgent ones, ever.
    [[nodiscard]] std::uint64_t displaced() const noexcept { return displaced_; }

private:
    using Index = std::uint32_t;
    static constexpr Index none = 0xFFFFFFFF;
    static constexpr std::size_t priorities = 3;
    struct Slot {
        Entry entry;
        Index next = none;
        Index previous = none;
    };
    struct List {
        Index head = none;
        Index tail = none;
    };

    [[nodiscard]] Index best(Instant t) const noexcept;
    void unlink(Index i) noexcept;
    [[nodiscard]] bool make_room(Priority priority) noexcept;

    std::size_t capacity_;
    std::vector<Slot> slots_;
    std::array<List, priorities> lists_;
    Index free_ = none;
    std::size_t size_ = 0;
    std::uint64_t displaced_ = 0;
};

}  // namespace axisgate
