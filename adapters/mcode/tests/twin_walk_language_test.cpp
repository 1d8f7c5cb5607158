// The reference page by page: names, registers, operators, printing, programs. A row is a statement and what is said of it.
// In: tables; the comment behind a row is the line of the reference, E-nn an error of it and how that is settled.
// Never tests arithmetic at random: the reference evaluator does.
#include "adapters/mcode/tests/twin_walk.hpp"

namespace axisgate::mcode::twin::test {
namespace {

using Rows = std::vector<Row>;

Rows program(std::initializer_list<const char*> lines, const Rows& more) {
    Rows rows{{"PG 1", ""}};
    for (const char* l : lines)
        rows.push_back({l, ""});
    rows.push_back({"PG", ""});
    rows.insert(rows.end(), more.begin(), more.end());
    return rows;
}

// clang-format off
TEST(McodeManual, Names) {
    play({{"VA",
           {
               {"VA Q1=25", ""}, {"PR Q1", "25"}, {"PR UV", "Q1 = G 25"},           // L6036, L5972
               {"VA SP", ""}, {"SP = V", ""}, {"PR SP", "0"}, {"VA A1 7", ""}, {"PR A1", "7"}, {"VA B=3", ""},
               {"PR B", "3"},  // L554, L6022
               {"VA 1A", "!30"}, {"VA ABC", "!24"}, {"VA A_", "!24"}, {"VA", "!30"},  // L6027-6028
               {"VA Q1", "!28"}, {"VA q1", "!28"},                                  // L8472, L3767
               {"VA VM", "!24"}, {"VA MV", "!24"}, {"VA MR", "!24"}, {"VA UV", "!24"}, {"VA SQ", "!24"}, {"VA A", "!24"},  // L547, L6026
               {"VA FT", "!24"}, {"VA PK", "!24"}, {"VA I7", "!24"}, {"VA I13", "!24"},  // L3032, L3361
               {"Q1=2147483647", ""}, {"Q1=2147483648", "!21"}, {"Q1=-2147483648", ""}, {"Q1=-2147483649", "!21"},
               {"PR Q1", "-2147483648"},  // L543
               {"q1=5", ""}, {"PR Q1", "5"}, {"Q9=1", "!20"}, {"PR Q9", "!35"}, {"A=Q9", "!30"},
               {"Q1", "!34"},  // L8464, L8474, L8480, L8479
           }},
          {"local variables", program({"VA K5=4", "LB G1", "IC K5", "PR K5", "E"}, {
               {"EX 1", "5"}, {"EX 1", "5"}, {"PR UV", "K5 = L 5"},                  // L555
               {"VA K5", "!28"}, {"PR G1", "!30"}, {"G1=1", "!32"}, {"EX K5", "!34"},  // L8476, L8479
           })},
          {"LB",
           {
               {"PG 1", ""}, {"LB K1", ""}, {"LB Ks", ""}, {"LB K23", ""}, {"LB B", ""}, {"LB SU", ""}, {"LB PW", ""}, {"E", ""},
               {"PG", ""},  // L3765, L605
               {"EX k1", ""}, {"EX KS", ""}, {"EX k23", ""}, {"EX ZZ", "!30"},       // L3767, L2779
               {"PG 200", ""}, {"LB ABC", "?"}, {"PG", "?"}, {"PR ER", "24"}, {"PG 200", ""}, {"LB K2A", "?"}, {"PG", "?"},
               {"PR ER", "24"},  // L3765 E-9
               {"PG 200", ""}, {"LB MR", "?"}, {"PG", "?"}, {"PR ER", "29"}, {"PG 200", ""}, {"LB FT", "?"}, {"PG", "?"},
               {"PR ER", "24"},    // L3763 E-10
               {"PG 200", ""}, {"LB 1K", "?"}, {"PG", "?"}, {"PR ER", "30"}, {"PG 200", ""}, {"LB k1", "?"}, {"PG", "?"},
               {"PR ER", "28"},    // L3764
           }},
          {"PW as a name where it is no word",
           {
               {"VA PW=5", ""}, {"PR PW", "5"}, {"PW=PW+1", ""}, {"PR PW", "6"},     // L4970
           }}});
}

TEST(McodeManual, RegistersAndOperators) {
    play({{"R1 to R4",
           {
               {"PR R1", "0"}, {"R1=12345", ""}, {"PR R1", "12345"}, {"R2=2", ""}, {"R3=3", ""}, {"R1=R2+R3", ""},
               {"PR R1", "5"},  // L5076-5083
               {"R4=2147483647", ""}, {"PR R4", "2147483647"}, {"R4=2147483648", "!21"}, {"R4=-2147483647", ""},
               {"R4=-2147483648", "!21"},  // L5076
               {"PR R4", "-2147483647"}, {"R4 17", ""}, {"PR R4", "17"}, {"R5=1", "!20"},
           }},
          {"F1 to F8",
           {
               {"PR F8", "0.000000"}, {"F2=3.256", ""}, {"PR F2", "3.256000"}, {"R2=4", ""}, {"F1=R2 * F2", ""},
               {"PR F1", "13.024000"},  // L2826-2829
               {"F3=2.9", ""}, {"R2=F3", ""}, {"PR R2", "2"}, {"F3=-2.9", ""}, {"R2=F3", ""},
               {"PR R2", "-2"},                       // L2813 E-11
               {"VA Q1", ""}, {"Q1=F3", ""}, {"PR Q1", "-2"}, {"F5=1000.9", ""}, {"MA F5", ""}, {"~2000", "*"},
               {"PR P", "1000"},     // L2815
               {"A=F5", ""}, {"PR A", "1000"}, {"EM=F9", "!30"}, {"D1=255.9", ""}, {"PR D1", "255"}, {"D1=256.0", "!21"},
               {"F1=1.7976931348623157e308", ""}, {"F1=1.8e308", "!21"}, {"F1=1e999", "!21"}, {"F1=-1e999", "!21"},
               {"F1=9e99999999999999999999", "!21"},  // L2819
               {"F1=4.9406564584124655e-324", ""}, {"F2=F1*1e308", ""}, {"F1=1e-400", ""}, {"PR F1", "0.000000"}, {"F1=0e999", ""},
               {"PR F1", "0.000000"},  // L2820
               {"R1=1e999", "!21"}, {"MA 1e999", "!21"}, {"A=1e999", "!21"}, {"R1=1e-999", ""}, {"PR R1", "0"}, {"F9=1", "!20"},
           }},
          {"+ - * /",
           {
               {"VA Q1=25", ""}, {"VA Q2=30", ""}, {"VA Q3=40", ""}, {"R1=Q1+Q2+Q3", ""}, {"PR R1", "95"},  // L6297-6298
               {"R1=Q2-Q1", ""}, {"PR R1", "5"}, {"R1=Q1*Q2", ""}, {"PR R1", "750"}, {"F1=Q2/Q1", ""},
               {"PR F1", "1.200000"},  // L6317, L6335, L6355
               {"R1=Q2/Q1", ""}, {"PR R1", "1"}, {"R1=Q1/Q2", ""}, {"PR R1", "0"}, {"R1=-7/2", ""}, {"PR R1", "-3"},           // L1249 E-11
               {"R1=2+3*4", ""}, {"PR R1", "20"}, {"R1=1/0", "!21"}, {"F1=1/0", "!21"}, {"PR R1", "20"},                      // E-13
               {"A=Q1*1000", ""}, {"PR A", "25000"}, {"R1=Q1+", "!21"}, {"R1=", "!21"}, {"R1=Q1 Q2", "!38"},
           }},
          {"& | ^ !",
           {
               {"R1=25", ""}, {"R2=30", ""}, {"R3=R1&R2", ""}, {"PR R3", "24"}, {"R3=R1|R2", ""}, {"PR R3", "31"}, {"R3=R1^R2", ""},
               {"PR R3", "7"},  // E-14
               {"R3=!R1", ""}, {"PR R3", "-26"}, {"R3=R1 & 7", ""}, {"PR R3", "1"},  // L6548, L7769
           }},
          {"functions",
           {
               {"MA -51200", ""}, {"~3000", "*"}, {"PR P", "-51200"}, {"F1=AB P", ""}, {"PR F1", "51200.000000"},  // L6569-6571 E-62
               {"VA Q1=51200", ""}, {"F1=CS Q1", ""}, {"PR F1", "-0.106072"}, {"F2=C_ F1", ""}, {"PR F2", "1.677068"},  // L6591-6616
               {"F1=LO Q1", ""}, {"PR F1", "10.843495"}, {"F1=L_ Q1", ""}, {"PR F1", "4.709270"},                 // L6636 E-15, L6656
               {"F1=Q1*PI", ""}, {"PR F1", "160849.543885"}, {"F1=PI", ""}, {"PF=10,9", ""}, {"PR F1", "3.141592654"},
               {"PF=10,6", ""},  // L6676, L6664
               {"F1=SI Q1", ""}, {"PR F1", "-0.994358"}, {"F2=S_ F1", ""}, {"PR F2", "-1.464524"},                 // L6685, L6707
               {"F1=SQ Q1", ""}, {"PR F1", "226.274170"}, {"F1=TG Q1", ""}, {"PR F1", "9.374376"}, {"F1=T_ Q1", ""},
               {"PR F1", "1.570777"},  // L6727, L6747, L6767
               {"R2=-9", ""}, {"F1=AB R2", ""}, {"PR F1", "9.000000"}, {"F1=AB -R2", ""}, {"PR F1", "9.000000"}, {"F1=SQ -R2", ""},
               {"PR F1", "3.000000"},
               {"F1=SQ R2", "!21"}, {"F1=LO 0", "!21"}, {"F1=L_ 0", "!21"}, {"F1=LO -1", "!21"}, {"F1=S_ 1.5", "!21"},
               {"F1=C_ -1.5", "!21"}, {"PR F1", "3.000000"},
               {"R1=SQ 17", ""}, {"PR R1", "4"}, {"F1=SQ", "!21"}, {"SQ 4", "!60"}, {"PI", "!60"},                 // L1249
           }},
          {"RA",
           {
               {"PR RA", "1"}, {"RA=2", "!21"}, {"RA=0", ""}, {"PR RA", "0"}, {"F1=SI 30", ""}, {"PR F1", "0.500000"},
               {"F1=C_ 0.5", ""}, {"PR F1", "60.000000"},  // L5106-5115
           }}});
}

TEST(McodeManual, Comparisons) {
    struct Case {
        const char* q;
        const char* printed;
    };
    // <> = < <= > >= in this order, and I5=<2048 [L6391-6469, L3314].
    for (const Case& c : {Case{"VA Q1=24", "1347"}, Case{"VA Q1=25", "2467"}, Case{"VA Q1=26", "1567"}}) {
        Rows rows{{c.q, ""}};
        const Rows more = program({"LB G1", "CL X1, Q1<>25", "CL X2,Q1=25", "CL X3,Q1<25", "CL X4,Q1<=25", "CL X5,Q1>25", "CL X6,Q1>=25",
                                   "CL X7,I5=<2048", "E",
                                   "LB X1", "PR \"1\";", "RT", "LB X2", "PR \"2\";", "RT", "LB X3", "PR \"3\";", "RT",
                                   "LB X4", "PR \"4\";", "RT",
                                   "LB X5", "PR \"5\";", "RT", "LB X6", "PR \"6\";", "RT", "LB X7", "PR \"7\";", "RT"},
                                  {{"EX G1", "?"}, {"~50", "*"}});
        rows.insert(rows.end(), more.begin(), more.end());
        rows[rows.size() - 2] = {"EX G1", c.printed};
        play(Walk{c.q, rows});
    }
    play({{"bit test", program({"LB G1", "BR Q1,AF&2", "PR \"no\"", "BR Q1, AF&128", "E", "LB Q1", "PR \"yes\"", "E"},
                                {{"EX G1", "no|yes"}})},  // L1356
          {"a label, an address", program({"LB G1", "BR 25", "PR \"no\"", "PR \"at\"", "E"},
          {{"L", "1 LB G1|7 BR 25|13 PR \"no\"|21 PR \"at\"|29 E"}, {"EX G1", "?"}, {"PR ER", "42"}})},
          {"an address", program({"LB G1", "BR 21", "PR \"no\"", "PR \"at\"", "E"}, {{"EX 1", "at"}, {"EX 2", "!42"}})},  // L1804
          {"a missing target", program({"LB G1", "BR ZZ", "PR \"on\"", "E"}, {{"EX G1", "on"}, {"PR ER", "30"}})},
          {"only one condition", {{"PG 1", ""}, {"BR G1,R1=1,R2=2", "?"}, {"PG", "?"}, {"PR ER", "38"}}}});  // L1794
}

TEST(McodeManual, Printing) {
    play({{"PF",
           {
               {"PR PF", "10,6,0,0"}, {"PR F1", "0.000000"}, {"PF=8,4,1,1", ""}, {"PR F1", "0.0000E+00"},
               {"PR PF", "8,4,1,1"},  // L4766-4768
               {"PF=16,16,0,0", ""}, {"PF=17,6,0,0", "!21"}, {"PF=10,6,2,0", "!21"}, {"PF=10,6,0,2", "!21"}, {"PF=-1,6,0,0", "!21"},
               {"PF=1,1,1,1,1", "!21"},  // L4756-4759
               {"PF=0,0,0,0", ""}, {"F1=2.5", ""}, {"PR F1", "2"}, {"PF=5,2", ""}, {"F1=-1234567.891", ""},
               {"PR F1", "-1234567.89"},  // L4753: nothing is cut
               {"PF=5,2,1", ""}, {"PR F1", "-1.23E+06"}, {"F1=1e-300", ""}, {"PR F1", "1.00E-300"},
               {"PR R1", "0"},                   // integers stay plain
           }},
          {"PR",
           {
               {"P=12345", ""}, {"PR P", "12345"}, {"PR \"Position = \",P", "Position = 12345"},
               {"PR \"Position: \" P", "Position: 12345"},  // L4920-4921 E-8
               {"PR P,\" \",VM", "12345 768000"}, {"PR P VM", "!38"}, {"PR \"open", "!20"}, {"PR", "!20"}, {"PR MR", "!35"},
               {"PR EX", "!35"},  // L4895, L8480
               {"PR \"a\",\"b\"", "ab"}, {"PR\"x\"", "x"}, {"pr p", "12345"}, {"Pr P", "12345"},  // L6871
               {"PR \"it's\"", "it's"}, {"PR P 'comment", "12345"}, {"'only a comment", ""}, {"", ""},  // L626
               {"PR \"123456789012345678901234567890123456789012345678901234567\"",
                "123456789012345678901234567890123456789012345678901234567"},
           }},
          {"values in print", {{"PR EM", "0"}, {"PR IN", "15"}, {"PR MD", "*"}, {"PR AL", "*"}, {"PR 5", "5"},
                               {"R1=25", ""}, {"PR R1+1", "26"}, {"PR 30/R1", "1"},
                               {"F1=5", ""}, {"PR F1/2", "2.500000"}, {"PR F1", "5.000000"}}}});
}

TEST(McodeManual, ProgramWords) {
    play({{"PG, L and editing",
           {
               {"PG 0", "!42"}, {"PG 99999", "!42"}, {"PG 200", ""}, {"LB K1", ""}, {"PG", ""}, {"L", "200 LB K1"},
               {"L K1", "200 LB K1"}, {"L 200", "200 LB K1"},  // L894-898, L3728
               {"L ZZ", "!30"}, {"L 5", "!42"},
           }},
          {"joined address", {{"PG1", ""}, {"MR 20000", ""}, {"H", ""}, {"MR -20000", ""}, {"H", ""}, {"E", ""}, {"PG", ""},
          {"EX 1", ""}, {"~6000", "*"}, {"PR P", "0"}, {"PR BY", "0"}}},  // L7052
          {"EX and modes", program({"LB G1", "PR \"x\"", "E"}, {
               {"EX G1", "x"}, {"EX G1,0", "x"}, {"EX G1,1", "1 LB G1|7 PR \"x\"|x|14 E"}, {"EX G1,3", "!21"}, {"EX VM", "!34"},
               {"EX=G1", "!33"},  // L2781-2792
               {"EX G1, 2", "?"}, {"$20", "1 LB G1"}, {"$20", "7 PR \"x\"|x"},
               {"$20", "14 E"},                                             // L2784
           })},
          {"BP", program({"LB G1", "IC R1", "BR G1,R1<5", "E"}, {
               {"BP", "!40"}, {"BP G1, 3", ""}, {"EX G1,1", "?"}, {"~50", "*"}, {"PR R1", "2"}, {"PR BY", "1"}, {"BP=0", ""},
               {"$1B", "*"}, {"R1=0", ""}, {"EX G1,1", "?"}, {"~50", "*"}, {"PR R1", "5"},  // L1757-1768
               {"BP G1, 1", ""}, {"R1=0", ""}, {"EX G1", "?"}, {"~50", "*"}, {"PR R1", "5"},  // L1757: neither traced nor stepped
               {"BP ZZ", "!30"},
           })},
          {"E", program({"LB G1", "MR 200000", "LB G2", "BR G2"}, {
               {"E", "!40"}, {"EX G1", ""}, {"E", ""}, {"PR BY", "1"}, {"~3000", "*"}, {"PR BY", "0"}, {"PR P", "200000"},  // L2531
           })},
          {"H", program({"LB G1", "MA 512000", "H", "PR P", "H 1000", "PR \"later\"", "H 0", "H 65001", "E"}, {
               {"H", "!46"}, {"H 10", "!46"}, {"EX G1", ""}, {"~3000", "512000"}, {"~900", "later"}, {"PR ER", "21"},  // L3048-3058
           })},
          {"PS and RS", program({"LB G1", "SL 200000", "H 60000", "E"}, {
               {"PS", "!40"}, {"RS", "!40"}, {"EX G1", ""}, {"RS", "!40"}, {"~1000", "*"}, {"PS", ""}, {"~50", "*"},
               {"PR V", "~100000..180000"}, {"~1000", "*"}, {"PR V", "0"},  // L4940
               {"R1=5", ""}, {"PR R1", "5"}, {"PR BY", "1"}, {"PS", "!40"}, {"RS", ""}, {"~50", "*"}, {"PR V", "~1000..100000"},
               {"~1000", "*"}, {"PR V", "200000"},              // L5203-5205
           })},
          {"E ends a paused program", program({"LB G1", "SL 200000", "H 60000", "E"}, {
               {"EX G1", ""}, {"~1000", "*"}, {"PS", ""}, {"E", ""}, {"PR BY", "1"}, {"~2000", "*"}, {"PR BY", "0"}, {"PR V", "0"},
               {"RS", "!40"},  // L2531
           })},
          {"a pause ends with its program", program({"LB G1", "SL 200000", "H 60000", "E"}, {
               {"IS=1,5,1", ""}, {"IS=2,7,0", ""}, {"JE=1", ""}, {"@inputs 14", ""}, {"EX G1", ""}, {"~1000", "*"}, {"PS", ""},
               {"~2000", "*"}, {"$1B", "*"},
               {"SL 50000", ""}, {"~500", "*"}, {"@inputs 15", ""}, {"~1000", "*"}, {"PR ER", "91"},
               {"PR V", "0"},  // L776: not paused any more
               {"~1000", "*"}, {"@inputs 12", ""}, {"~1000", "*"}, {"PR V", "768000"}, {"@inputs 14", ""},           // L778
           })},
          {"IV and IF", program({"LB G1", "IV F1", "LB X2", "BR X2, IF=1", "PR F1", "E"}, {
               {"IV F1", "!46"}, {"EX G1", ""}, {"PR IF", "1"}, {"2.5", "*"}, {"~20", "*"}, {"PR F1", "2.500000"},
               {"PR BY", "0"},  // L3672-3674
               {"EX G1", ""}, {"IF=1", "!21"}, {"IF=0", "*"}, {"~20", "*"}, {"PR BY", "0"}, {"EX G1", ""}, {"", "*"},
               {"PR IF", "0"},  // L3404-3406
           })},
          {"IV wants what can be written", program({"LB G1", "IV V", "IV ZZ", "IV K1", "PR IF", "E", "LB K1"}, {{"EX G1", "0"},
          {"PR ER", "30"}})},  // L3661
          {"CL and RT", program({"LB K1", "CL X1", "PR \"back\"", "E", "LB X1", "PR \"in\"", "RT"}, {
               {"EX K1", "in|back"}, {"RT", "!46"}, {"CL X1", "!46"}, {"LB Z1", "!46"},  // L917-928, L2121
           })},
          {"a blank condition", program({"LB K1", "CL X1,", "PR \"back\"", "BR X2,", "PR \"no\"", "LB X2", "E", "LB X1", "PR \"in\"", "RT"},
                                        {{"EX K1", "in|back"}})},  // L2117
          {"stack", program({"LB G1", "IC R1", "CL G1", "E"}, {{"EX G1", "?"}, {"~100", "*"}, {"PR ER", "43"}})},  // L8489
          {"words that are for typing only",
           {
               {"PG 1", ""}, {"EX G1", "?"}, {"L", "?"}, {"CP", "?"}, {"FD", "?"}, {"RS", "?"}, {"UG 2656102", "?"}, {"PG", "?"},
               {"PR ER", "60"}, {"L", ""},  // usage of L1404-5937
           }},
          {"rollover counter",
           {
               {"VA Xr=0", ""}, {"PG 1", ""}, {"LB X1", ""}, {"CL X2, C1>=2000000000", ""}, {"BR X1", ""}, {"LB X2", ""}, {"IC Xr", ""},
               {"PR Xr", ""}, {"PR C1", ""}, {"C1=0", ""}, {"RT", ""}, {"E", ""}, {"PG", ""},  // L1889-1896
               {"C1=1999990000", ""}, {"EX X1", ""}, {"SL 100000", ""}, {"~1000", "*"}, {"PR Xr", "1"}, {"PR C1", "~1000..100000"},
           }}});
}

TEST(McodeManual, ConditionsOfThePages) {
    struct Example {
        const char* line;
        Rows before;
        bool taken;
    };
    const std::vector<Example> examples{
        {"BR LP, I1=1", {{"@active_inputs 1", ""}}, true},                       // L532
        {"BR SP, MV = 0", {}, true},                                             // L566
        {"BR K5, I2=0", {}, true},                                               // L805
        {"CL Q1, AF=4", {}, false},                                              // L1357
        {"BR Q1, AV>10000", {{"AS=1", ""}, {"SL 50000", ""}, {"~500", "*"}}, true},  // L1558
        {"BR Q1, I1=1", {{"@active_inputs 1", ""}}, true},                       // L1812
        {"BR Q1, ST=1", {}, false},                                              // L1799
        {"BR Q1, V1<=10", {{"VA V1=10", ""}}, true},                             // L1800
        {"BR Q1, C1=512000", {{"C1=512000", ""}}, true},                         // L1877
        {"CL X5, C1=512000", {{"C1=511999", ""}}, false},                        // L1878
        {"BR Q1, C2=40000", {{"C2=40000", ""}}, true},                           // L1934
        {"CL X5, C2=40000", {{"C2=40001", ""}}, false},                          // L1935
        {"CL Q3, I1=1", {}, false},                                              // L2129
        {"BR Q1, ER=86", {}, false},                                             // L2718
        {"CL Z2, ER=104", {}, false},                                            // L2719
        {"BR L2, I3=1", {{"@active_inputs 4", ""}}, true},                       // L3283
        {"CL Q5, I4=0", {}, true},                                               // L3284
        {"BR L2, I5>2048", {{"@analog 2049", ""}}, true},                        // L3313
        {"CL Q5, I5=<2048", {{"@analog 2048", ""}}, true},                       // L3314
        {"BR L2, I6=0", {{"MR 5000", ""}, {"~3000", "*"}}, true},                // L3344
        {"CL Q5, I5=1", {}, false},                                              // L3345
        {"BR L5, IN=07", {{"@inputs 7", ""}}, true},                             // L3447
        {"CL K3, IN=13", {{"@inputs 13", ""}}, true},                            // L3448
        {"CL k5, LL>102500", {}, false},                                         // L3879
        {"CL Q1,OF=1", {{"@output_fault 1", ""}}, true},                         // L4592
        {"CL Q2, R1<25", {}, true},                                              // L5084
        {"CL Q1, VC=1", {{"SL 2000000", ""}}, true},                             // L6070
        {"CL X1, I1=1", {{"@active_inputs 1", ""}}, true},                       // L6374
    };
    for (const Example& e : examples) {
        const std::string name = std::string(e.line).substr(3, 2), label = "LB " + name;
        Rows rows{{"@active_inputs 0", ""}};
        for (const Row& r : e.before)
            if (std::string_view(r.line).starts_with("VA ")) rows.push_back(r);
        for (const char* l : {"PG 1", "LB G1", e.line, "PR \"on\"", "E", label.c_str(), "PR \"taken\"", "E", "PG"})
            rows.push_back({l, ""});
        for (const Row& r : e.before)
            if (!std::string_view(r.line).starts_with("VA ")) rows.push_back(r);
        rows.push_back({"EX G1", e.taken ? "taken" : "on"});
        play(Walk{e.line, rows});
    }
}

TEST(McodeManual, NamesOfInstructionsAreNotValues) {
    Wire w;
    for (const WordInfo& i : words) {
        const std::string word(i.text);
        if (i.kind == WordKind::instruction && word != "PG") EXPECT_EQ(w.error_of("R1=" + word), 30) << word;
        if (i.kind == WordKind::instruction || i.kind == WordKind::trip) {
            const int code = w.error_of("PR " + word);
            EXPECT_EQ(code, 35) << word;
        }
        if (i.kind == WordKind::keyword && i.access == Access::ro) EXPECT_EQ(w.error_of(word + "=1"), 25) << word;
        if (i.access == Access::ro && (i.kind == WordKind::variable || i.kind == WordKind::flag)) {
            EXPECT_EQ(w.error_of(word + "=1"), 25) << word;  // L8470
            EXPECT_EQ(w.error_of("IC " + word), 25) << word;
        }
        if (word != "PW" && word != "SU") EXPECT_EQ(w.error_of("VA " + word), 24) << word;  // L547
    }
}

// clang-format on
}  // namespace
}  // namespace axisgate::mcode::twin::test
