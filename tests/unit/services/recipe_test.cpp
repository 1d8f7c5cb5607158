// Recipes without a gateway: faults of the document, arguments, and the run as a state machine in virtual time.
#include <limits>

#include "tests/unit/services/recipe_bench.hpp"

namespace axisgate {
namespace {
using namespace recipe_test;
using std::chrono::seconds;

std::string deep(std::size_t n) {
    std::string s = R"({"wait_s":0})";
    for (std::size_t i = 0; i < n; ++i)
        s = R"({"repeat":{"times":1,"steps":[)" + s + "]}}";
    return R"({"steps":[)" + s + "]}";
}
std::string many(std::size_t n) {
    std::string s;
    for (std::size_t i = 0; i < n; ++i)
        s += std::string(i ? "," : "") + R"({"wait_s":0})";
    return R"({"steps":[)" + s + "]}";
}

struct BadCase {
    std::string name, document, pointer;
};
class BadRecipe : public ::testing::TestWithParam<BadCase> {};
TEST_P(BadRecipe, IsRefusedWithItsPlace) {
    std::vector<SiteFault> faults;
    EXPECT_FALSE(read_recipe(object(GetParam().document), nullptr, faults));
    ASSERT_FALSE(faults.empty());
    EXPECT_EQ(faults.front().pointer, GetParam().pointer) << faults.front().text;
    EXPECT_FALSE(faults.front().text.empty());
    EXPECT_FALSE(faults.front().remedy.empty());
}
INSTANTIATE_TEST_SUITE_P(
    Documents, BadRecipe,
    ::testing::Values(
        BadCase{"no_steps", "{}", "/steps"}, BadCase{"empty", R"({"steps":[]})", "/steps"},
        BadCase{"unknown_member", R"({"steps":[{"wait_s":1}],"zzz":1})", "/zzz"},
        BadCase{"unknown_step", R"({"steps":[{"fly":{}}]})", "/steps/0/fly"},
        BadCase{"two_words", R"({"steps":[{"wait_s":1,"message":"x"}]})", "/steps/0/message"},
        BadCase{"no_word", R"({"steps":[{"comment":"x"}]})", "/steps/0"},
        BadCase{"no_axis", R"({"steps":[{"enable":{}}]})", "/steps/0/enable"},
        BadCase{"member", R"({"steps":[{"enable":{"axis":"a","speed":1}}]})", "/steps/0/enable/speed"},
        BadCase{"no_value", R"({"steps":[{"set_parameter":{"axis":"a","parameter":"AC"}}]})", "/steps/0/set_parameter"},
        BadCase{"negative_wait", R"({"steps":[{"wait_s":-1}]})", "/steps/0/wait_s"},
        BadCase{"day", R"({"steps":[{"wait_s":86401}]})", "/steps/0/wait_s"},
        BadCase{"no_comparison", R"({"steps":[{"check":{"axis":"a","point":"moving"}}]})", "/steps/0/check"},
        BadCase{"two_comparisons", R"({"steps":[{"check":{"axis":"a","point":"position","above":1,"below":2}}]})", "/steps/0/check"},
        BadCase{"order_of_text", R"({"steps":[{"check":{"axis":"a","point":"state","above":"x"}}]})", "/steps/0/check/above"},
        BadCase{"point", R"({"steps":[{"check":{"axis":"a","point":"colour","is":1}}]})", "/steps/0/check/point"},
        BadCase{"point_and_parameter", R"({"steps":[{"check":{"axis":"a","point":"state","parameter":"AC","is":1}}]})", "/steps/0/check"},
        BadCase{"endless", R"({"steps":[{"repeat":{"steps":[{"wait_s":1}]}}]})", "/steps/0/repeat"},
        BadCase{"too_often", R"({"steps":[{"repeat":{"times":10001,"steps":[{"wait_s":1}]}}]})", "/steps/0/repeat/times"},
        BadCase{"no_condition", R"({"steps":[{"if":{"then":[{"wait_s":1}]}}]})", "/steps/0/if"},
        BadCase{"nested_fault", R"({"steps":[{"if":{"condition":{"axis":"a","point":"fault","is":true},"then":[],"else":[{"x":1}]}}]})",
                "/steps/0/if/else/0/x"},
        BadCase{"too_deep", deep(8),
                "/steps/0/repeat/steps/0/repeat/steps/0/repeat/steps/0/repeat/steps/0/repeat/steps/0/repeat/steps/0/repeat/steps/0/repeat/"
                "steps"},
        BadCase{"too_many", many(501), "/steps"}, BadCase{"no_parameter", R"({"steps":[{"message":"${x}"}]})", "/steps/0/message"},
        BadCase{"type", R"({"parameters":{"x":{"type":"colour"}},"steps":[{"wait_s":1}]})", "/parameters/x/type"},
        BadCase{"default", R"({"parameters":{"x":{"type":"number","default":5,"max":4}},"steps":[{"wait_s":1}]})", "/parameters/x/default"},
        BadCase{"on_failure", R"({"on_failure":"pray","steps":[{"wait_s":1}]})", "/on_failure"},
        BadCase{"timeout", R"({"timeout_s":0,"steps":[{"wait_s":1}]})", "/timeout_s"},
        BadCase{"long_text", R"({"steps":[{"message":")" + std::string(4097, 'x') + R"("}]})", "/steps/0/message"},
        BadCase{"register", R"({"steps":[{"write_register":{"unit":1,"address":65536,"value":1}}]})", "/steps/0/write_register/address"},
        BadCase{"half_a_unit", R"({"steps":[{"write_register":{"unit":1.5,"address":32,"value":1}}]})", "/steps/0/write_register/unit"}),
    [](const auto& p) { return p.param.name; });

TEST(Recipe, BoundsThemselvesAreAllowed) {
    std::vector<SiteFault> faults;
    EXPECT_TRUE(read_recipe(object(deep(7)), nullptr, faults)) << faults.front().pointer;
    EXPECT_TRUE(read_recipe(object(many(500)), nullptr, faults));
}

TEST(Recipe, AllFaultsComeAtOnce) {
    std::vector<SiteFault> faults;
    EXPECT_FALSE(read_recipe(object(R"({"steps":[{"fly":1},{"enable":{}},{"wait_s":"x"}],"y":1})"), nullptr, faults));
    EXPECT_EQ(faults.size(), 4u);
}

TEST(Recipe, ArgumentsStandInWithTheirOwnType) {
    const auto document = object(R"({"parameters":{"d":{"type":"number","default":10,"max":50},"a":{"type":"axis"}},
        "steps":[{"command":{"axis":"${a}","command":"move_relative","position":"${d}"}},{"message":"${a} by ${d}!"},{"wait_s":"${d}"}]})");
    std::vector<SiteFault> faults;
    const auto args = object(R"({"a":"feeder","d":2.5})");
    const auto r = read_recipe(document, &args, faults);
    ASSERT_TRUE(r) << faults.front().text;
    EXPECT_EQ(r->steps[0].axis, "feeder");
    EXPECT_EQ(std::get<double>(std::get<CommandWish>(r->steps[0].wish).position), 2.5);
    EXPECT_EQ(r->steps[1].text, "feeder by 2.5!") << "as people write it";
    EXPECT_EQ(r->steps[2].limit, milliseconds(2500));
    const auto whole = whole_arguments(document, object(R"({"a":"x"})"));
    EXPECT_EQ(whole.at("d"), json::value(10));
    for (const auto* bad : {R"({"d":1})", R"({"a":"x","d":51})", R"({"a":"x","d":"1"})", R"({"a":"x","z":1})", R"({"a":1})"}) {
        faults.clear();
        const auto wrong = object(bad);
        EXPECT_FALSE(read_recipe(document, &wrong, faults)) << bad;
        ASSERT_FALSE(faults.empty());
        EXPECT_TRUE(faults.front().pointer.starts_with("/arguments/")) << faults.front().pointer;
    }
}

TEST(Recipe, AStepIsTypedOnceAndKeepsNoDocument) {
    std::vector<SiteFault> faults;
    const auto r = read_recipe(object(R"({"steps":[
        {"set_parameter":{"axis":"a","parameter":"AC","value":2.5}},{"read_parameter":{"axis":"a","parameter":"QE"}},
        {"home":{"axis":"a","method":17,"wait_s":3}},{"command":{"axis":"a","command":"halt"}},
        {"action":{"axis":"a","name":"program.start","argument":"M1"}},{"simulate":{"axis":"a","input":"stall","value":true}},
        {"write_register":{"unit":2.0,"address":10,"type":"u32","value":7}},{"write_register":{"unit":2,"address":10,"type":5,"value":[1]}},
        {"wait_for":{"axis":"a","point":"position","at_least":18446744073709551615}},{"check":{"axis":"a","parameter":"QE","is":"x"}},
        {"enable":{"axis":"a"}}]})"),
                               nullptr, faults);
    ASSERT_TRUE(r) << faults.front().pointer << " " << faults.front().text;
    const auto& s = r->steps;
    EXPECT_EQ(std::get<ParameterWish>(s[0].wish).parameter, "AC");
    EXPECT_EQ(std::get<ParameterWish>(s[0].wish).value, Value{2.5});
    EXPECT_EQ(std::get<ParameterWish>(s[1].wish).parameter, "QE");
    EXPECT_EQ(word_of(s[2]), CommandWord::home);
    EXPECT_EQ(std::get<double>(std::get<CommandWish>(s[2].wish).method), 17);
    EXPECT_TRUE(std::get<CommandWish>(s[2].wish).unknown.empty()) << "the recipe's own members are none of the command's";
    EXPECT_EQ(word_of(s[3]), CommandWord::halt);
    EXPECT_EQ(std::get<ActionWish>(s[4].wish).argument, "M1");
    EXPECT_EQ(std::get<SimulateWish>(s[5].wish).value, Value{true});
    const auto& reg = std::get<RegisterWish>(s[6].wish);
    EXPECT_EQ(reg.unit, 2);
    EXPECT_EQ(reg.address, 10);
    EXPECT_EQ(reg.type, "u32");
    EXPECT_EQ(reg.value, Value{std::int64_t{7}});
    EXPECT_EQ(std::get<RegisterWish>(s[7].wish).type, "") << "no type's name";
    EXPECT_EQ(std::get<RegisterWish>(s[7].wish).value, Value{});
    EXPECT_EQ(s[8].condition->row, point_named("position"));
    EXPECT_EQ(s[8].condition->value, Value{18446744073709551615.0});
    EXPECT_TRUE(s[9].condition->reads_drive());
    EXPECT_EQ(word_of(s[10]), CommandWord::missing);
}

