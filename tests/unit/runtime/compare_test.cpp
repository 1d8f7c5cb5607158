// A recorded twin is equal to itself, and everything that is changed by hand in its recording is named: a value, a reply time, a message
// that is absent or that nobody asked for, and files that are no recording of this family.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/json.hpp>
#include <ostream>
#include <sstream>

#include "gateway/runtime/compare_input.hpp"
#include "gateway/runtime/compare_report.hpp"
#include "gateway/services/recorder/axr.hpp"
#include "gateway/wire/frame_export.hpp"
#include "tests/unit/runtime/compare_bench.hpp"

namespace axisgate::compare_test {
namespace {
using namespace std::chrono_literals;

struct Compared {
    std::string fault;
    std::optional<ComparisonInput> input;
    Comparison result;
    [[nodiscard]] std::string text() const { return input ? comparison_text(*input, result) : fault; }
};
Compared compared(const Families& all, CompareOptions o, const std::string& bytes) {
    Compared c;
    o.file = "recording";
    c.input = comparison_input(all, o, bytes, "", c.fault);
    if (!c.input) return c;
    c.result = compare(*c.input);
    c.fault = c.result.fault;
    return c;
}
CompareOptions manual(const std::string& family, const std::string& address = {}) {
    CompareOptions o;
    o.family = family;
    o.specimen = "0";
    if (!address.empty()) o.addresses = {address};
    return o;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);)
        out.push_back(line);
    return out;
}
std::string text_of(const std::vector<std::string>& lines) {
    std::string out;
    for (const auto& l : lines)
        out += l + "\n";
    return out;
}
/// The lines that contain this text.
std::vector<std::size_t> places_of(const std::vector<std::string>& lines, const std::string& text) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (lines[i].find(text) != std::string::npos) out.push_back(i);
    return out;
}
std::string replaced(std::string text, const std::string& old, const std::string& by) {
    const auto at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return at == std::string::npos ? text : text.replace(at, old.size(), by);
}
/// The stamps of the lines from `first` on, later by `by`.
void delay(std::vector<std::string>& lines, std::size_t first, Duration by) {
    for (std::size_t i = first; i < lines.size(); ++i) {
        const auto close = lines[i].find(')');
        const double at = std::stod(lines[i].substr(1, close - 1)) + seconds(by);
        char stamp[64];
        (void)std::snprintf(stamp, sizeof stamp, "(%.6f", at);
        lines[i].replace(0, close, stamp);
    }
}
std::size_t count(const Comparison& c, Difference::Kind kind) {
    return static_cast<std::size_t>(std::ranges::count(c.differences, kind, &Difference::kind));
}

/// Node 5 of CiA 402, whose profile acceleration (6083h) is read six times while the gateway polls.
const std::string& servo() {
    static const std::string text = [] {
        RecordedTwin r(families(), {.family = "cia402", .address = "5"});
        r.run(3s);
        for (int i = 0; i < 6; ++i) {
            EXPECT_EQ(r.read("6083h").outcome, Outcome::done);
            r.run(50ms);
        }
        return r.candump();
    }();
    return text;
}

struct Subject {
    std::string_view family, address;
    LineKind kind;
};
class EachFamily : public testing::TestWithParam<Subject> {};

TEST_P(EachFamily, ARecordedTwinIsEqualToItself) {
    const Subject& s = GetParam();
    RecordedTwin r(families(), {.family = std::string(s.family), .address = std::string(s.address), .kind = s.kind});
    r.run(4s);
    const auto c =
        compared(families(), manual(std::string(s.family), std::string(s.address)), s.kind == LineKind::can ? r.candump() : r.hex());
    ASSERT_EQ(c.fault, "");
    EXPECT_GT(c.result.answers, 20u);
    EXPECT_TRUE(c.result.differences.empty()) << c.text();
    EXPECT_TRUE(c.result.changes.empty()) << c.text();
    EXPECT_GE(c.result.equal + 1, c.result.answers) << "a heartbeat at the edge may be without its counterpart\n" << c.text();
}
INSTANTIATE_TEST_SUITE_P(Families, EachFamily,
                         testing::Values(Subject{"uim342", "5", LineKind::can}, Subject{"uim342", "5", LineKind::bytes},
                                         Subject{"cia402", "5", LineKind::can}, Subject{"aposs", "5", LineKind::can},
                                         Subject{"mcode", "!", LineKind::bytes}, Subject{"linmot", "17", LineKind::bytes},
                                         Subject{"pacontrol", "com1", LineKind::bytes}),
                         [](const auto& i) { return std::string(i.param.family) + (i.param.kind == LineKind::can ? "_can" : "_bytes"); });

