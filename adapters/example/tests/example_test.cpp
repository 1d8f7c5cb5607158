// The wire format, decoder and adapter of the example drive: recorded telegrams, requests that wait for a late answer, and a stop that
// overtakes others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "adapters/example/adapter.hpp"
#include "adapters/example/decoder.hpp"

namespace axisgate::example::test {
namespace {
using namespace std::chrono_literals;
using testing::ElementsAre;

const Catalogue& catalogue() {
    static const Catalogue c = [] {
        std::ifstream f(AXISGATE_SOURCE_DIR "/schema/families/example.json");
        std::stringstream s;
        s << f.rdbuf();
        std::vector<std::string> faults;
        auto parsed = Catalogue::parse(s.str(), faults);
        for (const auto& fault : faults)
            ADD_FAILURE() << fault;
        return *std::move(parsed);
    }();
    return c;
}
Frame frame(const std::string& text) { return Frame::run({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}); }

TEST(ExampleWire, GoldenTelegramsAreReadAndWrittenAgain) {
    std::ifstream f(AXISGATE_SOURCE_DIR "/adapters/example/vectors.txt");
    std::string line;
    int seen = 0;
    while (std::getline(f, line)) {
        if (line.size() < 3 || (line[0] != '>' && line[0] != '<')) continue;
        bool request = false;
        const auto t = telegram_of(line.substr(2), request);
        ASSERT_TRUE(t) << line;
        EXPECT_EQ(request, line[0] == '>');
        EXPECT_EQ(text_of(*t, request), line.substr(2) + "\r");
        ++seen;
        for (std::size_t i = 2; i < line.size(); ++i) {  // every other character makes it another telegram, or an invalid one
            std::string bad = line.substr(2);
            bad[i - 2] = bad[i - 2] == 'Z' ? 'Y' : 'Z';
            EXPECT_FALSE(telegram_of(bad, request)) << bad;
        }
    }
    EXPECT_GE(seen, 28);
}

TEST(ExampleWire, TheDecoderSaysWhatItIs) {
    LineDecoder d;
    EXPECT_THAT(d.on_frame(frame(text_of({5, 1, "R21", Telegram::Kind::value, "1500"}, true)), true),
                ElementsAre("to drive 5 axis 1: R21 = 1500"));
    EXPECT_THAT(d.on_frame(frame(text_of({5, 1, "R21", Telegram::Kind::refused, "14"}, false)), false),
                ElementsAre("drive 5 axis 1: R21 is refused: 14"));
    EXPECT_THAT(d.on_frame(frame("@0\x01!\r"), true), ElementsAre("unknown, no telegram: @0.!"));
    EXPECT_TRUE(d.finish().empty());
}

// A bounded recording has the last runs: it begins and ends anywhere in a telegram.
TEST(ExampleWire, ARecordingCutAtAnyByteIsReadAndNothingOfItIsStrange) {
    const std::string half = text_of({5, 1, "R21", Telegram::Kind::value, "1500"}, true);
    const std::string all = half + text_of({5, 1, "R21", Telegram::Kind::refused, "14"}, false) + half;
    for (std::size_t from = 0; from <= all.size(); ++from)
        for (std::size_t to = from; to <= all.size(); ++to) {
            LineDecoder d;
            auto lines = d.on_frame(frame(all.substr(from, to - from)), std::nullopt);
            std::ranges::move(d.finish(), std::back_inserter(lines));
            std::size_t shown = 0;
            for (const auto& line : lines) {
                EXPECT_THAT(line, testing::Not(testing::HasSubstr("unknown"))) << from << ".." << to;
                shown += line.starts_with("to drive 5") ? 1 : 0;
            }
            EXPECT_EQ(shown, (from == 0 && to >= half.size() ? 1U : 0U) + (from <= all.size() - half.size() && to == all.size() ? 1U : 0U));
            const bool only_an_end = all.substr(from, to - from).find_first_not_of('\r') == std::string::npos;
            EXPECT_EQ(lines.empty(), only_an_end) << "what has a character is told of";
        }
}

/// A drive whose answers the test gives.
struct Bench : testing::Test {
    LineAdapter adapter{catalogue()};
    Instant now = time_zero + 1h;
    Out out;
    std::vector<Telegram> sent;
    std::vector<Result> results;

