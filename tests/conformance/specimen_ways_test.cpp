// Each way of commanding, tried on each named specimen of each family: the motion begins within its bound or the client is told why not,
// its client's loss ends it, and a fresh edge starts it again. The judge is the twin's mechanics.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/axis/cia402.hpp"
#include "tests/conformance/ways.hpp"
#include "tests/world/specimen_day.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

/// Drives that these clients do not move. The UIM342: see its README, known limits. The MCode drive runs a program of its own, so a
/// download is refused with the remedy (program.end), which this client does not order.
constexpr std::array known_limits{std::pair{"uim342_can_slow", "enip_message"}, std::pair{"mcode_serial_chatty", "program"}};

struct SpecimenCell {
    Subject subject;
    const WayKind* way;
    friend void PrintTo(const SpecimenCell& c, std::ostream* out) { *out << c.subject.text() << " " << c.way->name; }
};

class SpecimenWays : public testing::TestWithParam<SpecimenCell> {
protected:
    const Subject& e = GetParam().subject;
    std::unique_ptr<Way> way = GetParam().way->make();
    FreedomValues values = specimen_values(*e.catalogue, e.specimen);
    Duration slow = slowness_of(*e.catalogue, values);
    Bench b{e, 1, std::make_shared<Plant>()};
    static constexpr Duration tick = 10ms;
    static constexpr double play = 200;  ///< increments: noise, backlash and settling of a shaft at rest

    [[nodiscard]] double speed() { return std::fabs(b.world.engine.twin(b.site->drive_ids.at(0))->mechanics(1, b.world.now).velocity); }
    [[nodiscard]] double place() { return b.world.engine.twin(b.site->drive_ids.at(0))->mechanics(1, b.world.now).position; }
    bool pass_until(const std::function<bool()>& condition, Duration limit) {
        for (const Instant end = b.world.now + limit; !condition();) {
            if (b.world.now >= end) return false;
            way->cycle(b);
            b.run(tick);
        }
        return true;
    }
    [[nodiscard]] std::string in_words() const {
        std::string all = "\n  client: " + way->refusal(b) + "\n  the drive:";
        for (const std::string& line : specimen_in_words(*e.catalogue, values))
            all += "\n    " + line;
        all += "\n  told:";
        const auto& list = b.world.events;
        for (std::size_t i = list.size() > 12 ? list.size() - 12 : 0; i < list.size(); ++i)
            all += "\n    " + list[i].kind + ": " + list[i].text;
        all += "\n  answers that say no:";
        for (const auto& [ticket, answers] : b.world.results) {
            for (const Result& r : answers) {
                if (!good(r)) all += "\n    " + r.text;
            }
        }
        return all;
    }
    /// A gateway with this drive, online. Returns false if no gateway can serve it, and the event says why.
    [[nodiscard]] bool begin() {
        Site s = b.world.twins(e);
        fit_line(s, values);
        way->fit(s, e);
        s.axes.at(0).fail_safe.watchdog_ms = 400;
        if (!way->endless()) {  // a motion to a target continues without its client unless the site says otherwise
            for (const LossCause cause : loss_causes())
                s.axes.at(0).fail_safe.of(cause) = FailSafeAction::quick_stop;
        }
        b.world.engine.set_lease(1s);
        b.use(b.world.apply(std::move(s)));
        const bool up = b.until([&] { return (b.picture().flags & flag_online) && b.picture().ever_seen; }, 60s + 4 * slow);
        EXPECT_TRUE(up || told_as_not_served(e, values, b.world.events)) << "the drive is not found" << in_words();
        b.run(1s + slow);
        b.meanwhile = [this] { way->cycle(b); };
        return up;
    }
    /// Prepares as a client does that tries again after a while. Returns false if the drive never became ready.
    [[nodiscard]] bool ready() {
        for (int times = 0; times < 5; ++times) {
            if (way->prepare(b)) return true;
            b.run(500ms + slow / 4);
        }
        return false;
    }
    /// Sets it off. Returns false if the client was told that nothing comes of it; nothing moves then.
    [[nodiscard]] bool goes() {
        way->set_off(b);
        const auto turns = [&] { return speed() > 400; };
        const bool told = pass_until([&] { return turns() || !way->refusal(b).empty(); }, 3s + slow) && !turns();
        if (!told) {
            EXPECT_TRUE(turns()) << "accepted, and it does not begin" << in_words();
            return !HasFailure();
        }
        way->silent = true;  // its next words may be accepted
        b.run(1s + slow);
        EXPECT_LT(speed(), 100) << "refused, and it moves" << in_words();
        return false;
    }
    /// `settle`: the time by which it rests at the latest behind the first standstill that is seen.
    void ends_with_its_client(Duration settle = 300ms) {
        way->lose(b, way->losses().front());
        ASSERT_TRUE(pass_until([&] { return speed() < 1; }, 6s + slow)) << "its client is gone and it goes on at " << speed() << in_words();
        b.run(settle + slow);
        const double rest = place();
        b.run(1200ms);
        EXPECT_LT(std::fabs(place() - rest), play) << "it moves on without a fresh edge" << in_words();
    }
};

