// The language of the twin: statements, errors, programs, trips, handler, input, debugging.
// In: typed lines and stored programs. Out: printed text and error codes.
// Never looks inside the interpreter: everything is asked by PR.
#include <chrono>

#include "adapters/mcode/tests/twin_bench.hpp"

namespace axisgate::mcode::twin::test {
namespace {

struct Reported {
    const char* line;
    const char* ask;
    const char* answer;
};

TEST(TwinLanguage, ValuesAsTheManualPrintsThem) {
    Bench b;
    for (const Reported& s : {Reported{"VA Q1=25", "PR Q1", "25"},
                              {"F1=30/25", "PR F1", "1.200000"},
                              {"R1=30/25", "PR R1", "1"},
                              {"R1=-7/2", "PR R1", "-3"},   // cut toward zero [E-11]
                              {"R1=25&30", "PR R1", "24"},  // [E-14]
                              {"R1=25|30", "PR R1", "31"},
                              {"R1=25^30", "PR R1", "7"},
                              {"R1=!25", "PR R1", "-26"},
                              {"R1=2+3*4", "PR R1", "20"},                // left to right [E-13]
                              {"F2=51200*PI", "PR F2", "160849.543885"},  // trap 14
                              {"Q1=51200", "PR Q1", "51200"},
                              {"F1=LO Q1", "PR F1", "10.843495"},         // [E-15]
                              {"F1=AB -51200", "PR F1", "51200.000000"},  // [E-62]
                              {"F1=SQ 16", "PR F1", "4.000000"},
                              {"F1=L_ 1000", "PR F1", "3.000000"},
                              {"F3=2.9", "R2=F3", ""},
                              {"R3=1", "PR R2", "2"},
                              {"PF=8,4,1,1", "PR F8", "0.0000E+00"},
                              {"PF=8,4,1,1", "PR PF", "8,4,1,1"}}) {
        b.type(s.line);
        EXPECT_EQ(b.prompt, '>') << s.line;
        EXPECT_EQ(b.type(s.ask), s.answer) << s.line;
    }
}

TEST(TwinLanguage, AnglesFollowTheUnitOfRA) {
    Bench b;
    b.type("RA=0");
    b.type("F1=SI 30");
    EXPECT_EQ(b.type("PR F1"), "0.500000");
    b.type("F1=C_ 0.5");
    EXPECT_EQ(b.type("PR F1"), "60.000000");
    b.type("RA=1");
    b.type("F1=T_ 1");
    EXPECT_EQ(b.type("PR F1"), "0.785398");
    EXPECT_EQ(b.error_of("F1=SQ -1"), 21);
}

struct Refused {
    const char* line;
    int code;
};

TEST(TwinLanguage, ErrorCodesOfTypedLines) {
    Bench b;
    b.type("VA Q1");
    b.program({"LB K1", "E"});
    for (const Refused& r : {Refused{"XX=1", 20},
                             {"PR", 20},
                             {"EM=4", 21},
                             {"VA FT", 24},
                             {"VA I7", 24},
                             {"VA PK", 24},
                             {"VA MR", 24},
                             {"EF=1", 25},
                             {"P=", 21},
                             {"IC MV", 25},
                             {"DC LM", 26},
                             {"IC AT", 26},
                             {"TE=2", 27},
                             {"VA Q1", 28},
                             {"VA K1", 28},
                             {"EX ZZ", 30},
                             {"OE ZZ", 30},
                             {"TP=100,ZZ", 30},
                             {"R1=ZZ", 30},
                             {"K1=5", 32},
                             {"RT=5", 33},
                             {"VM", 34},
                             {"EX VM", 34},
                             {"Q1", 34},
                             {"PR MR", 35},
                             {"PR ZZ", 35},
                             {"PR O1", 35},
                             {"PR P V", 38},
                             {"R1=1 2", 38},
                             {"E", 40},
                             {"PS", 40},
                             {"RS", 40},
                             {"EX 3", 42},
                             {"PG 99999", 42},
                             {"LB Z1", 46},
                             {"BR K1", 46},
                             {"H 10", 46},
                             {"HELLO", 60},
                             {"?", 60},
                             {"BD=77", 61},
                             {"EL=500", 37},
                             {"R1=5/0", 21},
                             {"R1=2147483647+1", 21},
                             {"ER=5", 21}}) {
        EXPECT_EQ(b.error_of(r.line), r.code) << r.line;
    }
    EXPECT_EQ(b.type("PR R1"), "0");
}

TEST(TwinLanguage, ProductsRefuseEachOthersWords) {
    struct Row {
        std::uint8_t product;
        const char* line;
        int code;
    };
    for (const Row& r : {Row{lmdo, "AS=1", 37},
                         {lmdc, "AS=1", 0},
                         {lmm, "AS=1", 37},
                         {lmm, "EL=500", 0},
                         {lmdc, "SA=1.8", 37},
                         {lmdo, "CF", 37},
                         {lmm, "FL=1", 37},
                         {lmdo, "PR LL", 37},
                         {lmm, "PR OF", 37},
                         {lmdo, "PR OF", 0},
                         {lmm, "PW=1,2,3,4", 0},
                         {lmdc, "VA PW", 0},
                         {lmm, "VA PW", 24}}) {
        DeviceSetup s;
        s.product = r.product;
        Bench b(s);
        EXPECT_EQ(b.error_of(r.line), r.code) << r.line << " on " << int{r.product};
    }
}

TEST(TwinLanguage, HundredNinetyTwoNames) {  // trap 16
    Bench b;
    int made = 0;
    for (char a = 'A'; a <= 'Z' && made < 192; ++a) {
        for (char d = '0'; d <= '9' && made < 192; ++d) {
            const std::string name{a, d};
            if (word_named(name)) continue;
            ASSERT_EQ(b.error_of("VA " + name), 0) << name;
            ++made;
        }
    }
    ASSERT_EQ(made, 192);
    EXPECT_EQ(b.error_of("VA ZZ"), 31);
}

TEST(TwinLanguage, LabelsWithoutCase) {
    Bench b;
    b.program({"LB K1", "PR \"here\"", "E"});
    EXPECT_NE(b.send("EX k1\r", milliseconds(20)).find("here"), std::string::npos);
}

TEST(TwinLanguage, PrintEscapesAndOpenEnd) {
    Bench b;
    EXPECT_EQ(shown(b.send("PR \"a\\tb\\g\\e\";\r")), "PR \"a\\tb\\g\\e\";<CR><LF>a<09>b<07><1B>>");
    EXPECT_EQ(b.type("PR \"Position = \",P"), "Position = 0");
    EXPECT_EQ(b.type("PR \"Position: \" P"), "Position: 0");  // [E-8]
    EXPECT_EQ(b.type("PR IN"), "00");                         // [E-61]
    EXPECT_EQ(b.type("PR IT,2"), "26");
    EXPECT_EQ(b.type("PR UV"), "");
    b.type("VA Q1=25");
    EXPECT_EQ(b.type("PR UV"), "Q1 = G 25");
    EXPECT_NE(b.type("PR AL").find("VM = 768000"), std::string::npos);
}

TEST(TwinLanguage, CountingLoop) {
    Bench b;
    EXPECT_EQ(b.run({"LB G1", "R1=0", "LB G2", "IC R1", "R2=R2+R1", "BR G2,R1<10", "PR R2", "E"}), "55<CR><LF>");
}

TEST(TwinLanguage, CallsNestAndOverflow) {
    Bench b;
    EXPECT_EQ(b.run({"LB G1", "CL K1", "PR \"back\"", "E", "LB K1", "CL K2,R1=0", "RT", "LB K2", "PR \"in\"", "RT"}),
              "in<CR><LF>back<CR><LF>");
    Bench deep;
    deep.program({"LB K1", "IC R1", "BR K2,R1>40", "CL K1", "LB K2", "E"});
    deep.type("EX K1", milliseconds(100));
    EXPECT_EQ(deep.type("PR ER"), "43");
}

TEST(TwinLanguage, HoldWaitsForTimeAndForMotionWithSettling) {  // trap 9
    Bench b;
    b.program({"LB K1", "H 200", "MR 768000", "H", "PR \"done\"", "E"});
    b.type("EX K1");
    b.send("", milliseconds(2100));
    EXPECT_EQ(b.type("PR MV"), "1") << "the motor has stopped, MT + HT run";
    b.sent.clear();
    const long calls = b.calls;
    b.send("", milliseconds(300));
    EXPECT_EQ(shown(b.sent), "done<CR><LF>");
    EXPECT_LT(b.calls - calls, 10) << "waiting costs nothing";
    EXPECT_EQ(b.type("PR MV"), "0");
}

TEST(TwinLanguage, HeldProgramCostsNothing) {
    Bench b;
    b.program({"LB K1", "H 65000", "E"});
    b.type("EX K1");
    const long calls = b.calls;
    b.pass(std::chrono::seconds(60));
    EXPECT_EQ(b.calls, calls);
    b.pass(std::chrono::seconds(6));
    EXPECT_EQ(b.type("PR BY"), "0");
}

TEST(TwinLanguage, EndlessLoopDoesNotHangTheDrive) {
    Bench b;
    b.program({"R1=0", "LB K1", "IC R1", "BR K1"});
    b.type("EX 1");
    b.pass(std::chrono::seconds(1));
    const int passes = std::stoi(b.type("PR R1"));  // 20 lines per ms, three of them in the loop
    EXPECT_GT(passes, 6600);
    EXPECT_LT(passes, 6800);
    EXPECT_EQ(b.type("PR BY"), "1");
    b.type("E");
    EXPECT_EQ(b.type("PR BY"), "0");
}

TEST(TwinLanguage, AHoldIsNotMadeUpFor) {
    Bench b;
    b.program({"H 1000", "LB K1", "IC R1", "BR K1"});
    b.type("EX 1", milliseconds(1100));
    const int passes = std::stoi(b.type("PR R1"));  // about 100 ms of 20 lines each, three per pass
    EXPECT_GT(passes, 600);
    EXPECT_LT(passes, 760);
}

TEST(TwinLanguage, TripsClearTheirOwnBitAlone) {  // trap 12
    Bench b;
    b.program({"LB K1", "PR \"trip \",P", "RT"});
    EXPECT_EQ(b.error_of("TE=2"), 27);
    b.type("TP=384000,K1");
    b.type("TT=60000,K1");
    b.type("TR=1000,0");
    EXPECT_EQ(b.error_of("TE=18"), 39);
    EXPECT_EQ(b.type("PR TE"), "0");
    b.type("TE=10");
    b.type("MR 768000");
    b.send("", milliseconds(700));
    EXPECT_NE(b.sent.find("trip 384000"), std::string::npos);
    EXPECT_EQ(b.type("PR TE"), "8");
    b.send("", std::chrono::seconds(60));
    EXPECT_NE(b.sent.find("trip 768000"), std::string::npos);
    EXPECT_EQ(b.type("PR TE"), "0");
    EXPECT_EQ(b.error_of("TC=K1"), 12);
    EXPECT_EQ(b.error_of("TT=0,K1"), 21);
}

TEST(TwinLanguage, TripInterruptsAHoldAndReturnsToIt) {
    Bench b;
    b.program({"LB K1", "TT=100,X1", "TE=8", "H 1000", "PR \"after\"", "E", "LB X1", "PR \"trip\"", "RT"});
    b.type("EX K1", milliseconds(1));
    EXPECT_EQ(shown(b.send("", milliseconds(900))), "trip<CR><LF>");
    EXPECT_EQ(shown(b.send("", milliseconds(200))), "after<CR><LF>");
}

TEST(TwinLanguage, ErrorHandlerRunsForTypedLinesToo) {  // trap 20
    Bench b;
    b.program({"LB K1", "PR \"Error! \" ER", "E"});
    b.type("OE K1");
    EXPECT_NE(b.send("QQQQ 1\r", milliseconds(20)).find("Error! 60"), std::string::npos);
    EXPECT_EQ(b.type("PR BY"), "0");
    b.type("PG 100");
    EXPECT_EQ(b.send("QQQQ 1\r", milliseconds(20)).find("Error!"), std::string::npos) << "not while programming";
    b.type("PG");
    Bench p;
    EXPECT_EQ(p.run({"LB G1", "OE K1", "R1=1/0", "PR \"next\"", "E", "LB K1", "PR \"e\",ER", "RT"}), "e21<CR><LF>next<CR><LF>");
}

TEST(TwinLanguage, WithoutHandlerTheProgramGoesOn) {  // [E-38]
    Bench b;
    EXPECT_EQ(b.run({"LB G1", "R1=1/0", "PR \"next\"", "E"}), "next<CR><LF>");
    EXPECT_EQ(b.type("PR ER"), "21");
}

TEST(TwinLanguage, InputToVariable) {
    Bench b;
    b.program({"VA K1", "LB G1", "IV K1", "LB X1", "BR X1,IF=1", "PR \"got \",K1", "E"});
    b.type("EX G1");
    EXPECT_EQ(b.type("PR IF"), "1");
    EXPECT_NE(b.send("-42\r", milliseconds(20)).find("got -42"), std::string::npos);
    EXPECT_EQ(b.type("PR IF"), "0");
    Bench twice;
    twice.program({"LB G1", "IV R1", "IV R2", "H 60000", "E"});
    twice.type("EX G1", milliseconds(20));
    EXPECT_EQ(twice.type("PR ER"), "62");
    twice.type("IF=0");
    EXPECT_EQ(twice.type("PR IF"), "0");
    EXPECT_EQ(twice.error_of("IF=1"), 21);
}

TEST(TwinLanguage, PauseAndResume) {
    Bench b;
    b.program({"LB K1", "IC R1", "H 10", "BR K1"});
    b.type("EX K1");
    b.type("PS");
    const std::string r = b.type("PR R1");
    b.pass(milliseconds(200));
    EXPECT_EQ(b.type("PR R1"), r);
    EXPECT_EQ(b.motor->pauses, 1);
    EXPECT_EQ(b.type("PR BY"), "1");
    b.type("RS");
    b.pass(milliseconds(200));
    EXPECT_NE(b.type("PR R1"), r);
    EXPECT_EQ(b.motor->resumes, 1);
    EXPECT_EQ(b.error_of("EX K1"), 41);
    EXPECT_EQ(b.error_of("CP"), 41);
    EXPECT_EQ(b.error_of("PG 1"), 41);
}

TEST(TwinLanguage, TypedEndWaitsForTheMotion) {
    Bench b;
    b.program({"LB K1", "MR 768000", "LB K2", "BR K2"});
    b.type("EX K1");
    b.type("E");
    EXPECT_EQ(b.type("PR BY"), "1");
    b.pass(milliseconds(2100));
    EXPECT_EQ(b.type("PR BY"), "0");
}

TEST(TwinLanguage, PartyFieldSendsTheName) {  // trap 13
    Bench b;
    b.type("MA 7680,1");
    b.pass(milliseconds(900));
    b.sent.clear();
    b.pass(milliseconds(300));
    EXPECT_EQ(b.sent, "!");
    b.type("MA 0");
    b.sent.clear();
    b.pass(milliseconds(2000));
    EXPECT_EQ(b.sent, "");
}

TEST(TwinLanguage, BareNumberRepeatsTheLastMotion) {
    Bench b;
    b.type("MA 1000", milliseconds(2000));
    EXPECT_EQ(b.error_of("2000"), 60);
    b.type("NE=1");
    b.type("2000", milliseconds(2000));
    EXPECT_EQ(b.type("PR P"), "2000");
    b.type("-5", milliseconds(2000));
    EXPECT_EQ(b.type("PR P"), "-5");
}

TEST(TwinLanguage, TraceStepAndBreakPoint) {
    Bench b;
    b.program({"LB K1", "IC R1", "BR K1,R1<5", "E"});
    b.type("EX K1,1", milliseconds(1));
    EXPECT_EQ(b.sent.substr(b.sent.find('>') + 1, 8), "1 LB K1\r");
    b.pass(milliseconds(50));
    EXPECT_EQ(b.type("PR R1"), "5");

    b.type("R1=0");
    b.type("EX K1,2");
    EXPECT_EQ(b.send(" "), "1 LB K1\r\n");
    EXPECT_EQ(b.send(" "), "7 IC R1\r\n");
    b.pass(std::chrono::seconds(1));
    EXPECT_EQ(b.type("PR R1"), "1");
    b.send("\r", milliseconds(50));
    EXPECT_EQ(b.type("PR R1"), "5");
    EXPECT_EQ(b.type("PR BY"), "0");

    b.type("R1=0");
    b.type("BP K1,3");
    b.type("EX K1,1", milliseconds(50));
    EXPECT_EQ(b.type("PR R1"), "2") << "stopped before the third pass";
    b.type("BP=0");
    b.send("\r", milliseconds(50));
    EXPECT_EQ(b.type("PR R1"), "5");
}

TEST(TwinLanguage, MotorEventsActOnTheProgram) {
    Bench b;
    b.program({"LB K1", "IC R1", "H 10", "BR K1"});
    b.motor->events.push_back({MotorEvent::Kind::go, 0, {}});
    EXPECT_EQ(b.type("PR BY"), "1");
    b.motor->events.push_back({MotorEvent::Kind::pause, 0, {}});
    b.type("A=1000");
    const std::string r = b.type("PR R1");
    b.pass(milliseconds(100));
    EXPECT_EQ(b.type("PR R1"), r);
    b.motor->events.push_back({MotorEvent::Kind::resume, 0, {}});
    b.type("A=1000", milliseconds(50));
    EXPECT_NE(b.type("PR R1"), r);
    b.motor->events.push_back({MotorEvent::Kind::end_program, 48, {}});
    b.type("A=1000");
    EXPECT_EQ(b.type("PR BY"), "0");
    EXPECT_EQ(b.type("PR ER"), "48");
    b.type("R1=9");
    b.motor->events.push_back({MotorEvent::Kind::reset, 0, {}});
    b.type("A=1000");
    EXPECT_EQ(b.type("PR R1"), "0");
}

TEST(TwinLanguage, ProgramThatPrintsFasterThanTheLine) {
    DeviceSetup s;
    s.bit_rate = 9600;
    Bench b(s);
    b.program({"LB K1", "PR \"0123456789012345678901234567890123456789\"", "BR K1,ER=0", "E"});
    b.type("EX K1", milliseconds(500));
    EXPECT_EQ(b.type("PR ER"), "66");
}

TEST(TwinLanguage, InterpreterIsFastEnough) {
    Symbols none;
    struct Nobody final : Host {
        Number read(Word, int&) override { return Number::of(1); }
        int write(Word, std::span<const Number>) override { return 0; }
        int perform(const Statement&, std::span<const Number>) override { return 0; }
        bool moving() override { return false; }
    } host;
    Program program;
    std::int32_t address = 1;
    for (const char* line : {"LB K1", "IC R1", "R2=R1+3", "R3=R2&7", "BR K1,R1<1000000000", "E"})
        ASSERT_EQ(program.enter(line, address), 0);
    twin::Run run(program, host);
    run.start(0);
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 200'000; ++i)
        ASSERT_EQ(run.step({}), 0);
    const double rate = 200'000 / std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    RecordProperty("statements_per_second", std::to_string(rate));
    std::printf("%.1f million statements per second\n", rate / 1e6);
    EXPECT_EQ(run.integer(0), 40'000);
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
