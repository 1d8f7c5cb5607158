// Statement: the compiler of one line: which of the forms it has, its operands, and the code of what is wrong.
// In: tokens. Out: a statement.
// Never throws a line away silently: what it cannot read becomes the code that the drive answers with.
#include "adapters/mcode/twin/statement.hpp"

#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {
namespace {
bool is_motion(Word w) noexcept {
    switch (w) {
        case Word::MA:
        case Word::MR:
        case Word::SL:
        case Word::HM:
        case Word::HI:
        case Word::HF:
        case Word::SC:
            return true;
        default:
            return false;
    }
}

bool is_function(Word w) noexcept { return info(w).kind == WordKind::math && w != Word::PI; }

std::string unescaped(std::string_view s) {
    std::string out;
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (s[i] != '\\' || i + 1 == s.size()) {
            out += s[i];
            continue;
        }
        switch (s[++i]) {
            case 'b':
                out += '\b';
                break;
            case 'c':
                out += '\x03';
                break;
            case 'e':
                out += '\x1B';
                break;
            case 'g':
                out += '\a';
                break;
            case 'n':
                out += '\n';
                break;
            case 'r':
                out += '\r';
                break;
            case 't':
                out += '\t';
                break;
            default:
                out += '\\';
                out += s[i];
                break;
        }
    }
    return out;
}

class Compiler {
public:
    Compiler(std::string_view line, Symbols& symbols, bool define) : tokens_(line), symbols_(symbols), define_(define) {}

    Statement run() {
        if (tokens_.at_end()) return {};
        const Token& first = tokens_.peek();
        if (first.kind == Token::Kind::number || tokens_.is_sign('-') || tokens_.is_sign('+')) return bare_number();
        if (first.kind != Token::Kind::name) return faulty(err::unknown_command);
        if (const auto word = word_named(first.text)) {
            tokens_.take();
            // PW is a word of one product only, and a free name on the others [L4970]: a user who has declared it means his own.
            if (*word == Word::PW && declared(first.text)) return of_name(first.text);
            return of_word(*word);
        }
        return of_name(tokens_.take().text);
    }

private:
    Statement faulty(int code) {
        Statement s;
        s.kind = Statement::Kind::faulty;
        s.error = code;
        return s;
    }

    Statement finish(Statement s) { return error_ != 0 ? faulty(error_) : tokens_.at_end() ? std::move(s) : faulty(err::separator); }

    [[nodiscard]] bool declared(std::string_view name) const noexcept {
        const SymbolId id = symbols_.find(name);
        return id != no_symbol && symbols_.at(id).kind != Symbol::Kind::unknown;
    }

    void fail(int code) {
        if (error_ == 0) error_ = code;
    }

    SymbolId symbol(std::string_view name) {
        const SymbolId id = define_ ? symbols_.mention(name) : symbols_.find(name);
        if (id == no_symbol) fail(define_ ? 31 : err::unknown_name);
        return id;
    }

    Statement bare_number() {
        Statement s;
        s.kind = Statement::Kind::bare_number;
        s.fields.push_back(expression());
        return finish(std::move(s));
    }

    Statement of_name(std::string_view name) {
        Statement s;
        const bool sign = tokens_.take_sign('=');
        const SymbolId known = symbols_.find(name);
        const bool good = Symbols::well_formed(name, 3);
        if (tokens_.at_end() && !sign) {
            return faulty(known != no_symbol && symbols_.at(known).kind != Symbol::Kind::unknown ? err::run_variable
                                                                                                 : err::unknown_command);
        }
        if (!good) return faulty(sign ? err::unknown_set : err::unknown_command);
        if (known == no_symbol && !define_) return faulty(sign ? err::unknown_set : err::unknown_command);
        s.kind = Statement::Kind::assign_name;
        s.with_sign = sign;
        s.symbol = symbol(name);
        if (s.symbol != no_symbol && symbols_.at(s.symbol).kind == Symbol::Kind::label) return faulty(err::set_label);
        s.fields.push_back(expression());
        return finish(std::move(s));
    }

