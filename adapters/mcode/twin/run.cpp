// Run: one statement after the other, each by what its word does to registers, the stack, the trips and the hold.
// In: statements. Out: their effects.
// Never recurses: a subroutine is a place on the stack of the program.
#include "adapters/mcode/twin/run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {
namespace {
bool fits_int32(std::int64_t v) noexcept {
    return v >= std::numeric_limits<std::int32_t>::min() && v <= std::numeric_limits<std::int32_t>::max();
}

/// R1 to R4 are symmetric, other than user variables [L5076].
bool fits_register(std::int64_t v) noexcept { return fits_int32(v) && v != std::numeric_limits<std::int32_t>::min(); }

Number function(Word f, const Number& n, bool radians, bool base_two, int& error) {
    const double x = n.as_double();
    const double to_radians = radians ? 1.0 : 3.141592653589793 / 180.0;
    double r = 0;
    switch (f) {
        case Word::AB:
            r = std::abs(x);
            break;
        case Word::CS:
            r = std::cos(x * to_radians);
            break;
        case Word::SI:
            r = std::sin(x * to_radians);
            break;
        case Word::TG:
            r = std::tan(x * to_radians);
            break;
        case Word::C_:
            r = std::acos(x) / to_radians;
            break;
        case Word::S_:
            r = std::asin(x) / to_radians;
            break;
        case Word::T_:
            r = std::atan(x) / to_radians;
            break;
        case Word::SQ:
            r = std::sqrt(x);
            break;
        case Word::LO:
            r = base_two ? std::log2(x) : std::log(x);  // the only printed figure is the natural logarithm [E-15]
            break;
        default:
            r = std::log10(x);
            break;
    }
    if (!std::isfinite(r)) error = err::bad_value;
    return Number::of_real(r);
}

Number negative(const Number& n) noexcept { return n.real ? Number::of_real(-n.d) : Number::of(-n.i); }

bool compare(Comparison c, const Number& a, const Number& b) noexcept {
    // Integers have 64 bits between operators, more than a double holds: two of them are compared as they are.
    const bool whole = !a.real && !b.real;
    const double x = whole ? static_cast<double>((a.i > b.i) - (a.i < b.i)) : a.as_double();
    const double y = whole ? 0.0 : b.as_double();
    switch (c) {
        case Comparison::equal:
            return x == y;
        case Comparison::different:
            return x != y;
        case Comparison::less:
            return x < y;
        case Comparison::less_equal:
            return x <= y;
        case Comparison::greater:
            return x > y;
        case Comparison::greater_equal:
            return x >= y;
        default:
            return a.truth();
    }
}

}  // namespace

Number Run::operand(const Operand& o, int& error) {
    switch (o.kind) {
        case Operand::Kind::constant:
            return o.number;
        case Operand::Kind::integer_register:
            return Number::of(integers_[o.index]);
        case Operand::Kind::float_register:
            return Number::of_real(reals_[o.index]);
        case Operand::Kind::symbol: {
            const Symbol& s = program_.symbols().at(o.symbol);
            if (s.kind != Symbol::Kind::global && s.kind != Symbol::Kind::local) error = err::unknown_name;
            return Number::of(s.value);
        }
        case Operand::Kind::word:
            break;
    }
    return host_.read(o.word, error);
}

Number Run::value(const Expression& e, bool real, int& error) {
    Number result;
    for (std::size_t i = 0; i < e.terms.size(); ++i) {
        const Term& t = e.terms[i];
        Number n = operand(t.operand, error);
        if (t.operand_minus) n = negative(n);
        if (t.function) {
            int unreadable = 0;
            const bool radians = host_.read(Word::RA, unreadable).truth();
            n = function(*t.function, n, radians, base_two_, error);
        }
        for (auto sign = t.prefix.rbegin(); sign != t.prefix.rend(); ++sign)
            n = *sign == '-' ? negative(n) : Number::of(static_cast<std::int32_t>(~static_cast<std::uint32_t>(n.as_integer())));
        if (error != 0) return n;
        if (i == 0) {
            result = n;
            continue;
        }
        const auto r = apply(t.op, result, n, real);
        if (!r || !std::isfinite(r->as_double())) {
            error = err::bad_value;  // division by zero, beyond the largest double: the manual is silent
            return result;
        }
        result = *r;
    }
    return result;
}

bool Run::holds(const Condition& c, int& error) {
    const Number left = value(c.left, false, error);
    if (c.comparison == Comparison::truth || error != 0) return left.truth();
    return compare(c.comparison, left, value(c.right, false, error));
}

int Run::store(Word word, const Number& n) {
    if (word >= Word::R1 && word <= Word::R4) {
        const std::int64_t v = n.as_integer();
        if (!fits_register(v)) return err::bad_value;
        integers_[static_cast<std::size_t>(word) - static_cast<std::size_t>(Word::R1)] = static_cast<std::int32_t>(v);
        return 0;
    }
    if (word >= Word::F1 && word <= Word::F8) {
        const double v = n.as_double();
        if (!std::isfinite(v)) return err::bad_value;
        reals_[static_cast<std::size_t>(word) - static_cast<std::size_t>(Word::F1)] = v;
        return 0;
    }
    return host_.write(word, {&n, 1});
}

