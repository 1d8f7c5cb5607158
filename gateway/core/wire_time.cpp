// Counts the bits of a frame, including stuffed ones, two to eight bits at a time, without allocating memory.
#include "gateway/core/wire_time.hpp"

#include <array>

namespace axisgate {
namespace {

/// Bit stuffing: after five equal bits the sender inserts the opposite one, which begins the next run.
struct Stuffing {
    std::uint8_t last, run;  ///< the end of a run of five is past; state 0 is that after the start of frame
    std::uint8_t count;

    constexpr void put(std::uint32_t bit) noexcept {
        ++count;
        run = bit == last ? static_cast<std::uint8_t>(run + 1) : std::uint8_t{1};
        last = static_cast<std::uint8_t>(bit);
        if (run < 5) return;
        ++count;
        last ^= 1;
        run = 1;
    }
    [[nodiscard]] constexpr std::size_t state() const noexcept { return last * 4u + run - 1u; }
};

constexpr std::uint32_t crc_of_bit(std::uint32_t crc, std::uint32_t bit) noexcept {
    return ((crc << 1) & 0x7FFFu) ^ (((crc >> 14) ^ bit) != 0 ? 0x4599u : 0u);
}

/// The effect of this number of bits, for each state: the length that they grow to, and in the low three bits the next state.
template <unsigned width>
struct OfBits {
    std::array<std::array<std::uint8_t, 1u << width>, 8> stuffing{};
    std::array<std::uint16_t, 1u << width> crc{};

    constexpr OfBits() noexcept {
        for (std::uint32_t bits = 0; bits < 1u << width; ++bits) {
            std::uint32_t c = bits << (15 - width);
            for (unsigned i = 0; i < width; ++i)
                c = crc_of_bit(c, 0);
            crc[bits] = static_cast<std::uint16_t>(c);
            for (std::uint8_t state = 0; state < 8; ++state) {
                Stuffing s{static_cast<std::uint8_t>(state / 4), static_cast<std::uint8_t>(state % 4 + 1), 0};
                for (unsigned i = width; i-- > 0;)
                    s.put((bits >> i) & 1u);
                stuffing[state][bits] = static_cast<std::uint8_t>(s.count << 3 | s.state());
            }
        }
    }
};
template <unsigned width>
constexpr OfBits<width> of_bits{};

/// Takes the bits of a frame in the order of sending, from behind the start of frame, and keeps count, checksum and stuff bits.
class BitStream {
public:
    /// The low `width` bits, the highest first: whole bytes, with 2 or 6 behind them.
    void put(std::uint64_t value, unsigned width) noexcept {
        for (; width >= 8; width -= 8)
            take<8>(static_cast<std::uint32_t>(value >> (width - 8)) & 0xFFu);
        if (width == 6) take<6>(static_cast<std::uint32_t>(value) & 0x3Fu);
        if (width == 2) take<2>(static_cast<std::uint32_t>(value) & 0x3u);
    }
    /// The checksum itself is stuffed like the rest but is not included in the checksum.
    void put_crc() noexcept {
        stuff<8>(crc_ >> 7);
        stuff<7>(crc_ & 0x7Fu);
    }
    [[nodiscard]] std::uint32_t count() const noexcept { return count_; }
    [[nodiscard]] std::uint16_t crc() const noexcept { return static_cast<std::uint16_t>(crc_); }

private:
    template <unsigned width>
    void take(std::uint32_t bits) noexcept {
        crc_ = ((crc_ << width) & 0x7FFFu) ^ of_bits<width>.crc[(crc_ >> (15 - width)) ^ bits];
        stuff<width>(bits);
    }
    template <unsigned width>
    void stuff(std::uint32_t bits) noexcept {
        const std::uint32_t then = of_bits<width>.stuffing[state_][bits];
        state_ = then & 7u;
        count_ += then >> 3;
    }
    std::uint32_t crc_ = 0;  // the start of frame, a 0, does not change it
    std::uint32_t state_ = 0, count_ = 1;
};

BitStream head_and_data(const Frame& f) noexcept {
    BitStream s;
    const std::uint64_t remote = f.remote ? 1u : 0u;
    const std::uint64_t length = f.size > 8 ? 8u : f.size;
    if (f.extended) {  // between the halves of the identifier, both recessive: substitute remote request, identifier extension; r1, r0
        s.put((f.id >> 18 & 0x7FFull) << 27 | 3ull << 25 | (f.id & 0x3FFFFull) << 7 | remote << 6 | length, 38);
    } else {  // identifier extension dominant, r0
        s.put((f.id & 0x7FFull) << 7 | remote << 6 | length, 18);
    }
    if (!f.remote) {
        for (std::uint64_t i = 0; i < length; ++i)
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
