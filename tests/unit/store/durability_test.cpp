// Acknowledged data are present after the process is killed, and after the power is cut, at any moment.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>

#include <random>

#include "tests/unit/store/fault_vfs.hpp"
#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {

TEST(Durability, EveryAcknowledgedWriteOutlivesSigkill) {
    std::mt19937 random(20'240'117);
    const TempDir dir;
    auto options = options_for(dir.path());
    options.limits.parameter_writes = 40;  // pruning goes on meanwhile
    std::int64_t acknowledged = 0;
    for (int round = 0; round < 12; ++round) {
        int pipe_ends[2];
        ASSERT_EQ(::pipe2(pipe_ends, O_CLOEXEC), 0);
        const pid_t child = ::fork();
        if (child == 0) {
            const auto opened = Store::open(options);
            if (!opened) ::_exit(2);
            auto& store = **opened;
            for (std::int64_t i = acknowledged + 1;; ++i) {
                // Two values that belong together, and an event.
                const std::vector writes{a_write("feeder", "AC", i, i), a_write("feeder", "DC", i, i)};
                const Event event = an_event("write", "feeder", i);
                if (!store.commit({writes, std::span(&event, 1), {}})) ::_exit(3);
                if (::write(pipe_ends[1], &i, sizeof i) != sizeof i) ::_exit(0);
            }
        }
        ::close(pipe_ends[1]);
        // The child continues while this side counts; where it is when the signal arrives is random.
        const auto until = static_cast<unsigned>(random() % 60);
        std::int64_t number = 0;
        for (unsigned k = 0; k < until && ::read(pipe_ends[0], &number, sizeof number) == sizeof number; ++k)
            acknowledged = number;
        ::kill(child, SIGKILL);
        while (::read(pipe_ends[0], &number, sizeof number) == sizeof number)
            acknowledged = number;
        ::close(pipe_ends[0]);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        ASSERT_TRUE(WIFSIGNALED(status)) << "the child ended by itself with " << WEXITSTATUS(status);

        const auto store = open_store(options);
        ASSERT_NE(store, nullptr);
        must(store->check());
        const auto ac = must(store->stored("feeder", "AC"));
        const auto dc = must(store->stored("feeder", "DC"));
        const std::int64_t found = ac ? std::get<std::int64_t>(ac->value) : 0;
        EXPECT_GE(found, acknowledged) << "round " << round;
        EXPECT_LE(found, acknowledged + 1) << "round " << round;  // at most the one that could not be acknowledged any more
        EXPECT_EQ(found, dc ? std::get<std::int64_t>(dc->value) : 0);
        EXPECT_EQ(must(store->last_event_id()), static_cast<std::uint64_t>(found));
        acknowledged = found;
    }
    EXPECT_GT(acknowledged, 12);
}

TEST(Durability, EveryAcknowledgedWriteOutlivesAPowerCut) {
    std::mt19937 random(7);
    int cuts = 0;
    int in_flight_kept = 0;
    for (int life = 0; life < 4; ++life) {
        FaultVfs vfs;
        FaultVfs no_wait;
        const TempDir dir;
        auto options = options_for(dir.path());
        options.vfs = vfs.name();
        options.limits.parameter_writes = 30;
        auto store = open_store(options);
        vfs.remember(dir.path());
        const auto look = [&](std::int64_t least, std::int64_t most) {
            const TempDir after;
            vfs.power_cut(after.path(), random);
            auto looking = options_for(after.path());
            looking.vfs = no_wait.name();
            const auto again = open_store(looking);
            ASSERT_NE(again, nullptr);
            must(again->check());
            const auto ac = must(again->stored("feeder", "AC"));
            const auto text = must(again->stored("feeder", "TEXT"));
            const std::int64_t found = ac ? std::get<std::int64_t>(ac->value) : 0;
            ASSERT_GE(found, least);
            ASSERT_LE(found, most);
            if (text) {
                ASSERT_EQ(std::get<std::string>(text->value),
                          std::string(6000, static_cast<char>('a' + found % 26)));  // never half a batch
            }
            if (found > least) ++in_flight_kept;
            ++cuts;
        };
        std::int64_t now = 0;
        for (int i = 0; i < 40; ++i) {
            const std::int64_t next = now + 1;
            const std::vector writes{a_write("feeder", "AC", next),
                                     a_write("feeder", "TEXT", std::string(6000, static_cast<char>('a' + next % 26)))};
            if (random() % 3 == 0) {
                // The cut comes inside the commit or the checkpoint: from some call on the disk does not answer any more.
                if (random() % 2 == 0) {
                    vfs.fail(FaultVfs::write | FaultVfs::sync | FaultVfs::truncate, SQLITE_IOERR, EIO, random() % 40);
                } else {
                    vfs.fail(FaultVfs::sync, SQLITE_IOERR_FSYNC, EIO,
                             random() % 3);  // everything is written, and a random part of it is on the disk
                }
                const auto r = store->commit(writes);
                const auto t = random() % 2 == 0 ? store->tidy() : StoreResult<>{};
                static_cast<void>(t);
                look(r ? next : now, next);
                vfs.heal();
                if (r) now = next;
                // The machine is off: this process continues from the disk's content only for simplicity, so a new log begins.
                store.reset();
                store = open_store(options);
                vfs.remember(dir.path());
                const auto stored = must(store->stored("feeder", "AC"));
                now = stored ? std::get<std::int64_t>(stored->value) : 0;
                continue;
            }
            must(store->commit(writes));
            now = next;
            if (random() % 3 == 0) must(store->tidy());  // a checkpoint moves pages into the file
            look(now, now);
        }
    }
    EXPECT_EQ(cuts, 160);
    EXPECT_GT(in_flight_kept, 0);  // some cuts fell inside a commit whose rows had reached the disk
}

}  // namespace
}  // namespace axisgate::test
