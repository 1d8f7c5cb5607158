// Every answer as in the standard, all refusals, and clients that send wrong data, lose frames or disappear.
#include "gateway/protocols/canopen/sdo_server.hpp"

#include <array>
#include <random>

#include "gateway/protocols/canopen/dictionary.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"
#include "tests/unit/canopen/bench.hpp"

namespace axisgate::canopen::test {
namespace {

struct Server : testing::Test {
    Dictionary dictionary;
    SdoServer server{5, dictionary, {.most_bytes = 4096, .block_size = 3, .stalls = 1}};
    std::vector<Frame> out;
    Instant now = time_zero + 1s;

    Server() {
        dictionary.add({0x1008, 0},
                       {.type = DataType::visible_string, .access = EntryAccess::constant, .bytes = bytes_of_text("123456789")});
        dictionary.add({0x1018, 0}, {.type = DataType::unsigned8, .access = EntryAccess::read_only, .bytes = {4}});
        dictionary.add({0x1018, 1}, {.type = DataType::unsigned32, .access = EntryAccess::read_only, .bytes = {0x78, 0x56, 0x34, 0x12}});
        dictionary.add({0x1F50, 1}, {.type = DataType::domain, .access = EntryAccess::write_only, .most_bytes = 4096});
        dictionary.add({0x2000, 0}, {.type = DataType::domain, .access = EntryAccess::read_write});
        dictionary.add({0x6040, 0}, {.type = DataType::unsigned16});
        dictionary.add({0x6060, 0}, {.type = DataType::integer8, .low = -1, .high = 10});
    }
    Texts ask(std::string_view text) {
        EXPECT_TRUE(server.on_frame(frame(text), now, out));
        return taken(out);
    }
};

TEST_F(Server, AnswersAShortValueAtOnce) {
    EXPECT_EQ(ask("605#4018100100000000"), Texts{"585#4318100178563412"});
    EXPECT_EQ(ask("605#4018100000000000"), Texts{"585#4F18100004000000"});
    EXPECT_FALSE(server.busy());
}
TEST_F(Server, AnswersALongValueBySegments) {
    EXPECT_EQ(ask("605#4008100000000000"), Texts{"585#4108100009000000"});
    EXPECT_EQ(ask("605#6000000000000000"), Texts{"585#0031323334353637"});
    EXPECT_EQ(ask("605#7000000000000000"), Texts{"585#1B38390000000000"});
    EXPECT_FALSE(server.busy());
}
TEST_F(Server, TakesAShortValueAtOnce) {
    EXPECT_EQ(ask("605#2B40600006010000"), Texts{"585#6040600000000000"});
    EXPECT_EQ(dictionary.integer({0x6040, 0}), 0x0106);
    EXPECT_EQ(ask("605#2240600007010000"), Texts{"585#6040600000000000"}) << "no length told: as many as the type has";
    EXPECT_EQ(dictionary.integer({0x6040, 0}), 0x0107);
}
TEST_F(Server, TakesALongValueBySegments) {
    EXPECT_EQ(ask("605#21501F0109000000"), Texts{"585#60501F0100000000"});
    EXPECT_EQ(ask("605#0031323334353637"), Texts{"585#2000000000000000"});
    EXPECT_TRUE(dictionary.find({0x1F50, 1})->bytes.empty()) << "nothing is applied half";
    EXPECT_EQ(ask("605#1B38390000000000"), Texts{"585#3000000000000000"});
    EXPECT_EQ(dictionary.find({0x1F50, 1})->bytes, bytes_of_text("123456789"));
}
TEST_F(Server, AnswersByBlocks) {
    EXPECT_EQ(ask("605#A408100002000000"), Texts{"585#C608100009000000"});
    EXPECT_EQ(ask("605#A300000000000000"), (Texts{"585#0131323334353637", "585#8238390000000000"}));
    EXPECT_EQ(ask("605#A201020000000000"), Texts{"585#8138390000000000"}) << "only the first came";
    EXPECT_EQ(ask("605#A201020000000000"), Texts{"585#D5C3310000000000"});
    EXPECT_EQ(ask("605#A100000000000000"), Texts{});
    EXPECT_FALSE(server.busy());
}
TEST_F(Server, LeavesTheBlockProtocolBelowTheSizeThatTheClientNames) {
    EXPECT_EQ(ask("605#A4181001020A0000"), Texts{"585#4318100178563412"});
    EXPECT_EQ(ask("605#A408100002090000"), Texts{"585#4108100009000000"});
}
TEST_F(Server, TakesBlocks) {
    EXPECT_EQ(ask("605#C6501F0109000000"), Texts{"585#A4501F0103000000"});
    EXPECT_EQ(ask("605#0131323334353637"), Texts{});
    EXPECT_EQ(ask("605#8238390000000000"), Texts{"585#A202030000000000"});
    EXPECT_TRUE(dictionary.find({0x1F50, 1})->bytes.empty());
    EXPECT_EQ(ask("605#D5C3310000000000"), Texts{"585#A100000000000000"});
    EXPECT_EQ(dictionary.find({0x1F50, 1})->bytes, bytes_of_text("123456789"));
}

// ---- refusals ---------------------------------------------------------------------------------------------------------
TEST_F(Server, RefusesWhatIsNotThereOrNotAllowed) {
    EXPECT_EQ(ask("605#4000300000000000"), Texts{"585#8000300000000206"});
    EXPECT_EQ(ask("605#4018100200000000"), Texts{"585#8018100211000906"});
    EXPECT_EQ(ask("605#40501F0100000000"), Texts{"585#80501F0101000106"});
    EXPECT_EQ(ask("605#2318100101000000"), Texts{"585#8018100102000106"});
    EXPECT_EQ(ask("605#2108100001000000"), Texts{"585#8008100002000106"}) << "a constant, and before the bytes come";
    EXPECT_EQ(ask("605#2F40600001000000"), Texts{"585#8040600013000706"});
    EXPECT_EQ(ask("605#2340600001000000"), Texts{"585#8040600012000706"});
    EXPECT_EQ(ask("605#2F6060000B000000"), Texts{"585#8060600031000906"});
    EXPECT_EQ(ask("605#2F606000FE000000"), Texts{"585#8060600032000906"}) << "-2";
    EXPECT_EQ(ask("605#2F606000FF000000"), Texts{"585#6060600000000000"}) << "-1";
    EXPECT_EQ(ask("605#21501F0101100000"), Texts{"585#80501F0112000706"}) << "4097 bytes into 4096";
    EXPECT_EQ(ask("605#2100200001100000"), Texts{"585#8000200005000405"}) << "above what the server keeps";
}
TEST_F(Server, TheOwnerHasTheLastWord) {
    dictionary.on_write([](Address a, std::span<const std::uint8_t>) { return a.index == 0x6060 ? Abort::device_state : Abort::none; });
    EXPECT_EQ(ask("605#2F60600001000000"), Texts{"585#8060600022000008"});
    EXPECT_EQ(dictionary.integer({0x6060, 0}), 0);
    dictionary.on_read([this](Address) {
        dictionary.set({0x1018, 1}, Value{std::int64_t{7}});
        return Abort::none;
    });
    EXPECT_EQ(ask("605#4018100100000000"), Texts{"585#4318100107000000"});
}
TEST_F(Server, AWrongToggleEndsTheTransfer) {
    ask("605#4008100000000000");
    EXPECT_EQ(ask("605#7000000000000000"), Texts{"585#8008100000000305"});
    EXPECT_FALSE(server.busy());
    ask("605#21501F0109000000");
    EXPECT_EQ(ask("605#1031323334353637"), Texts{"585#80501F0100000305"});
}
TEST_F(Server, LengthsThatLieEndTheTransferAndChangeNothing) {
    ask("605#21501F0103000000");
    EXPECT_EQ(ask("605#0031323334353637"), Texts{"585#80501F0110000706"}) << "more than announced";
    ask("605#21501F0109000000");
    EXPECT_EQ(ask("605#0131323334353637"), Texts{"585#80501F0110000706"}) << "fewer";
    ask("605#20501F0100000000");
    EXPECT_EQ(ask("605#0E00000000000000"), Texts{"585#80501F0110000706"}) << "empty, and not the last";
    EXPECT_TRUE(dictionary.find({0x1F50, 1})->bytes.empty());
}
TEST_F(Server, AWriteWithoutATotalStopsAtTheLimit) {
    ask("605#2000200000000000");
    Texts answer;
    int segments = 0;
    do {
        answer = ask(segments % 2 == 0 ? "605#0031323334353637" : "605#1031323334353637");
    } while (server.busy() && ++segments < 1000);
    EXPECT_EQ(answer, Texts{"585#8000200005000405"});
    EXPECT_EQ(segments, 4096 / 7);
}
TEST_F(Server, AnAbortInTheMiddleEndsTheTransfer) {
    ask("605#21501F0109000000");
    EXPECT_EQ(ask("605#80501F0100000008"), Texts{});
    EXPECT_FALSE(server.busy());
    EXPECT_EQ(ask("605#0031323334353637"), Texts{"585#8000000001000405"}) << "a segment of no transfer";
}
TEST_F(Server, ASecondRequestTakesThePlaceOfTheFirst) {
    ask("605#4008100000000000");
    EXPECT_EQ(ask("605#4018100000000000"), Texts{"585#4F18100004000000"});
    EXPECT_EQ(ask("605#6000000000000000"), Texts{"585#8000000001000405"});
}
TEST_F(Server, AClientThatLeavesIsGivenUp) {
    ask("605#4008100000000000");
    EXPECT_EQ(server.deadline(), now + 500ms);
    server.on_deadline(now + 499ms, out);
    EXPECT_EQ(taken(out), Texts{});
    server.on_deadline(now + 500ms, out);
    EXPECT_EQ(taken(out), Texts{"585#8008100000000405"});
    EXPECT_EQ(server.deadline(), never);
}
TEST_F(Server, BlocksOutOfOrderOrWithAWrongChecksumChangeNothing) {
    ask("605#C6501F0109000000");
    EXPECT_EQ(ask("605#8238390000000000"), Texts{"585#A200030000000000"}) << "the first is missing";
    EXPECT_EQ(ask("605#8238390000000000"), Texts{"585#80501F0103000405"}) << "and again";
    ask("605#C6501F0109000000");
    ask("605#0131323334353637");
    ask("605#8238390000000000");
    EXPECT_EQ(ask("605#D5C3320000000000"), Texts{"585#80501F0104000405"});
    ask("605#C6501F0109000000");
    EXPECT_EQ(ask("605#0431323334353637"), Texts{"585#80501F0103000405"}) << "above the block size";
    EXPECT_TRUE(dictionary.find({0x1F50, 1})->bytes.empty());
}
TEST_F(Server, BlockSizesThatAreNoneAreRefused) {
    EXPECT_EQ(ask("605#A408100000000000"), Texts{"585#8008100002000405"});
    EXPECT_EQ(ask("605#A408100080000000"), Texts{"585#8008100002000405"});
    ask("605#A408100001000000");
    ask("605#A300000000000000");
    EXPECT_EQ(ask("605#A201000000000000"), Texts{"585#8008100002000405"});
    ask("605#A408100001000000");
    ask("605#A300000000000000");
    EXPECT_EQ(ask("605#A202010000000000"), Texts{"585#8008100003000405"}) << "more than was sent";
}
TEST_F(Server, HalfAMessageIsNotAnswered) {
    EXPECT_EQ(ask("605#401810"), Texts{});
    EXPECT_FALSE(server.on_frame(frame("606#4018100100000000"), now, out));
    EXPECT_FALSE(server.on_frame(frame("605#R"), now, out));
}
TEST_F(Server, KeepsBoundsAndTypesOfWhatItsOwnerSets) {
    EXPECT_FALSE(dictionary.set({0x6060, 0}, Value{std::int64_t{11}}));
    EXPECT_FALSE(dictionary.set({0x6040, 0}, Value{std::int64_t{65536}}));
    EXPECT_FALSE(dictionary.set({0x6041, 0}, Value{std::int64_t{0}}));
    EXPECT_TRUE(dictionary.set({0x1018, 1}, Value{std::int64_t{0xFFFFFFFF}}));
    EXPECT_EQ(dictionary.integer({0x1018, 1}), 0xFFFFFFFF);
}

// ---- both together ----------------------------------------------------------------------------------------------------
// A client and a server on a wire that loses one frame in so many, selected by a seed.
struct Pair {
    Dictionary dictionary;
    SdoServer server{5, dictionary, {.patience = 300ms, .block_size = 127}};
    SdoClient client{5, {.block_size = 100}};
    Instant now = time_zero;
    std::mt19937 random;
    int lost_of_1000 = 0;
    std::vector<Frame> requests, answers;

