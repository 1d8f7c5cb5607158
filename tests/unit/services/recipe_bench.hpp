// One run of a recipe in virtual time, with a world and answers of the test, without a gateway.
#pragma once

#include <gtest/gtest.h>

#include <boost/json/parse.hpp>
#include <map>
#include <memory>

#include "gateway/axis/points.hpp"
#include "gateway/services/recipes/recipe_read.hpp"
#include "gateway/services/recipes/recipe_run.hpp"

namespace axisgate::recipe_test {
namespace json = boost::json;
using std::chrono::milliseconds;

inline json::object object(std::string_view text) { return json::parse(text).get_object(); }

struct World final : RecipeWorld {
    std::map<std::string, Value, std::less<>> points;
    mutable std::vector<const AxisPointRow*> looked_at;
    [[nodiscard]] Value point(std::string_view axis, const AxisPointRow& row) const override {
        looked_at.push_back(&row);
        const auto it = points.find(std::string(axis) + "." + std::string(row.name));
        return it == points.end() ? Value{} : it->second;
    }
    std::map<std::string, Claim, std::less<>> claims;
    [[nodiscard]] Claim claim(std::string_view axis) const override {
        const auto it = claims.find(axis);
        return it == claims.end() ? Claim{} : it->second;
    }
};
using Published = RecipeAnswer::Motion;
using Whose = RecipeWorld::Claim::Whose;

class Runs : public ::testing::Test {
protected:
    Instant now = at_ns(1'000'000'000);
    World world;
    std::vector<RecipeRequest> requests;
    std::unique_ptr<RecipeRun> run;

    void start(std::string_view document) {
        std::vector<SiteFault> faults;
        auto r = read_recipe(object(document), nullptr, faults);
        ASSERT_TRUE(r) << faults.front().pointer << " " << faults.front().text;
        run = std::make_unique<RecipeRun>(std::move(*r), now);
        turn();
    }
    void turn() {
        requests.clear();
        run->turn(now, world, requests);
    }
    void pass(Duration d) {
        now += d;
        turn();
    }
    void answer(bool good = true, std::string text = {}, Value value = {}, Published motion = Published::by_result) {
        ASSERT_EQ(requests.size(), 1u);
        run->answer(requests[0].number, {good, std::move(text), std::move(value), motion});
        EXPECT_LE(run->deadline(), now);
        turn();
    }
};

}  // namespace axisgate::recipe_test
