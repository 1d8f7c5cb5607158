// Drive, part start: how a node is found, what is read of it, and how it is set up to be heard and led.
// In: answers. Out: reads, then writes. A node that the site does not name (a scan) is read and never written to.
#include <fmt/core.h>

#include "adapters/cia402/drive.hpp"

namespace axisgate::cia402_drive {

void Drive::probed(const canopen::SdoEnd& end, Turn& t) {
    const bool servo = end.done() && (canopen::low_first(end.data) & 0xFFFFu) == 402;
    if (!servo) {
        presence_.lose(t.now, line_.timing.pause_max);
        const std::string what =
            end.done() ? fmt::format("device profile {}", canopen::low_first(end.data) & 0xFFFFu) : canopen::to_text(end);
        return presence_.report("a node answers that is no drive by CiA 402: " + what, t.out);
    }
    presence_.found();
    identity_.clear();
    told_ = {};
    start(t);
}

void Drive::start(Turn& t) {
    if (presence_.is(Presence::Phase::ready)) presence_.found();  // set up anew
    (void)t;
    start_.clear();
    start_at_ = 0;
    deaf_ = 0;
    status_new_ = motion_new_ = false;
    const auto read = [&](Address a) { start_.push_back({Step::Kind::read, a, {}, 0, 0, true}); };
    for (const Address a : {object::vendor, object::product, object::revision})
        read(a);
    if (axis_ == no_axis) return;
    for (const Address a : {object::modes, object::controlword, object::homing_method, object::profile_velocity,
                            object::profile_acceleration, object::profile_deceleration, object::error_code, object::quick_stop_option})
        read(a);
}

void Drive::set_up(std::vector<Step>& steps) const {
    const auto add = [&](Address a, std::vector<std::uint8_t> bytes, bool optional) {
        steps.push_back({Step::Kind::write, a, std::move(bytes), 0, 0, optional});
    };
    add(object::heartbeat, bytes_of(milliseconds_of(heartbeat_period_), 2), true);
    for (const auto& p : {status_pdo(node_), motion_pdo(node_)})
        for (const auto& w : canopen::writes_of(p))
            add(w.address, w.bytes, false);
    for (const auto& [number, mode] : {std::pair{1, 8}, {2, 9}, {3, 10}})
        if (offers(mode))
            for (const auto& w : canopen::writes_of(target_pdo(node_, static_cast<std::uint16_t>(number))))
                add(w.address, w.bytes, true);
    Step go;
    go.kind = Step::Kind::nmt;
    steps.push_back(go);
}

void Drive::next_start(Turn& t) {
    if (start_.empty()) start(t);
    if (start_at_ >= start_.size()) {
        start_.clear();
        presence_.made_ready();
        presence_.report("CiA 402 drive, " + identity_, t.out);
        // It is served all the same: what is safe with another model of the same maker, the plant knows and the gateway does not.
        if (const std::string fault = differs(expected_, told_); !fault.empty())
            notices_.tell(Severity::warning, axis_, "identity", 0, fmt::format("{}: {}", setup_.name, fault), t.now, t.out);
        heartbeat_.set_time(3 * heartbeat_period_);
        check_at_ = t.now + std::max<Duration>(8 * line_.cycle, std::chrono::milliseconds(200));
        return;
    }
    const Step& s = start_[start_at_];
    if (s.kind == Step::Kind::nmt) {
        t.out.send(canopen::nmt_frame(s.nmt, node_));
        ++start_at_;
        return next_start(t);
    }
    send({Ask::Why::start, s, no_ticket, line_.timing.retries}, t);
}

void Drive::started(const Step& step, const canopen::SdoEnd& end, Turn& t) {
    if (start_at_ >= start_.size()) return;
    if (!end.done() && !step.optional) {
        start_.clear();
        presence_.lose(t.now, line_.timing.pause_max);
        return forget(Reason::drive_refused, "the drive cannot be set up: " + canopen::to_text(end), t);
    }
    const Address a = step.address;
    const auto raw = static_cast<std::int64_t>(end.done() && step.kind == Step::Kind::read ? canopen::low_first(end.data) : 0);
    if (a == object::vendor) identity_ = fmt::format("vendor {:X}h", raw);
    if (a == object::product) identity_ += fmt::format(", product {:X}h", raw);
    if (a == object::revision) identity_ += fmt::format(", revision {:X}h", raw);
    for (const auto& [place, i] : {std::pair{object::vendor, 0u}, {object::product, 1u}, {object::revision, 2u}})
        if (a == place && end.done()) told_[i] = static_cast<std::uint32_t>(raw);
    if (a == object::modes) modes_ = static_cast<std::uint32_t>(raw);
    if (a == object::controlword && step.kind == Step::Kind::read) cw_ = static_cast<std::uint16_t>(raw);
    if (a == object::homing_method) homing_method_ = signed_of(end.data);
    if (a == object::profile_velocity && raw > 0) profile_[0] = raw;
    if (a == object::profile_acceleration && raw > 0) profile_[1] = raw;
    if (a == object::profile_deceleration && raw > 0) profile_[2] = raw;
    if (a == object::error_code && end.done()) fb_.error_code = static_cast<std::uint16_t>(raw);
    ++start_at_;
    if (a == object::quick_stop_option && step.kind == Step::Kind::read) {
        // A quick stop must end in quick stop active, where it can be seen, and not in a drive that is off.
        if (end.done() && keep_quick_stop_ && raw < 5)
            start_.push_back({Step::Kind::write, object::quick_stop_option, bytes_of(6, 2), 0, 0, true});
        set_up(start_);
    }
}

}  // namespace axisgate::cia402_drive
