#include "adapters/aposs/twin/bus_manners.hpp"

#include <algorithm>
#include <array>

#include "gateway/core/specimen.hpp"

namespace axisgate::aposs {
using canopen::Abort;
using canopen::Address;
using canopen::NmtCommand;
using canopen::NmtState;
using cia402_drive::twin::Node;

namespace {
constexpr int most_events = 100'000;  // in one call
bool is_mapping(std::uint16_t index) { return (index >= 0x1600 && index < 0x1800) || (index >= 0x1A00 && index < 0x1C00); }
bool is_pdo(const Frame& f) { return f.id >= 0x180 && f.id < 0x580; }
bool begins(const Frame& request) {
    const unsigned command = request.storage[0] >> 5;
    return command == 1 || command == 2 || command == 5 || command == 6;
}
bool writes(const Frame& request) { return (request.storage[0] & 0xE2u) == 0x22u; }  // a whole value in one message
}  // namespace

BusManners::BusManners(const Manners& m, std::uint8_t node)
    : manners_(m),
      node_(node),
      plain_(m.sdo_answer == Duration::zero() && m.sdo_late_share == 0 && m.sdo_busy_share == 0 && m.pdo_setup == PdoSetup::always &&
             m.lacks == Lacks::nothing && m.sends_emergencies && m.emergency_late == Duration::zero() &&
             m.heartbeat_jitter == Duration::zero() && m.foreign == Duration::zero() && m.pdo_late == Duration::zero()) {}

void BusManners::power_on(Instant now) {
    power_off();
    foreign_at_ = manners_.foreign == Duration::zero() ? never : now + manners_.foreign;
}
void BusManners::power_off() {
    requests_.clear();
    waiting_.clear();
    foreign_at_ = never;
    state_ = NmtState::pre_operational;
}

bool BusManners::happens(std::string_view what, std::int64_t share) const {
    return share > 0 && static_cast<std::int64_t>(specimen_draw(manners_.seed, what, requests_seen_) % 1000) < share;
}

bool BusManners::lacks(Address a) const {
    constexpr std::array<std::uint16_t, 5> values{0x6062, 0x6063, 0x606B, 0x606C, 0x60F4};
    constexpr std::array<std::uint16_t, 5> options{0x1010, 0x1016, 0x6007, 0x605A, 0x6502};
    if (manners_.lacks == Lacks::nothing) return false;
    const auto index = static_cast<std::uint16_t>(a.index >= 0x6800 ? a.index - 0x800 : a.index);
    const auto in = [&](const auto& list) { return std::ranges::find(list, index) != list.end(); };
    return in(values) || (manners_.lacks == Lacks::options && in(options));
}

Abort BusManners::refused_setup(const canopen::Dictionary& d, Address a, std::uint32_t value) const {
    if (a.index < 0x1400 || a.index >= 0x1C00) return Abort::none;
    const bool mapping = is_mapping(a.index);
    if (mapping && a.sub > 0 && lacks({static_cast<std::uint16_t>(value >> 16), 0})) return Abort::no_object;
    if (manners_.pdo_setup == PdoSetup::always) return Abort::none;
    if (state_ != NmtState::pre_operational) return Abort::device_state;
    if (manners_.pdo_setup != PdoSetup::strict) return Abort::none;
    const auto settings = static_cast<std::uint16_t>(mapping ? a.index - 0x200 : a.index);
    const auto id = static_cast<std::uint32_t>(d.integer({settings, 1}).value_or(0x80000000));
    if ((id & 0x80000000u) != 0) return Abort::none;
    if (mapping || a.sub == 3 || a.sub == 6) return Abort::device_state;
    return a.sub == 1 && (value & 0x80000000u) == 0 && value != id ? Abort::value : Abort::none;
}

Abort BusManners::refusal(const canopen::Dictionary& d, const Frame& request) const {
    if (request.size < 8 || !begins(request)) return Abort::none;
    const Address a = canopen::address_of(request);
    if (lacks(a)) return Abort::no_object;
    return writes(request) ? refused_setup(d, a, canopen::value_of(request)) : Abort::none;
}

void BusManners::serve(Node& node, const Frame& request, Instant at, Out& out) {
    const auto answer_id = static_cast<std::uint32_t>(canopen::sdo_answer_base + node_);
    Out own;
    if (const Abort refused = refusal(node.dictionary(), request); refused == Abort::none) {
        node.on_frame(request, at, own);
    } else if (node.powered() && !node.silent()) {
        Frame answer = canopen::abort_frame(answer_id, canopen::address_of(request), refused);
        answer.at = at;
        own.send(answer);
    }
    pass(own, at, out);
}

void BusManners::receive(Node& node, const Frame& f, Instant now, Out& out) {
    if (plain_) return node.on_frame(f, now, out);
    run(node, now, out);
    if (!node.powered()) return;
    if (f.kind == Frame::Kind::can) {
        if (const auto command = canopen::nmt_for(f, node_)) {
            state_ = *command == NmtCommand::start  ? NmtState::operational
                     : *command == NmtCommand::stop ? NmtState::stopped
                                                    : NmtState::pre_operational;
            if (*command == NmtCommand::reset_node || *command == NmtCommand::reset_communication) requests_.clear();
        }
        if (canopen::is_data(f, static_cast<std::uint32_t>(canopen::sdo_request_base + node_)) && state_ != NmtState::stopped) {
            ++requests_seen_;
            if (f.size == 8 && begins(f) && happens("busy", manners_.sdo_busy_share)) {
                if (manners_.busy_answer == BusyAnswer::none || node.silent()) return;
                const Abort code = manners_.busy_answer == BusyAnswer::device_state ? Abort::device_state : Abort::transfer;
                const auto answer_id = static_cast<std::uint32_t>(canopen::sdo_answer_base + node_);
                wait(canopen::abort_frame(answer_id, canopen::address_of(f), code), now + manners_.sdo_answer);
                return run(node, now, out);
            }
            if (manners_.sdo_answer == Duration::zero() && requests_.empty()) return serve(node, f, now, out);
            if (requests_.size() >= most_requests) return;
            const Instant before = requests_.empty() ? now : std::max(now, requests_.back().at);
            requests_.push_back({before + manners_.sdo_answer, f});
            return;
        }
    }
    Out own;
    node.on_frame(f, now, own);
    pass(own, now, out);
}

void BusManners::pass(const Out& from_node, Instant now, Out& out, bool by_itself) {
    for (const auto& tx : from_node.frames) {
        const Frame& f = tx.frame;
        Duration late{};
        if (f.id == static_cast<std::uint32_t>(canopen::emergency_base + node_)) {
            if (!manners_.sends_emergencies) continue;
            late = manners_.emergency_late;
        } else if (f.id == static_cast<std::uint32_t>(canopen::error_control_base + node_)) {
            const bool boots = f.size == 1 && f.storage[0] == 0;
            const auto span = static_cast<std::uint64_t>(manners_.heartbeat_jitter.count()) + 1;
            if (!boots) late = Duration(static_cast<std::int64_t>(specimen_draw(manners_.seed, "heartbeat", ++beats_) % span));
        } else if (f.id == static_cast<std::uint32_t>(canopen::sdo_answer_base + node_) && happens("late", manners_.sdo_late_share)) {
            late = manners_.sdo_late;
        } else if (by_itself && is_pdo(f)) {
            late = manners_.pdo_late;
        }
        const Instant at = std::max(f.at, Instant{}) + late;
        if (late == Duration::zero() || at <= now)
            out.frames.push_back(tx);
        else
            wait(f, at);
    }
}

void BusManners::wait(const Frame& frame, Instant at) {
    if (waiting_.size() >= most_waiting) return;
    waiting_.insert(std::ranges::upper_bound(waiting_, at, {}, &Waiting::at), {at, frame});
}

/// Another node sends PDOs, a heartbeat and now and then an EMCY. Its number is far from the own one, so that it is hardly one of the site.
void BusManners::speak_foreign(Instant at, Out& out) {
    const auto other = static_cast<std::uint8_t>((node_ + 62) % 127 + 1);
    std::array<std::uint8_t, 8> data{};
    canopen::put_low_first(static_cast<std::uint64_t>(ns_of(at) / 1'000'000), data);
    const std::uint64_t n = foreign_sent_++;
    Frame f = n % 5 == 4    ? canopen::heartbeat_frame(other, NmtState::operational)
              : n % 50 == 8 ? canopen::emergency_frame(other, {0x8130, 0x11, {}})
                            : canopen::data_frame(0x180u + other, data);
    f.at = at;
    out.send(f);
}

Instant BusManners::deadline() const {
    return std::min({foreign_at_, requests_.empty() ? never : requests_.front().at, waiting_.empty() ? never : waiting_.front().at});
}

void BusManners::run(Node& node, Instant now, Out& out) {
    if (plain_) return node.advance(now, out);
    const auto advance = [&](Instant at) {
        if (!node.powered()) return;
        Out own;
        node.advance(at, own);
        pass(own, at, out, true);
    };
    for (int i = 0; i < most_events && deadline() <= now; ++i) {
        const Instant at = deadline();
        advance(at);
        if (foreign_at_ <= at) {
            speak_foreign(at, out);
            foreign_at_ += manners_.foreign;
        }
        if (!requests_.empty() && requests_.front().at <= at) {
            const Frame request = requests_.front().frame;
            requests_.pop_front();
            serve(node, request, at, out);
        }
        while (!waiting_.empty() && waiting_.front().at <= at) {
            Frame f = waiting_.front().frame;
            f.at = waiting_.front().at;
            waiting_.pop_front();
            if (node.powered() && !node.silent()) out.send(f);
        }
    }
    advance(now);
}

}  // namespace axisgate::aposs
