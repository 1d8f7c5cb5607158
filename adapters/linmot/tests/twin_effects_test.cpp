// The twin: each interpolator command of the catalogue in the same situation (in motion, with the position behind the demand). The final
// position must follow the rule of the command's sub ID.
#include <cmath>

#include "adapters/linmot/tests/twin_bench.hpp"

namespace axisgate::linmot::test {
namespace {
constexpr std::int64_t former = 20'000, given = 3000;  // 0.1 um

/// The command's own values: the position, and limits that fit every width.
std::vector<std::int64_t> values_of(const CatalogueCommand& c) {
    std::vector<std::int64_t> v;
    for (const auto& a : c.arguments) {
        const bool place = a.name == "position" || a.name == "increment" || a.name == "event_position";
        const std::int64_t ramp = a.type == ValueType::u16 ? 60'000 : 1'000'000;
        v.push_back(place ? given : a.name == "velocity" ? 50'000 : a.name == "current_limit" ? 2000 : ramp);
    }
    return v;
}

/// In motion to 2 mm at 0.1 m/s, with the position 5 ms behind.
void set_moving(Bench& b) {
    b.enable();
    (void)b.hand("lag_ms", Value{5.0});
    b.motion("010xh", {former, 100'000, 1'000'000, 1'000'000});
    b.run(12ms);
}

TEST(LinmotEffects, EveryInterpolatorCommandByTheRuleOfItsSubId) {
    std::size_t seen = 0;
    for (const auto& c : page().commands()) {
        if (c.id.size() != 5 || !c.id.ends_with("xh")) continue;
        const int code = std::stoi(c.id.substr(0, 3), nullptr, 16), master = code >> 4, sub = code & 15;
        if (master != 1 && master != 2 && master != 9 && master != 10 && master != 11 && master != 12) continue;
        SCOPED_TRACE(c.id + " " + c.name);
        Bench b;
        set_moving(b);
        const double demand = b.demand(), actual = b.position();
        ASSERT_GT(demand, actual + 1000);
        if (master == 1 && sub == 9) (void)b.hand("analog", Value{std::int64_t{given}});
        b.motion(c.id, values_of(c));
        ++seen;
        const bool press = master == 12 && sub >= 5 && sub <= 7;
        const bool endless = (master == 2 || master == 12) && sub >= 14;
        if (endless) {
            b.run(2s);
            EXPECT_NEAR(std::fabs(b.drive().mechanics().velocity), master == 2 ? 1'000'000 : 500'000, 1);
            EXPECT_EQ(b.drive().mechanics().velocity > 0, sub == 14);
            continue;
        }
        if (sub == 7 && !press) {
            b.run(3s);
            const double deceleration = master == 9 ? 6e6 : 1e8;  // that of the command, or of the quick stop
            EXPECT_NEAR(b.position(), demand + 1e12 / (2 * deceleration), 2);
            EXPECT_EQ(b.sub() & 0x20, 0);
            continue;
        }
        if (sub >= 10) {
            const bool edge = sub <= 13, rising = sub <= 11;
            EXPECT_NE(b.sub() & 0x10, 0) << "armed";
            if (edge && !rising) (void)b.hand("trigger", Value{true});
            b.run(3s);
            EXPECT_EQ(b.position(), former) << "the running motion goes on";
            if (!edge) continue;
            (void)b.hand("trigger", Value{rising});
            b.run(3s);
            EXPECT_EQ(b.position(), (sub & 1) != 0 ? former + given : given);
            continue;
        }
        if (sub == 8) {
            b.run(5ms);
            EXPECT_GT(b.demand(), demand) << "not yet";
        }
        b.run(3s);
        const double wanted = press                  ? given
                              : sub == 1             ? demand + given
                              : sub == 2             ? former + given
                              : sub == 5 || sub == 6 ? actual + given
                                                     : given;
        EXPECT_NEAR(b.position(), wanted, 2);
        if (press) EXPECT_EQ(b.drive().ram(0x13A6), 2000u);
    }
    EXPECT_EQ(seen, 80u);
}

TEST(LinmotEffects, FromActualPlacesTheStartOfTheProfile) {
    const auto after = [](const char* id) {
        Bench b;
        set_moving(b);
        const double actual = b.position();
        b.motion(id, {former, 50'000, 1'000'000, 1'000'000});
        return std::pair{b.demand() - actual, b.drive().mechanics().velocity};
    };
    EXPECT_NEAR(after("013xh").first, 0, 1);
    EXPECT_GT(after("013xh").second, 100'000) << "with the actual velocity";
    EXPECT_NEAR(after("014xh").first, 0, 1);
    EXPECT_NEAR(after("014xh").second, 0, 1) << "with none";
    EXPECT_GT(after("010xh").first, 1000) << "from the demand";
}

TEST(LinmotEffects, CapturedPlacesVariablesAndOutputs) {
    Bench b;
    b.enable();
    b.motion("010xh", {50'000, 100'000, 1'000'000, 1'000'000});
    b.run(2s);
    (void)b.hand("capture", Value{true});
    b.motion("010xh", {0, 100'000, 1'000'000, 1'000'000});
    b.run(2s);
    b.motion("0D0xh", {1000, 100'000, 1'000'000, 1'000'000});
    b.run(2s);
    EXPECT_EQ(b.position(), 51'000) << "the captured position and 0.1 mm";
    b.motion("240xh", {7000});
    b.motion("242xh", {-9000});
    for (const auto& [id, place] : {std::pair{"0D4xh", 7000.0}, {"0D5xh", -9000.0}, {"0D6xh", 7000.0}, {"0D7xh", -9000.0}}) {
        b.motion(id, {100'000, 1'000'000, 1'000'000});
        b.run(2s);
        EXPECT_EQ(b.position(), place) << id;
    }
    b.motion("0D1xh", {2500, 50'000, 60'000});
    b.run(2s);
    EXPECT_EQ(b.position(), 2500);
    b.motion("003xh", {0x0005, 0x0007});
    EXPECT_EQ(b.drive().outputs_x4(), 0x0005) << "the masked bits alone";
    b.motion("003xh", {0x0001, 0x0000});
    EXPECT_EQ(b.drive().outputs_x4(), 0x0004);
    b.motion("004xh", {0x0003, 0x0002});
    EXPECT_EQ(b.drive().outputs_x6(), 0x0002);
}

TEST(LinmotEffects, CurvesFromTheSetPointAndWithoutAnAddress) {
    Bench b;
    b.enable();
    auto& c = b.drive().curves[1];
    c.info.assign(70, 0);
    c.info[32] = 0x10;
    c.info[33] = 0x27;  // 0.1 s
    for (const int p : {5000, 15'000})
        Bench::put(c.data, p, 4);
    b.motion("010xh", {40'000, 100'000, 1'000'000, 1'000'000});
    b.run(2s);
    b.motion("041xh", {1});
    b.run(1s);
    EXPECT_EQ(b.position(), 50'000) << "from the set point on, whatever the curve's own start";
    b.motion("050xh", {1, 0x0FFF});
    EXPECT_FALSE(b.drive().curves.contains(1)) << "0FFFh: no curve";
    Bench none(Bench::Options{{"series", "b1100"}, {"keys", "none"}});
    none.enable();
    none.motion("110xh", {1, 0});
    none.run(1s);
    EXPECT_EQ(none.drive().state_var(), 0x0481) << "cams need their key";
}

}  // namespace
}  // namespace axisgate::linmot::test
