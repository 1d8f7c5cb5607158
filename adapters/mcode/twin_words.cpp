// Words: lookup of a mnemonic; see the header.
// In: letters. Out: the word, or nothing.
// Never allocates.
#include "adapters/mcode/twin_words.hpp"

#include <algorithm>

namespace axisgate::mcode::twin {
namespace {

constexpr char upper(char c) noexcept { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

}  // namespace

std::optional<Word> word_named(std::string_view letters) noexcept {
    if (letters.empty() || letters.size() > 3) return std::nullopt;
    std::array<char, 3> buffer{};
    for (std::size_t i = 0; i < letters.size(); ++i)
        buffer[i] = upper(letters[i]);
    const std::string_view wanted(buffer.data(), letters.size());
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i].text == wanted) return static_cast<Word>(i);
    }
    return std::nullopt;
}

bool countable(Word w) noexcept {
    const WordInfo& i = info(w);
    if (i.access != Access::rw || i.kind != WordKind::variable) return false;
    switch (w) {
        case Word::AS:
        case Word::AT:
        case Word::BD:
        case Word::BM:
        case Word::CB:
        case Word::CK:
        case Word::DN:
        case Word::DT:
        case Word::EL:
        case Word::ER:
        case Word::LM:
        case Word::MS:
        case Word::MU:
        case Word::RA:
        case Word::RD:
        case Word::SA:
        case Word::SM:
        case Word::TD:
        case Word::TE:
            return false;
        default:
            return true;
    }
}

}  // namespace axisgate::mcode::twin
