// Every error code of the catalogue: provoked where its cause can occur, from outside; the others are named with the reason.
// And the words of the catalogue on the three products: each is served or refused with error 37.
// In: lines, control bytes, the tester's hand. Out: ER.
// Never raises a code by the hand's inject_error.
#include <boost/json.hpp>

#include <fstream>
#include <set>
#include <sstream>

#include "adapters/mcode/tests/twin_wire.hpp"

namespace axisgate::mcode::twin::test {
namespace {

struct Cause {
    int code;
    std::vector<std::string> script;  ///< lines; `@name value` is the hand, `~ms` time passes
    std::uint8_t product = lmdc;
    int frame_size = 23;
};

const std::vector<std::string> holding{"PG 1", "LB G1", "H 60000", "E", "PG", "EX G1"};

std::vector<std::string> after(std::vector<std::string> first, std::initializer_list<const char*> more) {
    first.insert(first.end(), more.begin(), more.end());
    return first;
}

std::vector<Cause> causes() {
    return {
        {1, {"@output_fault 1"}},
        {2, {"@output_fault 2"}},
        {6, {"IS=1,1,0", "IS=1,1,0"}},
        {8, {"IS=1,9,0"}},
        {9, {"OS=1,17,1", "O1=1"}},
        {10, {"IS=7,0,0"}},
        {11, {"IS=3,13,0"}, lmdc, 17},
        {12, {"PG 1", "LB K1", "RT", "PG", "TC=K1"}},
        {14, {"@enable_input 0"}, lmm},
        {20, {"XX=1"}},
        {21, {"EM=4"}},
        {22, {"VI=800000"}},
        {23, {"VM=500"}},
        {24, {"VA FT"}},
        {25, {"EF=1"}},
        {26, {"IC AT"}},
        {27, {"TE=2"}},
        {28, {"VA Q1", "VA Q1"}},
        {29, {"PG 1", "LB MR"}},
        {30, {"EX ZZ"}},
        {32, {"PG 1", "LB K1", "E", "PG", "K1=5"}},
        {33, {"RT=5"}},
        {34, {"VM"}},
        {35, {"PR MR"}},
        {37, {"CF"}, lmdo},
        {38, {"PR P V"}},
        {39, {"PG 1", "LB K1", "RT", "PG", "TP=10,K1", "TR=10,K1", "TE=18"}},
        {40, {"E"}},
        {41, after(holding, {"EX G1"})},
        {42, {"EX 3"}},
        {43, {"PG 1", "LB G1", "CL G1", "E", "PG", "EX G1", "~200"}},
        {44, {"LK=1", "L"}},
        {45, {"PG 16380", "R1=123456789", "R1=123456789"}},
        {46, {"H 10"}},
        {48, after(holding, {"IS=4,5,0", "@inputs 7", "~50"})},
        {60, {"HELLO"}},
        {61, {"BD=77"}},
        {62, {"PG 1", "LB G1", "IV R1", "IV R2", "H 60000", "E", "PG", "EX G1", "~50"}},
        {66, {"PG 1", "LB G1", "PR \"much too much for a slow line\"", "BR G1", "E", "PG", "EX G1", "~3000"}},
        {71, {"@temperature 82"}},
        {72, {"@temperature 90"}},
        {73, {"MR 7680000", "S"}},
        {74, {"MR 7680000", "CP"}},
        {76, {"MF=10"}},
        {77, {"VM=3000000"}},
        {78, {"@aux_voltage 35"}},
        {79, {"@supply_voltage 70"}},
        {80, {"HM 1"}},
        {81, {"IS=1,1,0", "HM 5"}},
        {82,
         {"IS=1,1,0", "IS=2,2,0", "IS=3,3,0", "VM=50000", "@limit_negative_position -1", "@limit_positive_position 1", "HM 1", "~20000"}},
        {83, {"IS=2,2,0", "SL 100000", "~100", "@inputs 13", "~500"}},
        {84, {"IS=3,3,0", "SL -100000", "~100", "@inputs 11", "~500"}},
        {85, {"IS=1,1,0", "HM 1", "~100", "MR 100"}},
        {86, {"EE=1", "MR 40000", "~300", "@stall 1", "~500"}},
        {87, {"SL 50000", "~100", "AS=1"}},
        {89, {"SL 50000", "~100", "SC 1"}},
        {91, {"IS=4,5,0", "SL 50000", "~100", "@inputs 7", "~50"}},
        {94, {"DE=0", "MR 100"}},
        {95, {"SL 50000", "~100", "RD=1"}},
        {96, {"@supply_voltage 0", "ER=0", "MR 100"}},
        {97, {"SL 500"}},
        {98, {"VM=2000", "AT=2", "A=1000000000", "MR 1000"}},
        {99, {"VM=2000", "DT=2", "D=1000000000", "MR 1000"}},
        {100, {"@encoder_fault 1", "SC 1", "~20000"}},
        {101, {"@encoder_fault 2", "SC 1", "~20000"}},
        {102, {"@encoder_fault 3", "SC 1", "~20000"}},
        {103, {"DE=0", "SC 1"}},
        {104, {"AS=1", "MR 512000", "~300", "@stall 1", "~5000"}},
    };
}

/// Codes without a row above, and why.
const std::map<int, std::string>& elsewhere() {
    static const std::map<int, std::string> all{
        {7, "the reference gives no cause"},
        {13, "a fault inside the module's power stage; inject_error"},
        {31, "needs 192 names: McodeTrap.T16"},
        {36, "depends on EL, MS and EE together: tests of the closed loop"},
        {47, "the reference gives no cause"},
        {63, "needs lines faster than they are worked off: TheNinthWaitingLineIsLost below"},
        {65, "internal bus; inject_error"},
        {70, "memory checksum at the start; inject_error"},
        {75, "internal driver; inject_error"},
        {88, "a move during SC: tests of the closed loop"},
        {90, "VI and VM are refused before they are too low: 21, 22, 23; McodeMotion.EveryRefusalHasItsCode"},
        {92, "tests of the closed loop"},
        {93, "needs a position correction under way: tests of the closed loop"},
        {105, "tests of the closed loop"},
        {106, "tests of the closed loop"},
        {107, "tests of the closed loop"},
        {108, "tests of the closed loop"},
        {109, "tests of the closed loop"},
        {110, "tests of the closed loop"},
        {111, "factory calibration is not a command of the user"},
    };
    return all;
}

boost::json::value catalogue() {
    std::ifstream file(std::string(AXISGATE_SOURCE_DIR) + "/schema/families/mcode.json");
    std::stringstream text;
    text << file.rdbuf();
    return boost::json::parse(text.str());
}

TEST(McodeErrors, EveryCauseRaisesItsCode) {
    for (const Cause& c : causes()) {
        Wire w(c.product, '!', {}, c.frame_size);
        for (const std::string& step : c.script) {
            if (step[0] == '@') {
                const auto gap = step.find(' ');
                const std::string name = step.substr(1, gap - 1);
                const double v = std::stod(step.substr(gap + 1));
                const bool flag = name == "stall" || name == "enable_input";
                const bool real = name.ends_with("position");
                w.hand(name, flag ? Value{v != 0} : real ? Value{v} : Value{static_cast<std::int64_t>(v)});
                w.pass(milliseconds(1));
            } else if (step[0] == '~') {
                w.pass(milliseconds(std::stoll(step.substr(1))));
            } else {
                (void)w.ask(step);
            }
        }
        w.bytes("\x1B");  // ends what still runs, prints or is entered
        w.pass(std::chrono::seconds(2));
        EXPECT_EQ(w.number("ER"), c.code) << "by " << c.script.back();
    }
}

TEST(McodeErrors, TheNinthWaitingLineIsLost) {
    Wire w;
    std::string many;
    for (int i = 0; i < 9; ++i)
        many += "IC R1\r";
    w.bytes(many, milliseconds(50));
    EXPECT_EQ(w.number("ER"), 63);
    EXPECT_EQ(w.number("R1"), 8);
}

TEST(McodeErrors, EveryCodeOfTheCatalogueIsInOneOfTheTables) {
    std::set<int> provoked;
    for (const Cause& c : causes())
        provoked.insert(c.code);
    const auto json = catalogue();
    std::size_t seen = 0;
    for (const auto& e : json.at("errors").as_array()) {
        const int code = static_cast<int>(e.at("code").as_int64());
        if (e.at("kind").as_string() == "status" || code > 111) continue;
        EXPECT_NE(provoked.contains(code), elsewhere().contains(code)) << code;
        ++seen;
    }
    EXPECT_GT(seen, 80u);
}

TEST(McodeProducts, EveryWordOfTheCatalogueIsServedOrRefused) {
    const auto json = catalogue();
    int served = 0, refused = 0;
    const std::map<std::string, std::uint8_t> products{{"lmdo", lmdo}, {"lmdc", lmdc}, {"lmm", lmm}};
    for (const auto& [name, product] : products) {
        Wire w(product);
        for (const auto& p : json.at("parameters").as_array()) {
            const auto& wire = p.at("wire");
            const std::string word(wire.at("word").as_string());
            if (word != p.at("id").as_string()) continue;  // a field of another word
            const auto found = word_named(word);
            ASSERT_TRUE(found) << word;
            if (info(*found).access == Access::none || info(*found).access == Access::wo) continue;
            bool here = false;
            for (const auto& x : wire.at("products").as_array())
                here = here || x.as_string() == name;
            // An open loop has no encoder; the words that need one are refused as the motor's list says.
            static const std::set<std::string> encoder{"C2", "DB", "EE", "FS", "I6", "PM", "SF", "SM", "ST"};
            if (product == lmdo && encoder.contains(word)) here = false;
            const int code = w.error_of("PR " + word);
            EXPECT_EQ(code, here || word == "ER" ? 0 : 37) << name << ' ' << word;
            ++(here ? served : refused);
        }
        for (const auto& [line, where] : std::map<std::string, std::uint8_t>{{"CF", lmdc}, {"SC 0", lmdc}, {"TA=1,K1", lmdc}}) {
            const int code = w.error_of(line);
            EXPECT_EQ(code == 37, (where & product) == 0) << name << ' ' << line << ": " << code;
        }
    }
    EXPECT_GT(served, 200);
    EXPECT_GT(refused, 30);
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
