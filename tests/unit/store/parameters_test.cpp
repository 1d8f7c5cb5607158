// The parameter database: values keep their kind, the newest write is what is stored, the history is bounded, names move with the site.
#include <atomic>
#include <limits>
#include <thread>

#include "gateway/doors/modbus/words.hpp"
#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<Value>& every_value() {
    static const std::vector<Value> all{Value{},
                                        Value{true},
                                        Value{false},
                                        Value{std::int64_t{0}},
                                        Value{std::int64_t{1}},
                                        Value{std::int64_t{-2}},
                                        Value{std::int64_t{0x01020304}},
                                        Value{std::numeric_limits<std::int64_t>::min()},
                                        Value{std::numeric_limits<std::int64_t>::max()},
                                        Value{0.0},
                                        Value{-0.0},
                                        Value{1.0},
                                        Value{0.1},
                                        Value{-1e308},
                                        Value{std::numeric_limits<double>::denorm_min()},
                                        Value{9007199254740993.0},
                                        Value{std::numeric_limits<double>::infinity()},
                                        Value{-std::numeric_limits<double>::infinity()},
                                        Value{std::numeric_limits<double>::quiet_NaN()},
                                        Value{std::string()},
                                        Value{std::string("12")},
                                        Value{std::string("Grüße, 轴")},
                                        Value{std::string("a\0b\0", 4)},
                                        Value{std::string("\xFF\xFE not UTF-8 \x80")},
                                        Value{std::string("'; DROP TABLE axis; --")},
                                        Value{std::string(max_value_bytes, 'x')}};
    return all;
}

TEST(Values, ComeBackAsTheSameKindAndInEveryBit) {
    const TempDir dir;
    std::vector<ParameterWrite> writes;
    std::vector<ParameterSeen> seen;
    std::vector<SnapshotValue> snapshot;
    NonVolatile memory;
    for (std::size_t i = 0; i < every_value().size(); ++i) {
        const std::string id = "P" + std::to_string(100 + i);
        writes.push_back(a_write("feeder", id, every_value()[i]));
        writes.back().previous = every_value()[every_value().size() - 1 - i];
        seen.push_back({"feeder", id, every_value()[i], 5});
        snapshot.push_back({id, every_value()[i]});
        memory[id] = every_value()[i];
    }
    {
        const auto store = open_store(dir);
        must(store->commit({writes, {}, seen}));
        must(store->save_snapshot("feeder", "all", "", "test", 1, snapshot));
        must(store->save_twin("feeder", memory));
    }
    const auto store = open_store(dir);
    const auto stored = must(store->stored("feeder"));
    const auto history = must(store->history("feeder", {}, 1000));
    const auto last_seen = must(store->seen("feeder"));
    const auto saved = must(store->snapshot("feeder", 1));
    const auto twin = must(store->load_twin("feeder"));
    const std::size_t n = every_value().size();
    ASSERT_EQ(stored.size(), n);
    ASSERT_EQ(history.size(), n);
    ASSERT_EQ(last_seen.size(), n);
    ASSERT_EQ(saved->parameters.size(), n);
    ASSERT_EQ(twin.size(), n);
    for (std::size_t i = 0; i < n; ++i) {
        const Value& want = every_value()[i];
        const std::string id = "P" + std::to_string(100 + i);
        EXPECT_TRUE(same_value(stored[i].value, want)) << id << " " << to_text(stored[i].value);
        EXPECT_TRUE(same_value(stored[i].previous, every_value()[n - 1 - i])) << id;
        EXPECT_TRUE(same_value(history[n - 1 - i].value, want)) << id;
        EXPECT_TRUE(same_value(last_seen[i].value, want)) << id;
        EXPECT_TRUE(same_value(saved->parameters[i].value, want)) << id;
        EXPECT_TRUE(same_value(twin.at(id), want)) << id;
    }
}

TEST(Values, SameValueTellsKindsAndBitsApart) {
    for (std::size_t i = 0; i < every_value().size(); ++i) {
        for (std::size_t k = 0; k < every_value().size(); ++k)
            EXPECT_EQ(same_value(every_value()[i], every_value()[k]), i == k) << i << " " << k;
    }
}

