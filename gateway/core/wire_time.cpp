// Wire time: see wire_time.hpp. In: frames. Out: bit counts.
// Never allocates; one pass over the bits of the frame.
#include "gateway/core/wire_time.hpp"

namespace axisgate {
namespace {

/// Takes the bits of a frame as they are sent and keeps count, checksum and stuff bits.
class BitStream {
public:
    void put(std::uint32_t value, unsigned width) noexcept {
        while (width-- > 0) {
            const std::uint32_t bit = (value >> width) & 1u;
            crc_ = ((crc_ << 1) & 0x7FFFu) ^ (((crc_ >> 14) ^ bit) != 0 ? 0x4599u : 0u);
            stuff(bit);
        }
    }
    /// The checksum itself is stuffed like the rest but does not go into the checksum.
    void put_crc() noexcept {
        const std::uint32_t crc = crc_;
        for (unsigned i = 15; i-- > 0;)
            stuff((crc >> i) & 1u);
    }
    [[nodiscard]] std::uint32_t count() const noexcept { return count_; }
    [[nodiscard]] std::uint16_t crc() const noexcept { return static_cast<std::uint16_t>(crc_); }

private:
    void stuff(std::uint32_t bit) noexcept {
        ++count_;
        run_ = bit == last_ ? run_ + 1 : 1;
        last_ = bit;
        if (run_ == 5) {  // the sender inserts the opposite bit, which begins the next run
            ++count_;
            last_ = bit ^ 1u;
            run_ = 1;
        }
    }
    std::uint32_t crc_ = 0;
    std::uint32_t count_ = 0;
    std::uint32_t last_ = 2;  // no bit yet: the bus was idle, and idle bits are not part of the frame
    unsigned run_ = 0;
};

BitStream head_and_data(const Frame& f) noexcept {
    BitStream s;
    const std::uint32_t remote = f.remote ? 1u : 0u;
    const std::uint32_t length = f.size > 8 ? 8u : f.size;
    s.put(0, 1);  // start of frame
    if (f.extended) {
        s.put((f.id >> 18) & 0x7FFu, 11);
        s.put(3, 2);  // substitute remote request, identifier extension: both recessive
        s.put(f.id & 0x3FFFFu, 18);
        s.put(remote, 1);
        s.put(0, 2);  // r1, r0
    } else {
        s.put(f.id & 0x7FFu, 11);
        s.put(remote, 1);
        s.put(0, 2);  // identifier extension dominant, r0
    }
    s.put(length, 4);
    if (!f.remote) {
        for (std::uint32_t i = 0; i < length; ++i)
            s.put(f.storage[i], 8);
    }
    return s;
}

// Checksum delimiter, acknowledge slot and delimiter, seven bits of end of frame: never stuffed.
constexpr std::uint32_t tail_bits = 1 + 1 + 1 + 7;

}  // namespace

std::uint32_t can_bits(const Frame& frame) noexcept {
    BitStream s = head_and_data(frame);
    s.put_crc();
    return s.count() + tail_bits;
}

std::uint16_t can_crc(const Frame& frame) noexcept { return head_and_data(frame).crc(); }

std::uint32_t can_arbitration(const Frame& f) noexcept {
    const std::uint32_t remote = f.remote ? 1u : 0u;
    if (!f.extended) return (f.id & 0x7FFu) << 21 | remote << 20;
    // The bit where a standard frame has its remote request is recessive here, and so is the next, where it has a dominant one.
    return ((f.id >> 18) & 0x7FFu) << 21 | 1u << 20 | 1u << 19 | (f.id & 0x3FFFFu) << 1 | remote;
}

}  // namespace axisgate