int Run::store(SymbolId symbol, const Number& n) {
    if (symbol == no_symbol) return err::unknown_name;
    Symbol& s = program_.symbols().at(symbol);
    if (s.kind == Symbol::Kind::label) return err::set_label;
    if (s.kind == Symbol::Kind::unknown) return 20;
    const std::int64_t v = n.as_integer();
    if (!fits_int32(v)) return err::bad_value;
    s.value = static_cast<std::int32_t>(v);
    return 0;
}

int Run::count(const Statement& s, int by) {
    if (s.symbol != no_symbol) {
        Symbol& v = program_.symbols().at(s.symbol);
        if (v.kind != Symbol::Kind::global && v.kind != Symbol::Kind::local) return err::read_only;  // unspecified counts as that [L2336]
        return store(s.symbol, Number::of(std::int64_t{v.value} + by));
    }
    const Operand& o = s.fields[0].terms[0].operand;
    if (o.kind == Operand::Kind::integer_register) {
        std::int32_t& r = integers_[o.index];
        if (!fits_register(std::int64_t{r} + by)) return err::bad_value;
        r += by;
        return 0;
    }
    if (o.kind == Operand::Kind::float_register) {
        reals_[o.index] += by;
        return 0;
    }
    if (o.kind != Operand::Kind::word || info(o.word).access == Access::ro || info(o.word).access == Access::none) return err::read_only;
    if (!countable(o.word)) return err::not_countable;
    int error = 0;
    const Number n = host_.read(o.word, error);
    if (error != 0) return error;
    return host_.write(o.word, std::array{n.real ? Number::of_real(n.d + by) : Number::of(n.i + by)});
}

int Run::jump(const Statement& s, bool call) {
    int error = 0;
    if (s.condition && !holds(*s.condition, error)) return error;
    if (error != 0) return error;
    const std::int32_t to = program_.find(*s.target, error);
    if (to < 0) return error;
    if (call) {
        if (stack_.size() >= stack_limit) return err::stack_full;
        stack_.push_back({static_cast<std::uint32_t>(next_), State::running, CallKind::call, {}, false});
    }
    next_ = static_cast<std::size_t>(to);
    return 0;
}

int Run::execute(const Statement& s, Instant now) {
    int error = 0;
    switch (s.kind) {
        case Statement::Kind::empty:
            return 0;
        case Statement::Kind::faulty:
            return s.error;
        case Statement::Kind::assign_name: {
            const Number n = value(s.fields[0], false, error);
            return error != 0 ? error : store(s.symbol, n);
        }
        case Statement::Kind::assign:
            if (s.fields.size() == 1) {
                const Number n = value(s.fields[0], s.word >= Word::F1 && s.word <= Word::F8, error);
                return error != 0 ? error : store(s.word, n);
            }
            break;
        case Statement::Kind::execute:
            switch (s.word) {
                case Word::BR:
                    return jump(s, false);
                case Word::CL:
                    return jump(s, true);
                case Word::LB:
                    return 0;
                case Word::IC:
                    return count(s, 1);
                case Word::DC:
                    return count(s, -1);
                case Word::RT: {
                    if (stack_.empty()) return err::stack_full;
                    const Frame f = stack_.back();
                    stack_.pop_back();
                    if (f.ends) {
                        stop();
                        return 0;
                    }
                    next_ = f.next;
                    state_ = f.state;
                    until_ = f.until;
                    return 0;
                }
                case Word::H: {
                    if (s.fields.empty()) {
                        if (host_.moving()) state_ = State::hold_motion;
                        return 0;
                    }
                    const std::int64_t ms = value(s.fields[0], false, error).as_integer();
                    if (error != 0) return error;
                    if (ms < 1 || ms > 65000) return err::bad_value;
                    state_ = State::hold_time;
                    until_ = now + std::chrono::milliseconds(ms);
                    return 0;
                }
                default:
                    break;
            }
            break;
        case Statement::Kind::bare_number:
            break;
    }
    std::array<Number, field_limit> fields{};
    std::size_t n = 0;
    // IV names a place, not a value.
    if (!(s.kind == Statement::Kind::execute && s.word == Word::IV)) {
        for (const Expression& e : s.fields) {
            if (n == fields.size()) return err::bad_value;
            fields[n++] = value(e, false, error);
            if (error != 0) return error;
        }
    }
    const std::span<const Number> given(fields.data(), n);
    return s.kind == Statement::Kind::assign && !given.empty() ? host_.write(s.word, given) : host_.perform(s, given);
}

void Run::start(std::size_t line) {
    stack_.clear();
    next_ = line;
    state_ = State::running;
}

void Run::stop() noexcept {
    stack_.clear();
    state_ = State::idle;
}

bool Run::awake(Instant now) {
    if (state_ == State::hold_time && now >= until_) state_ = State::running;
    if (state_ == State::hold_motion && !host_.moving()) state_ = State::running;
    return state_ == State::running;
}

int Run::step(Instant now) {
    if (next_ >= program_.lines().size()) {
        stop();
        return 0;
    }
    return execute(program_.lines()[next_++].statement, now);
}

int Run::interrupt(std::size_t line, CallKind kind) {
    if (stack_.size() >= stack_limit) return err::stack_full;
    const bool ends = state_ == State::idle;
    stack_.push_back({static_cast<std::uint32_t>(next_), state_, kind, until_, ends});
    next_ = line;
    state_ = State::running;
    return 0;
}

bool Run::handling_error() const noexcept {
    return std::ranges::any_of(stack_, [](const Frame& f) { return f.kind == CallKind::error_handler; });
}

}  // namespace axisgate::mcode::twin
