// The errata of the manual that concern a name, a layout or a value: catalogue and twin must have the corrected form.
#include "adapters/linmot/motion_commands.hpp"
#include "adapters/linmot/tests/page.hpp"

#include <gtest/gtest.h>

#include <set>

namespace axisgate::linmot::test {
namespace {
struct Row {
    const char* erratum;
    const char* id;
    const char* name;
    const char* layout;  ///< name:type, in order
};
std::string layout_of(const CatalogueCommand& c) {
    std::string s;
    for (const auto& a : c.arguments) {
        const char* type = a.type == ValueType::i16 ? "i16" : a.type == ValueType::u16 ? "u16" : a.type == ValueType::i32 ? "i32" : "u32";
        s += (s.empty() ? "" : " ") + a.name + ":" + type;
    }
    return s;
}

TEST(LinmotErrata, NamesAndLayoutsOfMotionCommands) {
    for (const Row& r : {
             Row{"E-01", "027xh", "Predef VAI Stop With Quick Stop Deceleration", ""},
             Row{"E-02", "02Dxh", "Predef VAI Increment Target Pos On Falling Trigger Event", "increment:i32"},
             Row{"E-03", "031xh", "PV Stream With Slave Generated Time Stamp", "position:i32 velocity:i32"},
             Row{"E-05", "069xh", "Setup Encoder Cam On Rising Trigger Event With Delay Counts", "curve:u16 delay:i32"},
             Row{"E-06", "06Exh", "Setup Encoder Cam On Falling Trigger Event With Delay Counts, Amplitude scale and Length",
                 "curve:u16 delay:i32 amplitude_scale:i16 length:i32"},
             Row{"E-07", "07Fxh", "Stop Position Indexing And Predef VAI Go To Pos", "position:i32"},
             Row{"E-08", "096xh", "VAI 16 Bit Increment Act Pos Starting With Dem Vel = 0",
                 "increment:i16 velocity:u16 acceleration:u16 deceleration:u16"},
             Row{"E-09", "09Fxh", "VAI 16 Bit Change Motion Parameters On Negative Position Transition",
                 "event_position:i16 velocity:u16 acceleration:u16 deceleration:u16"},
             Row{"E-10", "0A3xh", "Predef VAI 16 Bit Go To Pos From Act Pos And Act Vel", "position:i16"},
             Row{"E-12", "0ACxh", "Predef VAI 16 Bit Go To Pos On Falling Trigger Event", "position:i16"},
             Row{"E-13", "0ADxh", "Predef VAI 16 Bit Increment Target Pos On Falling Trigger Event", "increment:i16"},
             Row{"E-14", "0DFxh", "VAI Start Trig Fall Config VAI Command", ""},
             Row{"E-15", "0D0xh", "VAI Increment Captured Pos", "increment:i32 velocity:u32 acceleration:u32 deceleration:u32"},
             Row{"E-16", "209xh", "Modify Command Table 32 bit Parameter in RAM", "entry:u16 offset:u16 value:i32"},
             Row{"E-17", "212xh", "Wait Until In Target Position", ""},
             Row{"E-18", "22Exh", "Wait Until Current Greater Than", "level:i16"},
             Row{"E-19", "252xh", "IF Cmd Table Var 2 Less Than", "value:i32 entry_if_true:u16 entry_if_false:u16"},
             Row{"E-20", "25Exh", "IF Current Less Than", "value:i32 entry_if_true:u16 entry_if_false:u16"},
             Row{"E-21", "052xh", "Modify Curve Info Block 32 Bit Value in RAM", "curve:u16 offset:u16 value:i32"},
             Row{"E-24", "113xh", "Encoder Cam 1 Define Curve From Pos To Pos In Counts",
                 "curve:u16 start:i32 start_position:i32 position:i32 length:i32"},
             Row{"E-24", "128xh", "Encoder Cam 2 Change Amplitude Scale and Length", "amplitude_scale:i16 length:i32"},
         }) {
        const auto* c = page().command(r.id);
        ASSERT_TRUE(c) << r.erratum;
        EXPECT_EQ(c->name, r.name) << r.erratum;
        EXPECT_EQ(layout_of(*c), r.layout) << r.erratum;
    }
}

TEST(LinmotErrata, NoCommandIsLongerThanTheBufferAndNoNameStandsTwice) {
    const Motions all(page());
    EXPECT_EQ(all.size(), 216u) << "E-11: rebuilt from the codes";
    std::set<std::string> names;
    std::size_t longest = 0;
    for (const auto& c : page().commands()) {
        const Motion* m = all.named(c.id);
        if (!m) continue;
        EXPECT_TRUE(names.insert(c.name).second) << c.name;
        longest = std::max(longest, Motions::pack(*m, 0, std::vector<Value>(c.arguments.size(), Value{std::int64_t{1}})).size());
    }
    EXPECT_EQ(longest, 20u) << "E-25: 16 words at most; none needs more than 10";
}

TEST(LinmotErrata, CodesAndParameters) {
    std::set<std::int32_t> codes;
    for (const auto& e : page().errors())
        codes.insert(e.code);
    EXPECT_EQ(codes.size(), 84u);
    for (const int gap : {0x1F, 0x26, 0x27, 0x2D, 0x2F, 0x3D, 0x3F, 0x43, 0x48, 0x4F, 0x52, 0x57, 0x59, 0x5F, 0x66, 0x6A, 0x7F})
        EXPECT_FALSE(codes.contains(gap)) << "E-40: " << gap;
    EXPECT_TRUE(codes.contains(0x24)) << "E-31: kept, without a trigger";
    const auto* text = page().error(0x41);
    ASSERT_TRUE(text);
    EXPECT_EQ(text->name, "dig_out_x4_4_x4_11_status") << "E-33";
    const auto parameter = [](const char* id) { return page().parameter(*page().find(id)); };
    EXPECT_EQ(parameter("1BC8h")->name, "power_bridge_temp_ph2_plus") << "E-29";
    EXPECT_EQ(parameter("1BC9h")->name, "power_bridge_temp_ph2") << "E-29";
    for (const char* id : {"1018h", "1019h", "101Ah", "101Bh"})
        EXPECT_NE(parameter(id)->name.find("motor_supply"), std::string::npos) << "E-30: " << id;
    EXPECT_EQ(parameter("171Ch")->name, "brake_release_delay") << "E-32";
    EXPECT_EQ(parameter("13CAh")->name, "slider_home_position") << "E-47";
    for (const auto& [value, name] : parameter("128Eh")->allowed)
        EXPECT_NE(value, 3) << "E-41";
    EXPECT_FALSE(page().check_write(*page().find("128Eh"), Value{std::int64_t{3}}).fault.empty()) << "E-41";
    EXPECT_TRUE(page().find("14BFh") && page().find("13BAh") && page().find("13A6h")) << "E-37";
}

}  // namespace
}  // namespace axisgate::linmot::test
