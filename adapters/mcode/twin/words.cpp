// Words: lookup of a mnemonic by its letters, upper and lower case alike.
// In: letters. Out: the word, or nothing.
// Never allocates.
#include "adapters/mcode/twin/words.hpp"

#include <algorithm>

#include "gateway/core/text.hpp"

namespace axisgate::mcode::twin {
namespace {

// At most three letters, upper case, packed into one number: a statement is looked up with a few comparisons of numbers.
constexpr std::uint32_t key_of(std::string_view letters) noexcept {
    std::uint32_t key = 0;
    for (const char c : letters)
        key = key << 8 | static_cast<std::uint8_t>(upper(c));
    return key;
}

struct Entry {
    std::uint32_t key;
    Word word;
};

constexpr auto by_key = [] {
    std::array<Entry, words.size()> out{};
    for (std::size_t i = 0; i < words.size(); ++i)
        out[i] = {key_of(words[i].text), static_cast<Word>(i)};
    std::ranges::sort(out, {}, &Entry::key);
    return out;
}();

static_assert(std::ranges::all_of(words, [](const WordInfo& w) { return !w.text.empty() && w.text.size() <= 3; }));

}  // namespace

std::optional<Word> word_named(std::string_view letters) noexcept {
    if (letters.empty() || letters.size() > 3) return std::nullopt;
    const auto at = std::ranges::lower_bound(by_key, key_of(letters), {}, &Entry::key);
    if (at == by_key.end() || at->key != key_of(letters)) return std::nullopt;
    return at->word;
}

bool came_with_6(Word w) noexcept {
    switch (w) {
        case Word::AJ:
        case Word::AT:
        case Word::AV:
        case Word::BE:
        case Word::BL:
        case Word::BM:
        case Word::DJ:
        case Word::DT:
        case Word::FL:
        case Word::FS:
        case Word::HF:
        case Word::HI:
        case Word::LS:
        case Word::PF:
        case Word::RA:
            return true;
        default:
            return info(w).kind == WordKind::math || (w >= Word::F1 && w <= Word::F8);
    }
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
