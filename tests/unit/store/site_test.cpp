// The site document: revisions, history, and names that change together with it; twins' memory and documents.
#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Site, NoneAtFirstThenTheNewest) {
    const TempDir dir;
    {
        const auto store = open_store(dir);
        EXPECT_FALSE(must(store->load_site()));
        EXPECT_EQ(must(store->save_site("{\"a\":1}", "http admin", 10)), 1u);
        EXPECT_EQ(must(store->save_site("{\"ä\":2}", "file", 20)), 2u);
    }
    const auto store = open_store(dir);
    const auto site = must(store->load_site());
    ASSERT_TRUE(site);
    EXPECT_EQ(site->revision, 2u);
    EXPECT_EQ(site->text, "{\"ä\":2}");
    EXPECT_EQ(site->bytes, site->text.size());
    EXPECT_EQ(site->who, "file");
    EXPECT_EQ(site->at_unix_ns, 20);
    EXPECT_EQ(must(store->site(1))->text, "{\"a\":1}");
    EXPECT_FALSE(must(store->site(3)));
}

TEST(Site, TheSameTextIsNoNewRevision) {
    const TempDir dir;
    const auto store = open_store(dir);
    must(store->save_site("a", "x", 1));
    must(store->save_site("b", "x", 2));
    EXPECT_EQ(must(store->save_site("b", "y", 3)), 2u);
    EXPECT_EQ(must(store->save_site("a", "y", 4)), 3u);  // going back is a change
    EXPECT_EQ(must(store->site_history()).size(), 3u);
}

TEST(Site, TheNewestAreKeptAndNumbersGoOn) {
    EXPECT_EQ(StoreLimits{}.site_revisions, 1000u);
    const TempDir dir;
    auto options = options_for(dir.path());
    options.limits.site_revisions = 50;
    {
        const auto store = open_store(options);
        for (int i = 1; i <= 60; ++i)
            EXPECT_EQ(must(store->save_site("site " + std::to_string(i), "x", i)), static_cast<std::uint64_t>(i));
        const auto history = must(store->site_history());
        ASSERT_EQ(history.size(), 50u);
        EXPECT_EQ(history.front().revision, 60u);
        EXPECT_EQ(history.back().revision, 11u);
        EXPECT_EQ(history.back().bytes, 7u);
        EXPECT_TRUE(history.back().text.empty());
        EXPECT_FALSE(must(store->site(10)));
        EXPECT_EQ(must(store->site(11))->text, "site 11");
        const auto page = must(store->site_history(3, 20));
        ASSERT_EQ(page.size(), 3u);
        EXPECT_EQ(page.front().revision, 19u);
        EXPECT_EQ(must(store->site_history(1000, 12)).size(), 1u);
        EXPECT_TRUE(must(store->site_history(10, 11)).empty());
    }
    EXPECT_EQ(must(open_store(options)->save_site("next", "x", 61)), 61u);
}

TEST(Site, TheHistoryIsBoundedByTheLengthOfItsDocumentsToo) {
    const TempDir dir;
    auto options = options_for(dir.path());
    options.limits.site_bytes = 1000;
    const auto store = open_store(options);
    for (int i = 1; i <= 9; ++i)
        must(store->save_site(std::to_string(i) + std::string(299, 'x'), "x", i));
    EXPECT_EQ(must(store->site_history()).size(), 3u);
    must(store->save_site(std::string(5000, 'y'), "x", 10));  // the one in force stays, whatever its length
    const auto history = must(store->site_history());
    ASSERT_EQ(history.size(), 1u);
    EXPECT_EQ(history[0].bytes, 5000u);
    EXPECT_EQ(must(store->load_site())->revision, 10u);
}

TEST(Site, SizeIsBounded) {
    const TempDir dir;
    const auto store = open_store(dir);
    EXPECT_EQ(refused(store->save_site("", "x", 1)).kind, Kind::invalid);
    EXPECT_EQ(refused(store->save_site(std::string(max_site_bytes + 1, ' '), "x", 1)).kind, Kind::invalid);
    EXPECT_EQ(must(store->save_site(std::string(max_site_bytes, ' '), "x", 1)), 1u);
}

