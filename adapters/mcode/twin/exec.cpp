// Device: typed lines, words and the instructions that are one step.
// In: statements with worked-out fields. Out: values, MCode error codes.
// Never moves anything itself: that is the motor's.
#include <algorithm>

#include "adapters/mcode/twin/device.hpp"
#include "adapters/mcode/twin/errors.hpp"
#include "gateway/core/text.hpp"

namespace axisgate::mcode::twin {
namespace {

/// `PG1` of the manual's listing [L7052]: no name may have this form, so the address is meant.
bool is_joined_pg(std::string_view s) noexcept {
    return s.size() > 2 && (s[0] == 'P' || s[0] == 'p') && (s[1] == 'G' || s[1] == 'g') && is_digit(s[2]);
}

/// PF: field width, decimals, scientific, left.
int take_print_format(std::span<const Number> fields, PrintFormat& format) {
    PrintFormat f = format;
    const std::array<std::int64_t, 4> top{16, 16, 1, 1};
    if (fields.size() > top.size()) return err::bad_value;
    for (std::size_t k = 0; k < fields.size(); ++k) {
        const std::int64_t n = fields[k].as_integer();
        if (n < 0 || n > top[k]) return err::bad_value;
        if (k == 0) f.width = static_cast<int>(n);
        if (k == 1) f.decimals = static_cast<int>(n);
        if (k == 2) f.scientific = n == 1;
        if (k == 3) f.left = n == 1;
    }
    format = f;
    return 0;
}

/// What a drive may be called.
bool is_party_name(std::string_view s) {
    return s.size() == 1 && (is_digit(s[0]) || (s[0] >= 'a' && s[0] <= 'z') || (s[0] >= 'A' && s[0] <= 'Z'));
}

}  // namespace

int DeviceSetup::available(Word word) const noexcept {
    if ((info(word).products & product) == 0 || (manners.before_6() && came_with_6(word))) return err::not_available;
    if (ethernet) {
        switch (word) {
            case Word::BD:
            case Word::CK:
            case Word::DG:
            case Word::DN:
            case Word::PY:
            case Word::QD:
                return err::not_available;
            default:
                break;
        }
    }
    return 0;
}

void Device::raise(int code) {
    if (code == 0) {
        error_ = {};
        return;
    }
    error_.set(code);
    // The handler runs for errors of typed lines too, but not while programming [L4547-4549], and not for its own errors.
    if (!on_error_ || program_mode_.on() || run_.handling_error()) return;
    int fault = 0;
    const std::int32_t line = program_.find(*on_error_, fault);
    if (line < 0) return;
    if (const int full = run_.interrupt(static_cast<std::size_t>(line), Run::CallKind::error_handler); full != 0) {
        stop_program();
        error_.set(full);
        return;
    }
    if (slice_due_ == never) slice_due_ = now_;
}

int Device::typed(std::string_view text) {
    text = trimmed(text);
    std::string apart;
    if (is_joined_pg(text)) text = apart = "PG " + std::string(text.substr(2));
    if (const int code = setup_.too_new(text); code != 0) return code;
    if (program_mode_.on()) return program_mode_.line(text);
    if (awaited_.takes(text)) return awaited_.take(text);
    const Statement s = program_.compile_typed(text);
    if (s.kind == Statement::Kind::faulty) {
        // What this drive does not have it does not judge the value of: DN=a over Ethernet is 37, not 21.
        const Tokens tokens(text);
        const auto word = tokens.peek().kind == Token::Kind::name ? word_named(tokens.peek().text) : std::nullopt;
        const int missing = word ? setup_.available(*word) : 0;
        return missing != 0 ? missing : s.error;
    }
    if (s.kind == Statement::Kind::assign || s.kind == Statement::Kind::execute) {
        if (const int code = setup_.available(s.word); code != 0) return code;
        if (!info(s.word).immediate) return err::not_program;
    }
    return run_.execute(s, now_);
}

Number Device::read(Word word, int& error) {
    if (const int code = setup_.available(word); code != 0) {
        error = code;
        return {};
    }
    if (info(word).owner == Owner::motor) return motor_->read(word, now_, error);
    switch (word) {
        case Word::BD:
            return Number::of(bd_);
        case Word::BY:
            return Number::of(run_.idle() ? 0 : 1);
        case Word::CE:
            return Number::of(comm_.flags.ce);
        case Word::CK:
            return Number::of(comm_.flags.ck);
        case Word::DG:
            return Number::of(comm_.flags.dg ? 1 : 0);
        case Word::EF:
            return Number::of(error_.flag ? 1 : 0);
        case Word::EM:
            return Number::of(comm_.flags.em);
        case Word::ER:
            return Number::of(error_.code);
        case Word::ES:
            return Number::of(comm_.flags.es);
        case Word::IF:
            return Number::of(awaited_.pending() ? 1 : 0);
        case Word::LK:
            return Number::of(lk_ ? 1 : 0);
        case Word::NE:
            return Number::of(ne_ ? 1 : 0);
        case Word::PY:
            return Number::of(comm_.flags.py ? 1 : 0);
        case Word::QD:
            return Number::of(comm_.flags.qd ? 1 : 0);
        case Word::RA:
            return Number::of(radians_ ? 1 : 0);
        case Word::TE:
            return Number::of(trips_.enabled());
        case Word::R1:
        case Word::R2:
        case Word::R3:
        case Word::R4:
            return Number::of(run_.integer(static_cast<std::size_t>(word) - static_cast<std::size_t>(Word::R1)));
        default:
            break;
    }
    if (word >= Word::F1 && word <= Word::F8)
        return Number::of_real(run_.real(static_cast<std::size_t>(word) - static_cast<std::size_t>(Word::F1)));
    error = err::bad_print;
    return {};
}

int Device::write(Word word, std::span<const Number> fields) {
    if (const int code = setup_.available(word); code != 0) return code;
    const WordInfo& i = info(word);
    if (i.access == Access::ro) return err::read_only;
    if (i.access == Access::none) return err::unknown_set;
    if (fields.size() != 1 && i.kind != WordKind::setup) return err::bad_value;
    if (i.ranged) {
        const auto v = static_cast<double>(fields[0].as_integer());  // the fraction is dropped first [L2813]
        if (!(v >= i.min && v <= i.max)) return err::bad_value;
    }
    if (i.owner == Owner::motor) return motor_->write(word, fields, now_);
    const std::int64_t v = fields[0].as_integer();
    switch (word) {
        case Word::BD:
            if (rate_of_code(static_cast<int>(std::clamp<std::int64_t>(v, 0, 1000))) == 0) return err::bad_baud;
            bd_ = static_cast<int>(v);
            return 0;
        case Word::CE:
            comm_.flags.ce = static_cast<int>(v);
            return 0;
        case Word::CK:
            comm_.flags.ck = static_cast<int>(v);
            return 0;
        case Word::DG:
            comm_.flags.dg = v != 0;
            return 0;
        case Word::EM:
            comm_.flags.em = static_cast<int>(v);
            return 0;
        case Word::ER:
            if (v != 0) return err::bad_value;
            error_ = {};
            return 0;
        case Word::ES:
            comm_.flags.es = static_cast<int>(v);
            return 0;
        case Word::IF:
            awaited_.drop();
            return 0;
        case Word::LK:
            // A saved lock goes only with the programs: full CP or FD [L3907].
            if (v == 0 && lk_saved_) return err::locked;
            lk_ = v != 0;
            return 0;
        case Word::NE:
            ne_ = v != 0;
            return 0;
        case Word::PF:
            return take_print_format(fields, format_);
        case Word::PW:
            if (fields.size() > pw_.size()) return err::bad_value;
            for (std::size_t k = 0; k < fields.size(); ++k)
                pw_[k] = fields[k].as_integer();
            return 0;
        case Word::PY:
            if (v != 0 && !comm_.flags.py) comm_.disarm();
            comm_.flags.py = v != 0 || address_input_;
            return 0;
        case Word::QD:
            comm_.flags.qd = v != 0;
            return 0;
        case Word::RA:
            radians_ = v != 0;
            return 0;
        case Word::TE:
            return trips_.enable(v, now_);
        default:
            return err::read_only;
    }
}

const Device::Instruction Device::instructions[] = {
    {Word::PR, [](Device& d, const Statement& s, Fields) { return d.print(s); }},
    {Word::VA, [](Device& d, const Statement& s, Fields fields) { return d.declare(s, fields); }},
    {Word::EX, [](Device& d, const Statement& s, Fields fields) { return d.execute_label(s, fields); }},
    {Word::E,
     // In a program its end; typed: the program ends when the motion is over [L2523-2531].
     [](Device& d, const Statement&, Fields) -> int {
         if (d.run_.idle()) return err::not_running;
         if (d.data_ == nullptr) {
             d.stop_program();
         } else {
             d.ending_ = true;
         }
         return 0;
     }},
    {Word::PS,
     [](Device& d, const Statement&, Fields) -> int {
         if (d.run_.idle() || d.paused_) return err::not_running;
         d.paused_ = true;
         d.motor_->pause(d.now_);
         return 0;
     }},
    {Word::RS,
     [](Device& d, const Statement&, Fields) -> int {
         if (d.run_.idle() || !d.paused_) return err::not_running;
         d.paused_ = false;
         d.motor_->resume(d.now_);
         d.slice_due_ = d.now_;
         return 0;
     }},
    {Word::OE,
     [](Device& d, const Statement& s, Fields fields) -> int {
         const bool none = fields.empty() && s.target && s.target->given && s.target->label == no_symbol && !s.target->missing_name &&
                           s.target->address == 0;
         int error = 0;
         if (!none && (!s.target || d.program_.find(*s.target, error) < 0)) return err::unknown_name;
         d.on_error_ = none ? std::nullopt : s.target;
         return 0;
     }},
    {Word::IV, [](Device& d, const Statement& s, Fields) { return d.awaited_.ask(s); }},
    {Word::BP,
     [](Device& d, const Statement& s, Fields fields) -> int {
         if (s.target && s.target->given) return d.tracer_.set_break(*s.target, fields);
         if (d.run_.idle()) return err::not_running;
         d.tracer_.run_as(Tracer::Mode::step);
         return 0;
     }},
    {Word::PG, [](Device& d, const Statement&, Fields fields) { return d.enter_program_mode(fields); }},
    {Word::L, [](Device& d, const Statement& s, Fields) { return d.list(s); }},
    {Word::CP, [](Device& d, const Statement& s, Fields fields) { return d.clear_program(s, fields); }},
    {Word::S,
     [](Device& d, const Statement&, Fields) -> int {
         if (d.motor_->busy(false, d.now_)) return err::saving_in_motion;
         d.lk_saved_ = d.lk_;
         d.keep();
         d.pace_.memory_works(d.now_);
         return 0;
     }},
    {Word::IP,
     [](Device& d, const Statement&, Fields) -> int {
         if (d.motor_->busy(true, d.now_)) return err::restoring_in_motion;
         d.restore(d.nvm_, false);
         d.pace_.memory_works(d.now_);
         return 0;
     }},
    {Word::FD,
     [](Device& d, const Statement&, Fields) -> int {
         if (d.motor_->busy(true, d.now_)) return err::saving_in_motion;
         d.stop_program();
         d.factory_state(false);
         d.keep();
         d.pace_.memory_works(d.now_);
         return 0;
     }},
    {Word::UG,
     [](Device& d, const Statement&, Fields fields) -> int {
         const std::int64_t code = fields.empty() ? 0 : fields[0].as_integer();
         if (code != 2656102 && code != 2956102) return err::bad_value;
         d.stop_everything();
         d.upgrading_ = true;  // at 19200 and deaf for MCode until power comes back
         return 0;
     }},
};

int Device::perform(const Statement& s, std::span<const Number> fields) {
    if (s.kind == Statement::Kind::bare_number) {
        if (!ne_) return 60;
        const auto last = motor_->text(Word::MD, now_);
        const auto word = last ? word_named(*last) : std::nullopt;
        if (!word || (*word != Word::MA && *word != Word::MR && *word != Word::SL)) return 60;
        const int code = motor_->start(*word, fields, now_);
        if (code == 0) announce_ = false;
        return code;
    }
    if (const int code = setup_.available(s.word); code != 0) return code;
    if (s.kind == Statement::Kind::assign) {
        if (s.word != Word::DN) return err::unknown_set;
        if (!is_party_name(s.name)) return err::bad_value;
        comm_.flags.dn = s.name[0];
        return 0;
    }
    if (info(s.word).kind == WordKind::trip) return trips_.define(s, fields, now_);
    if (info(s.word).owner == Owner::motor) {
        const int code = motor_->start(s.word, fields, now_);
        // What was announced for an earlier motion is not said at the end of another one.
        if (code == 0 && s.word != Word::CF)
            announce_ = (s.word == Word::MA || s.word == Word::MR) && fields.size() >= 2 && fields[1].truth();
        return code;
    }
    const auto* instruction = std::ranges::find(instructions, s.word, &Instruction::word);
    return instruction == std::end(instructions) ? err::not_program : instruction->carry_out(*this, s, fields);
}

}  // namespace axisgate::mcode::twin
