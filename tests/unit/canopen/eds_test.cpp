// Three files of different style, every possible fault in one, and a DCF that is read as it was written.
#include "gateway/protocols/canopen/eds.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <array>
#include <fstream>
#include <iterator>

#include "gateway/protocols/canopen/pdo.hpp"
#include "tests/unit/canopen/bench.hpp"

namespace axisgate::canopen::test {
namespace {
using testing::HasSubstr;

std::string file(const std::string& name) {
    std::ifstream in(AXISGATE_SOURCE_DIR "/tests/unit/canopen/eds/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
struct Read {
    std::vector<FileFault> faults, notes;
    std::optional<Eds> eds;
    explicit Read(std::string_view text) { eds = read_eds(text, faults, notes); }
    [[nodiscard]] std::string all() const {
        std::string t;
        for (const auto& f : faults)
            t += std::to_string(f.line) + ": " + f.text + "\n";
        return t;
    }
    [[nodiscard]] std::string noted() const {
        std::string t;
        for (const auto& f : notes)
            t += std::to_string(f.line) + ": " + f.text + "\n";
        return t;
    }
};
Value number(std::int64_t n) { return Value{n}; }

TEST(EdsFiles, TheClassicStyle) {
    const Read r(file("servo.eds"));
    ASSERT_TRUE(r.eds) << r.all();
    EXPECT_EQ(r.noted(), "");
    const Eds& e = *r.eds;
    EXPECT_EQ(e.vendor, "Example Motion");
    EXPECT_EQ(e.vendor_number, 0x1ABu);
    EXPECT_EQ(e.revision_number, 0x10002u);
    EXPECT_EQ(e.kbits, (std::vector<std::uint32_t>{20, 50, 125, 250, 500, 1000}));
    EXPECT_EQ(e.objects.size(), 22u);
    EXPECT_EQ(e.objects.at(0x607D).shape, EdsShape::array);
    const EdsEntry& mode = e.entries.at({0x6060, 0});
    EXPECT_EQ(mode.type, DataType::integer8);
    EXPECT_EQ(mode.access, EntryAccess::read_write_output);
    EXPECT_TRUE(mode.mappable);
    EXPECT_EQ(mode.low.value, number(-1));
    EXPECT_EQ(mode.high.value, number(10));
    EXPECT_EQ(mode.fallback.value, number(1));
    EXPECT_EQ(e.entries.at({0x607D, 1}).fallback.value, number(INT32_MIN)) << "hex digits are the bits of the number";
    EXPECT_EQ(e.entries.at({0x1008, 0}).fallback.value, Value{std::string("Servo One")});
    EXPECT_EQ(e.entries.at({0x2000, 0}).fallback.value, Value{25.5});
    EXPECT_EQ(e.entries.at({0x2001, 0}).fallback.value, Value{static_cast<double>(0.1f)}) << "bits of a REAL32";
    EXPECT_FALSE(e.entries.at({0x6041, 0}).fallback.given());
    EXPECT_EQ(e.entries.at({0x1200, 1}).fallback.of(5), number(0x605));
}
TEST(EdsFiles, TheShortStyle) {
    const Read r(file("compact.eds"));
    ASSERT_TRUE(r.eds) << r.all();
    EXPECT_EQ(r.noted(), "");
    const Eds& e = *r.eds;
    EXPECT_EQ(e.vendor, "Müller Antriebe") << "Latin-1";
    EXPECT_EQ(e.kbits, (std::vector<std::uint32_t>{125, 1000}));
    EXPECT_EQ(e.entries.at({0x6099, 0}).fallback.value, number(2));
    EXPECT_EQ(e.entries.at({0x6099, 2}).name, "speed to zero");
    EXPECT_EQ(e.entries.at({0x6099, 2}).fallback.value, number(100)) << "octal";
    EXPECT_EQ(e.entries.at({0x2010, 254}).name, "points254");
    EXPECT_TRUE(e.entries.at({0x2010, 254}).mappable);
    EXPECT_FALSE(e.entries.contains({0x2010, 255}));
    EXPECT_EQ(e.entries.at({0x2011, 0}).fallback.value, number(-2));
    EXPECT_EQ(e.entries.at({0x2012, 0}).type, DataType::domain);
    EXPECT_EQ(e.entries.at({0x2012, 0}).access, EntryAccess::write_only);
}
TEST(EdsFiles, ADcfByHand) {
    const Read r(file("by_hand.dcf"));
    ASSERT_TRUE(r.eds) << r.all();
    const Eds& e = *r.eds;
    ASSERT_TRUE(e.commissioning);
    EXPECT_EQ(*e.commissioning, (Commissioning{0x21, "feeder µm", 500}));
    EXPECT_EQ(e.vendor, "\"Third & Sons\"");
    EXPECT_FALSE(e.revision_number);
    EXPECT_EQ(e.entries.at({0x1000, 0}).fallback.value, number(0x20192)) << "a comment behind a number";
    EXPECT_EQ(e.entries.at({0x1014, 0}).fallback.of(0x21), number(0xA1));
    EXPECT_EQ(e.entries.at({0x1014, 0}).configured.of(0x21), number(0x21));
    EXPECT_EQ(e.entries.at({0x3000, 0}).configured.value, Value{false});
    EXPECT_EQ(e.entries.at({0x3001, 0}).fallback.value, Value{std::string("0102FF")});
    EXPECT_EQ(e.entries.at({0x3001, 0}).configured.value, Value{std::string("AABB")});
    EXPECT_EQ(e.entries.at({0x3002, 0}).fallback.value, number(INT64_MIN));
    EXPECT_EQ(e.entries.at({0x3002, 0}).configured.value, number(INT64_MAX));
    EXPECT_EQ(e.entries.at({0x3003, 0}).fallback.value, Value{0.001});
    EXPECT_EQ(e.entries.at({0x3004, 0}).configured.value, Value{std::string("line = 3; left")});
    EXPECT_FALSE(e.entries.at({0x3005, 0}).high.given());
    EXPECT_EQ(e.entries.at({0x3006, 0}).fallback.value, number(-1));
    EXPECT_EQ(e.entries.at({0x3006, 0}).flags, 1u);
    EXPECT_THAT(r.noted(), HasSubstr("1014h stands in no list"));
    EXPECT_THAT(r.noted(), HasSubstr("HighLimit of 3005h:00 is above 2^63 - 1"));
    EXPECT_THAT(r.noted(), HasSubstr("DefaultValue of 3007h:00 is outside its limits"));
    EXPECT_THAT(r.noted(), HasSubstr("1018h tells 3 subindices and has 2"));
    EXPECT_EQ(r.notes.size(), 4u) << r.noted();
}

// ---- faults -----------------------------------------------------------------------------------------------------------
const std::string head = "[DeviceInfo]\nVendorName=x\n[MandatoryObjects]\n1=0x1000\n";  // four lines
std::string object(std::string_view keys) { return head + "[1000]\nParameterName=a\n" + std::string(keys); }

struct NoteCase {
    std::string text;
    std::size_t line;
    std::string words;
};
/// Each odd row of a file is a note with its line that says what was done; the file is read all the same.
TEST(EdsNotes, AnOddRowIsToldAndTheFileIsRead) {
    const std::string good = "DataType=7\nAccessType=ro\n";
    const std::string whole = object(good);  // eight lines
    const NoteCase cases[] = {
        {whole + "just words\n", 9, "\"just words\" is neither a section nor a key with a value: left out"},
        {"a=1\n" + whole, 1, "the key a stands before the first section: left out"},
        {whole + "=5\n", 9, "neither a section nor a key"},
        {whole + "[1000sub\xED]\n", 9, "[1000sub\u00ED]: \"\u00ED\" is no subindex (two hex digits): left out"},
        {whole + "[1000sub" + std::string(99, 'x') + "]\n", 9, "[1000sub" + std::string(33, 'x') + "...]: \""},
        {head + "[1000 ; device type\nParameterName=a\n" + good, 5, "has no ]: read as [1000]"},
        {whole + "[DEVICEINFO]\nVendorName=y\n", 9, "the section [deviceinfo] stands twice, first in line 1: the second one is left out"},
        {object(good + "datatype=6\n"), 9, "the key datatype stands twice in [1000]: the first one counts"},
        {"[1000]\nParameterName=a\n" + good, 0, "the section [DeviceInfo] is missing"},
        {whole + "[OptionalObjects]\n1=0x2000\n", 10, "the object 2000h is listed and has no section"},
        {whole + "[OptionalObjects]\n1=soon\n", 10, "\"soon\" is no index of an object: left out"},
        {whole + "[OptionalObjects]\n1=0x1000\n", 10, "the object 1000h is listed twice"},
        {whole + "[OptionalObjects]\nSupportedObjects=4\n", 9, "tells 4 objects and lists 0"},
        {"[DeviceInfo]\nProductNumber=many\n[1000]\n" + good, 2, "productnumber of [deviceinfo] is \"many\""},
        {whole + "[2000]\nAccessType=ro\nObjectType=7\n", 9, "2000h:00 has no DataType: left out"},
        {object("DataType=0x23\nAccessType=ro\n"), 7, "DataType \"0x23\" of 1000h:00 is none of CiA 301's simple types: read as bytes"},
        {object("DataType=0x40 ; ours\nAccessType=ro\n"), 7, "DataType \"0x40\" of 1000h:00"},
        {object("DataType=integer32\nAccessType=ro\n"), 7, "DataType of 1000h:00 is written as \"integer32\": read as 4"},
        {object("DataType=7\n"), 5, "1000h:00 has no AccessType: read as ro"},
        {object("DataType=7\nAccessType=always\n"), 8, "AccessType \"always\" of 1000h:00 is none"},
        {object(good + "DefaultValue=five\n"), 9, "DefaultValue \"five\" of 1000h:00 is no UNSIGNED32: left out"},
        {object(good + "DefaultValue=-1\n"), 9, "is no UNSIGNED32: left out"},
        {object(good + "DefaultValue=0x1FFFFFFFF\n"), 9, "is no UNSIGNED32"},
        {object(good + "DefaultValue=08\n"), 9, "DefaultValue of 1000h:00 is written as \"08\": read as 8"},
        {object(good + "DefaultValue=10UL\n"), 9, "is written as \"10UL\": read as 10"},
        {object(good + "DefaultValue=100 ms\n"), 9, "is written as \"100 ms\": read as 100"},
        {object(good + "DefaultValue=100.0\n"), 9, "is written as \"100.0\": read as 100"},
        {object(good + "DefaultValue=1Fh\n"), 9, "is written as \"1Fh\": read as 31"},
        {object(good + "DefaultValue=0x1Fh\n"), 9, "is written as \"0x1Fh\": read as 31"},
        {object(good + "DefaultValue=1.5\n"), 9, "is no UNSIGNED32"},
        {object("DataType=3\nAccessType=ro\nDefaultValue=0x10000\n"), 9, "is no INTEGER16"},
        {object("DataType=3\nAccessType=ro\nDefaultValue=32768\n"), 9, "is no INTEGER16"},
        {object("DataType=8\nAccessType=ro\nDefaultValue=1e99\n"), 9, "is no REAL32"},
        {object("DataType=8\nAccessType=ro\nDefaultValue=0x7F800000\n"), 9, "is no REAL32"},
        {object("DataType=8\nAccessType=ro\nDefaultValue=$NODEID+1\n"), 9, "only whole numbers hang on the node number"},
        {object(good + "LowLimit=5\nHighLimit=4\n"), 5, "LowLimit of 1000h:00 is above its HighLimit: both are left out"},
        {object("DataType=4\nAccessType=ro\nLowLimit=0\nHighLimit=0xFFFFFFFF\n"), 5, "above its HighLimit: both are left out"},
        {object(good + "HighLimit=-1\n"), 9, "HighLimit \"-1\" of 1000h:00 is no UNSIGNED32: left out"},
        {object(good + "PDOMapping=2\n"), 9, "pdomapping of [1000] is \"2\""},
        {object(good + "ObjectType=3\n"), 5, "ObjectType of 1000h is none (2 domain, 7 variable, 8 array, 9 record): read as 7"},
        {whole + "[2000]\nObjectType=8\nSubNumber=1\n", 9, "2000h has no entry that can be read: left out"},
        {whole + "[2000]\nObjectType=8\nCompactSubObj=255\n" + good, 11, "must be a whole number up to 254"},
        {whole + "[1001sub0]\n" + good, 9, "[1001sub0] has no object [1001]: read as a record without a name"},
        {whole + "[1000sub100]\n" + good, 9, "\"100\" is no subindex (two hex digits): left out"},
        {whole + "[1000sub1]\n" + good, 5, "1000h is a variable with subindices: read as a record"},
        {object("ObjectType=8\nCompactSubObj=1\n" + good) + "[1000sub1]\n" + good, 11, "1000h:01 is described twice"},
        {whole + "[DeviceComissioning]\nNodeID=0\n", 9, "NodeID of [DeviceComissioning] is missing, or not 1 to 127: left out"},
        {whole + "[DeviceCommissioning]\nNodeName=x\n", 9, "NodeID of [DeviceComissioning] is missing"},
    };
    for (const auto& c : cases) {
        const Read r(c.text);
        ASSERT_TRUE(r.eds) << c.words << "\n" << r.all();
        EXPECT_FALSE(r.eds->entries.empty());
        const auto told = std::ranges::find_if(r.notes, [&](const FileFault& n) { return n.text.find(c.words) != std::string::npos; });
        ASSERT_NE(told, r.notes.end()) << c.words << "\n" << r.noted();
        EXPECT_EQ(told->line, c.line) << c.words;
    }
    const Read r(whole);
    EXPECT_TRUE(r.eds && r.notes.empty()) << "all of them are made of a good one: " << r.noted();
}
TEST(EdsNotes, RowsOfMakersThatNeedNone) {
    // CR alone, comments behind words and numbers, empty keys, NODEID without its sign.
    std::string text = head +
                       "[1000]\nParameterName=a\nDataType=7 ; UNSIGNED32\nAccessType=RW ; and more\nLowLimit=\nHighLimit= ; none\n"
                       "DefaultValue=;\nPDOMapping=\n[2000]\nDataType=7\nAccessType=ro\nDefaultValue=NodeID + 0x10\n"
                       "[OptionalObjects]\nSupportedObjects=1\n1=0x2000\n2=\n";
    const Read usual(text);
    std::ranges::replace(text, '\n', '\r');
    const Read r(text);
    ASSERT_TRUE(r.eds && usual.eds) << r.all();
    EXPECT_EQ(r.noted(), "");
    EXPECT_TRUE(*r.eds == *usual.eds);
    const EdsEntry& e = r.eds->entries.at({0x1000, 0});
    EXPECT_EQ(e.type, DataType::unsigned32);
    EXPECT_EQ(e.access, EntryAccess::read_write);
    EXPECT_FALSE(e.fallback.given() || e.low.given() || e.high.given()) << "an empty value is none";
    EXPECT_EQ(r.eds->entries.at({0x2000, 0}).fallback.of(5), number(0x15));
}
TEST(EdsNotes, OfADuplicateTheFirstCounts) {
    const Read r(object("DataType=7\nAccessType=ro\nDefaultValue=1\nDefaultValue=2\n[1000]\nDataType=3\nDefaultValue=3\n"));
    ASSERT_TRUE(r.eds);
    EXPECT_EQ(r.eds->entries.at({0x1000, 0}).type, DataType::unsigned32);
    EXPECT_EQ(r.eds->entries.at({0x1000, 0}).fallback.value, number(1));
}
TEST(EdsNotes, HaveABound) {
    std::string text = object("DataType=7\nAccessType=ro\n");
    for (int i = 0; i < 5000; ++i)
        text += "words\n";
    const Read many(text);
    EXPECT_TRUE(many.eds);
    EXPECT_EQ(many.notes.size(), most_file_faults + 1);
    EXPECT_EQ(many.notes.back().text, "there are more notes");
}
TEST(EdsFaults, AFileWithoutAnObjectIsNone) {
    for (const std::string& text : {std::string(), std::string("just words\n"), head, std::string("\0\1\2", 3)}) {
        const Read r(text);
        EXPECT_FALSE(r.eds);
        ASSERT_EQ(r.faults.size(), 1u);
        EXPECT_EQ(r.faults[0].text, "no object is described: this is no EDS or DCF");
    }
}
TEST(EdsFaults, AMegabyteOfSectionsIsRefusedInWords) {
    std::string text = head;
    for (int i = 0; text.size() < 1'000'000; ++i)
        text += "[s" + std::to_string(i) + "]\n";
    const Read r(text);
    EXPECT_FALSE(r.eds);
    ASSERT_EQ(r.faults.size(), 1u);
    EXPECT_THAT(r.faults[0].text, HasSubstr("more than 20000 sections: this is no description of a drive"));
    EXPECT_EQ(r.faults[0].line, 4 + 20'000 - 2 + 1u);
}
TEST(EdsFaults, ATooLargeFileIsRefusedUnread) {
    const Read r(std::string(Ini::most_bytes + 1, 'x'));
    ASSERT_EQ(r.faults.size(), 1u);
    EXPECT_EQ(r.faults[0].text, "the file has 4194305 bytes, and 4194304 are the most");
}
TEST(EdsFaults, CompactArraysDoNotGrowWithoutBound) {
    std::string text = "[DeviceInfo]\n";
    for (int i = 0; i < 300; ++i) {
        text += fmt::format("[{:04X}]\nObjectType=8\nDataType=5\nAccessType=rw\nCompactSubObj=254\n", 0x2000 + i);
    }
    const Read r(text);
    EXPECT_FALSE(r.eds);
    ASSERT_EQ(r.faults.size(), 1u) << r.all();
    EXPECT_THAT(r.faults[0].text, HasSubstr("more than 50000 entries"));
}

// ---- what is made of it -----------------------------------------------------------------------------------------------
TEST(EdsDictionary, HasTypesBoundsAndTheNodesIdentifiers) {
    const Read r(file("servo.eds"));
    ASSERT_TRUE(r.eds);
    Dictionary d = dictionary_of(*r.eds, 7);
    EXPECT_EQ(d.integer({0x1800, 1}), 0x40000187);
    EXPECT_EQ(d.write({0x6060, 0}, std::array<std::uint8_t, 1>{11}, true), Abort::too_high);
    EXPECT_EQ(d.find({0x6041, 0})->mappable, Mappable::transmit);
    EXPECT_EQ(d.find({0x6040, 0})->mappable, Mappable::receive);
    EXPECT_EQ(d.find({0x6081, 0})->bytes.size(), 4u);
    Abort fault{};
    const auto pdo = pdo_of(d, PdoDirection::transmit, 1, fault);
    ASSERT_TRUE(pdo) << to_text(fault);
    EXPECT_EQ(pdo->settings.id, 0x187u);
    EXPECT_EQ(fault_of(pdo->mapping, PdoDirection::transmit, d), Abort::none);
}

TEST(Dcf, IsReadAsItWasWritten) {
    for (const char* name : {"servo.eds", "compact.eds", "by_hand.dcf"}) {
        const Read r(file(name));
        ASSERT_TRUE(r.eds) << name;
        std::vector<std::string> left_out;
        const Commissioning c{9, "x", 250};
        const std::string text = write_dcf(*r.eds, c, {}, {"02:15PM", "11-22-2026"}, left_out);
        EXPECT_TRUE(left_out.empty());
        const Read again(text);
        ASSERT_TRUE(again.eds) << name << "\n" << again.all();
        Eds expected = *r.eds;
        expected.commissioning = c;
        EXPECT_TRUE(*again.eds == expected) << name;
    }
}
TEST(Dcf, HoldsTheValuesOfOneDevice) {
    const Read r(file("servo.eds"));
    std::vector<std::string> left_out;
    const std::map<Address, Value> values{{{0x6081, 0}, number(70'000)}, {{0x607D, 1}, number(-5)},
                                          {{0x2001, 0}, Value{0.25}},    {{0x1008, 0}, Value{std::string("two\nlines")}},
                                          {{0x6060, 0}, number(1000)},   {{0x9999, 0}, number(1)}};
    const std::string text = write_dcf(*r.eds, {5, "feeder\n[x]", 0}, values, {}, left_out);
    EXPECT_THAT(text, HasSubstr("[DeviceComissioning]\r\nNodeID=5\r\nNodeName=feeder [x]\r\n"));
    EXPECT_THAT(left_out, testing::ElementsAre("1008h:00 (VISIBLE_STRING): a DCF cannot hold this value",
                                               "6060h:00 (INTEGER8): a DCF cannot hold this value", "9999h:00 is not in the description"));
    const Read again(text);
    ASSERT_TRUE(again.eds) << again.all();
    EXPECT_EQ(again.eds->entries.at({0x6081, 0}).configured.value, number(70'000));
    EXPECT_EQ(again.eds->entries.at({0x607D, 1}).configured.value, number(-5));
    EXPECT_EQ(again.eds->entries.at({0x2001, 0}).configured.value, Value{0.25});
    EXPECT_FALSE(again.eds->entries.at({0x1008, 0}).configured.given());
    EXPECT_EQ(dictionary_of(*again.eds, 5).integer({0x6081, 0}), 70'000);
}

}  // namespace
}  // namespace axisgate::canopen::test
