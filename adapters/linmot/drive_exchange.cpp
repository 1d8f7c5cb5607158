#include "adapters/linmot/drive_exchange.hpp"

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {

void Exchanges::missed(Instant now) noexcept { late_.missed(now, drive_.bus.timing.reply_timeout); }

Ticket Exchanges::order_of(const Request& r) const noexcept {
    return r.purpose == Purpose::stop ? drive_.stops.order() : r.purpose == Purpose::job ? drive_.jobs.job().command.ticket : no_ticket;
}

void Exchanges::send(Request r, Turn& t) {
    Bus& bus = drive_.bus;
    const auto bytes = pack(r.telegram, bus.checksum);
    const Duration both = bus.wire(bytes.size() + wire_size(drive_.start.response_size() + value_size, bus.checksum));
    const bool poll = r.purpose == Purpose::poll || r.purpose == Purpose::probe;
    const bool once = (poll && !bus.shared.shared(t.now)) || r.purpose == Purpose::stream || r.any_length || r.quiet || r.once;
    bus.shared.sends(t.now, bus.wire(bytes.size()));
    timed_out_at_ = never;
    t.out.send(Frame::run(bytes), r.purpose == Purpose::stop ? Priority::urgent : poll ? Priority::poll : Priority::command, order_of(r));
    const auto period = r.purpose == Purpose::stream ? drive_.stream.patience() : std::nullopt;
    exchange_.begin(std::move(r), t.now, period.value_or(bus.timing.reply_timeout + both), once ? 0 : bus.timing.retries);
}

bool Exchanges::answers(const Telegram& a) const noexcept {
    if (!active() || a.main != 0) return false;
    const Request& r = request();
    if (r.any_length) return true;
    const Telegram& q = r.telegram;
    const std::size_t response = drive_.start.response_size();
    const bool probe = r.purpose == Purpose::probe;
    switch (static_cast<Main>(q.main)) {
        case Main::parameters:
        case Main::table:
            return a.sub == static_cast<std::uint8_t>((q.main == 5 ? 0x50 : 0x80) + q.sub) && a.size == 7 &&
                   (q.sub == 0x0B || q.size < 2 || (q.main == 8 && q.sub == 0) || a.u16(1) == q.u16(0));
        case Main::curves:
            return a.sub == 0x40 && a.size == 7 && (q.size < 2 || a.u16(1) == q.u16(0));
        case Main::errors:
            return a.sub == static_cast<std::uint8_t>(0x70 + q.sub);
        case Main::program:
            return q.sub == 4 || q.sub == 1 ? a.sub == 0x60 : a.sub == 0 && drive_.start.response_fits(a.size);
        case Main::ram:  // its sub ID is not known
            return a.size == (probe ? size_without_position : response) + value_size;
        default:
            if (probe) return a.sub == 0 && a.size > 0;
            return a.sub == 0 && (q.main == 0 && q.sub == 3 ? a.size > response : drive_.start.response_fits(a.size));
    }
}

Request Exchanges::answered() {
    late_.settled();
    return exchange_.answered(drive_.bus.counters);
}

bool Exchanges::on_deadline(Turn& t) {
    SharedLine& shared = drive_.bus.shared;
    if (active() && t.now >= deadline() && exchange_.repeatable()) {
        timed_out_at_ = std::min(timed_out_at_, t.now);
        const Instant at = shared.repeat_at(t.now, timed_out_at_, exchange_.tries());
        if (at > t.now) {
            exchange_.extend(at);
            return false;
        }
    }
    timed_out_at_ = never;
    const auto late = exchange_.on_deadline(t.now, drive_.bus.counters);
    if (late == drive::Late::repeat) {
        repeated_at_ = t.now;
        const auto bytes = pack(request().telegram, drive_.bus.checksum);
        shared.sends(t.now, drive_.bus.wire(bytes.size()));
        t.out.send(Frame::run(bytes), request().purpose == Purpose::stop ? Priority::urgent : Priority::command, order_of(request()));
    }
    return late == drive::Late::over;
}

void Exchanges::no_repeats() noexcept {
    if (active() && request().purpose == Purpose::job) exchange_.no_repeats();
}

}  // namespace axisgate::linmot
