// RTU session and door: which frames are answered, broadcasts, late answers, a port that appears and disappears.
#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <chrono>

#include "gateway/core/event.hpp"
#include "gateway/doors/modbus/rtu_door.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "tests/unit/modbus/responder_bench.hpp"

namespace axisgate::modbus {
namespace rtu_door_test {
using namespace std::chrono_literals;
using test::bytes;
using test::hex;

std::vector<std::uint8_t> sealed(std::string_view body) {
    auto b = bytes(body);
    const auto crc = rtu_crc(b);
    b.push_back(static_cast<std::uint8_t>(crc & 0xFF));
    b.push_back(static_cast<std::uint8_t>(crc >> 8));
    return b;
}
RtuFrame frame(std::string_view body) {
    const auto b = bytes(body);
    RtuFrame f;
    f.address = b[0];
    f.size = static_cast<std::uint8_t>(b.size() - 1);
    std::copy(b.begin() + 1, b.end(), f.bytes.begin());
    return f;
}

struct RtuSessionTest : testing::Test, RtuSink {
    RtuSessionTest() {
        for (std::uint16_t n = 1; n <= 2; ++n)
            axes[n] = port.add_axis(n, &test::catalogue());
        port.edit(axes[1], [](AxisPicture& p) { p.statusword = 0x0250; });
    }
    void send(std::span<const std::uint8_t> adu, bool repeats) override {
        EXPECT_EQ(rtu_crc(adu.first(adu.size() - 2)), adu[adu.size() - 2] | adu[adu.size() - 1] << 8);
        sent.push_back(hex(adu.first(adu.size() - 2)));
        repeated = repeats;
    }
    void answered() override { ++woken; }
    /// The immediate answer.
    std::string ask(RtuSession& s, std::string_view body) {
        sent.clear();
        s.on_frame(frame(body), port.time);
        return sent.empty() ? "" : sent.back();
    }
    test::FakePort port;
    test::ResponderDoor door{port};
    std::shared_ptr<const std::string> who = std::make_shared<const std::string>("/dev/ttyUSB0");
    RtuSession session{door.responder, door.image, *this, 1, who};
    AxisId axes[3] = {};
    std::vector<std::string> sent;
    bool repeated = false;
    int woken = 0;
};

const std::string reading = "03 00 00 00 01", reading_answer = "03 02 02 50", writing = "06 00 2C 00 05";

TEST_F(RtuSessionTest, AnswersItsOwnAddressAlone) {
    EXPECT_EQ(ask(session, "01 " + reading), "01 " + reading_answer);
    EXPECT_FALSE(repeated);
    for (int address = 2; address < 256; ++address) {
        char text[4];
        std::snprintf(text, sizeof text, "%02X", static_cast<unsigned>(address));
        EXPECT_EQ(ask(session, std::string(text) + " " + reading), "") << address;
    }
    EXPECT_EQ(session.counters().foreign.value(), 254u);
    EXPECT_EQ(session.counters().answers.value(), 1u);
}

TEST_F(RtuSessionTest, SeveralGatewaysShareALineByTheirAddresses) {
    RtuSession second(door.responder, door.image, *this, 17, who);
    EXPECT_EQ(ask(second, "01 " + reading), "");
    EXPECT_EQ(ask(second, "11 " + reading), "11 " + reading_answer) << "the standard map under its own address";
    EXPECT_EQ(ask(session, "11 " + reading), "");
}

TEST_F(RtuSessionTest, UnitsOfTheSiteStandUnderTheirNumbers) {
    struct OneWord final : UnitMap {
        Verdict check_read(Table, std::uint16_t, std::uint16_t) override { return Verdict::good; }
        Verdict read_registers(Table, std::uint16_t, std::uint16_t count, Instant, std::uint8_t* out) override {
            std::fill_n(out, 2 * count, std::uint8_t{0x77});
            return Verdict::good;
        }
        Verdict read_bits(Table, std::uint16_t, std::uint16_t, std::uint8_t*) override { return Verdict::no_address; }
        Verdict check_write(Table, std::uint16_t, std::uint16_t) override { return Verdict::no_address; }
        Verdict write(Table, std::uint16_t, std::uint16_t, const std::uint8_t*, registers::WritePlan&) override {
            return Verdict::no_address;
        }
        void on_own_result(std::uint32_t, const Result&) override {}
    } map;
    for (const std::uint8_t unit : {std::uint8_t{5}, std::uint8_t{247}, std::uint8_t{248}})
        door.image.set_map(unit, &map);
    EXPECT_EQ(ask(session, "05 " + reading), "05 03 02 77 77");
    EXPECT_EQ(ask(session, "F7 " + reading), "F7 03 02 77 77");
    EXPECT_EQ(ask(session, "F8 " + reading), "") << "addresses above 247 are reserved";
    RtuSession fifth(door.responder, door.image, *this, 5, who);
    EXPECT_EQ(ask(fifth, "05 " + reading), "05 03 02 77 77") << "the site's user map of that unit goes first";
    for (const std::uint8_t unit : {std::uint8_t{5}, std::uint8_t{247}, std::uint8_t{248}})
        door.image.set_map(unit, nullptr);
}

TEST_F(RtuSessionTest, ExceptionsAreThoseOfTheTcpDoor) {
    EXPECT_EQ(ask(session, "01 63"), "01 E3 01");
    EXPECT_EQ(ask(session, "01 06 00 00 00 01"), "01 86 02");
    EXPECT_EQ(ask(session, "01 03 00 00 00 7E"), "01 83 03");
    EXPECT_EQ(ask(session, "01 03 00"), "01 83 03") << "a good checksum around too few bytes";
    EXPECT_EQ(ask(session, "01 06 0F E0 00 0F"), "01 86 0A") << "no such axis";
}

TEST_F(RtuSessionTest, AWriteIsAnsweredWhenTheDriveHasAnswered) {
    EXPECT_EQ(ask(session, "01 " + writing), "");
    EXPECT_TRUE(session.waits());
    session.finish(port.time);
    EXPECT_TRUE(sent.empty()) << "not before the drive";
    ASSERT_TRUE(port.answer());
    EXPECT_EQ(woken, 1);
    session.finish(port.time);
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_EQ(sent[0], "01 " + writing);
    EXPECT_TRUE(repeated);
    EXPECT_TRUE(session.has_commanded());
    (void)ask(session, "01 " + writing);
    port.refuse(Reason::drive_refused);
    session.finish(port.time);
    EXPECT_EQ(sent.back(), "01 86 04");
}

TEST_F(RtuSessionTest, NothingIsAnsweredOnceTheMasterSpeaksOfSomethingElse) {
    for (const std::string next : {"09 03 00 00 00 01", "00 06 00 2C 00 07", "01 03 00 00 00 01"}) {
        (void)ask(session, "01 " + writing);
        const auto at_once = ask(session, next);
        while (port.answer()) {
        }
        session.finish(port.time);
        EXPECT_EQ(sent.size(), at_once.empty() ? 0u : 1u) << next;
    }
    EXPECT_EQ(session.counters().late_answers.value(), 3u);
    // The same write again: its own drive's answer is the one that counts.
    (void)ask(session, "01 06 00 2C 00 05");
    (void)ask(session, "01 06 00 2C 00 06");
    ASSERT_TRUE(port.answer());
    EXPECT_EQ(woken, 0);
    session.finish(port.time);
    EXPECT_TRUE(sent.empty());
    ASSERT_TRUE(port.answer());
    session.finish(port.time);
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_EQ(sent[0], "01 06 00 2C 00 06");
}

TEST_F(RtuSessionTest, ARequestBehindWhichMoreWasHeardIsCarriedOutAndNotAnswered) {
    session.on_frame(frame("01 " + reading), port.time, true);
    session.on_frame(frame("01 " + writing), port.time, true);
    EXPECT_EQ(port.commands.size(), 1u);
    EXPECT_TRUE(port.answer());
    session.finish(port.time);
    EXPECT_TRUE(sent.empty());
    EXPECT_EQ(session.counters().late_answers.value(), 2u);
}

TEST_F(RtuSessionTest, ABroadcastIsCarriedOutAndNeverAnswered) {
    EXPECT_EQ(ask(session, "00 " + writing), "");
    ASSERT_EQ(port.commands.size(), 1u);
    const auto* data = std::get_if<ProcessData>(&port.commands.front().body);
    ASSERT_NE(data, nullptr);
    EXPECT_EQ(data->homing_method, 5);
    ASSERT_TRUE(port.answer());
    session.finish(port.time);
    EXPECT_TRUE(sent.empty());
    EXPECT_EQ(woken, 0);
    // Reads and impossible requests have no effect.
    for (const std::string& odd :
         {"00 " + reading, std::string("00 17 00 00 00 01 00 2C 00 01 02 00 05"), std::string("00 63"), std::string("00 06 00 00 00 01")}) {
        EXPECT_EQ(ask(session, odd), "") << odd;
        EXPECT_TRUE(port.commands.empty()) << odd;
    }
    EXPECT_EQ(session.counters().broadcasts.value(), 5u);
    RtuSession second(door.responder, door.image, *this, 17, who);
    EXPECT_EQ(ask(second, "00 " + writing), "");
    EXPECT_EQ(port.commands.size(), 1u) << "every gateway on the line follows it";
}

TEST_F(RtuSessionTest, FunctionsAndTheLockAreThoseOfTheConfiguration) {
    door.responder.set_read_only(true);
    EXPECT_EQ(ask(session, "01 " + writing), "01 86 01");
    EXPECT_EQ(ask(session, "00 " + writing), "");
    EXPECT_TRUE(port.commands.empty());
    EXPECT_EQ(ask(session, "01 06 00 20 00 02"), "") << "a quick stop is taken, and answered by the drive";
    EXPECT_EQ(port.commands.size(), 1u);
}

// --- the door around them, on a line that a test holds

struct TestLine final : Line {
    void open(LineEvents& e, Instant) override { events = &e; }
    void close() override { closed = true; }
    bool send(const Frame& f, Priority, Instant) override {
        sent.push_back(hex(f.data()));
        return true;
    }
    Instant deadline() const override { return never; }
    void on_deadline(Instant) override {}
    LineStatus status(Instant) const override { return {}; }
    void bring(const std::vector<std::uint8_t>& data, Instant at) {
        Frame f = Frame::run(data);
        f.at = at;
        events->on_frame(f);
    }
    LineEvents* events = nullptr;
    bool closed = false;
    std::vector<std::string> sent;
};

/// The silence is measured by the machine's clock, as in the door.
struct NowPort : test::FakePort {
    Instant now() const override {
        return Instant{std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch())};
    }
};

struct RtuDoorTest : testing::Test {
    RtuDoorTest() {
        axis = port.add_axis(1, &test::catalogue());
        port.edit(axis, [](AxisPicture& p) { p.statusword = 0x0250; });
        RtuSettings s;
        s.timing = RtuTiming::of(115200, 11);
        s.port = "/dev/ttyUSB0";
        s.text = "serial:/dev/ttyUSB0?baud=115200&format=8E1";
        auto own = std::make_unique<TestLine>();
        line = own.get();
        door = std::make_unique<RtuDoor>(io, port, image, std::move(s), std::move(own));
        door->open();
    }
    void run_until(const std::function<bool()>& done) {
        const auto limit = std::chrono::steady_clock::now() + 5s;
        while (!done() && std::chrono::steady_clock::now() < limit) {
            io.restart();
            (void)io.run_one_for(100ms);
        }
        EXPECT_TRUE(done());
    }
    [[nodiscard]] const HotDoor& hot() const { return *port.doors.back(); }

