// Reference: a second, independent evaluator of MCode's expressions, registers, variables, branches and calls, for random programs.
// In: syntax trees that the test makes. Out: the text of the program, what it must print, and its last error.
// Never uses the twin's tokens, operators or formatting: what both agree on was written twice.
//
// Rules [2.3 to 2.7 of the language, E-11, E-13, E-14, E-15]: terms from left to right without precedence; whole numbers stay whole
// (quotient cut toward zero, 64 bits between operators, a double beyond them) unless the target is an F register or an operand is a double;
// & | ^ ! work on the low 32 bits; nothing is ever infinite; a value that its target does not hold, a quotient by 0 and a function outside
// its domain are error 21, and the program goes on with the next line.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>

#include <cmath>
#include <cstdint>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace axisgate::mcode::twin::test::reference {

struct Figure {
    bool real = false;
    std::int64_t whole = 0;
    double fraction = 0;
    [[nodiscard]] double approximate() const { return real ? fraction : static_cast<double>(whole); }
    [[nodiscard]] bool zero() const { return approximate() == 0; }
};

inline Figure whole(std::int64_t v) { return {false, v, 0}; }
inline Figure broken(double v) { return {true, 0, v}; }

/// Toward zero; beyond 64 bits the nearest end.
inline std::int64_t cut(const Figure& f) {
    if (!f.real) return f.whole;
    if (f.fraction >= 9.2e18) return std::numeric_limits<std::int64_t>::max();
    if (f.fraction <= -9.2e18) return std::numeric_limits<std::int64_t>::min();
    return static_cast<std::int64_t>(std::trunc(f.fraction));
}

inline std::int64_t low_bits(const Figure& f) { return static_cast<std::int64_t>(static_cast<std::uint64_t>(cut(f)) & 0xFFFFFFFFULL); }
inline Figure of_bits(std::int64_t bits) {
    bits &= 0xFFFFFFFFLL;
    return whole(bits >= 0x80000000LL ? bits - 0x100000000LL : bits);
}

struct Format {
    int decimals = 6;
    bool scientific = false;
};

inline std::string printed(const Figure& f, const Format& format) {
    std::ostringstream s;
    if (!f.real) {
        s << f.whole;
        return s.str();
    }
    s << std::uppercase << (format.scientific ? std::scientific : std::fixed) << std::setprecision(format.decimals) << f.fraction;
    return s.str();
}

/// What stands between operators: signs, a function with a sign behind it, and a value.
struct Piece {
    char sign_before = 0;  ///< + - * / & | ^; 0: the first
    std::string prefix;
    std::string function;
    bool minus_behind = false;
    std::string text;  ///< R1, F2, Q3, PI or digits
    char kind = 'n';   ///< R, F, Q: a place; n: `constant`
    int index = 0;
    Figure constant;
};
using Sum = std::vector<Piece>;

inline std::string text_of(const Sum& sum) {
    std::string s;
    for (const Piece& p : sum) {
        if (p.sign_before != 0) s += p.sign_before;
        s += p.prefix;
        if (!p.function.empty()) s += p.function + " ";
        if (p.minus_behind) s += '-';
        s += p.text;
    }
    return s;
}

/// Registers, variables and settings of a drive.
struct State {
    std::int64_t r[4]{};
    double f[8]{};
    std::int64_t q[4]{};
    bool radians = true;
    Format format;
    int error = 0;  ///< the last one
    std::string output;
};

inline std::optional<double> function_value(const std::string& name, double x, bool radians) {
    const double degree = 3.141592653589793 / 180.0;
    const double angle = radians ? x : x * degree;
    const auto back = [&](double a) { return radians ? a : a / degree; };
    if (name == "AB") return std::signbit(x) ? -x : x;
    if (name == "SQ") return x < 0 ? std::nullopt : std::optional(std::sqrt(x));
    if (name == "LO") return x <= 0 ? std::nullopt : std::optional(std::log(x));
    if (name == "L_") return x <= 0 ? std::nullopt : std::optional(std::log10(x));
    if (name == "S_") return std::abs(x) > 1 ? std::nullopt : std::optional(back(std::asin(x)));
    if (name == "C_") return std::abs(x) > 1 ? std::nullopt : std::optional(back(std::acos(x)));
    if (name == "T_") return back(std::atan(x));
    if (name == "SI") return std::sin(angle);
    if (name == "CS") return std::cos(angle);
    return std::tan(angle);
}