    Statement of_word(Word word) {
        const WordInfo& i = info(word);
        Statement s;
        s.word = word;
        s.kind = Statement::Kind::execute;
        switch (i.kind) {
            case WordKind::reserved:
                return faulty(24);
            case WordKind::math:
                return faulty(err::unknown_command);
            case WordKind::keyword:
                return faulty(tokens_.is_sign('=') ? 25 : err::run_variable);
            case WordKind::variable:
            case WordKind::flag:
            case WordKind::setup:
                return assignment(std::move(s));
            case WordKind::trip:
                return trip(std::move(s));
            case WordKind::instruction:
                break;
        }
        return instruction(std::move(s));
    }

    Statement assignment(Statement s) {
        s.with_sign = tokens_.take_sign('=');
        if (tokens_.at_end()) return faulty(s.with_sign ? 21 : err::run_variable);
        s.kind = Statement::Kind::assign;
        if (s.word == Word::DN) {
            if (tokens_.peek().kind != Token::Kind::text) return faulty(21);
            s.name = std::string(tokens_.take().text);
            return finish(std::move(s));
        }
        fields(s);
        return finish(std::move(s));
    }

    /// TI input,label; TP position,label; TR distance,label|0[,repeat]; TT ms,label; TA mask,label; TC label; TM label.
    Statement trip(Statement s) {
        s.with_sign = tokens_.take_sign('=');
        if (tokens_.at_end()) return faulty(s.with_sign ? 21 : err::run_variable);
        if (s.word == Word::TC || s.word == Word::TM) {
            s.target = target();
            return finish(std::move(s));
        }
        s.fields.push_back(expression());
        if (s.word == Word::TR && tokens_.at_end() && error_ == 0) {
            s.target = Target{};  // no subroutine: the trip output alone [L5832]
            return s;
        }
        if (!tokens_.take_sign(',')) return faulty(error_ != 0 ? error_ : err::separator);
        s.target = target();
        if (s.word == Word::TR && tokens_.take_sign(',')) s.fields.push_back(expression());
        return finish(std::move(s));
    }

    Statement instruction(Statement s) {
        switch (s.word) {
            case Word::PR:
                return print(std::move(s));
            case Word::LB:
            case Word::VA:
                return declaration(std::move(s));
            case Word::BR:
            case Word::CL:
                if (tokens_.is_sign('=')) return faulty(err::set_instruction);
                s.target = target();
                if (!s.target->given) return faulty(error_ != 0 ? error_ : err::unknown_name);
                if (!tokens_.at_end()) {
                    if (!tokens_.take_sign(',')) return faulty(err::separator);
                    if (!tokens_.at_end()) s.condition = condition();  // a blank condition is none [L2117]
                }
                return finish(std::move(s));
            case Word::OE:
            case Word::EX:
            case Word::L:
            case Word::BP:
                s.with_sign = tokens_.take_sign('=');
                if (s.with_sign && (s.word == Word::EX || s.word == Word::L)) return faulty(err::set_instruction);
                if (!tokens_.at_end()) s.target = target();
                if ((s.word == Word::EX || s.word == Word::BP) && tokens_.take_sign(',')) s.fields.push_back(expression());
                return finish(std::move(s));
            case Word::CP:
                return clear(std::move(s));
            case Word::IC:
            case Word::DC:
            case Word::IV:
                return counted(std::move(s));
            default:
                break;
        }
        s.with_sign = tokens_.take_sign('=');
        if (s.with_sign && !is_motion(s.word)) return faulty(err::set_instruction);
        if (!tokens_.at_end()) fields(s);
        if (is_motion(s.word) && s.fields.empty()) return faulty(error_ != 0 ? error_ : 21);
        return finish(std::move(s));
    }

    /// CP, CP label, CP 0, CP 1, CP 0,label [L2149-2161].
    Statement clear(Statement s) {
        if (tokens_.is_sign('=')) return faulty(err::set_instruction);
        if (tokens_.at_end()) return s;
        if (tokens_.peek().kind == Token::Kind::number) {
            s.fields.push_back(expression());
            if (tokens_.take_sign(',')) s.target = target();
        } else {
            s.target = target();
        }
        return finish(std::move(s));
    }

