// The feedback of a node and of its axes from PDOs, EMCY and heartbeats. Values of one picture belong to one SYNC: feedback is published
// when all PDOs of that SYNC have arrived.
#include <fmt/core.h>

#include <cstdlib>
#include <utility>

#include "adapters/cia402/drive.hpp"

namespace axisgate::cia402_drive {
namespace {
/// Not enabled, without a fault.
bool is_off(unsigned sw) noexcept {
    const unsigned low = sw & 0x4Fu, six = sw & 0x6Fu;
    return low == 0x40 || low == 0 || six == 0x21 || six == 0x23;
}
}  // namespace

void Drive::on_emergency(const canopen::Emergency& e, Turn& t) {
    if (!node.presence.online()) return node.presence.received(t.now);
    const std::uint16_t number = node.number_of(e.code);
    const ErrorCode* known = node.catalogue().error(number);
    // An EMCY does not name its axis: each axis that shows a fault reports this code.
    for (const auto& a : axes)
        a->feedback.on_error_code(number);
    if (!gate_.admits(e, t.now)) return;
    const auto left_out = gate_.take_kept_back();
    notice(e.code == 0 ? Severity::info : Severity::warning, "emergency", number,
           fmt::format("EMCY {}{}{}", canopen::to_text(e), known ? ": " + known->text : "",
                       left_out ? fmt::format(" ({} before it were left out)", left_out) : ""),
           t);
}

void Drive::on_heartbeat(const Frame& f, Turn& t) {
    const auto news = heartbeat_.on_frame(f, t.now);
    Presence& presence = node.presence;
    // SDO answers of two nodes may be identical and coincide on the bus; heartbeats do not stay synchronous.
    if (news != canopen::NodeNews::started && double_beat_.beat(t.now)) tell_two_nodes("heartbeats come in the gaps of others", t);
    if (news == canopen::NodeNews::started) {
        double_beat_.restarted();
        for (const auto& a : axes)
            a->feedback.restarted();
        if (presence.online() && !presence.is(Presence::Phase::restarting)) {
            forget(Reason::interrupted, "the drive has restarted", t);
            return presence.begin(t.now);
        }
    }
    if (heartbeat_.state() == canopen::NmtState::stopped && !axes.empty()) {
        if (presence.is(Presence::Phase::ready)) return nmt.stopped(t);
        if (!node.only_reads) nmt.wake(t);
    } else if (node.stopped) {
        nmt.back(t);
    }
    presence.received(t.now);
    // The node has left the operational state by itself: it sends no PDOs, and its monitoring of the gateway may be the reason.
    if (news == canopen::NodeNews::state && heartbeat_.state() == canopen::NmtState::pre_operational &&
        presence.is(Presence::Phase::ready) && listeners() > 0)
        start.begin();
}

bool Drive::on_pdo(const Frame& f, Turn& t) {
    const auto is_default = [&](std::size_t place) {
        const std::uint32_t shift = per_axis * static_cast<std::uint32_t>(place) + node.number;
        return canopen::is_data(f, status_base + shift) || canopen::is_data(f, motion_base + shift);
    };
    for (const auto& place : axes) {
        Axis& a = *place;
        const auto& reports = a.known.pdos.reports;
        const auto it = std::ranges::find_if(reports, [&](const auto& p) { return canopen::is_data(f, p.settings.id); });
        if (it == reports.end() && !is_default(a.place())) continue;
        if (it == reports.end() || !a.listens() || a.known.polled) return node.presence.received(t.now), true;
        if (node.stopped) nmt.back(t);
        const auto which = static_cast<std::size_t>(it - reports.begin());
        a.turns.came(which, t);
        a.feedback.on_report(which, f.data(), t);
        return true;
    }
    if (axes.empty() && is_default(0)) return node.presence.received(t.now), true;
    return false;
}

void Feedback::begin(Instant now) {
    deaf_ = 0;
    fresh_reports_ = 0;
    seen_ = false;
    fallen_ = 0;
    place_at_ = {};
    if (drive_.known.polled) drive_.polled.begin_anew();
    if (drive_.known.profile) look_by(now + std::max<Duration>(8 * drive_.node.line.cycle(), std::chrono::milliseconds(200)));
}
/// The polls of an axis without PDOs notice by themselves that the node is silent.
void Feedback::look_by(Instant at) noexcept { check_at_ = drive_.known.polled ? never : at; }
void Feedback::look_soon(Instant at) noexcept { look_by(std::min(check_at_, at)); }
void Feedback::forget() noexcept {
    check_at_ = never;
    need_code_ = false;
}
void Feedback::restarted() {
    AxisKnown& known = drive_.known;
    const auto place = known.fb.position;
    known.fb = {};
    known.fb.position = place;
    known.order = Order::none;
    known.cw = 0;
}

void Feedback::on_report(std::size_t which, std::span<const std::uint8_t> bytes, Turn& t) {
    const auto& reports = drive_.known.pdos.reports;
    if (canopen::unpack(reports[which].mapping, bytes, raw_) != canopen::PdoLength::fits) {
        ++drive_.node.line.counters.garbled;
        return;
    }
    for (std::size_t i = 0; i < raw_.size(); ++i)
        take(reports[which].mapping[i].address, raw_[i], reports[which].mapping[i].bits, t);
    fresh_reports_ |= 1u << which;
    if (fresh_reports_ != (1u << reports.size()) - 1) return;
    if (!drive_.known.pdos.carries(object::velocity)) calculate_velocity(t.now);
    if (!drive_.known.pdos.carries(object::demand)) drive_.known.fb.position_demand = drive_.known.fb.position;
    learnt(t);
}
void Feedback::take(Address object, std::uint64_t raw, std::uint8_t bits, Turn& t) {
    AxisKnown& known = drive_.known;
    const auto is = [&](Address wanted) { return object == of_axis(wanted, drive_.place()); };
    const std::int64_t value = canopen::as_signed(raw, bits);
    if (is(object::statusword)) known.fb.native_status = static_cast<std::uint32_t>(raw);
    if (is(object::position)) known.fb.position = value;
    if (is(object::velocity)) known.fb.velocity = value;
    if (is(object::demand)) known.fb.position_demand = value;
    if (!is(object::mode_shown)) return;
    known.mode = static_cast<int>(value);
    drive_.stream.mode_shown(known.mode, t);
}
void Feedback::on_values(std::uint32_t status_word, std::int64_t position, int mode, std::int64_t velocity, Turn& t) {
    AxisKnown& known = drive_.known;
    known.fb.native_status = status_word;
    known.fb.position = position;
    known.fb.position_demand = position;
    known.mode = known.has_mode ? mode : known.ordered_mode;
    if (known.has_velocity)
        known.fb.velocity = velocity;
    else
        calculate_velocity(t.now);
    drive_.stream.mode_shown(known.mode, t);
    learnt(t);
}
void Feedback::calculate_velocity(Instant now) noexcept {
    AxisKnown& known = drive_.known;
    constexpr Duration shortest = std::chrono::milliseconds(15);
    constexpr std::int64_t flicker = 2;  // increments: of an encoder at standstill
    if (place_at_ != Instant{} && now < place_at_ + shortest) return;
    const std::int64_t way = saturated_difference(known.fb.position, place_);
    const bool first = place_at_ == Instant{};
    known.fb.velocity =
        first || std::llabs(way) <= flicker ? 0 : static_cast<std::int64_t>(static_cast<double>(way) / seconds(now - place_at_));
    place_ = known.fb.position;
    place_at_ = now;
}
void Feedback::on_status_word(std::uint32_t word, Turn& t) {
    drive_.known.fb.native_status = word;
    judge(t);
}
/// The axis is at standstill, so its demand position has changed by the same amount.
void Feedback::on_position(std::int64_t position, Turn& t) {
    AxisFeedback& fb = drive_.known.fb;
    fb.position_demand += position - fb.position;
    fb.position = position;
    emit(t);
}

void Feedback::after_sync() noexcept {
    if (!drive_.turns.apart()) fresh_reports_ = 0;
}
void Feedback::on_error_code(std::uint16_t code) noexcept {
    std::uint16_t& shown = drive_.known.fb.error_code;
    if (code == 0 || shown == 0) shown = code;
}
void Feedback::error_code_read(const canopen::SdoEnd& end, Turn& t) {
    need_code_ = false;
    if (end.done()) drive_.known.fb.error_code = drive_.node.number_of(static_cast<std::uint16_t>(canopen::low_first(end.data)));
    emit(t);
}

void Feedback::ordered(Order order, std::optional<std::int64_t> target, Turn& t) {
    AxisFeedback& fb = drive_.known.fb;
    drive_.known.order = order;
    drive_.known.target = target;
    way_ = target ? saturated_difference(*target, fb.position) : 0;
    left_ = false;
    ordered_at_ = t.now;
    fb.target_reached = false;
    fb.moving = true;
    if (order == Order::homing) {
        fb.homing = true;
        fb.homing_attained = fb.homing_error = false;
    } else {
        fresh_ = 1;
    }
    emit(t);
}

bool Feedback::deaf(Instant now) noexcept {
    look_by(now + std::max<Duration>(4 * drive_.node.line.cycle(), std::chrono::milliseconds(100)));
    return ++deaf_ >= 3;
}

void Feedback::learnt(Turn& t) {
    Node& node = drive_.node;
    fresh_reports_ = 0;
    deaf_ = 0;
    doubted_until_ = {};
    node.presence.answered();
    ++node.line.counters.exchanges;  // a SYNC counts as the request, its PDOs as the answer
    look_by(t.now + std::max<Duration>(3 * node.line.cycle(), std::chrono::milliseconds(150)));
    if (!drive_.known.has_mode) drive_.known.mode = drive_.known.ordered_mode;
    if (older_than_power(drive_.known.fb.native_status, t.now)) {
        drive_.known.fb.native_status = judged_;
        return;
    }
    seen_ = true;
    watch_power(drive_.known.fb.native_status);
    judge(t);
}

/// A report of an axis that is off, or in its quick stop, may have been on its way while the axis was enabled, which SDO answers have
/// shown. Reports that do not show the axis enabled within a second are believed.
bool Feedback::older_than_power(unsigned sw, Instant now) noexcept {
    constexpr Duration latest = std::chrono::seconds(1);
    if ((drive_.known.cw & 0x0Fu) != 0x0F || drive_.enabling()) {
        enabled_at_ = now;
        power_shown_ = false;
        return false;
    }
    power_shown_ = power_shown_ || (sw & 0x6Fu) == 0x27 || (sw & 0x08u) != 0;  // a fault is no older report
    return !power_shown_ && now - enabled_at_ < latest;
}

/// If the power is removed (STO, a safe enable input, a switch at the drive), the drive goes to "switch on disabled" while its control word
/// still says "enable operation". A drive that returns by itself would then run again. Two reports are needed, since one may be older than
/// the control word.
void Feedback::watch_power(unsigned sw) {
    const unsigned six = sw & 0x6Fu;
    const bool fell = is_off(sw) && (drive_.known.cw & 0x0Fu) == 0x0F && !drive_.enabling();
    fallen_ = fell ? fallen_ + 1 : 0;
    if (fallen_ == 2) {
        power_lost_ = true;
        drive_.withdraw();
    }
    if ((sw & 0x10u) || six == 0x27) power_lost_ = false;
}

/// By the mode that the drive shows: velocity, torque and cyclic modes have no end of their own.
Course Feedback::course() const noexcept {
    switch (drive_.known.mode) {
        case 1:
            return Course::to_target;
        case 2:
        case 3:
        case 4:
        case 7:
        case 8:
        case 9:
        case 10:
            return Course::endless;
        default:
            return Course::unknown;
    }
}

void Feedback::tell_rates(Turn& t) {
    if (seen_ && drive_.rates.in_force() != drive_.known.fb.rates) emit(t);
}

void Feedback::judge(Turn& t) {
    AxisKnown& known = drive_.known;
    AxisFeedback& fb = known.fb;
    const unsigned sw = judged_ = fb.native_status, six = sw & 0x6Fu;
    drive_.saw_status(sw);
    const bool enabled = six == 0x27, quick = six == 0x07, reacting = (sw & 0x4Fu) == 0x0F, was_fault = fb.fault;
    fb.statusword = static_cast<std::uint16_t>(sw & 0x7Fu);
    fb.power = enabled || quick || reacting ? AxisFeedback::Power::on : AxisFeedback::Power::off;
    fb.fault = (sw & 0x4Fu) == 0x08 || reacting;
    fb.warning = sw & 0x80u;
    fb.internal_limit = sw & 0x800u;
    fb.quick_stopping = quick;
    fb.demand_source = fb.power == AxisFeedback::Power::on && !fb.fault ? DemandSource::drive : DemandSource::none;
    const bool halted = known.cw & 0x100u;
    if (!enabled || halted) {
        fb.homing = false;
        known.order = Order::none;
    }
    if (!enabled) drive_.stream.end();
    judge_order(sw, t.now);
    if (fb.power != AxisFeedback::Power::on) fb.moving = fb.velocity != 0;
    if (!fb.fault) fb.error_code = 0;
    if (fb.fault && !was_fault && fb.error_code == 0) {  // its EMCY was lost: the fault is reported when its number has been read
        need_code_ = true;
        return;
    }
    if (!need_code_) emit(t);
}

/// The progress of the ordered motion.
void Feedback::judge_order(unsigned sw, Instant now) {
    AxisKnown& known = drive_.known;
    AxisFeedback& fb = known.fb;
    if (known.order == Order::homing) {
        if (known.mode == 6 && (sw & 0x2000u)) fb.homing = false, fb.homing_error = true, known.order = Order::none;
        if (known.mode == 6 && (sw & 0x1000u) && (sw & 0x400u)) {
            fb.homing = false;
            fb.homing_attained = fb.referenced = true;
            known.order = Order::none;
        }
    }
    // Bit 10 of the previous motion may still be set after a new set-point.
    const bool fresh = std::exchange(fresh_, fresh_ > 0 ? fresh_ - 1 : 0) > 0;
    left_ = left_ || (!fresh && (sw & 0x400u) == 0);
    fb.target_reached = known.order == Order::position && known.mode == 1 && (sw & 0x400u) && !fresh && may_have_arrived(now);
    const bool on_its_way = (known.order == Order::position && !fb.target_reached) || fb.homing;
    fb.moving = fb.velocity != 0 || on_its_way || drive_.stream.moves();
    known.at_target = fb.target_reached && known.target && near_target();
}

/// A drive that clears bit 10 late has not arrived although it says so. A short positioning may begin and end between two reports, so that
/// nobody has seen bit 10 cleared: then the axis is near its target. If neither is true for long, the drive is believed.
bool Feedback::may_have_arrived(Instant now) const noexcept {
    return left_ || !drive_.known.target || now >= ordered_at_ + drive_.node.start_timeout || near_target();
}
bool Feedback::near_target() const noexcept {
    constexpr std::int64_t near = 20;  // increments
    const AxisKnown& known = drive_.known;
    return std::llabs(saturated_difference(*known.target, known.fb.position)) <= std::max<std::int64_t>(near, std::llabs(way_) / 50);
}

void Feedback::emit(Turn& t) {
    drive_.known.fb.at = t.now;
    drive_.known.fb.rates = drive_.rates.in_force();
    drive_.known.fb.course = course();
    drive_.known.fb.safe_stop = power_lost_;
    t.out.feedback.push_back({drive_.id(), drive_.known.fb});
}

}  // namespace axisgate::cia402_drive
