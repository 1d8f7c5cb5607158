// Drive, part exchange: one request and its acknowledgement, and everything that can go wrong between them.
// In: bytes, the passing of time. Out: requests; acknowledgements given to what asked for them.
// Never takes an acknowledgement for another request's: it carries no mark, so after a silence a barrier sorts late ones out.
#include <fmt/core.h>

#include <algorithm>

#include "adapters/pacontrol/drive.hpp"
#include "gateway/core/wire_time.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr std::size_t reply_bytes = 48;  // of the longest acknowledgement but rare ones
constexpr std::uint8_t frame_tries = 4;  // of one request that the control says it could not read (10h, 11h, 12h)
constexpr std::uint8_t misfit_limit = 2;
constexpr Duration protocol_notice_period = std::chrono::seconds(10);

bool could_not_read(std::uint16_t q) { return q == quit::check_wrong || q == quit::frame_order || q == quit::frame_begin; }
bool asks_input(const Request& r) { return r.code == 0x1900 || r.code == 0x1901; }
}  // namespace

CheckForm Drive::request_form() const noexcept { return line_.check == CheckMode::zero ? CheckForm::zero : form_; }

Duration Drive::reply_limit(std::size_t bytes) const noexcept {
    return line_.timing.reply_timeout + wire_time((bytes + reply_bytes) * line_.bits_per_byte, line_.bit_rate);
}

void Drive::begin_exchange(Purpose purpose, std::size_t axis, std::size_t bytes, Turn& t) {
    exchange_ = {};
    exchange_.purpose = purpose;
    exchange_.axis = axis;
    exchange_.number = ++exchanges_;
    exchange_.sent = t.now;
    exchange_.deadline = t.now + reply_limit(bytes);
    framer_.reset();
}

void Drive::send(Purpose purpose, const Request& request, std::size_t axis, Priority priority, Turn& t) {
    const auto bytes = framed(text_of(request), request_form());
    t.out.send(Frame::run(bytes), priority);
    begin_exchange(purpose, axis, bytes.size(), t);
    exchange_.request = request;
}

void Drive::send_poll(Purpose purpose, std::size_t axis, Priority priority, Turn& t) {
    t.out.send(Frame::run(std::array{EOT}), priority);
    begin_exchange(purpose, axis, 1, t);
    exchange_.eot = true;
}

void Drive::send_raw(std::vector<std::uint8_t> bytes, Purpose purpose, std::size_t axis, Turn& t) {
    t.out.send(Frame::run(bytes), Priority::command);
    begin_exchange(purpose, axis, bytes.size(), t);
}

// --- what arrives ----------------------------------------------------------------------------------------------------------------

void Drive::on_bytes(std::span<const std::uint8_t> bytes, Turn& t) {
    const Framer::Sink sink{[&](std::string_view text, std::string_view digits) { on_text(text, digits, t); },
                            [&] { garbled("an EOT outside a frame", t); },
                            [&](FrameFault fault, std::span<const std::uint8_t>) { garbled(name_of(fault), t); }};
    framer_.push(bytes, sink);
}

/// Counted always; told at most every ten seconds.
void Drive::garbled(std::string_view what, Turn& t) {
    ++counters_.garbled;
    if (t.now < next_protocol_notice_) return;
    next_protocol_notice_ = t.now + protocol_notice_period;
    notice(Severity::warning, "protocol", 0, fmt::format("not an acknowledgement: {}", what), t);
}

void Drive::on_text(std::string_view text, std::string_view digits, Turn& t) {
    const auto form = form_of_check(text, digits, reply_form_.value_or(CheckForm::with_etx));
    std::string fault;
    std::optional<Reply> reply;
    if (!form) {
        fault = fmt::format("check {} is wrong, {} would be right: {}", digits.empty() ? "(none)" : digits,
                            check_of(text, CheckForm::with_etx), text);
    } else if (line_.strict && *form == CheckForm::text) {
        fault = fmt::format("check {} leaves the ETX out, {} would be right (strict = off takes both): {}", digits,
                            check_of(text, CheckForm::with_etx), text);
    } else if (*form == CheckForm::zero && reply_form_) {
        fault = fmt::format("check 0 from a control that computes it: {}", text);
    } else {
        reply = reply_of(text, fault);
    }
    if (!reply) {
        garbled(fault, t);
        // A whole frame came, so the answer is here and cannot come late; what it said is not known.
        if (exchange_.active()) silent(t);
        return;
    }
    if (*form != CheckForm::zero) reply_form_ = line_.strict ? CheckForm::with_etx : *form;
    raw_reply_ = framed(text, *form);
    answered(*reply, t);
}