    void SetUp() override {
        LineSetup line;
        line.bit_rate = 57600;
        DriveSetup d;
        d.id = DriveId{1};
        d.name = "feeder";
        d.address = "5";
        d.axes = {{AxisId{10}, 1}, {AxisId{12}, 3}};
        line.drives = {d};
        adapter.configure(line, now, out);
        adapter.on_line(true, now, out);
        take();
        answer("R01", "100");
        for (int axis : {1, 3})
            answer("S00", "1,700,0,700,0", axis);
        results.clear();
    }
    void take() {
        for (const auto& tx : out.frames) {
            bool request = false;
            const std::string text(reinterpret_cast<const char*>(tx.frame.data().data()), tx.frame.size - 1u);
            const auto t = telegram_of(text, request);
            ASSERT_TRUE(t && request) << text;
            sent.push_back(*t);
        }
        results.insert(results.end(), out.results.begin(), out.results.end());
        out.clear();
    }
    void answer(const std::string& item, const std::string& text, int axis = 1, Telegram::Kind kind = Telegram::Kind::value) {
        adapter.on_frame(frame(text_of({5, axis, item, kind, text}, false)), now, out);
        take();
    }
    void pass(Duration d) {
        for (const Instant end = now + d; adapter.deadline() <= end;) {
            now = std::max(now, adapter.deadline());
            adapter.on_deadline(now, out);
            take();
        }
    }
    void command(Ticket n, CommandBody b, AxisId axis = AxisId{10}) {
        adapter.on_command({n, axis, std::move(b), false, {}}, now, out);
        take();
    }
    [[nodiscard]] std::string last() const { return sent.back().item + static_cast<char>(sent.back().kind) + sent.back().text; }
};

TEST_F(Bench, ARelativeMoveReadsThePlaceFirst) {
    Move m;
    m.kind = Move::Kind::relative;
    m.target = 50;
    m.velocity = 900;
    command(1, m);
    EXPECT_EQ(last(), "R06=900");
    answer("R06", "900");
    EXPECT_EQ(last(), "S00?");
    answer("S00", "1,800,0,800,0");
    EXPECT_EQ(last(), "R21=850");
    EXPECT_TRUE(results.empty());
    adapter.on_frame(frame(text_of({5, 1, "R21", Telegram::Kind::value, "850"}, false)), now, out);
    ASSERT_EQ(out.feedback.size(), 1u);
    EXPECT_FALSE(out.feedback[0].value.target_reached);
    take();
    ASSERT_EQ(results.size(), 1u);
    EXPECT_EQ(results[0].outcome, Outcome::accepted);
}

TEST_F(Bench, AStopGoesBehindTheExchangeInProgressAndEndsWhatWaitsOfItsAxis) {
    Move m;
    m.target = 5;
    command(1, m);
    command(2, m);
    command(3, m, AxisId{12});
    command(4, Halt{});
    ASSERT_EQ(results.size(), 2u);
    EXPECT_EQ(results[0].reason, Reason::interrupted);
    EXPECT_EQ(last(), "R21=5") << "one request at a time";
    answer("R21", "5");
    EXPECT_EQ(last(), "R23=0");
    answer("R23", "0");
    EXPECT_EQ(results.back().ticket, 4u);
    EXPECT_EQ(results.back().outcome, Outcome::accepted);
    pass(1ms);
    EXPECT_EQ(sent.back().axis, 3) << "the other axis' motion goes on";
}

TEST_F(Bench, ALateAnswerIsNotTakenForANewOne) {
    command(1, ReadParameter{*catalogue().find("R10")});
    const std::size_t before = sent.size();
    pass(300ms);
    ASSERT_EQ(results.size(), 1u);
    EXPECT_EQ(results[0].reason, Reason::no_answer);
    EXPECT_GE(std::ranges::count(sent, std::string("R10"), &Telegram::item), 3) << "repeated twice";
    EXPECT_GT(sent.size(), before);
    ASSERT_EQ(last(), "S00?") << "the line goes on";
    const std::size_t asked = sent.size();
    command(2, ReadParameter{*catalogue().find("R10")});
    EXPECT_EQ(sent.size(), asked) << "one request at a time";
    answer("S00", "1,700,0,700,0", sent.back().axis);
    EXPECT_EQ(last(), "R10?") << "behind another answer";
}

TEST_F(Bench, ARefusalHasItsCodeAndItsWords) {
    command(1, WriteParameter{*catalogue().find("R10"), Value{std::int64_t{7}}});
    answer("R10", "12", 1, Telegram::Kind::refused);
    ASSERT_EQ(results.size(), 1u);
    EXPECT_EQ(results[0].code, 12);
    EXPECT_THAT(results[0].text, testing::HasSubstr("outside the register's range"));
}

}  // namespace
}  // namespace axisgate::example::test
