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

int Device::run_program(const Target& target, Tracer::Mode mode) {
    int error = 0;
    const std::int32_t line = program_.find(target, error);
    if (line < 0) return error;
    error_ = {};
    program_.reset_locals();
    run_.start(static_cast<std::size_t>(line));
    tracer_.run_as(mode);
    tracer_.step(false);
    paused_ = false;
    ending_ = false;
    awaited_.drop();
    slice_due_ = now_;
    return 0;
}

int Device::execute_label(const Statement& s, std::span<const Number> fields) {
    if (!run_.idle()) return err::running;
    const std::int64_t mode = fields.empty() ? 0 : fields[0].as_integer();
    if (mode < 0 || mode > 2) return err::bad_value;
    if (!s.target) return err::unknown_name;
    return run_program(*s.target, static_cast<Tracer::Mode>(mode));
}

void Device::fire(Word word) {
    const Target* target = trips_.met(word, now_);
    if (target == nullptr) return;
    int error = 0;
    const std::int32_t line = program_.find(*target, error);
    if (line < 0) return;  // TR with label 0: the output alone
    if (const int code = run_.interrupt(static_cast<std::size_t>(line), Run::CallKind::trip); code != 0) {
        stop_program();
        error_.set(code);
        return;
    }
    if (slice_due_ == never || slice_due_ < now_) slice_due_ = now_;
}

void Device::stop_program() {
    run_.stop();
    paused_ = false;
    ending_ = false;
    awaited_.drop();
    tracer_.run_as(Tracer::Mode::normal);
    slice_due_ = never;
}

void Device::stop_everything() {
    stop_program();
    program_mode_.leave();
    announce_ = false;
    motor_->stop_at_once(now_);
}

int Device::enter_program_mode(std::span<const Number> fields) {
    if (data_ == nullptr) return err::running;  // PG in a stored program has nothing to leave
    if (!run_.idle()) return err::running;
    if (lk_) return err::locked;
    if (motor_->busy(true, now_)) return err::saving_in_motion;
    return program_mode_.enter(fields);
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
    tracer_.clear_break();
    trips_.clear();
    motor_->enable_trips(0, now_);
    awaited_.forget();
    return 0;
}

}  // namespace axisgate::mcode::twin
