// Disks that fail: what the error says, that nothing half is left, and that the store goes on when the cause is gone.
#include <cerrno>

#include "tests/unit/store/fault_vfs.hpp"
#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {
using testing::HasSubstr;
using testing::Not;

struct Failure {
    const char* name;
    unsigned operations;
    int code;
    int system;
    Kind kind;
    const char* words;
    const char* remedy;
};
const Failure failures[] = {
    {"disk_full", FaultVfs::write, SQLITE_FULL, 0, Kind::disk_full, "the disk is full", "Free space on the file system of"},
    {"no_space_by_errno", FaultVfs::write, SQLITE_IOERR_WRITE, ENOSPC, Kind::disk_full, "the disk is full",
     "Free space on the file system of"},
    {"quota", FaultVfs::write, SQLITE_IOERR_WRITE, EDQUOT, Kind::disk_full, "the disk is full", "Disk quota exceeded"},
    {"no_space_for_shared_memory", FaultVfs::shared_memory, SQLITE_IOERR_SHMSIZE, ENOSPC, Kind::disk_full, "the disk is full",
     "Free space"},
    {"write_error", FaultVfs::write, SQLITE_IOERR_WRITE, EIO, Kind::io, "failed", "dmesg"},
    {"sync_error", FaultVfs::sync, SQLITE_IOERR_FSYNC, EIO, Kind::io, "failed", "replace the disk"},
    {"read_only", FaultVfs::write, SQLITE_IOERR_WRITE, EROFS, Kind::read_only, "cannot be written", "mount it for writing"},
};

class Disk : public testing::TestWithParam<Failure> {};

TEST_P(Disk, EveryWriteReportsItAndTheStoreHeals) {
    const Failure& f = GetParam();
    FaultVfs vfs;
    const TempDir dir;
    auto options = options_for(dir.path());
    options.vfs = vfs.name();
    if (f.operations == FaultVfs::shared_memory) {
        // Mapped once at opening: a failure there keeps the store from opening, and opening again helps.
        { const auto store = open_store(options); }
        vfs.fail(f.operations, f.code, f.system);
        const auto error = refused(Store::open(options));
        EXPECT_EQ(error.kind, f.kind) << error.text;
        EXPECT_THAT(error.text, HasSubstr(f.words));
        EXPECT_THAT(error.text, HasSubstr(f.remedy));
        vfs.heal();
        EXPECT_NE(open_store(options), nullptr);
        return;
    }
    const auto store = open_store(options);
    const SnapshotValue value{"AC", Value{std::int64_t{7}}};
    const ParameterSeen seen{"feeder", "AC", Value{std::int64_t{5}}, 1};
    const Event event = an_event("alarm", "feeder", 1, Severity::alarm);
    const SiteChange change{{{"feeder", "belt"}}, {}, {}, {}, {}, {}};
    must(commit_one(*store, a_write("feeder", "AC", std::int64_t{1})));
    must(store->save_site("{}", "x", 1));
    must(store->save_snapshot("feeder", "one", "", "", 1, std::span(&value, 1)));
    must(store->save_twin("feeder", {{"a", Value{true}}}));
    must(store->save_document({"recipe", "r", "1", "me", 1}));

    std::int64_t turn = 1;
    const std::vector<std::pair<const char*, std::function<StoreResult<>()>>> writes{
        {"AC of axis feeder is not stored", [&] { return commit_one(*store, a_write("feeder", "AC", ++turn)); }},
        {"1 event is not stored", [&] { return store->append_events(std::span(&event, 1)).map([](auto) {}); }},
        {"1 last seen value is not stored",
         [&] {
             auto s = seen;
             s.value = ++turn;
             return store->record_seen(std::span(&s, 1));
         }},
        {"the site is not stored", [&] { return store->save_site("site " + std::to_string(++turn), "x", 2).map([](auto) {}); }},
        {"the snapshot of axis feeder is not saved",
         [&] { return store->save_snapshot("feeder", "", "", "", 2, std::span(&value, 1)).map([](auto) {}); }},
        {"the memory of the twin of drive feeder is not saved",
         [&] {
             return store->save_twin("feeder", {{"a", Value{++turn}}});
         }},
        {"recipe r is not saved",
         [&] {
             return store->save_document({"recipe", "r", std::to_string(++turn), "me", 1});
         }},
        {"axis feeder is not renamed to x", [&] { return store->rename_axis("feeder", "x", 1); }},
    };
    for (int round = 0; round < 3; ++round) {
        vfs.fail(f.operations, f.code, f.system);
        for (const auto& [what, write] : writes) {
            const auto error = refused(write());
            EXPECT_EQ(error.kind, f.kind) << what << ": " << error.text;
            EXPECT_THAT(error.text, HasSubstr(what));
            EXPECT_THAT(error.text, HasSubstr(f.words));
            EXPECT_THAT(error.text, HasSubstr(f.remedy));
            EXPECT_THAT(error.text, HasSubstr(dir.path()));
            EXPECT_NE(error.sqlite_code, 0);
        }
        // Meanwhile everything can be read, as it was before.
        EXPECT_TRUE(must(store->stored("feeder", "AC")));
        EXPECT_EQ(must(store->snapshots("feeder")).size(), 1u + static_cast<std::size_t>(round));
        vfs.heal();
        for (std::size_t i = 0; i + 1 < writes.size(); ++i)
            must(writes[i].second());
        EXPECT_EQ(must(store->snapshots("feeder")).back().n, 2u + static_cast<std::uint32_t>(round));  // a refused one took no number
        EXPECT_EQ(must(store->last_event_id()), 1u + static_cast<std::uint64_t>(round));
        must(store->check());
    }
    must(store->rename_axis("feeder", "x", 1));
}
INSTANTIATE_TEST_SUITE_P(Store, Disk, testing::ValuesIn(failures), [](const auto& i) { return std::string(i.param.name); });

