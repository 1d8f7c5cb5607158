// The metrics of axes; unknown values are left out.
#include <gtest/gtest.h>

#include "gateway/runtime/axis_metrics.hpp"

namespace axisgate::test {
namespace {

TEST(AxisMetrics, SayWhatIsKnownInTheAxisUnit) {
    SiteState site;
    site.site.axes.resize(2);
    site.site.axes[0].name = "feeder";
    site.site.axes[0].unit = "a\"b";
    site.site.axes[0].increments_per_unit = 100;
    site.site.axes[1].name = "slide";
    AxisPicture known, unknown;
    known.ever_seen = true;
    known.at = at_ns(1'000'000'000);
    known.position = 250;
    known.velocity = -50;
    known.position_demand = 260;
    known.demand_source = DemandSource::drive;
    known.statusword = 0x0627;
    known.flags = flag_online | flag_simulated | flag_moving;
    unknown.flags = flag_stale;
    const AxisPicture pictures[] = {known, unknown};
    const std::string s = axis_metrics(site, pictures, at_ns(1'250'000'000));
    for (const auto* line :
         {"axisgate_axis_position{axis=\"feeder\",unit=\"a\\\"b\"} 2.5\n", "axisgate_axis_velocity{axis=\"feeder\",unit=\"a\\\"b\"} -0.5\n",
          "axisgate_axis_following_error{axis=\"feeder\",unit=\"a\\\"b\"} 0.1\n", "axisgate_axis_age_seconds{axis=\"feeder\"} 0.250\n",
          "axisgate_axis_state{axis=\"feeder\",state=\"operation_enabled\"} 1\n",
          "axisgate_axis_state{axis=\"feeder\",state=\"fault\"} 0\n", "axisgate_axis_simulated{axis=\"feeder\"} 1\n",
          "axisgate_axis_simulated{axis=\"slide\"} 0\n", "axisgate_axis_stale{axis=\"slide\"} 1\n",
          "axisgate_axis_fault{axis=\"slide\"} 0\n", "# TYPE axisgate_axis_position gauge\n"})
        EXPECT_NE(s.find(line), std::string::npos) << line << s;
    for (const auto* absent : {"axisgate_axis_position{axis=\"slide\"", "axisgate_axis_age_seconds{axis=\"slide\"",
                               "axisgate_axis_following_error{axis=\"slide\""})
        EXPECT_EQ(s.find(absent), std::string::npos) << absent;
}

}  // namespace
}  // namespace axisgate::test
