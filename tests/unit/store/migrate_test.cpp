// Migrations: order, upgrades with a copy before, steps that fail, files that are newer.
#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {
using testing::HasSubstr;

TEST(Migrations, AreFoundAmongTheAssetsInOrderOfNumber) {
    const Asset assets[] = {
        {"schema/sql/0002_two.sql", "b"}, {"web/dist/index.html", "x"}, {"schema/sql/0001_one.sql", "a"}, {"schema/sql/README.md", "x"}};
    const auto m = must(migrations_among(assets));
    ASSERT_EQ(m.size(), 2u);
    EXPECT_EQ(m[0].number, 1);
    EXPECT_EQ(m[0].sql, "a");
    EXPECT_EQ(m[1].name, "0002_two.sql");
}

TEST(Migrations, WrongNumbersAreAFaultOfTheProgram) {
    const std::vector<std::vector<Asset>> wrong = {{},
                                                   {{"schema/sql/0002_two.sql", ""}},
                                                   {{"schema/sql/0001_a.sql", ""}, {"schema/sql/0001_b.sql", ""}},
                                                   {{"schema/sql/0001_a.sql", ""}, {"schema/sql/0003_c.sql", ""}},
                                                   {{"schema/sql/base.sql", ""}},
                                                   {{"schema/sql/0001.sql", ""}}};
    for (const auto& assets : wrong)
        EXPECT_EQ(refused(migrations_among(assets)).kind, Kind::internal);
}

TEST(Migrations, FromTheFirstFormNothingIsLost) {
    const TempDir dir;
    auto first = options_for(dir.path());
    first.migrations.resize(1);
    { const auto store = open_store(first); }
    meddle(dir / "axisgate.db",
           "INSERT INTO axis (id, name, last_snapshot) VALUES (3, 'feeder', 4);"
           "INSERT INTO parameter_write VALUES (7, 3, 'AC', 'i', 5, 'u', NULL, 'ram', 'http', 'me', 9);"
           "INSERT INTO parameter_stored VALUES (3, 'AC', 'i', 5, 'u', NULL, 'ram', 'http', 'me', 9);"
           "INSERT INTO snapshot VALUES (3, 4, 'good', '', 'me', 8); INSERT INTO snapshot_value VALUES (3, 4, 'AC', 'i', 5);"
           "INSERT INTO site_revision VALUES (11, 1, 'me', 'one'), (12, 2, 'me', 'z\xC3\xBC')");
    const auto store = open_store(dir);
    ASSERT_NE(store, nullptr);
    must(store->check());
    EXPECT_EQ(must(store->stored("feeder", "AC"))->value, Value{std::int64_t{5}});
    EXPECT_EQ(must(store->history("feeder", "AC", 9)).at(0).id, 7u);
    EXPECT_EQ(must(store->snapshot("feeder", 4))->parameters.at(0).value, Value{std::int64_t{5}});
    EXPECT_EQ(must(store->snapshot("feeder", 4))->family, "");
    const auto history = must(store->site_history());
    ASSERT_EQ(history.size(), 2u);
    EXPECT_EQ(history[0].bytes, 3u);
    EXPECT_EQ(must(store->load_site())->text, "z\xC3\xBC");
    EXPECT_EQ(must(store->save_site("next", "me", 3)), 13u) << "numbers go on";
}

