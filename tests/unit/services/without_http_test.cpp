// Services used without the HTTP door: snapshots, tables of parameters, changes of the site, descriptions, recipes.
#include <gtest/gtest.h>
#include <boost/json/parse.hpp>

#include "gateway/doors/dds/words.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/services/descriptions/description_files.hpp"
#include "gateway/services/parameters/parameter_table.hpp"
#include "gateway/services/parameters/snapshots.hpp"
#include "gateway/services/recipes/recipe_documents.hpp"
#include "gateway/services/site/site_change.hpp"
#include "gateway/services/site/site_edit.hpp"
#include "gateway/services/site/site_staging.hpp"
#include "tests/unit/http/fake_gateway.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;
using http::test::FakeGateway;
using Why = ServiceRefusal::Why;

class OtherDoor : public ::testing::Test {
protected:
    FakeGateway gateway;
    std::shared_ptr<AxisJobs> jobs = std::make_shared<AxisJobs>();
    std::shared_ptr<ChangeQueue> changes = std::make_shared<ChangeQueue>();
    const Origin anna{dds::clients, std::make_shared<const std::string>("anna"), std::make_shared<const std::string>("anna panel")};

    Snapshots snapshots() { return {gateway.ports(), jobs}; }
    void drive_answers(std::int64_t value) {
        gateway.at_once = [value](const Command& c) {
            Result r;
            r.outcome = Outcome::accepted;
            const auto* w = std::get_if<WriteParameter>(&c.body);
            r.value = w ? w->value : Value{value};
            return r;
        };
    }
    KeptSnapshot taken(std::string name) {
        std::optional<TakenSnapshot> out;
        snapshots().take("feeder", {std::move(name), "", false}, anna, [&](Refusable<TakenSnapshot> answer) {
            if (auto* s = std::get_if<TakenSnapshot>(&answer)) out = std::move(*s);
        });
        EXPECT_TRUE(out);
        return out ? KeptSnapshot(*out) : KeptSnapshot{};
    }
};

TEST_F(OtherDoor, ASnapshotIsTakenComparedAndRestored) {
    drive_answers(16);
    const auto kept = taken("first");
    EXPECT_EQ(kept.snapshot.n, 1u);
    EXPECT_EQ(kept.snapshot.who, "anna");
    ASSERT_EQ(gateway.noted.size(), 1u);
    EXPECT_EQ(gateway.noted[0].door, "dds") << "the event names the door that it came by";
    for (const auto& c : gateway.submitted)
        EXPECT_EQ(c.origin.door, dds::clients);

    drive_answers(17);
    std::optional<SnapshotDifference> difference;
    snapshots().compare("feeder", "1", "device", anna, [&](Refusable<SnapshotDifference> answer) {
        if (auto* d = std::get_if<SnapshotDifference>(&answer)) difference = std::move(*d);
    });
    ASSERT_TRUE(difference);
    ASSERT_EQ(difference->rows.size(), kept.snapshot.parameters.size());
    EXPECT_FALSE(equal_values(difference->rows.front().snapshot, difference->rows.front().other));
    EXPECT_EQ(difference->not_known, 0u);

    RestoreWish wish;
    wish.parameters = {{"AC"}};
    auto plan = snapshots().plan_restore(kept, wish);
    ASSERT_TRUE(std::holds_alternative<ParameterPlan>(plan));
    ASSERT_EQ(std::get<ParameterPlan>(plan).changes.size(), 1u);
    std::optional<WrittenParameters> written;
    snapshots().restore(kept, std::get<ParameterPlan>(std::move(plan)), anna, [&](Refusable<WrittenParameters> answer) {
        if (auto* w = std::get_if<WrittenParameters>(&answer)) written = std::move(*w);
    });
    ASSERT_TRUE(written);
    ASSERT_EQ(written->changed.size(), 1u);
    EXPECT_EQ(written->changed[0].parameter, "AC");
    EXPECT_EQ(written->changed[0].value, Value{std::int64_t{16}});
}

TEST_F(OtherDoor, WhatASnapshotIsRefusedForIsAValue) {
    const auto none = snapshots().find("feeder", "7");
    ASSERT_TRUE(std::holds_alternative<ServiceRefusal>(none));
    EXPECT_EQ(std::get<ServiceRefusal>(none).why, Why::not_found);
    EXPECT_EQ(std::get<ServiceRefusal>(none).text, "there is no snapshot 7");
    gateway.at_once = [](const Command&) {
        Result r;
        r.outcome = Outcome::failed;
        r.reason = Reason::no_answer;
        r.text = "silence";
        return r;
    };
    std::optional<ServiceRefusal> refusal;
    snapshots().take("feeder", {"x", "", false}, anna, [&](Refusable<TakenSnapshot> answer) {
        if (auto* r = std::get_if<ServiceRefusal>(&answer)) refusal = std::move(*r);
    });
    ASSERT_TRUE(refusal);
    EXPECT_EQ(refusal->why, Why::no_answer);
    EXPECT_EQ(refusal->axis, "feeder");
    EXPECT_TRUE(gateway.kept_snapshots["feeder"].empty()) << "no half of a snapshot is kept";
}

