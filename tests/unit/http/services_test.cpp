// Services without any door: alarms are raised and stored, and recipes can be run. There is no router and no connection.
#include <gtest/gtest.h>

#include <boost/json/parse.hpp>

#include "gateway/doors/dds/words.hpp"
#include "gateway/services/recipes/recipe_read.hpp"
#include "gateway/services/services.hpp"
#include "tests/unit/http/fake_gateway.hpp"

namespace axisgate::http::test {
namespace {
namespace json = boost::json;

struct ServicesAlone : testing::Test {
    FakeGateway gateway;
    Instant now = at_ns(1'000'000'000);
    std::unique_ptr<Services> services = make();

    std::unique_ptr<Services> make() {
        return std::make_unique<Services>(gateway.ports(), [this] { return now; });
    }
};

TEST_F(ServicesAlone, RaiseAlarmsAndKeepThemForTheNextStart) {
    gateway.tell(event("too much current", "feeder", Severity::alarm, "fault"));
    ASSERT_EQ(services->alarms->list().all().size(), 1u);
    const auto id = services->alarms->list().all().begin()->first;
    EXPECT_FALSE(gateway.documents("alarm").empty()) << "on the disk, though nobody asked for it";
    services.reset();
    EXPECT_TRUE(gateway.listeners.empty()) << "nothing is told to services that are gone";
    EXPECT_TRUE(gateway.site_listeners.empty());
    gateway.events_.clear();  // stored alarms are not derived from the events again
    services = make();
    ASSERT_EQ(services->alarms->list().all().size(), 1u);
    EXPECT_EQ(services->alarms->list().all().begin()->first, id);
}

TEST_F(ServicesAlone, RunRecipesOfWhoeverComes) {
    gateway.set_picture("feeder", standing(3200));
    std::vector<SiteFault> faults;
    auto recipe = read_recipe(json::parse(R"({"steps":[{"enable":{"axis":"feeder"}}]})").get_object(), nullptr, faults);
    ASSERT_TRUE(recipe);
    const auto begun = services->recipes->start("go", std::move(*recipe), {},
                                                {axisgate::dds::clients, std::make_shared<const std::string>("a panel"), {}});
    ASSERT_TRUE(std::holds_alternative<json::object>(begun));
    EXPECT_LE(services->deadline(), now) << "the services have one deadline, and it is the recipe's";
    services->on_deadline(now);
    ASSERT_EQ(gateway.submitted.size(), 1u);
    EXPECT_EQ(*gateway.submitted[0].origin.who, "recipe go by a panel");
    Result done;
    done.outcome = Outcome::done;
    gateway.finish(done);
    services->on_deadline(now);
    EXPECT_EQ(services->recipes->report("go", 1)->at("state"), json::value("done"));
}

}  // namespace
}  // namespace axisgate::http::test
