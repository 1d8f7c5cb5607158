// The containers of Turns: a heap of deadlines and rings of waiting drives, by slots 0..slot_limit-1. Changes of a deadline take O(log n).
// The size is fixed and no memory is allocated.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "gateway/core/instant.hpp"

namespace axisgate::drive {

inline constexpr std::size_t slot_limit = 256;  ///< drives of one line; a further drive is reported as one too many

/// A binary heap of slots by instant. The position of each slot is stored, so that its instant can be changed.
class DeadlineHeap {
public:
    DeadlineHeap() noexcept { clear(); }
    void clear() noexcept {
        size_ = 0;
        place_.fill(none);
    }
    [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
    [[nodiscard]] Instant earliest() const noexcept { return size_ == 0 ? never : when_[heap_[0]]; }
    [[nodiscard]] std::size_t first() const noexcept { return heap_[0]; }

    /// Adds a slot or changes its instant; `never` removes it.
    void set(std::size_t slot, Instant at) noexcept {
        const std::uint16_t place = place_[slot];
        if (at == never) {
            if (place != none) take_out(place);
            return;
        }
        if (place == none) {
            when_[slot] = at;
            heap_[size_] = static_cast<std::uint16_t>(slot);
            place_[slot] = static_cast<std::uint16_t>(size_);
            up(size_++);
            return;
        }
        const Instant before = when_[slot];
        when_[slot] = at;
        at < before ? up(place) : down(place);
    }

private:
    static constexpr std::uint16_t none = 0xFFFF;
    void put(std::size_t place, std::uint16_t slot) noexcept {
        heap_[place] = slot;
        place_[slot] = static_cast<std::uint16_t>(place);
    }
    void up(std::size_t place) noexcept {
        const std::uint16_t slot = heap_[place];
        while (place > 0) {
            const std::size_t parent = (place - 1) / 2;
            if (when_[heap_[parent]] <= when_[slot]) break;
            put(place, heap_[parent]);
            place = parent;
        }
        put(place, slot);
    }
    void down(std::size_t place) noexcept {
        const std::uint16_t slot = heap_[place];
        for (;;) {
            std::size_t child = 2 * place + 1;
            if (child >= size_) break;
            if (child + 1 < size_ && when_[heap_[child + 1]] < when_[heap_[child]]) ++child;
            if (when_[slot] <= when_[heap_[child]]) break;
            put(place, heap_[child]);
            place = child;
        }
        put(place, slot);
    }
    void take_out(std::size_t place) noexcept {
        place_[heap_[place]] = none;
        --size_;
        if (place == size_) return;
        const std::uint16_t moved = heap_[size_];
        put(place, moved);
        up(place);
        down(place_[moved]);
    }

    std::array<Instant, slot_limit> when_{};
    std::array<std::uint16_t, slot_limit> heap_{};
    std::array<std::uint16_t, slot_limit> place_{};
    std::size_t size_ = 0;
};

/// Slots in order of arrival. The caller makes sure that a slot is not in the ring twice.
class Ring {
public:
    [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
    void push(std::size_t slot) noexcept {
        slots_[(first_ + size_) % slot_limit] = static_cast<std::uint16_t>(slot);
        ++size_;
    }
    [[nodiscard]] std::size_t pop() noexcept {
        const std::size_t slot = slots_[first_];
        first_ = (first_ + 1) % slot_limit;
        --size_;
        return slot;
    }
    void clear() noexcept { first_ = size_ = 0; }

private:
    std::array<std::uint16_t, slot_limit> slots_{};
    std::size_t first_ = 0, size_ = 0;
};

}  // namespace axisgate::drive