/// A file as each program since the first has left it: with rows in every table that it had then.
TEST(Migrations, EveryFormThatWasReleasedOpensWithAllItsRows) {
    const std::size_t newest = program_migrations().size();
    ASSERT_EQ(newest, 4u) << "a new step: give the file of the form before it rows of its own below";
    for (std::size_t form = 1; form <= newest; ++form) {
        SCOPED_TRACE(form);
        const TempDir dir;
        auto then = options_for(dir.path());
        then.migrations.resize(form);
        { const auto store = open_store(then); }
        const bool families = form >= 2;  // since then a row tells of which family it is
        const std::string site = R"({"lines":[{"name":"c","uri":"twin","family":"uim342"}],"drives":[],"axes":[],"mappings":[]})";
        meddle(
            dir / "axisgate.db",
            "INSERT INTO axis (id, name, last_snapshot) VALUES (3, 'feeder', 4);"
            "INSERT INTO parameter_write (id, axis_id, parameter, value_type, value, old_type, old_value, storage, door, who, at_unix_ns)"
            " VALUES (7, 3, 'AC', 'i', 5, 'f', 1.5, 'ram', 'http', 'me', 9);"
            "INSERT INTO parameter_stored (axis_id, " +
                std::string(families ? "family, " : "") +
                "parameter, value_type, value, old_type, old_value, storage, door, who, at_unix_ns) VALUES (3, " +
                (families ? "'', " : "") +
                "'AC', 'i', 5, 'f', 1.5, 'ram', 'http', 'me', 9);"
                "INSERT INTO snapshot (axis_id, n, name, comment, who, at_unix_ns) VALUES (3, 4, 'good', '', 'me', 8);"
                "INSERT INTO snapshot_value VALUES (3, 4, 'AC', 'i', 5);"
                "INSERT INTO twin_memory VALUES ('feeder', 'node', 'i', 9);"
                "INSERT INTO event (at_unix_ns, severity, kind, axis, drive, line, code, text, who, door, parameter, old_value, new_value)"
                " VALUES (5, 2, 'fault', 'feeder', '', '', 0, 'it was hot', '', '', '', '', '');"
                "INSERT INTO document VALUES ('recipe', 'warm-up', '{}', 'me', 3);"
                "INSERT INTO document VALUES ('" +
                (form < 3 ? "recipe_run', 'warm-up/0000000001" : "recipe_run warm-up', '0000000001") +
                "', '{}', 'me', 4);"
                "INSERT INTO site_revision (id, at_unix_ns, " +
                (families ? "bytes, " : "") + "who, text) VALUES (12, 2, " + (families ? std::to_string(site.size()) + ", " : "") +
                "'me', '" + site + "')" + (form < 4 ? "" : ";INSERT INTO description VALUES ('a.eds', '[FileInfo]', 'me', 5)"));
        const auto store = open_store(dir);
        ASSERT_NE(store, nullptr);
        must(store->check());
        EXPECT_EQ(must(store->facts()).version, static_cast<int>(newest));
        const auto descriptions = must(store->descriptions());
        ASSERT_EQ(descriptions.size(), form < 4 ? 0u : 1u);
        if (form >= 4) EXPECT_EQ(descriptions[0].text, "[FileInfo]");
        EXPECT_EQ(std::filesystem::exists(dir / ("axisgate.db.before-" + std::to_string(newest))), form < newest) << "a copy from before";
        EXPECT_EQ(must(store->load_site())->text, site);
        EXPECT_EQ(must(store->stored("feeder", "AC"))->value, Value{std::int64_t{5}});
        EXPECT_EQ(must(store->stored("feeder", "AC"))->previous, Value{1.5});
        EXPECT_EQ(must(store->history("feeder", "AC", 9)).at(0).id, 7u);
        EXPECT_EQ(must(store->snapshot("feeder", 4))->parameters.at(0).value, Value{std::int64_t{5}});
        must(commit_one(*store, a_write("feeder", "AC", std::int64_t{7})));
        EXPECT_EQ(must(store->stored("feeder", "AC"))->value, Value{std::int64_t{7}}) << "and it goes on";
        const auto file = must(Db::open(dir / "axisgate.db", Db::Mode::read_only));
        EXPECT_EQ(must(file->integer("SELECT value FROM twin_memory WHERE drive = 'feeder'")), 9);
        EXPECT_EQ(must(file->text("SELECT text FROM event WHERE kind = 'fault'")), "it was hot");
        EXPECT_EQ(must(file->text("SELECT text FROM document WHERE name = 'warm-up'")), "{}");
        EXPECT_EQ(must(file->text("SELECT name FROM document WHERE kind = 'recipe_run warm-up'")), "0000000001");
    }
}

class Upgrade : public testing::Test {
protected:
    Upgrade() {
        const auto store = open_store(dir_);
        must(commit_one(*store, a_write("feeder", "AC", std::int64_t{7})));
        version_ = static_cast<int>(program_migrations().size());
    }
    StoreOptions with(std::string_view sql) const {
        auto o = options_for(dir_.path());
        o.migrations.push_back({version_ + 1, "next.sql", sql});
        return o;
    }
    std::string before() const { return dir_ / ("axisgate.db.before-" + std::to_string(version_ + 1)); }

