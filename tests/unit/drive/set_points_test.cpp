// One set-point per axis, the newest, in the order in which axes began to wait.
#include "gateway/drive/set_points.hpp"

#include <gtest/gtest.h>

namespace axisgate::drive {
namespace {

SetPoint point(std::uint16_t axis, std::int64_t value) {
    SetPoint p;
    p.axis = AxisId{axis};
    p.value = value;
    return p;
}

TEST(SetPoints, TheNewestCountsAndNoAxisStarvesAnother) {
    SetPoints s;
    s.put(point(1, 10));
    s.put(point(2, 20));
    s.put(point(1, 11));
    EXPECT_EQ(s.take().value, 11) << "in the older one's place";
    s.put(point(1, 12));
    EXPECT_EQ(s.take().value, 20);
    EXPECT_EQ(s.take().value, 12);
    EXPECT_TRUE(s.empty());
}

TEST(SetPoints, AStopTakesAwayItsOwn) {
    SetPoints s;
    s.put(point(1, 10));
    s.put(point(2, 20));
    s.forget(AxisId{1});
    s.forget(AxisId{7});
    EXPECT_EQ(s.take().value, 20);
    s.put(point(1, 1));
    s.clear();
    EXPECT_TRUE(s.empty());
}

}  // namespace
}  // namespace axisgate::drive
