// Freedoms of a page and the specimens that are drawn from them: the format, the named extremes, and that a draw depends on nothing but
// its seed and the name of its freedom.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/json.hpp>
#include <cstdlib>
#include <set>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/specimen.hpp"

namespace axisgate {
namespace {
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string reply(const std::string& more = "") {
    return R"({"name":"reply_ms","unit":"ms","min":0,"max":200,"default":2,"description":"how late an answer is","source":"silent",)"
           R"("named":{"slow":200}})" +
           more;
}
const std::string order = R"(,{"name":"order","min":0,"max":2,"default":0,"description":"order of two notices","source":"section 4.2",)"
                          R"("values":{"0":"status first","2":"event first"},"named":{"strict":2}})";

Catalogue page(const std::string& freedoms) {
    std::vector<std::string> faults;
    auto c =
        Catalogue::parse(R"({"family":"toy","number":1,"parameters":[],"commands":[],"errors":[],"freedoms":[)" + freedoms + "]}", faults);
    EXPECT_THAT(faults, IsEmpty());
    return c ? *std::move(c) : Catalogue();
}
std::vector<std::string> faults_of(const std::string& freedoms) {
    std::vector<std::string> faults;
    (void)read_freedoms(boost::json::parse(R"({"freedoms":)" + freedoms + "}").as_object(), faults);
    return faults;
}

TEST(Freedoms, APageSaysRangeDefaultMeaningAndSource) {
    const Catalogue c = page(reply(order));
    ASSERT_EQ(c.freedoms().size(), 2u);
    const Freedom& f = c.freedoms()[0];
    EXPECT_EQ(f.name, "reply_ms");
    EXPECT_EQ(f.unit, "ms");
    EXPECT_EQ(f.min, 0);
    EXPECT_EQ(f.max, 200);
    EXPECT_EQ(f.fallback, 2);
    EXPECT_EQ(f.source, "silent");
    EXPECT_EQ(f.extremes.at("slow"), 200);
    EXPECT_EQ(c.freedoms()[1].values.size(), 2u);
    EXPECT_THAT(Catalogue().freedoms(), IsEmpty());
}

TEST(Freedoms, EachFaultOfAPageIsToldWithItsPlace) {
    EXPECT_THAT(faults_of("3"), ElementsAre(HasSubstr("not a list")));
    EXPECT_THAT(faults_of("[3]"), ElementsAre(HasSubstr("freedoms[0]: not an object")));
    EXPECT_THAT(faults_of("[" + reply("," + reply()) + "]"), ElementsAre(HasSubstr("freedoms[1]: reply_ms is there twice")));
    EXPECT_THAT(faults_of("[{}]"), Contains(HasSubstr("freedoms[0].source: a text is missing")));
    EXPECT_THAT(faults_of("[{}]"), Contains(HasSubstr("freedoms[0].default: a whole number is missing")));
    const std::string begin = R"([{"name":"a","description":"b","source":"c",)";
    EXPECT_THAT(faults_of(begin + R"("min":0,"max":3,"default":4}])"), ElementsAre(HasSubstr("disagree")));
    EXPECT_THAT(faults_of(begin + R"("min":3,"max":0,"default":2}])"), ElementsAre(HasSubstr("disagree")));
    EXPECT_THAT(faults_of(begin + R"("min":0,"max":3,"default":1,"values":{"0":"none","3":"all"}}])"), ElementsAre(HasSubstr("disagree")));
    EXPECT_THAT(faults_of(begin + R"("min":0,"max":3,"default":0,"values":{"0":"none","x":"all"}}])"), ElementsAre(HasSubstr("values: x")));
    EXPECT_THAT(faults_of(begin + R"("min":0,"max":3,"default":0,"named":{"slow":4}}])"), ElementsAre(HasSubstr("named.slow")));
    EXPECT_THAT(faults_of(begin + R"("min":0,"max":3,"default":0,"named":{"quick":1}}])"), ElementsAre(HasSubstr("named.quick")));
}

TEST(Specimens, ATextIsASeedOrAName) {
    for (const auto* good : {"0", "1", "1000000000", "slow", "sparse", "strict", "chatty", "weak", "old"}) {
        EXPECT_TRUE(is_specimen(good)) << good;
        EXPECT_EQ(check_specimen(good), "");
    }
    for (const auto* bad : {"", "-1", "1000000001", "1.5", "fast", "SLOW", "7 ", "99999999999999999999"}) {
        EXPECT_FALSE(is_specimen(bad)) << bad;
        EXPECT_THAT(check_specimen(bad), HasSubstr("slow, sparse, strict, chatty, weak, old")) << bad;
    }
}

TEST(Specimens, SeedZeroIsTheDriveOfTheManualAndANameIsItsExtreme) {
    const Catalogue c = page(reply(order));
    EXPECT_EQ(specimen_values(c, "0"), (FreedomValues{{"reply_ms", 2}, {"order", 0}}));
    EXPECT_EQ(specimen_values(c, "slow"), (FreedomValues{{"reply_ms", 200}, {"order", 0}}));
    EXPECT_EQ(specimen_values(c, "strict"), (FreedomValues{{"reply_ms", 2}, {"order", 2}}));
    EXPECT_EQ(specimen_values(c, "weak"), specimen_values(c, "0"));
    EXPECT_EQ(specimen_values(c, "nonsense"), specimen_values(c, "0"));
}

TEST(Specimens, ADrawIsPermittedAndReachesTheWholeRange) {
    const Catalogue c = page(reply(order));
    std::set<std::int64_t> times, orders;
    int defaults = 0, short_times = 0;
    for (int seed = 1; seed <= 2000; ++seed) {
        const auto v = specimen_values(c, std::to_string(seed));
        times.insert(v.at("reply_ms"));
        orders.insert(v.at("order"));
        defaults += v.at("reply_ms") == 2;
        short_times += v.at("reply_ms") < 20;
        EXPECT_EQ(v, specimen_values(c, std::to_string(seed)));
    }
    EXPECT_EQ(*times.begin(), 0);
    EXPECT_GE(*times.rbegin(), 195);
    EXPECT_GE(times.size(), 100u);
    EXPECT_EQ(orders, (std::set<std::int64_t>{0, 2})) << "1 is in the range, and no value";
    EXPECT_NEAR(defaults, 1000, 250) << "half of the draws keep the manual's value";
    EXPECT_GT(short_times, 1300) << "small values are drawn as often as large ones";
}

TEST(Specimens, ARangeAroundZeroIsDrawnInBothDirectionsAndManySizes) {
    const std::string start =
        R"({"name":"start_increments","min":-1000000,"max":1000000,"default":5,"description":"the start","source":"silent"},)"
        R"({"name":"below_increments","min":-1000,"max":0,"default":0,"description":"only below","source":"silent"},)"
        R"({"name":"away_increments","min":-1000,"max":-10,"default":-10,"description":"away from 0","source":"silent"})";
    const Catalogue c = page(start);
    int below = 0, above = 0, small = 0, large = 0;
    for (int seed = 1; seed <= 2000; ++seed) {
        const auto v = specimen_values(c, std::to_string(seed));
        const std::int64_t n = v.at("start_increments");
        EXPECT_TRUE(n >= -1'000'000 && n <= 1'000'000) << n;
        EXPECT_TRUE(v.at("below_increments") >= -1000 && v.at("below_increments") <= 0);
        EXPECT_TRUE(v.at("away_increments") >= -1000 && v.at("away_increments") <= -10);
        if (n == 5) continue;
        below += n < 0;
        above += n > 0;
        small += std::llabs(n) < 1000;
        large += std::llabs(n) >= 1000;
    }
    EXPECT_NEAR(below, 500, 120);
    EXPECT_NEAR(above, 500, 120);
    EXPECT_NEAR(small, 500, 120) << "a size below 1,000 is drawn as often as one above";
    EXPECT_NEAR(large, 500, 120);
}

TEST(Specimens, AFurtherFreedomChangesNoDraw) {
    const Catalogue before = page(reply()), after = page(order.substr(1) + "," + reply());
    for (int seed = 0; seed < 300; ++seed) {
        const std::string s = std::to_string(seed);
        EXPECT_EQ(specimen_values(before, s).at("reply_ms"), specimen_values(after, s).at("reply_ms")) << seed;
    }
    int differ = 0;
    for (int seed = 1; seed < 300; ++seed)
        differ += specimen_draw(static_cast<std::uint64_t>(seed), "reply_ms", 0) % 2 !=
                  specimen_draw(static_cast<std::uint64_t>(seed), "order", 0) % 2;
    EXPECT_NEAR(differ, 150, 50) << "freedoms are drawn independently of each other";
}

TEST(Specimens, AFreedomInTheOptionsGoesBeforeTheSpecimen) {
    const Catalogue c = page(reply(order));
    EXPECT_EQ(freedoms_of(c, {}), specimen_values(c, "0"));
    EXPECT_EQ(freedoms_of(c, {{"specimen", "17"}}), specimen_values(c, "17"));
    EXPECT_EQ(freedoms_of(c, {{"specimen", "slow"}, {"reply_ms", "7"}}).at("reply_ms"), 7);
    for (const auto* bad : {"201", "-1", "", "7x", "7.5"})
        EXPECT_EQ(freedoms_of(c, {{"specimen", "slow"}, {"reply_ms", bad}}).at("reply_ms"), 200) << bad;
    EXPECT_EQ(freedoms_of(c, {{"order", "1"}, {"model", "x"}}), specimen_values(c, "0"));
}

TEST(Specimens, AWrongValueIsToldWithThePermittedOnes) {
    const Catalogue c = page(reply(order));
    EXPECT_EQ(check_freedom(c, "reply_ms", "200"), "");
    EXPECT_EQ(check_freedom(c, "reply_ms", "201"), "reply_ms = 201: write a whole number from 0 to 200 ms");
    EXPECT_EQ(check_freedom(c, "order", "1"), "order = 1: write one of 0 (status first), 2 (event first)");
    EXPECT_EQ(check_freedom(c, "orders", "1"), "orders is no freedom of toy");
}

TEST(Specimens, InWordsItSaysItsDifferencesFromTheManual) {
    const Catalogue c = page(reply(order));
    EXPECT_THAT(specimen_in_words(c, specimen_values(c, "0")), IsEmpty());
    EXPECT_THAT(specimen_in_words(c, {}), IsEmpty());
    EXPECT_THAT(specimen_in_words(c, {{"reply_ms", 40}, {"order", 2}}),
                ElementsAre("reply_ms = 40 ms: how late an answer is", "order = 2 (event first)"));
}

TEST(Specimens, AFreedomThatIsNotInTheMapHasTheDefaultOfItsReader) {
    const FreedomValues v{{"reply_ms", 40}};
    EXPECT_EQ(freedom(v, "reply_ms", 2), 40);
    EXPECT_EQ(freedom(v, "order", 2), 2);
}

}  // namespace
}  // namespace axisgate
