// Statement: the fields behind a word matched against each form that the language has for it; the first form that fits decides.
// In: one statement and what its program declares. Out: the first thing that no form allows, in words.
// Never refuses for a range that only one product or one mode of the encoder has.
#include "adapters/mcode/native_statement.hpp"

#include <fmt/core.h>

#include <charconv>
#include <optional>
#include <vector>

#include "gateway/core/text.hpp"

namespace axisgate::mcode {
namespace {

struct Token {
    enum class Kind : std::uint8_t { end, word, number, text, sign, open_text };
    Kind kind = Kind::end;
    std::string text;   ///< words in upper case; signs as written
    std::string shown;  ///< as written
    double number = 0;
};

std::vector<Token> tokens_of(std::string_view s) {
    std::vector<Token> out;
    for (std::size_t at = 0; at < s.size();) {
        if (s[at] == ' ' || s[at] == '\t') {
            ++at;
            continue;
        }
        Token t;
        std::size_t end = at + 1;
        if (is_letter(s[at])) {
            while (end < s.size() && (is_letter(s[end]) || is_digit(s[end]) || s[end] == '_'))
                ++end;
            t.kind = Token::Kind::word;
            for (const char c : s.substr(at, end - at))
                t.text += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
        } else if (is_digit(s[at]) || (s[at] == '.' && end < s.size() && is_digit(s[end]))) {
            const auto [last, fault] = std::from_chars(s.data() + at, s.data() + s.size(), t.number);
            end = static_cast<std::size_t>(last - s.data());
            t.kind = Token::Kind::number;
        } else if (s[at] == '"') {
            const auto close = s.find('"', end);
            t.kind = close == std::string_view::npos ? Token::Kind::open_text : Token::Kind::text;
            end = close == std::string_view::npos ? s.size() : close + 1;
        } else {
            t.kind = Token::Kind::sign;
            for (const std::string_view two : {"<>", "<=", ">=", "=<"}) {
                if (s.substr(at, 2) == two) end = at + 2;
            }
        }
        t.shown = s.substr(at, end - at);
        if (t.kind == Token::Kind::sign) t.text = t.shown;
        out.push_back(std::move(t));
        at = end;
    }
    return out;
}

class Judge {
public:
    Judge(std::string_view statement, const Language& language, const Names& names, Place place)
        : tokens_(tokens_of(statement)), language_(language), names_(names), place_(place) {}

    std::string run() {
        const Token first = take();
        if (first.kind == Token::Kind::number || first.text == "-" || first.text == "+") return bare_number(first);
        if (first.kind != Token::Kind::word) return fmt::format("{} begins with no word of the language", first.shown);
        word_ = first.text;
        const Word* w = word(word_);
        if (!w) return own_name();
        switch (w->kind) {
            case Word::Kind::reserved:
                return fmt::format("{} is reserved by the drive", word_);
            case Word::Kind::function:
            case Word::Kind::constant:
                return fmt::format("{} belongs into an expression", word_);
            case Word::Kind::keyword:
                return fmt::format("{} is no statement: {} uses it", word_, w->syntax);
            case Word::Kind::parameter:
                if (!w->writable) return fmt::format("{} can only be read", word_);
                break;
            case Word::Kind::instruction:
                break;
        }
        if (!(place_ == Place::program ? w->program : w->immediate)) {
            return place_ == Place::program ? fmt::format("{} cannot stand in a program: it is for typing only", word_)
                                            : fmt::format("{} can stand in a program only, between PG and PG", word_);
        }
        return of_word(*w);
    }

private:
    [[nodiscard]] const Token& peek() const noexcept { return at_ < tokens_.size() ? tokens_[at_] : end_; }
    Token take() { return at_ < tokens_.size() ? tokens_[at_++] : end_; }
    [[nodiscard]] bool at_end() const noexcept { return at_ >= tokens_.size(); }
    [[nodiscard]] bool is(std::string_view sign) const noexcept { return peek().kind == Token::Kind::sign && peek().text == sign; }
    bool take(std::string_view sign) {
        if (!is(sign)) return false;
        ++at_;
        return true;
    }
    /// PW is a word of one product only and a free name on the others [L4970]: who has declared it means his own.
    [[nodiscard]] const Word* word(std::string_view s) const {
        return s == "PW" && names_.variables.contains(s) ? nullptr : language_.find(s);
    }
    std::string left_over(std::string_view what) const {
        const bool sign = peek().kind == Token::Kind::sign && peek().text != "-" && peek().text != "!";
        return sign ? fmt::format("{}: {} has no place here", what, peek().shown)
                    : fmt::format("{}: a comma or an operator is missing before {}", what, peek().shown);
    }

