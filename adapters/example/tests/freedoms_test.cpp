// The freedoms of the example drive: the simulated drive does each of them. Those that all families share are tested in
// tests/unit/wire/specimen_twin_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "adapters/example/twin/axis.hpp"
#include "adapters/example/twin/twin.hpp"
#include "adapters/example/wire.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/core/specimen.hpp"

namespace axisgate::example::test {
namespace {
using namespace std::chrono_literals;
using testing::ElementsAre;

const Catalogue& page() {
    static const Catalogue c = [] {
        std::ifstream f(AXISGATE_SOURCE_DIR "/schema/families/example.json");
        std::stringstream s;
        s << f.rdbuf();
        std::vector<std::string> faults;
        auto parsed = Catalogue::parse(s.str(), faults);
        for (const auto& fault : faults)
            ADD_FAILURE() << fault;
        return *std::move(parsed);
    }();
    return c;
}

/// One drive with these freedoms, enabled where a test needs it.
struct Drive {
    explicit Drive(const FreedomValues& freedoms) {
        TwinSetup setup;
        setup.address = "5";
        setup.freedoms = freedoms;
        setup.seed = 3;
        twin = twin::make_twin(setup);
        Out out;
        twin->power_on({}, now, out);
    }
    std::string ask(const std::string& item, const std::string& value = "", int axis = 1) {
        const Telegram t{5, axis, item, value.empty() ? Telegram::Kind::read : Telegram::Kind::value, value};
        const std::string text = text_of(t, true);
        Out out;
        twin->on_frame(Frame::run({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}), now, out);
        EXPECT_EQ(out.frames.size(), 1u) << text;
        return out.frames.empty() ? "" : body(out.frames[0].frame);
    }
    /// "=value" or "!code".
    static std::string body(const Frame& f) {
        bool request = false;
        const auto t = telegram_of({reinterpret_cast<const char*>(f.data().data()), f.size - 1u}, request);
        EXPECT_TRUE(t && !request);
        return t ? static_cast<char>(t->kind) + t->text : "";
    }
    std::vector<std::int64_t> state() {
        std::vector<std::int64_t> v;
        std::stringstream s(ask("S00").substr(1));
        for (std::string n; std::getline(s, n, ',');)
            v.push_back(std::stoll(n));
        return v;
    }
    [[nodiscard]] std::int64_t bits() { return state()[0]; }
    [[nodiscard]] std::int64_t position() { return state()[1]; }

