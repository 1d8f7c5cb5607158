// What is asked of a drive, and when: probes, the values at the start, polls, commands and stops in their order.
// In: the passing of time, places on the line. Out: telegrams; what a silence means.
// Never two exchanges at once; after a silence nothing for as long as its answer may still come.
#include <fmt/core.h>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {
using drive::Want;
using Phase = drive::Presence::Phase;
namespace {}

Want Drive::wants(Instant now) const noexcept {
    if (presence_.is(Phase::down) || exchange_.active() || !late_.over(now)) return Want::nothing;
    if (!stops_.empty()) return Want::urgent;
    if (!presence_.is(Phase::ready) && !presence_.is(Phase::starting)) return presence_.probe_due(now) ? Want::probe : Want::nothing;
    if (stream_.on) return stream_.ending || now >= stream_.next ? Want::command : Want::nothing;
    if (reading_.core_pending() || release_home_) return Want::command;
    if (job_.active ? now >= job_.not_before : !queue_.empty() || !set_points_.empty() || stream_.newest) return Want::command;
    if (poll_.due(now)) return fb_.moving && !pace_.close() ? Want::quick_poll : Want::poll;
    return Want::nothing;
}

Instant Drive::wish() const noexcept {
    if (presence_.is(Phase::down)) return never;
    Instant at = presence_.deadline();
    if (presence_.is(Phase::ready) || presence_.is(Phase::starting)) {
        if (stream_.on) return std::max(stops_.empty() && !stream_.ending ? stream_.next : Instant{}, late_.until());
        at = std::min(at, poll_.deadline());
        if (job_.active) at = std::min(at, job_.not_before);
        if (release_home_ || reading_.core_pending() || (!job_.active && (!queue_.empty() || !set_points_.empty() || stream_.newest)))
            at = Instant{};
    }
    if (!stops_.empty()) at = Instant{};
    return std::max(at, late_.until());
}

void Drive::go(Turn& t) {
    if (exchange_.active()) return;
    if (stream_.on && stream_.ending && (stops_.empty() || std::holds_alternative<Halt>(stops_.front().command.body)))
        return send_stream(t);
    if (!stops_.empty()) {
        if (auto telegram = stop_request(t)) return send({std::move(*telegram), Purpose::stop}, t);
    }
    const Telegram status = request(id_, Main::response, 1);
    if (!presence_.is(Phase::ready) && !presence_.is(Phase::starting)) {
        if (!presence_.probe_due(t.now)) return;
        presence_.probe_sent();
        return send({status, Purpose::probe}, t);
    }
    if (reading_.core_pending()) return send({request16(id_, Main::ram, 0, core_values[reading_.at()]), Purpose::core}, t);
    if (release_home_) {
        release_home_ = false;
        return send({control(static_cast<std::uint16_t>(cw_ & ~cw_home)), Purpose::release}, t);
    }
    if (!stream_.on && stream_.newest && !job_.active && queue_.empty()) begin_stream(t);
    if (stream_.on) return t.now >= stream_.next ? send_stream(t) : void();
    // Commands that end at once make room for the next one.
    while (!job_.active && !queue_.empty())
        begin_job(t);
    if (!job_.active && !set_points_.empty()) {  // a move without a ticket; its answers say where the axis is, so no poll is held up
        Command c;
        c.axis = axis_;
        c.body = set_points_.take().as_move();
        (void)queue_.push(std::move(c));
        begin_job(t);
    }
    if (job_.active && t.now >= job_.not_before) {
        if (auto telegram = job_request(t)) {
            Request r{std::move(*telegram), Purpose::job};
            if (std::holds_alternative<Native>(job_.command.body)) r.any_length = true;
            // The drive answers the start of its software after about 3 s: for so long no stop could pass on this line.
            r.once = job_.transfer.active;
            r.quiet = r.telegram.main == static_cast<std::uint8_t>(Main::program) && r.telegram.sub == 4;
            return send(std::move(r), t);
        }
    }
    if (exchange_.active() || !poll_.due(t.now)) return;
    poll_.asked(t.now, pace_.period(bus_.timing.poll_period));
    send({status, Purpose::poll}, t);
}

