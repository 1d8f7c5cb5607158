// The content of a line: one CAN frame, one CAN error report, or a run of bytes, with the instant at which it was seen. The meaning of a
// frame is known only in adapters/<family>. No memory is allocated.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string>

#include "gateway/core/instant.hpp"

namespace axisgate {

struct Frame {
    enum class Kind : std::uint8_t {
        can,        ///< `id`, `extended`, `remote`, 0..8 bytes
        can_error,  ///< a report of the CAN controller; `id` has the error class bits of linux/can/error.h, with 8 bytes of detail
        bytes       ///< a run of 1..capacity bytes of a byte stream; the boundaries of runs have no meaning
    };
    static constexpr std::size_t capacity = 256;

    Instant at{};
    Kind kind = Kind::bytes;
    bool extended = false;
    bool remote = false;
    /// The adapter on the gateway's line that sends it: waiting frames are sent in turn by sender. Not a part of the frame on the wire; 0
    /// if there is one.
    std::uint8_t sender = 0;
    std::uint16_t size = 0;
    std::uint32_t id = 0;                        ///< 11 or 29 bits; 0 for bytes
    std::array<std::uint8_t, capacity> storage;  // deliberately not cleared: `size` is the number of valid bytes

    Frame() noexcept {}  // NOLINT(modernize-use-equals-default): `= default` would clear `storage` in value-initialisation
    Frame(const Frame& o) noexcept { *this = o; }
    Frame& operator=(const Frame& o) noexcept {
        at = o.at;
        kind = o.kind;
        extended = o.extended;
        remote = o.remote;
        sender = o.sender;
        size = o.size;
        id = o.id;
        // Copies the bytes of a CAN frame at once, whatever their number is, without a call.
        if (o.size <= 8) {
            std::memcpy(storage.data(), o.storage.data(), 8);
        } else {
            std::memmove(storage.data(), o.storage.data(), o.size);
        }
        return *this;
    }

    /// One CAN data frame with a 29-bit identifier. Bytes beyond 8 are dropped.
    [[nodiscard]] static Frame can_extended(std::uint32_t id, std::span<const std::uint8_t> data) noexcept {
        Frame f;
        f.kind = Kind::can;
        f.extended = true;
        f.id = id & 0x1FFFFFFFu;
        f.assign(data.first(std::min<std::size_t>(data.size(), 8)));
        return f;
    }
    /// A run of bytes. Bytes beyond `capacity` are dropped: split longer runs with `for_each_run`.
    [[nodiscard]] static Frame run(std::span<const std::uint8_t> data) noexcept {
        Frame f;
        f.kind = Kind::bytes;
        f.assign(data);
        return f;
    }

    [[nodiscard]] std::span<const std::uint8_t> data() const noexcept { return {storage.data(), size}; }
    void assign(std::span<const std::uint8_t> data) noexcept {
        size = static_cast<std::uint16_t>(std::min(data.size(), capacity));
        if (size > 0) std::memcpy(storage.data(), data.data(), size);
    }

    /// True if the content is equal; the instant is not compared.
    [[nodiscard]] bool same(const Frame& o) const noexcept {
        return kind == o.kind && extended == o.extended && remote == o.remote && id == o.id && std::ranges::equal(data(), o.data());
    }
};

/// `04280095#01` for CAN (candump's form), `AA 05 95` for bytes, `error 00000040#...` for controller reports.
[[nodiscard]] std::string to_text(const Frame& frame);

/// Calls `f(Frame)` for pieces of `data` that fit a Frame each, in order.
template <class F>
void for_each_run(std::span<const std::uint8_t> data, F&& f) {
    while (!data.empty()) {
        const auto n = std::min(data.size(), Frame::capacity);
        f(Frame::run(data.first(n)));
        data = data.subspan(n);
    }
}

/// The order in which frames that wait for the same line are sent. `urgent` is only for stop, quick stop and disable.
enum class Priority : std::uint8_t { urgent, command, poll };

/// One recorded frame.
struct TraceEntry {
    std::uint64_t sequence = 0;  ///< increases per line; a gap means that older ones were overwritten
    std::int64_t at_unix_ns = 0;
    bool to_drive = false;
    bool simulated = false;  ///< on the twin bus, not on the cable
    Frame frame;
};

}  // namespace axisgate
