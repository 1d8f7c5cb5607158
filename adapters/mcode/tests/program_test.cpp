// Program texts judged without a drive: faults with their lines, and that nothing is refused which the manual prints as good.
// In: texts, the manual's listings, the golden lines of vectors.txt, the texts of the twin's tests. Out: faults, lines to be sent.
// Never speaks to a drive: downloads are in download_test.cpp.
#include "adapters/mcode/native_program.hpp"

#include <fmt/core.h>

#include "adapters/mcode/native_statement.hpp"
#include "adapters/mcode/tests/fake_drive.hpp"
#include "adapters/mcode/tests/printed_listings.hpp"
#include "adapters/mcode/twin/statement.hpp"

namespace axisgate::mcode::test {
namespace {

const Language& language() {
    static const Language l(catalogue());
    return l;
}
std::string fault_of(std::string_view text) { return check_program(text, language()).fault; }
std::string within(std::string_view statement) { return fmt::format("VA Q1\nPG 1\nLB A1\n' a comment\n\n{}\nE\nPG\n", statement); }

TEST(McodeProgram, FaultsHaveTheirLine) {
    struct Row {
        const char* text;
        const char* fault;
    };
    for (const Row& r : {Row{"PG 1\nLB AA\nMX 1\nPG", "line 3: MX is no word"},
                         Row{"PG 1\nLB AA\nMA 1\nLB aa\nPG", "line 4: label AA stands in line 2"},
                         Row{"PG 1\nMA 1\nE", "line 1: PG opens"},
                         Row{"PG 1\nBR ZZ\nPG", "line 2: there is no label ZZ"},
                         Row{"PG 1\nMA 1        ' a comment that is far too long for the sixty-four characters of a line\nPG", "line 2"},
                         Row{"PG 1\nMA \x01\nPG", "line 2"},
                         Row{"PG 1\nLB MA\nPG", "line 2: MA is a word"},
                         Row{"", "line 1"},
                         Row{"PG 1\n7\nPG", "line 2"},
                         Row{"PG0\nE\nPG", "line 1: PG: 0"},
                         Row{"PG 0\nE\nPG", "line 1: PG: 0 is not allowed"},
                         Row{"PG x\nE\nPG", "line 1: PG"},
                         Row{"\nMS=7\nPG 1\nE\nPG", "line 2: MS: 7"},
                         Row{"PG 1\nE\nPG\n\nFOO=1", "line 5: FOO is no word"},
                         Row{"MA 100\nPG 1\nE\nPG", "line 1: MA stands outside"},
                         Row{"EM=2\nPG 1\nE\nPG", "line 1: EM belongs to the line"},
                         Row{"PG 1\nLB A1\nPG\nLB B1", "line 4: LB can stand in a program only"},
                         Row{"PG 1\nLB AI1\nE\nPG", "line 2: AI1 is no name"},
                         Row{"VA Q1\nPG 1\nVA Q1\nE\nPG", "line 3: Q1 is declared"},
                         Row{"A==5\nBR ZZ", "line 1"},
                         Row{"PG 1\nMS=7\nLB MA\nPG", "line 2"}}) {
        const auto p = check_program(r.text, language());
        EXPECT_TRUE(p.fault.starts_with(r.fault)) << r.text << ": " << p.fault;
        EXPECT_TRUE(p.lines.empty());
    }
}

constexpr const char* faulty_statements[] = {"A==5",
                                             "MR",
                                             "IC",
                                             "CL A1,P>",
                                             "H 100 200",
                                             "MA 1 2",
                                             "R1=(1+2)*3",
                                             "PR \"abc",
                                             "EX A1",
                                             "L",
                                             "FD",
                                             "CP",
                                             "RS",
                                             "UG 1",
                                             "AL",
                                             "SU",
                                             "P",
                                             "PK=1",
                                             "PR Q9",
                                             "R1=Q9+1",
                                             "IV Q5",
                                             "MS=7",
                                             "A=99999999999",
                                             "H 99999",
                                             "HM 7",
                                             "TI=9,A1",
                                             "IS=9,0,0",
                                             "AS=9",
                                             "V=5",
                                             "E 5",
                                             "TI 1,X9",
                                             "TI=1,X9",
                                             "A=",
                                             "A=FOO",
                                             "A=5,6",
                                             "Q1",
                                             "Q1=",
                                             "A1=5",
                                             "R1=A1",
                                             "PR A1",
                                             "PR",
                                             "PR A B",
                                             "PR A,,B",
                                             "VA",
                                             "VA Q12",
                                             "VA MA",
                                             "LB",
                                             "LB A1",
                                             "BR",
                                             "BR A1,",
                                             "CL",
                                             "IC V",
                                             "IC 5",
                                             "MR=X1",
                                             "R1=1+",
                                             "R1=2147483648",
                                             "Q1=2147483648",
                                             "SC",
                                             "SC 2",
                                             "FT=1",
                                             "I7",
                                             "PN=5",
                                             "DE",
                                             "RD=2",
                                             "CW=-1",
                                             "O1",
                                             "OT=8",
                                             "OE FOO",
                                             "TT=0,A1",
                                             "TT=70000,A1",
                                             "TR=10,A1,70000",
                                             "TA=32,A1",
                                             "MA 5,2",
                                             "MA 5,0,1,1",
                                             "MA 2147483648",
                                             "MA -2147483649",
                                             "SL 5000001",
                                             "SL=",
                                             "CF 1",
                                             "RT 1",
                                             "PS 1",
                                             "ER=5",
                                             "ST=1",
                                             "IF=1",
                                             "AB 5",
                                             "PI=3",
                                             "TX=1",
                                             "5X",
                                             "@",
                                             "R1 = 5 5",
                                             "R1=!",
                                             "BR A1 P>5",
                                             "CL A1,P>5,3",
                                             "IS=1,9,0",
                                             "OS=1,22,0",
                                             "OS=4,16,0",
                                             "LS=2,5,1",
                                             "PF=17",
                                             "BP FOO,1",
                                             "DN=\"",
                                             "DN=5",
                                             "TC=FOO",
                                             "TM=FOO",
                                             "TP=5",
                                             "R1=PN",
                                             "BR A1,PR=5",
                                             "R1=O1"};

TEST(McodeProgram, EveryFaultyStatementIsSeen) {
    for (const char* s : faulty_statements) {
        const bool blank_condition = std::string_view(s) == "BR A1,";  // taken by the drive as none [L2117]
        const auto fault = fault_of(within(s));
        if (blank_condition) {
            EXPECT_EQ(fault, "");
        } else {
            EXPECT_TRUE(fault.starts_with("line 6: ")) << s << ": " << fault;
            EXPECT_GT(fault.size(), 12U) << s;
        }
    }
}

constexpr const char* good_statements[] = {"A 5000",
                                           "A = 5000",
                                           "D=A",
                                           "SL=F2",
                                           "DJ 32",
                                           "MA Q1,0,1",
                                           "MA 5,,1",
                                           "MR -Q1*R1",
                                           "MR R1 * 51200",
                                           "P=-0",
                                           "H",
                                           "H 65000",
                                           "H R1",
                                           "TI 1,A1",
                                           "Ti = 1, A1",
                                           "Tp 5*3,A1",
                                           "TR=512000,A1,15",
                                           "TR=100",
                                           "TR=10000,0,25",
                                           "OE 0",
                                           "BR 1",
                                           "BR A1,R1=<5",
                                           "BR A1,Q1&2",
                                           "CL A1,R1",
                                           "PR \"a 'b",
                                           "PR \"Error! \" Er",
                                           "PR P;",
                                           "PR \"x\";",
                                           "PR VT,1",
                                           "PR IS",
                                           "PR UV",
                                           "PR -P,\"a\",R1+1",
                                           "F1=SQ -F2",
                                           "F1=PI*2",
                                           "R1=In",
                                           "R1=!25",
                                           "R1=-R1+-5",
                                           "VA Q2 = 5",
                                           "VA Q3",
                                           "LB SU",
                                           "LB B12",
                                           "LB PW",
                                           "VA PW",
                                           "IC Q1",
                                           "DC F1",
                                           "IV Q1",
                                           "IV R1",
                                           "S",
                                           "IP",
                                           "E",
                                           "RT",
                                           "PS",
                                           "BP A1,2",
                                           "BP",
                                           "BP=0",
                                           "SC 1",
                                           "CF",
                                           "O1=0",
                                           "OT=5",
                                           "IS=5,9,1",
                                           "IS=6,1",
                                           "IS = 1, 1, 0",
                                           "OS=3, 29",
                                           "LS=0, -5,1",
                                           "PF=8,4,1,1",
                                           "ER=0",
                                           "ST=0",
                                           "A=6",
                                           "TS=0",
                                           "SA=1.8",
                                           "EL=512",
                                           "F1=1.5e-300",
                                           "DN=\"a\"",
                                           "BD=96",
                                           "LK=1",
                                           "PW=1,2,3,4",
                                           "MF=92"};

TEST(McodeProgram, WhatIsGoodPasses) {
    for (const char* s : good_statements) {
        EXPECT_EQ(fault_of(within(s) + "NE=0\n"), s == std::string_view("PR \"a 'b") ? fault_of(within(s)) : "") << s;
    }
    EXPECT_EQ(fault_of("NE=1\nPG 1\nLB A1\n100\n-100\nE\nPG\n"), "");
    EXPECT_EQ(fault_of("pg100\nLB A1\nE\nPG\n"), "") << "PG1 is PG 1 [L7052]";
    EXPECT_EQ(fault_of("PG 1\nLB A1\nVA K5\nE\nLB B1\nVA K5\nE\nPG\n"), "") << "local: made again (E-71)";
}

TEST(McodeProgram, GoodTextIsSentAsItStands) {
    const auto p = check_program("VA Q1=25\r\nLB K1\nMA Q1 'go\nH\nQ1=3\nBR k1,Q1<5\n\n' only a comment\nH 5 \\or `so\n", language());
    EXPECT_EQ(p.fault, "");
    std::vector<std::string> lines;
    std::vector<std::size_t> numbers;
    for (const auto& l : p.lines) {
        lines.push_back(l.text);
        numbers.push_back(l.number);
    }
    EXPECT_EQ(lines, (std::vector<std::string>{"PG 1", "VA Q1=25", "LB K1", "MA Q1 'go", "H", "Q1=3", "BR k1,Q1<5", "H 5 'or `so", "PG"}));
    EXPECT_EQ(numbers, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 9, 0}));
    EXPECT_EQ(normal_form("ma  q1 'x"), normal_form("MA Q1"));
    EXPECT_NE(normal_form("PR \"a b\""), normal_form("PR \"ab\""));
}

