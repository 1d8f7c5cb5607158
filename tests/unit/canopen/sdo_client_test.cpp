// Every message as in the standard, and the reactions to servers that send wrong data, lose or repeat something.
#include "gateway/protocols/canopen/sdo_client.hpp"

#include <array>
#include <set>

#include "tests/unit/canopen/bench.hpp"

namespace axisgate::canopen::test {
namespace {

struct Client : testing::Test {
    SdoLimits limits;
    SdoClient client{5, limits};
    std::vector<Frame> out;
    Instant now = time_zero + 1s;

    std::optional<SdoEnd> receive(std::string_view text) { return client.on_frame(frame(text), now, out); }
    Texts sent() { return taken(out); }
    void read(Address a, bool block = false) { ASSERT_TRUE(client.read(a, now, out, block)); }
    void write(Address a, std::vector<std::uint8_t> data, bool block = false) {
        ASSERT_TRUE(client.write(a, std::move(data), now, out, block));
    }
};

TEST_F(Client, ReadsAnExpeditedValue) {
    read({0x1018, 1});
    EXPECT_EQ(sent(), Texts{"605#4018100100000000"});
    const auto end = receive("585#4318100178563412");
    ASSERT_TRUE(end);
    EXPECT_TRUE(end->done());
    EXPECT_EQ(end->data, (std::vector<std::uint8_t>{0x78, 0x56, 0x34, 0x12}));
    EXPECT_EQ(sent(), Texts{}) << "an expedited answer is the end";
    EXPECT_FALSE(client.busy());
    EXPECT_EQ(client.deadline(), never);
}
TEST_F(Client, TakesTheLengthOfAnExpeditedValueFromItsCommand) {
    for (const auto& [answer, bytes] : {std::pair{"585#4F00600008AABBCC", 1u},
                                        {"585#4B00600008AABBCC", 2u},
                                        {"585#4700600008AABBCC", 3u},
                                        {"585#4300600008AABBCC", 4u},
                                        {"585#4200600008AABBCC", 4u}}) {
        read({0x6000, 0});
        const auto end = receive(answer);
        ASSERT_TRUE(end && end->done()) << answer;
        EXPECT_EQ(end->data.size(), bytes) << answer;
    }
}
TEST_F(Client, WritesOneToFourBytesAtOnce) {
    const std::pair<std::vector<std::uint8_t>, std::string> cases[] = {{{6}, "605#2F40600006000000"},
                                                                       {{6, 1}, "605#2B40600006010000"},
                                                                       {{6, 1, 2}, "605#2740600006010200"},
                                                                       {{6, 1, 2, 3}, "605#2340600006010203"}};
    for (const auto& [data, request] : cases) {
        write({0x6040, 0}, data);
        EXPECT_EQ(sent(), Texts{request});
        const auto end = receive("585#6040600000000000");
        ASSERT_TRUE(end);
        EXPECT_TRUE(end->done() && end->write);
    }
}
TEST_F(Client, ReadsSegmentsWithAnAlternatingToggle) {
    read({0x1008, 0});
    sent();
    EXPECT_FALSE(receive("585#4108100009000000"));
    EXPECT_EQ(sent(), Texts{"605#6000000000000000"});
    EXPECT_FALSE(receive("585#0053657276 6F2061"));
    EXPECT_EQ(sent(), Texts{"605#7000000000000000"});
    const auto end = receive("585#1B2031000000 0000");
    ASSERT_TRUE(end && end->done());
    EXPECT_EQ(end->data, bytes_of_text("Servo a 1"));
}
TEST_F(Client, ReadsSegmentsWithoutATotal) {
    read({0x1008, 0});
    EXPECT_FALSE(receive("585#4008100000000000"));
    const auto end = receive("585#0D41000000000000");
    ASSERT_TRUE(end && end->done());
    EXPECT_EQ(end->data, bytes_of_text("A"));
}
TEST_F(Client, WritesSegments) {
    write({0x1F50, 1}, bytes_of_text("123456789"));
    EXPECT_EQ(sent(), Texts{"605#21501F0109000000"});
    EXPECT_FALSE(receive("585#60501F0100000000"));
    EXPECT_EQ(sent(), Texts{"605#0031323334353637"});
    EXPECT_FALSE(receive("585#2000000000000000"));
    EXPECT_EQ(sent(), Texts{"605#1B38390000000000"});
    const auto end = receive("585#3000000000000000");
    EXPECT_TRUE(end && end->done());
}
TEST_F(Client, WritesAnEmptyValueAsOneEmptySegment) {
    write({0x1F50, 1}, {});
    EXPECT_EQ(sent(), Texts{"605#21501F0100000000"});
    EXPECT_FALSE(receive("585#60501F0100000000"));
    EXPECT_EQ(sent(), Texts{"605#0F00000000000000"});
    const auto end = receive("585#2000000000000000");
    EXPECT_TRUE(end && end->done());
}

// ---- faults -----------------------------------------------------------------------------------------------------------
TEST_F(Client, TellsWhatTheNodeRefused) {
    read({0x1018, 9});
    sent();
    const auto end = receive("585#8018100911000906");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::no_subindex);
    EXPECT_TRUE(end->by_node);
    EXPECT_EQ(to_text(*end), "1018h:09 could not be read: the node refused: the subindex does not exist (06090011h)");
    EXPECT_EQ(sent(), Texts{});
}
TEST_F(Client, AnAbortInTheMiddleLeavesNothingOfTheValue) {
    read({0x1008, 0});
    (void)receive("585#4108100009000000");
    (void)receive("585#00536572766F2061");
    const auto end = receive("585#8008100000000008");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::general);
    EXPECT_TRUE(end->data.empty());
    EXPECT_FALSE(client.busy());
}
TEST_F(Client, AnAbortWithoutACodeIsAnAbortAllTheSame) {
    read({0x1008, 0});
    const auto end = receive("585#8008100000000000");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::general);
}
TEST_F(Client, AnAbortOfAnotherTransferIsAStray) {
    read({0x1008, 0});
    EXPECT_FALSE(receive("585#8009100000000008"));
    EXPECT_TRUE(client.busy());
    EXPECT_EQ(client.strays(), 1u);
}
TEST_F(Client, AWrongToggleEndsARead) {
    read({0x1008, 0});
    (void)receive("585#4108100009000000");
    sent();
    const auto end = receive("585#10536572766F2061");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::toggle);
    EXPECT_FALSE(end->by_node);
    EXPECT_EQ(sent(), Texts{"605#8008100000000305"});
}
TEST_F(Client, AWrongToggleEndsAWrite) {
    write({0x1F50, 1}, bytes_of_text("123456789"));
    (void)receive("585#60501F0100000000");
    sent();
    const auto end = receive("585#3000000000000000");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::toggle);
    EXPECT_EQ(sent(), Texts{"605#80501F0100000305"});
}
TEST_F(Client, MoreBytesThanAnnouncedAreALie) {
    read({0x1008, 0});
    (void)receive("585#4108100005000000");
    sent();
    const auto end = receive("585#00536572766F2061");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::length);
    EXPECT_EQ(sent(), Texts{"605#8008100010000706"});
}
TEST_F(Client, FewerBytesThanAnnouncedAreALie) {
    read({0x1008, 0});
    (void)receive("585#4108100009000000");
    const auto end = receive("585#0141424344454647");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::length);
    EXPECT_TRUE(end->data.empty());
}
TEST_F(Client, ASizeAboveTheLimitIsRefusedBeforeABitOfItCame) {
    read({0x1008, 0});
    sent();
    const auto end = receive("585#41081000FFFFFFFF");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::memory);
    EXPECT_EQ(sent(), Texts{"605#8008100005000405"});
}
TEST_F(Client, TheLimitHoldsForAValueInOneMessageToo) {
    client = SdoClient(5, {.most_bytes = 2});
    read({0x1018, 1});
    const auto end = receive("585#4318100178563412");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::memory);
    EXPECT_TRUE(end->data.empty());
}
TEST_F(Client, SegmentsWithoutEndStopAtTheLimit) {
    client = SdoClient(5, {.most_bytes = 20});
    read({0x1008, 0});
    (void)receive("585#4008100000000000");
    EXPECT_FALSE(receive("585#0041424344454647"));
    EXPECT_FALSE(receive("585#1041424344454647"));
    const auto end = receive("585#0041424344454647");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::memory);
}
TEST_F(Client, EmptySegmentsDoNotGoOnForEver) {
    read({0x1008, 0});
    (void)receive("585#4008100000000000");
    const auto end = receive("585#0E00000000000000");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::length);
}
TEST_F(Client, ACommandThatDoesNotFitEndsTheTransfer) {
    read({0x1008, 0});
    (void)receive("585#4108100009000000");
    const auto end = receive("585#6008100000000000");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::command);
}
TEST_F(Client, TheAnswerToSomethingElseIsAStray) {
    read({0x6041, 0});
    EXPECT_FALSE(receive("585#4B64600011110000")) << "another object: late, of a transfer that was given up";
    EXPECT_FALSE(receive("585#6041600000000000")) << "the answer to a write";
    EXPECT_FALSE(receive("585#00536572766F2061")) << "a segment";
    EXPECT_FALSE(receive("585#4B416000")) << "half a message";
    EXPECT_FALSE(receive("586#4B41600037060000")) << "of another node: not even a stray";
    EXPECT_EQ(client.strays(), 4u);
    const auto end = receive("585#4B41600037060000");
    ASSERT_TRUE(end && end->done());
    EXPECT_EQ(end->data, (std::vector<std::uint8_t>{0x37, 0x06}));
    EXPECT_FALSE(receive("585#4B41600037060000")) << "twice";
    EXPECT_EQ(client.strays(), 5u);
}
TEST_F(Client, SilenceEndsATransferAndTellsTheNode) {
    read({0x6041, 0});
    sent();
    EXPECT_EQ(client.deadline(), now + 500ms);
    EXPECT_FALSE(client.on_deadline(now + 499ms, out));
    const auto end = client.on_deadline(now + 500ms, out);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::timeout);
    EXPECT_EQ(to_text(*end), "6041h:00 could not be read: the node did not answer in time");
    EXPECT_EQ(sent(), Texts{"605#8041600000000405"});
}
TEST_F(Client, EachAnswerGivesNewPatience) {
    read({0x1008, 0});
    now += 400ms;
    (void)receive("585#4108100009000000");
    EXPECT_EQ(client.deadline(), now + 500ms);
}
TEST_F(Client, OneTransferAtATime) {
    read({0x6041, 0});
    sent();
    EXPECT_FALSE(client.read({0x6064, 0}, now, out));
    EXPECT_FALSE(client.write({0x6064, 0}, {1}, now, out));
    EXPECT_EQ(sent(), Texts{});
    const auto end = client.stop(Abort::local_control, out);
    ASSERT_TRUE(end);
    EXPECT_EQ(sent(), Texts{"605#8041600021000008"});
    EXPECT_FALSE(client.stop(Abort::general, out));
}

