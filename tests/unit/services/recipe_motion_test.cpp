// Which motions belong to a run and are stopped when it fails or is cancelled; all others continue.
#include "tests/unit/services/recipe_bench.hpp"

namespace axisgate {
namespace {
using namespace recipe_test;

constexpr auto move_a = R"({"steps":[{"command":{"axis":"a","command":"move_absolute","position":1,"wait_s":3}}]})";
/// A velocity move of a that continues, then a step whose outcome the test determines.
std::string after_velocity(std::string_view step) {
    return R"({"steps":[{"command":{"axis":"a","command":"move_velocity","velocity":1}},)" + std::string(step) + "]}";
}

TEST_F(Runs, ARefusedCommandHasSetNothingInMotion) {
    for (const auto* step : {R"({"command":{"axis":"a","command":"move_absolute","position":1,"wait_s":3}})", R"({"home":{"axis":"a"}})",
                             R"({"action":{"axis":"a","name":"juggle"}})"}) {
        start(R"({"steps":[)" + std::string(step) + "]}");
        answer(false, "held by http otto (authority)");
        EXPECT_EQ(run->state(), RecipeRun::State::failed) << step;
        EXPECT_TRUE(requests.empty()) << step;
        EXPECT_TRUE(run->stops().empty()) << step;
    }
}

TEST_F(Runs, ARefusedCommandLeavesAnEarlierMotionTheRunsOwn) {
    start(after_velocity(R"({"command":{"axis":"a","command":"move_absolute","position":1}})"));
    answer();
    answer(false, "out of range");
    ASSERT_EQ(requests.size(), 1u);
    EXPECT_EQ(requests[0].what, RecipeRequest::What::stop);
}

TEST_F(Runs, WhatMayHaveBegunIsStopped) {
    start(move_a);
    answer(false, "no answer", {}, Published::unknown);
    ASSERT_EQ(requests.size(), 1u);
    EXPECT_EQ(requests[0].what, RecipeRequest::What::stop);
    start(move_a);
    EXPECT_TRUE(run->cancel("enough"));
    turn();
    ASSERT_EQ(requests.size(), 1u) << "the answer may be lost, the motion is not";
    EXPECT_EQ(requests[0].what, RecipeRequest::What::stop);
}

TEST_F(Runs, AVelocityMoveThatIsAtItsSpeedGoesOn) {
    start(
        R"({"steps":[{"command":{"axis":"a","command":"move_velocity","velocity":1,"wait_s":3}},{"check":{"axis":"a","point":"fault","is":false}}]})");
    answer();
    ASSERT_EQ(requests.size(), 1u);
    EXPECT_EQ(requests[0].what, RecipeRequest::What::stop);
}

TEST_F(Runs, AnInterruptedMotionIsNotTakenForTheOneThatInterrupted) {
    start(move_a);
    answer(false, "ended by move_absolute (interrupted)", {}, Published::interrupted);
    EXPECT_EQ(run->state(), RecipeRun::State::stopping);
    EXPECT_TRUE(requests.empty()) << "the drive has not taken the other command yet";
    EXPECT_EQ(run->deadline(), now + RecipeRun::look_period);
    world.claims["a"] = {Whose::others, "it moves by another command now"};
    pass(RecipeRun::look_period);
    EXPECT_TRUE(requests.empty());
    EXPECT_EQ(run->state(), RecipeRun::State::failed);
    ASSERT_EQ(run->stops().size(), 1u);
    EXPECT_TRUE(run->stops()[0].left_alone);
    EXPECT_FALSE(run->stops()[0].good);
    EXPECT_EQ(run->stops()[0].text, "left alone: it moves by another command now");
}

TEST_F(Runs, AnInterruptedMotionThatNobodyTakesOverIsStopped) {
    start(move_a);
    answer(false, "ended by move_absolute (interrupted)", {}, Published::interrupted);
    pass(RecipeRun::doubt_limit - milliseconds(1));
    EXPECT_TRUE(requests.empty());
    pass(milliseconds(1));
    ASSERT_EQ(requests.size(), 1u) << "the other command was refused by the drive: the axis still moves by the run's";
    answer();
    EXPECT_EQ(run->state(), RecipeRun::State::failed);
    EXPECT_TRUE(run->stops()[0].good);
}

TEST_F(Runs, AnInterruptedMotionThatStandsIsOver) {
    world.claims["a"] = {Whose::resting, ""};
    start(move_a);
    answer(false, "fault (interrupted)", {}, Published::interrupted);
    EXPECT_EQ(run->state(), RecipeRun::State::failed);
    EXPECT_TRUE(requests.empty());
    EXPECT_TRUE(run->stops().empty());
}

TEST_F(Runs, AMotionThatAnotherHolderHasTakenOverIsLeftAlone) {
    start(after_velocity(R"({"wait_s":100})"));
    answer();
    world.claims["a"] = {Whose::others, "http otto holds the axis now"};
    EXPECT_TRUE(run->cancel("enough"));
    turn();
    EXPECT_TRUE(requests.empty());
    EXPECT_EQ(run->state(), RecipeRun::State::cancelled);
    ASSERT_EQ(run->stops().size(), 1u);
    EXPECT_EQ(run->stops()[0].text, "left alone: http otto holds the axis now");
}

TEST_F(Runs, AMoveThatHasArrivedIsOverAndAVelocityMoveNeverIs) {
    for (const bool ends : {true, false}) {
        world.claims["a"] = {Whose::resting, ""};
        start(std::string(R"({"steps":[{"command":{"axis":"a",)") +
              (ends ? R"("command":"move_absolute","position":1)" : R"("command":"move_velocity","velocity":1)") +
              R"(}},{"wait_s":100}]})");
        answer();
        pass(RecipeRun::start_limit + milliseconds(1));
        EXPECT_TRUE(run->cancel("enough"));
        turn();
        EXPECT_EQ(requests.size(), ends ? 0u : 1u) << ends;
    }
    start(R"({"steps":[{"command":{"axis":"a","command":"move_absolute","position":1}},{"wait_s":100}]})");
    answer();
    EXPECT_TRUE(run->cancel("enough"));
    turn();
    EXPECT_EQ(requests.size(), 1u) << "just begun: that it is not seen moving says nothing yet";
}

TEST_F(Runs, APreparedMotionIsNoneUntilAnActionMayHaveStartedIt) {
    const std::string prepare = R"({"command":{"axis":"a","command":"move_absolute","position":1,"prepare":true}})";
    start(R"({"steps":[)" + prepare + R"(,{"wait_s":100}]})");
    answer();
    EXPECT_TRUE(run->cancel("enough"));
    turn();
    EXPECT_TRUE(requests.empty());
    start(R"({"steps":[)" + prepare + R"(,{"action":{"axis":"b","name":"start_group"}},{"wait_s":100}]})");
    answer();
    answer();
    EXPECT_TRUE(run->cancel("enough"));
    turn();
    ASSERT_EQ(requests.size(), 2u);
    EXPECT_EQ(requests[0].axis, "a");
    EXPECT_EQ(requests[1].axis, "b");
}

TEST_F(Runs, ACommandThatHasBegunNothingStopsNothing) {
    start(R"({"steps":[{"action":{"axis":"a","name":"program.list"}},{"wait_s":100}]})");
    run->answer(requests[0].number, {true, "", {}, Published::nothing});
    EXPECT_TRUE(run->cancel("enough"));
    turn();
    EXPECT_TRUE(requests.empty());
}
}  // namespace
}  // namespace axisgate