class SiteNames : public testing::Test {
protected:
    SiteNames() : store_(open_store(dir_)) {
        must(store_->commit(std::vector{a_write("a", "P", std::string("of a")), a_write("b", "P", std::string("of b")),
                                        a_write("c", "P", std::string("of c"))}));
        for (const char* drive : {"da", "db", "dc"})
            must(store_->save_twin(drive, {{"V", Value{std::string("of ") + drive}}}));
    }
    std::string stored(const std::string& axis) {
        const auto r = must(store_->stored(axis, "P"));
        return r ? to_text(r->value) : "-";
    }
    std::string twin(const std::string& drive) {
        const auto m = must(store_->load_twin(drive));
        return m.empty() ? "-" : to_text(m.at("V"));
    }
    TempDir dir_;
    std::unique_ptr<Store> store_;
};

TEST_F(SiteNames, CanBeExchanged) {
    SiteChange change;
    change.renamed_axes = {{"a", "b"}, {"b", "c"}, {"c", "a"}};
    change.renamed_drives = {{"da", "db"}, {"db", "da"}};
    must(store_->save_site("{}", "x", 1, change));
    EXPECT_THAT((std::vector{stored("a"), stored("b"), stored("c")}), ElementsAre("of c", "of a", "of b"));
    EXPECT_THAT((std::vector{twin("da"), twin("db"), twin("dc")}), ElementsAre("of db", "of da", "of dc"));
}

TEST_F(SiteNames, WhatTheNewSiteDoesNotNameIsRemoved) {
    SiteChange change;
    change.renamed_axes = {{"a", "b"}};  // the old b is gone: its name was taken
    change.axes = std::vector<SiteAxis>{{"b", "demo"}, {"new", "demo"}};
    change.renamed_drives = {{"da", "db"}};
    change.drives = {{"db", "new"}};
    must(store_->save_site("{}", "x", 77, change));
    EXPECT_THAT((std::vector{stored("a"), stored("b"), stored("c")}), ElementsAre("-", "of a", "-"));
    EXPECT_THAT((std::vector{twin("da"), twin("db"), twin("dc")}), ElementsAre("-", "of da", "-"));
    EXPECT_EQ(must(store_->history("b", "P", 10)).size(), 1u);
    EXPECT_EQ(must(store_->history("c", "P", 10)).size(), 1u);  // removed, not forgotten
    EXPECT_EQ(must(store_->axes()).size(), 4u);
}

TEST_F(SiteNames, WhatIsStoredHoldsForOneFamily) {
    const auto site = [&](const std::string& text, std::vector<SiteAxis> axes) {
        SiteChange change;
        change.axes = std::move(axes);
        must(store_->save_site(text, "x", 1, change));
    };
    const auto snapshot = [&](const char* name) { must(store_->save_snapshot("a", name, "", "", 1, {})); };
    snapshot("before families were told");
    site("1", {{"a", "uim342"}, {"b", "uim342"}});
    EXPECT_EQ(stored("a"), "of a") << "rows from before are of the family that the axis is first seen with";
    snapshot("of a uim342");
    site("2", {{"a", "mcode"}, {"b", "uim342"}});
    EXPECT_EQ(stored("a"), "-");
    EXPECT_TRUE(must(store_->history("a", "", 10)).empty());
    must(commit_one(*store_, a_write("a", "P", std::string("of mcode"))));
    snapshot("of a mcode");
    const auto list = must(store_->snapshots("a"));
    ASSERT_EQ(list.size(), 3u);
    EXPECT_EQ((std::vector{list[0].family, list[1].family, list[2].family}), (std::vector<std::string>{"", "uim342", "mcode"}));
    EXPECT_EQ(must(store_->snapshot("a", 2))->family, "uim342");
    site("3", {{"a", "uim342"}, {"b", "uim342"}});
    EXPECT_EQ(stored("a"), "of a") << "the write of the same word by another family has not touched it";
    EXPECT_EQ(must(store_->history("a", "", 10)).size(), 1u);
    must(store_->check());
}

TEST_F(SiteNames, ARemovedAxisComesBackWithWhatWasStoredUnlessItIsOfAnotherFamily) {
    const auto site = [&](const std::string& text, std::vector<SiteAxis> axes, std::vector<std::string> kept = {}) {
        SiteChange change;
        change.axes = std::move(axes);
        change.kept_axes = std::move(kept);
        must(store_->save_site(text, "x", 1, change));
    };
    site("1", {{"a", "uim342"}, {"b", "uim342"}, {"c", "uim342"}});
    site("2", {{"a", "uim342"}}, {"b"});
    EXPECT_EQ(stored("b"), "of b") << "kept: not removed yet";
    EXPECT_EQ(stored("c"), "-");
    site("3", {{"a", "uim342"}});
    EXPECT_EQ(stored("b"), "-");
    site("4", {{"a", "uim342"}, {"b", "uim342"}, {"c", "mcode"}});
    EXPECT_EQ(stored("b"), "of b");
    EXPECT_EQ(stored("c"), "-");
    site("5", {{"a", "uim342"}, {"c", "uim342"}});
    EXPECT_EQ(stored("c"), "of c");
}