TEST(McodeProgram, OnlyWhatStandsWithinPgIsLookedForInAListing) {
    const auto p = check_program("A=5000\nVA Q1\nPG 100\nLB B1\nE\nPG\nPG 1\nLB A1\nVA Q2\nE\nPG\nS\n", language());
    ASSERT_EQ(p.fault, "");
    std::size_t count = 0;
    EXPECT_EQ(listing_fault(p.lines, "1 LB A1\r\n7 VA Q2\r\n9 E\r\n100 LB B1\r\n107 E", count), "");
    EXPECT_EQ(count, 4U);
    EXPECT_EQ(listing_fault(p.lines, "1 LB A1\r\n9 E\r\n100 LB B2\r\n107 E", count), "line 4: the drive lists LBB2 for LBB1");
}

TEST(McodeProgram, PrintedListingsPass) {
    for (const auto& l : printed_listings) {
        const auto fault = fault_of(l.text);
        EXPECT_TRUE(l.fault.empty() ? fault.empty() : fault.starts_with(l.fault)) << l.name << ": " << fault;
    }
}

/// Every line of vectors.txt that gives no error, typed or stored.
TEST(McodeProgram, TheGoldenLinesPass) {
    std::ifstream in(std::string(AXISGATE_SOURCE_DIR) + "/adapters/mcode/vectors.txt");
    struct Line {
        std::string text;
        Place place;
        std::size_t number;
    };
    std::vector<Line> lines;
    Names names;
    bool program = false, bytes = false;
    std::size_t number = 0, checked = 0;
    const auto judge = [&] {
        for (const auto& l : lines) {
            const auto at = comment_at(l.text);
            const std::string statement = l.text.substr(0, at);
            if (statement.find_first_not_of(' ') == std::string::npos) continue;
            EXPECT_EQ(statement_fault(statement, language(), names, l.place), "") << "vectors.txt line " << l.number << ": " << l.text;
            ++checked;
        }
        lines.clear();
        names = {};
        program = false;
    };
    for (std::string s; std::getline(in, s);) {
        ++number;
        if (s.starts_with("transcript ") || s.starts_with("program ") || s.starts_with("bytes ")) {
            judge();
            bytes = s.starts_with("bytes ");
        }
        if (s.starts_with("error ") && !lines.empty()) lines.pop_back();
        const bool typed = s.starts_with("> "), stored = s.starts_with("| ");
        if (!typed && !stored) continue;
        const std::string text = s.substr(2);
        std::string word = word_of(text);
        if (word == "PG1") word = "PG";  // the other way to write PG 1 [L7052]
        if (typed && word.empty() && text.find_first_not_of("0123456789.-") == std::string::npos && !names.numeric_entry)
            continue;  // for IV
        if (bytes) continue;
        if (word == "NE") names.numeric_entry = true;
        if (word == "LB" || word == "VA") {
            std::string name;
            for (const char c : text.substr(text.find_first_not_of(' ', text.find_first_not_of(' ') + 2))) {
                if (c == ' ' || c == '=') break;
                name += static_cast<char>(std::toupper(c));
            }
            (word == "LB" ? names.labels : names.variables).insert(name);
        }
        lines.push_back({word == "PG" ? "PG 1" : text, program && word != "PG" ? Place::program : Place::immediate, number});
        if (word == "PG") program = !program;
    }
    judge();
    EXPECT_GT(checked, 900U);
}

