// TCP/IP Interface, Ethernet Link and QoS: the data of the device's port that tools display.
// The network configuration of the host is never changed from here: that is done by its operating system.
#include <algorithm>

#include "gateway/protocols/cip/objects.hpp"

namespace axisgate::cip {

std::span<const std::uint16_t> TcpIpObject::all(std::uint32_t) const {
    static constexpr std::uint16_t list[] = {1, 2, 3, 4, 5, 6};
    return list;
}

General TcpIpObject::get(std::uint32_t, std::uint32_t attribute, const Context&, Bytes& to) {
    const Device& d = values_.device();
    switch (attribute) {
        case 1:
            put32(to, 1);  // the configuration is valid
            break;
        case 2:
            put32(to, 0);
            break;
        case 3:
            put32(to, 0);  // the configuration is stored by the host
            break;
        case 4:
            put16(to, 2);
            put_class(to, class_id::ethernet_link);
            put_instance(to, 1);
            break;
        case 5:
            put32(to, d.address);
            put32(to, d.mask);
            put32(to, d.router);
            put32(to, 0);
            put32(to, 0);
            put_string(to, "");
            break;
        case 6: {
            const std::string_view name = std::string_view(d.host_name).substr(0, 64);
            put_string(to, name);
            if (name.size() % 2 != 0) put8(to, 0);
            break;
        }
        case 13:
            put16(to, inactivity_s_);
            break;
        default:
            return General::attribute_not_supported;
    }
    return General::success;
}

General TcpIpObject::set(std::uint32_t instance, std::uint32_t attribute, const Context& context, Reader& data) {
    if (attribute != 13) return Object::set(instance, attribute, context, data);
    if (data.left() < 2) return General::not_enough_data;
    if (data.too_long_for(2)) return General::too_much_data;
    const std::uint16_t wanted = data.u16();
    if (wanted > 3600) return General::invalid_attribute_value;
    inactivity_s_ = wanted;
    return General::success;
}

std::span<const std::uint16_t> EthernetLinkObject::all(std::uint32_t) const {
    static constexpr std::uint16_t list[] = {1, 2, 3};
    return list;
}

General EthernetLinkObject::get(std::uint32_t, std::uint32_t attribute, const Context&, Bytes& to) {
    const Device& d = values_.device();
    switch (attribute) {
        case 1:
            put32(to, d.speed_mbit);
            break;
        case 2:
            put32(to, 1u | 1u << 1 | 3u << 2);  // link, full duplex, negotiated
            break;
        case 3:
            put_bytes(to, d.mac);
            break;
        case 7:
            put8(to, 2);  // twisted pair
            break;
        case 8:
            put8(to, 1);  // enabled
            break;
        case 9:
            put8(to, 1);  // also enabled by the administrator
            break;
        case 10:
            put_short_string(to, "Port 1");
            break;
        default:
            return General::attribute_not_supported;
    }
    return General::success;
}

General ConnectionConfigurationObject::get_of_class(std::uint32_t attribute, const Context&, Bytes& to) {
    if (attribute != 8 && attribute != 9) return General::attribute_not_supported;
    attribute == 8 ? put16(to, 0) : put32(to, 0);  // revision of the format; signature of the list, which has never been edited
    return General::success;
}

namespace {
constexpr std::uint32_t first_mark = 4, last_mark = 8;
constexpr std::uint8_t most_mark = 63;
}  // namespace

std::span<const std::uint16_t> QosObject::all(std::uint32_t) const {
    static constexpr std::uint16_t list[] = {4, 5, 6, 7, 8};
    return list;
}

General QosObject::get(std::uint32_t, std::uint32_t attribute, const Context&, Bytes& to) {
    static constexpr std::uint8_t of_time_synchronization[] = {0, 59, 47};  // no 802.1Q frames, and no clock for other devices
    if (attribute < 1 || attribute > last_mark) return General::attribute_not_supported;
    put8(to, attribute < first_mark ? of_time_synchronization[attribute - 1] : marks_[attribute - first_mark]);
    return General::success;
}

General QosObject::set(std::uint32_t instance, std::uint32_t attribute, const Context& context, Reader& data) {
    if (attribute < first_mark || attribute > last_mark) return Object::set(instance, attribute, context, data);
    if (data.left() < 1) return General::not_enough_data;
    if (data.too_long_for(1)) return General::too_much_data;
    const std::uint8_t wanted = data.u8();
    if (wanted > most_mark) return General::invalid_attribute_value;
    marks_[attribute - first_mark] = wanted;
    return General::success;
}

Response QosObject::other(std::uint8_t service, std::uint32_t instance, View data, Context&) {
    if (service != service::set_all || instance == 0) return Response::of(General::service_not_supported);
    if (data.size() != marks_.size()) return Response::of(data.size() < marks_.size() ? General::not_enough_data : General::too_much_data);
    if (std::ranges::any_of(data, [](std::uint8_t mark) { return mark > most_mark; }))
        return Response::of(General::invalid_attribute_value);
    std::ranges::copy(data, marks_.begin());
    return {};
}

}  // namespace axisgate::cip
