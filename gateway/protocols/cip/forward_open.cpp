// Forward_Open: checks a request in the order in which an originator would look for a fault, with one extended status for each fault.
#include "gateway/protocols/cip/forward_open.hpp"

#include <algorithm>

namespace axisgate::cip {
namespace {
bool rpi_is_wrong(const OpenRequest& q) {
    const bool messages = q.transport_class() == 3;
    const std::uint32_t most = messages ? most_message_rpi_us : most_rpi_us;
    const auto wrong = [&](std::uint32_t rpi_us) { return rpi_us < least_rpi_us || rpi_us > most; };
    return wrong(q.ot.rpi_us) || (q.to.type != Half::Type::null && wrong(q.to.rpi_us)) ||
           q.time_out() > (messages ? most_message_time_out : most_time_out);
}

Half read_half(std::uint32_t id, std::uint32_t rpi_us, std::uint32_t parameters, bool large) {
    Half h;
    h.id = id;
    h.rpi_us = rpi_us;
    const std::uint32_t upper = large ? parameters >> 16 : parameters;
    h.redundant_owner = (upper & 0x8000) != 0;
    h.type = static_cast<Half::Type>((upper >> 13) & 3);
    h.priority = static_cast<std::uint8_t>((upper >> 10) & 3);
    h.variable = (upper & 0x0200) != 0;
    h.size = static_cast<std::uint16_t>(parameters & (large ? 0xFFFF : 0x01FF));
    return h;
}

std::optional<Response> wrong_size(const Half& half, std::size_t right, Extended why) {
    if (half.variable ? half.size >= right : half.size == right) return std::nullopt;
    Response r = Response::refused(why);
    r.extended.push_back(static_cast<std::uint16_t>(right));
    return r;
}
}  // namespace

bool read_open(View data, bool large, OpenRequest& q, Response& refusal) {
    Reader r(data);
    r.skip(2);  // priority and time-out of the request itself, which is answered at once
    const std::uint32_t ot_id = r.u32(), to_id = r.u32();
    q.triad.serial = r.u16();
    q.triad.vendor = r.u16();
    q.triad.originator = r.u32();
    q.multiplier = r.u8();
    r.skip(3);
    const std::uint32_t ot_rpi = r.u32();
    const std::uint32_t ot_parameters = large ? r.u32() : r.u16();
    const std::uint32_t to_rpi = r.u32();
    const std::uint32_t to_parameters = large ? r.u32() : r.u16();
    q.transport = r.u8();
    const std::size_t words = r.u8();
    const View path = r.take(2 * words);
    if (r.bad() || r.left() > 0) {
        refusal = Response::of(r.bad() ? General::not_enough_data : General::too_much_data);
        return false;
    }
    q.ot = read_half(ot_id, ot_rpi, ot_parameters, large);
    q.to = read_half(to_id, to_rpi, to_parameters, large);
    std::size_t wrong_at = 0;
    auto read = read_path(path, wrong_at);
    if (!read) {
        refusal = refuse_open(q.triad, Response::refused(Extended::invalid_segment), words - std::min(words, wrong_at));
        return false;
    }
    q.path = std::move(*read);
    return true;
}

Response refuse_open(const Triad& triad, Response why, std::size_t path_words_left) {
    put16(why.data, triad.serial);
    put16(why.data, triad.vendor);
    put32(why.data, triad.originator);
    put8(why.data, static_cast<std::uint8_t>(path_words_left));
    put8(why.data, 0);
    return why;
}

std::optional<Extended> wrong_key(const ElectronicKey& k, const Device& d) {
    if ((k.vendor != 0 && k.vendor != d.vendor) || (k.product_code != 0 && k.product_code != d.product_code))
        return Extended::vendor_or_product_mismatch;
    if (k.device_type != 0 && k.device_type != d.device_type) return Extended::device_type_mismatch;
    if (k.major == 0 && k.minor == 0) return std::nullopt;
    const bool minor_fits = k.minor == 0 || (k.compatible ? k.minor <= d.minor : k.minor == d.minor);
    if ((k.major != 0 && k.major != d.major) || !minor_fits) return Extended::revision_mismatch;
    return std::nullopt;
}

bool same_places(const Path& a, const Path& b) {
    return std::ranges::equal(a.places, b.places,
                              [](const Place& x, const Place& y) { return x.class_id == y.class_id && x.instance == y.instance; });
}

bool names_router(const Path& path) {
    return path.places.size() == 1 && path.places[0].class_id == class_id::message_router && path.places[0].instance == 1;
}

std::optional<Extended> wrong_route(const Path& path) {
    if (path.ports.empty()) return std::nullopt;
    const Port& p = path.ports.front();
    if (path.ports.size() > 1 || p.number != 1) return Extended::port_not_available;
    // Slot 0 of a rack with one slot: tools write it for devices without slots.
    return p.link.size() == 1 && p.link[0] == 0 ? std::nullopt : std::optional(Extended::link_address_not_valid);
}

std::optional<Extended> wrong_by_itself(const OpenRequest& q, const Device& device) {
    if (auto wrong = wrong_route(q.path)) return wrong;
    if (q.path.key) {
        if (auto wrong = wrong_key(*q.path.key, device)) return wrong;
    }
    if (q.multiplier > 7) return Extended::timeout_multiplier_not_acceptable;
    const std::uint8_t transport = q.transport_class();
    if (transport > 3) return Extended::transport_class_not_supported;
    if (q.trigger() > Trigger::application) return Extended::trigger_not_supported;
    if (transport == 2) return Extended::class_and_trigger_not_supported;
    if (q.is_null()) return std::nullopt;
    if (q.ot.type != Half::Type::point_to_point) return Extended::invalid_ot_type;
    if (q.to.type == Half::Type::reserved) return Extended::invalid_to_type;
    if (q.ot.redundant_owner) return Extended::invalid_ot_redundant_owner;
    if (rpi_is_wrong(q)) return Extended::rpi_not_supported;
    if (q.path.inhibit_ms && std::uint64_t{*q.path.inhibit_ms} * 1000 > q.to.rpi_us) return Extended::rpi_below_inhibit_time;
    return std::nullopt;
}

std::optional<Response> plan_io(const OpenRequest& q, const Values& values, IoPlan& plan) {
    const bool produces = q.to.type != Half::Type::null;
    const std::size_t ends = produces ? 2 : 1;
    auto places = q.path.places;
    if (!q.path.symbols.empty() || std::ranges::any_of(places, [](const Place& p) { return p.class_id != class_id::assembly; }))
        return Response::refused(Extended::invalid_application_path);
    if (places.size() == ends + 1) {
        const auto configuration = values.assembly(places.front().instance);
        if (!configuration || configuration->role != AssemblyInfo::Role::configuration)
            return Response::refused(Extended::invalid_configuration_application_path);
        if (q.path.data && q.path.data->size() != configuration->size) return Response::refused(Extended::invalid_configuration_size);
        places.erase(places.begin());
    } else if (q.path.data && !q.path.data->empty()) {
        return Response::refused(Extended::invalid_configuration_size);
    }
    if (places.size() == 1 && ends == 2) places.push_back(places.front());
    if (places.size() != ends) return Response::refused(Extended::inconsistent_path_combination);

    const auto consumed = values.assembly(places[0].instance);
    using Role = AssemblyInfo::Role;
    if (!consumed || consumed->role == Role::input || consumed->role == Role::configuration)
        return Response::refused(Extended::invalid_consuming_path);
    // The output or input has no axis in this site.
    if (consumed->role == Role::output && consumed->size == 0) return Response::refused(Extended::device_not_configured);
    plan.role = consumed->role;
    plan.consumed = places[0].instance;
    plan.consumed_size = consumed->size;
    const std::size_t count = q.transport_class() == 1 ? 2 : 0;
    plan.header = plan.role == Role::output;
    // A heartbeat has no data; some originators send the header with it.
    if (!plan.header && q.ot.size == count + consumed->size + 4) plan.header = true;
    if (auto wrong = wrong_size(q.ot, count + consumed->size + (plan.header ? 4u : 0u), Extended::invalid_ot_size)) return wrong;
    if (!produces) return plan.role == Role::output ? std::nullopt : std::optional(Response::refused(Extended::invalid_to_type));

    const auto produced = values.assembly(places[1].instance);
    if (!produced || produced->role != Role::input) return Response::refused(Extended::invalid_producing_path);
    if (produced->size == 0) return Response::refused(Extended::device_not_configured);
    plan.produced = places[1].instance;
    plan.produced_size = produced->size;
    return wrong_size(q.to, count + produced->size, Extended::invalid_to_size);
}

}  // namespace axisgate::cip
