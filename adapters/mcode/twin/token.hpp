// Tokens: cuts one line of MCode into names, numbers, texts and signs.
// In: the characters of a line without its terminator. Out: tokens, or the place of what is none.
// Never knows a mnemonic: `MR` and `K1` are names alike. Comments are dropped.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "adapters/mcode/twin/value.hpp"

namespace axisgate::mcode::twin {

/// Text, blanks and comment of a line together; the 65th character is error 20 [L626, L4897].
inline constexpr std::size_t line_limit = 64;

struct Token {
    enum class Kind : unsigned char {
        end,
        name,    ///< letter, then letters, digits, `_`
        number,  ///< digits with point and exponent; a sign is a sign of its own
        text,    ///< between double quotes; `text` is what is inside
        sign,    ///< one of = + - * / & | ^ ! , ; <
        other    ///< no character of the language
    };
    /// Signs of two characters have a letter of their own in `sign`: n for <>, l for <= (and =<), g for >=.
    Kind kind = Kind::end;
    char sign = 0;
    std::string_view text;
    Number number;
};

/// The tokens of a line: at most one per character, and the end. Views into the line, which must outlive it.
class Tokens {
public:
    explicit Tokens(std::string_view line) noexcept;

    [[nodiscard]] const Token& peek(std::size_t ahead = 0) const noexcept {
        const std::size_t at = next_ + ahead;
        return tokens_[at < size_ ? at : size_];
    }
    Token take() noexcept {
        const Token& t = tokens_[next_];
        if (next_ < size_) ++next_;
        return t;
    }
    [[nodiscard]] bool at_end() const noexcept { return peek().kind == Token::Kind::end; }
    [[nodiscard]] bool is_sign(char sign) const noexcept { return peek().kind == Token::Kind::sign && peek().sign == sign; }
    bool take_sign(char sign) noexcept {
        if (!is_sign(sign)) return false;
        take();
        return true;
    }

private:
    std::array<Token, line_limit + 1> tokens_{};
    std::size_t size_ = 0;
    std::size_t next_ = 0;
};

}  // namespace axisgate::mcode::twin
