// Records of the hot thread on their way to the service thread, as bytes in one ring that never grows. A record that finds no space is lost
// and counted. Neither side waits.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>

#include "gateway/engine/flight_record.hpp"

namespace axisgate {

class RecordRing {
public:
    /// `size`: bytes, a power of two.
    explicit RecordRing(std::size_t size) : size_(size), bytes_(std::make_unique_for_overwrite<char[]>(size)) {}

    /// Sender's thread. Returns false if the record is lost.
    bool push(const FlightRecord& r) noexcept {
        const Head head{static_cast<std::uint32_t>(r.payload.size()), r.index, r.kind, ns_of(r.at)};
        const std::size_t need = sizeof head + r.payload.size();
        const std::size_t end = end_.load(std::memory_order_relaxed);
        if (need > size_ - (end - begin_.load(std::memory_order_acquire))) {
            lost_.fetch_add(1, std::memory_order_relaxed);
            return false;
        }
        write(end, &head, sizeof head);
        write(end + sizeof head, r.payload.data(), r.payload.size());
        end_.store(end + need, std::memory_order_release);
        return true;
    }
    /// Receiver's thread: calls `f` with each present record, up to this number; its payload is valid during the call. Returns true if no
    /// record is left.
    template <class F>
    bool empty(F&& f, std::size_t most = SIZE_MAX) {
        std::size_t begin = begin_.load(std::memory_order_relaxed);
        const std::size_t end = end_.load(std::memory_order_acquire);
        for (; begin != end && most > 0; --most) {
            Head head{};
            read(begin, &head, sizeof head);
            room_.resize(head.size);
            read(begin + sizeof head, room_.data(), head.size);
            begin += sizeof head + head.size;
            begin_.store(begin, std::memory_order_release);
            f(FlightRecord{head.kind, head.index, at_ns(head.at), room_});
        }
        return begin == end;
    }
    [[nodiscard]] std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

private:
    struct Head {
        std::uint32_t size;
        std::uint16_t index;
        FlightKind kind;
        std::int64_t at;
    };
    void write(std::size_t at, const void* data, std::size_t n) noexcept {
        if (n == 0) return;
        const std::size_t place = at & (size_ - 1), first = std::min(n, size_ - place);
        std::memcpy(bytes_.get() + place, data, first);
        std::memcpy(bytes_.get(), static_cast<const char*>(data) + first, n - first);
    }
    void read(std::size_t at, void* data, std::size_t n) const noexcept {
        if (n == 0) return;
        const std::size_t place = at & (size_ - 1), first = std::min(n, size_ - place);
        std::memcpy(data, bytes_.get() + place, first);
        std::memcpy(static_cast<char*>(data) + first, bytes_.get(), n - first);
    }

    std::size_t size_;
    std::unique_ptr<char[]> bytes_;
    std::string room_;
    alignas(64) std::atomic<std::size_t> begin_{0};
    alignas(64) std::atomic<std::size_t> end_{0};
    std::atomic<std::uint64_t> lost_{0};
};

}  // namespace axisgate
