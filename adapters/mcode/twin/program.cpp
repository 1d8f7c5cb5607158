// Program: a new line takes the place of what lies under its bytes; labels and local variables come and go with their lines.
// In: lines. Out: the same, in order.
// Never leaves a label that points at a line which is gone.
#include "adapters/mcode/twin/program.hpp"

#include <algorithm>
#include <charconv>

namespace axisgate::mcode::twin {
namespace {

bool declares(const Statement& s) noexcept {
    return s.kind == Statement::Kind::execute && (s.word == Word::LB || s.word == Word::VA) && s.symbol != no_symbol;
}

}  // namespace

int Program::enter(std::string_view line, std::int32_t& address) {
    line = trimmed(line);
    Statement s = compile(line, symbols_, true);
    if (s.kind == Statement::Kind::empty) return 0;
    if (s.kind == Statement::Kind::faulty) return s.error;
    const WordInfo& i = info(s.word);
    if (s.kind == Statement::Kind::execute && i.kind == WordKind::instruction && !i.program) return 60;
    const auto size = static_cast<std::int32_t>(line.size()) + 1;
    if (address < 1) return 42;
    if (address + size > space + 1) return 45;

    // What lies under the new line goes; its names are free again.
    const auto begin =
        std::ranges::find_if(lines_, [&](const Line& l) { return l.address + static_cast<std::int32_t>(l.text.size()) >= address; });
    const auto end = std::find_if(begin, lines_.end(), [&](const Line& l) { return l.address >= address + size; });
    const auto at = static_cast<std::size_t>(begin - lines_.begin());
    remove(at, static_cast<std::size_t>(end - lines_.begin()));

    if (declares(s)) {
        const bool label = s.word == Word::LB;
        if (const int code = symbols_.define(s.symbol, label ? Symbol::Kind::label : Symbol::Kind::local); code != 0) return code;
        if (label) symbols_.at(s.symbol).address = address;
    }
    lines_.insert(lines_.begin() + static_cast<std::ptrdiff_t>(at), Line{address, std::string(line), std::move(s)});
    address += size;
    index();
    return 0;
}

void Program::remove(std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
        const Statement& s = lines_[i].statement;
        if (!declares(s)) continue;
        Symbol& symbol = symbols_.at(s.symbol);
        const bool again = s.word == Word::VA && std::ranges::any_of(lines_, [&](const Line& l) {
                               const auto place = static_cast<std::size_t>(&l - lines_.data());
                               return (place < first || place >= last) && declares(l.statement) && l.statement.symbol == s.symbol;
                           });
        if (symbol.kind != Symbol::Kind::global && !again) symbol.kind = Symbol::Kind::unknown;
    }
    lines_.erase(lines_.begin() + static_cast<std::ptrdiff_t>(first), lines_.begin() + static_cast<std::ptrdiff_t>(last));
    index();
}

void Program::index() {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
        const Statement& s = lines_[i].statement;
        if (declares(s) && s.word == Word::LB) symbols_.at(s.symbol).line = static_cast<std::uint32_t>(i);
    }
}

std::int32_t Program::find(const Target& target, int& error) const noexcept {
    if (target.label != no_symbol) {
        const Symbol& s = symbols_.at(target.label);
        if (s.kind == Symbol::Kind::label) return static_cast<std::int32_t>(s.line);
        error = s.kind == Symbol::Kind::unknown ? 30 : 34;
        return -1;
    }
    if (target.missing_name || !target.given) {
        error = 30;
        return -1;
    }
    const auto it = std::ranges::lower_bound(lines_, target.address, {}, &Line::address);
    if (it == lines_.end() || it->address != target.address) {
        error = 42;
        return -1;
    }
    return static_cast<std::int32_t>(it - lines_.begin());
}

void Program::clear(bool variables) {
    lines_.clear();
    std::vector<Symbol> kept;
    for (std::size_t i = 0; i < symbols_.size(); ++i) {
        const Symbol& s = symbols_.at(static_cast<SymbolId>(i));
        if (!variables && s.kind == Symbol::Kind::global) kept.push_back(s);
    }
    symbols_.clear();
    for (const Symbol& s : kept)
        symbols_.at(symbols_.mention(s.name)) = s;
}

void Program::clear_from(std::size_t index) {
    std::size_t last = index;
    while (last < lines_.size()) {
        const Statement& s = lines_[last++].statement;
        if (s.kind == Statement::Kind::execute && s.word == Word::E) break;
    }
    remove(index, last);
}

std::string Program::text() const {
    std::string out;
    for (const Line& l : lines_)
        out += std::to_string(l.address) + ' ' + l.text + '\n';
    return out;
}

void Program::load(std::string_view text) {
    clear(false);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view row = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        std::int32_t address = 0;
        const auto [stop, fault] = std::from_chars(row.data(), row.data() + row.size(), address);
        if (fault != std::errc{} || stop == row.data() + row.size() || *stop != ' ') continue;
        const std::string_view line(stop + 1, static_cast<std::size_t>(row.data() + row.size() - stop - 1));
        if (line.size() > line_limit) continue;
        (void)enter(line, address);
    }
}

void Program::reset_locals() noexcept {
    for (std::size_t i = 0; i < symbols_.size(); ++i) {
        Symbol& s = symbols_.at(static_cast<SymbolId>(i));
        if (s.kind == Symbol::Kind::local) s.value = 0;
    }
}

}  // namespace axisgate::mcode::twin