    /// IC, DC, IV: one variable. A word stays in `fields` as it is, a name becomes `symbol`.
    Statement counted(Statement s) {
        const Token t = tokens_.take();
        // IC and DC of nothing are as of what cannot be written [L2336, L3375].
        if (t.kind != Token::Kind::name) return faulty(s.word == Word::IV ? err::unknown_name : 25);
        if (const auto w = word_named(t.text)) {
            Expression e;
            e.terms.push_back({});
            e.terms[0].operand = operand_of(*w);
            s.fields.push_back(std::move(e));
        } else {
            s.symbol = symbol(t.text);
            if (error_ == err::unknown_name && s.word != Word::IV) error_ = 25;
        }
        return finish(std::move(s));
    }

    Statement declaration(Statement s) {
        if (tokens_.is_sign('=')) return faulty(err::set_instruction);
        const Token t = tokens_.take();
        if (t.kind != Token::Kind::name) return faulty(err::unknown_name);
        s.name = std::string(t.text);
        if (const auto w = word_named(t.text)) {
            const bool reserved = info(*w).kind == WordKind::reserved;
            const bool start_up = s.word == Word::LB && *w == Word::SU;
            if (!start_up && *w != Word::PW) return faulty(reserved || s.word == Word::VA ? 24 : err::redefine_word);
        }
        // Two characters; a label may also be a letter and two digits [L3765, E-9].
        const bool digits = t.text.size() == 3 && t.text.find_first_not_of("0123456789", 1) == std::string_view::npos;
        if (!Symbols::well_formed(t.text, s.word == Word::LB && digits ? 3 : 2)) return faulty(24);
        s.symbol = symbols_.mention(t.text);
        if (s.symbol == no_symbol) return faulty(31);
        if (s.word == Word::VA && !tokens_.at_end()) {
            tokens_.take_sign('=');
            s.fields.push_back(expression());
        }
        return finish(std::move(s));
    }

    Statement print(Statement s) {
        if (tokens_.is_sign('=')) return faulty(err::set_instruction);
        if (tokens_.at_end()) return faulty(err::unknown_set);
        bool after_text = true;  // no separator is needed before the first item and after a text [E-8]
        bool first = true;
        while (!tokens_.at_end() && error_ == 0) {
            if (tokens_.take_sign(';')) {
                s.open_end = true;
                break;
            }
            if (!first && !tokens_.take_sign(',') && !after_text) return faulty(err::separator);
            if (tokens_.at_end() || tokens_.is_sign(';')) continue;
            first = false;
            PrintItem item;
            if (tokens_.peek().kind == Token::Kind::text) {
                item.kind = PrintItem::Kind::text;
                item.text = unescaped(tokens_.take().text);
                after_text = true;
            } else {
                if (tokens_.peek().kind == Token::Kind::other) return faulty(err::unknown_set);
                item.value = expression(err::bad_print);
                after_text = false;
            }
            s.items.push_back(std::move(item));
            // `PR IT,1` asks for one field: the number stays an item and the printer joins it [L3615].
        }
        return finish(std::move(s));
    }

    Target target() {
        Target t;
        if (tokens_.peek().kind == Token::Kind::number) {
            t.address = static_cast<std::int32_t>(std::min<std::int64_t>(tokens_.take().number.as_integer(), 0x7FFFFFFF));
            t.given = true;
            return t;
        }
        if (tokens_.peek().kind != Token::Kind::name) return t;
        const Token name = tokens_.take();
        const auto word = word_named(name.text);
        if (word && *word != Word::SU && *word != Word::PW) {
            fail(info(*word).kind == WordKind::variable || info(*word).kind == WordKind::flag ? err::run_variable : err::unknown_name);
            return t;
        }
        t.given = true;
        t.label = define_ ? symbols_.mention(name.text) : symbols_.find(name.text);
        t.missing_name = t.label == no_symbol;
        return t;
    }

    Condition condition() {
        Condition c;
        c.left = expression();
        if (tokens_.at_end() || error_ != 0) return c;
        const Token t = tokens_.take();
        switch (t.kind == Token::Kind::sign ? t.sign : '\0') {
            case '=':
                c.comparison = Comparison::equal;
                break;
            case 'n':
                c.comparison = Comparison::different;
                break;
            case '<':
                c.comparison = Comparison::less;
                break;
            case 'l':
                c.comparison = Comparison::less_equal;
                break;
            case '>':
                c.comparison = Comparison::greater;
                break;
            case 'g':
                c.comparison = Comparison::greater_equal;
                break;
            default:
                fail(err::separator);
                return c;
        }
        c.right = expression();
        return c;
    }