void Drive::answered(const Reply& reply, Turn& t) {
    if (!exchange_.active()) {
        // An answer to a command that was given up, or the control speaks unasked. Its status is as fresh as any.
        ++counters_.unexpected;
        if (t.now >= next_protocol_notice_) {
            next_protocol_notice_ = t.now + protocol_notice_period;
            notice(Severity::info, "protocol", reply.quit, fmt::format("an acknowledgement that nobody waits for: {}", describe(reply)), t);
        }
        if (presence_.is(Phase::ready)) learn(reply, t);
        return;
    }
    const bool barrier_late = reply.quit == quit::input_unknown && exchange_.purpose != Purpose::barrier &&
                              (exchange_.eot ? exchange_.purpose != Purpose::job : !asks_input(exchange_.request));
    if (barrier_late) {
        ++counters_.unexpected;  // of a barrier that was sent twice
        return;
    }
    // A get command whose answer has the other type: this is another one's answer. At the third time running the control is like that.
    const CommandInfo* asked = exchange_.eot ? nullptr : command_info(exchange_.request.code);
    if (asked && asked->code >= 0x1000 && reply.quit == 0 && exchange_.purpose != Purpose::barrier) {
        std::uint8_t& misfits = misfits_[static_cast<std::size_t>(asked - all_commands().data())];
        if ((asked->answer == Carries::real) == reply.real) {
            misfits = 0;
        } else if (misfits < misfit_limit) {
            ++misfits;
            ++counters_.unexpected;
            out_of_step_ = true;
            return;
        }
    }
    presence_.answered();
    if (could_not_read(reply.quit) && !exchange_.eot) return answered_with_frame_error(reply, t);
    check_refusals_ = 0;
    form_proved_ = true;

    if (exchange_.purpose == Purpose::barrier && reply.quit != quit::input_unknown && reply.quit != quit::inadmissible) {
        ++counters_.unexpected;  // late: the barrier's own answer is still to come
        heard_in_barrier_ = true;
        return;
    }
    const Exchange x = std::exchange(exchange_, Exchange{});
    quiet_until_ = t.now + line_.timing.pause;
    ++counters_.exchanges;
    if (!presence_.is(Phase::ready)) found(t);
    exchange_.request = x.request;  // read by what follows; not active
    exchange_.eot = x.eot;
    learn(reply, t);
    follow(x, reply, t);
    switch (x.purpose) {
        case Purpose::none:
        case Purpose::probe:
            break;
        case Purpose::barrier:
            if (reply.quit == quit::input_unknown) return in_step();
            look_due_ = true;  // refused as such: something is being processed, or the answer was late; a poll tells
            return;
        case Purpose::look:
            look_due_ = false;
            if (!reply.end && !processing_.active) {
                processing_ = {};
                processing_.active = processing_.foreign = true;
                processing_.next_poll = t.now;
                processing_.limit = t.now + options_.processing_limit;
            }
            return in_step();
        case Purpose::job:
            return job_answered(axes_[x.axis], reply, t);
        case Purpose::processing:
            if (!processing_.active) return;
            if (!x.eot) {                     // hidden: the status of the axis
                if (reply.quit != 0) return;  // still barred
                learn_status(axes_[x.axis], static_cast<int>(number_of(reply).value_or(-1)), t);
                if (axes_[x.axis].status == 1) return;
                return processing_over(reply, t);
            }
            if (reply.real && number_of(reply) &&
                (processing_.code == code::move_absolute_wait || processing_.code == code::move_relative_wait)) {
                learn_position(axes_[x.axis], *number_of(reply), t);
            }
            if (!reply.end) axes_[x.axis].running_at = t.now;
            emit_all(t);
            if (reply.end) processing_over(reply, t);
            return;
        case Purpose::stop:
            return stop_answered(reply, t);
        case Purpose::renew: {
            Axis& a = axes_[x.axis];
            if (reply.quit == 0) {
                learn_position(a, number_of(reply).value_or(0), t);
            } else {
                a.renew_at = never;
                end_motion(a, false, Reason::drive_refused, fmt::format("the manual move was not renewed: {}", describe_quit(reply.quit)),
                           t);
            }
            return;
        }
        case Purpose::give_back:
            if (reply.quit != 0) {
                leaving_ = false;
                notice(Severity::warning, "mode", reply.quit,
                       fmt::format("the control could not be given back: {}", describe_quit(reply.quit)), t);
            }
            return;
        case Purpose::poll:
            return poll_answered(x.poll, reply, t);
    }
}

