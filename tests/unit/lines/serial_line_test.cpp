// SerialLine on pseudo-terminals: settings, marks, exclusive use, disconnection. No serial port is needed.
#include "gateway/lines/serial_line.hpp"

#include <gmock/gmock.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <termios.h>

#include <filesystem>

#include "gateway/lines/serial_port.hpp"
#include "tests/unit/lines/fixture.hpp"

namespace axisgate {
namespace {

namespace fs = std::filesystem;
using namespace test;
using testing::HasSubstr;

/// The other end of the cable.
struct Cable {
    Fd master;
    std::string slave;
    Cable() : master(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
        EXPECT_EQ(::grantpt(master.fd), 0);
        EXPECT_EQ(::unlockpt(master.fd), 0);
        std::array<char, 128> name{};
        EXPECT_EQ(::ptsname_r(master.fd, name.data(), name.size()), 0);
        slave = name.data();
    }
};

class SerialLineTest : public LineTest {
protected:
    std::unique_ptr<SerialLine> line;
    fs::path folder;

    void SetUp() override {
        std::string name = fs::temp_directory_path() / "axisgate-serial-XXXXXX";
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder = name;
    }
    void TearDown() override {
        line.reset();
        fs::remove_all(folder);
    }
    void open(const std::string& path, const SerialSettings& settings = {}) {
        line = std::make_unique<SerialLine>(base(), path, settings);
        line->open(owner, clock.now());
        ASSERT_TRUE(until([&] { return !owner.states.empty(); }));
    }
    bool send(const Frame& f, Priority p = Priority::command) { return line->send(f, p, clock.now()); }
    [[nodiscard]] LineStatus status() const { return line->status(clock.now()); }
};

TEST_F(SerialLineTest, carriesEveryByteBothWays) {
    const Cable cable;
    SerialSettings s;
    s.baud = 57600;
    open(cable.slave, s);
    ASSERT_TRUE(owner.up()) << owner.states[0].second;
    EXPECT_EQ(owner.states[0].second, "up on " + cable.slave + " at 57600 bit/s 8N1");
    cable.master.write(every_byte());  // the kernel doubles 377 in this direction: see parity_marks.hpp
    ASSERT_TRUE(until([&] { return owner.received().size() >= 256; }));
    EXPECT_EQ(owner.received(), every_byte());
    EXPECT_TRUE(send(text(every_byte())));
    std::string got;
    ASSERT_TRUE(until([&] {
        got += cable.master.read();
        return got.size() >= 256;
    }));
    EXPECT_EQ(got, every_byte());
    EXPECT_EQ(owner.sent.size(), 1u);
    EXPECT_EQ(status().errors, 0u);
    EXPECT_GT(status().load, 0.03);  // 256 bytes of some 44 ms in each direction
    EXPECT_LT(status().load, 0.06);
}

TEST_F(SerialLineTest, loadOfATwoWirePortIsTheSumOfBothDirections) {
    const Cable cable;
    SerialSettings s;
    s.baud = 57600;
    s.rs485 = Rs485::automatic;
    open(cable.slave, s);
    cable.master.write(every_byte());
    EXPECT_TRUE(send(text(every_byte())));
    ASSERT_TRUE(until([&] { return owner.received().size() >= 256 && !owner.sent.empty(); }));
    EXPECT_GT(status().load, 0.07);
}

TEST_F(SerialLineTest, takesAnyBitRate) {
    const Cable cable;
    for (const std::uint32_t baud : {50u, 9600u, 123'456u, 250'000u, 1'000'000u, 12'000'000u}) {
        SerialSettings s;
        s.baud = baud;
        const SerialOpened opened = open_serial(cable.slave, s);
        ASSERT_GE(opened.fd, 0) << opened.fault;
        EXPECT_THAT(opened.text, HasSubstr(std::to_string(baud) + " bit/s"));
        ::close(opened.fd);
    }
}

TEST_F(SerialLineTest, setsThePortRawAndLocal) {
    const Cable cable;
    SerialSettings s;
    s.rtscts = true;
    const SerialOpened opened = open_serial(cable.slave, s);
    ASSERT_GE(opened.fd, 0);
    EXPECT_THAT(opened.text, HasSubstr("RTS/CTS"));
    termios t{};
    ASSERT_EQ(::tcgetattr(opened.fd, &t), 0);
    EXPECT_EQ(t.c_lflag, 0u);
    EXPECT_EQ(t.c_oflag, 0u);
    EXPECT_EQ(t.c_iflag, static_cast<tcflag_t>(INPCK | PARMRK));
    EXPECT_NE(t.c_cflag & CLOCAL, 0u);
    EXPECT_NE(t.c_cflag & CREAD, 0u);
    EXPECT_NE(t.c_cflag & CRTSCTS, 0u);
    EXPECT_EQ(t.c_cflag & HUPCL, 0u);
    EXPECT_EQ(t.c_cc[VMIN], 0);
    EXPECT_EQ(t.c_cc[VTIME], 0);
    ::close(opened.fd);
}

TEST_F(SerialLineTest, rs485MustBeDoneByTheDriverUnlessItIsAutomatic) {
    const Cable cable;  // the driver of a pseudo-terminal cannot do it
    SerialSettings s;
    s.rs485 = Rs485::on;
    s.rts_after_ms = 1;
    open(cable.slave, s);
    EXPECT_FALSE(owner.up());
    EXPECT_THAT(owner.states[0].second, HasSubstr("cannot turn the direction of RS-485"));
    EXPECT_THAT(owner.states[0].second, HasSubstr("rs485=auto"));
    line.reset();
    owner.states.clear();
    s.rs485 = Rs485::automatic;
    open(cable.slave, s);
    EXPECT_TRUE(owner.up());
    EXPECT_THAT(owner.states[0].second, HasSubstr("RS-485 left to the converter"));
}

TEST_F(SerialLineTest, aSecondUserIsToldThatThePortIsTaken) {
    const Cable cable;
    open(cable.slave);
    ASSERT_TRUE(owner.up());
    SerialLine second(base(), cable.slave, {});
    Owner other;
    second.open(other, clock.now());
    ASSERT_TRUE(until([&] { return !other.states.empty(); }));
    EXPECT_FALSE(other.up());
    EXPECT_THAT(other.states[0].second, HasSubstr("another program uses this port"));
    line->close();
    EXPECT_TRUE(until([&] { return other.up(); }));
}

TEST_F(SerialLineTest, comesBackAfterBeingUnplugged) {
    const std::string path = folder / "ttyUSB7";
    Cable cable;
    fs::create_symlink(cable.slave, path);
    open(path);
    ASSERT_TRUE(owner.up());
    cable.master.write("before");
    ASSERT_TRUE(until([&] { return owner.received() == "before"; }));
    fs::remove(path);
    cable.master.close();
    ASSERT_TRUE(until([&] { return owner.states.size() == 2; }));
    EXPECT_FALSE(owner.up());
    EXPECT_THAT(owner.states[1].second, HasSubstr(path + " is gone"));
    EXPECT_FALSE(send(text("x")));
    ASSERT_TRUE(until([&] { return status().text.find("No such file") != std::string::npos; }));
    EXPECT_THAT(status().text, HasSubstr("is the adapter plugged in"));
    EXPECT_EQ(owner.states.size(), 2u);

    const Cable again;  // another device of the kernel, under the same name
    fs::create_symlink(again.slave, path);
    ASSERT_TRUE(until([&] { return owner.up(); }));
    EXPECT_EQ(status().reopened, 1u);
    again.master.write("after");
    ASSERT_TRUE(until([&] { return owner.received() == "beforeafter"; }));
}

TEST_F(SerialLineTest, throwsAwayWhatCameBeforeItWasOpened) {
    const Cable cable;
    Fd slave(::open(cable.slave.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK));
    termios t{};
    ASSERT_EQ(::tcgetattr(slave.fd, &t), 0);
    ::cfmakeraw(&t);
    ASSERT_EQ(::tcsetattr(slave.fd, TCSANOW, &t), 0);
    cable.master.write("an old answer");
    open(cable.slave);
    ASSERT_TRUE(owner.up());
    cable.master.write("new");
    ASSERT_TRUE(until([&] { return !owner.frames.empty(); }));
    EXPECT_EQ(owner.received(), "new");
}

TEST_F(SerialLineTest, saysWhatIsWrongWithThePath) {
    const std::string file = folder / "file";
    std::fclose(std::fopen(file.c_str(), "w"));
    const struct {
        std::string path;
        const char* says;
    } rows[] = {{"/dev/no-such-port", "is the adapter plugged in"},
                {file, "not a serial port but a file"},
                {"/dev/null", "is not a serial port"},
                {folder.string(), "cannot open"}};
    for (const auto& r : rows) {
        owner.states.clear();
        open(r.path);
        EXPECT_FALSE(owner.up()) << r.path;
        EXPECT_THAT(owner.states[0].second, HasSubstr(r.says));
        EXPECT_THAT(owner.states[0].second, HasSubstr(r.path));
        line.reset();
    }
}

TEST_F(SerialLineTest, leavesLittleInTheDriverSoThatAStopOvertakes) {
    const Cable cable;
    SerialSettings s;
    s.baud = 9600;
    open(cable.slave, s);
    // A pseudo-terminal accepts bytes at once; a turn still writes no more than 64 bytes.
    for (int i = 0; i < 4; ++i)
        EXPECT_TRUE(send(text(std::string(100, static_cast<char>('a' + i))), Priority::poll));
    EXPECT_TRUE(send(text("STOP"), Priority::urgent));
    std::string got;
    ASSERT_TRUE(until([&] {
        got += cable.master.read();
        return got.size() == 404;
    }));
    EXPECT_EQ(got.substr(0, 4), "STOP");
    EXPECT_EQ(owner.sent.size(), 5u);
}

TEST_F(SerialLineTest, aPortThatDoesNotTakeBytesCostsABoundedQueue) {
    const Cable cable;
    SerialSettings s;
    s.baud = 1'000'000;
    open(cable.slave, s);
    const std::string block(Frame::capacity, 'x');
    int refused = 0;
    ASSERT_TRUE(until([&] {
        for (int i = 0; i < 32; ++i)
            refused += send(text(block)) ? 0 : 1;
        settle();
        return refused >= 64;
    }));
    EXPECT_EQ(status().queued, 256u);
    std::size_t got = 0;
    ASSERT_TRUE(until([&] {
        got += cable.master.read().size();
        return status().queued == 0;
    }));
    EXPECT_GT(got, 256u * 200);
}

TEST_F(SerialLineTest, mayBeDestroyedFromItsEvents) {
    Cable cable;
    open(cable.slave);
    owner.on_received = [&](const Frame&) { line.reset(); };
    cable.master.write("bye");
    ASSERT_TRUE(until([&] { return line == nullptr; }));
    settle();
    owner.states.clear();
    open(cable.slave);
    owner.changes = [&](bool) { line.reset(); };
    cable.master.close();
    EXPECT_TRUE(until([&] { return line == nullptr; }));
}

}  // namespace
}  // namespace axisgate