TEST(Values, OneThatAnotherProgramAlteredIsAnErrorNotAGuess) {
    const TempDir dir;
    {
        const auto store = open_store(dir);
        must(commit_one(*store, a_write("feeder", "AC", std::int64_t{7})));
    }
    meddle(dir / "axisgate.db", "UPDATE parameter_stored SET value = 'seven'");
    const auto store = open_store(dir);
    const auto error = refused(store->stored("feeder"));
    EXPECT_EQ(error.kind, Kind::corrupt);
    EXPECT_THAT(error.text, HasSubstr("AC"));
    EXPECT_THAT(error.text, HasSubstr("axis feeder"));
}

TEST(Stored, IsTheNewestWriteWithWhoWhenAndWhere) {
    const TempDir dir;
    const auto store = open_store(dir);
    EXPECT_TRUE(must(store->stored("feeder")).empty());
    auto first = a_write("feeder", "AC", std::int64_t{100}, 1'000);
    auto second = a_write("feeder", "AC", std::int64_t{200}, 2'000);
    second.previous = std::int64_t{100};
    second.door = modbus::clients;
    second.who = "192.0.2.9:1";
    second.storage = "ram";
    const auto other = a_write("slide", "AC", 1.5, 3'000);
    must(store->commit(std::vector{first, second, other}));
    const auto r = must(store->stored("feeder", "AC"));
    ASSERT_TRUE(r);
    EXPECT_EQ(r->parameter, "AC");
    EXPECT_EQ(r->value, Value{std::int64_t{200}});
    EXPECT_EQ(r->previous, Value{std::int64_t{100}});
    EXPECT_EQ(r->door, "modbus");
    EXPECT_EQ(r->who, "192.0.2.9:1");
    EXPECT_EQ(r->at_unix_ns, 2'000);
    EXPECT_EQ(r->storage, "ram");
    EXPECT_EQ(must(store->stored("slide", "AC"))->value, Value{1.5});
    EXPECT_FALSE(must(store->stored("feeder", "DC")));
    EXPECT_FALSE(must(store->stored("nobody", "AC")));
    const std::vector<StoredParameter> handed_on = [&] {
        const auto all = must(store->stored("feeder"));
        return std::vector<StoredParameter>(all.begin(), all.end());
    }();
    EXPECT_EQ(handed_on.at(0).value, Value{std::int64_t{200}});
}

TEST(Stored, AnOlderTimeStillReplacesBecauseTheClockMayHaveBeenSetBack) {
    const TempDir dir;
    const auto store = open_store(dir);
    must(commit_one(*store, a_write("feeder", "AC", std::int64_t{1}, 9'000'000'000)));
    must(commit_one(*store, a_write("feeder", "AC", std::int64_t{2}, 1)));
    EXPECT_EQ(must(store->stored("feeder", "AC"))->value, Value{std::int64_t{2}});
    EXPECT_EQ(must(store->history("feeder", "AC", 1)).at(0).value, Value{std::int64_t{2}});
}

TEST(Batch, IsAllOrNothing) {
    const TempDir dir;
    const auto store = open_store(dir);
    struct Case {
        const char* name;
        ParameterWrite wrong;
        const char* word;
    };
    const Case cases[] = {{"no axis", a_write("", "AC", std::int64_t{1}), "axis is empty"},
                          {"no parameter", a_write("feeder", "", std::int64_t{1}), "parameter is empty"},
                          {"long name", a_write(std::string(257, 'a'), "AC", std::int64_t{1}), "257 bytes"},
                          {"control character", a_write("fee\nder", "AC", std::int64_t{1}), "control characters"},
                          {"large text", a_write("feeder", "AC", std::string(max_value_bytes + 1, 'x')), "1048577 bytes"}};
    for (const Case& c : cases) {
        const std::vector writes{a_write("feeder", "AC", std::int64_t{1}), c.wrong};
        const auto error = refused(store->commit(writes));
        EXPECT_EQ(error.kind, Kind::invalid) << c.name;
        EXPECT_THAT(error.text, HasSubstr(c.word)) << c.name;
        EXPECT_THAT(error.text, HasSubstr("AC of axis feeder and 1 more values are not stored")) << c.name;
    }
    EXPECT_TRUE(must(store->stored("feeder")).empty());
    EXPECT_TRUE(must(store->axes()).empty());
    const std::vector<ParameterWrite> many(max_batch_rows + 1, a_write("feeder", "AC", std::int64_t{1}));
    EXPECT_EQ(refused(store->commit(many)).kind, Kind::invalid);
    must(store->commit(std::span(many).first(max_batch_rows)));
    must(store->commit(std::span<const ParameterWrite>{}));  // nothing to do is no error
}

TEST(Batch, WritesEventsAndSeenValuesGoTogether) {
    const TempDir dir;
    const auto store = open_store(dir);
    const std::vector writes{a_write("feeder", "AC", std::int64_t{1})};
    std::vector events{an_event("write", "feeder", 1), an_event("write", "feeder", 2)};
    const std::vector<ParameterSeen> seen{{"feeder", "DC", Value{2.0}, 1}};
    EXPECT_EQ(must(store->commit({writes, events, seen})), 2u);
    events[1].id = 1;  // taken: refuses the whole batch
    const std::vector again{a_write("feeder", "AC", std::int64_t{5})};
    EXPECT_EQ(refused(store->commit({again, events, seen})).kind, Kind::invalid);
    EXPECT_EQ(must(store->stored("feeder", "AC"))->value, Value{std::int64_t{1}});
    EXPECT_EQ(must(store->last_event_id()), 2u);
}

TEST(History, IsNewestFirstPerParameterOrPerAxisAndInPages) {
    const TempDir dir;
    const auto store = open_store(dir);
    std::vector<ParameterWrite> writes;
    for (int i = 1; i <= 6; ++i)
        writes.push_back(a_write("feeder", i % 2 == 0 ? "AC" : "DC", std::int64_t{i}, i));
    writes.push_back(a_write("slide", "AC", std::int64_t{99}, 99));
    must(store->commit(writes));
    const auto values = [](const std::vector<ParameterRecord>& list) {
        std::vector<std::int64_t> v;
        for (const auto& r : list)
            v.push_back(std::get<std::int64_t>(r.value));
        return v;
    };
    EXPECT_THAT(values(must(store->history("feeder", "AC", 100))), ElementsAre(6, 4, 2));
    EXPECT_THAT(values(must(store->history("feeder", "", 100))), ElementsAre(6, 5, 4, 3, 2, 1));
    const auto page = must(store->history("feeder", "", 4));
    EXPECT_THAT(values(page), ElementsAre(6, 5, 4, 3));
    EXPECT_THAT(values(must(store->history("feeder", "", 4, page.back().id))), ElementsAre(2, 1));
    EXPECT_THAT(values(must(store->history("feeder", "AC", 0))), ElementsAre(6));  // clamped to 1
    EXPECT_TRUE(must(store->history("nobody", "", 10)).empty());
}

TEST(History, IsBoundedAndTheOldestGoFirst) {
    const TempDir dir;
    auto options = options_for(dir.path());
    options.limits.parameter_writes = 50;
    options.limits.piece = 4;
    {
        const auto store = open_store(options);
        for (int i = 1; i <= 120; ++i) {
            must(commit_one(*store, a_write("feeder", "AC", std::int64_t{i})));
            ASSERT_LE(must(store->facts()).parameter_writes, 50u);
        }
        const auto rows = must(store->history("feeder", "AC", 1000));
        ASSERT_EQ(rows.size(), 50u);
        EXPECT_EQ(rows.front().value, Value{std::int64_t{120}});
        EXPECT_EQ(rows.back().value, Value{std::int64_t{71}});
        std::vector<ParameterWrite> batch(70, a_write("feeder", "DC", std::int64_t{1}));  // larger than the bound itself
        must(store->commit(batch));
        EXPECT_EQ(must(store->facts()).parameter_writes, 50u);
        EXPECT_EQ(must(store->stored("feeder", "AC"))->value, Value{std::int64_t{120}});  // the stored value outlives its history
    }
    options.limits.parameter_writes = 20;  // a smaller bound is reached in pieces, not at once
    const auto store = open_store(options);
    must(commit_one(*store, a_write("feeder", "DC", std::int64_t{1})));
    EXPECT_EQ(must(store->facts()).parameter_writes, 50u + 1 - 5);
    for (int i = 0; i < 20; ++i)
        must(store->tidy());
    EXPECT_EQ(must(store->facts()).parameter_writes, 20u);
}

TEST(Seen, TheNewestCallWinsAndUnchangedValuesAreNotWrittenAgain) {
    const TempDir dir;
    auto options = options_for(dir.path());
    options.limits.seen_refresh_ns = 1000;
    const auto store = open_store(options);
    const auto see = [&](Value v, std::int64_t at) {
        const ParameterSeen s{"feeder", "AC", std::move(v), at};
        must(store->record_seen(std::span(&s, 1)));
        return must(store->seen("feeder")).at(0);
    };
    EXPECT_EQ(see(std::int64_t{5}, 10'000).at_unix_ns, 10'000);
    EXPECT_EQ(see(std::int64_t{5}, 10'999).at_unix_ns, 10'000);  // same and young: not written
    EXPECT_EQ(see(std::int64_t{5}, 11'000).at_unix_ns, 11'000);  // same, but old enough to be confirmed
    EXPECT_EQ(see(std::int64_t{6}, 11'001).value, Value{std::int64_t{6}});
    EXPECT_EQ(see(6.0, 11'002).value, Value{6.0});  // another kind is another value
    EXPECT_EQ(see(6.0, 5'000).at_unix_ns, 5'000);   // the clock was set back
    EXPECT_EQ(see(Value{}, 5'001).value, Value{});
    EXPECT_TRUE(must(store->stored("feeder")).empty());  // seen is not stored
    const auto before = std::filesystem::file_size(dir / "axisgate.db-wal");
    for (int i = 0; i < 100; ++i)
        see(Value{}, 5'002 + i);
    EXPECT_EQ(std::filesystem::file_size(dir / "axisgate.db-wal"), before);  // not a byte to the disk
}

TEST(Axis, RenameTakesEverythingAlong) {
    const TempDir dir;
    const auto store = open_store(dir);
    must(commit_one(*store, a_write("feeder", "AC", std::int64_t{7})));
    const ParameterSeen seen{"feeder", "AC", Value{std::int64_t{8}}, 1};
    must(store->record_seen(std::span(&seen, 1)));
    const SnapshotValue value{"AC", Value{std::int64_t{7}}};
    must(store->save_snapshot("feeder", "good", "", "me", 1, std::span(&value, 1)));
    must(store->rename_axis("feeder", "belt", 5));
    EXPECT_EQ(must(store->stored("belt", "AC"))->value, Value{std::int64_t{7}});
    EXPECT_EQ(must(store->history("belt", "AC", 10)).size(), 1u);
    EXPECT_EQ(must(store->seen("belt")).size(), 1u);
    EXPECT_EQ(must(store->snapshots("belt")).size(), 1u);
    EXPECT_TRUE(must(store->stored("feeder")).empty());
    EXPECT_TRUE(must(store->history("feeder", "", 10)).empty());
    EXPECT_TRUE(must(store->snapshots("feeder")).empty());
    must(store->rename_axis("nobody", "somebody", 6));  // not known: nothing to do
    must(commit_one(*store, a_write("slide", "AC", std::int64_t{1})));
    const auto error = refused(store->rename_axis("belt", "slide", 7));
    EXPECT_EQ(error.kind, Kind::conflict);
    EXPECT_THAT(error.text, HasSubstr("axis belt is not renamed to slide"));
    EXPECT_EQ(must(store->stored("belt")).size(), 1u);  // undone whole
    EXPECT_EQ(refused(store->rename_axis("belt", "", 7)).kind, Kind::invalid);
    must(store->rename_axis("belt", "belt", 8));
    EXPECT_EQ(must(store->stored("belt")).size(), 1u);
}

TEST(Axis, WhatWasStoredForARemovedOneIsShownAgainWhenItIsMadeAgain) {
    const TempDir dir;
    const auto store = open_store(dir);
    must(commit_one(*store, a_write("feeder", "AC", std::int64_t{7})));
    const SnapshotValue value{"AC", Value{std::int64_t{7}}};
    must(store->save_snapshot("feeder", "good", "", "me", 1, std::span(&value, 1)));
    const ParameterSeen seen{"feeder", "AC", Value{std::int64_t{8}}, 1};
    must(store->record_seen(std::span(&seen, 1)));
    must(store->remove_axis("feeder", 50));
    EXPECT_TRUE(must(store->stored("feeder")).empty());
    EXPECT_FALSE(must(store->stored("feeder", "AC")));
    EXPECT_TRUE(must(store->seen("feeder")).empty());
    EXPECT_EQ(must(store->history("feeder", "AC", 10)).size(), 1u);
    EXPECT_EQ(must(store->snapshots("feeder")).size(), 1u);
    EXPECT_EQ(must(store->axes()).at(0).removed_unix_ns, 50);
    // Made again under its name: all goes on but what the drive itself said.
    must(commit_one(*store, a_write("feeder", "DC", std::int64_t{9})));
    EXPECT_EQ(must(store->axes()).at(0).removed_unix_ns, std::nullopt);
    EXPECT_THAT(must(store->stored("feeder")),
                ElementsAre(testing::Field(&ParameterRecord::parameter, "AC"), testing::Field(&ParameterRecord::parameter, "DC")));
    EXPECT_TRUE(must(store->seen("feeder")).empty());
    EXPECT_EQ(must(store->history("feeder", "", 10)).size(), 2u);
    EXPECT_EQ(must(store->save_snapshot("feeder", "new", "", "me", 2, {})), 2u);
    must(store->remove_axis("nobody", 60));
}

TEST(Axis, ARemovedOneStepsAsideForARenamedOne) {
    const TempDir dir;
    const auto store = open_store(dir);
    must(commit_one(*store, a_write("belt", "AC", std::int64_t{1})));
    must(store->remove_axis("belt", 5));
    must(commit_one(*store, a_write("feeder", "AC", std::int64_t{2})));
    must(store->rename_axis("feeder", "belt", 6));
    EXPECT_EQ(must(store->history("belt", "", 10)).size(), 1u);
    EXPECT_EQ(must(store->stored("belt", "AC"))->value, Value{std::int64_t{2}});
    EXPECT_EQ(must(store->axes()).size(), 2u);
    EXPECT_THAT(must(store->axes()).at(1).name, testing::MatchesRegex("belt \\(removed [0-9]+\\)"));
    EXPECT_EQ(must(store->history(must(store->axes()).at(1).name, "", 10)).at(0).value, Value{std::int64_t{1}});
}

TEST(Axis, RemovedOnesWithoutHistoryAreForgottenAtTheNextStart) {
    const TempDir dir;
    {
        const auto store = open_store(dir);
        const std::vector<ParameterSeen> seen{{"gone", "AC", Value{1.0}, 1}, {"here", "AC", Value{1.0}, 1}};
        must(store->record_seen(seen));
        must(commit_one(*store, a_write("written", "AC", std::int64_t{1})));
        must(store->save_snapshot("saved", "x", "", "me", 1, {}));
        for (const char* axis : {"gone", "written", "saved"})
            must(store->remove_axis(axis, 5));
        EXPECT_EQ(must(store->axes()).size(), 4u);
    }
    const auto store = open_store(dir);
    std::vector<std::string> names;
    for (const auto& a : must(store->axes()))
        names.push_back(a.name);
    EXPECT_THAT(names, ElementsAre("here", "saved", "written"));
}

TEST(Reader, SeesWholeBatchesWhileTheWriterCommits) {
    const TempDir dir;
    const auto store = open_store(dir);
    must(store->commit(std::vector{a_write("feeder", "AC", std::int64_t{0}), a_write("feeder", "DC", std::int64_t{0})}));
    std::atomic<bool> stop{false};
    std::atomic<int> reads{0};
    int torn = 0;
    int backwards = 0;
    std::string fault;
    std::thread thread([&] {
        auto reader = StoreReader::open(options_for(dir.path()));
        std::int64_t last = -1;
        while (reader && !stop) {
            const auto all = (*reader)->stored("feeder");
            if (!all) {
                fault = all.error().text;
                break;
            }
            if (!((*all)[0].value == (*all)[1].value)) ++torn;
            const auto now = std::get<std::int64_t>((*all)[0].value);
            if (now < last) ++backwards;
            last = now;
            ++reads;
        }
    });
    for (std::int64_t i = 1; i <= 100 || reads < 10; ++i) {
        must(store->commit(std::vector{a_write("feeder", "AC", i), a_write("feeder", "DC", i)}));
        if (i > 1'000'000) break;
    }
    stop = true;
    thread.join();
    EXPECT_EQ(fault, "");
    EXPECT_EQ(torn, 0);
    EXPECT_EQ(backwards, 0);
    EXPECT_GE(reads, 10);
}

}  // namespace
}  // namespace axisgate::test
