// Program: program text of MCode checked before a drive's memory is touched, and compared with what the drive lists.
// In: text as a person writes it. Out: the lines to send, or the number of the first wrong line and why.
// Never sends; knows the words of the language from the catalogue alone.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::mcode {

struct ProgramText {
    std::vector<std::string> lines;  ///< to be sent in this order, `PG n` and `PG` among them; no comments of their own, no empty ones
    std::string fault;               ///< "line 12: ...", empty: good
};
/// Lines of a program that are sent at most: the bound of one download.
inline constexpr std::size_t program_line_limit = 2000;

/// Checks: printable ASCII, 64 characters [L4897], known words, names of 1 or 2 letters and digits (labels up to 3), labels and
/// variables told twice, targets without a label, `PG` not closed. Text without any PG is put between `PG 1` and `PG`.
[[nodiscard]] ProgramText check_program(std::string_view text, const std::function<bool(const std::string& word)>& known);

/// Statement without comment, blanks outside quotes and case: what a listing is compared by.
[[nodiscard]] std::string normal_form(std::string_view line);
/// Text of a listing without its addresses, lines of the program alone.
[[nodiscard]] std::vector<std::string> listed_lines(std::string_view listing);

/// Questions of this gateway (`PR "#x",...`) in a listing: a drive that was in program mode has stored them.
struct StoredQuestions {
    std::size_t count = 0;
    bool at_end = false;  ///< nothing stands behind or between them
    std::string address;  ///< of the first one; empty: the listing shows none
};
[[nodiscard]] StoredQuestions stored_questions(std::string_view listing);

}  // namespace axisgate::mcode
