// The limit per cause, and the journal's datagrams, received by a socket of the test.
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "gateway/runtime/journal.hpp"
#include "gateway/runtime/log.hpp"
#include "gateway/runtime/log_limit.hpp"

namespace axisgate::log_test {

TEST(LogLimit, OneCauseWritesSoOftenAndIsThenCounted) {
    LogLimit limit;
    Instant now = at_ns(1'000'000'000);
    std::uint64_t written = 0;
    for (int i = 0; i < 1000; ++i, now += std::chrono::milliseconds(1)) {
        EXPECT_TRUE(limit.ended(now).empty());
        written += limit.allows("line can0", now) ? 1 : 0;
        EXPECT_EQ(limit.allows("drive feeder", now), i < static_cast<int>(LogLimit::at_once)) << "each cause by itself";
    }
    EXPECT_EQ(written, LogLimit::at_once);
    now += LogLimit::period;
    const auto published = limit.ended(now);
    ASSERT_EQ(published.size(), 2u);
    EXPECT_EQ(published[0].cause, "drive feeder");
    EXPECT_EQ(published[1].cause, "line can0");
    EXPECT_EQ(published[1].lines, 1000 - LogLimit::at_once);
    EXPECT_TRUE(limit.ended(now + std::chrono::minutes(1)).empty()) << "told once";
    EXPECT_TRUE(limit.allows("line can0", now)) << "a new period";
}

TEST(LogLimit, AStormOfCausesIsBounded) {
    LogLimit limit;
    const Instant now = at_ns(1'000'000'000);
    std::uint64_t written = 0;
    for (int i = 0; i < 100'000; ++i)
        written += limit.allows("cause " + std::to_string(i), now) ? 1 : 0;
    EXPECT_EQ(written, LogLimit::most_causes + LogLimit::at_once);
    EXPECT_LE(limit.ended(now + LogLimit::period).size(), 1u);
}

struct JournalTest : testing::Test {
    JournalTest() : path(std::filesystem::temp_directory_path() / ("axisgate-journal-" + std::to_string(::getpid()))) {
        std::filesystem::remove(path);
        fd = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
        sockaddr_un a{};
        a.sun_family = AF_UNIX;
        std::strncpy(a.sun_path, path.c_str(), sizeof a.sun_path - 1);
        EXPECT_EQ(::bind(fd, reinterpret_cast<const sockaddr*>(&a), sizeof a), 0);
    }
    ~JournalTest() override {
        ::close(fd);
        std::filesystem::remove(path);
    }
    std::string received() {
        std::array<char, 70'000> b{};
        const auto n = ::recv(fd, b.data(), b.size(), MSG_DONTWAIT);
        return n > 0 ? std::string(b.data(), static_cast<std::size_t>(n)) : "";
    }
    std::filesystem::path path;
    int fd = -1;
};

TEST_F(JournalTest, AnEventHasAFieldForEachOfItsParts) {
    const Journal journal(path.string());
    const Journal::Field fields[] = {{"AXISGATE_AXIS", "feeder"}, {"AXISGATE_WHO", ""}, {"AXISGATE_KIND", "alarm"}};
    EXPECT_TRUE(journal.send(3, "alarm: hot", fields));
    EXPECT_EQ(received(), "MESSAGE=alarm: hot\nPRIORITY=3\nSYSLOG_IDENTIFIER=axisgate\nAXISGATE_AXIS=feeder\nAXISGATE_KIND=alarm\n");
}

TEST_F(JournalTest, AMessageOfSeveralLinesCannotForgeAField) {
    const Journal journal(path.string());
    EXPECT_TRUE(journal.send(6, "one\nPRIORITY=0"));
    const std::string expected =
        std::string("MESSAGE\n") + std::string("\x0E\0\0\0\0\0\0\0", 8) + "one\nPRIORITY=0\nPRIORITY=6\nSYSLOG_IDENTIFIER=axisgate\n";
    EXPECT_EQ(received(), expected);
    EXPECT_TRUE(journal.send(6, std::string(1u << 20, 'x')));
    EXPECT_LT(received().size(), 64u << 10);
}

TEST_F(JournalTest, AJournalThatIsNotThereCostsNothing) {
    const Journal none("/nowhere/socket");
    EXPECT_FALSE(none.send(3, "text"));
    const Journal gone(path.string());
    ::close(fd);
    std::filesystem::remove(path);
    EXPECT_FALSE(gone.send(3, "text"));
    fd = -1;
}

TEST(Journal, StandardErrorIsTheJournalWhereTheManagerSaysSo) {
    struct stat what {};
    ASSERT_EQ(::fstat(STDERR_FILENO, &what), 0);
    const char* before = std::getenv("JOURNAL_STREAM");
    const std::string kept = before ? before : "";
    ::unsetenv("JOURNAL_STREAM");
    EXPECT_FALSE(Journal::is_standard_error());
    ::setenv("JOURNAL_STREAM", (std::to_string(what.st_dev) + ":" + std::to_string(what.st_ino)).c_str(), 1);
    EXPECT_TRUE(Journal::is_standard_error());
    for (const auto* wrong : {"", ":", "1", "1:2", "x:y"}) {
        ::setenv("JOURNAL_STREAM", wrong, 1);
        EXPECT_FALSE(Journal::is_standard_error()) << wrong;
    }
    before ? ::setenv("JOURNAL_STREAM", kept.c_str(), 1) : ::unsetenv("JOURNAL_STREAM");
}

TEST(Log, NamesOfStrangersStayOnTheirLine) {
    const auto path = std::filesystem::temp_directory_path() / ("axisgate-log-" + std::to_string(::getpid()));
    std::filesystem::remove(path);
    Config c;
    c.log_file = path.string();
    spdlog::drop_all();
    ASSERT_TRUE(open_log(c));
    LogListener events;
    Event e;
    e.kind = "fleet";
    e.door = "dds";
    e.who = "yard\n2026-01-01T00:00:00+00:00 error forged";
    e.text = "the gateway \x1b[2Jhall\xff\u202e is in the domain, gr\u00fc\u00dfe";
    events.on_event(e);
    spdlog::warn("a line\r\nand another");
    spdlog::drop_all();
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("none"));
    std::ifstream file(path);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);)
        lines.push_back(line);
    std::filesystem::remove(path);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_NE(lines[0].find(R"(by=dds/yard\n2026)"), std::string::npos) << lines[0];
    EXPECT_NE(lines[0].find("\\x1b[2Jhall\\xff\\u202e is in the domain, gr\u00fc\u00dfe"), std::string::npos) << lines[0];
    EXPECT_NE(lines[1].find(R"(a line\r\nand another)"), std::string::npos) << lines[1];
}

}  // namespace axisgate::log_test
