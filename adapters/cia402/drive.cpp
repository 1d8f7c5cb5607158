// Drive: what it sends next, and what answers and silences mean.
// In: places on the line, frames, time. Out: requests, results. Never has two SDO transfers with one node.
#include "adapters/cia402/drive.hpp"

#include <fmt/core.h>

#include "gateway/drive/option_reader.hpp"

namespace axisgate::cia402_drive {
using Phase = Presence::Phase;

void Line::take(const LineSetup& setup) {
    timing = drive::timing_of(setup.manners, drive::Timing{.reply_timeout = std::chrono::milliseconds(50)});
    bit_rate = setup.bit_rate;
    turns.set(
        {.window = 32, .probe_window = 8, .pause = timing.pause, .overtaken_limit = 64, .overtaken_grace = 20 * wire_time(140, bit_rate)});
}

Drive::Drive(Line& line, const DriveSetup& setup, std::size_t slot)
    : line_(line),
      setup_(setup),
      node_(static_cast<std::uint8_t>(node_of(setup.address))),
      slot_(slot),
      axis_(setup.axes.empty() ? no_axis : setup.axes.front().id),
      presence_(setup.id, line.timing),
      notices_(setup.id),
      // An answer waits for the SYNC's PDOs of all nodes in the worst case.
      sdo_(node_, {.patience = line.timing.reply_timeout + 64 * wire_time(140, line.bit_rate)}),
      heartbeat_(node_),
      expected_(expected_identity(catalogue())) {
    drive::OptionReader options(setup_.options);
    keep_quick_stop_ = options.flag("quick_stop_stays", true, "yes", "no");
    heartbeat_period_ = options.milliseconds("heartbeat_ms", 0, 60'000, heartbeat_period_);
}

void Drive::line_up(Turn& t) { presence_.begin(t.now); }

void Drive::forget(Reason reason, std::string_view why, Turn& t) {
    queue_.clear();
    job_.reset();
    start_.clear();
    end_stream();
    check_at_ = never;
    need_code_ = false;
    heartbeat_.set_time({});
    tickets_.fail_all(reason, why, t.out);
    presence_.report(std::string(why), t.out);
}
void Drive::line_down(std::string_view why, Turn& t) {
    presence_.close();
    if (sdo_.busy()) {
        std::vector<Frame> unsent;
        (void)sdo_.stop(canopen::Abort::timeout, unsent);
    }
    stops_.clear();
    forget(Reason::line_down, why, t);
}

void Drive::submit(const Command& c, Turn& t) {
    if (is_urgent(c.body) || drive::is_motion(c.body) || std::holds_alternative<Enable>(c.body) ||
        std::holds_alternative<SetPosition>(c.body)) {
        end_stream();
        if (job_ && job_->stream) job_.reset();
    }
    if (drive::admit(c, setup_.name, presence_, queue_, tickets_, t) != drive::Admission::urgent) return;
    const bool off = std::holds_alternative<Disable>(c.body);
    const auto ends = [&](const Command& w) {
        return drive::is_motion(w.body) || std::holds_alternative<SetPosition>(w.body) || (off && std::holds_alternative<Enable>(w.body));
    };
    (void)queue_.interrupt(ends, name_of(c.body), tickets_, t);
    if (job_ && ends(job_->command)) {
        tickets_.failed(job_->command.ticket, Reason::interrupted, drive::CommandQueue::interrupted_by(name_of(c.body)), t.out);
        job_.reset();
    }
    if (sdo_.busy()) ask_.left = 0;
    if (!stops_.add({c, {}})) tickets_.refused(c.ticket, Reason::busy, "8 stops are on their way already", t.out);
}

drive::Want Drive::wants(Instant now) const noexcept {
    if (sdo_.busy() || presence_.is(Phase::down)) return drive::Want::nothing;
    if (const Stop* stop = stops_.first()) return !stop->job || now >= stop->job->wait_until ? drive::Want::urgent : drive::Want::nothing;
    if (!presence_.online() || presence_.is(Phase::restarting)) return presence_.probe_due(now) ? drive::Want::probe : drive::Want::nothing;
    if (presence_.is(Phase::starting)) return drive::Want::command;
    if (need_code_) return drive::Want::quick_poll;
    if (job_ ? now >= job_->wait_until : !queue_.empty() || (newest_ && stream_ == Stream::none)) return drive::Want::command;
    return !job_ && now >= check_at_ ? drive::Want::poll : drive::Want::nothing;
}
/// Of what wants() looks at, and of nothing that waits behind it.
Instant Drive::wish() const noexcept {
    if (const Stop* stop = stops_.first()) return stop->job ? stop->job->wait_until : never;
    if (!presence_.online() || presence_.is(Phase::restarting)) return presence_.deadline();
    if (presence_.is(Phase::starting)) return never;
    return job_ ? job_->wait_until : check_at_;
}

void Drive::go(Turn& t) {
    const int retries = line_.timing.retries;
    if (Stop* stop = stops_.first()) {
        if (!stop->job) stop->job = stop_job(stop->command);
        return send({Ask::Why::stop, stop->job->steps[stop->job->at], stop->command.ticket, 0}, t);
    }
    if (!presence_.online() || presence_.is(Phase::restarting)) {
        presence_.probe_sent();
        return send({Ask::Why::probe, {Step::Kind::read, object::device_type, {}}, no_ticket, 0}, t);
    }
    if (presence_.is(Phase::starting)) return next_start(t);
    if (need_code_) return send({Ask::Why::error, {Step::Kind::read, object::error_code, {}}, no_ticket, 0}, t);
    while (!job_ && !queue_.empty())
        begin(queue_.pop(), t);
    if (!job_ && newest_ && stream_ == Stream::none) {
        job_ = stream_job();
        stream_ = Stream::starting;
    }
    if (job_ && t.now >= job_->wait_until) {
        const Step& s = job_->steps[job_->at];
        if (s.kind == Step::Kind::nmt) {
            t.out.send(canopen::nmt_frame(s.nmt, node_));
            return step_done(*job_, {}, t);
        }
        const bool once = std::holds_alternative<Native>(job_->command.body) && s.kind == Step::Kind::write;
        return send({Ask::Why::step, s, job_->command.ticket, once || job_->stream ? 0 : retries}, t);
    }
    if (t.now >= check_at_) send({Ask::Why::check, {Step::Kind::read, object::error_register, {}}, no_ticket, 0}, t);
}

void Drive::send(Ask ask, Turn& t) {
    // A late answer to the same question would be taken for the new one: something else is asked before. A stop waits for nothing.
    if (ask.why != Ask::Why::stop && late_.has(ask.step.address)) {
        const bool other = late_.has(object::error_register);
        ask = {ask.why == Ask::Why::probe ? Ask::Why::probe : Ask::Why::flush,
               {Step::Kind::read, other ? object::vendor : object::error_register, {}},
               no_ticket,
               0};
        if (late_.has(ask.step.address)) late_.clear();
        if (ask.why == Ask::Why::probe) {
            ask.step.address = object::device_type;
            late_.clear();
        }
    }
    if (ask.step.from_here && job_) {
        const std::int64_t to = job_->here + signed_of(ask.step.bytes);
        ask.step.bytes = bytes_of(std::clamp<std::int64_t>(to, INT32_MIN, INT32_MAX), 4);
    }
    ask_ = std::move(ask);
    line_.turns.began(slot_, ask_.why == Ask::Why::probe);
    transfer(t);
}
void Drive::transfer(Turn& t) {
    std::vector<Frame> frames;
    const Step& s = ask_.step;
    if (s.kind == Step::Kind::write) {
        (void)sdo_.write(s.address, s.bytes, t.now, frames);
    } else {
        (void)sdo_.read(s.address, t.now, frames);
    }
    emit_frames(frames, ask_.why == Ask::Why::stop ? Priority::urgent : ask_.why == Ask::Why::step ? Priority::command : Priority::poll, t);
}
void Drive::emit_frames(std::vector<Frame>& frames, Priority priority, Turn& t) {
    for (const Frame& f : frames)
        t.out.send(f, priority);
}

void Drive::on_frame(const Frame& f, Turn& t) {
    if (presence_.is(Phase::down)) return;
    if (const auto e = canopen::emergency_of(f, node_)) return on_emergency(*e, t);
    if (f.id == static_cast<std::uint32_t>(canopen::error_control_base + node_)) return on_heartbeat(f, t);
    if (canopen::is_data(f, status_base + node_)) return on_status(f.data(), t);
    if (canopen::is_data(f, motion_base + node_)) return on_motion(f.data(), t);
    if (f.id != static_cast<std::uint32_t>(canopen::sdo_answer_base + node_)) return;
    std::vector<Frame> frames;
    const auto strays = sdo_.strays();
    const auto end = sdo_.on_frame(f, t.now, frames);
    emit_frames(frames, Priority::command, t);
    if (sdo_.strays() != strays) ++line_.counters.unexpected;
    if (!end) {
        if (!sdo_.busy()) presence_.heard(t.now);
        return;
    }
    line_.turns.ended(slot_);
    line_.turns.heard(t.now);
    if (ask_.left != line_.timing.retries && ask_.why == Ask::Why::step) late_.add(end->address);
    ++line_.counters.exchanges;
    if (!end->done()) ++line_.counters.refused;
    presence_.answered();
    ended(*end, t);
}

void Drive::ended(const canopen::SdoEnd& end, Turn& t) {
    const Ask ask = ask_;
    switch (ask.why) {
        case Ask::Why::probe:
            return probed(end, t);
        case Ask::Why::start:
            return started(ask.step, end, t);
        case Ask::Why::flush:
            return late_.clear();
        case Ask::Why::check:
            check_at_ = t.now + std::max<Duration>(4 * line_.cycle, std::chrono::milliseconds(100));
            // It answers and sends no PDOs: somebody has reset it, or taken them away.
            if (axis_ != no_axis && ++deaf_ >= 3) start(t);
            return;
        case Ask::Why::error:
            need_code_ = false;
            if (end.done()) fb_.error_code = static_cast<std::uint16_t>(canopen::low_first(end.data));
            return emit(t);
        case Ask::Why::step:
            if (job_ && job_->command.ticket == ask.ticket && job_->at < job_->steps.size() &&
                job_->steps[job_->at].address == ask.step.address)
                step_done(*job_, end, t);
            return;
        case Ask::Why::stop:
            if (Stop* stop = stops_.first(); stop && stop->job && stop->command.ticket == ask.ticket) step_done(*stop->job, end, t);
            return;
    }
}

void Drive::on_deadline(Turn& t) {
    if (heartbeat_.on_deadline(t.now) == canopen::NodeNews::lost && presence_.online()) {
        notices_.tell(Severity::warning, axis_, "heartbeat", 0, fmt::format("{}: its heartbeat has stopped", setup_.name), t.now, t.out);
        check_at_ = t.now;
    }
    if (!sdo_.busy() || t.now < sdo_.deadline()) return;
    std::vector<Frame> frames;
    const auto end = sdo_.on_deadline(t.now, frames);
    if (!end) return;
    ++line_.counters.timeouts;
    if (ask_.left > 0) {
        --ask_.left;
        ++line_.counters.retries;
        return transfer(t);
    }
    line_.turns.ended(slot_);
    late_.add(ask_.step.address);
    unanswered(t);
}

void Drive::unanswered(Turn& t) {
    const std::string what = canopen::to_text(ask_.step.address) + " was not answered: whether the drive took it is not known";
    if (Stop* stop = stops_.first(); ask_.why == Ask::Why::stop && stop) stops_.remove(stop);
    if (ask_.why == Ask::Why::step && job_) {
        if (job_->stream) end_stream();
        job_.reset();
    }
    tickets_.failed(ask_.ticket, Reason::no_answer, what, t.out);
    check_at_ = presence_.online() ? t.now : never;
    if (presence_.is(Phase::starting)) start_.clear();
    const auto silence = presence_.silent(t.now);
    if (silence == Presence::Silence::counted) return;
    forget(Reason::no_answer, "the drive does not answer", t);
}

}  // namespace axisgate::cia402_drive
