// Program: program text of MCode checked before a drive's memory is touched, and compared with what the drive lists.
// In: text as a person writes it. Out: the lines to send with their places in that text, or the number of the first wrong line and why.
// Never sends; knows the words of the language from the catalogue alone.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "adapters/mcode/native_language.hpp"

namespace axisgate::mcode {

struct ProgramLine {
    enum class Kind : std::uint8_t {
        frame,    ///< PG: enters and leaves
        stored,   ///< between them: part of the program
        setting,  ///< outside: obeyed at once, and in no listing
    };
    Kind kind = Kind::stored;
    std::string text;
    std::size_t number = 0;  ///< in the user's text, comments and blank lines counted; 0: added here
};
struct ProgramText {
    std::vector<ProgramLine> lines;  ///< to be sent in this order; no comments of their own, no empty ones
    std::string fault;               ///< "line 12: ...", empty: good
};
/// Lines of a program that are sent at most: the bound of one download.
inline constexpr std::size_t program_line_limit = 2000;

/// Checks: printable ASCII, 64 characters [L4897], every statement by itself (statement.hpp), names of 1 or 2 letters and digits (labels
/// also a letter and two digits, E-9), labels and variables told twice, `PG` not closed, what may stand outside of PG. Text without any PG
/// is put between `PG 1` and `PG`. Comments as printed listings have them (backslash, backtick; E-7) become apostrophes.
[[nodiscard]] ProgramText check_program(std::string_view text, const Language& language);

/// How the listing of a drive differs from what was to be stored ("line 4: ..."); empty: it does not. `count`: statements that it holds.
/// VA is left apart: a drive may list it or not.
[[nodiscard]] std::string listing_fault(const std::vector<ProgramLine>& lines, std::string_view listing, std::size_t& count);

/// Statement without comment, blanks outside quotes and case: what a listing is compared by.
[[nodiscard]] std::string normal_form(std::string_view line);
/// Text of a listing without its addresses, lines of the program alone.
[[nodiscard]] std::vector<std::string> listed_lines(std::string_view listing);

/// Lines of a listing with the address that the drive shows of each, PG left apart, in order of address.
struct ListedLine {
    long address = 0;
    std::string text;
};
[[nodiscard]] std::vector<ListedLine> addressed_lines(std::string_view listing);

/// Questions of this gateway (`PR "#x",...`) in a listing: a drive that was in program mode has stored them.
struct StoredQuestions {
    std::size_t count = 0;
    bool at_end = false;  ///< nothing stands behind or between them
    std::string address;  ///< of the first one; empty: the listing shows none
};
[[nodiscard]] StoredQuestions stored_questions(std::string_view listing);

}  // namespace axisgate::mcode
