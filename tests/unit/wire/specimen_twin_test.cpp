// The freedoms that all families share, around a twin that echoes what it hears: times and order of answers, doubled and lost ones, chunks
// and noise of a byte line, boot, silence while the memory is written.
#include "gateway/wire/specimen_twin.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/specimen.hpp"
#include "tests/unit/wire/twin_bus_fixture.hpp"

namespace axisgate::test {
namespace {
using testing::ElementsAre;
using testing::IsEmpty;

constexpr Instant begin = time_zero + ms(1000);

/// Answers each frame with the same frame, sends "tick" by itself at `next`, and writes its memory when it hears "W".
class Echo final : public Twin {
public:
    void on_frame(const Frame& f, Instant now, Out& out) override {
        if (!power) return;
        heard.push_back(as_text(f));
        if (as_text(f) == "W") ++revision;
        send(f, now, out);
    }
    void on_deadline(Instant now, Out& out) override {
        next = never;
        own.at = now;
        if (power) out.send(own, own_priority);
    }
    [[nodiscard]] Instant deadline() const override { return next; }
    void power_on(const NonVolatile& m, Instant now, Out& out) override {
        memory = m;
        power = true;
        on_at = now;
        ++starts;
        send(text("hello"), now, out);
    }
    [[nodiscard]] NonVolatile non_volatile() const override { return memory; }
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return revision; }
    [[nodiscard]] std::vector<HandItem> hand() const override { return {{"power", Value{power}, true, "supply"}}; }
    [[nodiscard]] std::string set_hand(const std::string& name, const Value& v, Instant now, Out&) override {
        if (name == "turn") ++revision;
        if (name == "power") power = *as_flag(v), on_at = now;
        return name == "nonsense" ? "no such item" : "";
    }
    [[nodiscard]] TwinMechanics mechanics(int, Instant) const override { return {1, 2, power}; }

    static void send(Frame f, Instant now, Out& out) {
        f.at = now;
        out.send(f);
    }
    std::vector<std::string> heard;
    Frame own = text("tick");
    Priority own_priority = Priority::command;
    Instant next = never, on_at{};
    NonVolatile memory;
    std::uint64_t revision = 0;
    bool power = false;
    int starts = 0;
};

struct Sent {
    Duration at;  // after `begin`
    std::string what;
    bool operator==(const Sent&) const = default;
    friend void PrintTo(const Sent& s, std::ostream* os) { *os << 1000 * seconds(s.at) << " ms " << s.what; }
};

struct Specimen {
    explicit Specimen(FreedomValues freedoms, std::uint64_t seed = 1, bool power = true) {
        TwinSetup setup;
        setup.freedoms = std::move(freedoms);
        setup.seed = seed;
        auto made = std::make_unique<Echo>();
        inside = made.get();
        twin = with_common_freedoms(std::move(made), setup);
        if (power) call([&](Out& out) { twin->power_on({{"id", Value{std::int64_t{3}}}}, now, out); });
    }
    template <class F>
    void call(F&& f) {
        Out out;
        f(out);
        for (const auto& tx : out.frames) {
            EXPECT_LE(tx.frame.at, now);
            sent.push_back({tx.frame.at - begin, as_text(tx.frame)});
        }
    }
    void hear(const Frame& f) {
        call([&](Out& out) { twin->on_frame(f, now, out); });
    }
    std::string hand(const std::string& name, const Value& v) {
        std::string fault;
        call([&](Out& out) { fault = twin->set_hand(name, v, now, out); });
        return fault;
    }
    void until(Duration after_begin) {
        const Instant end = begin + after_begin;
        while (twin->deadline() <= end) {
            now = std::max(now, twin->deadline());
            call([&](Out& out) { twin->on_deadline(now, out); });
        }
        now = end;
    }
    std::vector<Sent> take() { return std::exchange(sent, {}); }
    [[nodiscard]] bool shows_power() const { return as_flag(twin->hand().front().value) == true; }