TEST(DiskError, TheWorstAnswerOfEachCallLeavesTheOldOrTheNewStateAndHeals) {
    // Each kind of failure at the first, second, third ... call that a commit makes, until a commit passes without meeting it.
    struct Kind_ {
        const char* name;
        unsigned operations;
        int code;
        int system;
    };
    const Kind_ kinds[] = {{"full", FaultVfs::write, SQLITE_FULL, 0},
                           {"write", FaultVfs::write, SQLITE_IOERR_WRITE, EIO},
                           {"sync", FaultVfs::sync, SQLITE_IOERR_FSYNC, EIO},
                           {"truncate", FaultVfs::truncate, SQLITE_IOERR_TRUNCATE, EIO},
                           {"read", FaultVfs::read, SQLITE_IOERR_READ, EIO},
                           {"size", FaultVfs::size, SQLITE_IOERR_FSTAT, EIO},
                           {"memory", FaultVfs::shared_memory, SQLITE_IOERR_SHMMAP, ENOMEM},
                           {"everything", FaultVfs::everything, SQLITE_IOERR, EIO}};
    int met = 0;
    for (const auto& k : kinds) {
        for (const bool for_ever : {false, true}) {
            for (const bool tidy : {false, true}) {
                FaultVfs vfs;
                const TempDir dir;
                auto options = options_for(dir.path());
                options.vfs = vfs.name();
                auto store = open_store(options);
                std::int64_t now = 0;
                bool reached = true;
                for (std::uint64_t n = 0; reached; ++n) {
                    ASSERT_LT(n, 200u);
                    const std::string large(9000, static_cast<char>('a' + n % 26));  // several pages, so that there are several calls
                    const std::vector writes{a_write("feeder", "AC", now + 1), a_write("feeder", "TEXT", large)};
                    vfs.fail(k.operations, k.code, k.system, n, for_ever ? ~0ull : 1);
                    const auto r = store->commit(writes);
                    const auto upkeep = tidy ? store->tidy() : StoreResult<>{};
                    reached = vfs.failures() != 0;
                    met += reached ? 1 : 0;
                    vfs.heal();
                    const auto stored = must(store->stored("feeder", "AC"));
                    if (r) {
                        ++now;
                    } else {
                        EXPECT_NE(r.error().kind, Kind::internal) << k.name << " " << n << ": " << r.error().text;
                    }
                    ASSERT_EQ(stored ? stored->value : Value{std::int64_t{0}}, Value{now}) << k.name << " " << n;
                    if (r) {
                        ASSERT_EQ(must(store->stored("feeder", "TEXT"))->value, Value{large});
                    }
                    must(commit_one(*store, a_write("feeder", "AC", ++now)));  // healed without being opened again
                    if (!upkeep) must(store->tidy());
                }
                must(store->check());
                store.reset();
                EXPECT_EQ(must(open_store(dir)->stored("feeder", "AC"))->value, Value{now}) << k.name;
            }
        }
    }
    EXPECT_GT(met, 40);
}

TEST(DiskError, AFirstStartOnAFullDiskLeavesNothingAndWorksLater) {
    FaultVfs vfs;
    const TempDir dir;
    auto options = options_for(dir.path());
    options.vfs = vfs.name();
    for (std::uint64_t n = 0;; ++n) {
        ASSERT_LT(n, 500u);
        vfs.fail(FaultVfs::write | FaultVfs::sync, SQLITE_FULL, 0, n);
        const auto r = Store::open(options);
        const bool met = vfs.failures() != 0;
        vfs.heal();
        if (r) {
            if (!met) break;
            continue;  // upkeep that may fail
        }
        EXPECT_EQ(r.error().kind, Kind::disk_full) << r.error().text;
        EXPECT_THAT(names_in(dir.path()), Not(testing::Contains(testing::StartsWith("axisgate.db.new"))));
    }
    must(open_store(dir)->check());
}