TEST_F(OtherDoor, ATableWithAFaultyLinePlansNothing) {
    const auto axis = find_axis(gateway, "feeder");
    ASSERT_TRUE(axis);
    const auto good = plan_of_csv("parameter,value\nAC,100\n", gateway, *axis, {});
    ASSERT_TRUE(std::holds_alternative<ParameterPlan>(good));
    ASSERT_EQ(std::get<ParameterPlan>(good).points.size(), 1u);
    const auto bad = plan_of_csv("parameter,value\nAC,100\nAC,200\nnone,1\n", gateway, *axis, {});
    ASSERT_TRUE(std::holds_alternative<ServiceRefusal>(bad));
    const auto& refusal = std::get<ServiceRefusal>(bad);
    EXPECT_EQ(refusal.why, Why::invalid);
    ASSERT_EQ(refusal.faults.size(), 2u);
    EXPECT_EQ(refusal.faults[0].pointer, "/3");
    EXPECT_EQ(refusal.faults[1].pointer, "/4");
}

TEST_F(OtherDoor, ASiteIsChangedForTheRevisionThatIsMeantAlone) {
    const auto renamed = [&](std::optional<std::uint64_t> only_for) {
        std::string end;
        SiteChange change{.origin = anna, .only_for = only_for};
        change.plan = [&](const SiteState& before) -> Refusable<SitePlan> {
            auto edited = patch_entry(to_json(before.site), Collection::lines, "can0", {{"name", "bus"}});
            if (auto* refusal = std::get_if<ServiceRefusal>(&edited)) return std::move(*refusal);
            auto site = checked_site(std::get<Edit>(edited).document, gateway.families(), std::get<Edit>(edited).pointer);
            if (auto* refusal = std::get_if<ServiceRefusal>(&site)) return std::move(*refusal);
            return SitePlan{std::get<Site>(std::move(site)), [&](const std::shared_ptr<const SiteState>&) { end = "in force"; }};
        };
        change.refused = [&](const ServiceRefusal& refusal) {
            end = refusal.text;
            if (refusal.why == Why::overtaken) end = "overtaken by " + std::to_string(refusal.revision);
        };
        change_site(*changes, gateway, gateway, std::move(change), nullptr);
        return end;
    };
    const auto revision = gateway.site()->revision;
    EXPECT_EQ(renamed(revision + 5), "overtaken by " + std::to_string(revision));
    EXPECT_EQ(renamed(revision), "in force");
    EXPECT_TRUE(gateway.site()->site.line("bus"));
    EXPECT_EQ(renamed(std::nullopt), "there is no line can0");
}

TEST_F(OtherDoor, AnotherClientsStageIsNotReplacedInSilence) {
    const SiteStaging staging(gateway.ports(), std::make_shared<StageOwner>());
    const auto document = to_json(gateway.site()->site);
    ASSERT_FALSE(staging.stage(document, anna));
    EXPECT_FALSE(staging.refuse_taken(anna));
    const Origin other{http::clients, std::make_shared<const std::string>("bert"), std::make_shared<const std::string>("bert")};
    const auto refusal = staging.refuse_taken(other);
    ASSERT_TRUE(refusal);
    EXPECT_EQ(refusal->why, Why::stage_taken);
    EXPECT_EQ(refusal->more.at("stage"), staging.document().at("id"));
}

TEST_F(OtherDoor, AFaultyDescriptionIsNotKept) {
    const DescriptionFiles files(gateway.ports(), changes);
    std::optional<ServiceRefusal> refusal;
    files.add(
        {"x.eds", "[no eds"}, anna,
        [&](Refusable<DescriptionFiles::Added> answer) {
            if (auto* r = std::get_if<ServiceRefusal>(&answer)) refusal = std::move(*r);
        },
        nullptr);
    ASSERT_TRUE(refusal);
    EXPECT_EQ(refusal->why, Why::invalid);
    EXPECT_FALSE(refusal->faults.empty());
    EXPECT_TRUE(files.list().empty());
}

TEST_F(OtherDoor, ARecipeIsKeptForTheStateThatIsMeantAlone) {
    const auto service = std::make_shared<RecipeService>(gateway, [] { return time_zero; });
    const RecipeDocuments recipes(gateway.ports(), service);
    const auto document = json::parse(R"({"steps":[{"wait_s":1}]})").get_object();
    const auto put = [&](MeantState meant) {
        std::string end;
        recipes.put(
            "r", document, std::move(meant), anna,
            [&](Refusable<RecipeDocuments::Put> answer) {
                const auto* refusal = std::get_if<ServiceRefusal>(&answer);
                end = refusal ? "refused " + refusal->tag : std::get<RecipeDocuments::Put>(answer).created ? "made" : "changed";
            },
            nullptr);
        return end;
    };
    EXPECT_EQ(put({}), "made");
    const auto kept = recipes.find("r");
    ASSERT_TRUE(std::holds_alternative<KeptRecipe>(kept));
    const auto tag = std::get<KeptRecipe>(kept).tag();
    const auto same = [](std::string_view text, std::string_view now, bool) noexcept { return text == now; };
    EXPECT_EQ(put({"\"another\"", "", same}), "refused " + tag);
    EXPECT_EQ(put({tag, "", same}), "changed");
    EXPECT_EQ(gateway.noted.back().door, "dds");
}

}  // namespace
}  // namespace axisgate
