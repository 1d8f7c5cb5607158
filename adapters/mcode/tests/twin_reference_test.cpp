// The interpreter against the reference evaluator: random programs with registers, doubles, variables, functions, branches and calls, and
// the edges of numbers enumerated.
// In: fixed seeds. Out: equal output, values and last error.
// Never compares with a tolerance: a double is shown with all its digits.
#include <random>

#include "adapters/mcode/tests/twin_bench.hpp"
#include "adapters/mcode/tests/twin_reference.hpp"

namespace axisgate::mcode::twin::test {
namespace {

using namespace reference;

const std::vector<std::string> functions{"AB", "SQ", "LO", "L_", "S_", "C_", "T_", "SI", "CS", "TG"};

Piece constant(const std::string& digits) {
    Piece p;
    p.text = digits;
    p.kind = 'n';
    const bool real = digits.find_first_of(".e") != std::string::npos;
    p.constant = real ? broken(std::strtod(digits.c_str(), nullptr)) : whole(std::stoll(digits));
    return p;
}
Piece pi() {
    Piece p;
    p.text = "PI";
    p.constant = broken(3.141592654);
    return p;
}
Piece place(char kind, int index) {
    Piece p;
    p.kind = kind;
    p.index = index;
    p.text = place_of(kind, index);
    return p;
}

/// Makes programs that end: branches go forward, loops count R4 down, subroutines call only later ones.
class Maker {
public:
    explicit Maker(std::uint32_t seed) : random_(seed) {}

    std::vector<Line> make() {
        lines_.clear();
        labels_ = 0;
        subroutines_ = below(4);
        if (below(2) == 0) add(Line::Kind::handler, [](Line& l) { l.label = "KE"; });
        for (int i = 0; i < 3; ++i)  // the fourth is global
            add(Line::Kind::declare, [&](Line& l) {
                l.place = 'Q';
                l.index = i;
                if (below(2) == 0) l.sum = sum(1);
            });
        block(0, 6 + below(10), true);
        show();
        add(Line::Kind::end, [](Line&) {});
        for (int s = 0; s < subroutines_; ++s) {
            add(Line::Kind::label, [&](Line& l) { l.label = subroutine(s); });
            block(s + 1, 1 + below(4), false);
            add(Line::Kind::back, [](Line&) {});
        }
        add(Line::Kind::label, [](Line& l) { l.label = "KE"; });
        add(Line::Kind::count, [&](Line& l) {
            l.place = 'F';
            l.index = 7;
        });
        if (below(3) == 0) statement();
        add(Line::Kind::back, [](Line&) {});
        return lines_;
    }

private:
    int below(int n) { return static_cast<int>(random_() % static_cast<std::uint32_t>(n)); }
    static std::string subroutine(int n) { return "K" + std::to_string(n); }

    template <typename Fill>
    void add(Line::Kind kind, Fill fill) {
        // A line has 64 characters at most; an expression that is longer is made anew.
        for (int tries = 0; tries < 100; ++tries) {
            Line l;
            l.kind = kind;
            fill(l);
            if (text_of(l).size() > 64) continue;
            lines_.push_back(std::move(l));
            return;
        }
    }

    void block(int from, int count, bool loops) {
        for (int n = 0; n < count; ++n) {
            switch (below(12)) {
                case 0:
                    if (from < subroutines_) {
                        add(Line::Kind::call, [&](Line& l) {
                            l.label = subroutine(from + below(subroutines_ - from));
                            if (below(2) == 0) l.test = test();
                        });
                    }
                    break;
                case 1: {
                    const std::string label = "B" + std::to_string(labels_ % 10) + std::to_string(labels_ / 10);
                    ++labels_;
                    add(Line::Kind::branch, [&](Line& l) {
                        l.label = label;
                        if (below(5) != 0) l.test = test();
                    });
                    statement();
                    if (below(2) == 0) statement();
                    add(Line::Kind::label, [&](Line& l) { l.label = label; });
                    break;
                }
                case 2: {
                    if (!loops) break;
                    loops = false;
                    add(Line::Kind::assign, [&](Line& l) {
                        l.place = 'R';
                        l.index = 3;
                        l.sum = {constant(std::to_string(1 + below(5)))};
                    });
                    add(Line::Kind::label, [&](Line& l) { l.label = "L1"; });
                    statement();
                    statement();
                    add(Line::Kind::count, [&](Line& l) {
                        l.place = 'R';
                        l.index = 3;
                        l.by = -1;
                    });
                    add(Line::Kind::branch, [&](Line& l) {
                        l.label = "L1";
                        l.test = Check{{place('R', 3)}, ">", {constant("0")}};
                    });
                    break;
                }
                case 3:
                    show();
                    break;
                default:
                    statement();
                    break;
            }
        }
    }

