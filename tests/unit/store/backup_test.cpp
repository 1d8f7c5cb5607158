// Complete copies or none, only checked files replace others, and a crash during a restore leaves one of the two databases.
#include <sys/stat.h>

#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {
using testing::HasSubstr;
using testing::Not;

void fill(Store& store, std::int64_t value) {
    must(commit_one(store, a_write("feeder", "AC", value)));
    must(store.save_site("site " + std::to_string(value), "test", value));
}
std::int64_t value_in(const std::string& directory) {
    const auto store = open_store(options_for(directory));
    if (!store) return -1;
    must(store->check());
    const auto r = must(store->stored("feeder", "AC"));
    return r ? std::get<std::int64_t>(r->value) : 0;
}

TEST(Backup, IsACopyOfWhatIsCommittedWhileTheStoreIsOpen) {
    const TempDir dir;
    const TempDir other;
    const auto store = open_store(dir);
    fill(*store, 7);  // still in the log
    must(store->backup(other / "b.db"));
    fill(*store, 8);
    struct stat st {};
    ASSERT_EQ(::stat((other / "b.db").c_str(), &st), 0);
    EXPECT_EQ(st.st_mode & 07777, 0640u);
    EXPECT_THAT(names_in(other.path()), testing::ElementsAre("b.db"));  // no part, no log
    const TempDir fresh;
    const auto report = must(restore_database(other / "b.db", options_for(fresh / "var")));
    EXPECT_EQ(report.kept, "");
    EXPECT_EQ(report.version, static_cast<int>(program_migrations().size()));
    EXPECT_EQ(value_in(fresh / "var"), 7);
    must(store->backup(other / "b.db"));  // the same name again: the newer one replaces it
    must(restore_database(other / "b.db", options_for(fresh / "var")));
    EXPECT_EQ(value_in(fresh / "var"), 8);
}

TEST(Backup, WorksFromAnotherReaderAndWithoutTheService) {
    const TempDir dir;
    {
        const auto store = open_store(dir);
        fill(*store, 7);
    }
    must(backup_database(dir.path(), dir / "copy.db"));
    const auto reader = must(StoreReader::open(options_for(dir.path())));
    must(reader->backup(dir / "copy2.db"));
    const TempDir fresh;
    must(restore_database(dir / "copy2.db", options_for(fresh.path())));
    EXPECT_EQ(value_in(fresh.path()), 7);
}

TEST(Backup, RefusesTargetsThatWouldDestroySomething) {
    const TempDir dir;
    const auto store = open_store(dir);
    fill(*store, 7);
    std::filesystem::create_directory(dir / "folder");
    std::filesystem::create_symlink(dir / "axisgate.db", dir / "link.db");
    for (const std::string& target : {dir / "axisgate.db", dir / "axisgate.db-wal", dir / "axisgate.lock", dir / "folder/../axisgate.db",
                                      dir / "link.db", dir / "folder", dir / "folder/", std::string()}) {
        EXPECT_EQ(refused(store->backup(target)).kind, Kind::invalid) << target;
    }
    EXPECT_THAT(refused(store->backup(dir / "folder")).text, HasSubstr("axisgate-backup.db"));
    EXPECT_EQ(refused(store->backup(dir / "missing/b.db")).kind, Kind::cannot_open);
    EXPECT_EQ(refused(backup_database(dir / "missing", dir / "b.db")).kind, Kind::not_found);
    must(store->check());
    fill(*store, 8);
    EXPECT_THAT(names_in(dir.path()), Not(testing::Contains(HasSubstr(".part"))));
}

TEST(Backup, OfADamagedDatabaseLeavesTheOlderBackupAlone) {
    const TempDir dir;
    {
        const auto store = open_store(dir);
        std::vector<ParameterWrite> writes;
        for (int i = 0; i < 500; ++i)
            writes.push_back(a_write("feeder", "N[" + std::to_string(i) + "]", std::int64_t{i}));
        must(store->commit(writes));
        must(store->backup(dir / "good.db"));
    }
    std::string c = content_of(dir / "axisgate.db");
    for (std::size_t at = 8192; at + 4096 <= c.size(); at += 4096)
        c.replace(at, 4096, std::string(4096, '\xFF'));
    write_file(dir / "axisgate.db", c);
    const auto good = content_of(dir / "good.db");
    EXPECT_EQ(refused(backup_database(dir.path(), dir / "good.db")).kind, Kind::corrupt);
    EXPECT_EQ(content_of(dir / "good.db"), good);
    EXPECT_THAT(names_in(dir.path()), Not(testing::Contains(HasSubstr(".part"))));
}