TEST_P(SpecimenWays, BeginOrAreToldAndEndWithTheirClient) {
    if (!begin()) return;
    std::string why;
    if (!way->offered(e, why)) {
        (void)way->prepare(b);
        way->set_off(b);
        b.run(500ms + slow);
        EXPECT_NE(way->refusal(b), "") << "it is not said that it cannot be done" << in_words();
        EXPECT_LT(speed(), 100) << in_words();
        return;
    }
    ASSERT_TRUE(ready()) << "it does not become ready" << in_words();
    if (!goes()) return;
    ends_with_its_client();
    if (HasFailure()) return;
    way->silent = false;
    bool moves = false;
    for (int times = 0; times < 5 && !moves; ++times) {
        if (times > 0) b.run(500ms + slow / 4);
        const bool ignored = way->again(b) && !pass_until([&] { return speed() > 400 || !way->refusal(b).empty(); }, 3s + slow);
        EXPECT_FALSE(ignored) << "a fresh edge is accepted and does not move it" << in_words();
        moves = speed() > 400;
    }
    EXPECT_TRUE(moves) << "a fresh edge does not move it" << in_words();
}

/// The client is lost while its order is on its way: what begins behind that ends as well.
TEST_P(SpecimenWays, ALossWhileTheOrderIsOnItsWayEndsWhatBeginsBehindIt) {
    if (!begin()) return;
    std::string why;
    if (e.specimen != "slow" || !way->offered(e, why)) return;
    ASSERT_TRUE(ready()) << "it does not become ready" << in_words();
    way->set_off(b);
    ends_with_its_client(6s);
}

/// One wire of each family; motions that no client of this gateway has begun are SpecimenLaws' TheNextGatewayFindsTheDriveAsItIs.
std::vector<SpecimenCell> specimen_cells() {
    std::vector<SpecimenCell> all;
    for (const auto& entry : families().entries) {
        Subject subject = wires_of(entry).front();
        for (const std::string_view name : named_specimens) {
            subject.specimen = name;
            for (const WayKind& kind : ways_in()) {
                const auto limited = [&](const auto& l) { return subject.text() == l.first && kind.name == l.second; };
                if (kind.name != "found" && std::ranges::none_of(known_limits, limited)) all.push_back({subject, &kind});
            }
        }
    }
    return all;
}

INSTANTIATE_TEST_SUITE_P(Cells, SpecimenWays, testing::ValuesIn(specimen_cells()), [](const testing::TestParamInfo<SpecimenCell>& i) {
    return i.param.subject.text() + "_" + std::string(i.param.way->name);
});

}  // namespace
}  // namespace axisgate::test
