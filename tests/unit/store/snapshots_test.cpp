// Snapshots: numbers count up per axis and never come twice; values come back; bounds are said.
#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::uint32_t> numbers(Store& store, const std::string& axis) {
    std::vector<std::uint32_t> n;
    for (const auto& s : must(store.snapshots(axis)))
        n.push_back(s.n);
    return n;
}

TEST(Snapshots, OfAnAxisThatWasRemovedAreNotSavedAndDoNotBringItBack) {
    const TempDir dir;
    const auto store = open_store(dir);
    EXPECT_EQ(must(store->save_snapshot("feeder", "before", "", "", 1, {})), 1u);
    ASSERT_TRUE(store->remove_axis("feeder", 2));
    const auto late = store->save_snapshot("feeder", "late", "", "", 3, {});
    ASSERT_FALSE(late);
    EXPECT_EQ(late.error().kind, StoreError::Kind::not_found);
    EXPECT_THAT(late.error().text, HasSubstr("removed"));
    ASSERT_EQ(must(store->axes()).size(), 1u);
    EXPECT_TRUE(must(store->axes())[0].removed_unix_ns.has_value());
    EXPECT_THAT(numbers(*store, "feeder"), ElementsAre(1u));
}

TEST(Snapshots, AreSavedListedReadAndDeleted) {
    const TempDir dir;
    const auto store = open_store(dir);
    const std::vector<SnapshotValue> values{{"DC", Value{2.5}}, {"AC", Value{std::int64_t{7}}}, {"N[10]", Value{}}};
    EXPECT_EQ(must(store->save_snapshot("feeder", "commissioned", "line 4,\nfirst set", "http admin", 123, values)), 1u);
    EXPECT_EQ(must(store->save_snapshot("feeder", {}, {}, {}, 124, {})), 2u);      // views of nothing are empty texts
    EXPECT_EQ(must(store->save_snapshot("slide", "x", "", "", 125, values)), 1u);  // each axis counts by itself
    const auto list = must(store->snapshots("feeder"));
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].name, "commissioned");
    EXPECT_EQ(list[0].comment, "line 4,\nfirst set");
    EXPECT_EQ(list[0].who, "http admin");
    EXPECT_EQ(list[0].at_unix_ns, 123);
    EXPECT_EQ(list[0].values, 3u);
    EXPECT_EQ(list[1].values, 0u);
    const auto s = must(store->snapshot("feeder", 1));
    ASSERT_TRUE(s);
    EXPECT_EQ(s->n, 1u);
    EXPECT_EQ(s->name, "commissioned");
    EXPECT_EQ(s->values, 3u);
    EXPECT_EQ(s->parameters.at(0).parameter, "AC");
    EXPECT_EQ(s->parameters.at(0).value, Value{std::int64_t{7}});
    EXPECT_EQ(s->parameters.at(1).value, Value{2.5});
    EXPECT_EQ(s->parameters.at(2).value, Value{});
    EXPECT_EQ(must(store->snapshot("feeder", 2))->parameters.size(), 0u);
    EXPECT_FALSE(must(store->snapshot("feeder", 3)));
    EXPECT_FALSE(must(store->snapshot("nobody", 1)));
    must(store->delete_snapshot("feeder", 1));
    EXPECT_FALSE(must(store->snapshot("feeder", 1)));
    EXPECT_TRUE(must(store->snapshot("slide", 1)));
    must(store->check());  // its values went with it
    const auto error = refused(store->delete_snapshot("feeder", 1));
    EXPECT_EQ(error.kind, Kind::not_found);
    EXPECT_THAT(error.text, HasSubstr("snapshot 1 of axis feeder"));
}

TEST(Snapshots, NumbersAreNeverGivenTwice) {
    const TempDir dir;
    {
        const auto store = open_store(dir);
        for (int i = 0; i < 3; ++i)
            must(store->save_snapshot("feeder", "", "", "", 1, {}));
        must(store->delete_snapshot("feeder", 3));
        must(store->delete_snapshot("feeder", 1));
    }
    const auto store = open_store(dir);
    EXPECT_EQ(must(store->save_snapshot("feeder", "", "", "", 1, {})), 4u);
    EXPECT_THAT(numbers(*store, "feeder"), ElementsAre(2, 4));
}

TEST(Snapshots, WhatIsRefusedTakesNoNumber) {
    const TempDir dir;
    const auto store = open_store(dir);
    const std::vector<SnapshotValue> twice{{"AC", Value{1.0}}, {"AC", Value{2.0}}};
    EXPECT_THAT(refused(store->save_snapshot("feeder", "", "", "", 1, twice)).text, HasSubstr("AC is there twice"));
    EXPECT_EQ(refused(store->save_snapshot("", "", "", "", 1, {})).kind, Kind::invalid);
    EXPECT_EQ(refused(store->save_snapshot("feeder", std::string(257, 'x'), "", "", 1, {})).kind, Kind::invalid);
    EXPECT_EQ(refused(store->save_snapshot("feeder", "", std::string(max_comment_bytes + 1, 'x'), "", 1, {})).kind, Kind::invalid);
    const std::vector<SnapshotValue> many(max_snapshot_values + 1);
    EXPECT_EQ(refused(store->save_snapshot("feeder", "", "", "", 1, many)).kind, Kind::invalid);
    EXPECT_EQ(must(store->save_snapshot("feeder", "", "", "", 1, {})), 1u);
}

TEST(Snapshots, AreBoundedPerAxis) {
    const TempDir dir;
    { const auto store = open_store(dir); }
    meddle(dir / "axisgate.db",
           "INSERT INTO axis (name, last_snapshot) VALUES ('feeder', 1000); WITH RECURSIVE k(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM k "
           "LIMIT 1000) "
           "INSERT INTO snapshot (axis_id, n, name, comment, who, at_unix_ns) SELECT (SELECT id FROM axis), n, '', '', '', 0 FROM k");
    const auto store = open_store(dir);
    const auto error = refused(store->save_snapshot("feeder", "", "", "", 1, {}));
    EXPECT_EQ(error.kind, Kind::conflict);
    EXPECT_THAT(error.text, HasSubstr("Delete those"));
    must(store->delete_snapshot("feeder", 500));
    EXPECT_EQ(must(store->save_snapshot("feeder", "", "", "", 1, {})), 1001u);
}

}  // namespace
}  // namespace axisgate::test