TEST_F(SiteNames, WhatSteppedAsideForARenamedAxisComesBackWhenItsNameIsFree) {
    SiteChange change;
    change.axes = std::vector<SiteAxis>{{"a", "demo"}, {"c", "demo"}};
    must(store_->save_site("1", "x", 1, change));  // b is removed
    change.renamed_axes = {{"a", "b"}};
    change.axes = std::vector<SiteAxis>{{"b", "demo"}, {"c", "demo"}};
    must(store_->save_site("2", "x", 2, change));
    EXPECT_EQ(stored("b"), "of a");
    change.renamed_axes = {{"b", "a"}};
    change.axes = std::vector<SiteAxis>{{"a", "demo"}, {"b", "demo"}, {"c", "demo"}};
    must(store_->save_site("3", "x", 3, change));
    EXPECT_THAT((std::vector{stored("a"), stored("b"), stored("c")}), ElementsAre("of a", "of b", "of c"));
}

TEST(SiteAxes, RemovedOnesAreBounded) {
    const TempDir dir;
    auto options = options_for(dir.path());
    options.limits.removed_axes = 2;
    const auto store = open_store(options);
    for (const char* name : {"a", "b", "c"}) {
        must(commit_one(*store, a_write(name, "P", std::int64_t{1})));
        must(store->save_snapshot(name, "", "", "", 1, std::vector<SnapshotValue>{{"P", Value{true}}}));
        SiteChange change;
        change.axes.emplace();
        must(store->save_site(name, "x", 1, change));
    }
    EXPECT_EQ(must(store->axes()).size(), 2u);
    EXPECT_TRUE(must(store->snapshots("a")).empty());
    EXPECT_EQ(must(store->snapshots("c")).size(), 1u);
    must(store->check());
}

TEST_F(SiteNames, AnAxisThatWasNeverWrittenDoesNotInheritByItsNewName) {
    must(store_->remove_axis("b", 5));
    SiteChange change;
    change.renamed_axes = {{"never written", "b"}};
    must(store_->save_site("{}", "x", 6, change));
    EXPECT_TRUE(must(store_->history("b", "", 10)).empty());
}

TEST_F(SiteNames, WithoutListsNothingIsRemoved) {
    must(store_->save_site("{}", "x", 1));
    EXPECT_EQ(stored("a"), "of a");
    EXPECT_EQ(twin("dc"), "of dc");
}

TEST_F(SiteNames, AnEmptySiteRemovesEverythingStored) {
    SiteChange change;
    change.axes.emplace();
    change.drives.emplace();
    must(store_->save_site("{}", "x", 1, change));
    EXPECT_EQ(stored("a") + stored("b") + stored("c") + twin("da"), "----");
}

TEST_F(SiteNames, AWrongChangeRefusesTheSiteWhole) {
    SiteChange twice;
    twice.renamed_axes = {{"a", "x"}, {"b", "x"}};
    EXPECT_EQ(refused(store_->save_site("{}", "x", 1, twice)).kind, Kind::invalid);
    SiteChange empty;
    empty.renamed_drives = {{"da", ""}};
    EXPECT_THAT(refused(store_->save_site("{}", "x", 1, empty)).text, HasSubstr("the site is not stored"));
    EXPECT_FALSE(must(store_->load_site()));
    EXPECT_EQ(stored("a"), "of a");
}

// --- twins ---------------------------------------------------------------------------------------------------------------------

