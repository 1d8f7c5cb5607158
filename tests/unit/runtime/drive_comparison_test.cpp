// A drive on a line against its twin: equal drives are equal, a value that differs is found, and so is one that changes meanwhile; nothing
// is written, nothing moves; and what the drive holds becomes the memory of its twin.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <regex>

#include "gateway/core/only_reads.hpp"
#include "tests/unit/runtime/compare_bench.hpp"
#include "tests/unit/runtime/line_sweep_bench.hpp"

namespace axisgate::compare_test {
namespace {
using namespace std::chrono_literals;
using Kind = ComparedValue::Kind;

/// A family on one of its lines; a parameter that its drives keep, and another value of it.
struct Case {
    std::string family, address;
    LineKind kind = LineKind::can;
    std::string parameter;
    std::int64_t value = 0;
    std::string question;  ///< what the decoder says of a message that only asks
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.family << (c.kind == LineKind::can ? " on CAN" : " on bytes"); }

const ComparedValue* row_of(const DriveComparison& c, std::string_view id) {
    const auto it = std::ranges::find(c.rows, id, &ComparedValue::id);
    return it == c.rows.end() ? nullptr : &*it;
}
std::string text_of(const DriveComparison& c) {
    std::string out = c.fault + c.replies.fault;
    for (const auto& r : c.rows)
        out += "\n" + std::string(name_of(r.kind)) + " " + r.id + ": " + to_text(r.drive) + " / " + to_text(r.twin) + " " + r.text;
    for (const auto& d : c.replies.outside)
        out += "\n" + std::string(name_of(d.kind)) + " " + d.request + " -> " + d.recorded + " " + std::to_string(seconds(d.reply));
    return out;
}
SweptLine::Wish wish_of(const Case& c) { return {.family = c.family, .address = c.address, .kind = c.kind}; }

class EachDrive : public testing::TestWithParam<Case> {};

TEST_P(EachDrive, AnEqualDriveIsEqualAndIsLeftAsItIs) {
    const Case& c = GetParam();
    SweptLine line(wish_of(c));
    const auto memory = line.drive().non_volatile();
    const auto revision = line.drive().non_volatile_revision();
    const TwinMechanics before = line.drive().mechanics(1, line.gateway().now());
    line.sweep();
    ASSERT_EQ(line.result().fault(), "");
    const DriveComparison compared = line.compared();
    EXPECT_EQ(compared.differences(), 0u) << text_of(compared);
    EXPECT_EQ(compared.replies.fault, "");
    EXPECT_GT(compared.read, 10u);
    EXPECT_EQ(compared.adoption.not_adopted.size() >= compared.adoption.adopted.size(), true);
    // The drive: its memory, its shaft, its power.
    EXPECT_EQ(line.drive().non_volatile_revision(), revision);
    EXPECT_EQ(line.drive().non_volatile(), memory);
    const TwinMechanics after = line.drive().mechanics(1, line.gateway().now());
    EXPECT_EQ(after.powered, before.powered);
    EXPECT_EQ(after.position, before.position);
}

TEST_P(EachDrive, AValueThatDiffersIsFoundAndAdopted) {
    const Case& c = GetParam();
    // Another twin gives the drive its memory: the value is written to it and kept.
    LineSweepWish w{.family = c.family, .uri = "twin", .address = c.address};
    if (c.kind == LineKind::bytes) w.options["kind"] = "bytes";
    const TwinPlace place{families(), site_of(w, families()), LineSweep::axis_name};
    const auto plan = sweep_plan(*families().find(c.family).catalogue);
    const Adoption held = adopt(place, {}, plan.points, {{c.parameter, Value{c.value}}});
    ASSERT_EQ(held.adopted, std::vector<std::string>{c.parameter})
        << (held.not_adopted.empty() ? "" : held.not_adopted.front().parameter + ": " + held.not_adopted.front().reason);

    auto wish = wish_of(c);
    wish.memory = held.memory;
    SweptLine line(wish);
    line.sweep();
    ASSERT_EQ(line.result().fault(), "");
    const DriveComparison compared = line.compared();
    const ComparedValue* row = row_of(compared, c.parameter);
    ASSERT_TRUE(row) << text_of(compared);
    EXPECT_EQ(row->kind, Kind::value);
    EXPECT_EQ(as_number(row->drive), static_cast<double>(c.value));
    EXPECT_NE(as_number(row->twin), static_cast<double>(c.value));
    EXPECT_FALSE(row->name.empty());
    EXPECT_GE(compared.differences(), 1u);
    // The twin with the adopted memory is this drive.
    const auto& adopted = compared.adoption.adopted;
    EXPECT_NE(std::ranges::find(adopted, c.parameter), adopted.end()) << text_of(compared);
    const DriveComparison again = compare_drive(line.result().input(compared.adoption.memory, 20ms));
    EXPECT_EQ(row_of(again, c.parameter), nullptr) << text_of(again);
    for (const auto& f : compared.adoption.not_adopted)
        EXPECT_FALSE(f.reason.empty()) << f.parameter;
}

/// Everything that the adapter sends by itself, and the questions: the decoder's sentences say what is a write.
TEST_P(EachDrive, TheDriveGetsNothingButQuestions) {
    const Case& c = GetParam();
    SweptLine line(wish_of(c));
    line.sweep();
    ASSERT_EQ(line.result().fault(), "");
    const auto entry = families().find(c.family);
    const auto decoder = entry.family->make_decoder(*entry.catalogue, c.kind);
    const auto input = line.result().input({}, 20ms);
    const std::regex question(c.question);
    std::size_t asked = 0;
    for (const SeenFrame& f : input.frames) {
        for (const std::string& text : decoder->on_frame(f.frame, f.to_drive)) {
            if (f.to_drive != true) continue;
            ++asked;
            EXPECT_TRUE(std::regex_search(text, question)) << text;
        }
    }
    EXPECT_GT(asked, 2 * input.sweep.values.size() - 1);
}

const std::string sdo = R"(read [0-9A-F]{4}h:[0-9A-F]{2}.*\?$|segment of)", uirobot = "^[^=]*$", prints = R"(PR )",
                  reads = "reads |asks|curve message 08h|table message 05h", gets = "get|read|state|cmd_send";
INSTANTIATE_TEST_SUITE_P(
    Families, EachDrive,
    testing::Values(Case{"cia402", "5", LineKind::can, "6083h", 4321, sdo}, Case{"aposs", "3", LineKind::can, "VELMAX", 1234, sdo},
                    Case{"uim342", "5", LineKind::can, "AC", 4321, uirobot}, Case{"uim342", "5", LineKind::bytes, "AC", 4321, uirobot},
                    Case{"mcode", "!", LineKind::bytes, "HT", 432, prints}, Case{"linmot", "17", LineKind::bytes, "1018h.rom", 432, reads},
                    Case{"pacontrol", "com1", LineKind::bytes, "SP[1]", 4, gets}));

TEST(DriveComparison, AValueThatChangesMeanwhileIsNamed) {
    SweptLine line({.family = "uim342", .address = "5"});
    bool changed = false;
    std::size_t answered = 0;
    line.sweep([&] {
        answered = line.frames();
        if (changed || answered < 300) return;
        auto memory = line.drive().non_volatile();
        memory["AC"] = Value{std::int64_t{7777}};
        line.restart(memory);
        changed = true;
    });
    ASSERT_TRUE(changed);
    const DriveComparison compared = line.compared();
    const ComparedValue* row = row_of(compared, "AC");
    ASSERT_TRUE(row) << text_of(compared);
    EXPECT_EQ(row->kind, Kind::changed) << text_of(compared);
    EXPECT_EQ(as_integer(row->again), 7777);
}

TEST(DriveComparison, ADriveThatVanishesInTheMiddleIsNamed) {
    SweptLine line({.family = "uim342", .address = "5"});
    bool gone = false;
    line.sweep([&] {
        if (std::exchange(gone, gone || line.frames() > 200) || !gone) return;
        line.set_hand("power", Value{false});
    });
    ASSERT_TRUE(gone);
    EXPECT_EQ(line.result().fault(), "");
    const DriveComparison compared = line.compared();
    EXPECT_NE(compared.fault.find("was not answered"), std::string::npos) << compared.fault;
    EXPECT_GT(compared.read, 5u);
    EXPECT_EQ(compared.differences(), 0u) << text_of(compared);
}

TEST(DriveComparison, ADriveOfAnotherFamilyOrNoneIsNamed) {
    SweptLine other({.family = "aposs", .address = "127", .asked_family = "cia402"});
    other.sweep();
    EXPECT_NE(other.result().fault().find("no cia402 at address"), std::string::npos) << other.result().fault();
    SweptLine nobody({.family = "uim342", .address = "5"});
    nobody.set_hand("power", Value{false});
    nobody.sweep();
    EXPECT_NE(nobody.result().fault().find("nothing was received"), std::string::npos) << nobody.result().fault();
}

TEST(DriveComparison, ALateDriveIsNamedWithItsTimes) {
    SweptLine line({.family = "uim342", .address = "5", .drive_options = {{"reply_ms", "35"}}});
    line.sweep();
    const DriveComparison compared = line.compared(5ms);
    ASSERT_FALSE(compared.replies.outside.empty());
    EXPECT_GE(compared.replies.shortest, 35ms) << text_of(compared);
    EXPECT_GT(compared.replies.outside.size(), compared.read);  // each is asked twice
    for (const auto& d : compared.replies.outside)
        EXPECT_EQ(d.kind, Difference::Kind::late);
    // Its own specimen explains it.
    SweptLine known({.family = "uim342", .address = "5", .drive_options = {{"reply_ms", "35"}}, .twin_options = {{"reply_ms", "35"}}});
    known.sweep();
    EXPECT_TRUE(known.compared(5ms).replies.outside.empty()) << text_of(known.compared(5ms));
}

/// Reading ER clears it, so it is not read, and an error that stands in the drive is still there afterwards.
TEST(DriveComparison, WhatReadingWouldChangeIsLeftOut) {
    SweptLine line({.family = "mcode", .address = "!", .kind = LineKind::bytes});
    line.set_hand("inject_error", Value{std::int64_t{74}});
    line.sweep();
    ASSERT_EQ(line.result().fault(), "");
    const DriveComparison compared = line.compared();
    const auto left = std::ranges::find(compared.left_out, "ER", &JobFailure::parameter);
    ASSERT_NE(left, compared.left_out.end());
    EXPECT_EQ(left->reason, "reading it clears it and EF");
    const ComparedValue* flag = row_of(compared, "EF");
    ASSERT_TRUE(flag) << text_of(compared) << "\n" << compared.read << " " << compared.equal;
    EXPECT_EQ(as_integer(flag->drive), 1);
}

}  // namespace
}  // namespace axisgate::compare_test