    explicit Pair(unsigned seed) : random(seed) { dictionary.add({0x2000, 0}, {.type = DataType::domain}); }
    bool lost() { return static_cast<int>(random() % 1000) < lost_of_1000; }
    SdoEnd run() {
        for (;;) {
            const auto to_server = std::exchange(requests, {});
            for (const auto& f : to_server)
                if (!lost()) server.on_frame(f, now, answers);
            const auto to_client = std::exchange(answers, {});
            for (const auto& f : to_client) {
                if (lost()) continue;
                if (auto end = client.on_frame(f, now, requests)) return *end;
            }
            if (!requests.empty() || !answers.empty()) continue;
            now = std::min(client.deadline(), server.deadline());
            server.on_deadline(now, answers);
            if (auto end = client.on_deadline(now, requests)) return *end;
        }
    }
    SdoEnd write(std::vector<std::uint8_t> data, bool block) {
        client.write({0x2000, 0}, std::move(data), now, requests, block);
        return run();
    }
    SdoEnd read(bool block) {
        client.read({0x2000, 0}, now, requests, block);
        return run();
    }
};

TEST(SdoPair, EveryLengthArrivesWholeInEveryWay) {
    for (const bool block : {false, true}) {
        for (const std::size_t n : {0, 1, 2, 3, 4, 5, 6, 7, 8, 13, 14, 15, 699, 700, 701, 888, 889, 890, 10'000, 65'536}) {
            Pair p(1);
            ASSERT_TRUE(p.write(pattern(n), block).done()) << n;
            EXPECT_EQ(p.dictionary.find({0x2000, 0})->bytes, pattern(n)) << n;
            const auto end = p.read(block);
            ASSERT_TRUE(end.done()) << n;
            EXPECT_EQ(end.data, pattern(n)) << n;
        }
    }
}
TEST(SdoPair, OnAWireThatLosesFramesAValueIsWholeOrNotThereAtAll) {
    int done = 0, failed = 0;
    for (unsigned seed = 0; seed < 400; ++seed) {
        Pair p(seed);
        const bool block = seed % 2 == 0;
        p.lost_of_1000 = 5;
        const auto data = pattern(300 + seed);
        const auto end = p.write(data, block);
        const auto& stored = p.dictionary.find({0x2000, 0})->bytes;
        if (end.done()) {
            EXPECT_EQ(stored, data) << "seed " << seed;
        } else {
            // The last acknowledgement may be the lost frame.
            EXPECT_TRUE(stored.empty() || stored == data) << "seed " << seed;
        }
        (end.done() ? done : failed) += 1;
        p.dictionary.set_bytes({0x2000, 0}, data);
        const auto back = p.read(block);
        if (back.done()) EXPECT_EQ(back.data, data) << "seed " << seed;
    }
    EXPECT_GT(done, 100);
    EXPECT_GT(failed, 10);
}

}  // namespace
}  // namespace axisgate::canopen::test
