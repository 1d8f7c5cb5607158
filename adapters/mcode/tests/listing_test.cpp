// What a drive lists, over lines of every rate and kind, with real twins: whole, or not at all; and a link that is set anew each time.
// In: programs of several kilobytes, rates, echo and checksum modes, a cable that hiccups. Out: the text as it was stored.
// Never sleeps: the time is the bus's.
#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

/// Some two kilobytes of program, with text in it that looks like a closing answer.
std::string long_program() {
    std::string s = "LB AA\n";
    for (int i = 0; i < 40; ++i)
        s += "PR \"line " + std::to_string(1000 + i) + " of a long listing #a0,0,0\"\n";
    return s + "E\n";
}

struct Way {
    std::string_view names;
    std::uint32_t rate;
    const char* em;
    const char* ck;
};

TEST(McodeListing, IsWholeAtEveryRateInEveryEchoAndChecksumMode) {
    std::vector<Way> ways;
    for (const std::uint32_t rate : {1200U, 4800U, 9600U, 19200U, 38400U, 115200U, 0U})
        for (const std::string_view names : {"!", "ab"})
            ways.push_back({names, rate, "1", "1"});
    for (const char* em : {"0", "1", "2", "3"})
        for (const char* ck : {"0", "1", "2"})
            ways.push_back({"!", 9600, em, ck});
    for (const Way& w : ways) {
        SCOPED_TRACE(testing::Message() << w.names << " at " << w.rate << " em " << w.em << " ck " << w.ck);
        LineBench b(w.names, w.rate, {{"em", w.em}, {"ck", w.ck}});
        b.run(20s);
        ASSERT_TRUE(b.online());
        ASSERT_EQ(b.wait(Action{"program.download", long_program()}, 0, 400s).outcome, Outcome::done);
        ASSERT_EQ(b.wait(line("VA Q1=25"), 0, 20s).outcome, Outcome::done);
        const auto collisions = b.bus->counters().collisions;  // fresh drives that still echo make some
        const Result up = b.wait(Action{"program.upload", ""}, 0, 60s);
        ASSERT_EQ(up.outcome, Outcome::done) << up.text;
        EXPECT_EQ(up.text, long_program());
        const Result list = b.wait(Action{"program.list", ""}, 0, 60s);
        EXPECT_EQ(std::ranges::count(list.text, '\n'), 41) << list.text;
        const Result all = b.wait(line("PR AL"), 0, 60s);
        EXPECT_NE(all.text.find("\nVM = 768000"), std::string::npos) << all.text;
        EXPECT_NE(all.text.find("WT = "), std::string::npos) << "the last word: " << all.text;
        EXPECT_EQ(b.wait(line("PR UV"), 0, 20s).text, "Q1 = G 25");
        EXPECT_EQ(b.wait(line("PR VM"), 0, 20s).text, "768000") << "and not the text of the question before";
        EXPECT_EQ(b.bus->counters().collisions, collisions) << "nobody spoke into the answer";
        EXPECT_TRUE(b.online());
    }
}

/// A converter that holds bytes back for longer than any silence of a line: the listing goes on behind it.
TEST(McodeListing, GoesOnBehindAHiccupOfTheCable) {
    for (const char* ck : {"0", "1"}) {
        LineBench b("!", 9600, {{"ck", ck}});
        b.run(4s);
        ASSERT_EQ(b.wait(Action{"program.download", long_program()}, 0, 60s).outcome, Outcome::done);
        std::size_t passed = 0;
        std::string kept;
        Instant until{};
        b.on_cable = [&](std::string bytes) {
            passed += bytes.size();
            kept += bytes;
            if (passed > 900 && until == Instant{}) until = b.now + 150ms;
            if (b.now < until) return std::string();
            return std::exchange(kept, {});
        };
        const Result up = b.wait(Action{"program.upload", ""}, 0, 60s);
        EXPECT_EQ(up.outcome, Outcome::done) << up.text;
        EXPECT_EQ(up.text, long_program());
        EXPECT_GT(b.now, until);
    }
}

TEST(McodeListing, WithoutItsEndItIsNoListing) {
    LineBench b("!", 9600, {{"ck", "1"}});
    b.run(4s);
    ASSERT_EQ(b.wait(Action{"program.download", long_program()}, 0, 60s).outcome, Outcome::done);
    std::size_t passed = 0;
    b.on_cable = [&](std::string bytes) { return (passed += bytes.size()) > 700 ? std::string() : bytes; };
    const Result cut = b.wait(Action{"program.upload", ""}, 0, 60s);
    EXPECT_EQ(cut.outcome, Outcome::failed);
    EXPECT_NE(cut.text.find("end"), std::string::npos) << cut.text;

    // Bytes lost in the middle: the checksum behind it tells, and it is asked again.
    b.on_cable = nullptr;
    b.run(5s);
    ASSERT_TRUE(b.online());
    passed = 0;
    bool lost = false;
    b.on_cable = [&](std::string bytes) {
        if ((passed += bytes.size()) > 700 && !std::exchange(lost, true)) return std::string();
        return bytes;
    };
    const Result again = b.wait(Action{"program.upload", ""}, 0, 60s);
    EXPECT_TRUE(lost);
    EXPECT_EQ(again.outcome, Outcome::done) << again.text;
    EXPECT_EQ(again.text, long_program());
}

