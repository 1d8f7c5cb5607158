// EMCY: reads frames, and holds the table of error code classes.
#include "gateway/protocols/canopen/emergency.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace axisgate::canopen {
namespace {
struct Class {
    std::uint16_t code, mask;
    std::string_view words;
};
// The first match counts, so special codes stand before their class. CiA 301 table 26, and the classes of CiA 402-2.
constexpr std::array classes{
    Class{0x0000, 0xFF00, "no error any more"},
    Class{0x8110, 0xFFFF, "CAN overrun: messages were lost"},
    Class{0x8120, 0xFFFF, "CAN in error passive mode"},
    Class{0x8130, 0xFFFF, "heartbeat or life guarding error"},
    Class{0x8140, 0xFFFF, "recovered from bus off"},
    Class{0x8150, 0xFFFF, "another node has the same identifier"},
    Class{0x8210, 0xFFFF, "PDO not processed: it is too short"},
    Class{0x8220, 0xFFFF, "PDO is too long"},
    Class{0x8230, 0xFFFF, "destination of a multiplexed PDO is not there"},
    Class{0x8240, 0xFFFF, "SYNC with an unexpected length"},
    Class{0x8250, 0xFFFF, "receive PDO missed"},
    Class{0x8611, 0xFFFF, "following error"},
    Class{0x8612, 0xFFFF, "reference limit"},
    Class{0x7305, 0xFFFF, "incremental encoder 1"},
    Class{0x7121, 0xFFFF, "motor blocked"},
    Class{0x7122, 0xFFFF, "motor error or wrong commutation"},
    Class{0x5441, 0xFFFF, "contact: drive disabled by the enable input"},
    Class{0x5530, 0xFFFF, "non-volatile memory"},
    Class{0x2310, 0xFFFF, "continuous over current at the output"},
    Class{0x2320, 0xFFFF, "short circuit or earth leakage at the output"},
    Class{0x2350, 0xFFFF, "load level, I2t"},
    Class{0x3210, 0xFFFF, "DC link over voltage"},
    Class{0x3220, 0xFFFF, "DC link under voltage"},
    Class{0x4210, 0xFFFF, "device temperature too high"},
    Class{0x4310, 0xFFFF, "drive temperature too high"},
    Class{0x2100, 0xFF00, "current at the device input"},
    Class{0x2200, 0xFF00, "current inside the device"},
    Class{0x2300, 0xFF00, "current at the device output"},
    Class{0x3100, 0xFF00, "mains voltage"},
    Class{0x3200, 0xFF00, "voltage inside the device"},
    Class{0x3300, 0xFF00, "output voltage"},
    Class{0x4100, 0xFF00, "ambient temperature"},
    Class{0x4200, 0xFF00, "device temperature"},
    Class{0x4300, 0xFF00, "drive temperature"},
    Class{0x6100, 0xFF00, "internal software"},
    Class{0x6200, 0xFF00, "user software"},
    Class{0x6300, 0xFF00, "data set"},
    Class{0x8100, 0xFF00, "communication"},
    Class{0x8200, 0xFF00, "protocol"},
    Class{0x8400, 0xFF00, "velocity controller"},
    Class{0x8500, 0xFF00, "position controller"},
    Class{0x8600, 0xFF00, "positioning"},
    Class{0x1000, 0xF000, "generic error"},
    Class{0x2000, 0xF000, "current"},
    Class{0x3000, 0xF000, "voltage"},
    Class{0x4000, 0xF000, "temperature"},
    Class{0x5000, 0xF000, "device hardware"},
    Class{0x6000, 0xF000, "device software"},
    Class{0x7000, 0xF000, "additional modules"},
    Class{0x8000, 0xF000, "monitoring"},
    Class{0x9000, 0xF000, "external error"},
    Class{0xF000, 0xFF00, "additional functions"},
    Class{0xFF00, 0xFF00, "the maker's own error"},
};
constexpr std::array<std::string_view, 8> register_bits{"generic",       "current",        "voltage",  "temperature",
                                                        "communication", "device profile", "reserved", "maker's own"};
}  // namespace

std::optional<Emergency> emergency_of(const Frame& frame, std::uint8_t node) noexcept {
    if (!is_data(frame, std::uint32_t{emergency_base} + node) || frame.size != 8) return std::nullopt;
    Emergency e;
    e.code = static_cast<std::uint16_t>(low_first(frame.data().first(2)));
    e.error_register = frame.storage[2];
    std::copy_n(frame.data().begin() + 3, e.maker.size(), e.maker.begin());
    return e;
}
Frame emergency_frame(std::uint8_t node, const Emergency& e) noexcept {
    std::array<std::uint8_t, 8> bytes{static_cast<std::uint8_t>(e.code), static_cast<std::uint8_t>(e.code >> 8), e.error_register};
    std::ranges::copy(e.maker, bytes.begin() + 3);
    return data_frame(std::uint32_t{emergency_base} + node, bytes);
}
std::string_view words_of_error(std::uint16_t code) noexcept {
    const auto* c = std::ranges::find_if(classes, [&](const Class& x) { return (code & x.mask) == x.code; });
    return c == classes.end() ? std::string_view{} : c->words;
}
std::string to_text(const Emergency& e) {
    std::string bits;
    for (std::size_t i = 0; i < register_bits.size(); ++i) {
        if ((e.error_register >> i & 1) != 0) bits += (bits.empty() ? "" : ", ") + std::string(register_bits[i]);
    }
    const auto words = words_of_error(e.code);
    std::string text =
        e.code == 0 ? std::string(words) : fmt::format("{:04X}h {}", e.code, words.empty() ? "no class of the standards" : words);
    if (e.error_register != 0) text += fmt::format(", register {:02X}h ({})", e.error_register, bits);
    return text;
}

}  // namespace axisgate::canopen