    std::unique_ptr<Twin> twin;
    Instant now = time_zero + 1s;
};
Drive enabled(const FreedomValues& freedoms) {
    Drive d(freedoms);
    EXPECT_EQ(d.ask("R20", "1"), "=1");
    return d;
}

TEST(ExampleFreedoms, ThePageListsThemAndSeedZeroIsToday) {
    EXPECT_GE(page().freedoms().size(), 12u);
    EXPECT_THAT(specimen_in_words(page(), specimen_values(page(), "0")), testing::IsEmpty());
    std::set<FreedomValues> all{specimen_values(page(), "0")};
    for (const auto name : named_specimens)
        EXPECT_TRUE(all.insert(specimen_values(page(), name)).second) << name;
    Drive manual({}), zero(specimen_values(page(), "0"));
    for (Drive* d : {&manual, &zero}) {
        (void)d->ask("R20", "1");
        (void)d->ask("R21", "3000");
        d->now += 400ms;
    }
    EXPECT_EQ(manual.ask("S00"), zero.ask("S00"));
    EXPECT_EQ(zero.twin->deadline(), never);
}

TEST(ExampleFreedoms, StateLate) {
    Drive d = enabled({{"state_late_ms", 200}});
    EXPECT_EQ(d.bits(), 0) << "not yet shown as on";
    d.now += 200ms;
    EXPECT_EQ(d.bits(), 1);
    EXPECT_EQ(d.ask("R21", "800"), "=800");  // 0.2 s up, 0.2 s down
    d.now += 199ms;
    EXPECT_EQ(d.bits(), 1) << "it moves, and shows that it stands";
    EXPECT_GT(d.position(), 300);
    d.now += 1ms;
    EXPECT_EQ(d.bits(), 3);
    d.now += 390ms;
    EXPECT_EQ(d.position(), 800);
    EXPECT_EQ(d.bits(), 3) << "it stands, and shows that it moves";
    d.now += 20ms;
    EXPECT_EQ(d.bits(), 5);
    EXPECT_EQ(d.ask("R21", "0"), "=0");
    EXPECT_EQ(d.bits(), 5) << "a new motion begins, and it shows that it is at its target";
    EXPECT_EQ(d.state()[4], 0);
}

TEST(ExampleFreedoms, PowerDelay) {
    Drive d = enabled({{"power_delay_ms", 300}});
    d.now += 299ms;
    EXPECT_EQ(d.bits(), 0);
    EXPECT_EQ(d.ask("R21", "5"), "!14");
    EXPECT_FALSE(d.twin->mechanics(1, d.now).powered);
    d.now += 1ms;
    EXPECT_EQ(d.bits(), 1);
    EXPECT_EQ(d.ask("R21", "5"), "=5");
    EXPECT_EQ(d.ask("R20", "1"), "=1") << "an axis that is on stays on";
    EXPECT_TRUE(d.twin->mechanics(1, d.now).powered);
}

TEST(ExampleFreedoms, NoNewTargetInMotion) {
    for (const std::int64_t accepts : {0, 1}) {
        Drive d = enabled({{"new_target_in_motion", accepts}});
        (void)d.ask("R21", "5000");
        d.now += 50ms;
        EXPECT_EQ(d.ask("R21", "6000"), accepts ? "=6000" : "!13");
        EXPECT_EQ(d.ask("R22", "100"), accepts ? "=100" : "!13");
        EXPECT_EQ(d.ask("R23", "0"), "=0") << "a stop is accepted always";
        d.now += 5s;
        EXPECT_EQ(d.ask("R21", "6000"), "=6000");
    }
}

TEST(ExampleFreedoms, SettingsAtRest) {
    for (const std::int64_t rest : {0, 1}) {
        Drive d = enabled({{"settings_at_rest", rest}});
        EXPECT_EQ(d.ask("R06", "900"), "=900");
        (void)d.ask("R22", "50");
        EXPECT_EQ(d.ask("R07", "900"), rest ? "!13" : "=900");
        EXPECT_EQ(d.ask("R07", "0"), "!12");
    }
}

TEST(ExampleFreedoms, OptionalRegisters) {
    Drive d({{"optional_registers", 0}});
    EXPECT_EQ(d.ask("R14"), "!11");
    EXPECT_EQ(d.ask("R18", "3"), "!11");
    EXPECT_EQ(d.ask("R13"), "=5");
    EXPECT_EQ(d.ask("R13", "6"), "=6");
    EXPECT_EQ(Drive({}).ask("R14"), "=20");
}

TEST(ExampleFreedoms, ReportsUnasked) {
    Drive d({{"report_ms", 100}});
    EXPECT_EQ(d.twin->deadline(), d.now + 100ms);
    Out out;
    d.twin->on_deadline(d.now + 350ms, out);
    ASSERT_EQ(out.frames.size(), 3u);
    EXPECT_EQ(Drive::body(out.frames[2].frame), "=0,0,0,0,0");
    EXPECT_EQ(out.frames[2].frame.at, d.now + 300ms);
    EXPECT_EQ(d.twin->set_hand("power", Value{false}, d.now + 360ms, out), "");
    EXPECT_EQ(d.twin->deadline(), never);
    EXPECT_EQ(d.twin->set_hand("power", Value{true}, d.now + 400ms, out), "");
    EXPECT_EQ(d.twin->deadline(), d.now + 500ms);
    EXPECT_EQ(d.twin->set_hand("silent", Value{true}, d.now + 410ms, out), "");
    out.clear();
    d.twin->on_deadline(d.now + 500ms, out);
    EXPECT_TRUE(out.frames.empty());
}

TEST(ExampleFreedoms, StartPosition) {
    Drive d = enabled({{"start_position_increments", 12345}});
    EXPECT_EQ(d.position(), 12345);
    EXPECT_EQ(d.state()[3], 12345);
    (void)d.ask("R21", "12445");
    d.now += 2s;
    EXPECT_EQ(d.state(), (std::vector<std::int64_t>{5, 12445, 0, 12445, 0}));
    EXPECT_NEAR(d.twin->mechanics(1, d.now).position, 100, 1e-6);
    Out out;
    (void)d.twin->set_hand("power", Value{false}, d.now, out);
    (void)d.twin->set_hand("power", Value{true}, d.now, out);
    EXPECT_EQ(d.position(), 12345) << "it counts from there at each power-on";
    (void)d.ask("R25", "7");
    EXPECT_EQ(d.position(), 7);
}

// --- mechanics -----------------------------------------------------------------------------------------------------------------------

TEST(ExampleFreedoms, TheShaftFollowsWithAnErrorAndSettles) {
    Drive d = enabled({{"follow_ms", 30}});
    (void)d.ask("R22", "4000");
    d.now += 2s;
    const auto s = d.state();
    EXPECT_NEAR(static_cast<double>(s[3] - s[1]), 2 * 0.03 * 4000, 8) << "twice the time constant times the speed";
    EXPECT_EQ(s[2], 4000);
    (void)d.ask("R23", "0");
    d.now += 200ms;
    EXPECT_EQ(d.bits(), 1) << "the demand stands";
    EXPECT_GT(d.twin->mechanics(1, d.now).velocity, 100) << "and the shaft does not";
    d.now += 2s;
    EXPECT_EQ(d.state()[1], d.state()[3]);
}

TEST(ExampleFreedoms, ItIsAtItsTargetWhenTheShaftIs) {
    Drive d = enabled({{"follow_ms", 30}, {"damping_percent", 30}});
    (void)d.ask("R21", "4000");
    d.now += 1200ms;
    EXPECT_EQ(d.bits(), 1) << "the demand has arrived";
    std::int64_t most = 0;
    for (int i = 0; i < 2000; ++i) {
        d.now += 1ms;
        most = std::max(most, d.position());
    }
    EXPECT_GT(most, 4010) << "it overshoots";
    EXPECT_EQ(d.bits(), 5);
    EXPECT_EQ(d.position(), 4000);
}

TEST(ExampleFreedoms, AMotorThatCannotFollowIsAFault) {
    Drive strong = enabled({{"most_acceleration", 10'000}}), weak = enabled({{"most_acceleration", 2'000}});
    for (Drive* d : {&strong, &weak}) {
        (void)d->ask("R22", "4000");  // with 20,000/s^2
        d->now += 10s;
    }
    EXPECT_EQ(strong.state()[4], 0);
    EXPECT_EQ(strong.state()[2], 4000);
    const auto s = weak.state();
    EXPECT_EQ(s[4], 3) << "R12 = 1000 increments behind";
    EXPECT_EQ(s[0], 0);
    EXPECT_EQ(s[2], 0);
    Drive often = enabled({{"most_acceleration", 2'000}});
    (void)often.ask("R22", "4000");
    for (int i = 0; i < 2000; ++i) {
        often.now += 5ms;
        (void)often.state();
    }
    EXPECT_EQ(often.state(), s) << "asked often, it tells the same";
}

TEST(ExampleFreedoms, AHeldShaftIsAFaultWithMechanicsToo) {
    Drive d = enabled({{"follow_ms", 5}});
    (void)d.ask("R22", "4000");
    d.now += 1s;
    Out out;
    EXPECT_EQ(d.twin->set_hand("stall", Value{true}, d.now, out), "");
    d.now += 100ms;
    EXPECT_EQ(d.state()[2], 0);
    EXPECT_EQ(d.state()[4], 0);
    d.now += 300ms;
    EXPECT_EQ(d.state()[4], 3);
}

TEST(ExampleFreedoms, FrictionBacklashAndNoise) {
    Drive stuck = enabled({{"friction_increments", 8}});
    (void)stuck.ask("R21", "1000");
    stuck.now += 3s;
    EXPECT_EQ(stuck.state(), (std::vector<std::int64_t>{1, 992, 0, 1000, 0})) << "outside the window of R13 = 5";
    Drive loose = enabled({{"backlash_increments", 8}});
    (void)loose.ask("R21", "1000");
    loose.now += 3s;
    EXPECT_EQ(loose.state(), (std::vector<std::int64_t>{5, 996, 0, 1000, 0}));
    Drive noisy = enabled({{"noise_increments", 1}});
    std::set<std::int64_t> seen;
    for (int i = 0; i < 100; ++i) {
        noisy.now += 1ms;
        seen.insert(noisy.position());
    }
    EXPECT_EQ(seen, (std::set<std::int64_t>{-1, 0, 1}));
}

TEST(ExampleFreedoms, DriftsWhenItIsSwitchedOff) {
    Drive d({{"drift_increments", 100}});
    d.now += 5s;
    EXPECT_EQ(d.position(), 0) << "it was never on";
    (void)d.ask("R20", "1");
    d.now += 1s;
    (void)d.ask("R20", "0");
    d.now += 5s;
    EXPECT_EQ(d.position(), 100);
    (void)d.ask("R20", "1");
    d.now += 1s;
    EXPECT_EQ(d.state(), (std::vector<std::int64_t>{1, 100, 0, 100, 0})) << "enabling takes the place where it is";
}

}  // namespace
}  // namespace axisgate::example::test
