// A ring that one thread writes without a lock and any thread can copy. Neither side ever waits.
#include "gateway/wire/frame_log.hpp"

#include <algorithm>

namespace axisgate {
namespace {

// The header word: identifier, size, then kind and flags.
constexpr unsigned size_shift = 32, kind_shift = 48;
constexpr std::uint64_t extended_bit = 1ull << 52, remote_bit = 1ull << 53, to_drive_bit = 1ull << 54, simulated_bit = 1ull << 55;

// The version of a slot while it is being written, and when it is complete.
constexpr std::uint64_t writing(std::uint64_t sequence) noexcept { return sequence << 1 | 1; }
constexpr std::uint64_t whole(std::uint64_t sequence) noexcept { return sequence << 1; }

}  // namespace

FrameLog::FrameLog(std::size_t capacity, std::size_t max_bytes)
    : capacity_(std::max<std::size_t>(capacity, 1)),
      max_bytes_(std::clamp<std::size_t>(max_bytes, 1, Frame::capacity)),
      stride_(head_words + (max_bytes_ + 7) / 8),
      words_(std::make_unique<Word[]>(capacity_ * stride_)) {}

void FrameLog::record(const Frame& frame, bool to_drive, bool simulated) noexcept {
    const std::uint64_t header = frame.id | std::uint64_t{static_cast<std::uint8_t>(frame.kind)} << kind_shift |
                                 (frame.extended ? extended_bit : 0) | (frame.remote ? remote_bit : 0) | (to_drive ? to_drive_bit : 0) |
                                 (simulated ? simulated_bit : 0);
    auto data = frame.data();
    // A remote frame has a length but no bytes, so its storage was never initialized.
    if (frame.remote) {
        const std::array<std::uint8_t, 8> nothing{};
        write(std::span(nothing).first(std::min<std::size_t>({data.size(), nothing.size(), max_bytes_})), header, frame.at);
        return;
    }
    do {
        const auto piece = data.first(std::min(data.size(), max_bytes_));
        write(piece, header, frame.at);
        data = data.subspan(piece.size());
    } while (!data.empty());
}

void FrameLog::write(std::span<const std::uint8_t> data, std::uint64_t header, Instant at) noexcept {
    const std::uint64_t sequence = next_.load(std::memory_order_relaxed);
    Word* w = slot(sequence);
    w[0].store(writing(sequence), std::memory_order_relaxed);
    // Each store is a release: a reader that sees any of these words then also sees that the version has changed.
    w[1].store(static_cast<std::uint64_t>(ns_of(at)), std::memory_order_release);
    w[2].store(header | std::uint64_t{data.size()} << size_shift, std::memory_order_release);
    for (std::size_t i = 0; i < data.size(); i += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, data.data() + i, std::min<std::size_t>(8, data.size() - i));
        w[head_words + i / 8].store(word, std::memory_order_release);
    }
    w[0].store(whole(sequence), std::memory_order_release);
    next_.store(sequence + 1, std::memory_order_release);
}

bool FrameLog::copy(std::uint64_t sequence, TraceEntry& to) const noexcept {
    const Word* w = slot(sequence);
    if (w[0].load(std::memory_order_acquire) != whole(sequence)) return false;
    const std::uint64_t at = w[1].load(std::memory_order_acquire);
    const std::uint64_t header = w[2].load(std::memory_order_acquire);
    const std::size_t size = std::min<std::size_t>((header >> size_shift) & 0xFFFFu, max_bytes_);
    for (std::size_t i = 0; i < size; i += 8) {
        const std::uint64_t word = w[head_words + i / 8].load(std::memory_order_acquire);
        std::memcpy(to.frame.storage.data() + i, &word, std::min<std::size_t>(8, size - i));
    }
    if (w[0].load(std::memory_order_relaxed) != whole(sequence)) return false;
    to.sequence = sequence;
    to.to_drive = (header & to_drive_bit) != 0;
    to.simulated = (header & simulated_bit) != 0;
    to.frame.at = at_ns(static_cast<std::int64_t>(at));
    to.frame.kind = static_cast<Frame::Kind>((header >> kind_shift) & 0xFu);
    to.frame.extended = (header & extended_bit) != 0;
    to.frame.remote = (header & remote_bit) != 0;
    to.frame.size = static_cast<std::uint16_t>(size);
    to.frame.id = static_cast<std::uint32_t>(header);
    return true;
}

FrameLog::Reading FrameLog::read(std::uint64_t since, std::size_t limit, std::int64_t unix_offset_ns) const {
    Reading r;
    const std::uint64_t end = next_sequence();
    const std::uint64_t asked = std::clamp<std::uint64_t>(since, 1, end);
    const std::uint64_t oldest = end > capacity_ ? end - capacity_ : 1;
    const std::uint64_t from = std::max(asked, oldest);
    const std::uint64_t until = from + std::min<std::uint64_t>(end - from, limit);
    r.missed = from - asked;
    r.next = until;
    r.entries.reserve(static_cast<std::size_t>(until - from));
    for (std::uint64_t sequence = from; sequence < until; ++sequence) {
        TraceEntry& entry = r.entries.emplace_back();
        if (copy(sequence, entry)) {
            entry.at_unix_ns = ns_of(entry.frame.at) + unix_offset_ns;
        } else {  // the writer has overwritten the slot meanwhile
            r.entries.pop_back();
            ++r.missed;
        }
    }
    return r;
}

FrameLog::Reading FrameLog::read_newest(std::size_t limit, std::int64_t unix_offset_ns) const {
    const std::uint64_t end = next_sequence();
    const std::uint64_t many = std::min<std::uint64_t>({limit, capacity_, end - 1});
    return read(end - many, limit, unix_offset_ns);
}

}  // namespace axisgate
