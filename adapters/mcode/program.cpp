// Program: see the header.
// In and out: see the header.
// Never changes a statement: what is sent is what was written, without its comment when the line would be too long with nothing lost.
#include "adapters/mcode/program.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <sstream>

#include "adapters/mcode/wire.hpp"

namespace axisgate::mcode {
namespace {
std::string upper(std::string_view s) {
    std::string out(s);
    for (char& c : out) {
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    }
    return out;
}
std::string_view trim(std::string_view s) {
    while (!s.empty() && (s.front() == ' ' || s.front() == '\t'))
        s.remove_prefix(1);
    while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r'))
        s.remove_suffix(1);
    return s;
}
/// Without the comment: an apostrophe outside of quotes begins it [L626].
std::string_view statement_of(std::string_view line) {
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"') quoted = !quoted;
        if (line[i] == '\'' && !quoted) return trim(line.substr(0, i));
    }
    return trim(line);
}
bool is_name(std::string_view s, std::size_t longest) {
    if (s.empty() || s.size() > longest || s[0] < 'A' || s[0] > 'Z') return false;
    for (const char c : s) {
        if (!((c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))) return false;
    }
    return true;
}
/// The name behind the first word, `=` and blanks skipped.
std::string name_after(std::string_view statement, std::size_t word) {
    std::size_t i = word;
    while (i < statement.size() && (statement[i] == ' ' || statement[i] == '='))
        ++i;
    std::size_t end = i;
    while (end < statement.size() && statement[end] != ',' && statement[end] != ' ' && statement[end] != '=')
        ++end;
    return upper(statement.substr(i, end - i));
}
}  // namespace

ProgramText check_program(std::string_view text, const std::function<bool(const std::string&)>& known) {
    ProgramText out;
    struct Use {
        std::size_t line;
        std::string name;
    };
    std::vector<Use> targets;
    struct First {
        std::size_t line;
        std::string word;
    };
    std::vector<First> unknown;
    std::map<std::string, std::size_t> labels;
    std::set<std::string> variables;
    std::size_t number = 0, opened = 0;
    bool inside = false, framed = false;
    const auto fault = [&](std::size_t line, std::string why) {
        out.lines.clear();
        out.fault = fmt::format("line {}: {}", line, why);
        return out;
    };
    for (std::size_t at = 0; at <= text.size();) {
        const auto end = std::min(text.find('\n', at), text.size());
        std::string_view line = trim(text.substr(at, end - at));
        at = end + 1;
        ++number;
        const std::string_view statement = statement_of(line);
        if (line.size() > line_limit) return fault(number, check_line(line));
        if (statement.empty()) continue;
        if (auto why = check_line(statement); !why.empty()) return fault(number, why);
        const std::string word = word_of(statement);
        if (word.empty()) return fault(number, fmt::format("{} begins with no word of the language", statement));
        if (word == "PG") {
            framed = true;
            inside = !inside;
            if (inside) opened = number;
        } else if (word == "LB" || word == "VA") {
            const std::string name = name_after(statement, 2);
            if (!is_name(name, word == "LB" ? 3 : 2)) {
                return fault(number, fmt::format("{} is no name: a letter, then {} or digits", name.empty() ? "nothing" : name,
                                                 word == "LB" ? "up to two letters" : "one letter"));
            }
            if (known(name) && name != "SU") return fault(number, fmt::format("{} is a word of the language and cannot be a name", name));
            if (word == "LB") {
                if (const auto [it, fresh] = labels.emplace(name, number); !fresh) {
                    return fault(number, fmt::format("label {} stands in line {} already", name, it->second));
                }
                if (variables.contains(name)) return fault(number, fmt::format("{} is a variable already", name));
            } else if (!variables.insert(name).second || labels.contains(name)) {
                return fault(number, fmt::format("{} is declared already", name));
            }
            if (labels.size() + variables.size() > 192) return fault(number, "more than 192 labels and variables");
        } else if (word == "BR" || word == "CL" || word == "OE") {
            targets.push_back({number, name_after(statement, 2)});
        } else if (!known(word)) {
            unknown.push_back({number, word});
        }
        out.lines.emplace_back(line.size() <= line_limit && check_line(line).empty() ? line : statement);
        if (out.lines.size() > program_line_limit) return fault(number, fmt::format("more than {} lines", program_line_limit));
    }
    for (const auto& u : unknown) {
        if (!variables.contains(u.word))
            return fault(u.line, fmt::format("{} is no word of the language and no declared variable", u.word));
    }
    for (const auto& u : targets) {
        if (is_name(u.name, 3) && !labels.contains(u.name) && !variables.contains(u.name)) {
            return fault(u.line, fmt::format("there is no label {}", u.name));
        }
    }
    if (inside) return fault(opened, "PG opens the program and nothing closes it: end the text with a line PG");
    if (out.lines.empty()) return fault(1, "there is no statement");
    if (!framed) {
        out.lines.insert(out.lines.begin(), "PG 1");
        out.lines.emplace_back("PG");
    }
    return out;
}

std::string normal_form(std::string_view line) {
    std::string s;
    bool quoted = false;
    for (const char c : statement_of(line)) {
        if (c == '"') quoted = !quoted;
        if (!quoted && (c == ' ' || c == '\t' || c == '=')) continue;
        s += quoted || c < 'a' || c > 'z' ? c : static_cast<char>(c - 'a' + 'A');
    }
    return s;
}

StoredQuestions stored_questions(std::string_view listing) {
    StoredQuestions found;
    std::istringstream in{std::string(listing)};
    for (std::string raw; std::getline(in, raw);) {
        std::string_view line = trim(raw);
        const auto digits = std::min(line.find_first_not_of("0123456789"), line.size());
        const std::string_view address = line.substr(0, digits);
        line = trim(line.substr(digits));
        if (line.empty() || word_of(line) == "PG") continue;
        const std::string text = normal_form(line);
        if (text.size() > 5 && text.starts_with("PR\"#") && text[5] == '"') {
            if (found.count++ == 0) found.address = address;
            found.at_end = found.count == 1 || found.at_end;
        } else if (found.count > 0) {
            found.at_end = false;
        }
    }
    return found;
}

std::vector<std::string> listed_lines(std::string_view listing) {
    std::vector<std::string> lines;
    std::istringstream in{std::string(listing)};
    for (std::string raw; std::getline(in, raw);) {
        std::string_view line = trim(raw);
        std::size_t digits = 0;
        while (digits < line.size() && line[digits] >= '0' && line[digits] <= '9')
            ++digits;
        if (digits > 0 && digits < line.size() && line[digits] == ' ') line = trim(line.substr(digits));
        if (!line.empty()) lines.emplace_back(line);
    }
    return lines;
}

}  // namespace axisgate::mcode
