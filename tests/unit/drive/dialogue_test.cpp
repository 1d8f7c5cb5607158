// Dialogue and LineAdapter of the kit, with a language of one letter and a number: what goes out, in which order, and what it means.
// In: calls of an adapter, answers. Out: messages, results. Rules that hold whatever the language is.
#include "gateway/drive/dialogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gateway/drive/line_adapter.hpp"
#include "gateway/drive/text_lines.hpp"

namespace axisgate::drive {
namespace {
using namespace std::chrono_literals;
using testing::ElementsAre;

/// Letters: i who is it, j another question, s state (its value is where it is; 1000 and more: it moves; negative: it is off), v speed, a
/// ramp, m move, e enable, h halt.
struct Letter {
    int channel = 1;
    char what = 'i';
    std::int64_t value = 0;
    bool no = false;
    [[nodiscard]] bool operator==(const Letter&) const = default;
    [[nodiscard]] std::string text() const { return fmt::format("{}{}{}", channel, what, value); }
};

class ToyDrive final : public Dialogue<Letter, 2> {
public:
    using Dialogue::Dialogue;

private:
    [[nodiscard]] Frame frame_of(const Letter& m) const override { return Frame::run(bytes_of(m.text())); }
    [[nodiscard]] Letter mark_of(const Letter& m) const override { return {m.channel, m.what, 0, false}; }
    [[nodiscard]] bool answers(const Letter& q, const Letter& a) const override { return q.what != 'm' || q.value == a.value; }
    [[nodiscard]] Reported reported(const Letter& a) const override { return {a.no, a.no ? 7 : 0, std::to_string(a.no ? 7 : a.value)}; }
    [[nodiscard]] Letter probe(bool other) const override { return {1, other ? 'j' : 'i', 0, false}; }
    [[nodiscard]] std::string title(const Letter*) const override { return "toy"; }
    [[nodiscard]] Letter poll(int channel) const override { return {channel, 's', 0, false}; }
    [[nodiscard]] int learn(const Letter& a) override {
        if (a.what != 's') return 0;
        axis(a.channel).power = a.value < 0 ? AxisFeedback::Power::off : AxisFeedback::Power::on;
        axis(a.channel).position = a.value;
        axis(a.channel).moving = a.value >= 1000;
        return a.channel;
    }
    [[nodiscard]] Letter stop(const Command& c) const override { return {channel_of(c.axis), 'h', 0, false}; }
    [[nodiscard]] std::string plan(Job& job, Reason&) const override {
        const int channel = channel_of(job.command.axis);
        if (std::holds_alternative<Native>(job.command.body)) return job.steps.push_back({channel, 'n', 1, false}), "";
        if (std::holds_alternative<Enable>(job.command.body)) return job.steps.push_back({channel, 'e', 1, false}), "";
        const auto* move = std::get_if<Move>(&job.command.body);
        if (!move) return "a toy only moves";
        if (move->acceleration) job.steps.push_back({channel, 'a', *move->acceleration, false});
        if (move->velocity) job.steps.push_back({channel, 'v', *move->velocity, false});
        job.steps.push_back({channel, 'm', move->target, false});
        return {};
    }
    [[nodiscard]] std::string words_of(const Letter& m) const override { return m.text(); }
};

class ToyAdapter final : public TurnsAdapter<ToyDrive> {
public:
    explicit ToyAdapter(const Catalogue& c) : TurnsAdapter(bus_), bus_(c) {}
    void arrived(const Frame&, Turn&) override {}
    void answer(const Letter& a, Instant now, Out& out) {
        Turn t{now, out};
        ToyDrive& d = *drives().at(0);
        d.on_message(a, t);
        settle(d, t);
        end(t);
    }

private:
    void take(const LineSetup& setup, Turn&) override { bus_.take(setup, {.reply_timeout = 50ms}); }
    [[nodiscard]] std::string fault(const DriveSetup& d, const LineSetup&) const override { return d.address == "1" ? "" : "no address"; }
    [[nodiscard]] std::unique_ptr<ToyDrive> make(const DriveSetup& s, std::size_t slot, Turn&) override {
        return std::make_unique<ToyDrive>(bus_, s, slot);
    }
    Bus bus_;
};

struct ToyLine : testing::Test {
    std::vector<std::string> faults;
    Catalogue catalogue = *Catalogue::parse(R"({"family": "toy", "number": 9, "parameters": [], "commands": [], "errors": []})", faults);
    ToyAdapter adapter{catalogue};
    LineSetup line;
    Instant now = time_zero + 1h;
    Out out;
    std::vector<std::string> sent;
    std::string last;
    std::vector<Priority> priorities;
    std::vector<Result> results;
    bool waiting = false;  ///< for an answer

