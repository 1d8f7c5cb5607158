// Recipes against specimens: the same specimen gives the same result, a specimen that the recipe cannot be done with is named with the step
// and the reason, and the drive that the manual shows passes in every family.
#include "gateway/services/recipes/recipe_rehearsal.hpp"

#include <boost/json/parse.hpp>

#include "gateway/core/specimen.hpp"
#include "gateway/services/recipes/rehearsal_gateway.hpp"
#include "tests/world/world.hpp"

namespace axisgate::test {
namespace {
namespace json = boost::json;
using namespace std::chrono_literals;

json::object object(std::string_view text) { return json::parse(text).get_object(); }

/// The families with a page of the test's own for the example, which has some of the freedoms that all families share.
const Families& with_freedoms() {
    static const Families all = [] {
        static std::unique_ptr<Catalogue> page;
        json::object document = families().find("example").catalogue->document();
        document["freedoms"] = json::parse(R"([
            {"name": "reply_ms", "unit": "ms", "min": 0, "max": 100, "default": 0, "description": "an answer is late", "source": "silent", "named": {"slow": 60}},
            {"name": "boot_ms", "unit": "ms", "min": 0, "max": 90000, "default": 0, "description": "it boots", "source": "silent", "named": {"old": 90000}}])");
        std::vector<std::string> faults;
        auto parsed = Catalogue::parse(json::serialize(document), faults);
        if (!parsed) std::abort();
        page = std::make_unique<Catalogue>(std::move(*parsed));
        Families f = families();
        for (FamilyEntry& e : f.entries) {
            if (e.family->name == "example") e.catalogue = page.get();
        }
        return f;
    }();
    return all;
}

constexpr auto two_moves = R"({"steps": [
    {"enable": {"axis": "a1"}},
    {"command": {"axis": "a1", "command": "move_absolute", "position": 10, "velocity": 20, "wait_s": 10}},
    {"check": {"axis": "a1", "point": "position", "is": 10, "tolerance": 0.2}},
    {"command": {"axis": "a1", "command": "move_absolute", "position": 0, "velocity": 20, "wait_s": 10}},
    {"disable": {"axis": "a1"}}]})";
/// The way takes 0.6 s. The limit is enough for a drive that answers at once, and too short for one that answers each question after 60 ms.
constexpr auto hurried = R"({"steps": [
    {"enable": {"axis": "a1"}},
    {"message": "the way"},
    {"command": {"axis": "a1", "command": "move_absolute", "position": 10, "velocity": 20, "wait_s": 0.7}},
    {"disable": {"axis": "a1"}}]})";

class RecipeRehearsals : public testing::Test {
protected:
    RecipeRehearsalWish wish(std::string_view document, std::string_view family = "example") {
        World w;
        RecipeRehearsalWish out;
        out.name = "cycle";
        out.document = object(document);
        out.site = w.twins(wires_of(with_freedoms().find(family)).front());
        out.by = {http::clients, std::make_shared<const std::string>("tester"), nullptr};
        return out;
    }
    RehearsedSpecimen play(RecipeRehearsalWish order, std::string_view specimen) {
        const RecipeRehearsal rehearsal(with_freedoms(), std::move(order), faults);
        EXPECT_TRUE(faults.empty()) << faults.front().pointer << ": " << faults.front().text;
        return rehearsal.play(specimen);
    }
    std::vector<SiteFault> faults;
};

TEST_F(RecipeRehearsals, PassWithTheDriveOfTheManual) {
    const auto r = play(wish(two_moves), "0");
    EXPECT_TRUE(r.passed) << r.step << ": " << r.text;
    EXPECT_EQ(r.specimen, "0");
    EXPECT_TRUE(r.pointer.empty() && r.step.empty() && r.text.empty());
    EXPECT_GT(r.seconds, 1.0);  // two ways of 10 at 20 per second
    EXPECT_LT(r.seconds, 5.0);
}

TEST_F(RecipeRehearsals, NameTheStepAtWhichASpecimenFails) {
    const auto good = play(wish(hurried), "0");
    EXPECT_TRUE(good.passed) << good.step << ": " << good.text;
    const auto late = play(wish(hurried), "slow");
    EXPECT_FALSE(late.passed);
    EXPECT_EQ(late.pointer, "/steps/2");
    EXPECT_NE(late.step.find("Step 3"), std::string::npos) << late.step;
    EXPECT_NE(late.text.find("not done within 0.7 s"), std::string::npos) << late.text;
    const auto document = to_json(late);
    EXPECT_EQ(document.at("specimen"), "slow");
    EXPECT_EQ(document.at("passed"), false);
    EXPECT_EQ(document.at("pointer"), "/steps/2");
}

TEST_F(RecipeRehearsals, GiveTheSameResultForTheSameSpecimen) {
    std::set<double> durations;
    for (int seed = 1; seed <= 8; ++seed) {
        const auto first = play(wish(two_moves), std::to_string(seed)), again = play(wish(two_moves), std::to_string(seed));
        EXPECT_EQ(first.passed, again.passed) << seed;
        EXPECT_EQ(first.seconds, again.seconds) << seed;
        durations.insert(first.seconds);
    }
    EXPECT_GT(durations.size(), 1u) << "no specimen differs from another";
}

