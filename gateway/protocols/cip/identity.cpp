// Identity: the device's description, whether it is owned, and its reset.
// A reset closes connections; it never affects a drive.
#include "gateway/protocols/cip/encapsulation.hpp"
#include "gateway/protocols/cip/objects.hpp"

namespace axisgate::cip {

std::span<const std::uint16_t> IdentityObject::all(std::uint32_t) const {
    static constexpr std::uint16_t list[] = {1, 2, 3, 4, 5, 6, 7};
    return list;
}

std::uint16_t IdentityObject::status() const {
    constexpr std::uint16_t configured = 1u << 2;
    const std::uint16_t extended = !connections_.io_open() ? 0x30 : connections_.running() ? 0x60 : 0x70;
    return static_cast<std::uint16_t>(configured | extended | (connections_.owned() ? 1 : 0));
}

General IdentityObject::get(std::uint32_t, std::uint32_t attribute, const Context&, Bytes& to) {
    const Device& d = values_.device();
    switch (attribute) {
        case 1:
            put16(to, d.vendor);
            break;
        case 2:
            put16(to, d.device_type);
            break;
        case 3:
            put16(to, d.product_code);
            break;
        case 4:
            put8(to, d.major);
            put8(to, d.minor);
            break;
        case 5:
            put16(to, status());
            break;
        case 6:
            put32(to, d.serial);
            break;
        case 7:
            put_short_string(to, std::string_view(d.name).substr(0, 32));
            break;
        case 8:
            put8(to, 3);  // operational
            break;
        case 9:
            put16(to, d.consistency);
            break;
        default:
            return General::attribute_not_supported;
    }
    return General::success;
}

Response IdentityObject::other(std::uint8_t service, std::uint32_t, View data, Context& context) {
    if (service != service::reset) return Response::of(General::service_not_supported);
    if (data.size() > 1) return Response::of(General::too_much_data);
    // Type 0, as if the power had been cycled. No setting of the site is reset from here.
    if (!data.empty() && data[0] != 0) return Response::of(General::invalid_parameter);
    if (connections_.owned_by_other(0, context.peer)) return Response::of(General::device_state_conflict);
    connections_.close_all(End::closed, context.now);
    return {};
}

Bytes IdentityObject::item() const {
    const Device& d = values_.device();
    Bytes to;
    put16(to, protocol_version);
    put_sockaddr(to, {d.address, d.port});
    put16(to, d.vendor);
    put16(to, d.device_type);
    put16(to, d.product_code);
    put8(to, d.major);
    put8(to, d.minor);
    put16(to, status());
    put32(to, d.serial);
    put_short_string(to, std::string_view(d.name).substr(0, 32));
    put8(to, 3);
    return to;
}

}  // namespace axisgate::cip