TEST(Recipe, ConditionsCompareWhatCanBeCompared) {
    RecipeCondition c;
    c.value = std::int64_t{10};
    c.tolerance = 0.5;
    EXPECT_EQ(holds(c, 10.4), true);
    EXPECT_EQ(holds(c, 10.6), false);
    EXPECT_EQ(holds(c, Value{}), std::nullopt);
    EXPECT_EQ(holds(c, "10"), std::nullopt);
    c.op = RecipeCondition::Op::above;
    EXPECT_EQ(holds(c, std::int64_t{10}), false);
    c.op = RecipeCondition::Op::at_least;
    EXPECT_EQ(holds(c, std::int64_t{10}), true);
    c.op = RecipeCondition::Op::is_not;
    c.value = "fault";
    EXPECT_EQ(holds(c, "ready"), true);
    c.op = RecipeCondition::Op::is;
    c.value = true;
    EXPECT_EQ(holds(c, true), true);
    EXPECT_EQ(holds(c, false), false);
}

// --- runs -------------------------------------------------------------------------------------------------------------------

TEST_F(Runs, OneStepAfterTheOther) {
    start(R"({"steps":[{"enable":{"axis":"a"}},{"wait_s":2},{"message":"hello"}]})");
    ASSERT_EQ(requests.size(), 1u);
    EXPECT_EQ(requests[0].axis, "a");
    EXPECT_EQ(run->deadline(), now + seconds(10));
    answer();
    EXPECT_EQ(run->deadline(), now + seconds(2));
    pass(milliseconds(1999));
    EXPECT_TRUE(requests.empty());
    pass(milliseconds(1));
    ASSERT_EQ(requests.size(), 1u);
    answer();
    EXPECT_EQ(run->state(), RecipeRun::State::done);
    EXPECT_EQ(run->deadline(), never);
    EXPECT_EQ(run->rows()[2].text, "hello");
    EXPECT_EQ(run->rows()[1].ended - run->rows()[1].started, seconds(2));
}