    void statement() {
        const int kind = below(14);
        if (kind == 0) {
            add(Line::Kind::angle, [&](Line& l) { l.flag = below(2) == 0; });
        } else if (kind == 1) {
            add(Line::Kind::format, [&](Line& l) { l.format = {below(17), below(2) == 0}; });
        } else if (kind == 2) {
            add(Line::Kind::count, [&](Line& l) {
                target(l);
                l.by = below(2) == 0 ? 1 : -1;
            });
        } else {
            add(Line::Kind::assign, [&](Line& l) {
                target(l);
                l.sum = sum(1 + below(4));
            });
        }
    }
    /// R4 belongs to the loop.
    void target(Line& l) {
        const int n = below(15);
        l.place = n < 3 ? 'R' : n < 11 ? 'F' : 'Q';
        l.index = n < 3 ? n : n < 11 ? n - 3 : n - 11;
    }
    void show() {
        add(Line::Kind::print, [&](Line& l) {
            const int count = 1 + below(3);
            for (int i = 0; i < count; ++i) {
                const int n = below(16);
                l.items.push_back(place(n < 4 ? 'R' : n < 12 ? 'F' : 'Q', n < 4 ? n : n < 12 ? n - 4 : n - 12));
            }
        });
    }
    Check test() {
        static const std::vector<std::string> signs{"=", "<>", "<", "<=", ">", ">=", ""};
        Check t;
        t.left = sum(1 + below(2));
        t.sign = signs[static_cast<std::size_t>(below(7))];
        if (!t.sign.empty()) t.right = sum(1 + below(2));
        return t;
    }
    Sum sum(int count) {
        Sum s;
        for (int i = 0; i < count; ++i) {
            Piece p = operand();
            if (i > 0) p.sign_before = "+-*/&|^"[below(10) < 7 ? below(4) : below(7)];
            if (below(5) == 0) p.prefix = "-";
            if (below(12) == 0) p.prefix += "!";
            if (below(20) == 0) p.prefix += "-";
            if (below(6) == 0) {
                // Those without a domain more often: a line that fails hides what stands behind it.
                static const std::vector<std::string> total{"AB", "T_", "SI", "CS", "TG"};
                p.function = below(3) != 0 ? total[static_cast<std::size_t>(below(5))] : functions[static_cast<std::size_t>(below(10))];
                p.minus_behind = below(6) == 0;
            }
            s.push_back(std::move(p));
        }
        return s;
    }
    Piece operand() {
        static const std::vector<std::string> edges{"0",       "1",   "2",   "2147483647", "2147483648", "4294967295", "9007199254740993",
                                                    "0.0",     "0.5", "2.9", "1e10",       "1e300",      "1e-300",     "1.0e308",
                                                    "1000000", "30"};
        switch (below(10)) {
            case 0:
                return constant(edges[static_cast<std::size_t>(below(16))]);
            case 1:
                return constant(std::to_string(below(2000)));
            case 2:
                return constant(std::to_string(below(100)) + "." + std::to_string(below(1000)));
            case 3:
                return below(3) == 0 ? pi() : constant(std::to_string(below(10)));
            case 4:
            case 5:
                return place('R', below(4));
            case 6:
            case 7:
                return place('Q', below(4));
            default:
                return place('F', below(8));
        }
    }

