// The adapter with the named specimens of the page, and with a drive that is drawn from a seed: each is served with what it has.
#include <fmt/core.h>

#include "adapters/cia402/family.hpp"
#include "adapters/cia402/tests/line_bench.hpp"
#include "gateway/core/specimen.hpp"
#include "gateway/wire/specimen_twin.hpp"

namespace axisgate::cia402_drive::test {
namespace {

using Options = std::map<std::string, std::string>;

struct Specimen : LineBench {
    FreedomValues values;

    explicit Specimen(Options options) : LineBench(page(), 1), values(freedoms_of(page(), options)) {
        TwinSetup t;
        t.address = "5";
        t.kind = LineKind::can;
        t.options = std::move(options);
        bus->add(DriveId{0}, make_specimen(family_cia402(), page(), t), {}, now);
        open();
    }
    void connect(Duration limit = 60s) {
        for (const Instant end = now + limit; now < end && !link.online;)
            run(100ms);
    }
    [[nodiscard]] double place() { return bus->twin(DriveId{0})->mechanics(1, now).position; }
};

void expect_served(const std::string& name) {
    SCOPED_TRACE(name);
    Specimen b({{"specimen", name}});
    b.connect();
    ASSERT_TRUE(b.link.online) << b.link.text;
    const Result enabled = b.ask(Enable{}, 10s);
    ASSERT_TRUE(good(enabled)) << enabled.text;
    const Result moved = b.ask(LineBench::to(10'000), 10s);
    EXPECT_TRUE(good(moved)) << moved.text;
    b.run(5s);
    EXPECT_NEAR(b.place(), 10'000, 5);
    EXPECT_TRUE(b.axis.target_reached);
    EXPECT_FALSE(b.axis.moving);
    EXPECT_FALSE(b.axis.fault);
    if (freedom(b.values, "stopped_by_other_s") != 0) {
        b.run(20s);
        EXPECT_NE(b.ask(LineBench::to(0), 10s).text.find("nmt_start"), std::string::npos);
    }
}

TEST(Cia402Specimens, ThePageHasThem) {
    EXPECT_GE(page().freedoms().size(), 12u);
    for (const auto name : named_specimens)
        EXPECT_GE(specimen_in_words(page(), specimen_values(page(), name)).size(), 4u) << name;
    EXPECT_TRUE(specimen_in_words(page(), specimen_values(page(), "0")).empty());
}

TEST(Cia402Specimens, EachOfTheNamedOnesIsServed) {
    expect_served("0");
    for (const auto name : named_specimens)
        expect_served(std::string(name));
}

TEST(Cia402Specimens, ADriveWithoutObjectsForPdosIsServedAndSaysSo) {
    for (const Options& lacks :
         {Options{{"has_606ch", "0"}}, Options{{"has_6062h", "0"}}, Options{{"pdo_setup", "3"}}, Options{{"pdo_setup", "4"}}}) {
        SCOPED_TRACE(lacks.begin()->first + " " + lacks.begin()->second);
        Specimen b(lacks);
        b.connect(5s);
        EXPECT_TRUE(b.link.online) << b.link.text;
        EXPECT_EQ(b.reported("drive_lacks"), 1);
    }
}

}  // namespace
}  // namespace axisgate::cia402_drive::test