TEST_F(Runs, ACommandThatIsNotDoneInTimeFailsAndItsAxisIsStopped) {
    start(R"({"steps":[{"command":{"axis":"a","command":"move_absolute","position":1,"wait_s":3}},{"wait_s":1}]})");
    const auto late = requests[0].number;
    pass(seconds(3));
    EXPECT_EQ(run->state(), RecipeRun::State::stopping);
    ASSERT_EQ(requests.size(), 1u);
    EXPECT_EQ(requests[0].what, RecipeRequest::What::stop);
    EXPECT_EQ(requests[0].axis, "a");
    run->answer(late, {true, ""});  // it is not waited for any more
    answer(true, "stands");
    EXPECT_EQ(run->state(), RecipeRun::State::failed);
    ASSERT_TRUE(run->where());
    EXPECT_EQ(run->where()->pointer, "/steps/0");
    EXPECT_EQ(run->text(), "not done within 3 s");
    EXPECT_TRUE(run->stops()[0].good);
    EXPECT_EQ(run->rows()[1].state, RecipeRow::State::not_run);
}

TEST_F(Runs, AMotionSeenToItsEndIsNotStoppedLater) {
    start(
        R"({"steps":[{"command":{"axis":"a","command":"move_absolute","position":1,"wait_s":3}},{"command":{"axis":"b","command":"move_absolute","position":1}},{"command":{"axis":"c","command":"move_velocity","velocity":1}},{"command":{"axis":"c","command":"halt"}},{"check":{"axis":"a","point":"fault","is":false}}]})");
    answer();
    answer();
    answer();
    world.points["a.fault"] = true;
    answer();
    ASSERT_EQ(requests.size(), 1u) << "b alone: a is at its target, c was halted by the recipe itself";
    EXPECT_EQ(requests[0].axis, "b");
    EXPECT_EQ(run->text(), "a fault is false: it is true");
}