/// A parameter of a family is written and read, and one answer is replaced by that of a drive with another value.
struct HandChange {
    std::string family, address;
    LineKind kind;
    std::string parameter;
    std::int64_t value, other;  ///< both with the same number of digits, so that the two recordings differ in these answers alone
};
void PrintTo(const HandChange& c, std::ostream* out) { *out << c.family << (c.kind == LineKind::can ? " on CAN" : " on bytes"); }
class EachChange : public testing::TestWithParam<HandChange> {};

struct RecordedText {
    std::vector<std::string> lines;
    std::vector<bool> from_drive;
};
RecordedText recorded_with(const HandChange& c, std::int64_t value) {
    RecordedTwin r(families(), {.family = c.family, .address = c.address, .kind = c.kind});
    r.run(3s);
    const auto point = families().find(c.family).catalogue->find(c.parameter);
    EXPECT_TRUE(point);
    const Result written = r.ask(WriteParameter{*point, Value{value}});
    EXPECT_TRUE(good(written)) << written.text;
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(r.read(c.parameter).outcome, Outcome::done);
        r.run(100ms);
    }
    RecordedText out{lines_of(c.kind == LineKind::can ? r.candump() : r.hex()), {}};
    for (const auto& e : r.entries())
        out.from_drive.push_back(!e.to_drive);
    return out;
}

TEST_P(EachChange, AValueThatWasChangedByHandIsFound) {
    const HandChange& c = GetParam();
    const RecordedText drive = recorded_with(c, c.value), other = recorded_with(c, c.other);
    ASSERT_EQ(drive.lines.size(), other.lines.size());
    ASSERT_EQ(drive.lines.size(), drive.from_drive.size());
    // The stamps may differ, because stuffed bits depend on the value.
    const auto content = [](const std::string& line) { return line.substr(line.find(')')); };
    std::vector<std::size_t> answers;
    for (std::size_t i = 0; i < drive.lines.size(); ++i)
        if (drive.from_drive[i] && content(drive.lines[i]) != content(other.lines[i])) answers.push_back(i);
    ASSERT_GE(answers.size(), 4u);
    auto lines = drive.lines;
    const auto whole = compared(families(), manual(c.family, c.address), text_of(lines));
    ASSERT_EQ(whole.fault, "");
    EXPECT_TRUE(whole.result.differences.empty()) << whole.text();
    const std::size_t at = answers[answers.size() - 2];
    lines[at] = lines[at].substr(0, lines[at].find(')')) + content(other.lines[at]);
    const auto changed = compared(families(), manual(c.family, c.address), text_of(lines));
    ASSERT_EQ(changed.fault, "");
    ASSERT_EQ(changed.result.differences.size(), 1u) << changed.text();
    const Difference& d = changed.result.differences[0];
    EXPECT_EQ(d.kind, Difference::Kind::value) << changed.text();
    EXPECT_NE(d.recorded, d.twin);
    EXPECT_FALSE(d.request.empty());
    EXPECT_EQ(changed.result.unexplained(), 1u);
}
INSTANTIATE_TEST_SUITE_P(Families, EachChange,
                         testing::Values(HandChange{"uim342", "5", LineKind::can, "AC", 4321, 4322},
                                         HandChange{"uim342", "5", LineKind::bytes, "AC", 4321, 4322},
                                         HandChange{"cia402", "5", LineKind::can, "6083h", 4321, 4322},
                                         HandChange{"aposs", "5", LineKind::can, "VELMAX", 1234, 1235},
                                         HandChange{"mcode", "!", LineKind::bytes, "HT", 432, 433},
                                         HandChange{"linmot", "17", LineKind::bytes, "1018h", 432, 433},
                                         HandChange{"pacontrol", "com1", LineKind::bytes, "SP[1]", 4, 5}));

