// Connection manager: opens, closes and describes connections.
// Two connections never command the same output, and never have the same triad.
#include "gateway/protocols/cip/connection_manager.hpp"

#include <algorithm>

namespace axisgate::cip {
namespace {
using Kind = Connection::Kind;
constexpr std::uint32_t multicast_base = 0xEFC00100;  // 239.192.1.0, volume 2, 3-5.3
constexpr std::uint16_t groups_per_device = 32;

Endpoint group_address(const Device& d, std::uint16_t number) {
    const std::uint32_t host = ((d.address & ~d.mask) - 1) & 0x3FF;
    return {multicast_base + host * groups_per_device + number % groups_per_device, default_io_port};
}

Response opened(const Connection& c) {
    Response r;
    put32(r.data, c.ot_id);
    put32(r.data, c.to_id);
    put16(r.data, c.request.triad.serial);
    put16(r.data, c.request.triad.vendor);
    put32(r.data, c.request.triad.originator);
    put32(r.data, c.request.ot.rpi_us);
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(c.interval).count();
    put32(r.data, c.interval > Duration::zero() ? static_cast<std::uint32_t>(us) : c.request.to.rpi_us);
    put16(r.data, 0);
    return r;
}

/// The activity of a connection, by which the one to close is chosen.
Standing standing_of(const Connection& c, const Values& values, Instant now) {
    if (c.kind == Kind::exclusive_owner) return c.received_any ? Standing::stop_path : Standing::known;
    if (!c.is_io()) {
        if (values.commands_by(c.session)) return Standing::stop_path;
        return now - c.last_received < std::chrono::seconds(1) ? Standing::strangers_work : Standing::stranger;
    }
    return c.received_any ? Standing::strangers_work : Standing::stranger;
}
}  // namespace

std::string_view name_of(Kind kind) noexcept {
    switch (kind) {
        case Kind::exclusive_owner:
            return "exclusive_owner";
        case Kind::input_only:
            return "input_only";
        case Kind::listen_only:
            return "listen_only";
        case Kind::explicit_messages:
            break;
    }
    return "messages";
}

ConnectionManager::ConnectionManager(Values& values, Carrier& carrier, const QosObject& marks, std::uint16_t incarnation)
    : values_(values), carrier_(carrier), marks_(marks), generation_(incarnation) {}

std::span<const std::uint16_t> ConnectionManager::all(std::uint32_t) const {
    static constexpr std::uint16_t list[] = {1, 2, 3, 4, 5, 6, 7, 8};
    return list;
}

General ConnectionManager::get(std::uint32_t, std::uint32_t attribute, const Context&, Bytes& to) {
    const Counter* const list[] = {&counters_.opened, &counters_.open_format,  &counters_.open_resource, &counters_.open_other,
                                   &counters_.closed, &counters_.close_format, &counters_.close_other,   &counters_.timed_out};
    if (attribute < 1 || attribute > std::size(list)) return General::attribute_not_supported;
    put16(to, static_cast<std::uint16_t>(list[attribute - 1]->value()));
    return General::success;
}

Response ConnectionManager::other(std::uint8_t service, std::uint32_t instance, View data, Context& context) {
    if (instance != 1) return Response::of(General::service_not_supported);
    switch (service) {
        case service::forward_open:
        case service::large_forward_open:
            return forward_open(data, service == service::large_forward_open, context);
        case service::forward_close:
            return forward_close(data, context);
        case service::get_connection_data:
        case service::search_connection_data:
            return connection_data(service, data);
        default:
            return Response::of(General::service_not_supported);
    }
}

Response ConnectionManager::forward_open(View data, bool large, Context& context) {
    counters_.opened.add();
    OpenRequest request;
    Response answer;
    if (!read_open(data, large, request, answer)) {
        counters_.open_format.add();
        return answer;
    }
    answer = open_one(request, context);
    if (answer.good()) return answer;
    const auto why = static_cast<Extended>(answer.extended.empty() ? 0 : answer.extended.front());
    const bool full = why == Extended::out_of_connections || why == Extended::object_out_of_connections;
    (full ? counters_.open_resource : counters_.open_other).add();
    return refuse_open(request.triad, std::move(answer));
}

Response ConnectionManager::open_one(const OpenRequest& request, Context& context) {
    if (const auto wrong = wrong_by_itself(request, values_.device())) return Response::refused(*wrong);
    if (request.is_null()) return open_null(request);
    if (find(request.triad)) return Response::refused(Extended::duplicate_forward_open);
    return request.transport_class() == 3 ? open_explicit(request, context) : open_io(request, context);
}

/// Opens nothing: checks whether the device is there (and configures it, if there is a configuration), or names an open connection.
Response ConnectionManager::open_null(const OpenRequest& request) {
    if (const Connection* const same = find(request.triad)) {
        if (!same_places(same->request.path, request.path)) return Response::refused(Extended::inconsistent_path_combination);
        if (request.path.data && !request.path.data->empty()) return Response::refused(Extended::invalid_configuration_size);
        return opened(*same);
    }
    for (const Place& p : request.path.places) {
        if (p.class_id == class_id::assembly && !values_.assembly(p.instance)) return Response::refused(Extended::invalid_application_path);
    }
    if (request.path.data && !request.path.data->empty()) return Response::refused(Extended::invalid_configuration_size);
    Connection none;
    none.request = request;
    return opened(none);
}

bool ConnectionManager::make_room(const Peer& newcomer, bool known, bool messages, Instant now) {
    std::vector<Guest> guests;
    std::vector<Connection*> whose;
    for (const auto& c : places_) {
        if (!c || (messages && c->is_io())) continue;
        guests.push_back({c->peer.from.address, standing_of(*c, values_, now), c->last_received});
        whose.push_back(c.get());
    }
    const std::size_t most = messages ? most_explicit : most_connections, spared = messages ? kept_explicit : kept;
    const auto verdict = find_place(guests, newcomer.from.address, known, {most - spared, spared, most_connections});
    if (!verdict.let_in || !verdict.closes) return verdict.let_in;
    Connection& goes = *whose[*verdict.closes];
    // An originator that already has most of them does not replace one of its own: it is told that there is no place.
    if (goes.peer.from.address == newcomer.from.address) return false;
    counters_.evicted.add();
    close(goes, End::to_make_room, now);
    return true;
}

Connection* ConnectionManager::place_for(const OpenRequest& request, const Context& context) {
    const auto free = std::ranges::find_if(places_, [](const auto& c) { return !c; });
    if (free == places_.end()) return nullptr;
    *free = std::make_unique<Connection>();
    Connection& c = **free;
    c.number = static_cast<std::uint16_t>(free - places_.begin() + 1);
    used_ = std::max<std::size_t>(used_, c.number);
    c.request = request;
    ++generation_;
    c.ot_id = (std::uint32_t{generation_} << 16) | c.number;
    c.to_id = request.to.id;
    c.peer = {context.peer.from, c.ot_id, context.session};
    c.session = context.session;
    c.since = c.last_received = context.now;
    c.expires = context.now + (request.transport_class() == 3 ? std::max(request.time_out(), first_data) : first_data);
    return &c;
}

Response ConnectionManager::open_explicit(const OpenRequest& request, Context& context) {
    if (request.to.type != Half::Type::point_to_point) return Response::refused(Extended::invalid_to_type);
    if (!request.is_server()) return Response::refused(Extended::direction_not_supported);
    const auto& p = request.path;
    if (p.places.size() != 1 || p.places[0].class_id != class_id::message_router || p.places[0].instance != 1)
        return Response::refused(Extended::invalid_application_path);
    constexpr std::uint16_t least = 8;  // a sequence count and the shortest message
    if (request.ot.size < least) return Response::refused(Extended::invalid_ot_size);
    if (request.to.size < least) return Response::refused(Extended::invalid_to_size);
    if (std::max(request.ot.size, request.to.size) > most_message) {
        Response r = Response::refused(Extended::invalid_connection_size);
        r.extended.push_back(most_message);
        return r;
    }
    const bool known = owns(context.peer.from.address) || values_.commands_by(context.session);
    if (!make_room(context.peer, known, true, context.now)) return Response::refused(Extended::object_out_of_connections);
    if (!make_room(context.peer, known, false, context.now)) return Response::refused(Extended::out_of_connections);
    Connection* const c = place_for(request, context);
    if (!c) return Response::refused(Extended::out_of_connections);
    c->kind = Kind::explicit_messages;
    return opened(*c);
}

std::optional<Extended> ConnectionManager::wrong_owner(const IoPlan& plan, const Peer& who, Instant now) const {
    using Role = AssemblyInfo::Role;
    if (plan.role == Role::output) {
        for (const auto& c : places_) {
            if (c && c->kind == Kind::exclusive_owner && values_.overlap(c->plan.consumed, plan.consumed))
                return Extended::ownership_conflict;
        }
        if (values_.held_by_another(plan.consumed, who, now)) return Extended::ownership_conflict;
    } else if (plan.role == Role::listen_only) {
        const bool there = std::ranges::any_of(
            places_, [&](const auto& c) { return c && c->is_io() && c->kind != Kind::listen_only && c->plan.produced == plan.produced; });
        if (!there) return Extended::non_listen_only_not_opened;
    }
    return std::nullopt;
}

Response ConnectionManager::open_io(const OpenRequest& request, Context& context) {
    IoPlan plan;
    if (auto wrong = plan_io(request, values_, plan)) return std::move(*wrong);
    if (const auto wrong = wrong_owner(plan, context.peer, context.now)) return Response::refused(*wrong);
    const bool known = plan.role == AssemblyInfo::Role::output;
    if (!make_room(context.peer, known, false, context.now)) return Response::refused(Extended::out_of_connections);
    Connection* const c = place_for(request, context);
    if (!c) return Response::refused(Extended::out_of_connections);
    using Role = AssemblyInfo::Role;
    c->plan = plan;
    c->kind = plan.role == Role::output ? Kind::exclusive_owner : plan.role == Role::input_only ? Kind::input_only : Kind::listen_only;
    c->interval = std::chrono::microseconds(request.to.rpi_us);
    if (plan.produced != 0) {
        c->sends = true;
        c->next = context.now;
        const Endpoint wanted = context.produce_to.value_or(Endpoint{});
        // Data go to the originator's own address, whatever address it wrote; the port is its own choice.
        c->produce_to = {context.peer.from.address, wanted.port != 0 ? wanted.port : default_io_port};
        if (request.trigger() != Trigger::cyclic) {
            const Duration inhibit =
                request.path.inhibit_ms ? Duration(std::chrono::milliseconds(*request.path.inhibit_ms)) : c->interval / 4;
            c->look = std::max<Duration>(inhibit, std::chrono::milliseconds(1));
            c->next_look = context.now + c->look;
        }
        if (c->multicasts()) join_group(*c, context);
    }
    if (values_.device().io_port != default_io_port) context.consume_at = Endpoint{values_.device().address, values_.device().io_port};
    if (c->kind == Kind::exclusive_owner) values_.opened(plan.consumed, c->peer, request.time_out(), context.now);
    return opened(*c);
}

/// Originators that read the same data by multicast share the datagrams, at the shortest interval that any of them wants.
void ConnectionManager::join_group(Connection& c, Context& context) {
    c.to_id = c.ot_id;
    c.produce_to = group_address(values_.device(), c.number);
    for (const auto& other : places_) {
        if (!other || other.get() == &c || !other->multicasts() || other->plan.produced != c.plan.produced) continue;
        c.to_id = other->to_id;
        c.produce_to = other->produce_to;
        c.interval = std::min(c.interval, other->interval);
        if (other->sends) {
            other->interval = c.interval;
            c.sends = false;
            c.next = c.next_look = never;
        }
    }
    context.multicast = c.produce_to;
}

Response ConnectionManager::forward_close(View data, const Context& context) {
    Reader r(data);
    r.skip(2);
    Triad triad;
    triad.serial = r.u16();
    triad.vendor = r.u16();
    triad.originator = r.u32();
    const std::size_t words = r.u8();
    r.skip(1);
    const View path = r.take(2 * words);
    if (r.bad() || r.left() > 0) {
        counters_.close_format.add();
        return Response::of(r.bad() ? General::not_enough_data : General::too_much_data);
    }
    std::size_t wrong_at = 0;
    const auto places = read_path(path, wrong_at);
    if (!places) {
        counters_.close_format.add();
        return refuse_open(triad, Response::refused(Extended::invalid_segment), words - std::min(words, wrong_at));
    }
    Connection* const c = find(triad);
    if (!c || c->peer.from.address != context.peer.from.address) {
        counters_.close_other.add();
        return refuse_open(triad, Response::refused(Extended::connection_not_found));
    }
    if (!same_places(*places, c->request.path) && !names_router(*places)) {
        counters_.close_other.add();
        return refuse_open(triad, Response::refused(Extended::close_path_mismatch));
    }
    counters_.closed.add();
    close(*c, End::closed, context.now);
    Response answer;
    put16(answer.data, triad.serial);
    put16(answer.data, triad.vendor);
    put32(answer.data, triad.originator);
    put16(answer.data, 0);
    return answer;
}

Response ConnectionManager::connection_data(std::uint8_t service, View data) const {
    Reader r(data);
    const Connection* c = nullptr;
    if (service == service::get_connection_data) {
        const std::uint16_t number = r.u16();
        c = number >= 1 && number <= places_.size() ? places_[number - 1u].get() : nullptr;
    } else {
        Triad triad;
        triad.serial = r.u16();
        triad.vendor = r.u16();
        triad.originator = r.u32();
        c = find(triad);
    }
    if (r.bad()) return Response::of(General::not_enough_data);
    if (r.left() > 0) return Response::of(General::too_much_data);
    if (!c)
        return service == service::get_connection_data ? Response::of(General::path_destination_unknown)
                                                       : Response::refused(Extended::connection_not_found);
    Response answer;
    Bytes& to = answer.data;
    put16(to, c->number);
    put16(to, 3);  // established
    put16(to, 1);  // originator's and target's port
    put16(to, 1);
    put16(to, c->request.triad.serial);
    put16(to, c->request.triad.vendor);
    put32(to, c->request.triad.originator);
    const auto half = [&](std::uint32_t theirs, std::uint32_t ours, const Half& h, std::uint32_t api_us) {
        put32(to, theirs);
        put32(to, ours);
        put32(to, c->request.multiplier);  // and three bytes that are reserved
        put32(to, h.rpi_us);
        put32(to, api_us);
    };
    half(c->request.ot.id, c->ot_id, c->request.ot, c->request.ot.rpi_us);
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(c->interval).count();
    half(c->request.to.id, c->to_id, c->request.to, c->is_io() ? static_cast<std::uint32_t>(us) : c->request.to.rpi_us);
    return answer;
}

Connection* ConnectionManager::find(const Triad& triad) const {
    const auto it = std::ranges::find_if(places_, [&](const auto& c) { return c && c->request.triad == triad; });
    return it == places_.end() ? nullptr : it->get();
}

void ConnectionManager::close(Connection& c, End why, Instant now) {
    const auto gone = std::move(places_[c.number - 1u]);
    if (!gone->is_io()) values_.messages_ended(gone->peer);
    if (gone->kind == Kind::exclusive_owner) values_.ended(gone->plan.consumed, gone->peer, why, now);
    if (!gone->is_io() || gone->plan.produced == 0) return;
    if (gone->sends && gone->multicasts()) {
        const auto heirs =
            std::ranges::find_if(places_, [&](const auto& c) { return c && c->multicasts() && c->plan.produced == gone->plan.produced; });
        if (Connection* const heir = heirs == places_.end() ? nullptr : heirs->get()) {
            heir->sends = true;
            heir->sent = gone->sent;
            heir->sent_count = gone->sent_count;
            heir->next = gone->next;
            heir->next_look = heir->look > Duration::zero() ? now + heir->look : never;
        }
    }
    if (gone->kind == Kind::listen_only) return;
    const bool others = std::ranges::any_of(
        places_, [&](const auto& o) { return o && o->is_io() && o->kind != Kind::listen_only && o->plan.produced == gone->plan.produced; });
    for (auto& o : places_) {
        if (!others && o && o->kind == Kind::listen_only && o->plan.produced == gone->plan.produced) o.reset();
    }
}

void ConnectionManager::close_all(End why, Instant now) {
    for (auto& c : places_) {
        if (c && (c->is_io() || why == End::by_gateway)) close(*c, why, now);
    }
}

bool ConnectionManager::owns(std::uint32_t address) const {
    return std::ranges::any_of(places_,
                               [&](const auto& c) { return c && c->kind == Kind::exclusive_owner && c->peer.from.address == address; });
}

void ConnectionManager::on_session_gone(SessionKey session) {
    for (auto& c : places_) {
        if (!c || c->session != session) continue;
        c->session = 0;
        if (!c->is_io()) c.reset();
    }
}

Connection* ConnectionManager::explicit_connection(std::uint32_t ot_id, SessionKey session) {
    const std::size_t number = ot_id & 0xFFFF;
    Connection* const c = number >= 1 && number <= places_.size() ? places_[number - 1].get() : nullptr;
    return c && c->ot_id == ot_id && !c->is_io() && c->session == session ? c : nullptr;
}

bool ConnectionManager::uses(SessionKey session) const {
    return std::ranges::any_of(places_, [&](const auto& c) { return c && c->session == session; });
}
std::size_t ConnectionManager::open() const {
    return static_cast<std::size_t>(std::ranges::count_if(places_, [](const auto& c) { return c != nullptr; }));
}
std::vector<std::uint16_t> ConnectionManager::numbers() const {
    std::vector<std::uint16_t> list;
    for (const auto& c : places_) {
        if (c) list.push_back(c->number);
    }
    return list;
}
bool ConnectionManager::io_open() const {
    return std::ranges::any_of(places_, [](const auto& c) { return c && c->is_io(); });
}
bool ConnectionManager::owned() const {
    return std::ranges::any_of(places_, [](const auto& c) { return c && c->kind == Kind::exclusive_owner; });
}
bool ConnectionManager::running() const {
    return std::ranges::any_of(places_, [](const auto& c) { return c && c->running; });
}
bool ConnectionManager::owned_by_other(std::uint32_t output, const Peer& than) const {
    return std::ranges::any_of(places_, [&](const auto& c) {
        return c && c->kind == Kind::exclusive_owner && c->peer.from.address != than.from.address &&
               (output == 0 || values_.overlap(c->plan.consumed, output));
    });
}

}  // namespace axisgate::cip
