// Adapter: packets are served in their order of arrival; an answer that waits for a drive is sent when the drive has answered.
// A command on a session that is not registered is not trusted.
#include "gateway/protocols/cip/adapter.hpp"

#include <algorithm>

namespace axisgate::cip {
namespace {
constexpr Duration look_period = std::chrono::seconds(1);
constexpr unsigned token_shift = 8;  // lower bits: the part of a message
constexpr std::size_t most_unconnected = 504;

/// A fraction of the requested delay, computed from a number of this device only, so that two devices rarely answer together.
Duration spread(std::uint16_t asked_ms, std::uint32_t own) {
    const std::uint32_t most_ms = asked_ms == 0 ? 2000u : std::max<std::uint32_t>(asked_ms, 500u);
    own ^= own >> 15;
    own *= 0x2C1B3C6Du;
    own ^= own >> 12;
    return std::chrono::milliseconds(own % (most_ms + 1));
}
}  // namespace

Adapter::Adapter(Values& values, Output& output, std::uint16_t incarnation)
    : values_(values),
      output_(output),
      manager_(values, output, qos_, incarnation),
      identity_(values, manager_),
      assembly_(values, manager_),
      parameter_(values),
      own_(values),
      tcp_ip_(values),
      ethernet_link_(values),
      router_(manager_, output),
      handles_(std::uint32_t{incarnation} << 16) {
    for (Object* o :
         std::initializer_list<Object*>{&manager_, &identity_, &assembly_, &parameter_, &tcp_ip_, &ethernet_link_, &qos_, &configuration_})
        router_.add(*o);
    router_.add_own(own_);
}

bool Adapter::make_room(Endpoint newcomer, Instant now) {
    if (sessions_.size() < most_sessions - kept_sessions) return true;
    return find_room(newcomer, sessions_.size() >= most_sessions, now);
}

bool Adapter::give_way(Instant now) {
    const std::size_t before = sessions_.size();
    return find_room({}, true, now) && sessions_.size() < before;
}

/// First a session that is not registered gives way, then a silent one, from the address with most sessions; an active session only if its
/// address has more than an eighth of all.
bool Adapter::find_room(Endpoint newcomer, bool full, Instant now) {
    const PlaceRules rules{most_sessions - kept_sessions, kept_sessions};
    std::vector<Guest> guests;
    std::vector<SessionKey> keys;
    bool known = manager_.owns(newcomer.address);
    for (const auto& [key, s] : sessions_) {
        if (s.leaving) continue;
        const bool commands = values_.commands_by(key), uses = manager_.uses(key), works = now - s.last_received < std::chrono::seconds(1);
        known = known || (commands && s.from.address == newcomer.address);
        const Standing standing = commands || (uses && manager_.owns(s.from.address)) ? Standing::stop_path
                                  : s.handle == 0                                     ? Standing::stranger
                                  : uses                                              ? Standing::strangers_work
                                  : works                                             ? Standing::strangers_work
                                                                                      : Standing::stranger;
        guests.push_back({s.from.address, standing, s.last_received});
        keys.push_back(key);
    }
    const auto verdict = find_place(guests, newcomer.address, known, rules, full);
    if (!verdict.let_in || !verdict.closes) return verdict.let_in;
    counters_.sessions_evicted.add();
    const SessionKey key = keys[*verdict.closes];
    output_.hang_up(key);
    on_disconnected(key);
    return true;
}

bool Adapter::on_connected(SessionKey key, Endpoint from, Instant now) {
    if (!make_room(from, now)) {
        counters_.sessions_refused.add();
        return false;
    }
    Session& s = sessions_[key];
    s.from = from;
    s.since = s.last_received = now;
    counters_.sessions_opened.add();
    if (next_look_ == never) next_look_ = now + look_period;
    return true;
}

void Adapter::on_disconnected(SessionKey key) {
    const auto it = sessions_.find(key);
    if (it == sessions_.end()) return;
    const Peer way{it->second.from, 0, key};
    sessions_.erase(it);
    manager_.on_session_gone(key);
    std::erase_if(waiting_, [&](const auto& w) { return w.second.route.session == key; });
    values_.messages_ended(way);
}

std::optional<Instant> Adapter::last_received(SessionKey key) const {
    const auto it = sessions_.find(key);
    return it == sessions_.end() ? std::nullopt : std::optional(it->second.last_received);
}

void Adapter::hang_up(SessionKey key, Session& session) {
    if (session.leaving) return;
    session.leaving = true;
    output_.hang_up(key);
}

void Adapter::on_stream(SessionKey key, View bytes, Instant now) {
    while (!bytes.empty()) {
        const auto it = sessions_.find(key);
        if (it == sessions_.end() || it->second.leaving) return;
        Session& s = it->second;
        s.last_received = now;
        const std::size_t n = std::min(bytes.size(), s.framer.room());
        s.framer.add(bytes.first(n));
        bytes = bytes.subspan(n);
        for (auto next = s.framer.next(); next.verdict != Framer::Verdict::need_more; next = s.framer.next()) {
            if (next.verdict == Framer::Verdict::too_long) {
                counters_.wrong_packets.add();
                say(key, next.header, PacketStatus::invalid_length);
                return hang_up(key, s);
            }
            packet_from(key, s, next.header, next.data, now);
            if (s.leaving) return;
        }
    }
}

void Adapter::say(SessionKey key, const Header& header, PacketStatus status, View data) {
    Header of = header;
    of.status = static_cast<std::uint32_t>(status);
    begin_packet(out_);
    put_bytes(out_, data);
    end_packet(out_, of);
    output_.stream(key, out_);
}

bool Adapter::listing(const Header& header, View data, Bytes& to) const {
    Bytes items;
    switch (static_cast<Order>(header.command)) {
        case Order::list_identity:
            put16(items, 1);
            put_item(items, item::identity, identity_.item());
            break;
        case Order::list_services: {
            Bytes service;
            put16(service, protocol_version);
            put16(service, 1u << 5 | 1u << 8);  // messages over TCP, implicit data over UDP
            static constexpr char name[16] = "Communications";
            service.insert(service.end(), std::begin(name), std::end(name));
            put16(items, 1);
            put_item(items, item::services, service);
            break;
        }
        case Order::list_interfaces:
            put16(items, 0);
            break;
        default:
            return false;
    }
    to = data.empty() ? packet(header, PacketStatus::success, items) : packet(header, PacketStatus::invalid_length);
    return true;
}

void Adapter::packet_from(SessionKey key, Session& s, const Header& header, View data, Instant now) {
    if (header.options != 0) return counters_.wrong_packets.add();  // the standard requires to discard such a packet
    counters_.requests.add();
    Bytes list;
    if (listing(header, data, list)) return output_.stream(key, list);
    switch (static_cast<Order>(header.command)) {
        case Order::nop:
            return;
        case Order::register_session:
            return register_session(key, s, header, data);
        case Order::unregister_session:
            if (s.handle == 0 || header.session != s.handle) return say(key, header, PacketStatus::invalid_session);
            return hang_up(key, s);
        case Order::send_rr_data:
        case Order::send_unit_data:
            if (s.handle == 0 || header.session != s.handle) return say(key, header, PacketStatus::invalid_session);
            if (header.command == static_cast<std::uint16_t>(Order::send_rr_data)) return rr_data(key, s, header, data, now);
            return unit_data(key, header, data, now);
        default:
            counters_.wrong_packets.add();
            return say(key, header, PacketStatus::invalid_command);
    }
}

void Adapter::register_session(SessionKey key, Session& s, const Header& header, View data) {
    if (data.size() != 4) return say(key, header, PacketStatus::invalid_length);
    if (s.handle != 0) return say(key, header, PacketStatus::invalid_command, data);
    Reader r(data);
    Bytes mine;
    put16(mine, protocol_version);
    put16(mine, 0);
    if (r.u16() != protocol_version || r.u16() != 0) return say(key, header, PacketStatus::unsupported_revision, mine);
    if (++handles_ == 0) ++handles_;
    s.handle = handles_;
    Header answer = header;
    answer.session = s.handle;
    say(key, answer, PacketStatus::success, mine);
}

void Adapter::rr_data(SessionKey key, Session& s, const Header& header, View data, Instant now) {
    Reader r(data);
    const std::uint32_t interface = r.u32();
    r.skip(2);
    const auto items = r.bad() || interface != 0 ? std::nullopt : read_items(r.rest());
    if (!items || items->count < 2 || items->list[0].type != item::null_address || !items->list[0].data.empty() ||
        items->list[1].type != item::unconnected_data) {
        counters_.wrong_packets.add();
        return say(key, header, PacketStatus::incorrect_data);
    }
    Context context;
    context.now = now;
    context.peer = {s.from, 0, key};
    context.session = key;
    if (const Item* to = items->find(item::sockaddr_to)) context.produce_to = endpoint_of(*to);
    Route route;
    route.session = key;
    route.header = header;
    route.most = most_unconnected;
    message(items->list[1].data, std::move(route), context);
}

void Adapter::unit_data(SessionKey key, const Header& header, View data, Instant now) {
    Reader r(data);
    const std::uint32_t interface = r.u32();
    r.skip(2);
    const auto items = r.bad() || interface != 0 ? std::nullopt : read_items(r.rest());
    // No answer: this request has no error answer, and an originator without an answer repeats it or closes its connection.
    if (!items || items->count < 2 || items->list[0].type != item::connected_address || items->list[0].data.size() != 4 ||
        items->list[1].type != item::connected_data || items->list[1].data.size() < 2)
        return counters_.wrong_packets.add();
    Connection* const c = manager_.explicit_connection(Reader(items->list[0].data).u32(), key);
    if (!c) return counters_.wrong_packets.add();
    c->touch(now);
    Reader body(items->list[1].data);
    const std::uint16_t count = body.u16();
    Route route;
    route.session = key;
    route.header = header;
    route.connection = c->ot_id;
    route.count = count;
    route.most = c->request.to.size - 2u;
    if (c->asked_any && c->asked == count) {  // a repetition: the same answer is sent again, if there is one
        if (!c->answered.empty()) output_.stream(key, c->answered);
        return;
    }
    c->asked_any = true;
    c->asked = count;
    c->answered.clear();
    Context context;
    context.now = now;
    context.peer = c->peer;
    context.session = key;
    message(body.rest(), std::move(route), context);
}

void Adapter::message(View bytes, Route route, Context context) {
    context.most_answer = route.most - 4;
    context.device = &values_.device();
    const std::uint64_t exchange = ++exchanges_;
    const bool may_wait = waiting_.size() < most_waiting;
    context.token = may_wait ? exchange << token_shift : 0;
    auto parts = router_.handle(bytes, context);
    const auto put = [&](std::uint16_t type, const std::optional<Endpoint>& e) {
        if (!e) return;
        Bytes address;
        put_sockaddr(address, *e);
        put_item(route.items, type, address);
        ++route.extra;
    };
    put(item::sockaddr_ot, context.consume_at);
    put(item::sockaddr_to, context.multicast);
    if (parts.pending > 0) {
        waiting_.emplace(exchange, Waiting{std::move(route), std::move(parts)});
    } else {
        answer(route, parts);
    }
}

/// Composed in the output buffer: an answer is copied once, by the kernel.
void Adapter::answer(const Route& route, const Router::Parts& parts) {
    Connection* const c = route.connection == 0 ? nullptr : manager_.explicit_connection(route.connection, route.session);
    if (route.connection != 0 && !c) return;  // closed meanwhile
    Header header = route.header;
    header.status = static_cast<std::uint32_t>(PacketStatus::success);
    begin_packet(out_);
    // Interface and time-out are 0. Then the items: an address, the data, whose length is set when it is known.
    const std::size_t data_at = header_size + (c ? 16 : 12);
    out_.resize(data_at + (c ? 6 : 4));
    std::uint8_t* const items = out_.data() + header_size + 6;
    set16(items, static_cast<std::uint16_t>(2 + route.extra));
    set16(items + 2, c ? item::connected_address : item::null_address);
    set16(items + 4, c ? 4 : 0);
    if (c) set32(items + 6, c->to_id);
    set16(out_.data() + data_at, c ? item::connected_data : item::unconnected_data);
    if (c) set16(out_.data() + data_at + 4, route.count);
    Router::put_answer(out_, parts, route.most - 4);
    set16(out_.data() + data_at + 2, static_cast<std::uint16_t>(out_.size() - data_at - 4));
    if (!c) put_bytes(out_, route.items);
    end_packet(out_, header);
    if (c && c->asked == route.count) c->answered = out_;
    output_.stream(route.session, out_);
}

void Adapter::answered(Token token, General general, View value, std::uint16_t extended) {
    const auto it = waiting_.find(token >> token_shift);
    const std::size_t index = token & ((1u << token_shift) - 1);
    if (it == waiting_.end() || index >= it->second.parts.parts.size()) return;
    Router::Parts& parts = it->second.parts;
    Response& r = parts.parts[index].response;
    if (!r.pending) return;
    if (general == General::success) {
        r.pending = false;
        r.data.insert(r.data.begin(), value.begin(), value.end());
        if (r.data.size() > it->second.route.most - 4) r = Response::of(General::reply_data_too_large);
    } else {
        r = Response::of(general);
        if (extended != 0) r.extended.push_back(extended);
    }
    if (--parts.pending > 0) return;
    const Waiting done = std::move(it->second);
    waiting_.erase(it);
    answer(done.route, done.parts);
}

void Adapter::on_datagram(View bytes, Endpoint from, bool broadcast, Instant now) {
    if (bytes.size() < header_size) return counters_.wrong_packets.add();
    const Header header = read_header(bytes);
    if (header.options != 0 || header.length != bytes.size() - header_size) return counters_.wrong_packets.add();
    counters_.requests.add();
    Bytes list;
    if (!listing(header, bytes.subspan(header_size), list)) {
        if (header.command != static_cast<std::uint16_t>(Order::nop) && !broadcast)
            output_.datagram(from, packet(header, PacketStatus::invalid_command));
        return;
    }
    if (!broadcast || header.command != static_cast<std::uint16_t>(Order::list_identity)) return output_.datagram(from, list);
    if (late_.size() >= most_late) return;
    const auto asked_ms = static_cast<std::uint16_t>(header.context[0] | header.context[1] << 8);
    const std::uint32_t own = values_.device().serial ^ values_.device().address ^ static_cast<std::uint32_t>(ns_of(now));
    late_.push_back({now + spread(asked_ms, own), from, std::move(list)});
}

std::vector<Adapter::SessionReport> Adapter::session_reports() const {
    std::vector<SessionReport> list;
    for (const auto& [key, s] : sessions_) {
        if (!s.leaving) list.push_back({key, s.from, s.since, s.last_received, s.handle != 0});
    }
    std::ranges::sort(list, {}, &SessionReport::key);
    return list;
}

bool Adapter::close_session(SessionKey key) {
    const auto it = sessions_.find(key);
    if (it == sessions_.end()) return false;
    hang_up(key, it->second);
    return true;
}

void Adapter::on_deadline(Instant now) {
    manager_.on_deadline(now);
    for (std::size_t i = 0; i < late_.size();) {
        if (late_[i].due > now) {
            ++i;
            continue;
        }
        output_.datagram(late_[i].to, late_[i].bytes);
        late_.erase(late_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (next_look_ > now) return;
    next_look_ = sessions_.empty() ? never : now + look_period;
    const Duration limit = std::chrono::seconds(tcp_ip_.inactivity_s());
    for (auto& [key, s] : sessions_) {
        const bool registered = s.handle != 0;
        if (registered && (limit <= Duration::zero() || manager_.uses(key))) continue;
        if (now - s.last_received < (registered ? limit : unregistered_time_out)) continue;
        if (!s.leaving) counters_.sessions_silent.add();
        hang_up(key, s);
    }
}

Instant Adapter::deadline() const {
    Instant first = std::min(manager_.deadline(), next_look_);
    for (const Late& l : late_)
        first = std::min(first, l.due);
    return first;
}

}  // namespace axisgate::cip