    Echo* inside = nullptr;
    std::unique_ptr<Twin> twin;
    Instant now = begin;
    std::vector<Sent> sent;
};

/// Instants of the answers to 400 requests, one each 100 ms, after their request.
std::vector<Duration> reply_times(const FreedomValues& freedoms, std::uint64_t seed = 1) {
    Specimen s(freedoms, seed);
    s.take();
    std::vector<Duration> times;
    for (int i = 0; i < 400; ++i) {
        s.until(ms(100 * i));
        for (const Sent& x : s.take())
            times.push_back(x.at % ms(100));
        s.hear(can(5, {'a'}));
    }
    return times;
}

int count(const std::vector<Duration>& times, Duration of) { return static_cast<int>(std::ranges::count(times, of)); }

TEST(SpecimenTwin, SenderOfNoAnswerLeavesABusyByteLineAlone) {
    for (const bool answer : {true, false}) {
        Specimen s({{"reply_ms", 40}});
        s.inside->own_priority = answer ? Priority::command : Priority::poll;
        s.take();
        s.hear(text("a"));
        s.inside->next = begin + ms(10);  // the answer is being prepared, and the line is its own
        s.until(ms(30));
        s.inside->next = begin + ms(50);
        s.until(ms(60));
        const auto sent = s.take();
        if (answer)
            EXPECT_THAT(sent, ElementsAre(Sent{ms(40), "a"}, Sent{ms(40), "tick"}, Sent{ms(50), "tick"}));
        else
            EXPECT_THAT(sent, ElementsAre(Sent{ms(40), "a"}, Sent{ms(50), "tick"}));
    }
}

TEST(SpecimenTwin, WithoutAFreedomItIsTheTwinItself) {
    for (const FreedomValues& off : {FreedomValues{}, FreedomValues{{"reply_ms", 0}, {"late_per_mille", 500}, {"chunk_pause_ms", 5}}}) {
        const Specimen s(off);
        EXPECT_EQ(s.twin.get(), s.inside);
    }
    const Specimen s({{"reply_ms", 1}});
    EXPECT_NE(s.twin.get(), s.inside);
}

TEST(SpecimenTwin, AnswersAfterItsReplyTime) {
    Specimen s({{"reply_ms", 30}});
    EXPECT_THAT(s.take(), ElementsAre(Sent{ms(0), "hello"})) << "its own frames are no answers";
    s.hear(can(5, {'a'}));
    s.until(ms(10));
    s.hear(can(5, {'b'}));
    EXPECT_THAT(s.take(), IsEmpty());
    EXPECT_THAT(s.inside->heard, ElementsAre("a", "b")) << "it hears, and acts, at once";
    s.until(ms(100));
    EXPECT_THAT(s.take(), ElementsAre(Sent{ms(30), "a"}, Sent{ms(40), "b"}));
    EXPECT_EQ(s.twin->deadline(), never);
}

TEST(SpecimenTwin, ReplyTimesSpreadAndAreTheSameInEachRun) {
    const auto times = reply_times({{"reply_ms", 10}, {"reply_spread_ms", 20}});
    ASSERT_EQ(times.size(), 399u);
    EXPECT_GE(*std::ranges::min_element(times), ms(10));
    EXPECT_LE(*std::ranges::max_element(times), ms(30));
    EXPECT_GT(std::set<Duration>(times.begin(), times.end()).size(), 300u);
    EXPECT_EQ(times, reply_times({{"reply_ms", 10}, {"reply_spread_ms", 20}}));
    EXPECT_NE(times, reply_times({{"reply_ms", 10}, {"reply_spread_ms", 20}}, 2));
}

TEST(SpecimenTwin, AShareOfTheAnswersIsLateLostOrDoubled) {
    const auto late = reply_times({{"late_per_mille", 100}, {"late_ms", 70}});
    EXPECT_NEAR(count(late, ms(70)), 40, 20);
    EXPECT_NEAR(count(late, ms(0)), 360, 20);
    EXPECT_NEAR(static_cast<double>(reply_times({{"lost_per_mille", 100}}).size()), 360, 20);
    EXPECT_NEAR(static_cast<double>(reply_times({{"doubled_per_mille", 100}}).size()), 440, 20);
    EXPECT_THAT(reply_times({{"lost_per_mille", 1000}}), IsEmpty());
    EXPECT_EQ(count(reply_times({{"late_per_mille", 100}}), ms(0)), 399) << "without late_ms there is no late answer";
}

TEST(SpecimenTwin, OnCanAFrameThatIsNoAnswerIsNotHeldBack) {
    Specimen s({{"reply_ms", 30}});
    s.take();
    s.inside->own = can(7, {'t'});
    s.inside->next = begin + ms(10);
    s.hear(can(5, {'a'}));
    s.until(ms(50));
    EXPECT_THAT(s.take(), ElementsAre(Sent{ms(10), "t"}, Sent{ms(30), "a"}));
}

TEST(SpecimenTwin, OnAByteLineEverythingKeepsItsOrder) {
    Specimen s({{"reply_ms", 30}, {"late_per_mille", 300}, {"late_ms", 400}, {"reply_spread_ms", 50}});
    s.take();
    s.inside->next = begin + ms(10);
    s.hear(text("a"));
    s.until(ms(10));
    std::string expected = "a";
    for (char c = 'b'; c <= 'z'; ++c) {
        s.hear(text(std::string(1, c)));
        expected += c;
        s.until(s.now - begin + ms(7));
    }
    s.until(ms(5000));
    std::string got;
    Duration before{};
    for (const Sent& x : s.take()) {
        if (x.what != "tick") got += x.what;
        EXPECT_GE(x.at, before);
        before = x.at;
    }
    EXPECT_EQ(got, expected);
}

TEST(SpecimenTwin, BytesComeInChunks) {
    Specimen s({{"chunk_bytes", 4}, {"chunk_pause_ms", 5}});
    s.until(ms(100));
    EXPECT_THAT(s.take(), ElementsAre(Sent{ms(0), "hell"}, Sent{ms(5), "o"}));
    s.hear(text("0123456789"));
    s.hear(text("ab"));
    s.hear(can(5, {1, 2, 3, 4, 5, 6}));
    s.until(ms(200));
    EXPECT_THAT(s.take(), ElementsAre(Sent{ms(100), "0123"}, Sent{ms(100), "\1\2\3\4\5\6"}, Sent{ms(105), "4567"}, Sent{ms(110), "89"},
                                      Sent{ms(110), "ab"}))
        << "a CAN frame has no chunks, and the next message does not begin inside of one";
}

TEST(SpecimenTwin, NoiseIsAByteBeforeAMessageAndNeverInACanFrame) {
    Specimen s({{"noise_per_mille", 1000}});
    s.take();
    s.hear(text("abc"));
    const auto sent = s.take();
    ASSERT_EQ(sent.size(), 2u);
    EXPECT_EQ(sent[0].what.size(), 1u);
    EXPECT_EQ(sent[1].what, "abc");
    s.hear(can(5, {'a'}));
    EXPECT_THAT(s.take(), ElementsAre(Sent{ms(0), "a"}));
}

TEST(SpecimenTwin, WhileItBootsItHearsAndSaysNothing) {
    Specimen s({{"boot_ms", 500}});
    EXPECT_EQ(s.twin->deadline(), begin + ms(500));
    EXPECT_EQ(s.inside->starts, 0);
    EXPECT_TRUE(s.shows_power());
    EXPECT_EQ(s.twin->non_volatile().size(), 1u) << "its memory is there before it boots";
    s.hear(text("a"));
    s.until(ms(499));
    s.hear(text("b"));
    EXPECT_THAT(s.take(), IsEmpty());
    s.until(ms(600));
    EXPECT_THAT(s.inside->heard, IsEmpty());
    EXPECT_THAT(s.take(), ElementsAre(Sent{ms(500), "hello"}));
    EXPECT_EQ(s.inside->on_at, begin + ms(500));
    s.hear(text("c"));
    EXPECT_THAT(s.take(), ElementsAre(Sent{ms(600), "c"}));
    s.call([&](Out& out) { s.twin->power_on({}, s.now, out); });
    s.hear(text("d"));
    s.until(ms(1099));
    EXPECT_THAT(s.take(), IsEmpty()) << "a restore is a boot, too";
}

TEST(SpecimenTwin, ALateCallDoesNotPostponeTheBoot) {
    Specimen s({{"boot_ms", 500}});
    s.now = begin + ms(700);
    s.hear(text("a"));
    EXPECT_EQ(s.inside->on_at, begin + ms(500));
    EXPECT_THAT(s.inside->heard, ElementsAre("a"));
}

TEST(SpecimenTwin, PowerByHandIsABootAndEndsWhatWaited) {
    Specimen s({{"boot_ms", 500}, {"reply_ms", 30}});
    s.until(ms(600));
    s.take();
    s.hear(text("a"));
    EXPECT_EQ(s.hand("power", Value{false}), "");
    EXPECT_FALSE(s.shows_power());
    s.until(ms(1000));
    EXPECT_THAT(s.take(), IsEmpty()) << "an answer that waited is not sent without power";
    EXPECT_EQ(s.hand("power", Value{true}), "");
    EXPECT_EQ(s.hand("power", Value{true}), "");
    EXPECT_TRUE(s.shows_power());
    s.until(ms(1499));
    s.hear(text("b"));
    EXPECT_FALSE(s.inside->power);
    s.until(ms(1500));
    EXPECT_TRUE(s.inside->power);
    s.hear(text("c"));
    s.until(ms(1600));
    EXPECT_THAT(s.take(), ElementsAre(Sent{ms(1530), "c"}));
    EXPECT_EQ(s.hand("power", Value{true}), "");
    EXPECT_TRUE(s.inside->power) << "power that is there is no boot";

    EXPECT_EQ(s.hand("power", Value{false}), "");
    EXPECT_EQ(s.hand("power", Value{true}), "");
    s.until(ms(1700));
    EXPECT_EQ(s.hand("power", Value{false}), "");
    s.until(ms(5000));
    EXPECT_FALSE(s.inside->power) << "it was switched off while it booted";
    EXPECT_EQ(s.hand("nonsense", Value{true}), "no such item");
}

TEST(SpecimenTwin, AHandDuringTheBootDoesNotShortenIt) {
    Specimen s({{"boot_ms", 500}});
    EXPECT_EQ(s.hand("turn", Value{true}), "");
    EXPECT_TRUE(s.shows_power());
    s.until(ms(499));
    s.hear(text("a"));
    EXPECT_THAT(s.take(), IsEmpty());
    s.until(ms(500));
    s.hear(text("b"));
    EXPECT_THAT(s.inside->heard, ElementsAre("b"));
    EXPECT_EQ(s.inside->memory.size(), 1u);
    EXPECT_EQ(s.inside->starts, 1);

    Specimen off({{"boot_ms", 500}});
    EXPECT_EQ(off.hand("power", Value{false}), "");
    EXPECT_FALSE(off.shows_power());
    off.until(ms(2000));
    EXPECT_FALSE(off.inside->power);
    EXPECT_THAT(off.take(), IsEmpty());
}

TEST(SpecimenTwin, ItIsSilentWhileItWritesItsMemory) {
    Specimen s({{"flash_silence_ms", 300}});
    s.take();
    s.hear(can(5, {'W'}));
    s.until(ms(100));
    s.hear(can(5, {'a'}));
    s.inside->own = can(7, {'t'});
    s.inside->next = begin + ms(200);
    s.until(ms(400));
    EXPECT_THAT(s.take(), ElementsAre(Sent{ms(300), "W"}, Sent{ms(300), "a"}, Sent{ms(300), "t"}));
    EXPECT_THAT(s.inside->heard, ElementsAre("W", "a")) << "it hears all the time";
    EXPECT_EQ(s.hand("turn", Value{true}), "");
    s.hear(can(5, {'b'}));
    EXPECT_THAT(s.take(), ElementsAre(Sent{ms(400), "b"})) << "a change that no request made is no write";
}

TEST(SpecimenTwin, FramesThatWaitAreLimited) {
    Specimen s({{"reply_ms", 60'000}});
    s.take();
    for (int i = 0; i < 3000; ++i)
        s.hear(can(5, {1}));
    s.until(ms(120'000));
    EXPECT_EQ(s.take().size(), 1024u);
}

TEST(SpecimenTwin, TheRestIsTheTwins) {
    Specimen s({{"reply_ms", 30}});
    EXPECT_EQ(s.twin->mechanics(1, s.now).velocity, 2);
    s.inside->revision = 12;
    EXPECT_EQ(s.twin->non_volatile_revision(), 12u);
    EXPECT_FALSE(s.twin->fit_axes(2, s.now));
    EXPECT_EQ(s.twin->acceptance(), Acceptance{});
}

// --- the maker -------------------------------------------------------------------------------------------------------------------------

TwinSetup made_with;

Family toy() {
    Family f{};
    f.name = "toy";
    f.make_twin = [](const Catalogue&, const TwinSetup& s) -> std::unique_ptr<Twin> {
        made_with = s;
        return std::make_unique<Echo>();
    };
    return f;
}
Catalogue page() {
    std::vector<std::string> faults;
    auto c = Catalogue::parse(
        R"({"family":"toy","number":1,"parameters":[],"commands":[],"errors":[],"freedoms":[{"name":"reply_ms","unit":"ms","min":0,"max":200,"default":0,"description":"late",)"
        R"("source":"silent","named":{"slow":200}}]})",
        faults);
    EXPECT_THAT(faults, IsEmpty());
    return c ? *std::move(c) : Catalogue();
}

TEST(MakeSpecimen, TheTwinHasTheValuesOfItsOptions) {
    TwinSetup setup;
    setup.address = "5";
    auto twin = make_specimen(toy(), page(), setup);
    EXPECT_EQ(made_with.freedoms, (FreedomValues{{"reply_ms", 0}}));
    EXPECT_NE(dynamic_cast<Echo*>(twin.get()), nullptr) << "the drive as its manual shows it costs nothing";
    setup.options["specimen"] = "slow";
    twin = make_specimen(toy(), page(), setup);
    EXPECT_EQ(made_with.freedoms, (FreedomValues{{"reply_ms", 200}}));
    EXPECT_EQ(dynamic_cast<Echo*>(twin.get()), nullptr);
    setup.options["reply_ms"] = "3";
    twin = make_specimen(toy(), page(), setup);
    EXPECT_EQ(made_with.freedoms, (FreedomValues{{"reply_ms", 3}}));
}

TEST(MakeSpecimen, SpecimensAndDrivesOfALineHaveSeedsOfTheirOwn) {
    std::set<std::uint64_t> seeds;
    for (const auto* specimen : {"0", "1", "slow"}) {
        for (const auto* address : {"5", "6", "55"}) {
            TwinSetup setup;
            setup.address = address;
            setup.options["specimen"] = specimen;
            (void)make_specimen(toy(), page(), setup);
            seeds.insert(made_with.seed);
        }
    }
    EXPECT_EQ(seeds.size(), 9u);
}

}  // namespace
}  // namespace axisgate::test