// ---- blocks -----------------------------------------------------------------------------------------------------------
struct BlockClient : Client {
    BlockClient() { client = SdoClient(5, {.block_size = 3, .stalls = 1}); }
};

TEST_F(BlockClient, ReadsBlocksWithTheirChecksum) {
    read({0x1008, 0}, true);
    EXPECT_EQ(sent(), Texts{"605#A408100003000000"});
    EXPECT_FALSE(receive("585#C608100009000000"));
    EXPECT_EQ(sent(), Texts{"605#A300000000000000"});
    EXPECT_FALSE(receive("585#0131323334353637"));
    EXPECT_EQ(sent(), Texts{});
    EXPECT_FALSE(receive("585#8238390000000000"));
    EXPECT_EQ(sent(), Texts{"605#A202030000000000"});
    const auto end = receive("585#D5C3310000000000");  // five bytes of the last segment are none; 31C3h
    ASSERT_TRUE(end && end->done());
    EXPECT_EQ(end->data, bytes_of_text("123456789"));
    EXPECT_EQ(sent(), Texts{"605#A100000000000000"});
}
TEST_F(BlockClient, AWrongChecksumLeavesNothing) {
    read({0x1008, 0}, true);
    (void)receive("585#C608100009000000");
    (void)receive("585#0131323334353637");
    (void)receive("585#8238390000000000");
    sent();
    const auto end = receive("585#D5C4310000000000");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::crc);
    EXPECT_TRUE(end->data.empty());
    EXPECT_EQ(sent(), Texts{"605#8008100004000405"});
}
TEST_F(BlockClient, WithoutAChecksumOfTheNodeNoneIsChecked) {
    read({0x1008, 0}, true);
    (void)receive("585#C208100009000000");
    (void)receive("585#0131323334353637");
    (void)receive("585#8238390000000000");
    const auto end = receive("585#D500000000000000");
    EXPECT_TRUE(end && end->done());
}
TEST_F(BlockClient, ALostSegmentIsAskedForAgain) {
    read({0x1008, 0}, true);
    (void)receive("585#C60810000F000000");
    sent();
    (void)receive("585#0131323334353637");
    EXPECT_FALSE(receive("585#8333000000000000")) << "the second is missing";
    EXPECT_EQ(sent(), Texts{"605#A201030000000000"});
    EXPECT_FALSE(receive("585#0138393031323334"));
    EXPECT_FALSE(receive("585#8235000000000000"));
    EXPECT_EQ(sent(), Texts{"605#A202030000000000"});
    const auto crc = sdo_crc(bytes_of_text("123456789012345"));
    const std::array<std::uint8_t, 8> last{0xD9, static_cast<std::uint8_t>(crc), static_cast<std::uint8_t>(crc >> 8)};
    const auto end = client.on_frame(data_frame(0x585, last), now, out);
    ASSERT_TRUE(end && end->done());
    EXPECT_EQ(end->data, bytes_of_text("123456789012345"));
}
TEST_F(BlockClient, BlocksThatBringNothingEndTheTransfer) {
    read({0x1008, 0}, true);
    (void)receive("585#C60810000F000000");
    sent();
    EXPECT_FALSE(receive("585#0333333333333333"));
    EXPECT_EQ(sent(), Texts{"605#A200030000000000"});
    const auto end = receive("585#0333333333333333");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::sequence);
}
TEST_F(BlockClient, ASequenceNumberAboveTheBlockSizeIsNone) {
    read({0x1008, 0}, true);
    (void)receive("585#C60810000F000000");
    const auto end = receive("585#0433333333333333");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::sequence);
}
TEST_F(BlockClient, MoreSegmentsThanAnnouncedAreALie) {
    read({0x1008, 0}, true);
    (void)receive("585#C608100007000000");
    (void)receive("585#0131323334353637");
    const auto end = receive("585#0231323334353637");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::length);
}
TEST_F(BlockClient, MoreUnusedBytesThanThereAreIsALie) {
    read({0x1008, 0}, true);
    (void)receive("585#C208100009000000");
    (void)receive("585#0131323334353637");
    (void)receive("585#8238390000000000");
    const auto end = receive("585#C100000000000000");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::length) << "14 bytes, and 9 were announced";
}
TEST_F(BlockClient, ANodeWithoutBlocksIsReadByThePlainProtocol) {
    read({0x1008, 0}, true);
    sent();
    EXPECT_FALSE(receive("585#8008100001000405"));
    EXPECT_EQ(sent(), Texts{"605#4008100000000000"});
    const auto end = receive("585#4308100031323334");
    EXPECT_TRUE(end && end->done());
}
TEST_F(BlockClient, ANodeWithoutBlocksIsWrittenByThePlainProtocol) {
    write({0x6040, 0}, {6, 0}, true);
    EXPECT_EQ(sent(), Texts{"605#C640600002000000"});
    EXPECT_FALSE(receive("585#8000000001000405")) << "and names no place";
    EXPECT_EQ(sent(), Texts{"605#2B40600006000000"});
    const auto end = receive("585#6040600000000000");
    EXPECT_TRUE(end && end->done());
}
TEST_F(BlockClient, ANodeMayAnswerABlockReadByThePlainProtocol) {
    read({0x6041, 0}, true);
    const auto end = receive("585#4B41600037060000");
    ASSERT_TRUE(end && end->done());
    EXPECT_EQ(end->data.size(), 2u);
}
TEST_F(BlockClient, WritesBlocksAndRepeatsFromTheLastGoodSegment) {
    write({0x1F50, 1}, bytes_of_text("123456789012345"), true);
    EXPECT_EQ(sent(), Texts{"605#C6501F010F000000"});
    EXPECT_FALSE(receive("585#A4501F0102000000"));
    EXPECT_EQ(sent(), (Texts{"605#0131323334353637", "605#0238393031323334"}));
    EXPECT_FALSE(receive("585#A201040000000000"));
    EXPECT_EQ(sent(), (Texts{"605#0138393031323334", "605#8235000000000000"}));
    EXPECT_FALSE(receive("585#A202040000000000"));
    const auto crc = sdo_crc(bytes_of_text("123456789012345"));
    std::array<std::uint8_t, 8> last{0xD9, static_cast<std::uint8_t>(crc), static_cast<std::uint8_t>(crc >> 8)};
    EXPECT_EQ(sent(), Texts{text(data_frame(0x605, last))});
    const auto end = receive("585#A100000000000000");
    EXPECT_TRUE(end && end->done());
}
TEST_F(BlockClient, ABlockSizeOfZeroIsRefused) {
    write({0x1F50, 1}, bytes_of_text("12345678"), true);
    sent();
    const auto end = receive("585#A4501F0100000000");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::block_size);
    EXPECT_EQ(sent(), Texts{"605#80501F0102000405"});
}
TEST_F(BlockClient, ABlockSizeOf128IsRefusedInTheMiddle) {
    write({0x1F50, 1}, bytes_of_text("12345678"), true);
    (void)receive("585#A4501F0101000000");
    const auto end = receive("585#A201800000000000");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::block_size);
}
TEST_F(BlockClient, AnAcknowledgementOfWhatWasNotSentIsRefused) {
    write({0x1F50, 1}, bytes_of_text("12345678"), true);
    (void)receive("585#A4501F0101000000");
    const auto end = receive("585#A202010000000000");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::sequence);
}
TEST_F(BlockClient, ANodeThatTakesNothingIsGivenUp) {
    write({0x1F50, 1}, bytes_of_text("12345678"), true);
    (void)receive("585#A4501F0101000000");
    EXPECT_FALSE(receive("585#A200010000000000"));
    const auto end = receive("585#A200010000000000");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::sequence);
}
TEST_F(BlockClient, TheNodeFindsTheChecksumWrong) {
    write({0x1F50, 1}, bytes_of_text("12345678"), true);
    (void)receive("585#A4501F017F000000");
    (void)receive("585#A2027F0000000000");
    const auto end = receive("585#80501F0104000405");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->abort, Abort::crc);
    EXPECT_TRUE(end->by_node);
}

TEST(Aborts, EachOfTheStandardHasWordsOfItsOwn) {
    std::set<std::string> words;
    for (const Abort a : all_aborts()) {
        EXPECT_FALSE(words_of(a).empty()) << std::hex << static_cast<std::uint32_t>(a);
        words.insert(std::string(words_of(a)));
    }
    EXPECT_EQ(words.size(), 31u);
    EXPECT_EQ(to_text(Abort::no_object), "the object does not exist (06020000h)");
    EXPECT_EQ(to_text(static_cast<Abort>(0x12345678)), "abort code 12345678h, which CiA 301 does not have");
}
TEST(SdoCrc, IsTheOneOfTheStandard) { EXPECT_EQ(sdo_crc(bytes_of_text("123456789")), 0x31C3); }

}  // namespace
}  // namespace axisgate::canopen::test
