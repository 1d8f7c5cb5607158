// CANopen messages: computes identifiers and services of the predefined connection set.
#include "gateway/protocols/canopen/message.hpp"

#include <fmt/core.h>

#include <string_view>

namespace axisgate::canopen {

std::string to_text(Address address) { return fmt::format("{:04X}h:{:02X}", address.index, address.sub); }

std::string_view name_of(Service service) noexcept {
    switch (service) {
        case Service::nmt:
            return "NMT";
        case Service::sync:
            return "SYNC";
        case Service::emergency:
            return "EMCY";
        case Service::time:
            return "TIME";
        case Service::transmit_pdo:
            return "TPDO";
        case Service::receive_pdo:
            return "RPDO";
        case Service::sdo_answer:
            return "SDO answer";
        case Service::sdo_request:
            return "SDO request";
        case Service::error_control:
            return "error control";
        case Service::other:
            return "other";
    }
    return "other";
}

Role role_of(std::uint32_t id) noexcept {
    const auto node = static_cast<std::uint8_t>(id & 0x7Fu);
    const std::uint32_t function = id >> 7;
    if (function > 15) return {};
    if (node == 0) {
        if (id == nmt_id) return {Service::nmt, 0, 0};
        if (id == sync_id) return {Service::sync, 0, 0};
        if (id == time_id) return {Service::time, 0, 0};
        return {};
    }
    switch (function) {
        case 1:
            return {Service::emergency, node, 0};
        case 3:
        case 5:
        case 7:
        case 9:
            return {Service::transmit_pdo, node, static_cast<std::uint8_t>((function - 1) / 2)};
        case 4:
        case 6:
        case 8:
        case 10:
            return {Service::receive_pdo, node, static_cast<std::uint8_t>((function - 2) / 2)};
        case 11:
            return {Service::sdo_answer, node, 0};
        case 12:
            return {Service::sdo_request, node, 0};
        case 14:
            return {Service::error_control, node, 0};
        default:
            return {};
    }
}

Frame data_frame(std::uint32_t id, std::span<const std::uint8_t> data) noexcept {
    Frame f;
    f.kind = Frame::Kind::can;
    f.id = id & 0x7FFu;
    f.assign(data.first(std::min<std::size_t>(data.size(), 8)));
    return f;
}
Frame remote_frame(std::uint32_t id) noexcept {
    Frame f;
    f.kind = Frame::Kind::can;
    f.id = id & 0x7FFu;
    f.remote = true;
    return f;
}
bool is_data(const Frame& frame, std::uint32_t id) noexcept {
    return frame.kind == Frame::Kind::can && !frame.extended && !frame.remote && frame.id == id;
}
bool is_remote(const Frame& frame, std::uint32_t id) noexcept {
    return frame.kind == Frame::Kind::can && !frame.extended && frame.remote && frame.id == id;
}

std::uint64_t low_first(std::span<const std::uint8_t> bytes) noexcept {
    std::uint64_t v = 0;
    for (std::size_t i = std::min<std::size_t>(bytes.size(), 8); i-- > 0;)
        v = v << 8 | bytes[i];
    return v;
}
void put_low_first(std::uint64_t value, std::span<std::uint8_t> into) noexcept {
    for (auto& b : into) {
        b = static_cast<std::uint8_t>(value);
        value >>= 8;
    }
}

}  // namespace axisgate::canopen