    boost::asio::io_context io;
    NowPort port;
    registers::RegisterImage image{port, {WordOrder::high_first, MapGaps::zero}};
    TestLine* line = nullptr;
    std::unique_ptr<RtuDoor> door;
    AxisId axis{};
};

TEST_F(RtuDoorTest, AnswersOnceTheLineIsSilent) {
    line->events->on_line_state(true, "up");
    const auto request = sealed("01 " + reading);
    const Instant asked = port.now();
    line->bring({request.begin(), request.begin() + 3}, asked);
    line->bring({request.begin() + 3, request.end()}, asked);
    EXPECT_TRUE(line->sent.empty());
    run_until([&] { return !line->sent.empty(); });
    EXPECT_GE(port.now() - asked, 1750us);
    EXPECT_EQ(line->sent.front(), hex(sealed("01 " + reading_answer)));
    EXPECT_EQ(hot().name(), "modbus_rtu");
    EXPECT_EQ(hot().addresses(), std::vector<std::string>{"serial:/dev/ttyUSB0?baud=115200&format=8E1"});
    AuthorityClient master{modbus::clients, "/dev/ttyUSB0"};
    ASSERT_TRUE(hot().last_received(master));
    EXPECT_FALSE(hot().last_received({modbus::clients, "192.0.2.1"}));
    EXPECT_NE(hot().metrics().find("axisgate_modbus_rtu_answers_total 1\n"), std::string::npos) << hot().metrics();
}

TEST_F(RtuDoorTest, AWriteIsAnsweredAfterItsDriveUnlessTheLineHasSpokenMeanwhile) {
    line->events->on_line_state(true, "up");
    for (const bool interrupted : {false, true}) {
        line->bring(sealed(interrupted ? "01 06 00 2C 00 06" : "01 " + writing), port.now());  // the same bytes at once might be an echo
        run_until([&] { return !port.commands.empty(); });
        if (interrupted) line->bring({0x09}, port.now());  // the master has sent something else
        const std::size_t before = line->sent.size();
        ASSERT_TRUE(port.answer());
        io.restart();
        (void)io.run_for(10ms);
        EXPECT_EQ(line->sent.size(), before + (interrupted ? 0 : 1));
    }
    EXPECT_EQ(door->counters().late_answers.value(), 1u);
}

TEST_F(RtuDoorTest, APortThatIsPulledOutIsToldAndItsMasterCountsAsLost) {
    line->events->on_line_state(false, "cannot open /dev/ttyUSB0: No such file or directory");
    ASSERT_EQ(port.notes.size(), 1u);
    EXPECT_EQ(port.notes[0].first.kind, "modbus_rtu");
    EXPECT_NE(port.notes[0].first.text.find("No such file"), std::string::npos);
    EXPECT_TRUE(port.lost.empty()) << "nobody has commanded";
    EXPECT_FALSE(door->report().up);
    line->events->on_line_state(true, "up on /dev/ttyUSB0");
    EXPECT_TRUE(door->report().up);
    line->bring(sealed("01 " + writing), port.now());
    run_until([&] { return !port.commands.empty(); });
    ASSERT_TRUE(port.answer());
    line->events->on_line_state(false, "/dev/ttyUSB0 is gone");
    ASSERT_EQ(port.lost.size(), 1u);
    EXPECT_EQ(port.lost[0].first, "modbus /dev/ttyUSB0");
    EXPECT_EQ(port.lost[0].second, modbus::loss_closed);
    io.restart();
    (void)io.run_for(5ms);
    EXPECT_TRUE(line->sent.empty()) << "what waited for its drive has nobody to go to";
    EXPECT_FALSE(hot().last_received({modbus::clients, "/dev/ttyUSB0"}));
    line->events->on_line_state(true, "up");
    line->events->on_line_state(false, "gone again");
    EXPECT_EQ(port.lost.size(), 1u) << "who has not commanded since is not lost again";
}

TEST_F(RtuDoorTest, TheEndOfTheDoorLeavesNothingBehind) {
    line->events->on_line_state(true, "up");
    line->bring(sealed("01 " + writing), port.now());
    run_until([&] { return !port.commands.empty(); });
    door.reset();
    EXPECT_TRUE(port.answer());
    io.restart();
    (void)io.run_for(5ms);
}

}  // namespace rtu_door_test
}  // namespace axisgate::modbus
