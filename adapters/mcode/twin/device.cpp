// Device: the passing of time and the link.
// Words are in exec.cpp, printing in print.cpp, programs in program_device.cpp, memory in memory.cpp.
// In: bytes, instants. Out: bytes at the instant at which the drive gives them.
// Never goes back in time.
#include "adapters/mcode/twin/device.hpp"

#include <algorithm>

namespace axisgate::mcode::twin {

Device::Device(DeviceSetup setup, std::unique_ptr<Mechanism> motor)
    : setup_(std::move(setup)), motor_(std::move(motor)), run_(program_, *this) {
    run_.base_two(setup_.base_two);
    comm_.network = setup_.ethernet;
    comm_.manners = setup_.manners;
}

bool Device::deaf() const noexcept {
    if (!powered_ || upgrading_) return true;
    const bool known = std::ranges::any_of(rate_codes, [&](int c) { return rate_of_code(c) == setup_.bit_rate; });
    return known && !setup_.ethernet && active_rate_ != setup_.bit_rate;
}

void Device::say(std::string_view text) {
    if (data_ != nullptr) {
        *data_ += text;
    } else if (!tx_.print(text, now_) && error_.code != 66) {
        raise(66);
    }
}

void Device::on_frame(const Frame& frame, Instant now, Out& out) {
    pass_until(now, out);
    if (deaf() || frame.kind != Frame::Kind::bytes || pace_.deaf(now_)) return;
    const auto bytes = frame.data();
    for (std::size_t i = comm_.pass_over(bytes); i < bytes.size(); i += 1 + comm_.pass_over(bytes.subspan(i + 1))) {
        std::string echo;
        const LinkEvent event = comm_.receive(bytes[i], echo);
        tx_.say(echo, now_);
        switch (event.kind) {
            case LinkEvent::Kind::none:
                break;
            case LinkEvent::Kind::command:
                if (waiting_.size() >= waiting_lines) {
                    raise(63);
                    break;
                }
                waiting_.push_back(comm_.take());
                if (command_due_ == never) command_due_ = pace_.next_line(now_);
                if (program_mode_.on() && setup_.manners.store > Duration::zero()) {
                    pace_.deaf_for(setup_.manners.store, command_due_);
                    return settle(out);
                }
                break;
            case LinkEvent::Kind::stop:
                pace_.stop_asked(now_);
                if (pace_.take_stop(now_)) stop_everything();
                break;
            case LinkEvent::Kind::reset:
                boot();
                break;
            case LinkEvent::Kind::step:
                tracer_.step(true);
                slice_due_ = now_;
                break;
            case LinkEvent::Kind::run_on:
                tracer_.run_as(Tracer::Mode::normal);
                slice_due_ = now_;
                break;
            case LinkEvent::Kind::overrun:
                raise(20);
                break;
        }
    }
    settle(out);
}

void Device::on_deadline(Instant now, Out& out) { pass_until(now, out); }

/// What is due up to `now`, each at the instant of its cause, however late the call is.
void Device::pass_until(Instant now, Out& out) {
    Instant done = never;
    for (int i = 0; i < events_per_call; ++i) {
        const Instant next = due();
        if (next >= now || next == done) break;  // what stays due must not hold up time
        done = next;
        now_ = std::max(now_, next);
        settle(out);
    }
    now_ = std::max(now_, now);
    settle(out);
}

/// Everything that is due up to now_, oldest first.
void Device::settle(Out& out) {
    if (powered_) {
        if (pace_.take_stop(now_)) stop_everything();
        while (const auto code = pace_.take_error(now_))
            raise(*code);
        if (trips_.time() <= now_) {
            // The position is that of the instant, however late the call is.
            motor_->advance(trips_.time());
            motor_->capture(trips_.time());
            trips_.time_over();
            take_events();
            fire(Word::TT);
        }
        motor_->advance(now_);
        take_events();
        while (command_due_ <= now_ && !waiting_.empty()) {
            const Command c = std::move(waiting_.front());
            waiting_.pop_front();
            command_due_ = waiting_.empty() ? never : pace_.next_line(now_);
            run_command(c);
            if (command_due_ != never) command_due_ = pace_.next_line(now_);
            if (!powered_ || upgrading_) break;
        }
        if (waiting_.empty()) command_due_ = never;

        if (ending_ && paused_ && !moving()) stop_program();
        while (!run_.idle() && !paused_) {
            if (ending_) {
                if (moving()) break;
                stop_program();
                break;
            }
            const bool held = run_.state() != Run::State::running;
            if (!run_.awake(now_)) break;
            // A hold is not time that the program may make up for, nor is what lies before the present instant.
            if (held || slice_due_ == never || slice_due_ + slice_time <= now_) slice_due_ = now_;
            if (slice_due_ > now_) break;
            run_slice(slice_due_);
            if (slice_due_ != never) slice_due_ += slice_time;  // never: the slice ended the program
            if (tracer_.steps()) break;
        }
        if (run_.idle()) slice_due_ = never;
        motor_->tell(error_.flag, !run_.idle(), now_);
        take_events();
    }
    tx_.flush(powered_, now_, out);
}

void Device::run_slice(Instant at) {
    for (int i = 0; i < lines_per_slice; ++i) {
        if (run_.state() != Run::State::running || paused_ || ending_) return;
        if (tracer_.waits()) return;
        const std::size_t line = run_.line();
        const auto& lines = program_.lines();
        if (tracer_.shows() && line < lines.size()) {
            if (tracer_.breaks_at(line)) return;
            say(std::to_string(lines[line].address) + ' ' + lines[line].text + "\r\n");
        }
        tracer_.step(false);
        if (const int code = run_.step(std::max(at, now_)); code != 0) raise(code);
        motor_->advance(now_);
        take_events();
    }
}

void Device::take_events() {
    // Bounded: each event is taken once, and a motor gives a finite number per instant.
    for (int i = 0; i < 64; ++i) {
        const auto e = motor_->next_event();
        if (!e) return;
        switch (e->kind) {
            case MotorEvent::Kind::error:
                if (setup_.manners.error_late > Duration::zero()) {
                    pace_.error(e->code, now_);
                } else {
                    raise(e->code);
                }
                break;
            case MotorEvent::Kind::finished:
                if (announce_) tx_.say(std::string_view(&comm_.flags.dn, 1), now_);  // whatever PY is [L4115]
                announce_ = false;
                break;
            case MotorEvent::Kind::trip:
                fire(e->word);
                break;
            case MotorEvent::Kind::end_program:
                if (run_.idle() || paused_) break;  // ignored when the program is paused [L776]
                stop_program();
                if (e->code != 0) raise(e->code);
                break;
            case MotorEvent::Kind::pause:
                if (!run_.idle() && !paused_) {
                    paused_ = true;
                    motor_->pause(now_);
                }
                break;
            case MotorEvent::Kind::resume:
                if (paused_) {
                    paused_ = false;
                    motor_->resume(now_);
                    slice_due_ = now_;
                }
                break;
            case MotorEvent::Kind::go:
                if (run_.idle()) {
                    Target first;
                    first.given = true;
                    first.address = 1;
                    if (const int code = run_program(first, Tracer::Mode::normal); code != 0) raise(code);
                }
                break;
            case MotorEvent::Kind::reset:
                boot();
                return;
        }
    }
}

void Device::run_command(const Command& command) {
    std::string data;
    int code = 0;
    data_ = &data;
    data_ended_ = true;
    data_given_ = false;
    const bool running = !run_.idle();
    bool good = command.checksum_good;
    const bool stored = program_mode_.on();
    if (good) {
        code = typed(command.text);
        good = code == 0;
    }
    data_ = nullptr;
    if (code != 0) raise(code);
    if (stored) pace_.busy_for(setup_.manners.store, now_);
    const auto printed = data_given_ ? std::optional<std::string_view>(data) : std::nullopt;
    if (pace_.busy_until() > now_) tx_.pause_until(pace_.busy_until());
    deliver(comm_.reply(command, printed, data_ended_, good, error_.flag, running), command.flags.py, setup_.manners, now_, tx_);
    if (setup_.manners.turnaround > Duration::zero()) pace_.deaf_for(setup_.manners.turnaround, tx_.end(now_));
}

Instant Device::deadline() const { return std::max(due(), now_); }

Instant Device::due() const {
    if (!powered_) return never;
    Instant t = std::min({command_due_, trips_.time(), motor_->deadline(), tx_.due(), pace_.due()});
    if (!run_.idle() && !paused_ && !ending_) {
        if (run_.state() == Run::State::running && !tracer_.waits()) t = std::min(t, slice_due_);
        if (run_.state() == Run::State::hold_time) t = std::min(t, run_.hold_until());
    }
    return t;
}

}  // namespace axisgate::mcode::twin
