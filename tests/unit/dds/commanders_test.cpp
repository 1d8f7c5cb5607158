// Which clients are lost when a writer is gone, without a bus.
#include "gateway/doors/dds/commanders.hpp"

#include <gtest/gtest.h>

namespace axisgate::dds {
namespace {
using Lost = std::set<std::string>;
constexpr Bus::Writer first{Topic::axis_command, 1}, second{Topic::axis_command, 2}, writes{Topic::parameter_write, 1};

TEST(Commanders, OneIsLostWithTheLastWriterByWhichItCommandsAnAxis) {
    Commanders c;
    EXPECT_TRUE(c.note("feeder", "anna", first));
    EXPECT_FALSE(c.note("feeder", "anna", first));
    EXPECT_TRUE(c.note("feeder", "anna", writes)) << "the same number in another topic is another writer";
    EXPECT_TRUE(c.note("slide", "anna", second));
    EXPECT_EQ(c.gone(first), Lost{});
    EXPECT_EQ(c.gone(second), Lost{});
    EXPECT_EQ(c.gone(writes), Lost{"anna"});
    EXPECT_EQ(c.gone(writes), Lost{}) << "once";
}

TEST(Commanders, WhoWasReplacedIsNotMissed) {
    Commanders c;
    c.note("feeder", "anna", first);
    c.note("feeder", "bert", second);
    EXPECT_EQ(c.gone(first), Lost{});
    EXPECT_EQ(c.gone(second), Lost{"bert"});
}

TEST(Commanders, ANewWriterOfTheSameTopicTakesThePlaceOfTheOldOne) {
    Commanders c;
    c.note("feeder", "anna", first);
    c.note("feeder", "anna", second);
    EXPECT_EQ(c.gone(first), Lost{});
    EXPECT_EQ(c.writers(), std::vector<Bus::Writer>{second});
}

TEST(Commanders, OneWriterMaySpeakForManyAndAnAxisThatIsNoMoreHasNone) {
    Commanders c;
    c.note("feeder", "anna", first);
    c.note("slide", "bert", first);
    c.note("gate", "carl", first);
    c.keep([](const std::string& axis) { return axis != "gate"; });
    EXPECT_EQ(c.writers().size(), 1u);
    EXPECT_EQ(c.gone(first), (Lost{"anna", "bert"}));
}

}  // namespace
}  // namespace axisgate::dds
