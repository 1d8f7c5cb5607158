// A PDO is applied completely or not at all. For time that has passed, only a bounded number of frames is sent.
#include "adapters/cia402/twin/node.hpp"

#include <algorithm>

namespace axisgate::cia402_drive::twin {
using canopen::Abort;
using canopen::Address;
using canopen::NmtCommand;
using canopen::NmtState;
using canopen::PdoDirection;

namespace {
constexpr std::int64_t save_word = 0x65766173, load_word = 0x64616F6C;  // "save", "load"
constexpr int most_events = 100'000;                                    // in one call; older ones are dropped

/// Memory of a node, and what it has without it.
struct Origin {
    const NonVolatile& memory;
    const Freedoms& freedoms;
};
/// The value of the memory, or the maker's. Memory of an object that the drive lacks does not count.
void restore(canopen::Dictionary& d, const Origin& from, Address address, const canopen::Entry& made) {
    const auto kept = from.memory.find(memory_key(address));
    const bool uses = kept != from.memory.end() && !from.freedoms.lacks(address.index);
    if (!uses || !d.set(address, kept->second)) (void)d.set_bytes(address, made.bytes);
}
/// The order that another master on the bus gives; this node carries it out as well.
void stop_as_other_master(std::uint8_t node, Instant at, Out& out) {
    Frame order = canopen::nmt_frame(NmtCommand::stop, node);
    order.at = at;
    out.send(order);
}
}  // namespace

Node::Node(std::uint8_t node, canopen::Dictionary dictionary)
    : node_(node), factory_(std::move(dictionary)), d_(factory_), server_(node, d_) {
    d_.on_write([this](Address a, std::span<const std::uint8_t> bytes) { return on_write(a, bytes); });
    d_.on_read([this](Address a) {
        if (free_.lacks(a.index)) return Abort::no_object;
        if (a.index >= 0x2000) show(now_);
        return Abort::none;
    });
}

void Node::show(Instant now) {
    if (shown_ == now) return;
    device_->refresh(now);
    shown_ = now;
}

void Node::send(Frame f, Instant at, Out& out) const {
    if (silent_ || !powered_) return;
    f.at = at;
    out.send(f);
}

void Node::load() {
    for (const auto& [address, entry] : factory_.entries()) {
        if (device_->keeps(address, entry)) {
            restore(d_, {stored_, free_}, address, entry);
        } else {
            (void)d_.set_bytes(address, entry.bytes);
        }
    }
    shape_pdos(free_, stored_, d_);
    device_->load(stored_);
}
void Node::save() {
    NonVolatile now;
    for (const auto& [address, entry] : factory_.entries())
        if (device_->keeps(address, entry) && d_.find(address)->bytes != entry.bytes) now[memory_key(address)] = d_.value(address);
    device_->save(now);
    if (now != stored_) ++revision_;
    stored_ = std::move(now);
}

void Node::power_on(const NonVolatile& memory, Instant now, Out& out) {
    now_ = now;
    if (memory != stored_) stored_ = memory;
    powered_ = true;
    shown_.reset();
    awake_at_ = other_stop_ = never;
    other_stopped_ = false;
    reset(true, now, out);
}
void Node::power_off(Instant now) {
    device_->power_off(now);
    (void)device_->take_reported();
    powered_ = false;
    state_ = NmtState::boot_up;
    requests_.clear();
    heartbeat_.set_period({}, now);
    awake_at_ = never;
    guard_.set({}, 0);
    watch_ = canopen::HeartbeatWatch{0};
    server_.reset();
    for (auto* list : {&receive_, &transmit_})
        for (Pdo& p : *list)
            p = {};
}

void Node::reset(bool all, Instant now, Out& out) {
    if (std::exchange(restore_, false)) {
        ++revision_;
        stored_.clear();
    }
    if (all) {
        if (device_->powered()) device_->power_off(now);
        load();
        device_->power_on(now);
    } else {
        for (const auto& [address, entry] : factory_.entries()) {
            if (address.index >= 0x2000) break;
            restore(d_, {stored_, free_}, address, entry);
        }
        shape_pdos(free_, stored_, d_);
    }
    server_.reset();
    requests_.clear();
    guard_.reset();
    boot(now, out);
}
void Node::boot(Instant now, Out& out) {
    state_ = NmtState::pre_operational;
    send(canopen::heartbeat_frame(node_, NmtState::boot_up), now, out);
    heartbeat_.set_period(std::chrono::milliseconds(d_.integer({0x1017, 0}).value_or(0)), now);
    guard_.set(std::chrono::milliseconds(d_.integer({0x100C, 0}).value_or(0)),
               static_cast<std::uint8_t>(d_.integer({0x100D, 0}).value_or(0)));
    watch_as_written();
    read_sync();
    read_pdos(now);
}

void Node::read_sync() {
    sync_id_ = static_cast<std::uint32_t>(d_.integer({0x1005, 0}).value_or(0x80)) & 0x7FFu;
    sync_overflow_ = static_cast<int>(d_.integer({0x1019, 0}).value_or(0));
}

/// 1016h:01: the node in bits 16 to 22, its time in ms in the low word; monitoring begins with its first heartbeat (CiA 301).
void Node::watch_as_written() {
    const auto entry = static_cast<std::uint32_t>(d_.integer({0x1016, 1}).value_or(0));
    const auto node = (entry >> 16) & 0xFFu;
    const bool valid = node >= 1 && node <= 127;
    watched_ = static_cast<std::uint8_t>(valid ? node : 0);
    watch_ = canopen::HeartbeatWatch(watched_, std::chrono::milliseconds(valid ? entry & 0xFFFFu : 0u));
}

Acceptance Node::acceptance() const noexcept {
    // The connection set has the node's number in the low seven bits. If PDOs have other identifiers, or SYNC is elsewhere, the node
    // receives all frames.
    const auto own = [this](const Pdo& p) { return !p.valid || (p.pdo.settings.id & 0x7Fu) == node_; };
    if (sync_id_ != canopen::sync_id || !std::ranges::all_of(receive_, own) || !std::ranges::all_of(transmit_, own)) return {};
    return {{{{0x7F, node_}, {0x7F, 0}, {0x7F, watched_}}}, 3};
}

/// No master is present, or the monitored heartbeat has stopped. 1029h:01 = 0: the node leaves the operational state (CiA 301, the
/// default).
void Node::connection_lost(Instant at, Out& out) {
    shown_.reset();
    if (d_.integer({0x6007, 0}).value_or(0) != 1)
        send(canopen::emergency_frame(node_, {0x8130, 0x11, {}}), at, out);  // 1: a fault has reported it
    device_->connection_lost(at);
    if (state_ == NmtState::operational && d_.integer({0x1029, 1}).value_or(0) == 0) state_ = NmtState::pre_operational;
}

void Node::read_pdos(Instant now) {
    for (std::uint16_t n = 1; n <= pdos; ++n)
        for (const auto direction : {PdoDirection::receive, PdoDirection::transmit})
            read_pdo(direction, n, now);
}
void Node::read_pdo(PdoDirection direction, std::uint16_t n, Instant now) {
    Pdo& p = (direction == PdoDirection::receive ? receive_ : transmit_)[n - 1u];
    Abort fault = Abort::none;
    const auto read = canopen::pdo_of(d_, direction, n, fault);
    const bool valid = read && read->settings.valid;
    if (valid && p.valid && p.pdo == *read) return;  // sub 6 is written while the PDO is disabled
    p = {};
    p.valid = valid;
    if (read) p.pdo = *read;
    if (direction == PdoDirection::transmit) p.start = static_cast<int>(d_.integer({canopen::settings_index(direction, n), 6}).value_or(0));
    for (const auto& m : p.pdo.mapping)
        p.entries.push_back(d_.find(m.address));
    if (valid && direction == PdoDirection::transmit && p.pdo.settings.event_ms > 0)
        p.event = now + std::chrono::milliseconds(p.pdo.settings.event_ms);
}

Abort Node::on_write(Address a, std::span<const std::uint8_t> bytes) {
    if (free_.lacks(a.index)) return Abort::no_object;
    const auto v = static_cast<std::int64_t>(canopen::low_first(bytes));
    if (const Abort fault = fault_of_setup({free_, d_, state_ == NmtState::pre_operational}, a, v); fault != Abort::none) return fault;
    if (a.index == 0x1010 && v != save_word) return Abort::transfer;
    if (a.index == 0x1011 && v != load_word) return Abort::transfer;
    if (const Abort fault = fault_of_mapping(free_, d_, a, v); fault != Abort::none) return fault;
    // CiA 301, 7.5.2.17: 1 is not a valid overflow, and it is constant while a period is produced; 7.5.2.37: sub 6 is constant while the
    // PDO is enabled.
    if (a.index == 0x1019 && v == 1) return Abort::value;
    if (a.index == 0x1019 && d_.integer({0x1006, 0}).value_or(0) != 0) return Abort::device_state;
    if (a.index >= 0x1800 && a.index < 0x1800 + pdos && a.sub == 6) {
        if (v > 240) return Abort::value;
        if (transmit_[a.index - 0x1800u].valid) return Abort::device_state;
    }
    const canopen::Entry* e = d_.find(a);
    const bool is_signed = e && canopen::is_signed(e->type);
    const Abort refused = device_->may_write(
        a, is_signed ? canopen::as_signed(static_cast<std::uint64_t>(v), static_cast<std::uint8_t>(8 * bytes.size())) : v, now_);
    if (refused == Abort::none) writes_.push_back(a);
    return refused;
}

void Node::take_writes(Instant now, Out& out) {
    if (!writes_.empty()) shown_.reset();
    for (const Address a : std::exchange(writes_, {})) {
        device_->written(a, now);
        if (a.index == 0x1016) watch_as_written();
        if (a.index == 0x1017) heartbeat_.set_period(std::chrono::milliseconds(d_.integer(a).value_or(0)), now);
        if (a.index == 0x1005 || a.index == 0x1019) read_sync();
        if (a.index == 0x100C || a.index == 0x100D)
            guard_.set(std::chrono::milliseconds(d_.integer({0x100C, 0}).value_or(0)),
                       static_cast<std::uint8_t>(d_.integer({0x100D, 0}).value_or(0)));
        // 1400h and 1600h: received PDOs, 1800h and 1A00h: sent PDOs; the low byte is the number of the PDO.
        if (a.index >= 0x1400 && a.index < 0x1C00 && (a.index & 0xFFu) < pdos)
            read_pdo(a.index < 0x1800 ? PdoDirection::receive : PdoDirection::transmit, static_cast<std::uint16_t>((a.index & 0xFFu) + 1),
                     now);
        if (a.index == 0x1003) {
            for (std::uint8_t i = 1; i <= 4; ++i)
                (void)d_.set({0x1003, i}, Value{std::int64_t{0}});
        }
        if (a.index == 0x1010) {
            (void)d_.set(a, Value{std::int64_t{1}});
            save();
        }
        if (a.index == 0x1011) {
            (void)d_.set(a, Value{std::int64_t{1}});
            restore_ = true;
        }
    }
    events(now, out);
}

void Node::nmt(NmtCommand command, Instant now, Out& out) {
    switch (command) {
        case NmtCommand::start:
            if (state_ != NmtState::operational)
                for (Pdo& p : transmit_)
                    p.syncs = 0, p.begun = false;
            state_ = NmtState::operational;
            if (free_.stopped_by_other > Duration::zero() && !std::exchange(other_stopped_, true))
                other_stop_ = now + free_.stopped_by_other;
            for (Pdo& p : transmit_)
                if (p.valid && p.pdo.settings.event_ms > 0) p.event = now + std::chrono::milliseconds(p.pdo.settings.event_ms);
            return events(now, out);
        case NmtCommand::stop:
            state_ = NmtState::stopped;
            shown_.reset();
            device_->connection_lost(now);
            return events(now, out);
        case NmtCommand::pre_operational:
            state_ = NmtState::pre_operational;
            return;
        case NmtCommand::reset_node:
            if (free_.boot == Duration::zero()) return reset(true, now, out);
            power_off(now);
            powered_ = true;
            awake_at_ = now + free_.boot;
            return;
        case NmtCommand::reset_communication:
            return reset(false, now, out);
    }
}

void Node::on_frame(const Frame& f, Instant now, Out& out) {
    if (!powered_) return;
    advance(now, out);
    now_ = now;
    if (awake_at_ != never) return;
    if (f.kind != Frame::Kind::can || f.extended) return;
    if (const auto command = canopen::nmt_for(f, node_)) return nmt(*command, now, out);
    (void)watch_.on_frame(f, now);
    if (const auto answer = guard_.on_frame(f, now, node_, state_)) return send(*answer, now, out);
    if (state_ == NmtState::stopped) return;
    if (canopen::is_data(f, sync_id_)) return on_sync(f, now, out);
    if (canopen::is_data(f, std::uint32_t{canopen::sdo_request_base} + node_))
        return free_.sdo_answer > Duration::zero() || !requests_.empty() ? keep_request(f, now) : serve_request(f, now, out);
    if (state_ != NmtState::operational) return;
    for (Pdo& p : receive_)
        if (p.valid && canopen::is_data(f, p.pdo.settings.id)) return receive(p, f.data(), now, out);
    for (Pdo& p : transmit_)
        if (p.valid && p.pdo.settings.remote_allowed && canopen::is_remote(f, p.pdo.settings.id)) return transmit(p, now, out);
}

void Node::keep_request(const Frame& f, Instant now) {
    if (requests_.size() >= most_requests) return;
    requests_.push_back({f, (requests_.empty() ? now : std::max(now, requests_.back().due)) + free_.sdo_answer});
}
void Node::serve_request(const Frame& f, Instant at, Out& out) {
    std::vector<Frame> answers;
    (void)server_.on_frame(f, at, answers);
    for (const Frame& a : answers)
        send(a, at, out);
    take_writes(at, out);
}

void Node::receive(Pdo& p, std::span<const std::uint8_t> bytes, Instant now, Out& out) {
    std::vector<std::uint64_t> values;
    const auto length = canopen::unpack(p.pdo.mapping, bytes, values);
    if (length == canopen::PdoLength::shorter) {
        return send(canopen::emergency_frame(node_, {0x8210, 0x11, {}}), now, out);
    }
    if (p.pdo.settings.transmission <= 240) {
        p.waiting.assign(bytes.begin(), bytes.end());
        return;
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto& m = p.pdo.mapping[i];
        std::vector<std::uint8_t> raw(m.bits / 8);
        canopen::put_low_first(values[i], raw);
        (void)d_.write(m.address, raw, true);
    }
    take_writes(now, out);
}

/// Whether a synchronous PDO is sent at this SYNC: with a start value, the SYNC with that counter is the first one; then every n-th SYNC,
/// counted from there (CiA 301, 7.5.2.37).
bool Node::due(Pdo& p, int counter) const {
    if (p.start != 0 && sync_overflow_ != 0 && !p.begun) {
        if (counter != p.start) return false;
        p.begun = true;
    }
    if (p.pdo.settings.transmission == 0) return true;
    if (++p.syncs < p.pdo.settings.transmission) return false;
    p.syncs = 0;
    return true;
}

void Node::on_sync(const Frame& sync, Instant now, Out& out) {
    const auto counter = sync.data();
    if (counter.size() != (sync_overflow_ != 0 ? 1u : 0u)) {
        if (!std::exchange(sync_odd_, true)) send(canopen::emergency_frame(node_, {0x8240, 0x11, {}}), now, out);
        return;
    }
    sync_odd_ = false;
    if (state_ != NmtState::operational) return;
    for (Pdo& p : transmit_) {
        if (!p.valid || p.pdo.settings.transmission > 240 || !due(p, counter.empty() ? 0 : counter[0])) continue;
        if (p.pdo.settings.transmission != 0 || packed(p, now) != p.sent) transmit(p, now, out);
    }
    for (Pdo& p : receive_) {
        if (p.waiting.empty()) continue;
        std::vector<std::uint64_t> values;
        (void)canopen::unpack(p.pdo.mapping, std::exchange(p.waiting, {}), values);
        for (std::size_t i = 0; i < values.size(); ++i) {
            std::vector<std::uint8_t> raw(p.pdo.mapping[i].bits / 8);
            canopen::put_low_first(values[i], raw);
            (void)d_.write(p.pdo.mapping[i].address, raw, true);
        }
    }
    take_writes(now, out);
    device_->on_sync(now);
    shown_.reset();
}

std::vector<std::uint8_t> Node::packed(const Pdo& p, Instant at) {
    show(at);
    std::vector<std::uint64_t> values;
    for (const canopen::Entry* e : p.entries)
        values.push_back(e ? canopen::low_first(e->bytes) : 0);
    return canopen::pack(p.pdo.mapping, values).value_or(std::vector<std::uint8_t>{});
}
void Node::transmit(Pdo& p, Instant at, Out& out) {
    p.sent = packed(p, at);
    if (p.pdo.settings.event_ms > 0) p.event = at + std::chrono::milliseconds(p.pdo.settings.event_ms);
    send(canopen::data_frame(p.pdo.settings.id, p.sent), at, out);
}

void Node::events(Instant at, Out& out) {
    const auto emergencies = [&] {
        for (const auto& reported : device_->take_reported())
            if (state_ != NmtState::stopped) send(canopen::emergency_frame(node_, reported.emergency), reported.at, out);
    };
    if (!free_.emergency_after_status) emergencies();
    if (state_ == NmtState::operational) send_changed(at, out);
    if (free_.emergency_after_status) emergencies();
}
void Node::send_changed(Instant at, Out& out) {
    for (Pdo& p : transmit_) {
        if (!p.valid || p.pdo.settings.transmission < 254) continue;
        // A PDO is event-driven if it contains states, inputs or modes; measured values are sent with them.
        const bool has_state =
            std::ranges::any_of(p.pdo.mapping, [](const auto& m) { return m.address.index == 0x6041 || m.address.index == 0x60FD; });
        if (has_state && packed(p, at) != p.sent) transmit(p, at, out);
    }
}

Instant Node::deadline() const {
    if (!powered_) return never;
    if (awake_at_ != never) return awake_at_;
    Instant next = std::min({device_->next_event(now_), heartbeat_.deadline(), server_.deadline(), guard_.deadline(), watch_.deadline()});
    next = std::min(next, other_stop_);
    if (!requests_.empty()) next = std::min(next, requests_.front().due);
    if (state_ == NmtState::operational)
        for (const Pdo& p : transmit_)
            next = std::min(next, p.event);
    return next;
}

void Node::advance(Instant now, Out& out) {
    for (int i = 0; i < most_events; ++i) {
        const Instant due = deadline();
        if (due > now) break;
        const Instant at = std::max(due, now_);
        now_ = at;
        if (awake_at_ <= at) {
            awake_at_ = never;
            reset(true, at, out);
            continue;
        }
        if (other_stop_ <= at) {
            other_stop_ = never;
            stop_as_other_master(node_, at, out);
            nmt(NmtCommand::stop, at, out);
        }
        if (device_->next_event(now_) <= at) {
            shown_.reset();
            device_->on_event(at);
        }
        if (!requests_.empty() && requests_.front().due <= at) {
            const Frame request = requests_.front().frame;
            requests_.pop_front();
            if (state_ != NmtState::stopped) serve_request(request, at, out);
        }
        if (const auto beat = heartbeat_.on_deadline(at, node_, state_)) send(*beat, at, out);
        if (guard_.on_deadline(at)) connection_lost(at, out);
        if (watch_.on_deadline(at) == canopen::NodeNews::lost) connection_lost(at, out);
        std::vector<Frame> answers;
        server_.on_deadline(at, answers);
        for (const Frame& f : answers)
            send(f, at, out);
        for (Pdo& p : transmit_)
            if (state_ == NmtState::operational && p.event <= at) transmit(p, at, out);
        events(at, out);
    }
    now_ = std::max(now_, now);
}

}  // namespace axisgate::cia402_drive::twin
