// A frame ends with a silence of the line. An echo is compared byte by byte; bytes that turn out not to be an echo are added to the frame
// as if they had just arrived. The beginning of a frame is never searched for within a run of bytes.
#include "gateway/doors/modbus/rtu_receiver.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "gateway/core/wire_time.hpp"

namespace axisgate::modbus {
namespace {
constexpr std::array<std::uint16_t, 256> crc_table = [] {
    std::array<std::uint16_t, 256> table{};
    for (unsigned i = 0; i < 256; ++i) {
        unsigned crc = i;
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc & 1u) != 0 ? (crc >> 1) ^ 0xA001u : crc >> 1;
        table[i] = static_cast<std::uint16_t>(crc);
    }
    return table;
}();
constexpr std::uint32_t fastest_counted_baud = 19200;  // above it the pauses have fixed lengths
/// Only this gateway sends its answers, so a late copy is an echo, too, from an adapter that collects bytes.
constexpr Duration echo_limit = std::chrono::seconds(1);
/// An answer that repeats its request, on a port of which it is not known whether it echoes: bytes that arrive within this time are not a
/// new request. (USB adapters collect bytes for up to 16 ms.) If an echo were taken for a request, it would be answered, and the echo of
/// that answer again, without end.
constexpr Duration unknown_echo_limit = std::chrono::milliseconds(50);
}  // namespace

std::uint16_t rtu_crc(std::span<const std::uint8_t> bytes) noexcept {
    unsigned crc = 0xFFFF;
    for (const std::uint8_t b : bytes)
        crc = (crc >> 8) ^ crc_table[(crc ^ b) & 0xFFu];
    return static_cast<std::uint16_t>(crc);
}

RtuTiming RtuTiming::of(std::uint32_t baud, unsigned bits_per_byte) noexcept {
    RtuTiming t;
    t.character = wire_time(bits_per_byte, baud);
    const bool fixed = baud > fastest_counted_baud;
    t.t15 = fixed ? Duration(std::chrono::microseconds(750)) : wire_time(std::uint64_t{bits_per_byte} * 3, baud) / 2;
    t.t35 = fixed ? Duration(std::chrono::microseconds(1750)) : wire_time(std::uint64_t{bits_per_byte} * 7, baud) / 2;
    return t;
}

Instant RtuReceiver::deadline() const noexcept { return busy() ? last_ + timing_.t35 : never; }

bool RtuReceiver::whole() const noexcept {
    if (overlong_ || size_ < rtu_min_frame) return false;
    const auto body = std::span(buffer_).first(size_ - 2);
    const std::uint16_t crc = rtu_crc(body);
    return buffer_[size_ - 2] == (crc & 0xFF) && buffer_[size_ - 1] == (crc >> 8);
}

std::optional<RtuFrame> RtuReceiver::take() noexcept {
    std::optional<RtuFrame> frame;
    if (whole()) {
        frame.emplace();
        frame->address = buffer_[0];
        frame->size = static_cast<std::uint8_t>(size_ - 3);
        std::copy_n(buffer_.begin() + 1, frame->size, frame->bytes.begin());
        counters_.frames.add();
        if (unechoed_ && echo_ == Echo::unknown) echo_ = Echo::absent;  // a correct frame of another sender came first
    } else if (overlong_) {
        counters_.overlong.add();
    } else if (size_ > 0) {
        counters_.bad_frames.add();
    }
    unechoed_ = false;
    size_ = 0;
    overlong_ = false;
    return frame;
}

void RtuReceiver::put(std::uint8_t byte) noexcept {
    if (size_ == buffer_.size()) {
        overlong_ = true;
    } else {
        buffer_[size_++] = byte;
    }
}

/// The bytes since the answer are not its echo: they are the beginning of another frame.
void RtuReceiver::no_echo() noexcept {
    const std::size_t n = std::exchange(matched_, 0);
    echo_size_ = 0;
    for (std::size_t i = 0; i < n; ++i)
        put(echo_bytes_[i]);
}

std::optional<RtuFrame> RtuReceiver::feed(std::span<const std::uint8_t> bytes, Instant at) noexcept {
    std::optional<RtuFrame> before;
    if (bytes.empty()) return before;
    if (deadline() <= at) {
        if (matched_ > 0) no_echo();
        if (whole()) before = take();
    } else if (busy() && at - last_ > timing_.t15 + timing_.character * static_cast<std::int64_t>(bytes.size())) {
        counters_.gaps.add();
    }
    if (echo_size_ > 0 && matched_ == 0 && at > echo_until_) no_echo();
    last_ = at;
    for (const std::uint8_t b : bytes) {
        if (echo_size_ > 0 && b == echo_bytes_[matched_]) {
            if (++matched_ < echo_size_) continue;
            echo_size_ = matched_ = 0;
            unechoed_ = false;
            echo_ = Echo::present;
            counters_.echoes.add();
            continue;
        }
        if (echo_size_ > 0) no_echo();
        put(b);
    }
    return before;
}

std::optional<RtuFrame> RtuReceiver::on_silence(Instant now) noexcept {
    if (now < deadline()) return std::nullopt;
    if (matched_ > 0) no_echo();
    return take();
}

void RtuReceiver::sent(std::span<const std::uint8_t> adu, bool repeats_request, Instant now) noexcept {
    if (adu.size() > echo_bytes_.size() || (repeats_request && echo_ == Echo::absent)) return;
    if (matched_ > 0) no_echo();
    std::copy(adu.begin(), adu.end(), echo_bytes_.begin());
    echo_size_ = adu.size();
    unechoed_ = true;
    const bool ambiguous = repeats_request && echo_ == Echo::unknown;
    echo_until_ = now + timing_.character * static_cast<std::int64_t>(adu.size()) + (ambiguous ? unknown_echo_limit : echo_limit);
}

void RtuReceiver::reset() noexcept {
    size_ = matched_ = echo_size_ = 0;
    overlong_ = unechoed_ = false;
    echo_ = Echo::unknown;
}

}  // namespace axisgate::modbus
