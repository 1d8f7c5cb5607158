// The link of a PtyLine and its rules, and programs that come and go.
#include "gateway/lines/pty_line.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <termios.h>

#include <filesystem>
#include <fstream>

#include "tests/unit/lines/fixture.hpp"

namespace axisgate {
namespace {

namespace fs = std::filesystem;
using namespace test;
using testing::HasSubstr;

class PtyLineTest : public LineTest {
protected:
    fs::path folder;
    std::string path;
    std::unique_ptr<PtyLine> line;

    void SetUp() override {
        std::string name = fs::temp_directory_path() / "axisgate-pty-XXXXXX";
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder = name;
        path = folder / "drive";
    }
    void TearDown() override {
        line.reset();
        fs::remove_all(folder);
    }
    void make(std::uint32_t baud = 0, const SerialFormat& format = {}) {
        line = std::make_unique<PtyLine>(base(), path, baud, format);
        ASSERT_TRUE(comes_up(*line));
    }
    /// As a program opens a serial port.
    Fd program() {
        Fd f(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
        EXPECT_GE(f.fd, 0) << errno;
        EXPECT_TRUE(until([&] { return status().text.find("opened by a program") != std::string::npos; }));
        return f;
    }
    bool send(const Frame& f, Priority p = Priority::command) { return line->send(f, p, clock.now()); }
    [[nodiscard]] LineStatus status() const { return line->status(clock.now()); }
    bool receives(const Fd& f, const std::string& wanted) {
        std::string all;
        const bool good = until([&] {
            all += f.read();
            return all.size() >= wanted.size();
        });
        EXPECT_EQ(all, wanted);
        return good;
    }
};

TEST_F(PtyLineTest, isASerialPortUnderAChosenName) {
    make();
    ASSERT_TRUE(fs::is_symlink(path));
    EXPECT_THAT(fs::read_symlink(path).string(), HasSubstr("/dev/pts/"));
    EXPECT_THAT(owner.states[0].second, HasSubstr("up as " + path));
    EXPECT_THAT(status().text, HasSubstr("not opened by anybody"));
    const Fd f = program();
    f.write(every_byte());
    ASSERT_TRUE(until([&] { return owner.received().size() >= 256; }));
    EXPECT_EQ(owner.received(), every_byte());  // raw: no byte is translated, and nothing is echoed
    EXPECT_TRUE(send(text(every_byte())));
    EXPECT_TRUE(receives(f, every_byte()));
    EXPECT_EQ(owner.sent.size(), 1u);
    line->close();
    EXPECT_FALSE(fs::exists(fs::symlink_status(path)));
}

TEST_F(PtyLineTest, survivesProgramsThatComeAndGo) {
    make();
    for (int i = 0; i < 4; ++i) {
        Fd f = program();
        f.write("in");
        ASSERT_TRUE(until([&] { return owner.received().size() == static_cast<std::size_t>(2 * (i + 1)); }));
        EXPECT_TRUE(send(text("out")));
        EXPECT_TRUE(receives(f, "out"));
        f.close();
        ASSERT_TRUE(until([&] { return status().text.find("not opened") != std::string::npos; }));
        EXPECT_TRUE(send(text("lost")));  // as on a cable that is not connected
        settle();
    }
    EXPECT_EQ(owner.states.size(), 1u);  // up all the time
    EXPECT_EQ(owner.sent.size(), 8u);
    EXPECT_EQ(status().reopened, 0u);
}

TEST_F(PtyLineTest, theNextProgramMeetsNothingOfTheLastOne) {
    make();
    for (int round = 0; round < 10; ++round) {
        Fd first = program();
        termios t{};
        ASSERT_EQ(::tcgetattr(first.fd, &t), 0);
        t.c_lflag |= ICANON | ECHO;
        t.c_iflag |= ICRNL;
        t.c_oflag |= OPOST | ONLCR;
        ASSERT_EQ(::tcsetattr(first.fd, TCSANOW, &t), 0);
        EXPECT_TRUE(send(text("never read")));
        if (round % 2 == 0) run_for(milliseconds(2));  // time to get from the master's buffer to the slave's
        settle();
        first.close();
        ASSERT_TRUE(until([&] { return status().text.find("not opened") != std::string::npos; }));
        owner.frames.clear();
        const Fd second = program();
        second.write("a\r\n");
        ASSERT_TRUE(until([&] { return owner.received() == "a\r\n"; }));
        EXPECT_EQ(second.read(), "");
    }
}

TEST_F(PtyLineTest, hearsAProgramThatWritesAndLeavesAtOnce) {
    make();
    for (int i = 1; i <= 5; ++i) {
        {
            const Fd f(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
            f.write("ping ");
        }
        ASSERT_TRUE(until([&] { return owner.received().size() == static_cast<std::size_t>(5 * i); }));
        ASSERT_TRUE(until([&] { return status().text.find("not opened") != std::string::npos; }));
    }
}

TEST_F(PtyLineTest, aProgramThatDoesNotReadCostsABoundedQueue) {
    make();
    const Fd f = program();
    const std::string block(Frame::capacity, 'x');
    int refused = 0;
    ASSERT_TRUE(until([&] {
        for (int i = 0; i < 32; ++i)
            refused += send(text(block)) ? 0 : 1;
        settle();
        return refused >= 64;
    }));
    EXPECT_GE(status().dropped, 64u);
    EXPECT_EQ(status().queued, 256u);
    std::size_t read = 0;
    EXPECT_TRUE(until([&] {
        read += f.read().size();
        return status().queued == 0;
    }));
    EXPECT_GT(read, 10'000u);
    EXPECT_TRUE(owner.up());
}

TEST_F(PtyLineTest, overwritesOnlyLinks) {
    std::ofstream(path) << "precious";
    line = std::make_unique<PtyLine>(base(), path);
    line->open(owner, clock.now());
    ASSERT_TRUE(until([&] { return !owner.states.empty(); }));
    EXPECT_FALSE(owner.up());
    EXPECT_THAT(status().text, HasSubstr("exists and is not a link"));
    std::string content;
    std::ifstream(path) >> content;
    EXPECT_EQ(content, "precious");
    fs::remove(path);
    EXPECT_TRUE(until([&] { return owner.up(); }));
    line->close();

    fs::create_directory(path);
    owner.states.clear();
    line->open(owner, clock.now());
    ASSERT_TRUE(until([&] { return !owner.states.empty(); }));
    EXPECT_FALSE(owner.up());
    EXPECT_TRUE(fs::is_directory(path));
}

TEST_F(PtyLineTest, replacesALinkThatWasLeftOver) {
    fs::create_symlink("/dev/pts/999999", path);
    make();
    EXPECT_NE(fs::read_symlink(path), "/dev/pts/999999");
    const Fd f = program();
    f.write("x");
    EXPECT_TRUE(until([&] { return owner.received() == "x"; }));
}

TEST_F(PtyLineTest, aLinkToAnythingElseStays) {
    std::ofstream(folder / "precious") << "precious";
    for (const std::string& target :
         {(folder / "precious").string(), std::string("/dev/null"), std::string("/dev/pts"), std::string("/dev/pts/"),
          std::string("/dev/pts/../null"), std::string("/dev/pts/1x"), std::string("nowhere")}) {
        fs::create_symlink(target, path);
        line = std::make_unique<PtyLine>(base(), path);
        owner.states.clear();
        line->open(owner, clock.now());
        ASSERT_TRUE(until([&] { return !owner.states.empty(); })) << target;
        EXPECT_FALSE(owner.up()) << target;
        EXPECT_THAT(status().text, HasSubstr("a link to something else than a pseudo-terminal")) << target;
        line.reset();
        EXPECT_EQ(fs::read_symlink(path), target);
        fs::remove(path);
    }
}

TEST_F(PtyLineTest, aSiteLinksBelowItsFolderAlone) {
    const fs::path allowed = folder / "lines", data = allowed / "data";
    fs::create_directories(data / "deep");
    fs::create_directories(allowed / "sub");
    fs::create_directories(folder / "lines-too");
    fs::create_directory_symlink(folder, allowed / "out");
    fs::create_directory_symlink(data, folder / "lines" / "in");
    const PtyPlaces places{allowed, data};
    const auto tried = [&](const fs::path& at) {
        line = std::make_unique<PtyLine>(base(), at, 0, SerialFormat{}, places);
        owner.states.clear();
        line->open(owner, clock.now());
        EXPECT_TRUE(until([&] { return !owner.states.empty(); })) << at;
        const std::string text = owner.up() ? "up" : status().text;
        line.reset();
        return text;
    };
    for (const auto& good : {allowed / "a", allowed / "sub" / "a", allowed / "sub" / ".." / "a"})
        EXPECT_EQ(tried(good), "up") << good;
    for (const auto& bad : {folder / "a", folder / "lines-too" / "a", allowed / "out" / "a", allowed / "sub" / ".." / ".." / "a",
                            fs::path("/a"), fs::path("a")})
        EXPECT_THAT(tried(bad), HasSubstr("pty_dir")) << bad;
    for (const auto& bad : {data / "a", data / "deep" / "a", allowed / "in" / "a"})
        EXPECT_THAT(tried(bad), HasSubstr("data directory")) << bad;
    EXPECT_FALSE(fs::exists(fs::symlink_status(folder / "a")));
    fs::remove(allowed / "out");
    fs::rename(allowed, folder / "gone");
    EXPECT_THAT(tried(folder / "a"), HasSubstr("is not there")) << "the folder must be made by whoever owns the machine";
}

TEST_F(PtyLineTest, takesAwayOnlyItsOwnLink) {
    make();
    fs::remove(path);
    fs::create_symlink("/dev/null", path);  // it belongs to another program by now
    line->close();
    EXPECT_TRUE(fs::is_symlink(path));
}

TEST_F(PtyLineTest, saysThatTheFolderIsMissing) {
    path = folder / "no" / "such" / "folder";
    line = std::make_unique<PtyLine>(base(), path);
    line->open(owner, clock.now());
    ASSERT_TRUE(until([&] { return !owner.states.empty(); }));
    EXPECT_THAT(owner.states[0].second, HasSubstr("does its folder exist"));
}

TEST_F(PtyLineTest, mayBeDestroyedFromItsEvents) {
    make();
    const Fd f = program();
    owner.on_received = [&](const Frame&) { line.reset(); };
    f.write("bye");
    ASSERT_TRUE(until([&] { return line == nullptr; }));
    settle();
    EXPECT_FALSE(fs::exists(fs::symlink_status(path)));
}

/// 48 bytes of 7N1 at 9600 baud: 45 ms.
constexpr SerialFormat paced{7, Parity::none, 1};
const std::string paced_text(48, 'x');
constexpr Duration paced_time = milliseconds(45);

TEST_F(PtyLineTest, withAPaceBytesTakeTheirTimeOut) {
    make(9600, paced);
    EXPECT_THAT(status().text, HasSubstr("at the pace of 9600 baud 7N1"));
    const Fd f = program();
    const Instant begun = clock.now();
    ASSERT_TRUE(send(text(paced_text)));
    ASSERT_TRUE(receives(f, paced_text));
    EXPECT_GE(clock.now() - begun, paced_time);
    ASSERT_TRUE(until([&] { return !owner.sent.empty(); }));
    EXPECT_GE(owner.sent[0].at - begun, paced_time) << "a frame is sent when its last byte is out";
    EXPECT_GT(status().load, 0.0);
}

TEST_F(PtyLineTest, withAPaceBytesTakeTheirTimeIn) {
    make(9600, paced);
    const Fd f = program();
    const Instant begun = clock.now();
    f.write(paced_text);
    ASSERT_TRUE(until([&] { return owner.received().size() >= paced_text.size(); }));
    EXPECT_EQ(owner.received(), paced_text);
    EXPECT_GE(owner.frames.back().at - begun, paced_time);
    EXPECT_EQ(status().bytes_in, paced_text.size());
    EXPECT_GT(status().load, 0.0);
}

TEST_F(PtyLineTest, bytesAreStampedWithTheirTimeOnTheWireHoweverLateTheyAreRead) {
    make(9600, paced);
    const Fd f = program();
    const Duration byte = paced_time / static_cast<std::int64_t>(paced_text.size());
    f.write(paced_text);
    ASSERT_TRUE(until([&] { return !owner.frames.empty(); }));
    clock.ahead += milliseconds(500);  // this process did not run, and the writer continued
    ASSERT_TRUE(until([&] { return owner.received().size() >= paced_text.size(); }));
    EXPECT_EQ(owner.received(), paced_text);
    ASSERT_GT(owner.frames.size(), 10u) << "runs of what has crossed together";
    for (std::size_t i = 1; i < owner.frames.size(); ++i)
        EXPECT_GE(owner.frames[i].at - owner.frames[i - 1].at, byte * owner.frames[i].size - std::chrono::microseconds(1)) << "frame " << i;
    EXPECT_LE(owner.frames.back().at, clock.now());
}

TEST_F(PtyLineTest, anUrgentFrameOvertakesWhatWaitsBehindThePace) {
    make(9600, paced);
    const Fd f = program();
    ASSERT_TRUE(send(text("aaaaaaaaaa"), Priority::poll));
    ASSERT_TRUE(send(text("bbbbbbbbbb"), Priority::poll));
    std::string got;
    ASSERT_TRUE(until([&] {
        got += f.read();
        return !got.empty();
    }));
    ASSERT_TRUE(send(text("SSSS"), Priority::urgent));
    ASSERT_TRUE(until([&] {
        got += f.read();
        return got.size() >= 24;
    }));
    EXPECT_EQ(got, "aaaaaaaaaaSSSSbbbbbbbbbb") << "the frame that is half out is finished first";
}

TEST_F(PtyLineTest, whoWritesMoreThanThePaceCarriesIsHeldUpAndLosesNothing) {
    make(4'000'000);
    const Fd f = program();
    const std::string much(20'000, 'y');
    std::size_t written = 0;
    bool held = false;
    ASSERT_TRUE(until([&] {
        if (written < much.size()) {
            const ssize_t n = ::write(f.fd, much.data() + written, much.size() - written);
            if (n > 0) written += static_cast<std::size_t>(n);
            held = held || n < 0 || written < much.size();
        }
        return owner.received().size() >= much.size();
    }));
    EXPECT_TRUE(held);
    EXPECT_EQ(owner.received(), much);
}

/// The drive's messages are complete, however long a slow line takes for them.
class PtyLineAge : public PtyLineTest, public testing::WithParamInterface<bool> {};

TEST_P(PtyLineAge, withoutALimitWhatWaitsIsSentWhole) {
    const bool limit = GetParam();
    LineBase b = base();
    if (!limit) b.stale_after = Duration::zero();
    line = std::make_unique<PtyLine>(b, path, 9600, paced);
    ASSERT_TRUE(comes_up(*line));
    const Fd f = program();
    for (int i = 0; i < 12; ++i)
        ASSERT_TRUE(send(text("0123456789")));
    settle();
    clock.ahead += stale_send_limit + milliseconds(500);
    std::string all;
    (void)until([&] {
        clock.ahead += milliseconds(20);
        all += f.read();
        return status().queued == 0 && all.size() >= (limit ? 0U : 120U);
    });
    EXPECT_EQ(all.size() == 120U, !limit) << all.size();
    EXPECT_EQ(status().dropped == 0U, !limit);
}

INSTANTIATE_TEST_SUITE_P(Limits, PtyLineAge, testing::Bool(), [](const auto& i) { return std::string(i.param ? "with" : "without"); });

TEST_F(PtyLineTest, aProgramThatLeavesTakesAlongWhatWasStillOnItsWay) {
    make(9600, paced);
    {
        const Fd f = program();
        ASSERT_TRUE(send(text(paced_text)));
        ASSERT_TRUE(until([&] { return !f.read().empty(); }));
    }
    ASSERT_TRUE(until([&] { return status().text.find("not opened") != std::string::npos; }));
    const Fd f = program();
    ASSERT_TRUE(send(text("new")));
    EXPECT_TRUE(receives(f, "new"));
}

}  // namespace
}  // namespace axisgate