TEST(Compare, AValueThatWasChangedByHandIsFound) {
    auto lines = lines_of(servo());
    const auto places = places_of(lines, "585#43836000");
    ASSERT_EQ(places.size(), 7u) << "one at the start, and six that were asked for";
    lines[places[3]].back() = lines[places[3]].back() == '7' ? '8' : '7';
    CompareOptions o = manual("cia402");
    o.specimen.clear();
    o.seeds = 3;
    const auto c = compared(families(), o, text_of(lines));
    ASSERT_EQ(c.fault, "");
    ASSERT_EQ(c.result.differences.size(), 1u) << c.text();
    const Difference& d = c.result.differences[0];
    EXPECT_EQ(d.kind, Difference::Kind::value);
    EXPECT_NE(d.request.find("read 6083h:00 profile_acceleration?"), std::string::npos) << d.request;
    EXPECT_NE(d.recorded.find("profile_acceleration = "), std::string::npos) << d.recorded;
    EXPECT_NE(d.recorded, d.twin);
    EXPECT_TRUE(d.explained_by.empty());
    EXPECT_EQ(c.result.unexplained(), 1u);
    EXPECT_TRUE(c.result.changes.empty()) << "one wrong answer is no change of the drive";
    EXPECT_NE(c.text().find("no specimen explains it"), std::string::npos) << c.text();
    const auto json = comparison_json(*c.input, c.result);
    EXPECT_EQ(json.at("differences").as_array().at(0).at("kind").as_string(), "value");
    EXPECT_EQ(json.at("scores").as_array().size(), 10u);
}

TEST(Compare, ALateAnswerIsNamedWithItsTime) {
    auto lines = lines_of(servo());
    const auto places = places_of(lines, "585#43836000");
    ASSERT_EQ(places.size(), 7u) << "one at the start, and six that were asked for";
    delay(lines, places[2], 300ms);
    const auto c = compared(families(), manual("cia402", "5"), text_of(lines));
    ASSERT_EQ(c.fault, "");
    // The process data that the drive sent in the same millisecond are late as well.
    EXPECT_EQ(count(c.result, Difference::Kind::late), c.result.differences.size()) << c.text();
    EXPECT_LE(c.result.differences.size(), 3u) << c.text();
    const auto d =
        std::ranges::find_if(c.result.differences, [](const Difference& x) { return x.request.find("6083h") != std::string::npos; });
    ASSERT_NE(d, c.result.differences.end()) << c.text();
    EXPECT_NEAR(seconds(d->reply), 0.3, 0.01);
    EXPECT_NE(c.text().find("after 300."), std::string::npos) << c.text();
}

TEST(Compare, AMessageThatIsMissingOrMoreThanTheTwinSendsIsNamed) {
    auto lines = lines_of(servo());
    const auto places = places_of(lines, "585#43836000");
    ASSERT_EQ(places.size(), 7u) << "one at the start, and six that were asked for";
    auto without = lines;
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(places[4]));
    const auto missing = compared(families(), manual("cia402", "5"), text_of(without));
    ASSERT_EQ(missing.result.differences.size(), 1u) << missing.text();
    EXPECT_EQ(missing.result.differences[0].kind, Difference::Kind::missing);
    EXPECT_NE(missing.result.differences[0].request.find("6083h"), std::string::npos);
    EXPECT_NE(missing.result.differences[0].twin.find("profile_acceleration"), std::string::npos);

    auto more = lines;
    more.insert(more.begin() + static_cast<std::ptrdiff_t>(places[4]) + 1,
                replaced(lines[places[4]], lines[places[4]].substr(lines[places[4]].find("585#")), "085#1081010000000000"));
    const auto extra = compared(families(), manual("cia402", "5"), text_of(more));
    ASSERT_EQ(extra.result.differences.size(), 1u) << extra.text();
    EXPECT_EQ(extra.result.differences[0].kind, Difference::Kind::extra);
    EXPECT_NE(extra.result.differences[0].recorded.find("EMCY"), std::string::npos);
}