inline Figure negated(const Figure& f) { return f.real ? broken(-f.fraction) : whole(-f.whole); }

inline std::optional<Figure> joined(char sign, const Figure& a, const Figure& b, bool to_real) {
    if (sign == '&') return of_bits(low_bits(a) & low_bits(b));
    if (sign == '|') return of_bits(low_bits(a) | low_bits(b));
    if (sign == '^') return of_bits(low_bits(a) ^ low_bits(b));
    if (sign == '/' && b.zero()) return std::nullopt;
    if (!to_real && !a.real && !b.real) {
        using wide = boost::multiprecision::int128_t;
        const wide x = a.whole, y = b.whole;
        const wide v(sign == '+' ? wide(x + y) : sign == '-' ? wide(x - y) : sign == '*' ? wide(x * y) : wide(x / y));
        if (v >= std::numeric_limits<std::int64_t>::min() && v <= std::numeric_limits<std::int64_t>::max())
            return whole(static_cast<std::int64_t>(v));
    }
    const double x = a.approximate(), y = b.approximate();
    const double v = sign == '+' ? x + y : sign == '-' ? x - y : sign == '*' ? x * y : x / y;
    if (std::isinf(v) || std::isnan(v)) return std::nullopt;
    return broken(v);
}

/// Nothing: error 21.
inline std::optional<Figure> value(const Sum& sum, const State& s, bool to_real) {
    Figure total;
    for (const Piece& p : sum) {
        const auto at = static_cast<std::size_t>(p.index);
        Figure v = p.kind == 'R' ? whole(s.r[at]) : p.kind == 'F' ? broken(s.f[at]) : p.kind == 'Q' ? whole(s.q[at]) : p.constant;
        if (p.minus_behind) v = negated(v);
        if (!p.function.empty()) {
            const auto result = function_value(p.function, v.approximate(), s.radians);
            if (!result || !std::isfinite(*result)) return std::nullopt;
            v = broken(*result);
        }
        for (std::size_t i = p.prefix.size(); i-- > 0;)
            v = p.prefix[i] == '-' ? negated(v) : of_bits(~low_bits(v));
        if (p.sign_before == 0) {
            total = v;
        } else {
            const auto next = joined(p.sign_before, total, v, to_real);
            if (!next) return std::nullopt;
            total = *next;
        }
    }
    return total;
}

/// To R1..R4 (symmetric), F1..F8 or a variable; false: error 21, and nothing changes.
inline bool put(State& s, char kind, int index, const Figure& v) {
    const auto at = static_cast<std::size_t>(index);
    if (kind == 'F') {
        if (!std::isfinite(v.approximate())) return false;
        s.f[at] = v.approximate();
        return true;
    }
    const std::int64_t n = cut(v), least = kind == 'R' ? -2147483647LL : -2147483648LL;
    if (n < least || n > 2147483647LL) return false;
    (kind == 'R' ? s.r[at] : s.q[at]) = n;
    return true;
}

struct Check {
    Sum left;
    std::string sign;  ///< = <> < <= > >=; empty: not zero
    Sum right;
};

inline std::string text_of(const Check& t) { return text_of(t.left) + (t.sign.empty() ? "" : t.sign + text_of(t.right)); }

/// Nothing: error 21.
inline std::optional<bool> holds(const Check& t, const State& s) {
    const auto a = value(t.left, s, false);
    if (!a) return std::nullopt;
    if (t.sign.empty()) return !a->zero();
    const auto b = value(t.right, s, false);
    if (!b) return std::nullopt;
    int order = 0;
    if (!a->real && !b->real) {
        order = a->whole < b->whole ? -1 : a->whole > b->whole ? 1 : 0;
    } else {
        order = a->approximate() < b->approximate() ? -1 : a->approximate() > b->approximate() ? 1 : 0;
    }
    if (t.sign == "=") return order == 0;
    if (t.sign == "<>") return order != 0;
    if (t.sign == "<") return order < 0;
    if (t.sign == "<=") return order <= 0;
    if (t.sign == ">") return order > 0;
    return order >= 0;
}