TEST(TwinMemory, EmptyIsFactoryStateAndDifferencesAloneAreWritten) {
    const TempDir dir;
    NonVolatile memory{{"AC", Value{std::int64_t{5}}}, {"name", Value{std::string("x")}}, {"ratio", Value{0.5}}};
    {
        const auto store = open_store(dir);
        EXPECT_TRUE(must(store->load_twin("feeder")).empty());
        must(store->save_twin("feeder", memory));
        EXPECT_EQ(must(store->load_twin("feeder")), memory);
        const auto log = std::filesystem::file_size(dir / "axisgate.db-wal");
        for (int i = 0; i < 50; ++i)
            must(store->save_twin("feeder", memory));
        EXPECT_EQ(std::filesystem::file_size(dir / "axisgate.db-wal"), log);  // the same again costs no write
        memory.erase("name");
        memory["AC"] = 5.0;  // another kind
        memory["DC"] = true;
        must(store->save_twin("feeder", memory));
        must(store->save_twin("slide", {{"AC", Value{std::int64_t{1}}}}));
    }
    const auto store = open_store(dir);
    EXPECT_EQ(must(store->load_twin("feeder")), memory);
    EXPECT_TRUE(std::holds_alternative<double>(must(store->load_twin("feeder")).at("AC")));
    must(store->remove_drive("feeder"));
    EXPECT_TRUE(must(store->load_twin("feeder")).empty());
    EXPECT_EQ(must(store->load_twin("slide")).size(), 1u);
    must(store->save_twin("slide", {}));
    EXPECT_TRUE(must(store->load_twin("slide")).empty());
    EXPECT_EQ(refused(store->save_twin("", memory)).kind, Kind::invalid);
    EXPECT_EQ(refused(store->save_twin("x", {{"", Value{true}}})).kind, Kind::invalid);
    EXPECT_EQ(refused(store->save_twin("x", {{"P", Value{std::string(max_value_bytes + 1, 'x')}}})).kind, Kind::invalid);
}

// --- documents -----------------------------------------------------------------------------------------------------------------

TEST(Documents, AreReplacedListedAndDeleted) {
    const TempDir dir;
    const auto store = open_store(dir);
    must(store->save_document({"recipe", "b", "1", "me", 1}));
    must(store->save_document({"recipe", "a", "2", "me", 2}));
    must(store->save_document({"token", "a", "3", "me", 3}));
    must(store->save_document({"recipe", "b", "4", "you", 4}));
    const auto recipes = must(store->documents("recipe"));
    ASSERT_EQ(recipes.size(), 2u);
    EXPECT_EQ(recipes[0].name, "a");
    EXPECT_EQ(recipes[1].text, "4");
    EXPECT_EQ(recipes[1].who, "you");
    EXPECT_EQ(must(store->document("token", "a"))->text, "3");
    EXPECT_FALSE(must(store->document("token", "b")));
    must(store->delete_document("recipe", "b"));
    EXPECT_EQ(refused(store->delete_document("recipe", "b")).kind, Kind::not_found);
    EXPECT_EQ(refused(store->save_document({"", "b", "4", "you", 4})).kind, Kind::invalid);
    EXPECT_EQ(refused(store->save_document({"recipe", "b", std::string(max_document_bytes + 1, 'x'), "you", 4})).kind, Kind::invalid);
}

// --- descriptions of drives ----------------------------------------------------------------------------------------------------

TEST(Descriptions, AreKeptListedAndDeletedAndNeverOverwritten) {
    const TempDir dir;
    {
        const auto store = open_store(dir);
        must(store->save_description({"b.eds", "[FileInfo]\r\nb\xE4\n", "me", 1}));
        must(store->save_description({"a.dcf", "a", "you", 2}));
        EXPECT_EQ(refused(store->save_description({"a.dcf", "another", "you", 3})).kind, Kind::conflict);
        EXPECT_EQ(refused(store->save_description({"", "x", "you", 3})).kind, Kind::invalid);
        EXPECT_EQ(refused(store->save_description({"c", std::string(max_description_bytes + 1, 'x'), "you", 4})).kind, Kind::invalid);
    }
    const auto store = open_store(dir);
    const auto list = must(store->descriptions());
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].name, "a.dcf");
    EXPECT_EQ(list[0].text, "a");
    EXPECT_EQ(list[1].text, "[FileInfo]\r\nb\xE4\n") << "byte by byte";
    EXPECT_EQ(list[1].who, "me");
    must(store->delete_description("a.dcf"));
    EXPECT_EQ(refused(store->delete_description("a.dcf")).kind, Kind::not_found);
    for (std::size_t i = 1; i < max_descriptions; ++i)
        must(store->save_description({"d" + std::to_string(i), "x", "me", 5}));
    EXPECT_EQ(refused(store->save_description({"one more", "x", "me", 6})).kind, Kind::conflict);
}

}  // namespace
}  // namespace axisgate::test