    void fields(Statement& s) {
        const bool may_be_blank = s.word == Word::MA || s.word == Word::MR;  // their further fields, which are 0 then [L4116]
        do {
            if (may_be_blank && !s.fields.empty() && (tokens_.at_end() || tokens_.is_sign(','))) {
                s.fields.push_back({{Term{}}});
            } else {
                s.fields.push_back(expression());
            }
        } while (error_ == 0 && s.fields.size() < 8 && tokens_.take_sign(','));
    }

    static Operand operand_of(Word w) {
        Operand o;
        o.word = w;
        if (w >= Word::R1 && w <= Word::R4) {
            o.kind = Operand::Kind::integer_register;
            o.index = static_cast<std::uint8_t>(static_cast<int>(w) - static_cast<int>(Word::R1));
        } else if (w >= Word::F1 && w <= Word::F8) {
            o.kind = Operand::Kind::float_register;
            o.index = static_cast<std::uint8_t>(static_cast<int>(w) - static_cast<int>(Word::F1));
        } else if (w == Word::PI) {
            o.number = Number::of_real(3.141592654);  // the figure that the printed products match [L6664, L6676]
        } else {
            o.kind = Operand::Kind::word;
        }
        return o;
    }

    Expression expression(int unknown = err::unknown_name) {
        Expression e;
        Operator op = Operator::add;
        for (;;) {
            Term t;
            t.op = op;
            for (;;) {
                if (tokens_.take_sign('-')) {
                    t.prefix += '-';
                } else if (tokens_.take_sign('!')) {
                    t.prefix += '!';
                } else if (!tokens_.take_sign('+')) {
                    break;
                }
            }
            Token token = tokens_.take();
            if (token.kind == Token::Kind::name) {
                if (const auto w = word_named(token.text); w && is_function(*w)) {
                    t.function = *w;
                    t.operand_minus = tokens_.take_sign('-');  // belongs to the operand, as in AB -5
                    token = tokens_.take();
                }
            }
            if (token.kind == Token::Kind::number) {
                t.operand.number = token.number;
            } else if (token.kind == Token::Kind::name) {
                const auto w = word_named(token.text);
                const SymbolId own = symbols_.find(token.text);
                if (w && !(*w == Word::PW && declared(token.text))) {
                    const WordInfo& i = info(*w);
                    if (i.access == Access::none && i.kind != WordKind::trip)
                        fail(unknown == err::bad_print ? err::bad_print : err::unknown_name);
                    if (i.access == Access::wo) fail(err::bad_print);
                    t.operand = operand_of(*w);
                } else {
                    t.operand.kind = Operand::Kind::symbol;
                    if (own == no_symbol && !define_) fail(unknown);
                    t.operand.symbol = symbol(token.text);
                }
            } else {
                fail(token.kind == Token::Kind::end ? 21 : err::separator);
            }
            e.terms.push_back(t);
            if (error_ != 0) return e;
            if (tokens_.take_sign('+')) {
                op = Operator::add;
            } else if (tokens_.take_sign('-')) {
                op = Operator::subtract;
            } else if (tokens_.take_sign('*')) {
                op = Operator::multiply;
            } else if (tokens_.take_sign('/')) {
                op = Operator::divide;
            } else if (tokens_.take_sign('&')) {
                op = Operator::bit_and;
            } else if (tokens_.take_sign('|')) {
                op = Operator::bit_or;
            } else if (tokens_.take_sign('^')) {
                op = Operator::bit_xor;
            } else {
                return e;
            }
        }
    }

    Tokens tokens_;
    Symbols& symbols_;
    bool define_;
    int error_ = 0;
};

}  // namespace

Statement compile(std::string_view line, Symbols& symbols, bool define) { return Compiler(line, symbols, define).run(); }

std::string_view trimmed(std::string_view line) noexcept {
    while (!line.empty() && (line.front() == ' ' || line.front() == '\t'))
        line.remove_prefix(1);
    while (!line.empty() && (line.back() == ' ' || line.back() == '\t'))
        line.remove_suffix(1);
    return line;
}

}  // namespace axisgate::mcode::twin