    void SetUp() override {
        DriveSetup d;
        d.id = DriveId{1};
        d.name = "feeder";
        d.address = "1";
        d.axes = {{AxisId{1}, 1}, {AxisId{2}, 2}};
        line.drives = {d};
        adapter.configure(line, now, out);
        adapter.on_line(true, now, out);
        take();
        answer('i', 0);
        answer('s', 0);
        answer('s', 0, 2);
        sent.clear();
        priorities.clear();
    }
    void take() {
        waiting = waiting || !out.frames.empty();
        for (const auto& tx : out.frames) {
            sent.emplace_back(last = text_of(tx.frame));
            priorities.push_back(tx.priority);
        }
        results.insert(results.end(), out.results.begin(), out.results.end());
    }
    void answer(char what, std::int64_t value, int channel = 1, bool no = false) {
        out.clear();
        waiting = false;
        adapter.answer({channel, what, value, no}, now, out);
        take();
    }
    void command(Ticket n, CommandBody body, std::uint16_t axis = 1) {
        out.clear();
        adapter.on_command({n, AxisId{axis}, std::move(body), false, {}}, now, out);
        take();
    }
    void stream(std::int64_t value, std::optional<std::int64_t> velocity) {
        SetPoint p;
        p.axis = AxisId{1};
        p.value = value;
        p.velocity = velocity;
        out.clear();
        adapter.on_set_point(p, now, out);
        take();
    }
    void wake() {
        out.clear();
        now = adapter.deadline();
        adapter.on_deadline(now, out);
        take();
    }
    /// Answers what is asked, or lets time pass, until this goes out. `place`: in each state.
    [[nodiscard]] bool comes(const std::string& wanted, std::int64_t place = 0) {
        for (int i = 0; i < 20; ++i) {
            if (waiting && last == wanted) return true;
            if (!waiting) wake();
            if (waiting && last != wanted) answer(last[1], last[1] == 's' ? place : std::stoll(last.substr(2)), last[0] - '0');
        }
        return false;
    }
    static Move to(std::int64_t target) {
        Move m;
        m.target = target;
        return m;
    }
};

TEST_F(ToyLine, AStopEndsWhatItMustAndIsUrgentEachTimeItIsSent) {
    command(1, to(5));
    command(2, to(6));
    command(3, ResetFault{});
    command(4, Halt{});
    ASSERT_EQ(results.size(), 2U);
    EXPECT_EQ(results[0].reason, Reason::interrupted);
    EXPECT_THAT(sent, ElementsAre("1m5"));
    answer('m', 5);
    EXPECT_THAT(sent, ElementsAre("1m5", "1h0"));
    wake();
    EXPECT_THAT(sent, ElementsAre("1m5", "1h0", "1h0")) << "nobody has answered: once more";
    EXPECT_EQ(priorities[1], Priority::urgent);
    EXPECT_EQ(priorities[2], Priority::urgent);
    answer('h', 0);
    ASSERT_EQ(results.size(), 4U);
    EXPECT_EQ(results[2].ticket, 4U);
    EXPECT_EQ(results[3].ticket, 3U) << "what does not move goes on, and is refused here by its plan";
}

/// A drive that is off, and acknowledges an enable at once.
struct ToyLineThatIsOff : ToyLine {
    void enable(Ticket n) {
        if (waiting) answer(last[1], -1, last[0] - '0');
        command(n, Enable{});
        ASSERT_TRUE(comes("1e1", -1));
        answer('e', 1);
        ASSERT_TRUE(results.empty()) << "it is answered before the power is on";
    }
    /// States of the drive that is still off, for this time.
    void off_for(Duration time) {
        for (const Instant end = now + time; now < end && results.empty();) {
            if (waiting)
                answer(last[1], last[1] == 's' ? -1 : 0, last[0] - '0');
            else
                wake();
        }
    }
    void SetUp() override {
        ToyLine::SetUp();
        ASSERT_TRUE(comes("1s0"));
        answer('s', -1);
    }
};

TEST_F(ToyLineThatIsOff, AnEnableIsAnsweredWhenThePowerIsShown) {
    enable(1);
    off_for(1s);
    ASSERT_TRUE(results.empty());
    ASSERT_TRUE(comes("1s0", -1));
    answer('s', 5);
    ASSERT_EQ(results.size(), 1U);
    EXPECT_TRUE(good(results[0]));
}

TEST_F(ToyLineThatIsOff, PowerThatIsShownLateBehindADisableIsThatOfBefore) {
    enable(1);
    command(2, Disable{});
    ASSERT_TRUE(comes("1h0", -1));
    answer('h', 0);
    results.clear();
    command(3, Enable{});
    ASSERT_TRUE(comes("1e1", 5));
    answer('e', 1);
    EXPECT_TRUE(results.empty()) << "answered by the power of before";
    for (const Instant end = now + 1s; now < end && results.empty();) {
        if (waiting)
            answer(last[1], 5, last[0] - '0');
        else
            wake();
    }
    ASSERT_EQ(results.size(), 1U);
    EXPECT_TRUE(good(results[0]));
}

TEST_F(ToyLineThatIsOff, EachEnableOfAControllerThatRepeatsItIsAnswered) {
    enable(1);
    enable(2);
    ASSERT_TRUE(comes("1s0", -1));
    answer('s', 5);
    ASSERT_EQ(results.size(), 2U);
}

TEST_F(ToyLineThatIsOff, AnEnableWithoutPowerFailsAfterItsBound) {
    enable(1);
    off_for(10s);
    ASSERT_EQ(results.size(), 1U);
    EXPECT_EQ(results[0].outcome, Outcome::failed);
    EXPECT_EQ(results[0].text, "the drive has acknowledged the enable and has not come on within 3 s");
}

TEST_F(ToyLineThatIsOff, ADisableEndsAnEnableWhosePowerIsNotShown) {
    enable(1);
    command(2, Disable{});
    ASSERT_EQ(results.size(), 1U);
    EXPECT_EQ(results[0].ticket, 1U);
    EXPECT_EQ(results[0].reason, Reason::interrupted);
}

TEST_F(ToyLine, RestThatIsShownLateBehindAMoveIsThatOfBefore) {
    const auto shown = [&] { return out.feedback.empty() ? AxisFeedback{} : out.feedback.back().value; };
    command(1, to(900));
    ASSERT_TRUE(comes("1m900"));
    answer('m', 900);
    ASSERT_TRUE(comes("1s0"));
    answer('s', 0);
    EXPECT_TRUE(shown().moving) << "it has not begun, or the state is older";
    ASSERT_TRUE(comes("1s0"));
    answer('s', 890);
    EXPECT_FALSE(shown().moving) << "at its target";
    command(2, to(100));
    ASSERT_TRUE(comes("1m100", 890));
    answer('m', 100);
    now += 600ms;
    ASSERT_TRUE(comes("1s0", 890));
    answer('s', 890);
    EXPECT_FALSE(shown().moving) << "after so long it is believed";
}

TEST_F(ToyLine, AStopBehindAMoveIsShownAtOnce) {
    command(1, to(900));
    ASSERT_TRUE(comes("1m900"));
    answer('m', 900);
    command(2, Halt{});
    ASSERT_TRUE(comes("1h0"));
    answer('h', 0);
    ASSERT_TRUE(comes("1s0", 300));
    answer('s', 300);
    ASSERT_FALSE(out.feedback.empty());
    EXPECT_FALSE(out.feedback.back().value.moving);
}

TEST_F(ToyLine, AStreamTellsWhatTheDriveKeepsOnlyWhenItChanges) {
    stream(10, 500);
    ASSERT_TRUE(comes("1m10"));
    stream(11, 500);
    ASSERT_TRUE(comes("1m11"));
    EXPECT_EQ(std::ranges::count(sent, "1v500"), 1);
    command(9, to(3));
    ASSERT_TRUE(comes("1m3"));
    sent.clear();
    stream(12, 500);
    ASSERT_TRUE(comes("1v500")) << "a command may have changed it";
    answer('v', 0, 1, true);
    ASSERT_EQ(out.stream_ends.size(), 1U);
    EXPECT_EQ(out.stream_ends[0].text, "1v500: code 7");
    EXPECT_TRUE(std::ranges::none_of(results, [](const Result& r) { return r.ticket == no_ticket; }));
}

TEST_F(ToyLine, ALateAnswerIsTakenForNothingNew) {
    command(1, Native{});
    command(2, Native{});
    EXPECT_THAT(sent, ElementsAre("1n1"));
    wake();
    ASSERT_EQ(results.size(), 1U);
    EXPECT_EQ(results[0].reason, Reason::no_answer) << "a client's own words are not repeated";
    EXPECT_THAT(sent, ElementsAre("1n1", "1i0")) << "something else first, whose answer comes behind the late one";
    answer('n', 8);
    EXPECT_EQ(results.size(), 1U) << "the first one's answer";
    waiting = true;
    ASSERT_TRUE(comes("1n1"));
    EXPECT_EQ(std::ranges::count(sent, "1n1"), 2);
    answer('n', 9);
    ASSERT_EQ(results.size(), 2U);
    EXPECT_EQ(results[1].text, "9");
}

TEST_F(ToyLine, AnAxisThatIsTakenAwayWhileItMovesIsStopped) {
    ASSERT_TRUE(comes("2s0"));
    answer('s', 1500, 2);
    command(1, to(5), 2);
    line.drives[0].axes.pop_back();
    out.clear();
    sent.clear();
    adapter.configure(line, now, out);
    take();
    ASSERT_EQ(results.size(), 1U);
    EXPECT_EQ(results[0].text, "the axis was removed or changed");
    EXPECT_TRUE(comes("2h0"));
    command(2, to(5), 2);
    EXPECT_EQ(results.back().reason, Reason::line_down);
    EXPECT_THAT(results.back().text, testing::HasSubstr("channels 1 to 2"));
}

TEST_F(ToyLine, ALineThatGoesDownEndsEverythingOnce) {
    command(1, to(5));
    command(2, to(6));
    out.clear();
    adapter.on_line(false, now, out);
    take();
    EXPECT_THAT(results, testing::SizeIs(2));
    EXPECT_EQ(adapter.deadline(), never);
    ASSERT_EQ(out.links.size(), 1U);
    EXPECT_FALSE(out.links[0].online);
    line.drives[0].address = "x";
    out.clear();
    adapter.configure(line, now, out);
    ASSERT_EQ(out.links.size(), 1U);
    EXPECT_EQ(out.links[0].text, "no address");
}

}  // namespace
}  // namespace axisgate::drive
