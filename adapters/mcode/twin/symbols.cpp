// Symbols: a table by name; what is only mentioned is kept too, until it is defined.
// In: names. Out: numbers.
// Never moves a symbol: a number stays good until clear().
#include "adapters/mcode/twin/symbols.hpp"

#include <algorithm>

#include "gateway/core/text.hpp"

namespace axisgate::mcode::twin {
namespace {

bool same_name(std::string_view a, std::string_view b) noexcept {
    return std::ranges::equal(a, b, [](char x, char y) { return upper(x) == upper(y); });
}

}  // namespace

SymbolId Symbols::find(std::string_view name) const noexcept {
    for (std::size_t i = 0; i < symbols_.size(); ++i) {
        if (same_name(symbols_[i].name, name)) return static_cast<SymbolId>(i);
    }
    return no_symbol;
}

SymbolId Symbols::mention(std::string_view name) {
    if (const SymbolId id = find(name); id != no_symbol) return id;
    if (symbols_.size() >= mention_limit) return no_symbol;
    Symbol s;
    s.name = std::string(name);
    symbols_.push_back(std::move(s));
    return static_cast<SymbolId>(symbols_.size() - 1);
}

std::size_t Symbols::defined() const noexcept {
    return static_cast<std::size_t>(std::ranges::count_if(symbols_, [](const Symbol& s) { return s.kind != Symbol::Kind::unknown; }));
}

int Symbols::define(SymbolId id, Symbol::Kind kind) {
    Symbol& s = symbols_[id];
    if (s.kind == Symbol::Kind::local && kind == Symbol::Kind::local) return 0;
    if (s.kind != Symbol::Kind::unknown) return 28;
    if (defined() >= defined_limit) return 31;
    s.kind = kind;
    s.value = 0;
    s.address = 0;
    return 0;
}

void Symbols::forget(Symbol::Kind kind) noexcept {
    for (Symbol& s : symbols_) {
        if (s.kind == kind) s.kind = Symbol::Kind::unknown;
    }
}

bool Symbols::well_formed(std::string_view name, std::size_t longest) noexcept {
    return !name.empty() && name.size() <= longest && is_letter(name[0]) &&
           std::ranges::all_of(name, [](char c) { return is_letter(c) || is_digit(c); });
}

}  // namespace axisgate::mcode::twin
