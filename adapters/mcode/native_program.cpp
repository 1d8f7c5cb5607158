// Program: rows are cut, declared and judged in three passes, so that a name may be used before the line that declares it.
// In: a text, or a listing. Out: lines with their numbers, or the first fault; listings in a form that can be compared.
// Never changes a statement: what is sent is what was written, without its comment when the line would be too long with nothing lost.
#include "adapters/mcode/native_program.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <map>
#include <set>
#include <sstream>

#include "adapters/mcode/native_statement.hpp"
#include "adapters/mcode/wire.hpp"
#include "gateway/core/text.hpp"

namespace axisgate::mcode {
namespace {
std::string upper(std::string_view s) {
    std::string out(s);
    for (char& c : out)
        c = axisgate::upper(c);
    return out;
}
std::string_view trim(std::string_view s) {
    while (!s.empty() && (s.front() == ' ' || s.front() == '\t'))
        s.remove_prefix(1);
    while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r'))
        s.remove_suffix(1);
    return s;
}
/// Without the comment [L626].
std::string_view statement_of(std::string_view line) { return trim(line.substr(0, comment_at(line))); }
/// A letter and a letter or digit; for labels a letter and two digits too (E-9).
bool is_name(std::string_view s, bool label) {
    if (s.empty() || s.size() > (label ? 3U : 2U) || s[0] < 'A' || s[0] > 'Z') return false;
    for (const char c : s.substr(1)) {
        if (!(c >= '0' && c <= '9') && (s.size() == 3 || c < 'A' || c > 'Z')) return false;
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
/// By them the gateway speaks to the drive: within a program they act when it runs, outside at once.
bool is_of_link(std::string_view w) { return w == "PY" || w == "DN" || w == "CK" || w == "EM" || w == "ES" || w == "BD"; }

class Check {
public:
    explicit Check(const Language& language) : language_(language) {}

    ProgramText run(std::string_view text) {
        cut(text);
        for (std::size_t i = 0; i < rows_.size() && fault_.empty(); ++i)
            declare(rows_[i]);
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            if (fault_.empty() || rows_[i].number < fault_line_) judge(rows_[i]);
        }
        if (fault_.empty() && opened_ != 0) fault(opened_, "PG opens the program and nothing closes it: end the text with a line PG");
        if (fault_.empty() && rows_.empty()) fault(1, "there is no statement");
        ProgramText out;
        out.fault = fault_;
        if (!fault_.empty()) return out;
        if (!framed_) out.lines.push_back({ProgramLine::Kind::frame, "PG 1", 0});
        for (auto& r : rows_)
            out.lines.push_back({framed_ ? r.kind : ProgramLine::Kind::stored, std::move(r.line), r.number});
        if (!framed_) out.lines.push_back({ProgramLine::Kind::frame, "PG", 0});
        return out;
    }

private:
    struct Row {
        std::size_t number;
        ProgramLine::Kind kind;
        std::string line, statement, word;
    };

    void fault(std::size_t line, std::string_view why) {
        if (!fault_.empty() && fault_line_ <= line) return;
        fault_line_ = line;
        fault_ = fmt::format("line {}: {}", line, why);
    }

    void cut(std::string_view text) {
        std::size_t number = 0;
        for (std::size_t at = 0; at <= text.size() && fault_.empty();) {
            const auto end = std::min(text.find('\n', at), text.size());
            const std::string_view line = trim(text.substr(at, end - at));
            at = end + 1;
            ++number;
            const std::string_view statement = statement_of(line);
            if (line.size() > line_limit) return fault(number, check_line(line));
            if (statement.empty()) continue;
            if (auto why = check_line(statement); !why.empty()) return fault(number, why);
            const std::string word = word_of(statement);
            if (word.empty() && statement.find_first_not_of("+-. 0123456789") != std::string_view::npos) {
                return fault(number, fmt::format("{} begins with no word of the language", statement));
            }
            Row r{number, ProgramLine::Kind::stored, std::string(check_line(line).empty() ? line : statement), std::string(statement),
                  word};
            if (const auto comment = comment_at(r.line); comment != std::string::npos) r.line[comment] = '\'';
            if (word.starts_with("PG") && word.find_first_not_of("0123456789", 2) == std::string::npos) {
                if (word.size() > 2) r.line = r.statement = "PG " + word.substr(2);  // PG1 means PG 1 [L7052]
                r.word = "PG";
                framed_ = true;
                opened_ = opened_ != 0 ? 0 : number;
                r.kind = ProgramLine::Kind::frame;
            } else if (opened_ == 0) {
                r.kind = ProgramLine::Kind::setting;
            }
            if (word == "NE" && statement.find('1') != std::string_view::npos) names_.numeric_entry = true;
            rows_.push_back(std::move(r));
            if (rows_.size() > program_line_limit) return fault(number, fmt::format("more than {} lines", program_line_limit));
        }
    }

    void declare(const Row& r) {
        const bool label = r.word == "LB";
        if (!label && r.word != "VA") return;
        const std::string name = name_after(r.statement, 2);
        if (!is_name(name, label)) {
            return fault(r.number, fmt::format("{} is no name: a letter, then one letter or digit{}", name.empty() ? "nothing" : name,
                                               label ? " or two digits" : ""));
        }
        if (language_.find(name) && name != "PW" && !(label && name == "SU")) {
            return fault(r.number, fmt::format("{} is a word of the language and cannot be a name", name));
        }
        const bool local = framed_ && r.kind == ProgramLine::Kind::stored;
        if (label) {
            if (const auto [it, fresh] = labels_.emplace(name, r.number); !fresh) {
                return fault(r.number, fmt::format("label {} stands in line {} already", name, it->second));
            }
            if (names_.variables.contains(name)) return fault(r.number, fmt::format("{} is a variable already", name));
            names_.labels.insert(name);
        } else {
            // A local one is made again at each run: only a global one or a label is in the way (E-71).
            if (names_.labels.contains(name)) return fault(r.number, fmt::format("{} is a label already", name));
            if (const bool fresh = names_.variables.insert(name).second; !fresh && !(local && locals_.contains(name))) {
                return fault(r.number, fmt::format("{} is declared already", name));
            }
            if (local) locals_.insert(name);
        }
        if (names_.labels.size() + names_.variables.size() > 192) fault(r.number, "more than 192 labels and variables");
    }

    void judge(const Row& r) {
        const bool within = r.kind != ProgramLine::Kind::setting || !framed_;
        const Place place = within && r.kind != ProgramLine::Kind::frame ? Place::program : Place::immediate;
        if (auto why = statement_fault(r.statement, language_, names_, place); !why.empty()) return fault(r.number, why);
        if (within) return;
        const Word* w = language_.find(r.word);
        const bool own = !w || names_.variables.contains(r.word);
        if (is_of_link(r.word)) {
            return fault(r.number, fmt::format("{} belongs to the line: set it with the line's options, or with line.setup", r.word));
        }
        const bool setting = own || w->kind == Word::Kind::parameter || r.word == "VA" || r.word == "S" || r.word == "IC" || r.word == "DC";
        if (!setting) fault(r.number, fmt::format("{} stands outside of PG and PG, where settings, VA and S can stand", r.word));
    }

    const Language& language_;
    std::vector<Row> rows_;
    Names names_;
    std::map<std::string, std::size_t> labels_;
    std::set<std::string> locals_;
    std::string fault_;
    std::size_t fault_line_ = 0, opened_ = 0;
    bool framed_ = false;
};

std::string_view without_address(std::string_view line) {
    const auto digits = std::min(line.find_first_not_of("0123456789"), line.size());
    return digits > 0 && digits < line.size() && line[digits] == ' ' ? trim(line.substr(digits)) : line;
}
}  // namespace

ProgramText check_program(std::string_view text, const Language& language) { return Check(language).run(text); }

std::string listing_fault(const std::vector<ProgramLine>& lines, std::string_view listing, std::size_t& count) {
    std::vector<std::string> got;
    for (const auto& l : listed_lines(listing)) {
        const auto w = word_of(l);
        if (w != "PG" && w != "VA") got.push_back(normal_form(l));
    }
    // The memory is listed by its addresses, in whatever order its parts were sent.
    std::multimap<long, const ProgramLine*> parts;
    long address = 1;
    for (const auto& l : lines) {
        if (l.kind == ProgramLine::Kind::frame) address = std::max(1L, std::atol(normal_form(l.text).c_str() + 2));
        if (l.kind == ProgramLine::Kind::stored && word_of(l.text) != "VA") parts.emplace(address, &l);
    }
    count = 0;
    for (const auto& [from, l] : parts) {
        const std::string want = normal_form(l->text);
        if (count >= got.size() || got[count] != want) {
            return fmt::format("line {}: the drive lists {} for {}", l->number, count < got.size() ? got[count] : "nothing", want);
        }
        ++count;
    }
    return {};
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

std::vector<ListedLine> addressed_lines(std::string_view listing) {
    std::vector<ListedLine> lines;
    std::istringstream in{std::string(listing)};
    for (std::string raw; std::getline(in, raw);) {
        const std::string_view line = trim(raw), text = without_address(line);
        if (text.size() == line.size() || text.empty() || word_of(text) == "PG") continue;
        lines.push_back({std::atol(std::string(line).c_str()), std::string(text)});
    }
    std::ranges::stable_sort(lines, {}, &ListedLine::address);
    return lines;
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
        if (const auto line = without_address(trim(raw)); !line.empty()) lines.emplace_back(line);
    }
    return lines;
}

}  // namespace axisgate::mcode