void Drive::send(Request r, Turn& t) {
    const auto bytes = pack(r.telegram, bus_.checksum);
    const Duration both = bus_.wire(bytes.size() + wire_size(ram_size, bus_.checksum));
    const bool once = r.purpose == Purpose::probe || r.purpose == Purpose::poll || r.purpose == Purpose::warn ||
                      r.purpose == Purpose::stream || r.any_length || r.quiet || r.once;
    t.out.send(Frame::run(bytes), r.purpose == Purpose::stop                                  ? Priority::urgent
                                  : r.purpose == Purpose::poll || r.purpose == Purpose::probe ? Priority::poll
                                                                                              : Priority::command);
    const Duration patience = r.purpose == Purpose::stream && !stream_.ending ? stream_.period : bus_.timing.reply_timeout + both;
    exchange_.begin(std::move(r), t.now, patience, once ? 0 : bus_.timing.retries);
}

/// An answer to what was asked: of its group, with its number where it carries one.
bool Drive::answers(const Telegram& a) const noexcept {
    if (!exchange_.active() || a.main != 0) return false;
    const Request& r = exchange_.request();
    if (r.any_length) return true;
    const Telegram& q = r.telegram;
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
            return a.sub == (q.sub == 4 || q.sub == 1 ? 0x60 : 0);
        case Main::ram:
            return a.size == ram_size;  // its sub ID is not known
        default:
            return a.sub == 0 && (r.purpose == Purpose::probe || a.size >= default_size);
    }
}

void Drive::on_telegram(const Telegram& telegram, Turn& t) {
    const Request r = exchange_.answered(bus_.counters);
    presence_.answered();
    late_.settled();
    if (r.purpose == Purpose::probe) return find(telegram, t);
    const bool default_response = telegram.sub == 0 && r.telegram.main <= static_cast<std::uint8_t>(Main::motion);
    if (default_response && telegram.size != default_size && !(r.telegram.main == 0 && r.telegram.sub == 3) && !r.any_length) {
        presence_.lose(t.now);
        not_ours_ = fmt::format("the default response of drive {} is reconfigured: {} bytes of data instead of {}", title(), telegram.size,
                                default_size);
        return lost(t, not_ours_);
    }
    if (r.purpose == Purpose::core) return core_answered(telegram, t);
    if (const auto status = status_of(telegram); status && telegram.sub == 0) learn(*status, t);
    switch (r.purpose) {
        case Purpose::stop:
            return stop_answered(t);
        case Purpose::job:
            if (job_.active) job_answered(telegram, t);
            return;
        case Purpose::stream:
            return stream_answered(t);
        default:
            return;
    }
}

void Drive::on_deadline(Turn& t) {
    switch (exchange_.on_deadline(t.now, bus_.counters)) {
        case drive::Late::no:
            return;
        case drive::Late::repeat:
            repeated_at_ = t.now;
            t.out.send(Frame::run(pack(exchange_.request().telegram, bus_.checksum)),
                       exchange_.request().purpose == Purpose::stop ? Priority::urgent : Priority::command);
            return;
        case drive::Late::over:
            return silence(t);
    }
}

void Drive::silence(Turn& t) {
    if (exchange_.request().quiet) {
        if (job_.active) job_.not_before = t.now + std::chrono::milliseconds(200);
        return;
    }
    // A stream waits for its period alone, and goes on with its next set-point: the drive may have heard it all the same.
    if (exchange_.request().purpose == Purpose::stream && t.now - stream_.heard < bus_.timing.reply_timeout) return;
    late_.missed(t.now, bus_.timing.reply_timeout);
    const Purpose purpose = exchange_.request().purpose;
    const auto what = presence_.silent(t.now);
    if (what == drive::Presence::Silence::lost) return lost(t, fmt::format("drive {} does not answer", title()));
    if (what == drive::Presence::Silence::still_absent && purpose == Purpose::probe) {
        presence_.report(not_ours_.empty() ? fmt::format("drive {} does not answer", title()) : not_ours_, t.out);
        return;
    }
    switch (purpose) {
        case Purpose::core:
            reading_.silent();
            if (!reading_.given_up()) return;
            (reading_.at() == 0 ? vmax_ : reading_.at() == 1 ? acc_ : dec_).reset();
            if (reading_.done()) {
                presence_.made_ready();
                tell(t);
                presence_.report(fmt::format("LinMot drive, {}; it does not answer reads of RAM values", state_text()), t.out);
                poll_.begin(t.now, bus_.timing.poll_period, slot_);
            }
            return;
        case Purpose::stop:
            if (stops_.empty()) return;
            if (++stops_.front().tries >= 2)
                end_stop(Outcome::failed, Reason::no_answer,
                         fmt::format("drive {} does not answer; whether it has stopped is not known", title()), t);
            return;
        case Purpose::job:
            if (job_.active) job_failed_silent(t);
            return;
        case Purpose::release:
            release_home_ = true;
            return;
        default:
            return;
    }
}

}  // namespace axisgate::linmot
