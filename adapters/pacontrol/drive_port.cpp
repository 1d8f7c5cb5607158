// Port: one exchange after the other, the check's form, and the way back into step.
// In: frames found among the bytes, deadlines. Out: what the drive is told of each.
// Never repeats by itself: after a silence the barrier comes first, and whoever asked decides anew.
#include "adapters/pacontrol/drive_port.hpp"

#include <fmt/core.h>

#include "adapters/pacontrol/drive.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr std::size_t reply_bytes = 48;  // of the longest acknowledgement but rare ones
constexpr std::uint8_t misfit_limit = 2;
constexpr std::uint8_t zero_checks_limit = 4;  // in a row, then the control has stopped computing the check
constexpr Duration protocol_notice_period = std::chrono::seconds(10);

bool could_not_read(std::uint16_t q) { return q == quit::check_wrong || q == quit::frame_order || q == quit::frame_begin; }
bool asks_input(const Request& r) { return r.code == 0x1900 || r.code == 0x1901; }
}  // namespace

void Port::forget() {
    exchange_.drop();
    framer_.reset();
    out_of_step_ = true;
    answered_in_barrier_ = look_due_ = false;
}

void Port::begin(Sent what, std::span<const std::uint8_t> bytes, Priority priority, Turn& t) {
    t.out.send(Frame::run(bytes), priority, what.order);
    const Bus& bus = drive_.bus;
    const Duration patience = bus.timing.reply_timeout + bus.wire(bytes.size() + reply_bytes);
    exchange_.begin(std::move(what), t.now, patience, 0);
    ++drive_.exchanges;
    framer_.reset();
}

void Port::send(Sent what, Priority priority, Turn& t) {
    const CheckForm form = drive_.bus.check == CheckMode::zero ? CheckForm::zero : form_;
    const auto bytes = what.eot ? std::vector<std::uint8_t>{EOT} : framed(text_of(what.request), form);
    begin(std::move(what), bytes, priority, t);
}

void Port::send_raw(Sent what, std::span<const std::uint8_t> bytes, Turn& t) { begin(std::move(what), bytes, Priority::command, t); }

/// Input 0 does not exist: the answer is "inadmissible input", which nothing else that is sent gives. What comes before it is late.
bool Port::send_barrier(Turn& t) {
    if (look_due_) {
        send({.purpose = Purpose::look, .eot = true}, Priority::command, t);
    } else if (out_of_step_) {
        send({Purpose::barrier, 0, request_for(code::get_input)}, Priority::command, t);
    }
    return busy();
}

void Port::on_bytes(std::span<const std::uint8_t> bytes, Turn& t) {
    const Framer::Sink sink{[&](std::string_view text, std::string_view digits) { on_text(text, digits, t); },
                            [&] { garbled("an EOT outside a frame", t); },
                            [&](FrameFault fault, std::span<const std::uint8_t>) { garbled(name_of(fault), t); }};
    framer_.push(bytes, sink);
}

/// Counted always; published at most every ten seconds.
void Port::garbled(std::string_view what, Turn& t) {
    ++drive_.bus.counters.garbled;
    if (t.now < next_protocol_notice_) return;
    next_protocol_notice_ = t.now + protocol_notice_period;
    drive_.notice(Severity::warning, "protocol", 0, fmt::format("not an acknowledgement: {}", what), t);
}

void Port::on_text(std::string_view text, std::string_view digits, Turn& t) {
    const auto form = form_of_check(text, digits, reply_form_.value_or(CheckForm::with_etx));
    std::string fault;
    std::optional<Reply> reply;
    if (!form) {
        fault = fmt::format("check {} is wrong, {} would be right: {}", digits.empty() ? "(none)" : digits,
                            check_of(text, CheckForm::with_etx), text);
    } else if (drive_.bus.strict && *form == CheckForm::text) {
        fault = fmt::format("check {} leaves the ETX out, {} would be right (strict = off takes both): {}", digits,
                            check_of(text, CheckForm::with_etx), text);
    } else if (*form == CheckForm::zero && reply_form_ && ++zero_checks_ < zero_checks_limit) {
        fault = fmt::format("check 0 from a control that computes it: {}", text);
    } else {
        reply = reply_of(text, fault);
    }
    if (!reply) {
        garbled(fault, t);
        // A whole frame came, so the answer is here and cannot come late; what it says is not known.
        if (!busy()) return;
        exchange_.drop();
        ++drive_.bus.counters.timeouts;
        return silent(t);
    }
    zero_checks_ = 0;
    // A sum that is 0 by itself does not show which form the control sends, nor that it computes one.
    if (*form == CheckForm::zero) {
        reply_form_.reset();
    } else if (check_of(text, *form) != 0) {
        reply_form_ = drive_.bus.strict ? CheckForm::with_etx : *form;
    }
    raw_reply_ = framed(text, *form);
    on_reply(*reply, t);
}