TEST_F(RecipeRehearsals, SayWhichDriveIsNotThere) {
    const auto r = play(wish(two_moves), "old");
    EXPECT_FALSE(r.passed);
    EXPECT_EQ(r.text, "not online within 60 s: a1");
    EXPECT_TRUE(r.step.empty()) << "no step was begun";
}

TEST_F(RecipeRehearsals, KeepTheSpecimenOfAFamilyThatIsFixed) {
    auto order = wish(two_moves);
    order.fixed["example"] = "old";
    EXPECT_EQ(play(std::move(order), "0").text, "not online within 60 s: a1");
    auto unknown = wish(two_moves);
    unknown.fixed = {{"nobody", "1"}, {"example", "fast"}};
    const RecipeRehearsal none(with_freedoms(), std::move(unknown), faults);
    ASSERT_EQ(faults.size(), 2u);
    EXPECT_EQ(faults[0].pointer, "/fixed");
}

TEST_F(RecipeRehearsals, TellTheNewestWarningOfADrive) {
    const auto r = play(wish(R"({"steps": [{"enable": {"axis": "a1"}},
        {"simulate": {"axis": "a1", "input": "stall", "value": true}},
        {"command": {"axis": "a1", "command": "move_absolute", "position": 50, "velocity": 20, "wait_s": 10}}]})"),
                        "0");
    EXPECT_FALSE(r.passed);
    EXPECT_EQ(r.pointer, "/steps/2");
    EXPECT_EQ(r.event.substr(0, 4), "a1: ") << r.event;
}

TEST_F(RecipeRehearsals, AreNotBegunWithARecipeThatDoesNotFitTheSite) {
    const RecipeRehearsal none(with_freedoms(), wish(R"({"steps": [{"enable": {"axis": "nobody"}}]})"), faults);
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults[0].pointer, "/steps/0/enable/axis");
}

TEST_F(RecipeRehearsals, AreNotBegunWithoutAnAxis) {
    const RecipeRehearsal none(with_freedoms(), wish(R"({"steps": [{"wait_s": 1}]})"), faults);
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_NE(faults[0].text.find("the recipe uses no axis"), std::string::npos) << faults[0].text;
}

TEST_F(RecipeRehearsals, AreGivenUpWhenTheyAreEnded) {
    const RecipeRehearsal rehearsal(with_freedoms(), wish(R"({"steps": [{"enable": {"axis": "a1"}}, {"wait_s": 50000}]})"), faults);
    ASSERT_TRUE(faults.empty());
    const std::atomic<bool> ended{true};
    const auto row = rehearsal.play("0", ended);
    EXPECT_FALSE(row.passed);
    EXPECT_LT(row.seconds, 1);
}

TEST_F(RecipeRehearsals, EveryFamilyPassesAsItsManualShowsIt) {
    for (const FamilyEntry& e : with_freedoms().entries) {
        for (const Subject& s : wires_of(e)) {
            auto order = wish(R"({"steps": [{"enable": {"axis": "a1", "wait_s": 20}}, {"wait_s": 1}, {"disable": {"axis": "a1"}}]})",
                              e.family->name);
            World w;
            order.site = w.twins(s);
            const auto r = play(std::move(order), "0");
            EXPECT_TRUE(r.passed) << s.text() << ": " << r.step << ": " << r.text << " (" << r.event << ")";
        }
    }
}

TEST(SimulatedSite, KeepsMediumAndBitRate) {
    const auto of = [](std::string_view family, std::string_view uri) {
        World w;
        return simulated_site(w.make_site(families().find(family), uri, 1, "device"), families());
    };
    const Site can = of("uim342", "can:can0");
    EXPECT_EQ(can.lines[0].uri, "twin");
    EXPECT_EQ(kind_of(can.lines[0], families()), LineKind::can);
    EXPECT_EQ(can.drives[0].presence, PresenceRule::twin);
    const Site converter = of("uim342", "tcp:192.0.2.1:8888");
    EXPECT_EQ(kind_of(converter.lines[0], families()), LineKind::bytes);
    const Site serial = of("mcode", "serial:/dev/ttyUSB0?baud=19200");
    EXPECT_EQ(serial.lines[0].bitrate, 19200u);
    EXPECT_EQ(kind_of(serial.lines[0], families()), LineKind::bytes);
}

TEST(SpecimenLists, AreSeedsRangesAndNames) {
    std::string fault;
    EXPECT_EQ(read_specimens("1..3,17,slow,2,slow", fault), (std::vector<std::string>{"1", "2", "3", "17", "slow"}));
    EXPECT_EQ(read_specimens("0", fault), std::vector<std::string>{"0"});
    EXPECT_EQ(read_specimens("slow,5..6", fault), (std::vector<std::string>{"slow", "5", "6"}));
    EXPECT_TRUE(fault.empty()) << fault;
    for (const auto* wrong : {"", "1,", "fast", "3..1", "1..", "..4", "1..10001", "-1", "1..2..3", "1 ..3"}) {
        fault.clear();
        EXPECT_TRUE(read_specimens(wrong, fault).empty()) << wrong;
        EXPECT_FALSE(fault.empty()) << wrong;
    }
    EXPECT_EQ(read_specimens("1..10000", fault).size(), most_rehearsed_specimens);
}

}  // namespace
}  // namespace axisgate::test
