#include "adapters/cia402/start.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "adapters/cia402/drive.hpp"

namespace axisgate::cia402_drive {

bool Start::waits(Instant now) const noexcept {
    if (sets_pdos()) return pdos_.look_at() != never && now < pdos_.look_at();
    return at_end() && !drive_.node.line.in_turn(drive_.node.slot, now);
}
std::string Start::title() const { return fmt::format("{}, {}", drive_.node.dialect.noun, identity_); }

void Start::probe(Turn& t) {
    drive_.node.presence.probe_sent();
    drive_.exchanges.send({Ask::Why::probe, {Step::Kind::read, drive_.node.mark(), {}}, no_ticket, 0, drive_.axes.size()}, t);
}

void Start::probed(const canopen::SdoEnd& end, Turn& t) {
    const Dialect& dialect = drive_.node.dialect;
    const bool ours = end.done() && (dialect.mark != object::device_type || (canopen::low_first(end.data) & 0xFFFFu) == 402);
    if (!ours) {
        drive_.node.presence.lose(t.now, drive_.node.line.timing.pause_max);
        const std::string what =
            end.done() ? fmt::format("device profile {}", canopen::low_first(end.data) & 0xFFFFu) : canopen::to_text(end);
        return drive_.node.presence.report(fmt::format("a node answers that is no {}: {}", dialect.noun, what), t.out);
    }
    drive_.node.presence.found();
    identity_.clear();
    reported_ = {};
    begin();
}

void Start::begin() {
    Presence& presence = drive_.node.presence;
    if (presence.is(Presence::Phase::ready)) presence.found();  // set up again
    steps_.clear();
    at_ = 0;
    for (const Address a : {object::vendor, object::product, object::revision, object::watched_heartbeat})
        steps_.push_back({{Step::Kind::read, a, {}, 0, 0, true}});
    for (const auto& a : drive_.axes) {
        a->begin_anew();
        a->rates.forget();
    }
    add_axes();
}

void Start::begin_axes() {
    steps_.clear();
    at_ = 0;
    add_axes();
}
void Start::add_axes() {
    for (const auto& a : drive_.axes) {
        if (!a->is_new()) continue;
        std::vector<Step> reads;
        a->first_reads(reads);
        for (Step& s : reads)
            steps_.push_back({std::move(s), a.get()});
    }
}

void Start::set_up() {
    if (drive_.axes.empty()) return;
    if (drive_.node.only_reads) {
        for (const auto& a : drive_.axes)
            a->known.polled = true;
        return;
    }
    steps_.push_back({{Step::Kind::write, object::heartbeat, bytes_of(milliseconds_of(drive_.heartbeat_period()), 2), 0, 0, true}});
    std::vector<PdoSetUp::Wanted> wanted;
    for (const auto& a : drive_.axes) {
        if (!a->is_new()) continue;
        std::vector<Step> writes;
        a->set_up(writes);
        a->want_pdos(wanted);
        for (Step& s : writes)
            steps_.push_back({std::move(s), a.get()});
    }
    pdos_.begin(std::move(wanted));
    steps_.push_back({{}, nullptr, true});
    set_up_limits();
    set_up_watch();
    Step go;
    go.kind = Step::Kind::nmt;
    steps_.push_back({go});
}

/// Nothing is written if the site has no limits. Limits that were written before stay in the drive until somebody writes others.
void Start::set_up_limits() {
    Presence& presence = drive_.node.presence;
    limits_open_ = 0;
    for (const auto& s : steps_)
        if (s.axis && s.step.kind == Step::Kind::write && s.step.address.index == object::position_min_limit.index) ++limits_open_;
    const bool wanted = std::ranges::any_of(drive_.axes, [](const auto& a) { return a->limited(); });
    presence.limited({!wanted                    ? DriveLimits::State::unknown
                      : !drive_.node.keep_limits ? DriveLimits::State::off
                                                 : presence.limits().state,
                      wanted && drive_.node.keep_limits ? presence.limits().text : std::string()});
    if (limits_open_ > 0) presence.limited({});
}

void Start::limit_set(const Step& step, const Axis& axis, const canopen::SdoEnd& end, Turn& t) {
    Presence& presence = drive_.node.presence;
    if (limits_open_ > 0) --limits_open_;
    if (presence.limits().state == DriveLimits::State::refused) return;
    if (end.done()) {
        if (limits_open_ == 0) presence.limited({DriveLimits::State::armed, {}});
        return;
    }
    std::string text = fmt::format("axis {} of {}: the drive does not take the site's limit of position ({}): {}", axis.place() + 1,
                                   drive_.node.setup.name, canopen::to_text(step.address), canopen::to_text(end));
    drive_.notice(Severity::warning, "drive_limits", 0, text, t);
    presence.limited({DriveLimits::State::refused, std::move(text)});
}

/// 1016h:01 contains the monitored node number and the time in ms; monitoring begins with the first heartbeat after the write. The reaction
/// is written first. A drive that has monitored this gateway before and no longer shall must not detect a missing heartbeat.
Duration Start::watched() const noexcept {
    const Node& node = drive_.node;
    if (node.only_reads || drive_.axes.empty() || ((watched_ >> 16) & 0x7Fu) != node.line.own_node) return {};
    return std::chrono::milliseconds(watched_ & 0xFFFFu);
}

void Start::set_up_watch() {
    const Watch& watch = drive_.node.watch;
    if (!watch.on)
        drive_.node.presence.watched({DriveWatchdog::State::off, {}, {}});
    else if (drive_.node.presence.watchdog().state == DriveWatchdog::State::refused)
        drive_.node.presence.watched({});
    if (!watch.on && watched() == Duration::zero()) return;
    const std::int64_t entry = watch.on ? std::int64_t{drive_.node.line.own_node} << 16 | milliseconds_of(watch.time) : 0;
    if (watch.on) steps_.push_back({{Step::Kind::write, object::connection_lost_option, bytes_of(watch.option, 2), 0, 0, true}});
    steps_.push_back({{Step::Kind::write, object::watched_heartbeat, bytes_of(entry, 4), 0, 0, true}});
}

/// An answer to a transfer of set_up_watch.
void Start::watch_set(const Step& step, const canopen::SdoEnd& end, Turn& t) {
    const Watch& watch = drive_.node.watch;
    if (!watch.on || drive_.node.presence.watchdog().state == DriveWatchdog::State::refused) return;
    if (!end.done()) {
        drive_.node.presence.watched({DriveWatchdog::State::refused, {}, {}});
        return drive_.notice(Severity::info, "watchdog", 0,
                             fmt::format("{}: it cannot be told to stop by itself when the gateway is gone: {}: {}", drive_.node.setup.name,
                                         canopen::to_text(step.address), canopen::to_text(end)),
                             t);
    }
    if (step.address == object::watched_heartbeat)
        drive_.node.presence.watched({DriveWatchdog::State::armed, watch.time, std::string(watch.action)});
}

void Start::next(Turn& t) {
    if (steps_.empty()) begin();
    if (at_ >= steps_.size()) return done(t);
    if (sets_pdos()) {
        if (pdos_.over()) return void(++at_), next(t);
        return drive_.exchanges.send({Ask::Why::start, pdos_.next(), no_ticket, drive_.node.line.timing.retries, drive_.axes.size()}, t);
    }
    const auto& [step, axis, pdos] = steps_[at_];
    if (step.kind == Step::Kind::nmt) {
        t.out.send(canopen::nmt_frame(step.nmt, drive_.node.number));
        ++at_;
        return next(t);
    }
    const auto& axes = drive_.axes;
    Ask ask{Ask::Why::start, step, no_ticket, drive_.node.line.timing.retries, axes.size()};
    for (std::size_t i = 0; i < axes.size(); ++i)
        if (axes[i].get() == axis) ask.axis = i;
    drive_.exchanges.send(std::move(ask), t);
}

void Start::done(Turn& t) {
    Node& node = drive_.node;
    steps_.clear();
    node.presence.made_ready();
    node.presence.report(title(), t.out);
    // The drive is used all the same: the plant knows whether another model of the same manufacturer is safe; the gateway does not.
    if (const std::string fault = differs(expected_, reported_); !fault.empty())
        drive_.notice(Severity::warning, "identity", 0, fmt::format("{}: {}", node.setup.name, fault), t);
    for (const auto& a : drive_.axes)
        if (const std::string text = lacks(a->known); a->is_new() && !text.empty())
            drive_.notice(Severity::info, "drive_lacks", 0, fmt::format("{}: {}", node.setup.name, text), t);
    drive_.made_ready(t);
}

void Start::answered(const canopen::SdoEnd& end, Turn& t) {
    if (at_ >= steps_.size()) return;
    if (sets_pdos()) {
        return pdos_.answered(end, t);
    }
    const auto [step, axis, pdos] = steps_[at_];
    if (!end.done() && !step.optional) return cannot_be_set_up(end, t);
    ++at_;
    if (axis && step.kind == Step::Kind::write && step.address.index == object::position_min_limit.index) {
        limit_set(step, *axis, end, t);
    } else if (axis) {
        axis->first_read(step, end);
    } else if (step.address == object::heartbeat) {
        drive_.beats(end.done() ? drive_.heartbeat_period() : Duration::zero());
    } else if (step.kind == Step::Kind::write) {
        if (step.address == object::watched_heartbeat && end.done()) watched_ = static_cast<std::uint32_t>(canopen::low_first(step.bytes));
        watch_set(step, end, t);
    } else if (step.address == object::watched_heartbeat) {
        watched_ = static_cast<std::uint32_t>(end.done() ? canopen::low_first(end.data) : 0);
    } else if (step.kind == Step::Kind::read) {
        identity_read(step.address, end);
    }
    // The values that were read decide what is written.
    if (at_ == steps_.size() && step.kind == Step::Kind::read) set_up();
}

void Start::cannot_be_set_up(const canopen::SdoEnd& end, Turn& t) {
    steps_.clear();
    drive_.node.presence.lose(t.now, drive_.node.line.timing.pause_max);
    drive_.forget(Reason::drive_refused, "the drive cannot be set up: " + canopen::to_text(end), t);
}

void Start::identity_read(Address address, const canopen::SdoEnd& end) {
    const auto raw = static_cast<std::uint32_t>(end.done() ? canopen::low_first(end.data) : 0);
    static constexpr std::string_view names[] = {"vendor", "product", "revision"};
    for (const auto& [place, i] : {std::pair{object::vendor, 0u}, {object::product, 1u}, {object::revision, 2u}}) {
        if (address != place) continue;
        identity_ += fmt::format("{}{} {:X}h", i ? ", " : "", names[i], raw);
        if (end.done()) reported_[i] = raw;
    }
}

void Axis::first_reads(std::vector<Step>& steps) const {
    for (const Address a :
         {object::statusword, object::velocity, object::demand, object::mode_shown, object::mode, object::modes, object::controlword,
          object::homing_method, object::profile_velocity, object::profile_acceleration, object::profile_deceleration,
          object::quick_stop_deceleration, object::error_code, object::quick_stop_option, object::cycle, object::cycle_index})
        steps.push_back({Step::Kind::read, a, {}, 0, 0, true});
}

void Axis::first_read(const Step& step, const canopen::SdoEnd& end) {
    if (step.kind == Step::Kind::write && step.address == object::quick_stop_option && end.done()) rates.take(step.address, 6);
    if (step.kind != Step::Kind::read) return;
    const Address a = step.address;
    if (end.done())
        rates.take(a, a == object::quick_stop_option ? signed_of(end.data) : static_cast<std::int64_t>(canopen::low_first(end.data)));
    const auto raw = static_cast<std::int64_t>(end.done() ? canopen::low_first(end.data) : 0);
    if (a == object::statusword) known.profile = end.done() || !node.dialect.profile_optional;
    if (a == object::statusword && end.done()) known.fb.native_status = static_cast<std::uint32_t>(raw);
    if (a == object::velocity && end.done()) known.fb.velocity = signed_of(end.data);
    if (a == object::velocity) known.has_velocity = end.done();
    if (a == object::demand) known.has_demand = end.done();
    if (a == object::mode_shown) known.has_mode = end.done();
    if (a == object::mode_shown && end.done()) known.mode = static_cast<int>(signed_of(end.data));
    if (a == object::mode && end.done()) known.ordered_mode = static_cast<int>(signed_of(end.data));
    // A drive that does not say which modes it has may have those of the profile: a mode that it lacks is refused when it is ordered.
    constexpr std::uint32_t usual_modes = 0x3A5;  // 1, 3, 6, 8, 9, 10
    if (a == object::modes) known.modes = end.done() ? static_cast<std::uint32_t>(raw) : usual_modes;
    if (a == object::controlword) known.cw = static_cast<std::uint16_t>(raw);
    if (a == object::homing_method) known.homing_method = signed_of(end.data);
    for (const auto& [place, i] :
         {std::pair{object::profile_velocity, 0u}, {object::profile_acceleration, 1u}, {object::profile_deceleration, 2u}})
        if (a == place && raw > 0) known.rates[i] = raw;
    if (a == object::cycle && end.done()) known.interpolation.value = raw;
    if (a == object::cycle_index && end.done()) known.interpolation.index = signed_of(end.data);
    if (a == object::error_code && end.done()) known.fb.error_code = node.number_of(static_cast<std::uint16_t>(raw));
    // The site wants quick stops to end in "quick stop active", where they stay visible.
    if (a == object::quick_stop_option) change_quick_stop_ = end.done() && node.keep_quick_stop && raw < 5;
}

void Axis::set_up(std::vector<Step>& steps) {
    if (!known.profile) return;
    turns.set_up(node.line.plan.turns);
    const auto add = [&](Address a, std::vector<std::uint8_t> bytes, bool optional) {
        steps.push_back({Step::Kind::write, a, std::move(bytes), 0, 0, optional});
    };
    if (change_quick_stop_) add(object::quick_stop_option, bytes_of(6, 2), true);
    if (node.keep_limits)
        for (const auto& [place, limit] :
             {std::pair{object::position_max_limit, limits_[1]}, std::pair{object::position_min_limit, limits_[0]}})
            if (limit) add(place, bytes_of(std::clamp<std::int64_t>(*limit, INT32_MIN, INT32_MAX), 4), true);
}

void Axis::want_pdos(std::vector<PdoSetUp::Wanted>& wanted) {
    if (!known.profile) return;
    known.polled = false;
    known.pdos = {};
    std::vector<canopen::Pdo> reports{status_pdo(node.number, place_, known.has_mode)};
    if (known.has_velocity || known.has_demand) reports.push_back(motion_pdo(node.number, place_, known.has_velocity, known.has_demand));
    for (canopen::Pdo& p : reports) {
        p.settings.transmission = static_cast<std::uint8_t>(node.line.plan.turns);
        wanted.push_back({std::move(p), this});
    }
    if (place_ > 0) return;  // the receive PDOs of the connection set belong to the first axis
    for (const auto kind : {SetPoint::Mode::position, SetPoint::Mode::velocity, SetPoint::Mode::torque}) {
        const int mode = known.stream_mode(kind);
        if (known.offers(mode))
            wanted.push_back({target_pdo(node.number, static_cast<std::uint16_t>(1 + static_cast<int>(kind)), mode == 7), this, kind});
    }
}

std::string lacks(const AxisKnown& known) {
    if (!known.profile) return {};
    std::string text;
    const auto add = [&](bool missing, std::string_view said) {
        if (missing) text += fmt::format("{}{}", text.empty() ? "" : "; ", said);
    };
    add(known.pdos.plan == PdoPlan::file, "the mapping of its PDOs is fixed, and is used as it is");
    add(known.polled, "its PDOs cannot be set up: its values are read by SDO, and are older than those of other drives");
    const auto unmapped = [&](bool has, Address a) { return has && !known.polled && !known.pdos.carries(a); };
    add(unmapped(known.has_velocity, object::velocity), "606Ch is in none of its PDOs: the velocity is calculated from its positions");
    add(unmapped(known.has_demand, object::demand), "6062h is in none of its PDOs: the actual position is shown as demand");
    add(unmapped(known.has_mode, object::mode_shown),
        "6061h is in none of its PDOs: the mode is read when another one is ordered, and a change by the drive itself is not seen");
    add(!known.has_velocity, "it has no actual velocity (606Ch): the velocity is calculated from its positions");
    add(!known.has_demand, "it has no position demand (6062h): the actual position is shown instead");
    add(!known.has_mode, "it does not show its mode (6061h): the mode that was ordered is shown");
    return text;
}

void Axis::made_ready(Instant now) {
    new_ = false;
    feedback.begin(now);
}

}  // namespace axisgate::cia402_drive