TEST_F(Runs, NumbersOfTheReportAreWrittenAsPeopleWriteThem) {
    world.points["a.position"] = 5.4990625;
    start(R"({"steps":[{"check":{"axis":"a","point":"position","at_least":5.5}}]})");
    EXPECT_EQ(run->state(), RecipeRun::State::failed);
    EXPECT_EQ(run->text(), "a position at_least 5.5: it is 5.4990625");
}

// --- labels of steps ----------------------------------------------------------------------------------------------------------

TEST(Recipe, StepsHaveLabelsForPeople) {
    std::vector<SiteFault> faults;
    const auto r = read_recipe(object(R"({"steps":[
        {"set_parameter":{"axis":"feeder","parameter":"AC","value":20000}},
        {"repeat":{"times":5,"steps":[{"if":{"condition":{"axis":"feeder","point":"moving","is":true},
            "then":[{"command":{"axis":"feeder","command":"move_relative","position":2.5,"velocity":4,"wait_s":2}}],
            "else":[{"action":{"axis":"feeder","name":"program.start","argument":"M1"}}]}}]}},
        {"write_register":{"unit":3,"address":10,"type":"u32","value":7}},{"wait_s":0.5},{"home":{"axis":"feeder","method":17}},
        {"message":")" + std::string(99, 'x') +
                                      std::string(71, 'y') +
                                      "\xC3\xA4\xC3\xA4\xC3\xA4\xC3\xA4\xC3\xA4\xC3\xA4\xC3\xA4\xC3\xA4\xC3\xA4\xC3\xA4" + R"("}]})"),
                               nullptr, faults);
    ASSERT_TRUE(r) << faults.front().text;
    std::vector<std::string> labels;
    for_each_step(r->steps, [&](const RecipeStep& s) {
        labels.push_back(label_of(s, s.pointer.find("repeat") == std::string::npos ? "" : "2 of 5"));
    });
    EXPECT_EQ(labels[0], "Step 1: set_parameter AC of feeder = 20000");
    EXPECT_EQ(labels[1], "Step 2: repeat 5 times");
    EXPECT_EQ(labels[2], "Step 2.1 (pass 2 of 5): if feeder moving is true");
    EXPECT_EQ(labels[3], "Step 2.1.then.1 (pass 2 of 5): command move_relative of feeder, position = 2.5, velocity = 4");
    EXPECT_EQ(labels[4], "Step 2.1.else.1 (pass 2 of 5): action program.start of feeder, argument = M1");
    EXPECT_EQ(labels[5], "Step 3: write_register 10 of unit 3 = 7");
    EXPECT_EQ(labels[6], "Step 4: wait_s 0.5");
    EXPECT_EQ(labels[7], "Step 5: home feeder, method = 17");
    EXPECT_LE(labels[8].size(), most_recipe_label_bytes);
    EXPECT_TRUE(labels[8].ends_with("\xA4...")) << labels[8];
}

