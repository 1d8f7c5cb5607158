// Symbols: the names of users: labels and variables, 192 together.
// In: names, definitions. Out: small numbers by which statements refer to them; values and addresses.
// Never more than 192 defined names [L599]; names that statements merely mention are bounded by `mention_limit`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::mcode::twin {

using SymbolId = std::uint16_t;
inline constexpr SymbolId no_symbol = 0xFFFF;

struct Symbol {
    enum class Kind : std::uint8_t { unknown, label, global, local };
    std::string name;  ///< as it was written first; compared without case [L3767]
    Kind kind = Kind::unknown;
    std::int32_t value = 0;    ///< of a variable
    std::int32_t address = 0;  ///< of a label
    std::uint32_t line = 0;    ///< place of that line in the program, kept by the program
};

class Symbols {
public:
    static constexpr std::size_t defined_limit = 192;
    static constexpr std::size_t mention_limit = 1024;

    [[nodiscard]] SymbolId find(std::string_view name) const noexcept;
    /// Its number, also if nobody has defined it yet; no_symbol when `mention_limit` names are there.
    [[nodiscard]] SymbolId mention(std::string_view name);
    [[nodiscard]] const Symbol& at(SymbolId id) const noexcept { return symbols_[id]; }
    [[nodiscard]] Symbol& at(SymbolId id) noexcept { return symbols_[id]; }
    [[nodiscard]] std::size_t size() const noexcept { return symbols_.size(); }
    [[nodiscard]] std::size_t defined() const noexcept;

    /// MCode error: 28 exists already, 31 full; 0 good. A local variable may be declared again [E-71].
    [[nodiscard]] int define(SymbolId id, Symbol::Kind kind);
    void forget(Symbol::Kind kind) noexcept;
    void clear() noexcept { symbols_.clear(); }
    /// A letter, then up to `longest` - 1 letters or digits.
    [[nodiscard]] static bool well_formed(std::string_view name, std::size_t longest) noexcept;

private:
    std::vector<Symbol> symbols_;
};

}  // namespace axisgate::mcode::twin
