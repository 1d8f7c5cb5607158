// The twin's time: a drive that is called late has done everything at the instant of its cause; and what the link takes and answers.
// In: lines at instants, deadlines met at once, in steps or at the end alone. Out: the same bytes at the same instants.
// Never sleeps: time is an argument.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "adapters/mcode/tests/twin_bench.hpp"
#include "adapters/mcode/twin/twin.hpp"
#include "gateway/core/catalogue.hpp"

namespace axisgate::mcode::twin::test {
namespace {

const Catalogue& catalogue_of_twin() {
    static const auto c = [] {
        std::ifstream in(std::string(AXISGATE_SOURCE_DIR) + "/schema/families/mcode.json");
        std::stringstream s;
        s << in.rdbuf();
        std::vector<std::string> faults;
        return *Catalogue::parse(s.str(), faults);
    }();
    return c;
}

struct Bytes {
    Instant at;
    std::string text;
    bool operator==(const Bytes&) const = default;
};
void PrintTo(const Bytes& b, std::ostream* o) { *o << b.at.time_since_epoch() / std::chrono::microseconds(1) << " us: " << shown(b.text); }

class Late {
public:
    explicit Late(Duration step) : step_(step) {
        TwinSetup s;
        s.address = "!";
        twin_ = make_twin(catalogue_of_twin(), s);
        twin_->power_on({}, now_, out_);
    }
    void type(const std::string& line) {
        pass(milliseconds(5));
        const std::string bytes = line + "\r";
        Frame f = Frame::run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
        f.at = now_;
        twin_->on_frame(f, now_, out_);
        take();
    }
    void pass(Duration d) {
        const Instant end = now_ + d;
        while (step_ > Duration::zero() && now_ < end) {
            now_ = std::min({now_ + step_, end, std::max(twin_->deadline(), now_ + std::chrono::microseconds(1))});
            call();
        }
        now_ = end;
    }
    void call() {
        twin_->on_deadline(now_, out_);
        take();
    }
    std::vector<Bytes> reported;
    Twin& twin() { return *twin_; }
    Instant now() const { return now_; }

private:
    void take() {
        for (const auto& tx : out_.frames) {
            const std::string text(reinterpret_cast<const char*>(tx.frame.storage.data()), tx.frame.size);
            if (!reported.empty() && reported.back().at == tx.frame.at) {
                reported.back().text += text;
            } else {
                reported.push_back({tx.frame.at, text});
            }
        }
        out_.clear();
    }
    Duration step_;
    Instant now_ = Instant{} + std::chrono::seconds(1);
    std::unique_ptr<Twin> twin_;
    Out out_;
};

/// A program moves; a trip on the way, a hold, a timed trip and the end of the motion each say when they were.
std::vector<Bytes> story(Duration step) {
    Late l(step);
    for (const char* line : {"EM=1",
                             "PG 1",
                             "LB AA",
                             "PR \"tp \",P",
                             "RT",
                             "LB X1",
                             "PR \"tt \",P",
                             "RT",
                             "LB BB",
                             "TP=102290,AA",
                             "TT=777,X1",
                             "TE=10",
                             "MR 200000",
                             "H 250",
                             "PR \"held \",P",
                             "H",
                             "PR \"there \",P",
                             "MR -1000",
                             "H",
                             "PR \"back \",P",
                             "E",
                             "PG",
                             "EX BB"})
        l.type(line);
    l.reported.clear();
    l.pass(std::chrono::seconds(6));
    l.call();
    l.type("PR \"last \",P,BY,MV,\" \",ER");
    l.pass(milliseconds(10));
    l.call();
    return l.reported;
}

TEST(McodeTwinTime, WhatHappensStandsAtTheInstantOfItsCauseHoweverLateTheCall) {
    const auto right = story(std::chrono::microseconds(500));
    std::string all;
    for (const Bytes& b : right)
        all += b.text;
    for (const char* what : {"tp 1022", "tt ", "held ", "there 200000", "back 199000", "last 19900000 0"})
        EXPECT_NE(all.find(what), std::string::npos) << what << " in " << all;
    for (const Duration step : {Duration{milliseconds(340)}, Duration{std::chrono::seconds(2)}, Duration{}})
        EXPECT_EQ(story(step), right) << step / milliseconds(1) << " ms";
}

/// An endless program and a host that comes back after a minute: bounded work, and the drive goes on.
TEST(McodeTwinTime, AnEndlessProgramAndAVeryLateCallCostABoundedTime) {
    Late l(Duration{});
    for (const char* line : {"EM=1", "PG 1", "LB AA", "IC R1", "BR AA", "PG", "EX AA"})
        l.type(line);
    for (int i = 0; i < 3; ++i) {
        l.pass(std::chrono::minutes(10));
        l.call();
    }
    l.reported.clear();
    l.type("PR BY");
    l.pass(milliseconds(5));
    l.call();
    ASSERT_FALSE(l.reported.empty());
    EXPECT_NE(l.reported.back().text.find('1'), std::string::npos);
}

TEST(McodeTwinLink, TheSixtyFifthCharacterShowsTheErrorAtThePrompt) {
    Bench b;
    EXPECT_EQ(shown(b.send(std::string(65, 'A'))), std::string(65, 'A') + "<CR><LF>?");
    (void)b.send("\r");
    EXPECT_EQ(b.type("PR ER"), "20");
}

TEST(McodeTwinLink, OverEthernetABareLineFeedEndsALineAndTheLinksWordsAre37) {
    DeviceSetup s;
    s.ethernet = true;
    Bench b(s);
    (void)b.send("EM=1\r\n");
    for (const char* line : {"PR 5\n", "PR 5\r\n", "PR 5\r"})
        EXPECT_EQ(shown(b.send(line)), "<CR><LF>5<CR><LF>") << shown(line);
    EXPECT_EQ(shown(b.send("PR 6\nPR 7\r\nPR 8\n")), "<CR><LF>6<CR><LF><CR><LF>7<CR><LF><CR><LF>8<CR><LF>");
    for (const char* line : {"DN=a", "DN=\"a\"", "PR DN", "PY=1", "BD=1", "CK=x", "QD=1,2", "DG"}) {
        (void)b.send(std::string(line) + "\r");
        EXPECT_EQ(shown(b.send("PR ER\r")), "<CR><LF>37<CR><LF>") << line;
    }
    Bench serial;
    (void)serial.send("EM=1\r");
    EXPECT_EQ(shown(serial.send("PR 5\n")), "") << "LF is nothing in single mode of the serial link";
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
