// Router: finds the object by its class, and carries out the two services that contain other requests.
// A fault in one part never suppresses the answer to another.
#include "gateway/protocols/cip/router.hpp"

#include <algorithm>

#include "gateway/protocols/cip/forward_open.hpp"

namespace axisgate::cip {
namespace {
bool names(const Path& path, std::uint32_t class_id) { return path.class_id == class_id && path.instance() == 1u; }
/// Changes of axes and connections are reported elsewhere.
bool changes_the_device(std::uint32_t which, std::uint8_t what, const Response& r) {
    if (which == class_id::assembly || which == class_id::parameter || which == class_id::connection_manager) return false;
    // those before the faulty one were written
    if (what == service::set_list) return r.good() || r.general == General::attribute_list_error;
    return r.good() && (what == service::set_single || what == service::set_all || what == service::reset);
}
std::uint8_t service_of(View message) { return message.empty() ? std::uint8_t{0} : static_cast<std::uint8_t>(message[0] & 0x7F); }

/// The embedded message, if the route ends here.
std::optional<Response> unwrap(View data, View& inside) {
    Reader r(data);
    r.skip(2);
    const std::size_t size = r.u16();
    inside = r.take(size);
    if (size % 2 != 0) r.skip(1);
    const std::size_t words = r.u8();
    r.skip(1);
    const View route = r.take(2 * words);
    const auto refuse = [&](Extended why) {
        Response no = Response::refused(why);
        put8(no.data, static_cast<std::uint8_t>(words));
        return no;
    };
    if (r.bad()) return Response::of(General::not_enough_data);
    if (r.left() > 0) return Response::of(General::too_much_data);
    if (size < 2) return refuse(Extended::unconnected_parameter_error);  // no service and no path
    const auto path = read_path(route);
    if (!path) return refuse(Extended::invalid_segment);
    if (const auto wrong = wrong_route(*path)) return refuse(*wrong);
    return std::nullopt;
}
}  // namespace

void Router::add(Object& object) { objects_.insert(std::ranges::upper_bound(objects_, object.class_id(), {}, &Object::class_id), &object); }

std::span<const std::uint16_t> Router::all(std::uint32_t) const {
    static constexpr std::uint16_t list[] = {1, 2, 3, 4};
    return list;
}

General Router::get(std::uint32_t, std::uint32_t attribute, const Context&, Bytes& to) {
    switch (attribute) {
        case 1:
            put16(to, static_cast<std::uint16_t>(objects_.size()));
            for (const Object* o : objects_)
                put16(to, static_cast<std::uint16_t>(o->class_id()));
            return General::success;
        case 2:
            put16(to, static_cast<std::uint16_t>(connections_.most()));
            return General::success;
        case 3:
            put16(to, static_cast<std::uint16_t>(connections_.open()));
            return General::success;
        case 4:
            for (const std::uint16_t number : connections_.numbers())
                put16(to, number);
            return General::success;
        default:
            return General::attribute_not_supported;
    }
}

Response Router::route(const Request& request, const Path& path, Context& context) {
    if (path.key && wrong_key(*path.key, context.device ? *context.device : Device{})) return Response::of(General::key_failure);
    if (wrong_route(path) || !path.symbols.empty() || !path.class_id) return Response::of(General::path_destination_unknown);
    if (path.places.size() > 1) return Response::of(General::path_segment_error);
    const auto it = std::ranges::find(objects_, *path.class_id, &Object::class_id);
    const bool own = it == objects_.end() && own_ && own_->serves(*path.class_id);
    if (it == objects_.end() && !own) return Response::of(General::path_destination_unknown);
    if (own) own_->name(*path.class_id);
    Object& object = own ? *own_ : **it;
    Response r = object.serve(request.service, path, request.data, context);
    if (!own && changes_the_device(*path.class_id, request.service, r))
        listener_.written({*path.class_id, path.instance().value_or(0), path.attribute.value_or(0)}, context.peer, context.now);
    if (r.data.size() > context.most_answer) return Response::of(General::reply_data_too_large);
    return r;
}

/// `request` and `path` are the decoded parts of `message`, as far as they are valid.
Response Router::one(View message, const std::optional<Request>& request, const std::optional<Path>& path, Context& context) {
    if (!request) return Response::of(message.size() < 2 ? General::not_enough_data : General::path_size_invalid);
    if (!path || request->path.empty()) return Response::of(General::path_segment_error);
    if (request->service == service::multiple && names(*path, class_id::message_router))
        return Response::of(General::service_not_supported);
    return route(*request, *path, context);
}

Router::Parts Router::handle(View message, Context& context) {
    Parts parts;
    auto request = read_request(message);
    auto path = request ? read_path(request->path) : std::nullopt;
    if (path && request->service == service::unconnected_send && names(*path, class_id::connection_manager)) {
        View inside;
        if (auto refusal = unwrap(request->data, inside)) {
            parts.service = service::unconnected_send;
            parts.parts.push_back({service::unconnected_send, std::move(*refusal)});
            return parts;
        }
        message = inside;
        request = read_request(message);
        path = request ? read_path(request->path) : std::nullopt;
    }
    if (path && request->service == service::multiple && names(*path, class_id::message_router)) {
        parts.multiple = true;
        parts.service = service::multiple;
        several(request->data, parts, context);
    } else {
        Part& p = parts.parts.emplace_back();
        parts.service = p.service = service_of(message);
        p.response = one(message, request, path, context);
    }
    parts.pending = static_cast<std::size_t>(std::ranges::count_if(parts.parts, [](const Part& p) { return p.response.pending; }));
    return parts;
}

void Router::several(View data, Parts& into, Context& context) {
    const auto whole = [&](General g) {
        into.multiple = false;
        into.parts.clear();
        into.parts.push_back({service::multiple, Response::of(g)});
    };
    Reader r(data);
    const std::size_t count = r.u16();
    if (r.bad() || r.left() < 2 * count) return whole(General::not_enough_data);
    if (count == 0 || count > most_parts) return whole(count == 0 ? General::not_enough_data : General::resource_unavailable);
    std::vector<std::size_t> offsets(count);
    for (auto& o : offsets)
        o = r.u16();
    offsets.push_back(data.size());
    for (std::size_t i = 0; i < count; ++i) {
        if (offsets[i] < 2 + 2 * count || offsets[i] > offsets[i + 1]) return whole(General::invalid_parameter);
    }
    into.parts.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        Part& p = into.parts.emplace_back();
        const View message = data.subspan(offsets[i], offsets[i + 1] - offsets[i]);
        const auto request = read_request(message);
        p.service = service_of(message);
        p.response = one(message, request, request ? read_path(request->path) : std::nullopt, context);
        if (context.token != 0) ++context.token;
    }
}

void Router::put_answer(Bytes& to, const Parts& parts, std::size_t most) {
    if (!parts.multiple) return put_response(to, parts.parts.front().service, parts.parts.front().response);
    Response whole;
    put16(whole.data, static_cast<std::uint16_t>(parts.parts.size()));
    whole.data.resize(2 + 2 * parts.parts.size());
    for (std::size_t i = 0; i < parts.parts.size(); ++i) {
        const Part& p = parts.parts[i];
        set16(whole.data.data() + 2 + 2 * i, static_cast<std::uint16_t>(whole.data.size()));
        put_response(whole.data, p.service, p.response);
        if (!p.response.good()) whole.general = General::embedded_service_error;
    }
    if (whole.data.size() > most) whole = Response::of(General::reply_data_too_large);
    put_response(to, parts.service, whole);
}

}  // namespace axisgate::cip
