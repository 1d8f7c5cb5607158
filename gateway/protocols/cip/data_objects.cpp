// Assembly and Parameter: the objects that represent the axes.
// An output that a connection of another originator commands is never written.
#include <algorithm>

#include "gateway/protocols/cip/objects.hpp"

namespace axisgate::cip {

std::uint32_t AssemblyObject::last_instance() const {
    const auto& list = values_.assemblies();
    return list.empty() ? 0 : list.back();
}
std::uint32_t AssemblyObject::instances() const { return static_cast<std::uint32_t>(values_.assemblies().size()); }

General AssemblyObject::get(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to) {
    if (attribute == 3) {
        values_.read(instance, context.now, to);
        return General::success;
    }
    if (attribute != 4) return General::attribute_not_supported;
    put16(to, values_.assembly(instance)->size);
    return General::success;
}

Response AssemblyObject::set_single(std::uint32_t instance, std::uint32_t attribute, View data, const Context& context) {
    const AssemblyInfo info = *values_.assembly(instance);
    if (attribute != 3) return Response::of(attribute == 4 ? General::attribute_not_settable : General::attribute_not_supported);
    if (info.role != AssemblyInfo::Role::output) return Response::of(General::attribute_not_settable);
    if (data.size() != info.size) return Response::of(data.size() < info.size ? General::not_enough_data : General::too_much_data);
    if (connections_.owned_by_other(instance, {})) return Response::of(General::object_state_conflict);
    Response r;
    r.general = values_.write(instance, data, context.token, context.peer, context.now, r.pending);
    r.pending = r.pending && r.good();
    return r;
}

namespace {
constexpr std::uint32_t most_own = 255;  // highest attribute and instance number that is searched
}
std::uint32_t OwnObject::last_instance() const {
    std::uint32_t last = 0;
    for (std::uint32_t i = 1; i <= most_own; ++i)
        last = has(i) ? i : last;
    return last;
}
std::uint32_t OwnObject::instances() const {
    std::uint32_t n = 0;
    for (std::uint32_t i = 1; i <= most_own; ++i)
        n += has(i) ? 1 : 0;
    return n;
}
std::uint16_t OwnObject::last_attribute() const {
    const std::uint32_t instance = last_instance();
    std::uint16_t last = 0;
    for (std::uint16_t i = 1; i <= most_own; ++i)
        last = values_.own_attribute(class_, instance, i) ? i : last;
    return last;
}

General OwnObject::get(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to) {
    const auto what = attribute == 0 ? std::nullopt : values_.own_attribute(class_, instance, attribute);
    if (!what) return General::attribute_not_supported;
    return what->readable ? values_.get_own({class_, instance, attribute}, context.now, to) : General::attribute_not_gettable;
}

Response OwnObject::set_single(std::uint32_t instance, std::uint32_t attribute, View data, const Context& context) {
    const auto what = attribute == 0 ? std::nullopt : values_.own_attribute(class_, instance, attribute);
    if (!what) return Response::of(General::attribute_not_supported);
    if (!what->writable) return Response::of(General::attribute_not_settable);
    const std::size_t size = size_of(what->type);
    if (data.size() != size) return Response::of(data.size() < size ? General::not_enough_data : General::too_much_data);
    if (context.token == 0) return Response::of(General::resource_unavailable);
    Response r;
    r.general = values_.set_own({class_, instance, attribute}, data, context.token, context.peer, context.now, r.pending);
    r.pending = r.pending && r.good();
    return r;
}

std::span<const std::uint16_t> ParameterObject::all(std::uint32_t) const {
    static constexpr std::uint16_t list[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21};
    return list;
}

std::uint16_t ParameterObject::descriptor(const ParameterInfo& p) noexcept {
    constexpr std::uint16_t enumerated = 1u << 1, read_only = 1u << 4;
    return static_cast<std::uint16_t>((p.allowed.empty() ? 0 : enumerated) | (p.writable ? 0 : read_only));
}

General ParameterObject::get(std::uint32_t instance, std::uint32_t attribute, const Context&, Bytes& to) {
    const ParameterInfo p = *values_.parameter(instance);
    const std::string_view name = p.name, units = p.units, help = p.help;
    switch (attribute) {
        case 2:  // no link to another place
            put8(to, 0);
            break;
        case 3:
            break;
        case 4:
            put16(to, descriptor(p));
            break;
        case 5:
            put8(to, static_cast<std::uint8_t>(p.type));
            break;
        case 6:
            put8(to, size_of(p.type));
            break;
        case 7:
            put_short_string(to, name.substr(0, 16));
            break;
        case 8:
            put_short_string(to, units.substr(0, 4));
            break;
        case 9:
            put_short_string(to, help.substr(0, 64));
            break;
        case 10:
            put_bytes(to, p.min);
            break;
        case 11:
            put_bytes(to, p.max);
            break;
        case 12:
            put_bytes(to, p.fallback);
            break;
        case 13:  // multiplier, divisor, base: displayed without scaling
        case 14:
        case 15:
            put16(to, 1);
            break;
        case 16:
        case 17:
        case 18:
        case 19:
        case 20:
            put16(to, 0);
            break;
        case 21:
            put8(to, 0);
            break;
        default:
            return General::attribute_not_supported;
    }
    return General::success;
}

General ParameterObject::ask(std::uint32_t instance, const Context& context) {
    if (!values_.parameter(instance)->readable) return General::attribute_not_supported;
    return values_.ask(instance, context.token, context.peer, context.now);
}

General ParameterObject::set(std::uint32_t instance, std::uint32_t attribute, const Context& context, Reader& data) {
    if (attribute != 1) return Object::set(instance, attribute, context, data);
    const ParameterInfo p = *values_.parameter(instance);
    if (!p.writable) return General::attribute_not_settable;
    const std::size_t size = p.type == DataType::short_string ? (data.left() > 0 ? 1 + std::size_t{data.rest()[0]} : 1) : size_of(p.type);
    if (data.left() < size) return General::not_enough_data;
    if (data.left() > size) return General::too_much_data;
    return values_.set(instance, data.take(size), context.token, context.peer, context.now);
}

General ParameterObject::get_of_class(std::uint32_t attribute, const Context&, Bytes& to) {
    switch (attribute) {
        case 8:
            put16(to, 0x0B);  // instances, all their attributes, stored by the drives under their own rules
            return General::success;
        case 9:
            put16(to, 0);  // no configuration assembly is built from them
            return General::success;
        case 10:
            put8(to, 1);  // English
            return General::success;
        default:
            return General::attribute_not_supported;
    }
}

Response ParameterObject::other(std::uint8_t service, std::uint32_t instance, View data, Context&) {
    if (service != service::get_enum_string || instance == 0) return Response::of(General::service_not_supported);
    const ParameterInfo p = *values_.parameter(instance);
    if (p.allowed.empty()) return Response::of(General::service_not_supported);
    Reader r(data);
    const std::uint16_t wanted = r.u16();
    if (r.bad()) return Response::of(General::not_enough_data);
    if (r.left() > 0) return Response::of(General::too_much_data);
    const auto it = std::ranges::find(p.allowed, std::int64_t{wanted}, &std::pair<std::int64_t, std::string>::first);
    if (it == p.allowed.end()) return Response::of(General::invalid_parameter);
    Response answer;
    put_short_string(answer.data, it->second);
    return answer;
}

}  // namespace axisgate::cip
