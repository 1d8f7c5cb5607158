// The twin's own reading of the UIM342 wire.
// In: frames and bytes. Out: telegrams, frames.
// Never interprets data.
#include "adapters/uim342/twin_wire.hpp"

#include <algorithm>

namespace axisgate::uim342::twin {
namespace {

constexpr std::uint8_t start_with_crc = 0xAA;
constexpr std::uint8_t start_plain = 0xAD;
constexpr std::uint8_t end_byte = 0xCC;
constexpr std::uint8_t highest_id = 127;

// The manual's high table is lost, so both are made from the polynomial; the printed low table agrees with this one.
constexpr std::array<std::uint16_t, 256> make_crc_table() {
    std::array<std::uint16_t, 256> table{};
    for (unsigned i = 0; i < 256; ++i) {
        unsigned c = i;
        for (int bit = 0; bit < 8; ++bit)
            c = (c & 1u) != 0 ? (c >> 1) ^ 0xA001u : c >> 1;
        table[i] = static_cast<std::uint16_t>(c);
    }
    return table;
}
constexpr auto crc_table = make_crc_table();

}  // namespace

std::optional<CrcRange> crc_range_named(std::string_view text) noexcept {
    if (text == "12") return CrcRange::twelve;
    if (text == "13") return CrcRange::thirteen;
    if (text == "auto") return CrcRange::automatic;
    return std::nullopt;
}

std::uint16_t crc16(std::span<const std::uint8_t> data) noexcept {
    unsigned crc = 0xFFFF;
    for (const std::uint8_t b : data)
        crc = (crc >> 8) ^ crc_table[(crc ^ b) & 0xFFu];
    return static_cast<std::uint16_t>(crc);
}

std::optional<Telegram> read_can(const Frame& frame) noexcept {
    constexpr std::uint32_t reserved = (1u << 18) | 0x3F00u;
    if (frame.kind != Frame::Kind::can || !frame.extended || frame.remote || (frame.id & reserved) != 0) return std::nullopt;
    Telegram t;
    t.producer = static_cast<std::uint8_t>(((frame.id >> 24) & 0x1Fu) | ((frame.id >> 11) & 0x60u));
    t.consumer = consumer_of(frame.id);
    t.cw = static_cast<std::uint8_t>(frame.id & 0xFFu);
    t.dl = static_cast<std::uint8_t>(std::min<std::size_t>(frame.size, 8));
    std::copy_n(frame.storage.data(), t.dl, t.d.data());
    return t;
}

Frame write_can(const Telegram& telegram) noexcept {
    return Frame::can_extended(can_id(telegram.producer, telegram.consumer, telegram.cw), std::span(telegram.d).first(telegram.dl));
}

std::array<std::uint8_t, 16> write_message(const Telegram& telegram, Form form) noexcept {
    std::array<std::uint8_t, 16> m{};
    m[0] = form == Form::plain ? start_plain : start_with_crc;
    m[1] = telegram.producer;
    m[2] = telegram.cw;
    m[3] = telegram.dl;
    std::copy_n(telegram.d.data(), std::min<std::size_t>(telegram.dl, 8), m.data() + 4);
    if (form != Form::plain) {
        const auto crc = form == Form::crc12 ? crc16(std::span(m).subspan(1, 12)) : crc16(std::span(m).first(13));
        m[13] = static_cast<std::uint8_t>(crc & 0xFFu);
        m[14] = static_cast<std::uint8_t>(crc >> 8);
    }
    m[15] = end_byte;
    return m;
}

bool MessageReader::good(const std::uint8_t* m, Form& form) const noexcept {
    if (m[15] != end_byte) return false;
    if (m[0] == start_plain) {
        // Without a CRC the only further signs of a message are an ID that can exist and a length that can exist.
        form = Form::plain;
        return m[1] <= highest_id && m[3] <= 8;
    }
    if (m[0] != start_with_crc) return false;
    const auto sent = static_cast<std::uint16_t>(m[13] | (m[14] << 8));
    const std::span<const std::uint8_t> all(m, 13);
    if (range_ != CrcRange::thirteen && crc16(all.subspan(1)) == sent) {
        form = Form::crc12;
        return true;
    }
    if (range_ != CrcRange::twelve && crc16(all) == sent) {
        form = Form::crc13;
        return true;
    }
    return false;
}

Telegram MessageReader::telegram_of(const std::uint8_t* m) noexcept {
    Telegram t;
    t.consumer = m[1];
    t.cw = m[2];
    t.dl = m[3];
    std::copy_n(m + 4, std::min<std::size_t>(t.dl, 8), t.d.data());
    return t;
}

void MessageReader::slide() noexcept {
    const auto* const begin = window_.data();
    const auto* const end = begin + held_;
    const auto* const next = std::find_if(begin + 1, end, [](std::uint8_t b) { return b == start_with_crc || b == start_plain; });
    held_ = static_cast<std::size_t>(end - next);
    std::copy(next, end, window_.data());
}

}  // namespace axisgate::uim342::twin
