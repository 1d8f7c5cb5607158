// The manual's sample programs (section 9) on the twin's language: they load without an error, and do what is said of them.
// In: the listings with their repairs noted. Out: printed text, stored lines.
// Never tests the motor's accuracy: positions are those of the plain motor of the bench.
#include "adapters/mcode/tests/twin_bench.hpp"

namespace axisgate::mcode::twin::test {
namespace {

void load(Bench& b, const std::vector<std::string>& lines) {
    for (const auto& l : lines) {
        b.type(l);
        ASSERT_EQ(b.prompt, '>') << l << ": error " << b.type("PR ER");
    }
}

TEST(TwinListings, MoveOnAnInput) {  // 9.1
    Bench b;
    load(b, {"Ms=256",
             "Vi=200000",
             "Vm=2500000",
             "A=1000000",
             "D=A",
             "Hc=2",
             "Rc=75",
             "P=0",
             "PG 1",
             "LB Ga      'Program execution label",
             "P=0",
             "LB G1      'Loop back label",
             "  CL Kb,I1=1",
             "  H 10",
             "  BR G1",
             "E",
             "LB Kb      'subroutine label",
             "  MA 512000",
             "  H",
             "  MA 0",
             "  H",
             "  RT",
             "PG          'exit program",
             "S",
             "'Keep this line to save program on load"});
    EXPECT_EQ(b.type("PR D"), "1000000");
    b.type("EX Ga", std::chrono::seconds(1));
    EXPECT_EQ(b.type("PR MV"), "0");
    b.motor->values[Word::I1] = 1;
    b.pass(milliseconds(900));
    EXPECT_EQ(b.type("PR P"), "512000");
    b.motor->values[Word::I1] = 0;
    b.pass(std::chrono::seconds(5));
    EXPECT_EQ(b.type("PR P"), "0");
    EXPECT_EQ(b.type("PR BY"), "1");
}

TEST(TwinListings, ChangeVelocityDuringAMove) {  // 9.2; D=8000000000 is beyond 32 bits [E-51] and left at 8000000 here
    Bench b;
    load(b, {"Hc=20",       "Rc=100",
             "PG 1",        "LB Ga",
             "Vi=20000",    "Vm=500000",
             "A=500000",    "D=8000000",
             "R1=0",        "R2=0",
             "LB Gx",       "P=0",
             "Tp=51200,Kb", "Te=2",
             "SL 101200",   "H",
             "H 250",       "IC R1",
             "R2=R2+P",     "BR Gx,R1<10",
             "R2=R2/10",    "PR \"Average end pos = \",R2",
             "E",           "LB Kb",
             "SL 202400",   "Tp=102290,Kc",
             "Te=2",        "RT",
             "LB Kc",       "SL 0",
             "H",           "RT",
             "PG",          "S"});
    b.type("EX Ga");
    b.sent.clear();
    b.pass(std::chrono::seconds(60));
    ASSERT_TRUE(b.sent.starts_with("Average end pos = ")) << shown(b.sent);
    EXPECT_NEAR(std::stod(b.sent.substr(18)), 102290, 15000);
}

TEST(TwinListings, BinaryMask) {  // 9.3
    Bench b;
    std::vector<std::string> lines{"PG 1",
                                   "LB Su",
                                   "  P=0",
                                   "LB G1",
                                   "  R1=In",
                                   "  R1=R1 & 7",
                                   "  CL K0,R1 = 0",
                                   "  CL K5,R1 = 5",
                                   "  H 10",
                                   "  BR G1",
                                   "  E",
                                   "LB K0",
                                   "  PR \"Logic 000\"",
                                   "  MR R1*51200",
                                   "  H",
                                   "  H 2000",
                                   "  RT",
                                   "LB K5",
                                   "  PR \"Logic 101\"",
                                   "  MR R1*51200",
                                   "  H",
                                   "  H 200",
                                   "  RT",
                                   "PG",
                                   "S"};
    load(b, lines);
    b.send("\x03", std::chrono::seconds(1));
    EXPECT_NE(b.sent.find("Logic 000"), std::string::npos);
    b.motor->values[Word::IN] = 13;
    b.send("", std::chrono::seconds(10));
    EXPECT_NE(b.sent.find("Logic 101"), std::string::npos);
    EXPECT_GE(std::stoi(b.type("PR P")), 256000);
}

TEST(TwinListings, ClosedLoopWithErrorHandler) {  // 9.4
    Bench b;
    load(b, {"Rc=80",
             "Mt=50",
             "As = 0",
             "Ee=1",
             "Sf=15",
             "Sm=0",
             "VA Q1",
             "PG 1",
             "LB Ga",
             "    OE K1",
             "    P=0",
             "LB Gb",
             "    MR 51200",
             "    H",
             "    H 500",
             "    MR -51200",
             "    H",
             "    H 500",
             "    IC Q1",
             "    BR Gb,Q1<3",
             "    CL K1",
             "E",
             "LB k1",
             "    R3=C1/25",
             "    R1=R3 - C2",
             "    PR \"Counts error = \",R1",
             "    PR \"Error = \",Er",
             "    Er=0",
             "    H 20",
             "    RT",
             "PG",
             "S"});
    b.type("EX Ga");
    b.sent.clear();
    b.pass(std::chrono::seconds(20));
    EXPECT_EQ(shown(b.sent), "Counts error = 0<CR><LF>Error = 0<CR><LF>");
    EXPECT_EQ(b.type("PR Q1"), "3");
}

TEST(TwinListings, UserInputIntoVariables) {  // 9.5
    Bench b;
    load(b, {"VA K1=0",
             "VA K2=0",
             "VA K3=51200",
             "VA K4=0",
             "PG 1",
             "  LB Su",
             "  P=-0",
             "  PR \"At Home Position\"",
             "  H 2000",
             "  LB Z1",
             "    PR \"Enter the number of revolutions in whole numbers\"",
             "    IV K1",
             "    LB X1",
             "    BR X1, If=1",
             "    H 50",
             "  LB X4",
             "    PR \"Enter rotation direction (0) neg. (1) pos.\"",
             "    IV K2",
             "    LB X2",
             "    BR X2, If=1",
             "    H 50",
             "    BR Y1,K2=0",
             "    BR Y2, K2=1",
             "    PR \"Invalid Entry\"",
             "    BR X4",
             "LB X6",
             "  VA K5",
             "  K5=P/K3",
             "  PR \"Axis position is \", K5, \" absolute from home\"",
             "  H 3000",
             "LB X5",
             "  PR \"Repeat program (1) or quit (0)\"",
             "  IV K4",
             "  LB X3",
             "  BR X3, If=1",
             "  BR Z1, K4=1",
             "  BR Z2, K4=0",
             "  PR \"Invalid Entry\"",
             "  BR X5",
             "LB Y1",
             "  MR -K3*K1",
             "  H",
             "  BR X6",
             "LB Y2",
             "  MR K3*K1",
             "  H",
             "  BR X6",
             "LB Z2",
             "PR \"Program Ended\"",
             "E",
             "PG",
             "S"});
    b.send("\x03", std::chrono::seconds(3));
    EXPECT_NE(b.sent.find("Enter the number"), std::string::npos);
    EXPECT_NE(b.send("3\r", std::chrono::seconds(1)).find("Enter rotation direction"), std::string::npos);
    EXPECT_NE(b.send("5\r", std::chrono::seconds(1)).find("Invalid Entry"), std::string::npos);
    EXPECT_NE(b.send("0\r", std::chrono::seconds(2)).find("Axis position is -3 absolute from home"), std::string::npos);
    b.pass(std::chrono::seconds(4));
    EXPECT_NE(b.send("0\r", std::chrono::seconds(1)).find("Program Ended"), std::string::npos);
    EXPECT_EQ(b.type("PR BY"), "0");
    EXPECT_EQ(b.type("PR P"), "-153600");
}

TEST(TwinListings, InputTrip) {  // 9.7
    Bench b;
    load(b, {"VA Q1",
             "D1=255",
             "PG 1",
             "LB G1",
             "  Ti = 1, X1",
             "  Te = 1",
             "  LB G2",
             "  Q1 = 0",
             "  BR G2",
             "E",
             "LB X1",
             "  IC Q1",
             "  MR 51200",
             "  H",
             "  MR -51200",
             "  H",
             "  BR X1, Q1 < 4",
             "  Te = 1",
             "  RT",
             "  E",
             "PG      ' End of Program",
             "S"});
    b.type("EX G1", std::chrono::seconds(1));
    EXPECT_EQ(b.type("PR TE"), "1");
    b.motor->events.push_back({MotorEvent::Kind::trip, 0, Word::TI});
    b.type("A=1000000");
    EXPECT_EQ(b.type("PR TE"), "0");
    b.pass(std::chrono::seconds(5));
    EXPECT_EQ(b.type("PR Q1"), "3");
    b.pass(std::chrono::seconds(6));
    EXPECT_EQ(b.type("PR TE"), "1");
    EXPECT_EQ(b.type("PR Q1"), "0");
    EXPECT_EQ(b.type("PR ER"), "0");
}

TEST(TwinListings, AnalogSpeedControl) {  // 9.9
    Bench b;
    load(b, {"A=2000000",
             "D=2000000",
             "R4=80",
             "PG 1",
             "LB G1",
             "  R1 = I5",
             "  CL Z1",
             "  SL R3",
             "  H 10",
             "  BR G1",
             "E",
             "LB Z1",
             "  R1 = R1-2032",
             "  R2 = 1",
             "  BR Z2, R1>=0",
             "  R2 = -1",
             "  R1 = R1 * R2",
             "LB Z2",
             "  BR Z3, R1<R4",
             "  R1 = R1 * 625",
             "  R3 = R1 * R2",
             "RT",
             "LB Z3",
             "  R3=0",
             "RT",
             "E",
             "PG",
             "S"});
    b.motor->values[Word::I5] = 1000;
    b.type("EX G1", std::chrono::seconds(1));
    EXPECT_EQ(b.type("PR V"), "-645000");
    b.motor->values[Word::I5] = 2100;
    b.pass(std::chrono::seconds(1));
    EXPECT_EQ(b.type("PR V"), "0");
}

TEST(TwinListings, AnalogSlewWithStall) {  // 9.10
    Bench b;
    load(b, {"As=0",
             "Ee=1",
             "Sf=30",
             "PG 1",
             "LB Su",
             "  OE X1",
             "  Er=0",
             "  R1=I5",
             "  R1=R1*50",
             "  SL R1",
             "  PR V",
             "  H 250",
             "  BR Su",
             "E",
             "LB X1",
             "  PR \"Error! \" Er",
             "LB Y1",
             "  BR Y2,Er <> 86",
             "  PR \"Stall\"",
             "LB Y2",
             "  Er=0",
             "E",
             "PG ' End of Program",
             "S"});
    b.motor->values[Word::I5] = 100;
    b.type("EX Su", std::chrono::seconds(1));
    b.sent.clear();
    b.motor->events.push_back({MotorEvent::Kind::error, 86, {}});
    b.pass(std::chrono::seconds(1));
    // PR ER clears ER, so the comparison after it does not find 86: the listing as printed says no more than this.
    EXPECT_NE(b.sent.find("Error! 86"), std::string::npos) << shown(b.sent);
    EXPECT_EQ(b.type("PR BY"), "0");
}

TEST(TwinListings, SpeedProfileByTrips) {  // 9.11, of which the first half is lost [E-52]: declarations added
    Bench b;
    load(b, {"VA Ds=51200",
             "VA Sp=28160",
             "PG 1",
             "LB G1",
             "P=0",
             "Vm=Sp",
             "MA Ds*9,0,1",
             "Tp Ds*2,X1",
             "Te=2",
             "H 60000",
             "E",
             "LB X1",
             "PR \" Starting Step 2  P=\",P,\"  V=\",V",
             "Vm= Sp*2",
             "MA Ds*9,0,1",
             "Tp Ds*3,X2",
             "Te=2",
             "RT",
             "LB X2",
             "PR \" Starting Step 3  P=\",P,\"  V=\",V",
             "Vm= Sp*3",
             "MA Ds*9 ,0,1",
             "RT",
             "PG",
             "S"});
    b.type("EX G1");
    b.sent.clear();
    b.pass(std::chrono::seconds(10));
    EXPECT_NE(b.sent.find(" Starting Step 2  P=102"), std::string::npos) << shown(b.sent);
    EXPECT_NE(b.sent.find(" Starting Step 3  P=153"), std::string::npos) << shown(b.sent);
    EXPECT_EQ(b.type("PR VM"), "84480");
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
