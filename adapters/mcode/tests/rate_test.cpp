// Bit rate after factory defaults, values that PR has with an index, and settings of I/O points that a drive has already.
// In: commands to real twins and fakes. Out: what is reported, what line.setup recovers, what a write says.
#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

std::vector<Notice> reported(const LineBench& b, std::string_view kind) {
    std::vector<Notice> some;
    for (const auto& n : b.notices) {
        if (n.kind == kind) some.push_back(n);
    }
    return some;
}
void power_cycle(LineBench& b) {
    b.hand(0, "power", Value{false});
    b.run(2s);
    b.hand(0, "power", Value{true});
    b.run(12s);
}

TEST(McodeRate, FactoryDefaultsAtAnotherRateAreReportedAndRecovered) {
    for (const bool recover : {false, true}) {
        LineBench b("!", 115200);
        b.run(4s);
        ASSERT_TRUE(b.online());
        EXPECT_TRUE(reported(b, "bit_rate").empty()) << "a drive that is set to its line is no news";
        const Result r = b.wait(Action{"factory_defaults", ""});
        ASSERT_EQ(r.outcome, Outcome::done) << r.text;
        for (const std::string& text : {r.text, reported(b, "bit_rate").empty() ? std::string() : reported(b, "bit_rate")[0].text}) {
            for (const char* part : {"BD=96", "9600", "115200", "line.setup", "not heard"})
                EXPECT_NE(text.find(part), std::string::npos) << part << ": " << text;
        }
        EXPECT_TRUE(b.online()) << "the old rate holds until the restart";
        if (recover) EXPECT_EQ(b.wait(Action{"line.setup", "save"}).outcome, Outcome::done);
        power_cycle(b);
        EXPECT_EQ(b.online(), recover);
        if (!recover) {
            const Result none = b.wait(Action{"line.setup", "save"});
            EXPECT_EQ(none.outcome, Outcome::refused);
            EXPECT_NE(none.text.find("baud=9600"), std::string::npos) << none.text;
        }
    }
}

TEST(McodeRate, ADriveThatIsGoneWithItsFactoryRateIsNamedSo) {
    Bench b({'!'});
    b.setup.bit_rate = 19200;
    b.drives[0].values["BD"] = "19";
    b.up();
    b.run(2s);
    ASSERT_TRUE(b.online());
    b.drives[0].deaf_after = "FD";
    const Ticket t = b.command(Action{"factory_defaults", ""});
    b.run(8s);
    EXPECT_FALSE(b.online());
    EXPECT_NE(b.links.back().text.find("since FD"), std::string::npos) << b.links.back().text;
    EXPECT_NE(b.links.back().text.find("baud=9600"), std::string::npos);
    ASSERT_TRUE(b.result(t));
    EXPECT_EQ(b.result(t)->outcome, Outcome::failed);
    EXPECT_NE(b.result(t)->text.find("since FD"), std::string::npos) << b.result(t)->text;
}

TEST(McodeRate, AFreshDriveThatIsNamedGetsTheRateOfTheLineToo) {
    LineBench b("a", 19200, {}, "!");
    b.run(2s);
    // As after FD by somebody's terminal: single mode, and BD = 96 for the next start.
    for (const char* text : {"\r", "FD\r"}) {
        const std::string bytes = text;
        EXPECT_TRUE(b.bus->send(Frame::run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}), Priority::command, b.now));
        b.run(100ms);
    }
    EXPECT_EQ(b.wait(Action{"line.setup", "save"}).outcome, Outcome::done);
    b.run(1s);
    power_cycle(b);
    EXPECT_TRUE(b.online()) << "it has kept its name and the rate of the line";
    EXPECT_TRUE(reported(b, "bit_rate").empty());
}

TEST(McodeRate, FactoryDefaultsAreRefusedWhileItMoves) {
    LineBench b("!", 9600);
    b.run(4s);
    ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = 5000;
    ASSERT_EQ(b.wait(m).outcome, Outcome::accepted);
    b.run(300ms);
    EXPECT_EQ(b.wait(Action{"factory_defaults", ""}).reason, Reason::wrong_state);
}

