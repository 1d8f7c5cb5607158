// SDO, the common part of client and server: checksum, messages, and both ends of a block transfer.
#include "gateway/protocols/canopen/sdo.hpp"

#include <algorithm>
#include <array>

namespace axisgate::canopen {

std::uint16_t sdo_crc(std::span<const std::uint8_t> bytes) noexcept {
    std::uint32_t crc = 0;
    for (const auto b : bytes) {
        crc ^= std::uint32_t{b} << 8;
        for (int i = 0; i < 8; ++i)
            crc = (crc & 0x8000u) != 0 ? crc << 1 ^ 0x1021u : crc << 1;
    }
    return static_cast<std::uint16_t>(crc);
}

Frame sdo_frame(std::uint32_t id, std::uint8_t command, Address address, std::uint32_t value) noexcept {
    std::array<std::uint8_t, 8> bytes{command, static_cast<std::uint8_t>(address.index), static_cast<std::uint8_t>(address.index >> 8),
                                      address.sub};
    put_low_first(value, std::span(bytes).subspan(4));
    return data_frame(id, bytes);
}
Frame abort_frame(std::uint32_t id, Address address, Abort code) noexcept {
    return sdo_frame(id, 0x80, address, static_cast<std::uint32_t>(code));
}
Address address_of(const Frame& frame) noexcept {
    return {static_cast<std::uint16_t>(low_first(frame.data().subspan(1, 2))), frame.storage[3]};
}
std::uint32_t value_of(const Frame& frame) noexcept { return static_cast<std::uint32_t>(low_first(frame.data().subspan(4, 4))); }

void BlockReceiver::begin(const SdoLimits& limits, std::optional<std::uint32_t> announced) {
    limits_ = limits;
    announced_ = announced;
    data_.clear();
    if (announced) data_.reserve(std::min<std::size_t>(*announced, limits.most_bytes) + segment_bytes);
    good_ = 0;
    stalls_ = 0;
    complete_ = false;
}

BlockReceiver::Step BlockReceiver::on_segment(const Frame& frame) {
    const auto sequence = static_cast<std::uint8_t>(frame.storage[0] & 0x7Fu);
    const bool last = (frame.storage[0] & 0x80u) != 0;
    if (sequence == 0 || sequence > limits_.block_size) return {false, 0, Abort::sequence};
    bool over = false;
    if (sequence == good_ + 1) {
        // The last segment is padded to seven bytes, so that much more than the value may arrive.
        const std::size_t most = std::min<std::size_t>(announced_.value_or(UINT32_MAX), limits_.most_bytes);
        if (data_.size() >= most && !(data_.empty() && last)) return {false, 0, announced_ ? Abort::length : Abort::memory};
        const auto bytes = frame.data().subspan(1, segment_bytes);
        data_.insert(data_.end(), bytes.begin(), bytes.end());
        good_ = sequence;
        over = last;
    }
    if (!last && sequence < limits_.block_size) return {};
    const std::uint8_t acknowledged = good_;
    good_ = 0;
    complete_ = over;
    stalls_ = acknowledged == 0 ? stalls_ + 1 : 0;
    if (stalls_ > limits_.stalls) return {false, 0, Abort::sequence};
    return {true, acknowledged, Abort::none};
}

Abort BlockReceiver::finish(std::uint8_t unused, std::optional<std::uint16_t> crc) {
    if (unused > segment_bytes || unused > data_.size()) return Abort::length;
    data_.resize(data_.size() - unused);
    if (announced_ ? data_.size() != *announced_ : data_.size() > limits_.most_bytes) return Abort::length;
    if (crc && *crc != sdo_crc(data_)) return Abort::crc;
    return Abort::none;
}

void BlockSender::begin(std::vector<std::uint8_t> data, int stalls) {
    data_ = std::move(data);
    at_ = 0;
    sent_ = 0;
    begun_ = false;
    stalls_ = 0;
    most_stalls_ = stalls;
}

void BlockSender::send(std::uint32_t id, std::uint8_t block_size, std::vector<Frame>& out) {
    sent_ = 0;
    for (std::size_t at = at_; sent_ < block_size && (at < data_.size() || (data_.empty() && sent_ == 0)); at += segment_bytes) {
        std::array<std::uint8_t, 8> bytes{};
        const auto n = std::min(segment_bytes, data_.size() - at);
        std::copy_n(data_.begin() + static_cast<std::ptrdiff_t>(at), n, bytes.begin() + 1);
        ++sent_;
        bytes[0] = static_cast<std::uint8_t>(sent_ | (at + segment_bytes >= data_.size() ? 0x80u : 0u));
        out.push_back(data_frame(id, bytes));
    }
}

Abort BlockSender::on_acknowledge(std::uint8_t sequence) {
    if (sequence > sent_) return Abort::sequence;
    if (sequence == 0) return ++stalls_ > most_stalls_ ? Abort::sequence : Abort::none;
    stalls_ = 0;
    begun_ = true;
    at_ = std::min(data_.size(), at_ + sequence * segment_bytes);
    return Abort::none;
}

std::uint8_t BlockSender::unused() const noexcept {
    if (data_.empty()) return segment_bytes;
    return static_cast<std::uint8_t>((segment_bytes - data_.size() % segment_bytes) % segment_bytes);
}

}  // namespace axisgate::canopen