    std::string bare_number(const Token& first) {
        std::string shown = first.shown;
        if (first.kind == Token::Kind::sign) shown += take().shown;
        if (names_.numeric_entry && at_end()) return {};
        return fmt::format("{} begins with no word of the language", shown);
    }

    std::string own_name() {
        const bool sign = take("=");
        if (!names_.variables.contains(word_)) {
            return names_.labels.contains(word_) ? fmt::format("{} is a label and takes no value", word_)
                                                 : fmt::format("{} is no word of the language and no declared variable", word_);
        }
        if (at_end())
            return sign ? fmt::format("{}: a value is missing", word_) : fmt::format("{} alone says nothing: write {}=", word_, word_);
        Field f;
        f.ranges.emplace_back(-2147483648.0, 2147483647.0);
        if (auto why = field(f); !why.empty()) return why;
        return at_end() ? std::string() : left_over(word_);
    }

    std::string of_word(const Word& w) {
        const std::size_t from = at_;
        std::string first;
        std::size_t furthest = 0;
        // Of several forms the one that fits furthest tells what is wrong.
        for (const Form& form : w.forms) {
            at_ = from;
            std::string why = of_form(w, form);
            if (why.empty()) return {};
            if (first.empty() || at_ > furthest) first = std::move(why), furthest = at_;
        }
        return first;
    }

    std::string of_form(const Word& w, const Form& form) {
        const bool sign = take("=");
        if (w.kind == Word::Kind::parameter && at_end()) {
            return sign ? fmt::format("{}: a value is missing", word_) : fmt::format("{} alone says nothing: write {}=", word_, word_);
        }
        for (std::size_t i = 0; i < form.size(); ++i) {
            const Field& f = form[i];
            if (at_end()) {
                if (f.optional) return {};
                return fmt::format("{}: something is missing: {}", word_, w.syntax);
            }
            const bool after_name = i > 0 && form[i - 1].kind == Field::Kind::name;
            if (after_name) {
                (void)take("=");
            } else if (i > 0 && !take(",")) {
                return left_over(word_);
            }
            const bool blank = (at_end() || is(",")) && f.optional && i > 0;  // fields left blank count as not written [L2117, L4116]
            if (blank) continue;
            if (auto why = field(f); !why.empty()) return why;
        }
        if (at_end()) return {};
        return is(",") || form.empty() ? fmt::format("{}: {} is too much: {}", word_, peek().shown, w.syntax) : left_over(word_);
    }

    std::string field(const Field& f) {
        switch (f.kind) {
            case Field::Kind::value:
                break;
            case Field::Kind::target:
                return target();
            case Field::Kind::condition:
                return condition();
            case Field::Kind::variable:
                return variable();
            case Field::Kind::item:
                return items();
            case Field::Kind::name: {
                const Token t = take();
                return t.kind == Token::Kind::word ? std::string() : fmt::format("{}: {} is no name", word_, t.shown);
            }
            case Field::Kind::text: {
                const Token t = take();
                return t.kind == Token::Kind::text ? std::string() : fmt::format("{}: {} must stand in double quotes", word_, t.shown);
            }
        }
        std::optional<double> figure;
        if (auto why = expression(&figure); !why.empty()) return why;
        if (!figure || f.ranges.empty()) return {};
        std::string allowed;
        for (const auto& [least, most] : f.ranges) {
            if (*figure >= least && *figure <= most) return {};
            allowed += fmt::format("{}{}", allowed.empty() ? "" : ", ",
                                   least == most ? fmt::format("{}", least) : fmt::format("{:.10g}..{:.10g}", least, most));
        }
        return fmt::format("{}: {:.12g} is not allowed, but {}", word_, *figure, allowed);
    }

    std::string target() {
        const Token t = take();
        if (t.kind == Token::Kind::number) return {};
        if (t.kind != Token::Kind::word)
            return fmt::format("{}: {} is no label and no address", word_, t.shown.empty() ? "nothing" : t.shown);
        if (names_.labels.contains(t.text)) return {};
        return fmt::format("there is no label {}", t.text);
    }

