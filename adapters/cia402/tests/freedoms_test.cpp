// The adapter with the named specimens of the page, and with a drive that is drawn from a seed: each is served with what it has.
#include <fmt/core.h>

#include "adapters/cia402/family.hpp"
#include "adapters/cia402/tests/line_bench.hpp"
#include "gateway/core/specimen.hpp"
#include "gateway/wire/specimen_twin.hpp"

namespace axisgate::cia402_drive::test {
namespace {

struct Specimen : LineBench {
    explicit Specimen(std::string_view name) : LineBench(page(), 1) {
        TwinSetup t;
        t.address = "5";
        t.kind = LineKind::can;
        t.options = {{"specimen", std::string(name)}};
        bus->add(DriveId{0}, make_specimen(family_cia402(), page(), t), {}, now);
        open();
    }
    [[nodiscard]] double place() { return bus->twin(DriveId{0})->mechanics(1, now).position; }
};

TEST(Cia402Specimens, ThePageHasThem) {
    EXPECT_GE(page().freedoms().size(), 12u);
    for (const auto name : named_specimens)
        EXPECT_GE(specimen_in_words(page(), specimen_values(page(), name)).size(), 4u) << name;
    EXPECT_TRUE(specimen_in_words(page(), specimen_values(page(), "0")).empty());
}

TEST(Cia402Specimens, EachOfTheNamedOnesIsServed) {
    for (const auto name : named_specimens) {
        SCOPED_TRACE(name);
        Specimen b(name);
        b.run(60s);
        ASSERT_TRUE(b.link.online) << b.link.text;
        const Result enabled = b.ask(Enable{}, 30s);
        ASSERT_TRUE(good(enabled)) << enabled.text;
        const Result moved = b.ask(LineBench::to(static_cast<std::int64_t>(b.place()) + 10'000), 30s);
        EXPECT_TRUE(good(moved)) << moved.text;
        b.run(5s);
        EXPECT_NEAR(b.place(), 10'000, 105) << "weak drifts before";
        EXPECT_TRUE(b.axis.target_reached);
        EXPECT_FALSE(b.axis.moving);
        const Result off = b.ask(Disable{}, 30s);
        EXPECT_TRUE(good(off)) << off.text;
    }
}

}  // namespace
}  // namespace axisgate::cia402_drive::test
