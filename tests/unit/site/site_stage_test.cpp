// The states of a staged change in virtual time, who may confirm, and which parts a change disturbs.
#include "gateway/site/site_stage.hpp"

#include <gtest/gtest.h>

namespace axisgate {
namespace {
constexpr std::int64_t second = 1'000'000'000;

TEST(SiteStage, AnAppliedSiteIsConfirmedByWhoAppliedItAndInTime) {
    SiteStage s;
    EXPECT_NE(s.begin_apply(1, 60, 0, "anna 192.0.2.7:1"), "");
    EXPECT_EQ(s.stage({}, 1, "anna 192.0.2.7:1"), "");
    EXPECT_NE(s.begin_apply(2, 60, 0, "anna 192.0.2.7:1"), "") << "staged on another revision";
    for (const std::uint32_t wrong : {1u, 4u, 601u})
        EXPECT_NE(s.begin_apply(1, wrong, 0, "anna 192.0.2.7:1"), "") << wrong;
    EXPECT_EQ(s.begin_apply(1, 60, 0, "anna 192.0.2.7:1"), "");
    EXPECT_TRUE(s.busy());
    s.applied(true);
    EXPECT_EQ(s.state(), SiteStage::State::applied);
    EXPECT_NE(s.stage({}, 2, "anna 192.0.2.7:1"), "");
    EXPECT_NE(s.discard(), "");
    EXPECT_NE(s.check_confirm("bert 192.0.2.7:1", second), "");
    EXPECT_EQ(s.check_confirm("anna 192.0.2.7:2", 60 * second - 1), "") << "another port is the same identity";
    EXPECT_NE(s.check_confirm("anna 192.0.2.7:2", 60 * second), "");
    EXPECT_TRUE(s.expired(60 * second));
    EXPECT_FALSE(s.expired(60 * second - 1));
}

TEST(SiteStage, AFailedRollBackStaysOnTrialAndIsTriedAgain) {
    SiteStage s;
    ASSERT_EQ(s.stage({}, 1, "a"), "");
    ASSERT_EQ(s.begin_apply(1, 5, 0, "a"), "");
    s.applied(true);
    EXPECT_EQ(s.begin_roll_back(), "");
    s.rolled_back(false, 10 * second);
    EXPECT_TRUE(s.expired(10 * second));
    EXPECT_EQ(s.begin_roll_back(), "");
    s.rolled_back(true, 0);
    EXPECT_EQ(s.state(), SiteStage::State::none);
}

TEST(SiteStage, WithoutATrialItIsForGoodAndAFailureLeavesItStaged) {
    SiteStage s;
    ASSERT_EQ(s.stage({}, 1, "a"), "");
    ASSERT_EQ(s.begin_apply(1, 0, 0, "a"), "");
    s.applied(false);
    EXPECT_EQ(s.state(), SiteStage::State::staged);
    ASSERT_EQ(s.begin_apply(1, 0, 0, "a"), "");
    s.applied(true);
    EXPECT_EQ(s.state(), SiteStage::State::none);
}

TEST(SiteStage, OnlyAxesWhoseConnectionChangesAreDisturbed) {
    Site from;
    from.lines.resize(2);
    from.lines[0].name = "a";
    from.lines[1].name = "b";
    from.drives.resize(2);
    from.drives[0].name = from.drives[0].line = "a";
    from.drives[1].name = from.drives[1].line = "b";
    from.axes.resize(2);
    from.axes[0].name = from.axes[0].drive = "a";
    from.axes[1].name = from.axes[1].drive = "b";
    Site to = from;
    EXPECT_TRUE(disturbed_axes(from, to).empty());
    EXPECT_TRUE(site_diff(from, to).empty());
    to.axes[0].unit = "mm";
    EXPECT_TRUE(disturbed_axes(from, to).empty());
    to.lines[1].bitrate = 250000;
    EXPECT_EQ(disturbed_axes(from, to), std::vector<std::string>{"b"});
    EXPECT_EQ(site_diff(from, to).size(), 2u);
}

TEST(SiteStage, AnIdentityHasNoPort) {
    EXPECT_EQ(identity_of("anna 192.0.2.7:5123"), "anna 192.0.2.7");
    EXPECT_EQ(identity_of("[::1]:80"), "[::1]");
    EXPECT_EQ(identity_of("token line3"), "token line3");
    EXPECT_EQ(identity_of("a:"), "a:");
}
}  // namespace
}  // namespace axisgate