TEST(Compare, ADriveThatChangesWhileItIsRecordedIsNamed) {
    auto lines = lines_of(servo());
    const auto places = places_of(lines, "585#43836000");
    ASSERT_EQ(places.size(), 7u) << "one at the start, and six that were asked for";
    for (std::size_t i = 3; i < 7; ++i)
        lines[places[i]].replace(lines[places[i]].find("43836000") + 8, 2, "77");
    const auto c = compared(families(), manual("cia402", "5"), text_of(lines));
    EXPECT_EQ(count(c.result, Difference::Kind::value), 4u) << c.text();
    ASSERT_EQ(c.result.changes.size(), 1u) << c.text();
    EXPECT_NE(c.result.changes[0].request.find("6083h"), std::string::npos);
    EXPECT_NE(c.result.changes[0].before, c.result.changes[0].after);
    EXPECT_NE(c.text().find("the drive changed while it was recorded"), std::string::npos) << c.text();
}

TEST(Compare, ARecordingOfAnotherFamilyIsRefused) {
    EXPECT_NE(compared(families(), manual("uim342"), servo()).fault.find("of another family"), std::string::npos);
    EXPECT_NE(compared(families(), manual("mcode"), servo()).fault.find("CAN frames, which drives of mcode do not have"),
              std::string::npos);
    RecordedTwin r(families(), {.family = "pacontrol", .address = "com1", .kind = LineKind::bytes});
    r.run(2s);
    for (const char* family : {"linmot", "mcode", "uim342"}) {
        const auto c = compared(families(), manual(family), r.hex());
        EXPECT_NE(c.fault, "") << family;
        EXPECT_TRUE(c.fault.find("pacontrol") != std::string::npos || c.fault.find("another family") != std::string::npos ||
                    c.fault.find("has no message") != std::string::npos)
            << c.fault;
    }
    EXPECT_NE(compared(families(), manual("cia402", "9"), servo()).fault.find("it has frames of: 5"), std::string::npos);
    EXPECT_NE(compared(families(), manual("servo"), servo()).fault.find("there is no family servo; families: "), std::string::npos);
}

TEST(Compare, ARecordingThatIsCutOrLacksWhatIsNeededIsRefused) {
    const std::string text = servo();
    const auto fault = [](const std::string& bytes) { return compared(families(), manual("cia402", "5"), bytes).fault; };
    EXPECT_NE(fault(text.substr(0, text.size() - 5)).find("cut in its last line"), std::string::npos);
    EXPECT_NE(fault(text.substr(0, text.size() - 1)).find("cut in its last line"), std::string::npos);
    EXPECT_NE(fault("can0 585#4383600000000000\n").find("has no time"), std::string::npos);
    EXPECT_NE(fault("").find("contains no frames"), std::string::npos);
    EXPECT_NE(fault("(2.0) can0 605#40\n(1.0) can0 585#40\n").find("the time steps back at frame 2"), std::string::npos);
    EXPECT_NE(fault("(2.0) can0 605#40\nnonsense\n").find("recording:2: "), std::string::npos);
    EXPECT_NE(fault("(2.0) can0 605#40\n(2.1) can1 585#40\n").find("choose one with --interface: can0, can1"), std::string::npos);
    EXPECT_NE(compared(families(), manual("mcode"), "(1.0) 41 0A\n").fault.find("no direction"), std::string::npos);
    std::vector<TraceEntry> entries(3);
    for (auto& e : entries)
        e.frame = Frame::run(std::span<const std::uint8_t>());
    const std::string capture = pcapng(entries, "line");
    EXPECT_NE(fault(capture.substr(0, capture.size() - 9)).find("cut off"), std::string::npos);
    EXPECT_NE(fault(std::string(axr_magic) + "x").find("recording"), std::string::npos);
}