class Restore : public testing::Test {
protected:
    Restore() {
        const TempDir other;
        const auto source = open_store(other);
        fill(*source, 7);
        must(source->backup(backup_));
        const auto store = open_store(dir_);
        fill(*store, 1);
    }
    TempDir shelf_;
    TempDir dir_;
    std::string backup_ = shelf_ / "backup.db";
    std::string file_ = dir_ / "axisgate.db";
};

TEST_F(Restore, KeepsWhatItReplaces) {
    const auto report = must(restore_database(backup_, options_for(dir_.path())));
    EXPECT_EQ(report.kept, file_ + ".replaced-1");
    EXPECT_EQ(value_in(dir_.path()), 7);
    must(restore_database(report.kept, options_for(dir_.path())));  // and back
    EXPECT_EQ(value_in(dir_.path()), 1);
    EXPECT_TRUE(std::filesystem::exists(file_ + ".replaced-2"));
    EXPECT_EQ(content_of(backup_).size(), std::filesystem::file_size(backup_));
}

TEST_F(Restore, RepairsADamagedDatabaseAndKeepsTheDamagedOneWithItsLog) {
    write_file(file_, "rubbish");
    write_file(file_ + "-wal", "its log");
    EXPECT_EQ(refused(Store::open(options_for(dir_.path()))).kind, Kind::corrupt);
    must(restore_database(backup_, options_for(dir_.path())));
    EXPECT_EQ(value_in(dir_.path()), 7);
    EXPECT_EQ(content_of(file_ + ".replaced-1"), "rubbish");
    EXPECT_EQ(content_of(file_ + ".replaced-1-wal"), "its log");
}

TEST_F(Restore, IsRefusedWhileTheServiceRuns) {
    const auto store = open_store(dir_);
    const auto error = refused(restore_database(backup_, options_for(dir_.path())));
    EXPECT_EQ(error.kind, Kind::in_use);
    EXPECT_THAT(error.text, HasSubstr("nothing was replaced"));
    EXPECT_EQ(must(store->stored("feeder", "AC"))->value, Value{std::int64_t{1}});
}

TEST_F(Restore, RefusesWhatIsNotAGoodBackupAndReplacesNothing) {
    struct Case {
        const char* name;
        std::function<void(const std::string&)> make;
        Kind kind;
        const char* words = "";
    };
    const std::string good = content_of(backup_);
    const std::vector<Case> cases{
        {"missing", [](const std::string& f) { std::filesystem::remove(f); }, Kind::cannot_open},
        {"folder", [](const std::string& f) { std::filesystem::remove(f), std::filesystem::create_directory(f); }, Kind::cannot_open},
        {"pipe", [](const std::string& f) { std::filesystem::remove(f), ::mkfifo(f.c_str(), 0600); }, Kind::cannot_open},
        {"empty", [](const std::string& f) { write_file(f, ""); }, Kind::corrupt},
        {"text", [](const std::string& f) { write_file(f, std::string(9000, 'x')); }, Kind::corrupt},
        {"one_byte", [](const std::string& f) { write_file(f, "x"); }, Kind::corrupt, "is not a database"},
        {"cut", [&](const std::string& f) { write_file(f, good.substr(0, good.size() / 2)); }, Kind::corrupt},
        {"other_program", [](const std::string& f) { meddle(f, "PRAGMA application_id=5"); }, Kind::not_ours},
        {"newer", [](const std::string& f) { meddle(f, "PRAGMA user_version=99"); }, Kind::newer},
        {"trigger", [](const std::string& f) { meddle(f, "CREATE TRIGGER t AFTER INSERT ON event BEGIN DELETE FROM axis; END"); },
         Kind::corrupt},
        {"table_missing", [](const std::string& f) { meddle(f, "DROP TABLE twin_memory"); }, Kind::corrupt},
        {"dangling_row", [](const std::string& f) { meddle(f, "PRAGMA foreign_keys=OFF; DELETE FROM axis"); }, Kind::corrupt},
        {"itself", [&](const std::string& f) { std::filesystem::remove(f), std::filesystem::create_symlink(file_, f); }, Kind::invalid},
    };
    for (const Case& c : cases) {
        std::filesystem::remove_all(backup_);
        write_file(backup_, good);
        c.make(backup_);
        const auto before = content_of_directory(dir_.path());
        const auto error = refused(restore_database(backup_, options_for(dir_.path())));
        EXPECT_EQ(error.kind, c.kind) << c.name << ": " << error.text;
        EXPECT_THAT(error.text, HasSubstr(backup_)) << c.name;
        EXPECT_THAT(error.text, Not(HasSubstr("incoming"))) << c.name;
        EXPECT_THAT(error.text, HasSubstr(c.words)) << c.name;
        EXPECT_EQ(content_of_directory(dir_.path()), before) << c.name;
    }
    EXPECT_EQ(value_in(dir_.path()), 1);
}

