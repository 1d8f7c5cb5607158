// Every URI gives its line; a twin on a listening port and a client line meet; impossible lines report the reason. Loopback only.
#include "gateway/lines/make_line.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "gateway/lines/pty_line.hpp"
#include "gateway/lines/serial_line.hpp"
#include "gateway/lines/tcp_line.hpp"
#include "gateway/lines/tcp_listen_line.hpp"
#include "gateway/lines/udp_line.hpp"
#include "tests/unit/lines/fixture.hpp"

namespace axisgate {
namespace {

using namespace test;
using testing::HasSubstr;

class MakeLineTest : public LineTest {};

TEST_F(MakeLineTest, givesTheKindOfTheUri) {
    const auto make = [&](const char* uri) { return make_line(parse_line_uri(uri).uri, base()); };
    EXPECT_NE(dynamic_cast<CanLine*>(make("can:can0").get()), nullptr);
    EXPECT_NE(dynamic_cast<SerialLine*>(make("serial:/dev/ttyS0").get()), nullptr);
    EXPECT_NE(dynamic_cast<TcpLine*>(make("tcp:127.0.0.1:1").get()), nullptr);
    EXPECT_NE(dynamic_cast<TcpListenLine*>(make("tcp-listen:127.0.0.1:0").get()), nullptr);
    EXPECT_NE(dynamic_cast<UdpLine*>(make("udp:127.0.0.1:1").get()), nullptr);
    EXPECT_NE(dynamic_cast<UdpLine*>(make("udp-listen:127.0.0.1:0").get()), nullptr);
    EXPECT_NE(dynamic_cast<PtyLine*>(make("pty:/tmp/never-opened").get()), nullptr);
    EXPECT_NE(dynamic_cast<PtyLine*>(make("pty:/tmp/never-opened?baud=9600&format=7N1").get()), nullptr);
    const auto line = make("can:can0");
    EXPECT_EQ(line->status(clock.now()).state, LineStatus::State::closed);
    EXPECT_EQ(line->deadline(), never);
    line->on_deadline(clock.now());
    EXPECT_FALSE(line->send(text("x"), Priority::command, clock.now()));
    line->close();
}

TEST_F(MakeLineTest, whatCannotBeSaysSo) {
    const struct {
        const char* uri;
        const char* says;
    } rows[] = {
        {"twin", "no real side"}, {"nonsense", "is not a kind of line"}, {"tcp:host", "port is missing"}, {"udp:host:0", "not a port"}};
    for (const auto& r : rows) {
        Owner o;
        const auto line = make_real_line(r.uri, {}, io);
        line->open(o, clock.now());
        ASSERT_TRUE(until([&] { return !o.states.empty(); }));
        EXPECT_FALSE(o.up());
        EXPECT_THAT(line->status(clock.now()).text, HasSubstr(r.says));
    }
}

TEST_F(MakeLineTest, twoEndsOfOneCable) {
    const auto twin_end = make_real_line("tcp-listen:127.0.0.1:0", {}, io);
    Owner twin;
    twin_end->open(twin, clock.now());
    ASSERT_TRUE(until([&] { return twin.up(); }));
    const std::string address = dynamic_cast<TcpListenLine&>(*twin_end).address();
    const auto gateway_end = make_real_line("tcp:" + address, {}, io);
    ASSERT_TRUE(comes_up(*gateway_end));
    // Question and answer a thousand times, each from inside the event of the other.
    int rounds = 0;
    twin.on_received = [&](const Frame& f) { EXPECT_TRUE(twin_end->send(f, Priority::command, clock.now())); };
    owner.on_received = [&](const Frame& f) {
        if (++rounds < 1000) EXPECT_TRUE(gateway_end->send(f, Priority::command, clock.now()));
    };
    EXPECT_TRUE(gateway_end->send(text("PR P\r"), Priority::command, clock.now()));
    EXPECT_TRUE(until([&] { return rounds == 1000; }));
    EXPECT_EQ(as_text(owner.frames.back()), "PR P\r");
    EXPECT_EQ(gateway_end->status(clock.now()).frames_out, 1000u);
}

TEST_F(MakeLineTest, twoEndsThatSpeakInDatagrams) {
    const auto twin_end = make_real_line("udp-listen:127.0.0.1:0", {}, io);
    Owner twin;
    twin_end->open(twin, clock.now());
    ASSERT_TRUE(until([&] { return twin.up(); }));
    const auto port = dynamic_cast<UdpLine&>(*twin_end).port();
    EXPECT_THAT(twin.states[0].second, HasSubstr("listening on UDP port " + std::to_string(port)));
    const auto gateway_end = make_real_line("udp:127.0.0.1:" + std::to_string(port), {}, io);
    ASSERT_TRUE(comes_up(*gateway_end));
    int rounds = 0;
    twin.on_received = [&](const Frame& f) { EXPECT_TRUE(twin_end->send(f, Priority::command, clock.now())); };
    owner.on_received = [&](const Frame& f) {
        if (++rounds < 1000) EXPECT_TRUE(gateway_end->send(f, Priority::command, clock.now()));
    };
    EXPECT_TRUE(gateway_end->send(text("PR P\r"), Priority::command, clock.now()));
    EXPECT_TRUE(until([&] { return rounds == 1000; }));
    EXPECT_EQ(as_text(owner.frames.back()), "PR P\r");
    EXPECT_EQ(gateway_end->status(clock.now()).frames_out, 1000u);
}

TEST_F(MakeLineTest, aSerialLineOpensAPseudoTerminalLine) {
    const auto path = std::filesystem::temp_directory_path() / ("axisgate-make-" + std::to_string(::getpid()));
    const auto twin_end = make_real_line("pty:" + path.string(), {}, io);
    Owner twin;
    twin_end->open(twin, clock.now());
    ASSERT_TRUE(until([&] { return twin.up(); }));
    LineSetup setup;
    setup.bit_rate = 57600;
    const auto gateway_end = make_real_line("serial:" + path.string() + "?format=7E1&rs485=auto", setup, io, "8N2");
    ASSERT_TRUE(comes_up(*gateway_end));
    EXPECT_THAT(owner.states[0].second, HasSubstr("57600 bit/s 7E1"));
    twin.on_received = [&](const Frame& f) { EXPECT_TRUE(twin_end->send(f, Priority::command, clock.now())); };
    EXPECT_TRUE(gateway_end->send(text(every_byte()), Priority::command, clock.now()));
    EXPECT_TRUE(until([&] { return owner.received() == every_byte(); }));
    twin_end->close();
    EXPECT_TRUE(until([&] { return !owner.up(); }));
    twin_end->open(twin, clock.now());
    EXPECT_TRUE(until([&] { return owner.up(); }));
}

TEST_F(MakeLineTest, theMachinesClockGoesForward) {
    const Instant a = machine_clock().now();
    EXPECT_GE(machine_clock().now(), a);
    EXPECT_GT(machine_clock().unix_ns(), 1'600'000'000'000'000'000);
}

TEST(GrowingPause, doublesUpToItsBoundAndBeginsAnew) {
    GrowingPause p({milliseconds(200), secs(5)});
    std::vector<std::int64_t> taken;
    for (int i = 0; i < 8; ++i)
        taken.push_back(milliseconds_of(p.take()));
    EXPECT_THAT(taken, testing::ElementsAre(200, 400, 800, 1600, 3200, 5000, 5000, 5000));
    p.reset();
    EXPECT_EQ(p.take(), milliseconds(200));
}

}  // namespace
}  // namespace axisgate