TEST(Compare, TheSpecimenThatWasRecordedIsTheBest) {
    const Families all = families_with("uim342", R"([
        {"name":"reply_ms","unit":"ms","min":0,"max":200,"default":0,"description":"d","source":"silent","named":{"slow":150}},
        {"name":"reply_spread_ms","unit":"ms","min":0,"max":200,"default":0,"description":"d","source":"silent"},
        {"name":"lost_per_mille","min":0,"max":100,"default":0,"description":"d","source":"silent"}])");
    RecordedTwin r(all, {.family = "uim342", .address = "5", .twin_options = {{"specimen", "slow"}}});
    r.run(4s);
    CompareOptions o = manual("uim342");
    o.specimen.clear();
    o.seeds = 0;
    const auto c = compared(all, o, r.candump());
    ASSERT_EQ(c.fault, "");
    ASSERT_FALSE(c.result.scores.empty());
    EXPECT_EQ(c.result.scores.front().specimen, "slow") << c.text();
    EXPECT_TRUE(c.result.differences.empty()) << c.text();
    const auto zero = *std::ranges::find(c.result.scores, "0", &SpecimenScore::specimen);
    EXPECT_GT(zero.times, 10u);
    ASSERT_EQ(c.result.best_in_words.size(), 1u);
    EXPECT_NE(c.result.best_in_words[0].find("reply_ms = 150"), std::string::npos);
    // The manual's drive alone: each late answer is named, and those that had not come when the recording ended.
    const auto alone = compared(all, manual("uim342"), r.candump());
    EXPECT_GT(count(alone.result, Difference::Kind::late), 10u);
    EXPECT_LE(count(alone.result, Difference::Kind::missing), 3u);
    EXPECT_EQ(count(alone.result, Difference::Kind::late) + count(alone.result, Difference::Kind::missing), alone.result.differences.size())
        << alone.text();
}

TEST(Compare, MeasuredValuesAreToldSeparately) {
    RecordedTwin r(families(), {.family = "uim342", .address = "5", .pushed = 4321});
    r.run(4s);
    const auto c = compared(families(), manual("uim342"), r.candump());
    ASSERT_EQ(c.fault, "");
    EXPECT_TRUE(c.result.differences.empty()) << c.text();
    ASSERT_FALSE(c.result.measured.empty()) << c.text();
    EXPECT_TRUE(std::ranges::any_of(c.result.measured, [](const auto& m) { return m.largest == 4321; })) << c.text();
}

TEST(Compare, CapturesAndRecordingsAreReadAsWell) {
    RecordedTwin r(families(), {.family = "cia402", .address = "5"});
    r.run(2s);
    const std::string capture = pcapng(r.entries(), "can0");
    AxrWriter w;
    for (const auto& [name, data] : {std::pair{axr_meta, std::string("{}")}, {axr_records, std::string()}, {axr_frames, capture}}) {
        w.begin(name);
        w.add(data);
    }
    for (const std::string& bytes : {capture, w.finish()}) {
        const auto c = compared(families(), manual("cia402"), bytes);
        ASSERT_EQ(c.fault, "");
        EXPECT_EQ(c.input->addresses, std::vector<std::string>{"5"});
        EXPECT_TRUE(c.result.differences.empty()) << c.text();
        EXPECT_GT(c.result.equal, 20u);
    }
}

TEST(Compare, TrafficOfOtherNodesIsNoDifference) {
    auto lines = lines_of(servo());
    std::vector<std::string> busy;
    for (const auto& l : lines) {
        busy.push_back(l);
        const auto at = l.find(" can0 ");
        busy.push_back(l.substr(0, at) + " can0 60A#4041600000000000");
        busy.push_back(l.substr(0, at) + " can0 58A#4B41600037020000");
    }
    const auto c = compared(families(), manual("cia402", "5"), text_of(busy));
    ASSERT_EQ(c.fault, "");
    EXPECT_TRUE(c.result.differences.empty()) << c.text();
}

}  // namespace
}  // namespace axisgate::compare_test