    std::string variable() {
        const Token t = take();
        if (t.kind != Token::Kind::word) return fmt::format("{}: {} is no variable", word_, t.shown);
        if (names_.variables.contains(t.text)) return {};
        const Word* w = word(t.text);
        if (!w) return fmt::format("{}: {} is no word of the language and no declared variable", word_, t.text);
        if (!w->number || !w->writable) return fmt::format("{}: {} cannot be changed", word_, t.text);
        return {};
    }

    std::string condition() {
        if (auto why = expression(nullptr); !why.empty()) return why;
        if (at_end()) return {};
        const Token t = take();
        for (const std::string_view c : {"=", "<>", "<", "<=", "=<", ">", ">="}) {
            if (t.kind == Token::Kind::sign && t.text == c) return expression(nullptr);
        }
        --at_;
        return left_over(word_);
    }

    std::string items() {
        bool after_text = true;  // behind a text the comma may be missing (E-8)
        for (bool first = true; !at_end(); first = false) {
            if (take(";")) return {};
            if (!first && !take(",") && !after_text) return left_over(word_);
            if (at_end() || is(";")) continue;
            if (peek().kind == Token::Kind::open_text) return fmt::format("{}: the text {} has no second quote", word_, peek().shown);
            after_text = peek().kind == Token::Kind::text;
            if (after_text) {
                take();
                continue;
            }
            const Word* w = peek().kind == Token::Kind::word ? word(peek().text) : nullptr;
            if (w && w->readable && !w->number) {
                take();  // a word that prints as text
                continue;
            }
            if (auto why = expression(nullptr); !why.empty()) return why;
        }
        return {};
    }

    /// Operands with operators between them, from left to right; there are no parentheses. `figure`: its value when it is one figure.
    std::string expression(std::optional<double>* figure) {
        for (bool only = true;; only = false) {
            bool minus = false, complement = false;
            while (is("-") || is("!") || is("+")) {
                const Token sign = take();
                if (sign.text == "-") minus = !minus;
                if (sign.text == "!") complement = true;
            }
            Token t = take();
            const Word* w = t.kind == Token::Kind::word ? word(t.text) : nullptr;
            const bool function = w && w->kind == Word::Kind::function;
            if (function) {
                (void)take("-");
                t = take();
                w = t.kind == Token::Kind::word ? word(t.text) : nullptr;
            }
            if (t.kind == Token::Kind::end) return fmt::format("{}: a value is missing at the end", word_);
            if (t.kind == Token::Kind::open_text) return fmt::format("{}: the text {} has no second quote", word_, t.shown);
            if (t.kind == Token::Kind::word) {
                if (auto why = operand(t, w); !why.empty()) return why;
            } else if (t.kind != Token::Kind::number) {
                return fmt::format("{}: {} stands where a value is wanted{}", word_, t.shown,
                                   t.text == "(" ? "; MCode has no parentheses" : "");
            }
            bool more = false;
            for (const std::string_view op : {"+", "-", "*", "/", "&", "|", "^"})
                more = more || take(op);
            if (more) continue;
            if (figure && only && !complement && !function && t.kind == Token::Kind::number) *figure = minus ? -t.number : t.number;
            return {};
        }
    }

    std::string operand(const Token& t, const Word* w) const {
        if (!w) {
            if (names_.variables.contains(t.text)) return {};
            return names_.labels.contains(t.text)
                       ? fmt::format("{}: {} is a label and has no value", word_, t.text)
                       : fmt::format("{}: {} is no word of the language and no declared variable", word_, t.text);
        }
        if (w->number || (w->kind == Word::Kind::keyword && w->readable && t.text == "IN")) return {};
        return fmt::format("{}: {} has no value that could be used here", word_, t.text);
    }

    std::vector<Token> tokens_;
    std::size_t at_ = 0;
    const Language& language_;
    const Names& names_;
    Place place_;
    std::string word_;
    Token end_;
};
}  // namespace

std::string statement_fault(std::string_view statement, const Language& language, const Names& names, Place place) {
    return Judge(statement, language, names, place).run();
}

std::size_t comment_at(std::string_view line) noexcept {
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"') quoted = !quoted;
        if (!quoted && (line[i] == '\'' || line[i] == '\\' || line[i] == '`')) return i;
    }
    return std::string_view::npos;
}

}  // namespace axisgate::mcode