TEST(DiskError, AnUpgradeOnAFullDiskChangesNothing) {
    FaultVfs vfs;
    const TempDir dir;
    {
        const auto store = open_store(dir);
        must(commit_one(*store, a_write("feeder", "AC", std::int64_t{7})));
    }
    auto next = options_for(dir.path());
    next.vfs = vfs.name();
    next.migrations.push_back(
        {static_cast<int>(next.migrations.size()) + 1, "next.sql", "CREATE TABLE more (x TEXT) STRICT; INSERT INTO more VALUES ('x')"});
    int refusals = 0;
    for (std::uint64_t n = 0;; ++n) {
        ASSERT_LT(n, 500u);
        vfs.fail(FaultVfs::write | FaultVfs::sync, SQLITE_FULL, 0, n);
        const auto r = Store::open(next);
        vfs.heal();
        if (r) break;
        ++refusals;
        EXPECT_EQ(r.error().kind, Kind::disk_full) << r.error().text;
        const auto older = open_store(dir);  // the older program still can
        ASSERT_NE(older, nullptr);
        EXPECT_EQ(must(older->stored("feeder", "AC"))->value, Value{std::int64_t{7}});
    }
    EXPECT_GT(refusals, 5);
    EXPECT_EQ(must(open_store(next)->stored("feeder", "AC"))->value, Value{std::int64_t{7}});
}

TEST(DiskError, AReadOnlyFileSystemIsSaidAtOnce) {
    FaultVfs vfs;
    const TempDir dir;
    { const auto store = open_store(dir); }
    auto options = options_for(dir.path());
    options.vfs = vfs.name();
    vfs.read_only(true);
    const auto error = refused(Store::open(options));
    EXPECT_EQ(error.kind, Kind::read_only);
    EXPECT_THAT(error.text, HasSubstr("cannot be written"));
}

TEST(DiskError, AReaderReportsIt) {
    FaultVfs vfs;
    const TempDir dir;
    const auto store = open_store(dir);
    must(commit_one(*store, a_write("feeder", "AC", std::int64_t{7})));
    auto options = options_for(dir.path());
    options.vfs = vfs.name();
    const auto reader = must(StoreReader::open(options));
    must(commit_one(*store, a_write("feeder", "AC", std::int64_t{8})));  // what the reader has in its cache is old now
    vfs.fail(FaultVfs::read, SQLITE_IOERR_READ, EIO);
    const auto error = refused(reader->stored("feeder"));
    EXPECT_EQ(error.kind, Kind::io);
    EXPECT_THAT(error.text, HasSubstr("values of axis feeder could not be read"));
    vfs.heal();
    EXPECT_EQ(must(reader->stored("feeder", "AC"))->value, Value{std::int64_t{8}});
}

TEST(SizeLimit, IsReportedAsSuchAndDeletingMakesRoom) {
    const TempDir dir;
    auto options = options_for(dir.path());
    options.limits.max_bytes = 400 * 1024;
    const auto store = open_store(options);
    const SnapshotValue large{"TEXT", Value{std::string(20'000, 'x')}};
    StoreResult<std::uint32_t> r = 0;
    for (int i = 0; i < 100 && r; ++i)
        r = store->save_snapshot("feeder", "", "", "", 1, std::span(&large, 1));
    const auto error = refused(r);
    EXPECT_EQ(error.kind, Kind::disk_full);
    EXPECT_THAT(error.text, HasSubstr("size limit of 409600 bytes"));
    EXPECT_THAT(error.text, HasSubstr("Delete snapshots"));
    EXPECT_LE(must(store->facts()).bytes, options.limits.max_bytes);
    const auto last = must(store->snapshots("feeder")).back().n;
    EXPECT_GT(last, 5u);
    must(store->delete_snapshot("feeder", 1));
    EXPECT_EQ(must(store->save_snapshot("feeder", "", "", "", 1, std::span(&large, 1))), last + 1);
    EXPECT_GT(must(store->facts()).bytes, 0u);
    must(store->check());
}

TEST(Busy, AnotherProgramThatHoldsTheFileIsNamedAsTheCause) {
    FaultVfs vfs;  // its time-out passes without waiting
    const TempDir dir;
    auto options = options_for(dir.path());
    options.vfs = vfs.name();
    const auto store = open_store(options);
    auto other = must(Db::open(dir / "axisgate.db", Db::Mode::read_write));
    must(other->exec("BEGIN IMMEDIATE"));
    const auto error = refused(commit_one(*store, a_write("feeder", "AC", std::int64_t{1})));
    EXPECT_EQ(error.kind, Kind::busy);
    EXPECT_THAT(error.text, HasSubstr("another program holds"));
    must(other->exec("ROLLBACK"));
    must(commit_one(*store, a_write("feeder", "AC", std::int64_t{1})));
}

TEST(Errors, KindsHaveNames) {
    EXPECT_EQ(name_of(Kind::disk_full), "disk_full");
    EXPECT_EQ(name_of(Kind::internal), "internal");
}

}  // namespace
}  // namespace axisgate::test