TEST_F(Restore, OfAnOlderVersionIsUpgradedAtTheNextStart) {
    auto next = options_for(dir_.path());
    next.migrations.push_back({static_cast<int>(next.migrations.size()) + 1, "next.sql", "CREATE TABLE more (x INTEGER) STRICT"});
    EXPECT_EQ(must(restore_database(backup_, next)).version, static_cast<int>(next.migrations.size()) - 1);
    const auto store = open_store(next);
    EXPECT_EQ(must(store->facts()).version, static_cast<int>(next.migrations.size()));
    EXPECT_EQ(must(store->stored("feeder", "AC"))->value, Value{std::int64_t{7}});
}

TEST_F(Restore, OfAHandMadeCopyTakesItsLogAlong) {
    const TempDir other;
    const TempDir copy;
    {
        const auto store = open_store(other);
        fill(*store, 33);
        for (const char* suffix : {"", "-wal"})
            std::filesystem::copy_file((other / "axisgate.db") + suffix, (copy / "mine.db") + suffix);
    }
    must(restore_database(copy / "mine.db", options_for(dir_.path())));
    EXPECT_EQ(value_in(dir_.path()), 33);
}

// A restore that ended by a crash after each of its steps: the state that the next start finds, and its result.
TEST_F(Restore, ACrashLeavesTheOldOrTheNewOne) {
    struct Case {
        const char* name;
        std::function<void()> state;
        std::int64_t value;
    };
    const auto move = [this](const std::string& from, const std::string& to) { std::filesystem::rename(file_ + from, file_ + to); };
    const auto copy_as = [this](const std::string& name) { std::filesystem::copy_file(backup_, file_ + name); };
    const std::string old = content_of(file_);
    const std::vector<Case> cases{
        {"while copying",
         [&] { write_file(file_ + ".incoming", content_of(backup_).substr(0, 5000)), write_file(file_ + ".incoming-wal", "x"); }, 1},
        {"copied, not checked", [&] { copy_as(".incoming"); }, 1},
        {"checked", [&] { copy_as(".restored"), write_file(file_ + "-wal", "log of the old one"); }, 7},
        {"log put aside", [&] { copy_as(".restored"), write_file(file_ + ".replaced-1-wal", "log of the old one"); }, 7},
        {"database put aside", [&] { copy_as(".restored"), write_file(file_ + ".replaced-1-wal", "x"), move("", ".replaced-1"); }, 7},
    };
    for (const Case& c : cases) {
        for (const auto& name : names_in(dir_.path()))
            std::filesystem::remove(dir_ / name);
        write_file(file_, old);
        c.state();
        EXPECT_EQ(value_in(dir_.path()), c.value) << c.name;
        EXPECT_FALSE(std::filesystem::exists(file_ + ".restored")) << c.name;
        EXPECT_FALSE(std::filesystem::exists(file_ + ".incoming")) << c.name;
        if (c.value == 7) {
            EXPECT_EQ(content_of(file_ + ".replaced-1"), old) << c.name;
            EXPECT_TRUE(std::filesystem::exists(file_ + ".replaced-1-wal")) << c.name;
            EXPECT_FALSE(std::filesystem::exists(file_ + ".replaced-2")) << c.name;
        }
    }
}

TEST_F(Restore, ReplacedDatabasesAreNotKeptWithoutBound) {
    for (int i = 1; i <= 99; ++i)
        write_file(file_ + ".replaced-" + std::to_string(i), "x");
    const auto error = refused(restore_database(backup_, options_for(dir_.path())));
    EXPECT_EQ(error.kind, Kind::conflict);
    EXPECT_THAT(error.text, HasSubstr("Remove those"));
    EXPECT_FALSE(std::filesystem::exists(file_ + ".restored"));
    std::filesystem::remove(file_ + ".replaced-42");
    EXPECT_EQ(value_in(dir_.path()), 1);
    must(restore_database(backup_, options_for(dir_.path())));
    EXPECT_EQ(value_in(dir_.path()), 7);
    EXPECT_TRUE(std::filesystem::exists(file_ + ".replaced-42"));
}

}  // namespace
}  // namespace axisgate::test