    TempDir dir_;
    int version_ = 0;
};

TEST_F(Upgrade, KeepsTheValuesAndACopyFromBefore) {
    const auto next = with("CREATE TABLE more (x INTEGER) STRICT; INSERT INTO more VALUES (5);");
    {
        const auto store = open_store(next);
        ASSERT_NE(store, nullptr);
        EXPECT_EQ(must(store->facts()).version, version_ + 1);
        EXPECT_EQ(must(store->stored("feeder", "AC"))->value, Value{std::int64_t{7}});
        must(store->check());
    }
    auto copy = must(Db::open(before(), Db::Mode::read_only));
    EXPECT_EQ(must(version_of(*copy)), version_);
    EXPECT_EQ(must(copy->integer("SELECT value FROM parameter_stored")), 7);
    // The copy is a backup like any other: it brings the older state back.
    must(restore_database(before(), options_for(dir_.path())));
    EXPECT_EQ(must(open_store(dir_)->facts()).version, version_);
}

TEST_F(Upgrade, IsDoneOnce) {
    const auto next = with("CREATE TABLE more (x INTEGER) STRICT");
    { const auto store = open_store(next); }
    std::filesystem::remove(before());
    { const auto store = open_store(next); }
    EXPECT_FALSE(std::filesystem::exists(before()));  // no copy without an upgrade
}

TEST_F(Upgrade, AStepThatFailsIsUndoneWhole) {
    const auto error = refused(Store::open(with("CREATE TABLE more (x INTEGER) STRICT; INSERT INTO no_such_table VALUES (1);")));
    EXPECT_THAT(error.text, HasSubstr("no_such_table"));
    EXPECT_THAT(error.text, HasSubstr("next.sql"));
    EXPECT_THAT(error.text, HasSubstr(before()));
    const auto store = open_store(dir_);  // the older program goes on
    ASSERT_NE(store, nullptr);
    EXPECT_EQ(must(store->stored("feeder", "AC"))->value, Value{std::int64_t{7}});
    auto db = must(Db::open(dir_ / "axisgate.db", Db::Mode::read_only));
    EXPECT_EQ(must(db->integer("SELECT count(*) FROM sqlite_schema WHERE name = 'more'")), 0);
}

TEST_F(Upgrade, AStepThatEndsItsTransactionOrBreaksReferencesIsAFaultOfTheProgram) {
    EXPECT_THAT(refused(Store::open(with("CREATE TABLE more (x INTEGER) STRICT; COMMIT"))).text, HasSubstr("ends its transaction"));
    const auto broken = refused(Store::open(with("PRAGMA defer_foreign_keys=ON; DELETE FROM axis")));
    EXPECT_THAT(broken.text, HasSubstr("breaks the references"));
    EXPECT_EQ(must(open_store(dir_)->stored("feeder")).size(), 1u);
}

TEST_F(Upgrade, ACopyThatCannotBeMadeStopsTheUpgrade) {
    std::filesystem::create_directories(before() + "/in the way");
    const auto error = refused(Store::open(with("CREATE TABLE more (x INTEGER) STRICT")));
    EXPECT_THAT(error.text, HasSubstr("not upgraded"));
    EXPECT_EQ(must(open_store(dir_)->facts()).version, version_);
    EXPECT_THAT(names_in(dir_.path()), testing::Not(testing::Contains(testing::HasSubstr(".part"))));
}

TEST_F(Upgrade, AnOlderProgramIsRefusedByTheNewerFile) {
    { const auto store = open_store(with("CREATE TABLE more (x INTEGER) STRICT")); }
    const auto before_open = content_of(dir_ / "axisgate.db");
    const auto error = refused(Store::open(options_for(dir_.path())));
    EXPECT_EQ(error.kind, Kind::newer);
    EXPECT_THAT(error.text, HasSubstr("Install the newer axisgate"));
    EXPECT_THAT(error.text, HasSubstr(before()));
    EXPECT_EQ(content_of(dir_ / "axisgate.db"), before_open);
}

}  // namespace
}  // namespace axisgate::test