TEST_F(Runs, ARowSaysWhichPassItWas) {
    start(R"({"steps":[{"repeat":{"times":2,"steps":[{"repeat":{"times":3,"steps":[{"message":"y"}]}}]}}]})");
    for (int i = 0; i < 4; ++i)
        answer();
    EXPECT_EQ(run->rows()[2].pass, "2 of 2, 2 of 3");
    EXPECT_EQ(run->rows()[1].pass, "2 of 2");
    EXPECT_EQ(run->rows()[0].pass, "");
}

TEST(Recipe, AFaultOfATextCanStandUnderAField) {
    for (const auto& [document, text] :
         {std::pair(R"({"steps":[{"set_parameter":{"axis":"a","parameter":"","value":1}}]})", "parameter must be a text, such as \"AC\""),
          std::pair(R"({"steps":[{"enable":{"axis":""}}]})", "axis must be a text, such as \"feeder\""),
          std::pair(R"({"steps":[{"message":5}]})", "message must be a text, such as \"tool changed\"")}) {
        std::vector<SiteFault> faults;
        EXPECT_FALSE(read_recipe(object(document), nullptr, faults));
        ASSERT_FALSE(faults.empty());
        EXPECT_EQ(faults[0].text, text);
        EXPECT_EQ(faults[0].remedy, "fill it in");
    }
}

TEST_F(Runs, AStopWithoutAnAnswerEndsAfterItsLimit) {
    start(R"({"steps":[{"command":{"axis":"a","command":"move_velocity","velocity":1}}, {"wait_s":100}]})");
    answer();
    EXPECT_TRUE(run->cancel("enough"));
    EXPECT_FALSE(run->cancel("again"));
    EXPECT_LE(run->deadline(), now);
    turn();
    EXPECT_EQ(run->state(), RecipeRun::State::stopping);
    EXPECT_EQ(run->deadline(), now + RecipeRun::stop_limit);
    pass(RecipeRun::stop_limit);
    EXPECT_EQ(run->state(), RecipeRun::State::cancelled);
    EXPECT_FALSE(run->stops()[0].good);
    EXPECT_EQ(run->rows()[1].state, RecipeRow::State::cancelled);
    EXPECT_FALSE(run->cancel("late"));
}

TEST_F(Runs, WaitsForAPoint) {
    start(R"({"steps":[{"wait_for":{"axis":"a","point":"position","at_least":5,"timeout_s":1}}]})");
    EXPECT_EQ(run->deadline(), now + RecipeRun::look_period);
    world.points["a.position"] = 4.9;
    pass(RecipeRun::look_period);
    EXPECT_EQ(run->state(), RecipeRun::State::running);
    world.points["a.position"] = 5.0;
    pass(RecipeRun::look_period);
    EXPECT_EQ(run->state(), RecipeRun::State::done);
    EXPECT_EQ(run->rows()[0].value, Value{std::int64_t{5}}) << "a whole number, as the report shows it";
}

TEST_F(Runs, AWaitLooksAtItsOneValueAndShowsItAsTheReportDoes) {
    start(R"({"steps":[{"wait_for":{"axis":"a","point":"position","at_least":5,"timeout_s":1}}]})");
    const auto looks = world.looked_at.size();
    const auto before = run->revision();
    world.points["a.position"] = -0.0;
    pass(RecipeRun::look_period);
    world.points["a.position"] = std::int64_t{0};
    pass(RecipeRun::look_period);
    EXPECT_EQ(run->revision(), before + 1) << "it is the same 0";
    world.points["a.position"] = std::numeric_limits<double>::quiet_NaN();
    pass(RecipeRun::look_period);
    EXPECT_EQ(run->rows()[0].value, Value{}) << "not known";
    const auto unknown = run->revision();
    pass(RecipeRun::look_period);
    EXPECT_EQ(run->revision(), unknown) << "and nothing new";
    ASSERT_EQ(world.looked_at.size(), looks + 4);
    for (const auto* row : world.looked_at)
        EXPECT_EQ(row, point_named("position"));
    pass(seconds(1));
    EXPECT_EQ(run->text(), "a position at_least 5 did not come true within 1 s: it is not known");
}

