// The buffer is linear; its content moves to the front only when the free end has become short. ADUs are not copied.
#include "gateway/doors/modbus/adu_framer.hpp"

#include <algorithm>
#include <cstring>

namespace axisgate::modbus {

std::span<std::uint8_t> AduFramer::space() noexcept {
    if (begin_ == end_) {
        begin_ = end_ = 0;
    } else if (begin_ > 0 && capacity - end_ < max_adu) {
        std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
        end_ -= begin_;
        begin_ = 0;
    }
    return std::span(buffer_).subspan(end_);
}

std::size_t AduFramer::feed(std::span<const std::uint8_t> bytes) noexcept {
    const auto free = space();
    const std::size_t n = std::min(free.size(), bytes.size());
    if (n > 0) std::memcpy(free.data(), bytes.data(), n);
    filled(n);
    return n;
}

AduFramer::Verdict AduFramer::peek(Adu& out) const noexcept {
    const std::uint8_t* const p = buffer_.data() + begin_;
    const std::size_t have = end_ - begin_;
    if (have >= 3 && p[2] != 0) return Verdict::bad_protocol;
    if (have >= 4 && p[3] != 0) return Verdict::bad_protocol;
    if (have >= 5 && p[4] != 0) return Verdict::bad_length;
    if (have < 6) return Verdict::need_more;
    const std::uint16_t length = get16(p + 4);
    if (length < min_length || length > max_length) return Verdict::bad_length;
    if (have < 6u + length) return Verdict::need_more;
    out.transaction = get16(p);
    out.unit = p[6];
    out.pdu = {p + mbap_size, static_cast<std::size_t>(length) - 1};
    return Verdict::adu;
}

void AduFramer::pop() noexcept { begin_ += 6u + get16(buffer_.data() + begin_ + 4); }

}  // namespace axisgate::modbus
