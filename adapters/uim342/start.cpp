// Drive, part start-up: is it there, what is it, what does it hold; and what follows when it falls silent or restarts.
// In: answers to ML and to the reads of the list below. Out: DriveLink, samples of everything read, the node made ready.
// Never writes to the drive but MF=0, which changes no value: a group left selected by somebody else would falsify the reads.
#include <fmt/core.h>

#include "adapters/uim342/drive.hpp"
#include "adapters/uim342/native.hpp"

namespace axisgate::uim342 {
namespace {
struct Read {
    std::uint8_t cw;
    std::uint8_t index;
};
// First what every command rests on; commands wait for it. Then the rest of the picture, between polls and behind commands.
constexpr std::array core{Read{cw::MS, 0}, Read{cw::MS, 1}, Read{cw::ER, 0}, Read{cw::IC, 4}, Read{cw::IC, 0}, Read{cw::IC, 5},
                          Read{cw::AC, 0}, Read{cw::DC, 0}, Read{cw::SS, 0}, Read{cw::SD, 0}, Read{cw::DV, 0}, Read{cw::DV, 2},
                          Read{cw::PP, 7}, Read{cw::PP, 8}, Read{cw::QE, 3}, Read{cw::IE, 8}};
constexpr std::array rest{
    Read{cw::SN, 0}, Read{cw::PP, 5}, Read{cw::IC, 1}, Read{cw::IC, 2}, Read{cw::IC, 3}, Read{cw::IC, 6}, Read{cw::IC, 7}, Read{cw::MT, 0},
    Read{cw::MT, 1}, Read{cw::MT, 2}, Read{cw::MT, 3}, Read{cw::QE, 0}, Read{cw::QE, 1}, Read{cw::QE, 2}, Read{cw::QE, 4}, Read{cw::IE, 0},
    Read{cw::IE, 1}, Read{cw::IE, 2}, Read{cw::DV, 1}, Read{cw::DV, 3}, Read{cw::DV, 4}, Read{cw::BL, 0}, Read{cw::IL, 0}, Read{cw::IL, 1},
    Read{cw::IL, 2}, Read{cw::IL, 3}, Read{cw::TG, 0}, Read{cw::TG, 1}, Read{cw::TG, 2}, Read{cw::DI, 0}, Read{cw::MO, 0}};
constexpr std::size_t all = core.size() + rest.size();
constexpr Duration boot_time = std::chrono::milliseconds(300);  // not in the manual; probing goes on if it takes longer

constexpr Read read_at(std::size_t n) { return n < core.size() ? core[n] : rest[n - core.size()]; }
}  // namespace

void Drive::begin_probing(Turn& t) {
    presence_.begin(t.now);
    stop_polls();
}

void Drive::stop_polls() noexcept {
    poll_.stop();
    poll_speed_ = false;
    read_error_ = false;
}

/// Its presence has been lost just now.
void Drive::went_absent(Turn& t, std::string why) {
    before_ = {status_known_ && position_known_, status_.on, fb_.referenced, fb_.position, cause_ == Cause::own};
    stop_polls();
    fail_all(Reason::no_answer, why, t);
    presence_.report(std::move(why), t.out);
}

void Drive::probe_answered(const Message& m, Turn& t) {
    const Model model = model_of(m);
    if (model.gateway) {
        presence_.lose(t.now, bus_.timing.pause_max);
        return went_absent(t,
                           fmt::format("at ID {} answers a gateway ({}), not a UIM342: correct the drive's address", address_, model.name));
    }
    const unsigned firmware = m.dl >= 6 ? get_u16(&m.d[4]) : 0u;
    if (model.name.empty()) {
        identity_ = fmt::format("unknown model ({}), firmware {}", hex_of(m), firmware);
        notice(Severity::warning, "model", 0,
               fmt::format("ID {} answers ML with {}: not a model of the UIM342 manual; it is treated as one", address_, hex_of(m)), t);
    } else {
        identity_ = fmt::format("{}, firmware {}", model.name, firmware);
    }
    presence_.found();
    presence_.report(identity_, t.out);
    bus_.points.each(m, 0, [&](const Binding& b, Value v) {
        t.out.samples.push_back({axis_, b.point, std::move(v), Quality::good, t.now});
    });
    status_known_ = position_known_ = rest_unread_ = false;
    // A refusal of before the silence is no fault after it; a restart clears the flag, and then it says nothing.
    cause_ = before_.known && before_.own_error ? Cause::own : Cause::none;
    alarm_ = 0;
    motion_ = {};
    forget_demand();
    prepared_ = false;
    stop_ramp_ = false;
    fb_.target_reached = false;
    fb_.homing_error = false;
    begin_reading(t, true);
}

/// `from_nothing`: nothing of before is trusted. Else the drive goes on being used, but its RAM may have changed.
void Drive::begin_reading(Turn& t, bool from_nothing) {
    (void)t;
    reading_.begin(core.size(), all);
    mf_unknown_ = true;
    ac_.reset();
    dc_.reset();
    ss_.reset();
    sd_.reset();
    time_ramps_.reset();
    for (auto& v : il_)
        v.reset();
    for (auto& v : tg_)
        v.reset();
    if (!from_nothing) return;
    auto_on_.reset();
    absolute_encoder_.reset();
    battery_ok_.reset();
    notifies_.reset();
    closed_loop_.reset();
    ptp_speed_.reset();
}

void Drive::startup_next(Turn& t) {
    const Read r = read_at(reading_.at());
    const Message m = msg_get(r.cw, r.index);
    if (late_.has(mark_of(m))) return go_barrier(t);
    if (mf_unknown_ && instruction(r.cw)->takes_mf)
        return send_exchange(msg_set(cw::MF, 0), Purpose::clear_mf, 0, bus_.timing.retries, Priority::poll, t);
    if (reading_.given_up()) {
        // Everything else is answered but not this one: leave it unknown rather than ask for ever.
        notice(Severity::warning, "protocol", 0, fmt::format("{} is not answered; its value stays unknown", describe_request(m)), t);
        startup_step_done(t);
        if (!reading_.pending() || exchange_.active() || !presence_.is(Phase::starting)) return;
        return startup_next(t);
    }
    send_exchange(m, Purpose::startup, 0, bus_.timing.retries, Priority::poll, t);
}

void Drive::startup_step_done(Turn& t) {
    if (reading_.done()) core_known(t);
}

/// Everything is known that commands rest on.
void Drive::core_known(Turn& t) {
    const bool first = presence_.is(Phase::starting);
    presence_.made_ready();
    if (first) {
        // A restart loses the zero of an incremental encoder. A drive that is still on (and does not switch itself on), or still
        // stands where it stood (a restart begins at 0), was only out of reach.
        const bool stayed_on = before_.on && status_.on && auto_on_ == false;
        const bool stayed_there = before_.position != 0 && fb_.position == before_.position && absolute_encoder_ == false;
        const bool same = before_.known && position_known_ && (stayed_on || stayed_there);
        fb_.referenced = same && before_.referenced;
        if (!fb_.referenced) fb_.homing_attained = false;
        if (before_.known && !same) {
            notice(Severity::info, "presence", 0, "the drive was away and may have been restarted: values kept in RAM alone are lost", t);
        }
        before_ = {};
        power_expected_ = status_.on;
        poll_.begin(t.now, bus_.timing.poll_period, slot_);
    }
    if (options_.absolute_known && absolute_encoder_ == true && battery_ok_ != false) fb_.referenced = true;
    derive(t);
    emit(t);
}

/// SY[1] has been sent; nothing acknowledges it [L1216].
void Drive::reboot_begun(Turn& t) {
    before_ = {};
    fb_.referenced = false;
    fb_.homing_attained = false;
    fail_all(Reason::interrupted, "the drive is restarted", t);
    restore_ = {};
    presence_.restart(t.now, boot_time);
    stop_polls();
}

}  // namespace axisgate::uim342
