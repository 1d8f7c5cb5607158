// Connection manager, implicit data: consuming, producing and time-outs.
// Datagrams are sent at their interval; those that were missed are not sent later in a burst.
#include <algorithm>
#include <utility>

#include "gateway/protocols/cip/connection_manager.hpp"

namespace axisgate::cip {
void ConnectionManager::on_implicit(View datagram, Endpoint from, Instant now) {
    const auto implicit = read_implicit(datagram);
    const std::size_t number = implicit ? implicit->connection & 0xFFFF : 0;
    Connection* const c = number >= 1 && number <= places_.size() ? places_[number - 1].get() : nullptr;
    if (!c || !c->is_io() || c->ot_id != implicit->connection) return counters_.unknown_connection.add();
    if (c->peer.from.address != from.address) return counters_.from_wrong_address.add();
    // Sequence numbers wrap around: a number that is not ahead of the newest is older.
    if (c->received_any && static_cast<std::int32_t>(implicit->sequence - c->received) <= 0) return counters_.stale.add();
    const std::size_t count = c->request.transport_class() == 1 ? 2 : 0;
    const std::size_t head = count + (c->plan.header ? 4 : 0);
    const std::size_t right = head + c->plan.consumed_size;
    // In idle mode an originator may omit the data.
    const bool only_head = c->plan.header && implicit->data.size() == head;
    if (implicit->data.size() != right && !only_head) return counters_.wrong_size.add();
    counters_.received.add();
    c->received = implicit->sequence;
    c->touch(now);
    consume(*c, implicit->data, now);
    c->received_any = true;
}

void ConnectionManager::consume(Connection& c, View bytes, Instant now) {
    Reader r(bytes);
    bool fresh = true;
    if (c.request.transport_class() == 1) {
        const std::uint16_t count = r.u16();
        fresh = !c.received_any || count != c.received_count;
        c.received_count = count;
    }
    const bool run = !c.plan.header || (r.u32() & 1) != 0;
    if (c.kind != Connection::Kind::exclusive_owner) {
        c.running = run;
        return;
    }
    const bool ran = std::exchange(c.running, run && r.left() == c.plan.consumed_size);
    if (!c.running) {
        if (ran) values_.idle(c.plan.consumed, c.peer, now);
    } else if (fresh || !ran) {
        values_.consumed(c.plan.consumed, r.rest(), c.peer, now);
    }
}

void ConnectionManager::produce(Connection& c, Instant now) {
    data_.clear();
    values_.read(c.plan.produced, now, data_);
    const bool counts = c.request.transport_class() == 1;
    ++c.sent_count;
    write_implicit(datagram_, c.to_id, ++c.sent, counts ? std::optional(c.sent_count) : std::nullopt, data_);
    if (c.look > Duration::zero()) c.sent_revision = values_.revision(c.plan.produced);
    counters_.sent.add();
    carrier_.implicit(c.produce_to, datagram_, marks_.implicit_mark(c.request.to.priority));
}

/// Change of state: data are sent when they change (at most every `look`), and otherwise at the interval.
void ConnectionManager::look(Connection& c, Instant now) {
    c.next_look = now + c.look;
    if (values_.revision(c.plan.produced) == c.sent_revision) return;
    produce(c, now);
    c.next = now + c.interval;
}

void ConnectionManager::on_deadline(Instant now) {
    for (std::size_t i = 0; i < used_; ++i) {
        Connection* const c = places_[i].get();
        if (!c) continue;
        if (c->expires <= now) {
            counters_.timed_out.add();
            close(*c, End::timed_out, now);
            continue;
        }
        if (!c->sends) continue;
        if (c->next <= now) {
            produce(*c, now);
            c->next += c->interval;
            if (c->next <= now) c->next = now + c->interval;  // missed datagrams are not sent later
            if (c->look > Duration::zero()) c->next_look = now + c->look;
        } else if (c->next_look <= now) {
            look(*c, now);
        }
    }
}

Instant ConnectionManager::deadline() const {
    Instant first = never;
    for (std::size_t i = 0; i < used_; ++i) {
        const Connection* const c = places_[i].get();
        if (c) first = std::min({first, c->expires, c->next, c->next_look});
    }
    return first;
}

}  // namespace axisgate::cip
