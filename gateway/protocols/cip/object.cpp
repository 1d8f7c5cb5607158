// Object: the common services, carried out with the attributes of an object.
// A request is checked in this order: instance, service, attribute, data.
#include "gateway/protocols/cip/object.hpp"

#include <algorithm>

namespace axisgate::cip {

General Object::set(std::uint32_t instance, std::uint32_t attribute, const Context& context, Reader&) {
    Bytes ignored;
    const bool there = is_late(attribute) || get(instance, attribute, context, ignored) == General::success;
    return there ? General::attribute_not_settable : General::attribute_not_supported;
}
General Object::get_of_class(std::uint32_t, const Context&, Bytes&) { return General::attribute_not_supported; }
Response Object::other(std::uint8_t, std::uint32_t, View, Context&) { return Response::of(General::service_not_supported); }
General Object::ask(std::uint32_t, const Context&) { return General::attribute_not_supported; }

void Object::put_count(Bytes& to, std::uint32_t count) const {
    counts_in_32_bits() ? put32(to, count) : put16(to, static_cast<std::uint16_t>(std::min<std::uint32_t>(count, 0xFFFF)));
}

General Object::read(std::uint32_t instance, std::uint32_t attribute, const Context& context, Bytes& to) {
    if (instance != 0) return get(instance, attribute, context, to);
    switch (attribute) {
        case 1:
            put16(to, revision());
            return General::success;
        case 2:
            put_count(to, last_instance());
            return General::success;
        case 3:
            put_count(to, instances());
            return General::success;
        case 6:
            put16(to, last_attribute_of_class());
            return General::success;
        case 7:
            put16(to, last_attribute());
            return General::success;
        default:
            return get_of_class(attribute, context, to);
    }
}

Response Object::serve(std::uint8_t service, const Path& path, View data, Context& context) {
    const std::uint32_t instance = path.instance().value_or(0);
    if (instance != 0 && !has(instance)) return Response::of(General::object_does_not_exist);
    switch (service) {
        case service::get_single:
            if (!path.attribute) return Response::of(General::path_segment_error);
            if (!data.empty()) return Response::of(General::too_much_data);
            return get_single(instance, *path.attribute, context);
        case service::set_single:
            if (instance == 0) return Response::of(General::service_not_supported);
            if (!path.attribute) return Response::of(General::path_segment_error);
            return set_single(instance, *path.attribute, data, context);
        case service::get_all:
            if (!data.empty()) return Response::of(General::too_much_data);
            return get_all(instance, context);
        case service::get_list:
            return get_list(instance, data, context);
        case service::set_list:
            if (instance == 0) return Response::of(General::service_not_supported);
            return set_list(instance, data, context);
        default:
            return other(service, instance, data, context);
    }
}

Response Object::get_single(std::uint32_t instance, std::uint32_t attribute, const Context& context) {
    Response r;
    if (instance != 0 && is_late(attribute)) {
        r.general = ask(instance, context);
        r.pending = r.good();
        return r;
    }
    r.general = read(instance, attribute, context, r.data);
    if (r.data.size() > context.most_answer) return Response::of(General::reply_data_too_large);
    return r;
}

Response Object::set_single(std::uint32_t instance, std::uint32_t attribute, View data, const Context& context) {
    Reader reader(data, true);
    Response r;
    r.general = set(instance, attribute, context, reader);
    if (r.good() && reader.left() > 0) r.general = General::too_much_data;
    r.pending = r.good() && is_late(attribute);
    return r;
}

Response Object::get_all(std::uint32_t instance, const Context& context) {
    static constexpr std::uint16_t of_class[] = {1, 2};
    const auto list = instance == 0 ? std::span<const std::uint16_t>(of_class) : all(instance);
    if (list.empty()) return Response::of(General::service_not_supported);
    Response r;
    for (const std::uint16_t attribute : list) {
        if (instance != 0 && is_late(attribute)) {  // such an attribute comes first and is sent before the others
            if (const General g = ask(instance, context); g != General::success) return Response::of(g);
            r.pending = true;
        } else if (const General g = read(instance, attribute, context, r.data); g != General::success) {
            return Response::of(g);
        }
    }
    if (r.data.size() > context.most_answer) return Response::of(General::reply_data_too_large);
    return r;
}

Response Object::get_list(std::uint32_t instance, View data, const Context& context) {
    Reader reader(data);
    const std::uint16_t count = reader.u16();
    if (reader.bad() || reader.left() < 2 * std::size_t{count}) return Response::of(General::not_enough_data);
    if (reader.left() > 2 * std::size_t{count}) return Response::of(General::too_much_data);
    Response r;
    put16(r.data, count);
    for (std::uint16_t i = 0; i < count; ++i) {
        const std::uint16_t attribute = reader.u16();
        Bytes value;
        // A value that comes later cannot be part of a list: it is read alone.
        const General g =
            instance != 0 && is_late(attribute) ? General::attribute_not_supported : read(instance, attribute, context, value);
        put16(r.data, attribute);
        put16(r.data, static_cast<std::uint16_t>(g));
        if (g == General::success) {
            put_bytes(r.data, value);
        } else {
            r.general = General::attribute_list_error;
        }
        if (r.data.size() > context.most_answer) return Response::of(General::reply_data_too_large);
    }
    return r;
}

Response Object::set_list(std::uint32_t instance, View data, const Context& context) {
    Reader reader(data);
    const std::uint16_t count = reader.u16();
    if (reader.bad()) return Response::of(General::not_enough_data);
    Response r;
    put16(r.data, count);
    for (std::uint16_t i = 0; i < count; ++i) {
        const std::uint16_t attribute = reader.u16();
        if (reader.bad()) return Response::of(General::not_enough_data);
        const General g = is_late(attribute) ? General::attribute_not_settable : set(instance, attribute, context, reader);
        put16(r.data, attribute);
        put16(r.data, static_cast<std::uint16_t>(g));
        if (g != General::success) {  // the length of its value is unknown, so that the next one cannot be found
            r.general = General::attribute_list_error;
            set16(r.data.data(), static_cast<std::uint16_t>(i + 1));
            return r;
        }
        if (r.data.size() > context.most_answer) return Response::of(General::reply_data_too_large);
    }
    if (reader.left() > 0) return Response::of(General::too_much_data);
    return r;
}

}  // namespace axisgate::cip
