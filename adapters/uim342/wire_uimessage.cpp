// UIMessage: packing and proving of one 16-byte frame.
// In: a message, or bytes of a stream. Out: 16 bytes, or a message. R0 (byte 13) is the low byte of the CRC, R1 (byte 14) the high one.
// Never accepts DL above 8 or an ID above 127: such bytes cannot be a message whatever their CRC says.
#include "adapters/uim342/wire_uimessage.hpp"

#include <algorithm>

namespace axisgate::uim342 {
namespace {
constexpr std::array<std::uint16_t, 256> make_table() noexcept {
    std::array<std::uint16_t, 256> t{};
    for (unsigned i = 0; i < 256; ++i) {
        unsigned c = i;
        for (int bit = 0; bit < 8; ++bit)
            c = c & 1u ? c >> 1 ^ 0xA001u : c >> 1;
        t[i] = static_cast<std::uint16_t>(c);
    }
    return t;
}
constexpr auto crc_table = make_table();
constexpr std::uint8_t with_crc = 0xAA, without_crc = 0xAD, end_byte = 0xCC;
constexpr std::array<std::string_view, 4> crc_names{"12", "13", "auto", "none"};  // as CrcMode counts
}  // namespace

std::uint16_t crc16(std::span<const std::uint8_t> data) noexcept {
    std::uint16_t crc = 0xFFFF;
    for (const auto b : data)
        crc = static_cast<std::uint16_t>(crc >> 8 ^ crc_table[(crc ^ b) & 0xFF]);
    return crc;
}

std::string_view name_of(CrcMode mode) noexcept { return crc_names[static_cast<std::size_t>(mode)]; }

std::optional<CrcMode> crc_mode_named(std::string_view text) noexcept {
    const auto n = std::ranges::find(crc_names, text);
    if (n == crc_names.end()) return std::nullopt;
    return static_cast<CrcMode>(n - crc_names.begin());
}

UiBytes to_uimessage(const Message& m, CrcMode mode) noexcept {
    UiBytes b{};
    b[0] = mode == CrcMode::none ? without_crc : with_crc;
    b[1] = m.id;
    b[2] = m.cw;
    b[3] = m.dl;
    std::copy_n(m.d.begin(), m.dl, b.begin() + 4);
    if (mode != CrcMode::none) {
        const std::size_t first = mode == CrcMode::thirteen ? 0 : 1;
        put_u16(&b[13], crc16({b.data() + first, 13 - first}));
    }
    b[15] = end_byte;
    return b;
}

UiCheck check_uimessage(const UiBytes& b, CrcMode accept) noexcept {
    UiCheck c;
    if ((b[0] != with_crc && b[0] != without_crc) || b[15] != end_byte || b[1] > 127 || b[3] > 8) return c;
    if (b[0] == without_crc) {
        c.good = accept == CrcMode::none;
        c.proved = CrcMode::none;
    } else {
        const std::uint16_t sent = get_u16(&b[13]);
        if (accept != CrcMode::thirteen && sent == crc16({b.data() + 1, 12})) {
            c.good = true;
            c.proved = CrcMode::twelve;
        } else if (accept != CrcMode::twelve && sent == crc16({b.data(), 13})) {
            c.good = true;
            c.proved = CrcMode::thirteen;
        }
    }
    if (c.good) c.message = message(b[1], b[2], {b.data() + 4, b[3]});
    return c;
}

}  // namespace axisgate::uim342
