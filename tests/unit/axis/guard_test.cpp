// Every bound at its edge: one below, equal, one above.
#include "gateway/axis/guard.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "gateway/axis/cia402.hpp"

namespace axisgate {
namespace {
using Kind = Move::Kind;
constexpr std::int64_t i32_min = std::numeric_limits<std::int32_t>::min(), i32_max = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t u32_max = std::numeric_limits<std::uint32_t>::max();
constexpr std::int64_t i64_max = std::numeric_limits<std::int64_t>::max(), i64_min = std::numeric_limits<std::int64_t>::min();

AxisLimits limited() {
    AxisLimits l;
    l.position_min = -100;
    l.position_max = 200;
    l.velocity_max = 50;
    l.acceleration_max = 70;
    return l;
}
Move move(Kind kind, std::int64_t target) {
    Move m;
    m.kind = kind;
    m.target = target;
    return m;
}

struct Case {
    const char* name;
    Kind kind;
    std::int64_t target, position;
    bool limits, passes;
};

TEST(Guard, EachBoundOfAMotionAtItsEdge) {
    constexpr std::array cases{
        Case{"position_min, one below", Kind::absolute, -101, 0, true, false},
        Case{"position_min", Kind::absolute, -100, 0, true, true},
        Case{"position_min, one above", Kind::absolute, -99, 0, true, true},
        Case{"position_max, one below", Kind::absolute, 199, 0, true, true},
        Case{"position_max", Kind::absolute, 200, 0, true, true},
        Case{"position_max, one above", Kind::absolute, 201, 0, true, false},
        Case{"an end below by a distance", Kind::relative, -111, 10, true, false},
        Case{"an end at position_min by a distance", Kind::relative, -110, 10, true, true},
        Case{"an end at position_max by a distance", Kind::relative, 190, 10, true, true},
        Case{"an end above by a distance", Kind::relative, 191, 10, true, false},
        Case{"least place of 32 bits, one below", Kind::absolute, i32_min - 1, 0, false, false},
        Case{"least place of 32 bits", Kind::absolute, i32_min, 0, false, true},
        Case{"greatest place of 32 bits", Kind::absolute, i32_max, 0, false, true},
        Case{"greatest place of 32 bits, one above", Kind::absolute, i32_max + 1, 0, false, false},
        Case{"a distance that ends at 32 bits", Kind::relative, i32_max - 5, 5, false, true},
        Case{"a distance that ends above 32 bits", Kind::relative, i32_max - 4, 5, false, false},
        Case{"a distance that wraps 64 bits", Kind::relative, i64_max, 1, false, false},
        Case{"a distance that wraps 64 bits downwards", Kind::relative, i64_min, -1, false, false},
        Case{"speed of 32 bits downwards, one more", Kind::velocity, -i32_max - 1, 0, false, false},
        Case{"speed of 32 bits downwards", Kind::velocity, -i32_max, 0, false, true},
        Case{"speed of 32 bits", Kind::velocity, i32_max, 0, false, true},
        Case{"speed of 32 bits, one more", Kind::velocity, i32_max + 1, 0, false, false},
        Case{"velocity_max downwards, one more", Kind::velocity, -51, 0, true, false},
        Case{"velocity_max downwards", Kind::velocity, -50, 0, true, true},
        Case{"velocity_max, one less", Kind::velocity, 49, 0, true, true},
        Case{"velocity_max", Kind::velocity, 50, 0, true, true},
        Case{"velocity_max, one more", Kind::velocity, 51, 0, true, false},
        Case{"up from below position_max", Kind::velocity, 1, 199, true, true},
        Case{"up from position_max", Kind::velocity, 1, 200, true, false},
        Case{"up from above position_max", Kind::velocity, 1, 201, true, false},
        Case{"down from position_max", Kind::velocity, -1, 200, true, true},
        Case{"down from above position_min", Kind::velocity, -1, -99, true, true},
        Case{"down from position_min", Kind::velocity, -1, -100, true, false},
        Case{"down from below position_min", Kind::velocity, -1, -101, true, false},
        Case{"up from position_min", Kind::velocity, 1, -100, true, true},
        Case{"to rest at position_max", Kind::velocity, 0, 200, true, true},
        Case{"to rest at position_min", Kind::velocity, 0, -100, true, true},
    };
    for (const Case& c : cases) {
        const auto r = guard_move(move(c.kind, c.target), c.limits ? limited() : AxisLimits{}, c.position);
        EXPECT_EQ(!r.has_value(), c.passes) << c.name << (r ? ": " + r->text : "");
        if (r) EXPECT_EQ(r->reason, Reason::out_of_range) << c.name;
    }
}

struct Rate {
    std::int64_t value;
    bool limits, passes;
};
/// {rate, with limits, passes} of one limit.
std::array<Rate, 8> rates(std::int64_t max) {
    return {Rate{-1, true, false}, Rate{0, true, false},       Rate{1, true, true},        Rate{max - 1, true, true},
            Rate{max, true, true}, Rate{max + 1, true, false}, Rate{u32_max, false, true}, Rate{u32_max + 1, false, false}};
}

TEST(Guard, EachRateOfAMotionAtItsEdge) {
    for (const Kind kind : {Kind::absolute, Kind::relative, Kind::velocity}) {
        for (const auto member : {&Move::velocity, &Move::acceleration, &Move::deceleration}) {
            const bool velocity = member == &Move::velocity;
            for (const Rate& r : rates(velocity ? 50 : 70)) {
                Move m = move(kind, 0);
                m.*member = r.value;
                const auto refused = guard_move(m, r.limits ? limited() : AxisLimits{}, 0);
                EXPECT_EQ(!refused.has_value(), r.passes) << r.value << (refused ? ": " + refused->text : "");
                const char* name = velocity ? "velocity" : member == &Move::acceleration ? "acceleration" : "deceleration";
                if (refused) EXPECT_EQ(refused->text.find(name), 0u) << refused->text;
            }
        }
    }
}

/// A limit of 0 is a limit: no motion may be that fast. It does not mean "no limit".
TEST(Guard, ALimitOfZeroRefusesEveryRate) {
    AxisLimits l;
    l.velocity_max = l.acceleration_max = 0;
    for (const auto member : {&Move::velocity, &Move::acceleration, &Move::deceleration}) {
        Move m = move(Kind::absolute, 0);
        EXPECT_FALSE(guard_move(m, l, 0)) << "as the drive has it";
        m.*member = 1;
        EXPECT_TRUE(guard_move(m, l, 0));
    }
    EXPECT_FALSE(guard_move(move(Kind::velocity, 0), l, 0));
    EXPECT_TRUE(guard_move(move(Kind::velocity, 1), l, 0));
    EXPECT_TRUE(guard_move(move(Kind::velocity, -1), l, 0));
}

TEST(Guard, EachRegisterAtItsEdge) {
    struct Register {
        std::optional<std::uint32_t> ProcessData::*member;
        std::int64_t max;
    };
    for (const Register& reg : {Register{&ProcessData::profile_velocity, 50}, Register{&ProcessData::profile_acceleration, 70},
                                Register{&ProcessData::profile_deceleration, 70}}) {
        for (const Rate& r : rates(reg.max)) {
            if (r.value < 0 || r.value > u32_max) continue;
            ProcessData d;
            d.*(reg.member) = static_cast<std::uint32_t>(r.value);
            const bool passes = r.passes || r.value == 0;  // 0: the drive's own value
            EXPECT_EQ(!guard_process_data(d, r.limits ? limited() : AxisLimits{}).has_value(), passes) << r.value;
        }
    }
    for (const auto& [speed, passes] : {std::pair{-51, false}, {-50, true}, {0, true}, {50, true}, {51, false}}) {
        ProcessData d;
        d.target_velocity = speed;
        EXPECT_EQ(!guard_process_data(d, limited()).has_value(), passes) << speed;
    }
    ProcessData least;
    least.target_velocity = std::numeric_limits<std::int32_t>::min();
    EXPECT_TRUE(guard_process_data(least, {})) << "it has no opposite";
    AxisLimits here = limited();
    here.position_max = here.position_min = 0;
    ProcessData d;
    d.target_velocity = 50;
    EXPECT_FALSE(guard_process_data(d, here)) << "whether it leads out of the limits is asked when it moves the axis";
    d = {};
    d.target_position = 100000;
    EXPECT_FALSE(guard_process_data(d, here)) << "a target is judged with its set-point";
}

TEST(Guard, LimitsAreRoundedToIncrementsAndToTheLastNumberWhereTheyHaveNoPlace) {
    AxisSpec a;
    a.increments_per_unit = 10;
    a.unit = "mm";
    a.position_min = -0.96;
    a.position_max = 1.25;
    a.velocity_max = 0;
    a.acceleration_max = 1e300;
    const AxisLimits l = AxisLimits::of(a);
    EXPECT_EQ(l.position_min, -10);
    EXPECT_EQ(l.position_max, 13);
    EXPECT_EQ(l.velocity_max, 0);
    ASSERT_TRUE(l.acceleration_max) << "beyond 64 bits it is a limit still";
    EXPECT_GT(*l.acceleration_max, 9'000'000'000'000'000'000);
    EXPECT_EQ(in_unit(25, l, "/s"), "2.5 mm/s");
    EXPECT_EQ(in_unit(25, {}, "/s"), "25 increments/s");
    EXPECT_FALSE(AxisLimits::of(AxisSpec{}).velocity_max);
}

TEST(Guard, WordsOfWhatIsRefused) {
    const auto words = [](const Move& m, std::int64_t position) { return guard_move(m, limited(), position)->text; };
    EXPECT_NE(words(move(Kind::absolute, -101), 0).find("below the axis' position_min -100"), std::string::npos);
    EXPECT_NE(words(move(Kind::absolute, 201), 0).find("above the axis' position_max 200"), std::string::npos);
    EXPECT_NE(words(move(Kind::velocity, 1), 200).find("its position_max is 200"), std::string::npos);
    EXPECT_NE(words(move(Kind::velocity, -1), -100).find("its position_min is -100"), std::string::npos);
    EXPECT_NE(words(move(Kind::velocity, 51), 0).find("limit of 50"), std::string::npos);
}

TEST(Guard, AModeIsWrittenWhereTheDriveOffersItAndNoStreamBeginsIt) {
    using namespace cia402;
    const std::array<std::int16_t, 4> offered{mode_profile_position, mode_profile_velocity, mode_cyclic_position, mode_profile_torque};
    EXPECT_FALSE(guard_mode(mode_none, {})) << "0 changes nothing";
    EXPECT_FALSE(guard_mode(mode_profile_position, offered));
    EXPECT_FALSE(guard_mode(mode_profile_velocity, offered));
    const auto absent = guard_mode(mode_homing, offered), streamed = guard_mode(mode_cyclic_position, offered);
    ASSERT_TRUE(absent && streamed);
    EXPECT_NE(absent->text.find("is not offered by this drive; use 1 (profile position), 3 (profile velocity)"), std::string::npos)
        << absent->text;
    EXPECT_NE(streamed->text.find("begins with the first streamed set-point"), std::string::npos) << streamed->text;
    EXPECT_EQ(streamed->text.find("8 (cyclic synchronous position),"), std::string::npos) << "it is no choice";
    EXPECT_TRUE(guard_mode(mode_profile_torque, offered));
    EXPECT_TRUE(guard_mode(-1, offered));
}

TEST(Guard, ModesThatAreStreamed) {
    using namespace cia402;
    for (const int m : {-1, 0, 1, 2, 3, 5, 6, 11})
        EXPECT_FALSE(is_streamed(static_cast<std::int16_t>(m))) << m;
    for (const int m : {4, 7, 8, 9, 10})
        EXPECT_TRUE(is_streamed(static_cast<std::int16_t>(m))) << m;
    EXPECT_EQ(older_mode_of(SetPoint::Mode::position), 7);
    EXPECT_EQ(older_mode_of(SetPoint::Mode::torque), 4);
    EXPECT_EQ(older_mode_of(SetPoint::Mode::velocity), 0);
    EXPECT_EQ(text_of_mode(-1), "of the maker");
    EXPECT_EQ(text_of_mode(0), "none");
    EXPECT_EQ(text_of_mode(11), "cyclic synchronous torque with commutation angle");
    EXPECT_EQ(text_of_mode(12), "reserved");
}

}  // namespace
TEST(Guard, RatesThatADriveKeepsAreBoundedByTheSiteAlone) {
    constexpr std::int64_t beyond_32_bits = 42'949'672'950;
    EXPECT_FALSE(guard_rates({beyond_32_bits, beyond_32_bits, beyond_32_bits}, {})) << "what a drive takes is its own";
    AxisLimits l;
    l.velocity_max = 1000;
    l.acceleration_max = 2000;
    EXPECT_FALSE(guard_rates({0, 0, 0}, l)) << "none of them is set";
    EXPECT_FALSE(guard_rates({1000, 2000, 2000}, l));
    for (const DriveRates& r :
         {DriveRates{1001, 0, 0}, DriveRates{-1001, 0, 0}, DriveRates{0, 2001, 0}, DriveRates{0, -2001, 0}, DriveRates{0, 0, 2001}}) {
        const auto no = guard_rates(r, l);
        ASSERT_TRUE(no);
        EXPECT_EQ(no->reason, Reason::out_of_range);
        EXPECT_NE(no->text.find("above the axis' limit"), std::string::npos) << no->text;
    }
}

}  // namespace axisgate