    std::mt19937 random_;
    std::vector<Line> lines_;
    int labels_ = 0;
    int subroutines_ = 0;
};

std::string text_of(const std::vector<Line>& lines) {
    std::string s;
    for (const Line& l : lines)
        s += reference::text_of(l) + "\n";
    return s;
}

/// All registers and variables with every digit.
std::string all_values(const State& s) {
    const Format full{16, true};
    std::string text;
    for (const std::int64_t r : s.r)
        text += std::to_string(r) + " ";
    for (const std::int64_t q : s.q)
        text += std::to_string(q) + " ";
    for (const double f : s.f)
        text += printed(broken(f), full) + " ";
    return text;
}
std::string all_values(Bench& b) {
    std::string text;
    b.type("PF=10,16,1");
    for (const char* place : {"R1", "R2", "R3", "R4", "Q1", "Q2", "Q3", "Q4", "F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8"})
        text += b.type(std::string("PR ") + place) + " ";
    return text;
}

TEST(McodeReference, TwoThousandRandomPrograms) {
    int with_errors = 0, with_output = 0, lines_run = 0;
    for (std::uint32_t seed = 1; seed <= 2000; ++seed) {
        Maker maker(seed);
        const std::vector<Line> lines = maker.make();
        State s;
        s.q[3] = static_cast<std::int64_t>(seed) * 977 % 5001 - 2500;
        Bench b;
        b.type("VA Q4=" + std::to_string(s.q[3]));
        ASSERT_TRUE(reference::run(lines, s, 2000)) << seed;
        b.type("PG 1");
        for (const Line& l : lines) {
            b.type(reference::text_of(l));
            ASSERT_EQ(b.prompt, '>') << seed << ": " << reference::text_of(l);
        }
        b.type("PG");
        b.sent.clear();
        (void)b.send("EX 1\r", milliseconds(150));
        ASSERT_TRUE(b.sent.starts_with("EX 1\r\n>")) << shown(b.sent);
        ASSERT_EQ(b.sent.substr(7), s.output) << "seed " << seed << "\n" << text_of(lines);
        ASSERT_EQ(b.type("PR BY"), "0") << seed;
        ASSERT_EQ(b.type("PR ER"), std::to_string(s.error)) << "seed " << seed << "\n" << text_of(lines);
        ASSERT_EQ(all_values(b), all_values(s)) << "seed " << seed << "\n" << text_of(lines);
        with_errors += s.error != 0;
        with_output += !s.output.empty();
        lines_run += static_cast<int>(lines.size());
    }
    EXPECT_GT(with_errors, 200);
    EXPECT_LT(with_errors, 1950) << "programs that run without an error belong to it too";
    EXPECT_EQ(with_output, 2000);
    std::printf("%d lines, %d programs with an error\n", lines_run, with_errors);
}

const std::vector<std::string> edge_values{"0",
                                           "1",
                                           "-1",
                                           "2",
                                           "-2",
                                           "7",
                                           "2147483647",
                                           "-2147483647",
                                           "-2147483648",
                                           "2147483648",
                                           "-4294967296",
                                           "0.5",
                                           "-0.5",
                                           "2.9",
                                           "-2.9",
                                           "1e10",
                                           "-1e10",
                                           "1e300",
                                           "-1e300",
                                           "1e-300",
                                           "5e-324",
                                           "1e308",
                                           "9007199254740992",
                                           "9007199254740993",
                                           "3000000000"};

Piece signed_constant(const std::string& digits) {
    if (digits[0] != '-') return constant(digits);
    Piece p = constant(digits.substr(1));
    p.prefix = "-";
    return p;
}

/// One typed statement on both sides; the target begins at 5.
void compare(Bench& b, State& s, char kind, const Sum& sum) {
    const std::string name = place_of(kind, 0), line = name + "=" + reference::text_of(sum);
    if (line.size() > 64) return;
    (void)put(s, kind, 0, whole(5));
    b.type(name + "=5");
    const auto v = value(sum, s, kind == 'F');
    const bool good = v && put(s, kind, 0, *v);
    b.type(line);
    ASSERT_EQ(b.type("PR ER"), good ? "0" : "21") << line;
    const Figure now = kind == 'F' ? broken(s.f[0]) : whole(kind == 'R' ? s.r[0] : s.q[0]);
    ASSERT_EQ(b.type("PR " + name), printed(now, {16, true})) << line;
}

TEST(McodeReference, EveryOperatorAtTheEdges) {
    Bench b;
    b.type("VA Q1");
    b.type("PF=10,16,1");
    State s;
    for (const char sign : std::string("+-*/&|^")) {
        for (const std::string& x : edge_values) {
            for (const std::string& y : edge_values) {
                for (const char kind : {'R', 'F', 'Q'}) {
                    Piece second = signed_constant(y);
                    second.sign_before = sign;
                    compare(b, s, kind, {signed_constant(x), second});
                    if (HasFatalFailure()) return;
                }
            }
        }
    }
}

TEST(McodeReference, EveryFunctionAtTheEdges) {
    Bench b;
    b.type("VA Q1");
    b.type("PF=10,16,1");
    std::vector<std::string> values = edge_values;
    for (const char* more :
         {"30", "45", "60", "90", "180", "270", "360", "-90", "1.0", "-1.0", "1.0000000001", "0.0", "100", "51200", "1e22"})
        values.emplace_back(more);
    for (const bool radians : {true, false}) {
        State s;
        s.radians = radians;
        b.type(radians ? "RA=1" : "RA=0");
        for (const std::string& f : functions) {
            for (const std::string& x : values) {
                for (const char kind : {'R', 'F', 'Q'}) {
                    for (const char* before : {"", "-", "!"}) {
                        Piece p = constant(x[0] == '-' ? x.substr(1) : x);
                        p.minus_behind = x[0] == '-';
                        p.function = f;
                        p.prefix = before;
                        compare(b, s, kind, {p});
                        if (HasFatalFailure()) return;
                    }
                }
            }
        }
    }
}

TEST(McodeReference, EveryPrefixAndCountAtTheEdges) {
    Bench b;
    b.type("VA Q1");
    b.type("PF=10,16,1");
    State s;
    for (const std::string& x : edge_values) {
        for (const char* before : {"", "-", "!", "-!", "!-", "--", "!!", "!-!"}) {
            for (const char kind : {'R', 'F', 'Q'}) {
                Piece p = constant(x[0] == '-' ? x.substr(1) : x);
                p.prefix = before;
                compare(b, s, kind, {p});
                if (HasFatalFailure()) return;
            }
        }
    }
    for (const char kind : {'R', 'F', 'Q'}) {
        for (const std::string x : {"2147483647", "2147483646", "-2147483647", "-2147483648", "0"}) {
            for (const int by : {1, -1}) {
                const std::string name = place_of(kind, 0);
                b.type(name + "=0");
                (void)put(s, kind, 0, whole(0));
                b.type(name + "=" + x);
                (void)put(s, kind, 0, whole(std::stoll(x)));
                b.type("ER=0");
                b.type((by > 0 ? "IC " : "DC ") + name);
                const Figure next = kind == 'F' ? broken(s.f[0] + by) : whole((kind == 'R' ? s.r[0] : s.q[0]) + by);
                const bool good = put(s, kind, 0, next);
                EXPECT_EQ(b.type("PR ER"), good ? "0" : "21") << name << x << by;
                const Figure now = kind == 'F' ? broken(s.f[0]) : whole(kind == 'R' ? s.r[0] : s.q[0]);
                EXPECT_EQ(b.type("PR " + name), printed(now, {16, true})) << name << x << by;
            }
        }
    }
}

TEST(McodeReference, EveryComparisonAtTheEdges) {
    Bench b;
    State s;
    for (const char* sign : {"=", "<>", "<", "<=", ">", ">="}) {
        std::vector<Line> lines;
        for (const std::string& x : edge_values) {
            // The second operand is one of the same, one more, and what stands behind it in the table.
            const Check same{{signed_constant(x)}, sign, {signed_constant(x)}};
            Piece one = constant("1");
            one.sign_before = '+';
            const Check more{{signed_constant(x)}, sign, {signed_constant(x), one}};
            for (const Check& t : {same, more}) {
                const auto yes = holds(t, s);
                ASSERT_TRUE(yes);
                b.type("CP");
                b.type("PG 1");
                b.type("BR K1," + reference::text_of(t));
                b.type("PR \"no\"");
                b.type("E");
                b.type("LB K1");
                b.type("PR \"yes\"");
                b.type("E");
                b.type("PG");
                (void)b.send("EX 1\r", milliseconds(20));
                EXPECT_EQ(b.sent.substr(7), *yes ? "yes\r\n" : "no\r\n") << reference::text_of(t);
            }
        }
    }
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
