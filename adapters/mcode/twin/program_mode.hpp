// ProgramMode: the state between PG and PG, in which typed lines are stored.
// In: PG's address, lines. Out: MCode error codes; a longer program.
// Never runs a line.
#pragma once

#include "adapters/mcode/twin/errors.hpp"
#include "adapters/mcode/twin/program.hpp"
#include "adapters/mcode/twin/token.hpp"

namespace axisgate::mcode::twin {

class ProgramMode {
public:
    /// `module`: PW is a word of an LMM, and a free name elsewhere [L4970].
    ProgramMode(Program& program, bool module) : program_(program), module_(module) {}

    [[nodiscard]] bool on() const noexcept { return on_; }
    void leave() noexcept { on_ = false; }
    [[nodiscard]] int enter(std::span<const Number> fields) {
        const std::int64_t address = fields.empty() ? 1 : fields[0].as_integer();
        if (address < 1 || address > Program::space) return err::bad_address;
        address_ = static_cast<std::int32_t>(address);
        on_ = true;
        return 0;
    }
    [[nodiscard]] int line(std::string_view text) {
        const Tokens tokens(text);
        const auto named = [&](std::size_t i) {
            return tokens.peek(i).kind == Token::Kind::name ? word_named(tokens.peek(i).text) : std::nullopt;
        };
        if (named(0) == Word::PG) {
            leave();
            return 0;
        }
        if (module_ && named(1) == Word::PW) {
            const auto first = word_named(tokens.peek().text);
            if (first == Word::VA) return err::illegal_data;
            if (first == Word::LB) return err::redefine_word;
        }
        return program_.enter(text, address_);
    }

private:
    Program& program_;
    bool module_;
    bool on_ = false;
    std::int32_t address_ = 1;
};

}  // namespace axisgate::mcode::twin
