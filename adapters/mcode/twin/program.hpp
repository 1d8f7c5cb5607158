// Program: the stored lines of MCode by address, with their labels.
// In: lines with their address. Out: compiled lines in order, listings, the text that is kept in the non-volatile memory.
// Never executes, and never holds more than `space` bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/mcode/twin/statement.hpp"
#include "adapters/mcode/twin/symbols.hpp"

namespace axisgate::mcode::twin {

class Program {
public:
    /// Bytes of program memory; the manual gives no size. An address is the running byte count, one terminator per line [E-37].
    static constexpr std::int32_t space = 16384;

    struct Line {
        std::int32_t address = 1;
        std::string text;
        Statement statement;
    };

    [[nodiscard]] const std::vector<Line>& lines() const noexcept { return lines_; }
    [[nodiscard]] bool empty() const noexcept { return lines_.empty(); }
    [[nodiscard]] Symbols& symbols() noexcept { return symbols_; }
    [[nodiscard]] const Symbols& symbols() const noexcept { return symbols_; }
    /// Typed lines are compiled against the names of the program without adding to them.
    [[nodiscard]] Statement compile_typed(std::string_view line) { return compile(line, symbols_, false); }

    /// Stores a line at `address`, over what was there, and moves `address` behind it. Blank and comment lines take no space.
    /// MCode error: what `compile` gives, 28 or 31 of labels and variables, 42 bad address, 45 no space. A faulty line is not stored.
    [[nodiscard]] int enter(std::string_view line, std::int32_t& address);

    /// Index of the line to which a target leads, or -1: error 30 for a label, 42 for an address, in `error`.
    [[nodiscard]] std::int32_t find(const Target& target, int& error) const noexcept;

    /// Everything; global variables stay unless `variables`.
    void clear(bool variables);
    /// From that line up to its E, or to the end.
    void clear_from(std::size_t index);

    /// Address and text, one per line, each ended by LF.
    [[nodiscard]] std::string text() const;
    /// What `text` gave; lines that are none are dropped. Old lines are gone.
    void load(std::string_view text);
    /// Values of local variables back to 0, as at the start of a program.
    void reset_locals() noexcept;

private:
    void remove(std::size_t first, std::size_t last);
    void index();

    std::vector<Line> lines_;
    Symbols symbols_;
};

}  // namespace axisgate::mcode::twin