TEST_F(Runs, AWaitThatDoesNotComeTrueSaysWhatItIs) {
    start(R"({"steps":[{"wait_for":{"axis":"a","point":"state","is":"operation_enabled","timeout_s":1}}]})");
    world.points["a.state"] = "fault";
    for (int i = 0; i < 60 && !run->ended(); ++i)
        pass(RecipeRun::look_period);
    EXPECT_EQ(run->state(), RecipeRun::State::failed);
    EXPECT_EQ(run->text(), "a state is operation_enabled did not come true within 1 s: it is fault");
    EXPECT_EQ(run->ended_at() - run->started(), seconds(1));
}

TEST_F(Runs, AParameterIsReadForItsCondition) {
    start(R"({"steps":[{"wait_for":{"axis":"a","parameter":"QE","is":7,"timeout_s":1}}]})");
    EXPECT_EQ(requests[0].what, RecipeRequest::What::read_parameter);
    answer(true, "", std::int64_t{6});
    EXPECT_EQ(run->deadline(), now + RecipeRun::read_period);
    pass(RecipeRun::read_period);
    answer(false, "no answer");
    pass(RecipeRun::read_period);
    answer(true, "", 7.0);
    EXPECT_EQ(run->state(), RecipeRun::State::done);
}

TEST_F(Runs, IfTakesOneSideAndRepeatIsBounded) {
    world.points["a.referenced"] = false;
    start(
        R"({"steps":[{"if":{"condition":{"axis":"a","point":"referenced","is":true},"then":[{"message":"x"}],"else":[{"repeat":{"times":3,"steps":[{"message":"y"}]}}]}}]})");
    for (int i = 0; i < 3; ++i)
        answer();
    EXPECT_EQ(run->state(), RecipeRun::State::done);
    EXPECT_EQ(run->rows()[1].state, RecipeRow::State::not_run);
    EXPECT_EQ(run->rows()[3].times, 3u);
    EXPECT_EQ(run->rows()[0].text, "else");
    for (const auto r : {0u, 2u, 3u})
        EXPECT_EQ(run->rows()[r].state, RecipeRow::State::done) << r;
}

TEST_F(Runs, RepeatUntilEndsOrFails) {
    constexpr auto document =
        R"({"steps":[{"repeat":{"times":2,"until":{"axis":"a","point":"target_reached","is":true},"steps":[{"message":"y"}]}}]})";
    world.points["a.target_reached"] = true;
    start(document);
    answer();
    EXPECT_EQ(run->state(), RecipeRun::State::done);
    EXPECT_EQ(run->rows()[1].times, 1u);
    world.points["a.target_reached"] = false;
    start(document);
    answer();
    answer();
    EXPECT_EQ(run->state(), RecipeRun::State::failed);
    EXPECT_EQ(run->text(), "a target_reached is true did not come true in 2 rounds: it is false");
}

TEST_F(Runs, AnUnknownValueIsNoAnswerToAnIf) {
    start(R"({"steps":[{"if":{"condition":{"axis":"a","point":"moving","is":false},"then":[{"enable":{"axis":"a"}}]}}]})");
    EXPECT_EQ(run->state(), RecipeRun::State::failed);
    EXPECT_TRUE(requests.empty());
}

TEST_F(Runs, TheWholeRunHasALimit) {
    start(R"({"timeout_s":5,"steps":[{"wait_s":100}]})");
    EXPECT_EQ(run->deadline(), now + seconds(5));
    pass(seconds(5));
    EXPECT_EQ(run->state(), RecipeRun::State::failed);
    EXPECT_EQ(run->text(), "the run took longer than its timeout_s of 5 s");
}

TEST_F(Runs, ManyRoundsGiveTheOthersTheirTurn) {
    start(R"({"steps":[{"repeat":{"times":10000,"steps":[{"repeat":{"times":10000,"steps":[{"wait_s":0}]}}]}}]})");
    EXPECT_EQ(run->state(), RecipeRun::State::running);
    EXPECT_EQ(run->deadline(), now + milliseconds(1));
    EXPECT_LE(run->rows()[2].times, RecipeRun::steps_per_turn);
}

TEST_F(Runs, ARefusedStepFailsWithTheDrivesWords) {
    start(R"({"steps":[{"set_parameter":{"axis":"a","parameter":"AC","value":1}}]})");
    answer(false, "data error (drive_refused, the drive's code 51)");
    EXPECT_EQ(run->state(), RecipeRun::State::failed);
    EXPECT_EQ(run->text(), "data error (drive_refused, the drive's code 51)");
    EXPECT_EQ(run->rows()[0].text, run->text());
}
}  // namespace
}  // namespace axisgate
