// The axis to which a drive's report belongs, and the catalogue that numbers its points.
#include "gateway/drive/drive_base.hpp"

#include <gtest/gtest.h>

namespace axisgate::drive {
namespace {

class BareDrive : public DriveBase {
public:
    using DriveBase::DriveBase;
};

DriveSetup setup_of(std::vector<AxisSetup> axes) {
    DriveSetup s;
    s.id = DriveId{4};
    s.name = "feeder";
    s.axes = std::move(axes);
    return s;
}

TEST(DriveBase, OnlyADriveOfOneChannelSpeaksForItsAxis) {
    const Timing timing;
    Out out;
    Turn t{Instant{}, out};
    BareDrive one(setup_of({{AxisId{7}, 1}}), timing, 2), bare(setup_of({}), timing, 3), several(setup_of({{AxisId{7}, 1}}), timing, 0, 16);
    EXPECT_EQ(one.axis(), AxisId{7});
    EXPECT_EQ(bare.axis(), no_axis);
    EXPECT_EQ(several.axis(), no_axis) << "what it tells may be about another one";
    EXPECT_EQ(BareDrive(setup_of({{AxisId{7}, 2}}), timing, 0).axis(), no_axis) << "of a channel that it has not";
    EXPECT_EQ(one.slot(), 2u);
    EXPECT_EQ(one.name(), "feeder");

    one.notice(Severity::info, "stop", 5, "stands", t);
    several.notice(Severity::info, "mode", 0, "is online", t);
    several.notice(Severity::info, "mode", 0, "is in motion", t, AxisId{7});
    one.tell_setup({"option a: write b", "option c: write d"}, t);
    ASSERT_EQ(out.notices.size(), 5u);
    EXPECT_EQ(out.notices[0].axis, AxisId{7});
    EXPECT_EQ(out.notices[0].drive, DriveId{4});
    EXPECT_EQ(out.notices[0].code, 5);
    EXPECT_EQ(out.notices[1].axis, no_axis);
    EXPECT_EQ(out.notices[2].axis, AxisId{7});
    EXPECT_EQ(out.notices[4].text, "option c: write d");
    EXPECT_EQ(out.notices[4].kind, "setup");
}

TEST(DriveBase, PointsAreNumberedByItsOwnCatalogueWhereItHasOne) {
    const Timing timing;
    const Catalogue page;
    DriveSetup own = setup_of({});
    own.catalogue = std::make_shared<const Catalogue>();
    const BareDrive with(own, timing, 0), without(setup_of({}), timing, 1);
    EXPECT_EQ(&with.catalogue_or(page), own.catalogue.get());
    EXPECT_EQ(&without.catalogue_or(page), &page);
}

TEST(DriveBase, IsReadyWhenCommandsCanRestOnWhatIsKnown) {
    const Timing timing;
    BareDrive m(setup_of({}), timing, 0);
    EXPECT_FALSE(m.ready());
    m.presence.begin(Instant{});
    m.presence.found();
    EXPECT_FALSE(m.ready());
    m.presence.made_ready();
    EXPECT_TRUE(m.ready());
}

}  // namespace
}  // namespace axisgate::drive
