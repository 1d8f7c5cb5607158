// The whole drive on its wire: what FD does to a party line, TT, what is announced, names of the products, the cost of waiting.
// In: bytes. Out: bytes.
// Never tests words one by one: the tests of the language and of the motor do.
#include "adapters/mcode/tests/twin_wire.hpp"
#include "adapters/mcode/twin/switched.hpp"
#include "adapters/mcode/twin/twin.hpp"
#include "gateway/core/catalogue.hpp"

namespace axisgate::mcode::twin::test {
namespace {

TEST(TwinWire, FactoryDefaultsOnAPartyLineEndTheNameAndTheParty) {
    Wire w(lmdc, 'a');
    EXPECT_EQ(w.bytes("\n"), "");
    w.bytes("aA=5000\n");
    EXPECT_EQ(w.bytes("aFD\n"), "FD<CR><LF>>") << "the answer has the shape that the line had";
    EXPECT_EQ(w.bytes("PR DN\r"), "PR DN<CR><LF>!<CR><LF>>");
    EXPECT_EQ(w.ask("PR PY"), "0");
    EXPECT_EQ(w.ask("PR A"), "1000000");
    EXPECT_EQ(w.ask("PR EM"), "0");
    Wire after(lmdc, 'a', w.device->non_volatile());
    EXPECT_EQ(after.ask("PR DN"), "!") << "also after the power comes back";
    after.bytes("PY=1\r");
    after.bytes("\n");
    EXPECT_EQ(after.bytes("!PR PY\n"), "PR PY<CR><LF>1<CR><LF>>");
}

TEST(TwinWire, TripOnTimeCapturesThePositionOfItsInstant) {
    Wire w;
    w.program({"LB T1", "R1=R1+1", "RT", "LB G1", "TT=250,T1", "TE=8", "SL 100000", "H 5000", "SL 0", "H", "E"});
    w.lines({"A=1000000000", "VI=50000"});
    w.ask("EX G1", std::chrono::seconds(1));
    const std::int64_t captured = w.number("PC");
    // 250 ms at 100000 steps/s, less the ramp, which takes 50 us.
    EXPECT_NEAR(static_cast<double>(captured), 25000, 60);
    EXPECT_EQ(w.number("R1"), 1);
    EXPECT_EQ(w.number("TE"), 0);
    w.pass(std::chrono::seconds(1));
    EXPECT_EQ(w.number("PC"), captured) << "once: TE is not armed again";
}

TEST(TwinWire, WhatWasAnnouncedIsNotSaidOfAnotherMotion) {
    Wire w;
    w.ask("MA 768000,1");
    EXPECT_EQ(w.bytes("", std::chrono::seconds(5)), "!");
    w.ask("MR 768000,1");
    w.pass(milliseconds(500));
    w.ask("SL 50000");
    w.pass(std::chrono::seconds(2));
    w.ask("SL 0");
    EXPECT_EQ(w.bytes("", std::chrono::seconds(5)), "") << "the slew ended, not the move";
}

TEST(TwinWire, PgMayStandJoinedToItsAddress) {  // the manual's listing of 7.2.5
    Wire w;
    w.lines({"IS=4,4,0", "PG1", "MR 20000", "H", "MR -20000", "H", "E", "PG"});
    EXPECT_EQ(w.ask("L").substr(0, 10), "1 MR 20000");
    w.hand("inputs", std::int64_t{7});
    w.pass(milliseconds(100));
    EXPECT_EQ(w.number("BY"), 1);
    EXPECT_EQ(w.error_of("PGX"), 60);
}

TEST(TwinWire, NamesAndSuppliesAreThoseOfTheProduct) {
    EXPECT_EQ(Wire(lmdc).ask("PR VR"), "LMDCM 6.002, Hw: 3.2");
    EXPECT_EQ(Wire(lmdo).ask("PR VR"), "LMDOM 6.002, Hw: 3.2");
    EXPECT_EQ(Wire(lmm).ask("PR VR"), "LMMCM 6.002, Hw: 3.2");
    EXPECT_EQ(Wire(lmdc).ask("PR VT"), "0, 24, 48");
    EXPECT_EQ(Wire(lmm).ask("PR VT"), "1, 48") << "no auxiliary supply: status 1 is normal, and its field is missing";
}

TEST(TwinWire, APointIsNotGivenTheTypeThatItHas) {  // L8456: "IS/OS to the type the point already has"
    Wire w;
    for (const char* line :
         {"IS=1,1,0", "IS=2,1,0", "OS=1,17,1", "OS=2,17,0", "IS=3,0,0", "IS=3,0,0", "OS=3,16,0", "IS=3,13,1", "IS=4,13,1"})
        EXPECT_EQ(w.error_of(line), 0) << line;
    for (const char* line : {"IS=1,1,0", "IS=1,1,1", "OS=1,17,1"})
        EXPECT_EQ(w.error_of(line), 6) << line;
    EXPECT_EQ(w.error_of("IS=1,0,0"), 0);
    EXPECT_EQ(w.error_of("IS=1,1,1"), 0);
}

TEST(TwinWire, AnAddressInputOfTheModuleMakesPartyMode) {  // L5016
    Wire w(lmm);
    EXPECT_EQ(w.ask("PR PY"), "0");
    w.hand("address_input", Value{true});
    EXPECT_EQ(w.bytes("PR P\r"), "");
    EXPECT_EQ(w.bytes("\n!PR PY\n"), "PR PY<CR><LF>1<CR><LF>>");
    EXPECT_EQ(w.bytes("!PY=0\n"), "PY=0<CR><LF>>");
    EXPECT_EQ(w.bytes("!PR PY\n"), "PR PY<CR><LF>1<CR><LF>>") << "as long as it is active";
    w.bytes("!FD\n");
    EXPECT_EQ(w.bytes("\n!PR PY\n"), "PR PY<CR><LF>1<CR><LF>>");
    w.hand("address_input", Value{false});
    w.bytes("!PY=0\n");
    EXPECT_EQ(w.ask("PR PY"), "0");
    Out out;
    EXPECT_NE(Wire().device->set_hand("address_input", Value{true}, {}, out), "") << "only the module has them";
}

TEST(TwinWire, OneWordForEthernet) {
    for (const char* on : {"on", "true", "1"})
        EXPECT_TRUE(switched_on(on)) << on;
    for (const char* off : {"off", "false", "0", "", "ON!"})
        EXPECT_FALSE(switched_on(off)) << off;
    for (const auto& [text, code] :
         std::map<std::string, std::string>{{"on", "37"}, {"true", "37"}, {"1", "37"}, {"off", "0"}, {"0", "0"}}) {
        TwinSetup setup;
        setup.address = "!";
        setup.options["ethernet"] = text;
        auto twin = make_twin(Catalogue{}, setup);
        Out out;
        Instant now = Instant{} + std::chrono::seconds(1);
        twin->power_on({}, now, out);
        std::string sent;
        for (const std::string line : {"CK=0\r", "PR ER\r"}) {
            twin->on_frame(Frame::run({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}), now, out);
            now += milliseconds(5);
            twin->on_deadline(now, out);
        }
        for (const auto& tx : out.frames)
            sent.append(reinterpret_cast<const char*>(tx.frame.storage.data()), tx.frame.size);
        EXPECT_NE(sent.find("PR ER\r\n" + code + "\r\n"), std::string::npos) << text << ": " << shown(sent);
    }
}

TEST(TwinWire, AHoldCostsNothing) {
    Wire w;
    w.program({"LB G1", "H 60000", "R1=1", "E"});
    w.ask("EX G1");
    const long before = w.calls;
    EXPECT_GT(w.device->deadline() - w.now, std::chrono::seconds(59)) << "nothing is due before the hold ends";
    w.pass(std::chrono::seconds(59));
    EXPECT_EQ(w.calls, before);
    EXPECT_EQ(w.number("R1"), 0);
    w.pass(std::chrono::seconds(2));
    EXPECT_EQ(w.number("R1"), 1);
    EXPECT_EQ(w.number("BY"), 0);
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