/// PR VT and PR IT take the number of one value [L3615, L6203]: each is a parameter of its own.
TEST(McodeIndexed, VoltagesAndTemperaturesAreReadOneByOne) {
    for (const char* product : {"LMDC", "LMDO", "LMM"}) {
        LineBench b("ab", 19200, {{"product", product}});
        b.run(6s);
        ASSERT_TRUE(b.online());
        for (const char* id : {"VT1", "IT1", "IT2", "VT2"}) {
            if (std::string(product) == "LMM" && std::string(id) == "VT2") continue;  // one supply
            const auto point = catalogue().find(id);
            ASSERT_TRUE(point) << id;
            const Result r = b.wait(ReadParameter{*point});
            EXPECT_EQ(r.outcome, Outcome::done) << product << id << r.text;
            const auto value = as_integer(r.value);
            ASSERT_TRUE(value) << product << id << r.text;
            const bool volt = id[0] == 'V';
            EXPECT_TRUE(volt ? *value >= 5 && *value < 60 : *value >= 10 && *value <= 100) << product << id << *value;
            const Result whole = b.wait(ReadParameter{*catalogue().find(volt ? "VT" : "IT")});
            EXPECT_NE(to_text(whole.value).find(std::to_string(*value)), std::string::npos) << product << id << to_text(whole.value);
        }
    }
}

/// E-12, E-15: what the manual leaves open can be chosen.
TEST(McodeModel, PaddingAndTheBaseOfLoAreOptions) {
    for (const bool on : {false, true}) {
        LineBench b("!", 19200,
                    on ? std::map<std::string, std::string>{{"pad", "on"}, {"log_base", "2"}} : std::map<std::string, std::string>{});
        b.run(4s);
        const auto ask = [&](std::string_view s) { return b.wait(Native{{s.begin(), s.end()}, true}).text; };
        EXPECT_EQ(ask("PR \"[\",F1,\"]\""), on ? "[  0.000000]" : "[0.000000]");
        (void)ask("PF=12,3,0,1");
        EXPECT_EQ(ask("PR \"[\",F1,\"]\""), on ? "[0.000       ]" : "[0.000]");
        (void)ask("F1=LO 51200");
        EXPECT_EQ(ask("PR \"[\",F1").substr(1, 6), on ? "15.644" : "10.843");
    }
}

/// An open loop has no encoder, and none of its words.
TEST(McodeModel, AnOpenLoopHasNoWordsOfAnEncoder) {
    LineBench b("!", 19200, {{"product", "LMDO"}});
    b.run(4s);
    for (const char* w : {"ST=1", "ST=0", "C2=5", "DB=70000", "EE=1", "HI 1"}) {
        const std::string_view s = w;
        const Result r = b.wait(Native{{s.begin(), s.end()}, true});
        EXPECT_EQ(r.code, 37) << w << r.text;
        EXPECT_FALSE(r.bytes.empty()) << "what came back, for reply_hex";
    }
}

/// Error 6 has two readings: this point has the type, or another one has it. What the drive shows decides.
TEST(McodeIoSetup, ErrorSixIsNoErrorWhereTheSettingIsInForce) {
    const auto is = catalogue().find("IS");
    ASSERT_TRUE(is);
    Bench b;
    b.drives[0].values["IS"] = "IS = 1, 1, 0\r\nIS = 2, 0, 0";
    b.up();
    b.run(2s);
    b.drives[0].refuse = {{"IS=1,1,0", 6}, {"IS=2,1,0", 6}};
    EXPECT_EQ(b.wait(WriteParameter{*is, Value{std::string("1,1,0")}}).outcome, Outcome::done);
    const Result other = b.wait(WriteParameter{*is, Value{std::string("2,1,0")}});
    EXPECT_EQ(other.outcome, Outcome::refused);
    EXPECT_EQ(other.code, 6);
    EXPECT_NE(other.text.find("type 0 first"), std::string::npos) << other.text;
    LineBench twin("a", 19200);
    twin.run(4s);
    for (const char* v : {"1,1,0", "1,1,0", "2,1,0"})
        EXPECT_EQ(twin.wait(WriteParameter{*is, Value{std::string(v)}}).outcome, Outcome::done) << v;
    EXPECT_EQ(twin.wait(WriteParameter{*is, Value{std::string("1,1,1")}}).code, 6) << "the level alone cannot be changed";
}

}  // namespace
}  // namespace axisgate::mcode::test
