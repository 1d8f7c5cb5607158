// Device: what concerns stored programs: running, tracing, trips, the editor, listing and clearing.
// In: statements with worked-out fields. Out: MCode error codes.
// Never executes a line: that is the interpreter's.
#include <algorithm>

#include "adapters/mcode/twin/device.hpp"
#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {
int Device::declare(const Statement& s, std::span<const Number> fields) {
    if (s.name.size() == 2 && (setup_.product & lmm) != 0 && word_named(s.name) == Word::PW) return err::illegal_data;
    Symbols& names = program_.symbols();
    if (s.symbol == no_symbol) return 31;
    const bool stored = data_ == nullptr;
    if (const int code = names.define(s.symbol, stored ? Symbol::Kind::local : Symbol::Kind::global); code != 0) return code;
    names.at(s.symbol).value = 0;
    return fields.empty() ? 0 : run_.store(s.symbol, fields[0]);
}

int Device::run_program(const Target& target, Mode mode) {
    int error = 0;
    const std::int32_t line = program_.find(target, error);
    if (line < 0) return error;
    clear_error();
    program_.reset_locals();
    run_.start(static_cast<std::size_t>(line));
    mode_ = mode;
    comm_.stepping(mode == Mode::step);
    step_now_ = false;
    paused_ = false;
    ending_ = false;
    input_pending_ = false;
    slice_due_ = now_;
    return 0;
}

int Device::execute_label(const Statement& s, std::span<const Number> fields) {
    if (!run_.idle()) return err::running;
    const std::int64_t mode = fields.empty() ? 0 : fields[0].as_integer();
    if (mode < 0 || mode > 2) return err::bad_value;
    if (!s.target) return err::unknown_name;
    return run_program(*s.target, static_cast<Mode>(mode));
}

int Device::break_point(const Statement& s, std::span<const Number> fields) {
    if (!s.target || !s.target->given) {
        if (run_.idle()) return err::not_running;
        mode_ = Mode::step;
        comm_.stepping(true);
        return 0;
    }
    int error = 0;
    if (s.target->label == no_symbol && s.target->address == 0 && !s.target->missing_name) {
        break_at_.reset();
        return 0;
    }
    if (program_.find(*s.target, error) < 0) return error;
    break_at_ = s.target;
    break_count_ = fields.empty() ? 1 : std::max<std::int64_t>(fields[0].as_integer(), 1);
    return 0;
}

int Device::set_trip(const Statement& s, std::span<const Number> fields) {
    const std::size_t i = trip_index(s.word);
    const bool none = s.target && s.target->label == no_symbol && s.target->address == 0 && !s.target->missing_name;
    if (!(none && s.word == Word::TR)) {
        int error = 0;
        if (!s.target || program_.find(*s.target, error) < 0) return err::unknown_name;
    }
    Trip t;
    t.defined = true;
    t.target = *s.target;
    if (s.word == Word::TT) {
        t.ms = fields[0].as_integer();
        if (t.ms < 1 || t.ms > 65535) return err::bad_value;
    } else {
        if (s.word == Word::TR && fields.size() > 1) {
            t.repeats = fields[1].as_integer();
            if (t.repeats < 0 || t.repeats > 65000) return err::bad_value;
            t.left = t.repeats;
        }
        if (const int code = motor_->arm(s.word, fields, now_); code != 0) return code;
    }
    trips_[i] = t;
    return 0;
}

int Device::enable_trips(std::int64_t mask) {
    for (std::size_t i = 0; i < trips_.size(); ++i) {
        if ((mask >> i & 1) != 0 && !trips_[i].defined) return err::trip_undefined;
    }
    if ((mask & 2) != 0 && (mask & 16) != 0) return err::two_trips;
    if ((mask & 8) != 0 && (te_ & 8) == 0) trip_time_ = now_ + std::chrono::milliseconds(trips_[3].ms);
    if ((mask & 8) == 0) trip_time_ = never;
    if ((mask & 16) != 0 && (te_ & 16) == 0) trips_[4].left = trips_[4].repeats;  // each series begins with TE [L5836]
    te_ = static_cast<int>(mask);
    motor_->enable_trips(te_, now_);
    return 0;
}

void Device::fire(Word word) {
    const std::size_t i = trip_index(word);
    const int bit = 1 << i;
    if (i >= trips_.size() || (te_ & bit) == 0) return;
    Trip& t = trips_[i];
    if (word != Word::TR || (t.repeats > 0 && --t.left <= 0)) {
        te_ &= ~bit;
        motor_->enable_trips(te_, now_);
    }
    int error = 0;
    const std::int32_t line = program_.find(t.target, error);
    if (line < 0) return;  // TR with label 0: the output alone
    if (const int code = run_.interrupt(static_cast<std::size_t>(line), Run::CallKind::trip); code != 0) {
        stop_program();
        er_ = code;
        ef_ = true;
        return;
    }
    if (slice_due_ == never || slice_due_ < now_) slice_due_ = now_;
}

void Device::stop_program() {
    run_.stop();
    paused_ = false;
    ending_ = false;
    input_pending_ = false;
    mode_ = Mode::normal;
    comm_.stepping(false);
    slice_due_ = never;
}

void Device::stop_everything() {
    stop_program();
    programming_ = false;
    announce_ = false;
    motor_->stop_at_once(now_);
}

int Device::enter_program_mode(std::span<const Number> fields) {
    if (data_ == nullptr) return err::running;  // PG in a stored program has nothing to leave
    if (!run_.idle()) return err::running;
    if (lk_) return err::locked;
    if (motor_->busy(true, now_)) return err::saving_in_motion;
    const std::int64_t address = fields.empty() ? 1 : fields[0].as_integer();
    if (address < 1 || address > Program::space) return err::bad_address;
    program_address_ = static_cast<std::int32_t>(address);
    programming_ = true;
    return 0;
}

int Device::list(const Statement& s) {
    if (lk_) return err::locked;
    std::size_t from = 0;
    if (s.target && s.target->given) {
        int error = 0;
        const std::int32_t line = program_.find(*s.target, error);
        if (line < 0) return error;
        from = static_cast<std::size_t>(line);
    }
    std::string text;
    for (std::size_t i = from; i < program_.lines().size(); ++i) {
        const auto& l = program_.lines()[i];
        text += (text.empty() ? "" : "\r\n") + std::to_string(l.address) + ' ' + l.text;
    }
    say(text);
    data_given_ = !text.empty();
    return 0;
}

int Device::clear_program(const Statement& s, std::span<const Number> fields) {
    if (!run_.idle()) return err::running;
    if (motor_->busy(true, now_)) return err::restoring_in_motion;
    const std::int64_t variables = fields.empty() ? 0 : fields[0].as_integer();
    if (variables != 0 && variables != 1) return err::bad_value;
    if (s.target && s.target->given) {
        if (lk_) return err::locked;
        int error = 0;
        const std::int32_t line = program_.find(*s.target, error);
        if (line < 0) return error;
        program_.clear_from(static_cast<std::size_t>(line));
        return 0;
    }
    program_.clear(variables == 1);
    lk_ = false;
    lk_saved_ = false;
    on_error_.reset();
    break_at_.reset();
    trips_ = {};
    te_ = 0;
    trip_time_ = never;
    motor_->enable_trips(0, now_);
    input_symbol_ = no_symbol;
    return 0;
}

}  // namespace axisgate::mcode::twin