/// One line of a program.
struct Line {
    enum class Kind { assign, declare, count, label, branch, call, back, end, print, angle, format, handler };
    Kind kind = Kind::end;
    char place = 'R';
    int index = 0;
    Sum sum;
    int by = 1;
    std::string label;
    std::optional<Check> test;
    Format format;
    bool flag = false;
    std::vector<Piece> items;
};

inline std::string place_of(char kind, int index) { return std::string(1, kind) + std::to_string(index + 1); }

inline std::string text_of(const Line& l) {
    const std::string place = place_of(l.place, l.index);
    switch (l.kind) {
        case Line::Kind::assign:
            return place + "=" + text_of(l.sum);
        case Line::Kind::declare:
            return "VA " + place + (l.sum.empty() ? "" : "=" + text_of(l.sum));
        case Line::Kind::count:
            return (l.by > 0 ? "IC " : "DC ") + place;
        case Line::Kind::label:
            return "LB " + l.label;
        case Line::Kind::branch:
        case Line::Kind::call:
            return (l.kind == Line::Kind::branch ? "BR " : "CL ") + l.label + (l.test ? "," + text_of(*l.test) : "");
        case Line::Kind::back:
            return "RT";
        case Line::Kind::end:
            return "E";
        case Line::Kind::handler:
            return "OE " + l.label;
        case Line::Kind::angle:
            return l.flag ? "RA=1" : "RA=0";
        case Line::Kind::format:
            return "PF=10," + std::to_string(l.format.decimals) + (l.format.scientific ? ",1" : ",0");
        default: {
            std::string s = "PR ";
            for (const Piece& p : l.items)
                s += p.text + (&p == &l.items.back() ? "" : ",\" \",");
            return s;
        }
    }
}

/// Runs from the first line to E; false if it is not over after `most` lines.
inline bool run(const std::vector<Line>& lines, State& s, int most) {
    struct Return {
        std::size_t at;
        bool from_handler;
    };
    std::vector<Return> calls;
    std::optional<std::size_t> handler;
    bool handling = false, failed = false;
    const auto place_of_label = [&](const std::string& label) {
        std::size_t at = 0;
        while (lines[at].kind != Line::Kind::label || lines[at].label != label)
            ++at;
        return at;
    };
    for (int i = 0; i < 3; ++i)  // local variables; the fourth is global
        s.q[i] = 0;
    for (std::size_t at = 0; at < lines.size() && most-- > 0;) {
        if (failed) {
            s.error = 21;
            failed = false;
            if (handler && !handling) {
                calls.push_back({at, true});
                handling = true;
                at = *handler;
            }
        }
        const Line& l = lines[at++];
        switch (l.kind) {
            case Line::Kind::declare:
                s.q[static_cast<std::size_t>(l.index)] = 0;
                if (l.sum.empty()) break;
                [[fallthrough]];
            case Line::Kind::assign: {
                const auto v = value(l.sum, s, l.place == 'F');
                failed = !v || !put(s, l.place, l.index, *v);
                break;
            }
            case Line::Kind::count: {
                const auto i = static_cast<std::size_t>(l.index);
                const Figure now = l.place == 'R' ? whole(s.r[i] + l.by) : l.place == 'Q' ? whole(s.q[i] + l.by) : broken(s.f[i] + l.by);
                failed = !put(s, l.place, l.index, now);
                break;
            }
            case Line::Kind::branch:
            case Line::Kind::call: {
                const auto yes = l.test ? holds(*l.test, s) : std::optional(true);
                failed = !yes;
                if (!yes || !*yes) break;
                if (l.kind == Line::Kind::call) calls.push_back({at, false});
                at = place_of_label(l.label);
                break;
            }
            case Line::Kind::back:
                at = calls.back().at;
                if (calls.back().from_handler) handling = false;
                calls.pop_back();
                break;
            case Line::Kind::handler:
                handler = place_of_label(l.label);
                break;
            case Line::Kind::end:
                return true;
            case Line::Kind::angle:
                s.radians = l.flag;
                break;
            case Line::Kind::format:
                s.format = l.format;
                break;
            case Line::Kind::print:
                for (const Piece& p : l.items)
                    s.output += (&p == &l.items.front() ? "" : " ") + printed(*value({p}, s, true), s.format);
                s.output += "\r\n";
                break;
            default:
                break;
        }
    }
    return false;
}

}  // namespace axisgate::mcode::twin::test::reference
