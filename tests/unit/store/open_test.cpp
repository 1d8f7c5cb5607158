// Opening the store: what is made, who is let in, what is refused and left as it is.
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {
using testing::HasSubstr;

struct stat stat_of(const std::string& file) {
    struct stat st {};
    EXPECT_EQ(::stat(file.c_str(), &st), 0) << file;
    return st;
}

TEST(Open, MakesDirectoryAndDatabaseWithTheirModes) {
    const TempDir dir;
    const mode_t before = ::umask(0);  // whatever the umask is
    const std::string data = dir / "a/b/var";
    {
        const auto store = open_store(options_for(data));
        ::umask(before);
        EXPECT_EQ(stat_of(dir / "a").st_mode & 07777, 0750u);
        EXPECT_EQ(stat_of(data).st_mode & 07777, 0750u);
        EXPECT_EQ(stat_of(data + "/axisgate.db").st_mode & 07777, 0640u);
        ASSERT_TRUE(commit_one(*store, a_write("feeder", "AC", std::int64_t{1})));
        EXPECT_EQ(stat_of(data + "/axisgate.db-wal").st_mode & 07777, 0640u);
    }
    EXPECT_THAT(names_in(data), testing::UnorderedElementsAre("axisgate.db", "axisgate.lock"));  // closed in order: no log is left
}

TEST(Open, FilesBelongToTheOwnerOfTheDirectory) {
    const TempDir dir;
    if (::geteuid() == 0) {  // as `sudo axisgate restore` finds the service's
        ASSERT_EQ(::chown(dir.path().c_str(), 12345, 12346), 0);
    }
    const auto store = open_store(dir);
    must(commit_one(*store, a_write("feeder", "AC", std::int64_t{1})));
    const auto owner = stat_of(dir.path());
    for (const char* file : {"axisgate.db", "axisgate.lock", "axisgate.db-wal", "axisgate.db-shm"}) {
        EXPECT_EQ(stat_of(dir / file).st_uid, owner.st_uid) << file;
        EXPECT_EQ(stat_of(dir / file).st_gid, owner.st_gid) << file;
    }
}

TEST(Open, SettingsAreThoseOfADurableDatabase) {
    const TempDir dir;
    { const auto store = open_store(dir); }
    auto db = must(Db::open(dir / "axisgate.db", Db::Mode::read_write));
    EXPECT_EQ(must(db->text("PRAGMA journal_mode")), "wal");  // kept in the file
    EXPECT_EQ(must(db->integer("PRAGMA application_id")), application_id);
    EXPECT_EQ(must(db->integer("PRAGMA user_version")), static_cast<int>(program_migrations().size()));
    EXPECT_EQ(must(db->integer("SELECT count(*) FROM pragma_table_list WHERE schema = 'main' AND strict = 0 AND name NOT LIKE 'sqlite%'")),
              0);
    EXPECT_GT(must(db->integer("SELECT count(*) FROM pragma_table_list WHERE schema = 'main' AND strict = 1")), 8);
}

TEST(Open, ASecondProcessIsRefusedAndLetInAfterwards) {
    const TempDir dir;
    {
        const auto store = open_store(dir);
        const auto options = options_for(dir.path());
        const pid_t child = ::fork();
        if (child == 0) {
            const auto second = Store::open(options);
            ::_exit(second ? 1 : second.error().kind == Kind::in_use ? 0 : 2);
        }
        int status = -1;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        EXPECT_EQ(status, 0);
        // Also within one process: the lock belongs to the opened file, not to the process.
        const auto error = refused(Store::open(options));
        EXPECT_EQ(error.kind, Kind::in_use);
        EXPECT_THAT(error.text, HasSubstr("process " + std::to_string(::getpid())));
        EXPECT_THAT(error.text, HasSubstr("--data"));
        must(commit_one(*store, a_write("feeder", "AC", std::int64_t{1})));  // the first one is not disturbed
    }
    EXPECT_NE(open_store(dir), nullptr);
}

TEST(Open, ALockFileThatACrashLeftDoesNotKeepAnyoneOut) {
    const TempDir dir;
    write_file(dir / "axisgate.lock", "99999999\n");
    EXPECT_NE(open_store(dir), nullptr);
}

TEST(Open, WhatAnInterruptedFirstStartLeftIsCleared) {
    const TempDir dir;
    write_file(dir / "axisgate.db.new", "half a database");
    write_file(dir / "axisgate.db.new-journal", "half a journal");
    const auto store = open_store(dir);
    ASSERT_NE(store, nullptr);
    EXPECT_THAT(names_in(dir.path()), testing::Not(testing::Contains(testing::StartsWith("axisgate.db.new"))));
}

TEST(Open, DirectoryThatCannotBe) {
    const TempDir dir;
    write_file(dir / "file", "x");
    const auto error = refused(Store::open(options_for(dir / "file")));
    EXPECT_EQ(error.kind, Kind::cannot_open);
    EXPECT_THAT(error.text, HasSubstr(dir / "file"));
    EXPECT_EQ(refused(Store::open(options_for(dir / "file/below"))).kind, Kind::cannot_open);
    const auto nothing = refused(Store::open(options_for("/proc/axisgate/var")));  // a place where nobody can make a directory
    EXPECT_THAT(nothing.text, HasSubstr("/proc/axisgate"));
}

TEST(Open, WithoutMigrationsIsAFaultOfTheProgram) {
    const TempDir dir;
    StoreOptions o;
    o.directory = dir.path();
    EXPECT_EQ(refused(Store::open(o)).kind, Kind::internal);
    EXPECT_TRUE(names_in(dir.path()).empty());
}

// --- files that are refused: said why and what to do, and not changed by a byte ------------------------------------------------

struct Damage {
    const char* name;
    void (*inflict)(const std::string& file);
    Kind kind;
    const char* word;  // of the reason
    const char* remedy;
};
const auto restore_it = "axisgate restore FILE";

const Damage damages[] = {
    {"zero_length", [](const std::string& f) { write_file(f, ""); }, Kind::corrupt, "is empty", restore_it},
    {"text_file", [](const std::string& f) { write_file(f, std::string(20000, 'x')); }, Kind::corrupt, "damaged or not a database",
     restore_it},
    {"short_garbage", [](const std::string& f) { write_file(f, "SQLite format 3"); }, Kind::corrupt, "damaged or not a database",
     restore_it},
    {"cut_in_half", [](const std::string& f) { std::filesystem::resize_file(f, std::filesystem::file_size(f) / 8192 * 4096); },
     Kind::corrupt, "damaged", restore_it},
    {"one_page_lost",
     [](const std::string& f) {
         std::string c = content_of(f);
         c.replace(c.size() / 8192 * 4096, 4096, std::string(4096, '\xFF'));
         write_file(f, c);
     },
     Kind::corrupt, "damaged", restore_it},
    {"other_program",
     [](const std::string& f) {
         std::filesystem::remove(f);
         write_file(f, "");
         meddle(f, "CREATE TABLE contacts (name TEXT); INSERT INTO contacts VALUES ('somebody')");
     },
     Kind::not_ours, "not one of axisgate", "move this one away"},
    {"newer_version", [](const std::string& f) { meddle(f, "PRAGMA user_version=9"); }, Kind::newer,
     "of version 9, this program knows versions up to", "Install the newer axisgate"},
    {"newer_version_in_the_log", [](const std::string& f) { meddle(f, "PRAGMA user_version=9", true); }, Kind::newer, "of version 9",
     "Install the newer"},
    {"table_dropped", [](const std::string& f) { meddle(f, "DROP TABLE parameter_seen"); }, Kind::corrupt, "of table parameter_seen",
     restore_it},
    {"column_dropped", [](const std::string& f) { meddle(f, "ALTER TABLE event DROP COLUMN who"); }, Kind::corrupt, "column who",
     restore_it},
    {"index_dropped", [](const std::string& f) { meddle(f, "DROP INDEX event_by_time"); }, Kind::corrupt, "index event_by_time",
     restore_it},
    {"trigger_made", [](const std::string& f) { meddle(f, "CREATE TRIGGER t AFTER INSERT ON event BEGIN DELETE FROM site_revision; END"); },
     Kind::corrupt, "trigger", "DROP TRIGGER"},
};

class Refused : public testing::TestWithParam<Damage> {};

TEST_P(Refused, IsSaidAndLeftAsItIs) {
    const TempDir dir;
    const std::string file = dir / "axisgate.db";
    {
        const auto store = open_store(dir);
        std::vector<ParameterWrite> writes;
        for (int i = 0; i < 500; ++i)
            writes.push_back(a_write("feeder", "N[" + std::to_string(i) + "]", std::int64_t{i}));
        must(store->commit(writes));
        must(store->save_site("{}", "test", 1));
    }
    GetParam().inflict(file);
    const auto before = content_of_directory(dir.path());
    const auto error = refused(Store::open(options_for(dir.path())));
    EXPECT_EQ(error.kind, GetParam().kind) << error.text;
    EXPECT_THAT(error.text, HasSubstr(file));
    EXPECT_THAT(error.text, HasSubstr(GetParam().word));
    EXPECT_THAT(error.text, HasSubstr(GetParam().remedy));
    auto after = content_of_directory(dir.path());
    if (after["axisgate.db-wal"].empty()) after.erase("axisgate.db-wal");  // SQLite makes an empty one to look
    EXPECT_TRUE(before == after) << "the refused file was changed";
}
INSTANTIATE_TEST_SUITE_P(Store, Refused, testing::ValuesIn(damages), [](const auto& i) { return std::string(i.param.name); });

TEST(Open, ALogWithoutItsDatabaseIsRefused) {
    const TempDir dir;
    write_file(dir / "axisgate.db-wal", "frames of a database that is gone");
    const auto before = content_of_directory(dir.path());
    const auto error = refused(Store::open(options_for(dir.path())));
    EXPECT_EQ(error.kind, Kind::corrupt);
    EXPECT_THAT(error.text, HasSubstr("axisgate.db-wal"));
    EXPECT_THAT(error.text, HasSubstr("move the log away"));
    EXPECT_EQ(content_of_directory(dir.path()), before);
}

TEST(Open, ADamagedLogCostsOnlyWhatWasNeverAcknowledged) {
    const TempDir dir;
    {
        const auto store = open_store(dir);
        must(commit_one(*store, a_write("feeder", "AC", std::int64_t{7})));
    }
    write_file(dir / "axisgate.db-wal", std::string(9000, '\x5A'));  // garbage after a crash: no frame of it has a good checksum
    const auto store = open_store(dir);
    ASSERT_NE(store, nullptr);
    EXPECT_EQ(must(store->stored("feeder", "AC"))->value, Value{std::int64_t{7}});
}

TEST(Open, MoreIndexesThanOursDoNoHarm) {
    const TempDir dir;
    { const auto store = open_store(dir); }
    meddle(dir / "axisgate.db", "CREATE INDEX mine ON event (kind); CREATE TABLE notes (text TEXT)");
    EXPECT_NE(open_store(dir), nullptr);
}

// --- readers -------------------------------------------------------------------------------------------------------------------

TEST(Reader, WithoutADatabase) {
    const TempDir dir;
    const auto error = refused(StoreReader::open(options_for(dir.path())));
    EXPECT_EQ(error.kind, Kind::not_found);
    EXPECT_THAT(error.text, HasSubstr("Start the service once"));
}

TEST(Reader, SeesWhatTheWriterCommitsAndMayNotWrite) {
    const TempDir dir;
    const auto store = open_store(dir);
    const auto reader = must(StoreReader::open(options_for(dir.path())));
    EXPECT_FALSE(must(reader->stored("feeder", "AC")));
    must(commit_one(*store, a_write("feeder", "AC", std::int64_t{7})));
    EXPECT_EQ(must(reader->stored("feeder", "AC"))->value, Value{std::int64_t{7}});
}

TEST(Reader, WorksWithoutTheService) {
    const TempDir dir;
    {
        const auto store = open_store(dir);
        must(commit_one(*store, a_write("feeder", "AC", std::int64_t{7})));
    }
    const auto reader = must(StoreReader::open(options_for(dir.path())));
    EXPECT_EQ(must(reader->stored("feeder", "AC"))->value, Value{std::int64_t{7}});
}

TEST(Reader, OlderAndNewerDatabases) {
    const TempDir dir;
    { const auto store = open_store(dir); }
    auto two = options_for(dir.path());
    two.migrations.push_back({static_cast<int>(two.migrations.size()) + 1, "0099_test.sql", "CREATE TABLE more (x INTEGER) STRICT"});
    EXPECT_EQ(refused(StoreReader::open(two)).kind, Kind::invalid);
    { const auto store = open_store(two); }
    EXPECT_EQ(refused(StoreReader::open(options_for(dir.path()))).kind, Kind::newer);
    EXPECT_TRUE(StoreReader::open(two));
}

}  // namespace
}  // namespace axisgate::test