/// The control could not read the request (10h, 11h, 12h), so it has not been executed and may be sent again, whatever it was.
void Drive::answered_with_frame_error(const Reply& reply, Turn& t) {
    const Exchange x = std::exchange(exchange_, Exchange{});
    ++counters_.retries;
    if (!presence_.is(Phase::ready)) found(t);
    learn(reply, t);
    if (reply.quit == quit::check_wrong && line_.check == CheckMode::learn && ++check_refusals_ >= (form_proved_ ? 3 : 2)) {
        check_refusals_ = 0;
        form_ = form_ == CheckForm::text ? CheckForm::with_etx : form_ == CheckForm::with_etx ? CheckForm::zero : CheckForm::text;
        notice(Severity::warning, "protocol", reply.quit,
               fmt::format("the control says that the check is wrong; now sent: {}", name_of(form_)), t);
    }
    switch (x.purpose) {
        case Purpose::probe:
        case Purpose::none:
        case Purpose::barrier:
        case Purpose::look:
        case Purpose::give_back:
        case Purpose::processing:
        case Purpose::renew:
        case Purpose::poll:
            return;  // comes again by itself
        case Purpose::job: {
            Axis& a = axes_[x.axis];
            if (!a.job.active() || !a.job.in_flight) return;
            a.job.in_flight = false;
            if (a.job.tries < frame_tries && a.job.raw.empty()) {
                a.job.want = Job::Want::send;
                return;
            }
            if (a.job.kind == Job::Kind::native) return run(a, &reply, t);
            (void)ended_by_quit(a, reply, t, "the line is disturbed, or check is set wrongly (option check)");
            return;
        }
        case Purpose::stop:
            if (!stops_.empty() && ++stops_.front().tries >= 2 * frame_tries) {
                stop_over(Outcome::failed, Reason::drive_refused, describe_quit(reply.quit), t, reply.quit);
            }
            return;
    }
}

/// The exchange has had no answer that could be read.
void Drive::silent(Turn& t) {
    const Exchange x = std::exchange(exchange_, Exchange{});
    ++counters_.timeouts;
    out_of_step_ = true;
    if (!x.eot && (x.purpose == Purpose::job || x.purpose == Purpose::stop)) not_acknowledged(x.request);
    switch (x.purpose) {
        case Purpose::none:
        case Purpose::probe:
        case Purpose::poll:
        case Purpose::give_back:
            break;
        case Purpose::renew:
            axes_[x.axis].renew_at = t.now;
            break;
        case Purpose::barrier:
            if (heard_in_barrier_) {
                in_step();  // answers came, then silence for a whole time-out: nothing is on its way any more
                presence_.answered();
                return;
            }
            break;
        case Purpose::look:
            break;
        case Purpose::processing:
            processing_.next_poll = t.now;
            break;
        case Purpose::job:
            job_silent(axes_[x.axis], t);
            break;
        case Purpose::stop:
            stop_silent(t);
            break;
    }
    count_silence(t);
}

/// Every answer from here on belongs to what asked for it.
void Drive::in_step() {
    out_of_step_ = false;
    heard_in_barrier_ = false;
    look_due_ = false;
    wake_ = true;
    for (Stop& s : stops_)
        s.blind = false;
}

}  // namespace axisgate::pacontrol
