// Drive, part start: how a node is found, what is read of it, and how it is set up to be heard and led.
// In: answers. Out: reads, then writes. A node that the site does not name (a scan) is read and never written to.
#include <fmt/core.h>

#include "adapters/cia402/drive.hpp"

namespace axisgate::cia402_drive {

void Drive::probed(const canopen::SdoEnd& end, Turn& t) {
    const Dialect& dialect = node_.line.dialect;
    const bool ours = end.done() && (dialect.mark != object::device_type || (canopen::low_first(end.data) & 0xFFFFu) == 402);
    if (!ours) {
        node_.presence.lose(t.now, node_.line.timing.pause_max);
        const std::string what =
            end.done() ? fmt::format("device profile {}", canopen::low_first(end.data) & 0xFFFFu) : canopen::to_text(end);
        return node_.presence.report(fmt::format("a node answers that is no {}: {}", dialect.noun, what), t.out);
    }
    node_.presence.found();
    identity_.clear();
    told_ = {};
    start();
}

void Drive::start() {
    if (node_.presence.is(Presence::Phase::ready)) node_.presence.found();  // set up anew
    start_.clear();
    start_at_ = 0;
    for (const Address a : {object::vendor, object::product, object::revision, object::watched_heartbeat})
        start_.push_back({{Step::Kind::read, a, {}, 0, 0, true}});
    for (const auto& a : axes_)
        a->begin_anew();
    start_axes();
}

/// Those that are new to the node; the others go on.
void Drive::start_axes() {
    for (const auto& a : axes_) {
        if (!a->is_new()) continue;
        std::vector<Step> reads;
        a->first_reads(reads);
        for (Step& s : reads)
            start_.push_back({std::move(s), a.get()});
    }
}

void Drive::set_up() {
    if (axes_.empty()) return;
    start_.push_back({{Step::Kind::write, object::heartbeat, bytes_of(milliseconds_of(heartbeat_period_), 2), 0, 0, true}});
    for (const auto& a : axes_) {
        if (!a->is_new()) continue;
        std::vector<Step> writes;
        a->set_up(writes);
        for (Step& s : writes)
            start_.push_back({std::move(s), a.get()});
    }
    set_up_watch();
    Step go;
    go.kind = Step::Kind::nmt;
    start_.push_back({go});
}

/// 1016h:01 holds the number of the node that is watched and the time in ms; the watch begins with its first heartbeat after that. What it
/// shall do comes first. One that watched this gateway before and shall not any more must not miss it.
void Drive::set_up_watch() {
    const Watch& watch = node_.watch;
    const bool watched = ((watched_ >> 16) & 0x7Fu) == node_.line.own_node && (watched_ & 0xFFFFu) != 0;
    if (!watch.on)
        node_.presence.watched({DriveWatchdog::State::off, {}, {}});
    else if (node_.presence.watchdog().state == DriveWatchdog::State::refused)
        node_.presence.watched({});
    if (!watch.on && !watched) return;
    const std::int64_t entry = watch.on ? std::int64_t{node_.line.own_node} << 16 | milliseconds_of(watch.time) : 0;
    if (watch.on) start_.push_back({{Step::Kind::write, object::connection_lost_option, bytes_of(watch.option, 2), 0, 0, true}});
    start_.push_back({{Step::Kind::write, object::watched_heartbeat, bytes_of(entry, 4), 0, 0, true}});
}

/// An answer to what set_up_watch has asked for.
void Drive::watch_set(const Step& step, const canopen::SdoEnd& end, Turn& t) {
    const Watch& watch = node_.watch;
    if (!watch.on || node_.presence.watchdog().state == DriveWatchdog::State::refused) return;
    if (!end.done()) {
        node_.presence.watched({DriveWatchdog::State::refused, {}, {}});
        return node_.notices.tell(Severity::info, first_axis(), "watchdog", 0,
                                  fmt::format("{}: it cannot be told to stop by itself when the gateway is gone: {}: {}", node_.setup.name,
                                              canopen::to_text(step.address), canopen::to_text(end)),
                                  t.now, t.out);
    }
    if (step.address == object::watched_heartbeat)
        node_.presence.watched({DriveWatchdog::State::armed, watch.time, std::string(watch.action)});
}

void Drive::next_start(Turn& t) {
    if (start_.empty()) start();
    if (start_at_ >= start_.size()) {
        start_.clear();
        node_.presence.made_ready();
        node_.presence.report(fmt::format("{}, {}", node_.line.dialect.noun, identity_), t.out);
        // It is served all the same: what is safe with another model of the same maker, the plant knows and the gateway does not.
        if (const std::string fault = differs(expected_, told_); !fault.empty())
            node_.notices.tell(Severity::warning, first_axis(), "identity", 0, fmt::format("{}: {}", node_.setup.name, fault), t.now,
                               t.out);
        if (!axes_.empty()) heartbeat_.set_time(3 * heartbeat_period_);
        for (const auto& a : axes_)
            if (a->is_new()) a->made_ready(t.now);
        if (listeners() == 0) check_at_ = t.now + std::chrono::milliseconds(200);
        return;
    }
    const auto& [step, axis] = start_[start_at_];
    if (step.kind == Step::Kind::nmt) {
        t.out.send(canopen::nmt_frame(step.nmt, node_.number));
        ++start_at_;
        return next_start(t);
    }
    Ask ask{Ask::Why::start, step, no_ticket, node_.line.timing.retries, axes_.size()};
    for (std::size_t i = 0; i < axes_.size(); ++i)
        if (axes_[i].get() == axis) ask.axis = i;
    send(std::move(ask), t);
}

void Drive::started(const canopen::SdoEnd& end, Turn& t) {
    if (start_at_ >= start_.size()) return;
    const auto [step, axis] = start_[start_at_];
    if (!end.done() && !step.optional) {
        start_.clear();
        node_.presence.lose(t.now, node_.line.timing.pause_max);
        return forget(Reason::drive_refused, "the drive cannot be set up: " + canopen::to_text(end), t);
    }
    ++start_at_;
    if (axis) {
        axis->first_read(step, end);
    } else if (step.address == object::heartbeat) {
        double_beat_.begin(end.done() ? heartbeat_period_ : Duration::zero());
    } else if (step.kind == Step::Kind::write) {
        watch_set(step, end, t);
    } else if (step.address == object::watched_heartbeat) {
        watched_ = static_cast<std::uint32_t>(end.done() ? canopen::low_first(end.data) : 0);
    } else if (step.kind == Step::Kind::read) {
        const auto raw = static_cast<std::uint32_t>(end.done() ? canopen::low_first(end.data) : 0);
        static constexpr std::string_view names[] = {"vendor", "product", "revision"};
        for (const auto& [place, i] : {std::pair{object::vendor, 0u}, {object::product, 1u}, {object::revision, 2u}}) {
            if (step.address != place) continue;
            identity_ += fmt::format("{}{} {:X}h", i ? ", " : "", names[i], raw);
            if (end.done()) told_[i] = raw;
        }
    }
    // What was read decides what is written.
    if (start_at_ == start_.size() && step.kind == Step::Kind::read) set_up();
}

void Axis::first_reads(std::vector<Step>& steps) const {
    for (const Address a : {object::statusword, object::modes, object::controlword, object::homing_method, object::profile_velocity,
                            object::profile_acceleration, object::profile_deceleration, object::error_code, object::quick_stop_option})
        steps.push_back({Step::Kind::read, a, {}, 0, 0, true});
}

void Axis::first_read(const Step& step, const canopen::SdoEnd& end) {
    if (step.kind != Step::Kind::read) return;
    const Address a = step.address;
    const auto raw = static_cast<std::int64_t>(end.done() ? canopen::low_first(end.data) : 0);
    if (a == object::statusword) known_.profile = end.done() || !node_.line.dialect.profile_optional;
    if (a == object::modes) known_.modes = static_cast<std::uint32_t>(raw);
    if (a == object::controlword) known_.cw = static_cast<std::uint16_t>(raw);
    if (a == object::homing_method) known_.homing_method = signed_of(end.data);
    for (const auto& [place, i] :
         {std::pair{object::profile_velocity, 0u}, {object::profile_acceleration, 1u}, {object::profile_deceleration, 2u}})
        if (a == place && raw > 0) known_.rates[i] = raw;
    if (a == object::error_code && end.done()) known_.fb.error_code = node_.number_of(static_cast<std::uint16_t>(raw));
    // A quick stop must end in quick stop active, where it can be seen, and not in a drive that is off.
    if (a == object::quick_stop_option) change_quick_stop_ = end.done() && node_.keep_quick_stop && raw < 5;
}

void Axis::set_up(std::vector<Step>& steps) const {
    if (!known_.profile) return;
    const auto add = [&](Address a, std::vector<std::uint8_t> bytes, bool optional) {
        steps.push_back({Step::Kind::write, a, std::move(bytes), 0, 0, optional});
    };
    if (change_quick_stop_) add(object::quick_stop_option, bytes_of(6, 2), true);
    for (const auto& p : {status_pdo(node_.number, place_), motion_pdo(node_.number, place_)})
        for (const auto& w : canopen::writes_of(p))
            add(w.address, w.bytes, false);
    if (place_ > 0) return;  // the receive PDOs of the connection set are the first axis'
    for (const auto kind : {SetPoint::Mode::position, SetPoint::Mode::velocity, SetPoint::Mode::torque}) {
        const int mode = known_.stream_mode(kind);
        if (!known_.offers(mode)) continue;
        for (const auto& w :
             canopen::writes_of(target_pdo(node_.number, static_cast<std::uint16_t>(1 + static_cast<int>(kind)), mode == 7)))
            add(w.address, w.bytes, true);
    }
}

void Axis::made_ready(Instant now) {
    new_ = false;
    deaf_ = 0;
    status_new_ = motion_new_ = false;
    if (known_.profile) check_at_ = now + std::max<Duration>(8 * node_.line.cycle, std::chrono::milliseconds(200));
}

}  // namespace axisgate::cia402_drive
