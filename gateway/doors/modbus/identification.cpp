// Objects by category (basic, regular, extended), streamed or one by one (Modbus application protocol V1.1b3, 6.21). An object is never
// split.
#include "gateway/doors/modbus/identification.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace axisgate::modbus {
namespace {
constexpr std::uint8_t stream_basic = 1, stream_regular = 2, stream_extended = 3, individual = 4;
constexpr std::uint8_t individual_access = 0x80;  // bit of the conformity level: individual access in addition to streams
constexpr std::size_t head = 7;                   // function, MEI type, code, conformity, more follows, next object, number of objects

constexpr std::uint8_t last_of_category(std::uint8_t category) noexcept {
    return category == stream_basic ? 0x02 : category == stream_regular ? 0x7F : 0xFF;
}
std::size_t length_of(const IdentityObject& o) noexcept { return std::min(o.value.size(), IdentityObject::max_value); }

std::size_t put(const IdentityObject& o, std::uint8_t* out) noexcept {
    const std::size_t n = length_of(o);
    out[0] = o.id;
    out[1] = static_cast<std::uint8_t>(n);
    std::memcpy(out + 2, o.value.data(), n);
    return 2 + n;
}
}  // namespace

Identity Identity::gateway(std::string version, WordOrder order) {
    Identity i;
    i.version = version;
    i.objects = {{0x00, "axisgate"}, {0x01, "AXISGATE"}, {0x02, std::move(version)},         {0x04, "axisgate fieldbus gateway"},
                 {0x05, "axisgate"}, {0x80, "00000000"}, {0x81, std::string(name_of(order))}};
    return i;
}

void Identity::set_mapping_revision(std::uint32_t revision) {
    const auto at = std::find_if(objects.begin(), objects.end(), [](const auto& o) { return o.id == 0x80; });
    if (at == objects.end()) return;
    at->value.resize(8);
    for (int i = 0; i < 8; ++i)
        at->value[static_cast<std::size_t>(i)] = "0123456789abcdef"[(revision >> (28 - 4 * i)) & 0xFu];
}

std::size_t report_server_id(const Identity& identity, std::uint8_t unit, std::uint8_t* out) noexcept {
    std::size_t size = 4;
    const auto put = [&](std::string_view text) {
        const std::size_t n = std::min(text.size(), max_pdu - size);
        std::memcpy(out + size, text.data(), n);
        size += n;
    };
    put(identity.server_name);
    put(" ");
    put(identity.version);
    out[0] = function::report_server_id;
    out[1] = static_cast<std::uint8_t>(size - 2);
    out[2] = unit;
    out[3] = 0xFF;
    return size;
}

IdentityAnswer read_device_identification(const Identity& identity, std::uint8_t code, std::uint8_t object, std::uint8_t* out) noexcept {
    if (code < stream_basic || code > individual) return {Exception::illegal_value, 0};
    const auto& objects = identity.objects;
    const std::uint8_t highest = objects.empty() ? 0 : objects.back().id;
    const std::uint8_t level = highest > last_of_category(stream_regular) ? stream_extended
                               : highest > last_of_category(stream_basic) ? stream_regular
                                                                          : stream_basic;
    const auto find = [&](std::uint8_t id) {
        return std::find_if(objects.begin(), objects.end(), [&](const auto& o) { return o.id == id; });
    };
    out[0] = function::encapsulated_interface;
    out[1] = function::device_identification;
    out[2] = code;
    out[3] = static_cast<std::uint8_t>(individual_access | level);
    out[4] = 0;
    out[5] = 0;
    out[6] = 0;
    std::size_t size = head;

    if (code == individual) {
        const auto it = find(object);
        if (it == objects.end()) return {Exception::illegal_address, 0};
        out[6] = 1;
        return {Exception::none, size + put(*it, out + size)};
    }
    const std::uint8_t last = last_of_category(code);
    auto it = object <= last ? find(object) : objects.end();
    if (it == objects.end()) it = objects.begin();
    for (; it != objects.end() && it->id <= last; ++it) {
        if (size + 2 + length_of(*it) > max_pdu) {
            out[4] = 0xFF;
            out[5] = it->id;
            break;
        }
        size += put(*it, out + size);
        ++out[6];
    }
    return {Exception::none, size};
}

}  // namespace axisgate::modbus