/// Texts in the sources of the twin's tests that the twin's own compiler takes: none may be refused for its form.
TEST(McodeProgram, WhatTheTwinCompilesPasses) {
    std::size_t checked = 0;
    for (const char* file : {"listings", "language", "errors", "memory", "traps", "value", "comm", "motor_motion", "motor_io",
                             "motor_closed_loop", "walk_io", "walk_language", "walk_motion", "walk_system"}) {
        std::ifstream in(fmt::format("{}/adapters/mcode/tests/twin_{}_test.cpp", AXISGATE_SOURCE_DIR, file));
        ASSERT_TRUE(in.good()) << file;
        for (std::string s; std::getline(in, s);) {
            for (std::size_t at = s.find('"'); at != std::string::npos; at = s.find('"', at + 1)) {
                std::string text;
                for (++at; at < s.size() && s[at] != '"'; ++at) {
                    if (s[at] == '\\' && at + 1 < s.size()) ++at;
                    text += s[at];
                }
                const std::string word = word_of(text);
                if (text.size() > 64 || word.empty() || word == "PG") continue;
                twin::Symbols symbols;
                const auto compiled = twin::compile(text, symbols, true);
                using Kind = twin::Statement::Kind;
                if (compiled.kind != Kind::assign && compiled.kind != Kind::assign_name && compiled.kind != Kind::execute) continue;
                // A name in front of a party line, and PW, which is a word or a name.
                if ((compiled.kind == Kind::assign_name && word.size() > 2) || word == "PW") continue;
                if (compiled.kind != Kind::assign_name && !twin::info(compiled.word).program) continue;
                Names names;
                for (twin::SymbolId i = 0; i < symbols.size(); ++i) {
                    std::string name;
                    for (const char c : symbols.at(i).name)
                        name += static_cast<char>(std::toupper(c));
                    names.labels.insert(name);
                    names.variables.insert(name);
                }
                const std::size_t comment = comment_at(text);
                const auto fault = statement_fault(text.substr(0, comment), language(), names, Place::program);
                // What is wrong with a value, or with the number of fields, the twin says when it runs.
                const bool of_value = fault.find("is not allowed") != std::string::npos ||
                                      fault.find("can only be read") != std::string::npos ||
                                      fault.find("is too much") != std::string::npos || fault.find("is missing") != std::string::npos ||
                                      fault.find("cannot be changed") != std::string::npos;
                EXPECT_TRUE(fault.empty() || of_value) << file << ": " << text << ": " << fault;
                ++checked;
            }
        }
    }
    EXPECT_GT(checked, 500U);
}

}  // namespace
}  // namespace axisgate::mcode::test
