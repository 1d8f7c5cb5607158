// Which axes' trends are written, by the site in force and the host's settings; and how they are restored. The test never waits for a
// minute.
#include "gateway/runtime/trend_disk.hpp"

#include <gmock/gmock.h>
#include <stdlib.h>

#include <filesystem>

#include "gateway/runtime/file_shelf.hpp"

namespace axisgate {
namespace {
using namespace std::chrono_literals;
constexpr std::int64_t offset = 1'700'000'000'000'000'000;  // the difference between an instant and a time
constexpr AxisId left{1}, right{2};

class TrendDiskTest : public testing::Test {
protected:
    void SetUp() override { ASSERT_NE(::mkdtemp(folder.data()), nullptr); }
    void TearDown() override {
        pool.join();
        std::filesystem::remove_all(folder);
    }
    static SiteState site(bool left_marked, bool right_marked) {
        SiteState s;
        s.site.axes.resize(2);
        s.site.axes[0].name = "left";
        s.site.axes[0].trend_on_disk = left_marked;
        s.site.axes[1].name = "right";
        s.site.axes[1].trend_on_disk = right_marked;
        s.axis_ids = {left, right};
        return s;
    }
    static Trends moved() {
        Trends t(1 << 20, 10min);
        for (int i = 0; i < 20; ++i) {
            PictureRecord p;
            p.current = true;
            p.position = i;
            t.add(left, p, Instant(i * 1s));
            t.add(right, p, Instant(i * 1s));
        }
        return t;
    }
    TrendDisk disk(bool unmarked, Instant from = Instant(0s)) {
        TrendDisk d(pool, folder, 1 << 20, unmarked);
        EXPECT_EQ(d.open(offset + from.time_since_epoch().count(), offset, 10min), "");
        return d;
    }
    /// Names of the axes that a gateway with this site finds after a restart.
    std::vector<std::string> kept() {
        std::vector<std::string> names;
        auto d = disk(false, Instant(60s));
        Trends t(1 << 20, 10min);
        const auto all = site(false, false);
        for (std::size_t i = 0; i < all.axis_ids.size(); ++i) {
            d.bring_back(all.axis_ids[i], t, all);
            if (t.knows(all.axis_ids[i])) names.push_back(all.site.axes[i].name);
        }
        return names;
    }
    std::string folder = "/tmp/axisgate-trends-XXXXXX";
    boost::asio::thread_pool pool{1};
};

TEST_F(TrendDiskTest, AMarkedAxisAloneIsKept) {
    disk(false).end(moved(), site(false, true), Instant(20s), offset);
    EXPECT_THAT(kept(), testing::ElementsAre("right"));
}

TEST_F(TrendDiskTest, WithoutAMarkNothingIsWritten) {
    disk(false).end(moved(), site(false, false), Instant(20s), offset);
    EXPECT_TRUE(names_in(folder, ".axt", 10).empty());
}

TEST_F(TrendDiskTest, AWrittenBoundKeepsAllAxesOfASiteThatMarksNone) {
    disk(true).end(moved(), site(false, false), Instant(20s), offset);
    EXPECT_THAT(kept(), testing::ElementsAre("left", "right"));
}

TEST_F(TrendDiskTest, AWrittenBoundLeavesTheChoiceToASiteThatMarks) {
    disk(true).end(moved(), site(true, false), Instant(20s), offset);
    EXPECT_THAT(kept(), testing::ElementsAre("left"));
}

TEST_F(TrendDiskTest, AChangedSiteCountsFromTheNextWritingOn) {
    auto d = disk(false);
    const auto trends = moved();
    d.keep(trends, site(false, false), Instant(10s), offset);  // too early for any of them
    d.keep(trends, site(true, false), Instant(0s) + TrendDisk::period, offset);
    d.end(trends, site(false, false), Instant(70s), offset);
    pool.join();
    EXPECT_THAT(names_in(folder, ".axt", 10), testing::ElementsAre(std::to_string((offset + 60'000'000'000) / 1'000'000)));
    EXPECT_THAT(kept(), testing::ElementsAre("left"));
}

}  // namespace
}  // namespace axisgate
