// Language: the words of MCode as the catalogue has them: what each is, where it may stand, its fields with their ranges.
// In: the catalogue. Out: one row per word, found by its mnemonic.
// Never knows a drive: where products or the encoder mode differ, the widest range holds.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/core/catalogue.hpp"

namespace axisgate::mcode {

/// One field behind a word, as the catalogue's syntax has it: `<0|1>`, `<1..4>`, `<label|address>`, `<ms>`.
struct Field {
    enum class Kind : std::uint8_t { value, target, condition, variable, name, item, text };
    Kind kind = Kind::value;
    std::vector<std::pair<double, double>> ranges;  ///< a figure lies in one of them; empty: any
    bool optional = false;
};
using Form = std::vector<Field>;

struct Word {
    enum class Kind : std::uint8_t { parameter, instruction, keyword, reserved, function, constant };
    Kind kind = Kind::instruction;
    bool immediate = true, program = true;  ///< where a statement may begin with it
    bool readable = false, writable = false;
    bool number = false;      ///< readable as one number: an operand
    std::vector<Form> forms;  ///< of a statement that begins with it; each is tried
    std::string syntax;       ///< the forms for people
};

class Language {
public:
    explicit Language(const Catalogue& catalogue);
    /// `mnemonic` in upper case; null: no word, so it may be a name.
    [[nodiscard]] const Word* find(std::string_view mnemonic) const;

private:
    std::map<std::string, Word, std::less<>> words_;
};

}  // namespace axisgate::mcode
