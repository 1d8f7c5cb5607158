// Awaited: the value that IV asks for, until a typed line brings it.
// In: IV, typed lines. Out: a register, variable or word that has it.
// Never waits for two.
#pragma once

#include "adapters/mcode/twin/errors.hpp"
#include "adapters/mcode/twin/run.hpp"
#include "gateway/core/text.hpp"

namespace axisgate::mcode::twin {

class Awaited {
public:
    Awaited(const Program& program, Run& run) : program_(program), run_(run) {}

    /// IF.
    [[nodiscard]] bool pending() const noexcept { return pending_; }
    void drop() noexcept { pending_ = false; }
    /// The variable that was asked for is gone.
    void forget() noexcept { symbol_ = no_symbol; }

    [[nodiscard]] int ask(const Statement& s) {
        if (pending_) return err::already_pending;
        if (s.symbol != no_symbol) {
            const auto kind = program_.symbols().at(s.symbol).kind;
            if (kind != Symbol::Kind::global && kind != Symbol::Kind::local) return err::unknown_name;
        } else {
            const Operand& o = s.fields[0].terms[0].operand;
            if (info(o.word).access != Access::rw) return err::read_only;
            word_ = o.word;
        }
        symbol_ = s.symbol;
        pending_ = true;
        return 0;
    }
    /// Whether a typed line is the value.
    [[nodiscard]] bool takes(std::string_view text) const noexcept {
        return pending_ && (text.empty() || is_digit(text[0]) || text[0] == '-' || text[0] == '+' || text[0] == '.');
    }
    [[nodiscard]] int take(std::string_view text) {
        pending_ = false;
        if (text.empty()) return 0;
        Symbols none;
        const Statement s = compile(text, none, false);
        if (s.kind != Statement::Kind::bare_number) return err::bad_value;
        int error = 0;
        const Number n = run_.value(s.fields[0], word_ >= Word::F1 && word_ <= Word::F8, error);
        if (error != 0) return error;
        return symbol_ != no_symbol ? run_.store(symbol_, n) : run_.store(word_, n);
    }

private:
    const Program& program_;
    Run& run_;
    bool pending_ = false;
    Word word_{};
    SymbolId symbol_ = no_symbol;
};

}  // namespace axisgate::mcode::twin
