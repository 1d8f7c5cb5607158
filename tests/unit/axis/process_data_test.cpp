// Each writable point of the standard map accepts the numbers of its register's type, and no others.
#include "gateway/axis/process_data.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace axisgate {
namespace {
struct Ends {
    AxisPoint point;
    std::int64_t least, greatest;
    std::optional<std::int64_t> (*shown)(const ProcessData&);
};
template <auto member>
std::optional<std::int64_t> shown(const ProcessData& d) {
    return d.*member ? std::optional<std::int64_t>(*(d.*member)) : std::nullopt;
}
constexpr std::int64_t i16_least = std::numeric_limits<std::int16_t>::min(), i16_greatest = std::numeric_limits<std::int16_t>::max(),
                       i32_least = std::numeric_limits<std::int32_t>::min(), i32_greatest = std::numeric_limits<std::int32_t>::max(),
                       u16_greatest = std::numeric_limits<std::uint16_t>::max(), u32_greatest = std::numeric_limits<std::uint32_t>::max();
constexpr Ends all[] = {{AxisPoint::controlword, 0, u16_greatest, shown<&ProcessData::controlword>},
                        {AxisPoint::mode, i16_least, i16_greatest, shown<&ProcessData::mode>},
                        {AxisPoint::target_position, i32_least, i32_greatest, shown<&ProcessData::target_position>},
                        {AxisPoint::profile_velocity, 0, u32_greatest, shown<&ProcessData::profile_velocity>},
                        {AxisPoint::profile_acceleration, 0, u32_greatest, shown<&ProcessData::profile_acceleration>},
                        {AxisPoint::profile_deceleration, 0, u32_greatest, shown<&ProcessData::profile_deceleration>},
                        {AxisPoint::target_velocity, i32_least, i32_greatest, shown<&ProcessData::target_velocity>},
                        {AxisPoint::homing_method, i16_least, i16_greatest, shown<&ProcessData::homing_method>}};

TEST(ProcessDataPoints, TakeTheNumbersOfTheirTypeAndNoOthers) {
    for (const Ends& e : all) {
        SCOPED_TRACE(name_of(e.point));
        for (const std::int64_t n : {e.least, e.greatest, std::int64_t{1}}) {
            ProcessData d;
            EXPECT_TRUE(put_process_data(d, e.point, n)) << n;
            EXPECT_EQ(e.shown(d), n);
        }
        for (const std::int64_t n :
             {e.least - 1, e.greatest + 1, std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()}) {
            ProcessData d;
            EXPECT_FALSE(put_process_data(d, e.point, n)) << n;
            EXPECT_FALSE(e.shown(d)) << n << " has become another number";
        }
    }
}

TEST(ProcessDataPoints, AreThoseThatUserMapsMayWrite) {
    for (const AxisPointInfo& i : axis_point_list) {
        ProcessData d;
        EXPECT_EQ(put_process_data(d, i.point, 1), i.writable) << i.name;
    }
}
}  // namespace
}  // namespace axisgate
