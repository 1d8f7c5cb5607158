// Lines on which others speak, too, and drives that do not answer everything: the drive is found and served, and nothing of the others is
// taken for its answer.
#include "adapters/linmot/tests/line_bench.hpp"
#include "gateway/wire/specimen_twin.hpp"

namespace axisgate::linmot::test {
namespace {
constexpr std::uint32_t shared_rate = 38400;
const char* response_at_5 = "01 11 0C 02 00 00 00 37 04 C1 08 05 00 00 00 04";
const char* response_at_9 = "01 11 0C 02 00 00 00 37 04 C1 08 09 00 00 00 04";

Move quick_move(std::int64_t target) {
    Move m;
    m.target = target;
    m.velocity = 1'000'000;
    m.acceleration = m.deceleration = 10'000'000;
    return m;
}

/// An adapter without a drive: the test plays the line.
struct AloneOnALine {
    LineBench b{1, shared_rate};
    LineAdapter adapter{page()};
    Instant now = b.now;
    Out out;
    AloneOnALine() {
        adapter.configure(b.setup, now, out);
        adapter.on_line(true, now, out);
    }
    /// Returns the number of requests that were sent.
    std::size_t hear(const char* hex, Duration later) {
        now += later;
        out.frames.clear();
        adapter.on_frame(Frame::run(bytes_of(hex)), now, out);
        return out.frames.size();
    }
    /// The bytes that are sent until `later`.
    std::size_t wait(Duration later) {
        out.frames.clear();
        for (const Instant end = now + later; adapter.deadline() <= end;) {
            now = std::max(now, adapter.deadline());
            adapter.on_deadline(now, out);
        }
        return out.frames.size();
    }
    [[nodiscard]] bool found() const { return !out.feedback.empty(); }
};

TEST(LinmotSharedLine, BytesThatOverlapARequestAreNoAnswerWhereOthersSpeak) {
    AloneOnALine alone;
    (void)alone.hear(response_at_5, 4ms);
    EXPECT_TRUE(alone.found()) << "a drive behind a pseudo terminal answers without the time on the wire";
    AloneOnALine a;
    (void)a.hear("01 91 03 02 01 00 04", 0ms);  // another master
    (void)a.hear(response_at_5, 4ms);           // 16 bytes take 4.2 ms, and the request 1.8 ms
    EXPECT_FALSE(a.found());
    (void)a.hear(response_at_9, 10ms);
    ASSERT_TRUE(a.found());
    EXPECT_EQ(a.out.feedback.back().value.position, 9);
}

TEST(LinmotSharedLine, AnAnswerBeginsWithTheEndOfItsRequestAtTheEarliest) {
    AloneOnALine a;
    (void)a.hear(response_at_9, 5990us);  // 7 and 16 bytes of 260 us
    EXPECT_TRUE(a.found());
}

TEST(LinmotSharedLine, RequestsWaitForSilenceWhereOthersSpeak) {
    AloneOnALine quiet;
    EXPECT_EQ(quiet.hear(response_at_9, 10ms), 1u) << "the next request follows at once";
    AloneOnALine a;
    (void)a.hear("01 91 03 02 01 00 04", 8ms);  // another master
    (void)a.hear("01 91 0C 02 00 00 00 37 04 C1 08 05 00 00 00 04", 5ms);
    EXPECT_EQ(a.hear(response_at_9, 5ms), 0u);
    EXPECT_EQ(a.wait(14ms), 0u);
    EXPECT_EQ(a.wait(16ms), 1u);
    // A line that is never silent does not silence the gateway.
    AloneOnALine never_silent;
    std::size_t sent = never_silent.hear("01 91 03 02 01 00 04", 8ms) + never_silent.hear(response_at_9, 5ms);
    for (int i = 0; i < 12 && sent == 0; ++i)
        sent += never_silent.hear("01 91 03 02 01 00 04", 10ms);
    EXPECT_EQ(sent, 1u);
}

TEST(LinmotSharedLine, TheOwnEchoIsNobodyElse) {
    AloneOnALine a;
    (void)a.hear("01 11 03 02 01 00 04", 4ms);  // as the request was sent
    EXPECT_EQ(a.hear(response_at_9, 6ms), 1u);
}

TEST(LinmotSharedLine, ADriveBesideAnotherMasterIsFoundAndServed) {
    for (const char* period : {"70", "100", "500"}) {
        SCOPED_TRACE(period);
        LineBench b(1, shared_rate, {{"foreign_ms", period}, {"unsolicited_ms", "900"}, {"first_count", "15"}});
        b.run(3s);
        ASSERT_TRUE(b.links[DriveId{0}].online) << b.links[DriveId{0}].text;
        ASSERT_TRUE(b.enable());
        for (int i = 0; i < 30; ++i) {
            const Result r = b.ask(quick_move(i % 2 == 0 ? 100'000 : 0));
            ASSERT_TRUE(good(r)) << i << ": " << r.text;
            b.run(997ms);
            EXPECT_TRUE(b.links[DriveId{0}].online) << i;
            EXPECT_EQ(b.axis().position, i % 2 == 0 ? 100'000 : 0) << i;
            EXPECT_FALSE(b.axis().fault) << i;
        }
        EXPECT_GT(b.bus->counters().collisions, 0u) << "without any the test shows nothing";
        EXPECT_EQ(std::ranges::count(b.notices, std::string("alarm"), &Notice::kind), 0);
    }
}

TEST(LinmotSharedLine, AStopDoesNotWaitForATelegramInPieces) {
    SharedLine line;
    Instant now = at_ns(10'000'000'000);
    const Instant begun = now + 34ms;  // the first pause is not known to be inside of a telegram yet
    line.strange(now);
    for (int piece = 0; piece < 12; ++piece) {
        now += 17ms;
        (void)line.heard(now, 1, 260us, piece > 0);
        EXPECT_LE(line.stop_at(now), now + 15ms) << piece;
        EXPECT_LE(line.stop_at(now), begun + 100ms) << piece;
        if (piece > 0) EXPECT_GT(line.silent_at(now), now + 20ms) << piece << ": anything else waits for the end of the telegram";
    }
    EXPECT_EQ(line.stop_at(now + 21s), now + 21s) << "nobody else has spoken for long";
}

/// Each byte of a reply and of the other master needs 17 ms, and the master speaks twice in a second.
TEST(LinmotSharedLine, PausesInsideOfATelegramAreNoSilence) {
    LineTiming timing;
    timing.reply_timeout = 1226ms;
    LineBench b(1, shared_rate, {}, timing);
    TwinSetup t;
    t.address = "17";
    t.seed = 789038827;  // pieces of 1 byte with pauses of 17 ms; replies after 27 to 37 ms; another master each 500 ms
    t.freedoms = specimen_values(page(), std::to_string(t.seed));
    b.bus->add(DriveId{0}, with_common_freedoms(twin::make_twin(page(), t), t), {}, b.now);
    b.run(20s);
    ASSERT_TRUE(b.links[DriveId{0}].online) << b.links[DriveId{0}].text;
    const Result on = b.ask(Enable{}, 0, 40s);
    ASSERT_TRUE(good(on)) << on.text;
    for (int i = 0; i < 30; ++i) {
        const Result r = b.ask(i % 3 == 2 ? CommandBody{Halt{}} : CommandBody{quick_move(i % 2 == 0 ? 100'000 : 0)});
        EXPECT_TRUE(good(r)) << i << ": " << r.text;
        b.run(std::chrono::milliseconds(1000 + 37 * i));
        ASSERT_TRUE(b.links[DriveId{0}].online) << i;
    }
}

/// The drive's own response each 900 ms answers a request that was lost, and the next ones follow in the same places between the telegrams
/// of the other master.
TEST(LinmotSharedLine, AControlWordIsNotLostInEachPeriodOfTheOthers) {
    LineTiming timing;
    timing.reply_timeout = 600ms;
    for (int phase = 0; phase < 20; ++phase) {
        LineBench b(1, shared_rate, {}, timing);
        b.run(std::chrono::milliseconds(7 * phase));
        TwinSetup t;
        t.address = "17";
        t.options = {{"foreign_ms", "100"}, {"unsolicited_ms", "900"}, {"reply_ms", "162"}};
        t.freedoms = freedoms_of(page(), t.options);
        b.bus->add(DriveId{0}, with_common_freedoms(twin::make_twin(page(), t), t), {}, b.now);
        b.run(20s);
        for (int i = 0; i < 4; ++i) {
            const Result on = b.ask(Enable{}, 0, 40s);
            EXPECT_TRUE(good(on)) << phase << " " << i << ": " << on.text;
            EXPECT_TRUE(good(b.ask(Disable{}, 0, 40s))) << phase << " " << i;
            b.run(std::chrono::milliseconds(1000 + 37 * i));
        }
    }
}

TEST(LinmotSharedLine, ADriveThatNeedsAPauseBetweenRequestsIsServed) {
    for (const char* content : {"0", "3"}) {
        SCOPED_TRACE(content);
        LineBench b(1, shared_rate,
                    {{"request_pause_ms", "45"}, {"response_content", content}, {"unsolicited_ms", "900"}, {"status_late_ms", "17"}});
        b.run(5s);
        ASSERT_TRUE(b.links[DriveId{0}].online) << b.links[DriveId{0}].text;
        ASSERT_TRUE(b.enable());
        for (int i = 0; i < 10; ++i) {
            const Result r = b.ask(quick_move(i % 2 == 0 ? 100'000 : 0));
            ASSERT_TRUE(good(r)) << i << ": " << r.text;
            b.run(1s);
            EXPECT_EQ(b.axis().position, i % 2 == 0 ? 100'000 : 0) << i;
        }
    }
}

TEST(LinmotSharedLine, ADriveThatReadsNoRamIsServedWithoutItsRates) {
    LineBench b(1, 115200, {{"ram_access", "0"}});
    b.run(5s);
    ASSERT_TRUE(b.links[DriveId{0}].online) << b.links[DriveId{0}].text;
    EXPECT_NE(b.links[DriveId{0}].text.find("does not answer reads of RAM values"), std::string::npos) << b.links[DriveId{0}].text;
    ASSERT_TRUE(b.enable());
    EXPECT_TRUE(good(b.ask(quick_move(50'000))));
    b.run(1s);
    EXPECT_EQ(b.axis().position, 50'000);
    Move without;
    without.target = 0;
    EXPECT_NE(b.ask(without).text.find("give velocity"), std::string::npos);
    for (int i = 0; i < 100; ++i) {
        b.run(100ms);
        ASSERT_TRUE(b.links[DriveId{0}].online) << i;
    }
    b.hand("power", Value{false});
    b.run(3s);
    EXPECT_FALSE(b.links[DriveId{0}].online) << "a drive that is away is lost all the same";
}

}  // namespace
}  // namespace axisgate::linmot::test