/// A question of a client changes nothing: where its answer is spoilt on the way, it is asked again.
TEST(McodeListing, AQuestionWhoseAnswerIsSpoiltIsAskedAgain) {
    LineBench b("!", 9600, {{"ck", "1"}});
    b.run(4s);
    for (const std::string& question : {std::string("PR P"), std::string("PR AL")}) {
        for (std::size_t at = 0; at < 40; ++at) {
            const Native native{{question.begin(), question.end()}, true};
            std::size_t came = 0;
            b.on_cable = [&](std::string bytes) {
                for (char& c : bytes)
                    if (came++ == at) c = static_cast<char>(c ^ 0x04);
                return bytes;
            };
            const Result r = b.wait(native, 0, 20s);
            EXPECT_TRUE(good(r)) << question << " at " << at << ": " << r.text;
            if (question == "PR P") EXPECT_EQ(r.text, "0") << at;
            if (came <= at) break;  // the spoilt byte would have been behind the answer
        }
    }
}

/// What the drive lists is what there is: read, written one by one or as a whole, and given back.
TEST(McodeListing, UserVariablesAreAParameterOfTheAxis) {
    LineBench b("a", 19200);
    b.run(4s);
    const Point all = *catalogue().find("variables");
    EXPECT_EQ(to_text(b.wait(ReadParameter{all}).value), "");
    ASSERT_EQ(b.wait(Action{"VA", "Q1=25"}).outcome, Outcome::done);
    ASSERT_EQ(b.wait(Action{"VA", "Z=-7"}).outcome, Outcome::done);
    const std::string before = to_text(b.wait(ReadParameter{all}).value);
    EXPECT_EQ(before, "Q1 = G 25\r\nZ = G -7");
    EXPECT_EQ(b.wait(Action{"UV", ""}).text, before);
    const Result one = b.wait(WriteParameter{all, Value{std::string("q1=26")}});
    EXPECT_EQ(one.outcome, Outcome::done) << one.text;
    EXPECT_EQ(to_text(one.value), "Q1 = G 26\r\nZ = G -7");
    const Result back = b.wait(WriteParameter{all, Value{before}});
    EXPECT_EQ(back.outcome, Outcome::done) << back.text;
    EXPECT_EQ(to_text(back.value), before) << "as a snapshot writes it";
    EXPECT_EQ(b.wait(WriteParameter{all, Value{std::string("X9=1")}}).code, 20) << "not declared";
    for (const char* wrong : {"VM=5", "Q1", "Q1=1.5", "Q1=3000000000", "", "MA 100", "Q1=1\nDE=0"}) {
        const auto sent = b.sent.size();
        EXPECT_EQ(b.wait(WriteParameter{all, Value{std::string(wrong)}}).outcome, Outcome::refused) << wrong;
        for (auto i = sent; i < b.sent.size(); ++i)
            EXPECT_NE(b.sent[i].bytes.find("PR \"#"), std::string::npos) << wrong << ": nothing but polls: " << b.sent[i].bytes;
    }
    EXPECT_NE(b.wait(Action{"AL", ""}, 0, 20s).text.find("VM = 768000"), std::string::npos);
}

/// What a listing complains of is its result, with the drive's code.
TEST(McodeListing, ARefusalHasItsCode) {
    for (const char* ck : {"0", "1"}) {
        LineBench b("a", 19200, {{"ck", ck}});
        b.run(4s);
        ASSERT_EQ(b.wait(line("LK=1")).outcome, Outcome::done);
        const Result r = b.wait(Action{"program.upload", ""});
        EXPECT_EQ(r.outcome, Outcome::refused) << r.text;
        EXPECT_EQ(r.code, 44) << r.text;
    }
}

/// Power comes back: EM, CK, ES and CE are those of the drive's memory, and are set anew, however often that happens.
TEST(McodeListing, TheLinkIsSetAnewAfterEachPowerCycle) {
    LineBench b("ab", 19200);
    b.run(5s);
    for (int round = 0; round < 6; ++round) {
        b.hand(0, "power", Value{false});
        b.run(3s);
        EXPECT_FALSE(b.online());
        b.hand(0, "power", Value{true});
        b.run(20s);
        ASSERT_TRUE(b.online()) << round;
        for (const auto& [what, is] : std::map<std::string, std::string>{{"EM", "1"}, {"CK", "1"}, {"ES", "3"}, {"CE", "2"}}) {
            const Result r = b.wait(ReadParameter{*catalogue().find(what)});
            EXPECT_EQ(to_text(r.value), is) << what << " in round " << round;
        }
    }
}

}  // namespace
}  // namespace axisgate::mcode::test