void Port::unasked(const Reply& reply, Turn& t) {
    ++drive_.bus.counters.unexpected;
    if (t.now >= next_protocol_notice_) {
        next_protocol_notice_ = t.now + protocol_notice_period;
        drive_.notice(Severity::info, "protocol", reply.quit, fmt::format("an acknowledgement that nobody waits for: {}", describe(reply)),
                      t);
    }
    if (drive_.ready()) drive_.feedback.learn(reply, t);  // its status is as fresh as any
}

bool Port::is_of_another(const Sent& sent, const Reply& reply) {
    // Of a barrier that was sent twice.
    if (reply.quit == quit::input_unknown && sent.purpose != Purpose::barrier &&
        (sent.eot ? sent.purpose != Purpose::job : !asks_input(sent.request)))
        return true;
    // A get command whose answer has the other type: this is another one's answer. At the third time running the control is like that.
    const CommandInfo* asked = sent.eot ? nullptr : command_info(sent.request.code);
    if (!asked || asked->code < 0x1000 || reply.quit != 0 || sent.purpose == Purpose::barrier) return false;
    std::uint8_t& misfits = misfits_[static_cast<std::size_t>(asked - all_commands().data())];
    if ((asked->answer == Carries::real) == reply.real) {
        misfits = 0;
        return false;
    }
    if (misfits >= misfit_limit) return false;
    ++misfits;
    return out_of_step_ = true;
}

void Port::on_reply(const Reply& reply, Turn& t) {
    if (!busy()) return unasked(reply, t);
    if (is_of_another(exchange_.request(), reply)) {
        ++drive_.bus.counters.unexpected;
        return;
    }
    drive_.presence.answered();
    if (could_not_read(reply.quit) && !exchange_.request().eot) {
        exchange_.drop();
        ++drive_.bus.counters.retries;
        const Sent sent = exchange_.request();
        check_refused(reply, t);
        return drive_.not_read(sent, reply, t);
    }
    check_refusals_ = 0;
    form_proved_ = true;
    if (exchange_.request().purpose == Purpose::barrier && reply.quit != quit::input_unknown && reply.quit != quit::inadmissible) {
        ++drive_.bus.counters.unexpected;  // late: the barrier's own answer is still to come
        answered_in_barrier_ = true;
        return;
    }
    const Sent sent = exchange_.answered(drive_.bus.counters);
    quiet_until_ = t.now + drive_.bus.timing.pause;
    drive_.answered(sent, reply, t);
    if (sent.purpose == Purpose::look) return regain_step();
    if (sent.purpose != Purpose::barrier) return;
    if (reply.quit == quit::input_unknown) return regain_step();
    look_due_ = true;  // refused as such: something is being processed, or the answer was late; a poll tells
}

void Port::check_refused(const Reply& reply, Turn& t) {
    if (reply.quit != quit::check_wrong || drive_.bus.check != CheckMode::learn || ++check_refusals_ < (form_proved_ ? 3 : 2)) return;
    check_refusals_ = 0;
    form_ = form_ == CheckForm::text ? CheckForm::with_etx : form_ == CheckForm::with_etx ? CheckForm::zero : CheckForm::text;
    drive_.notice(Severity::warning, "protocol", reply.quit,
                  fmt::format("the control answers that the check is wrong; now sent: {}", name_of(form_)), t);
}

void Port::on_deadline(Turn& t) {
    if (exchange_.on_deadline(t.now, drive_.bus.counters) == drive::Late::over) silent(t);
}

/// The exchange has had no answer that could be read.
void Port::silent(Turn& t) {
    const Sent sent = exchange_.request();
    out_of_step_ = true;
    look_due_ = false;  // a look that is not answered: the barrier is sent again
    if (sent.purpose == Purpose::barrier && answered_in_barrier_) {
        regain_step();  // answers came, then silence for a whole time-out: nothing is on its way any more
        drive_.presence.answered();
        return;
    }
    drive_.silent(sent, t);
}

void Port::regain_step() {
    out_of_step_ = answered_in_barrier_ = look_due_ = false;
    drive_.in_step();
}

}  // namespace axisgate::pacontrol
