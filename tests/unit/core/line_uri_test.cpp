// Line URIs: every form of the contract, their defaults, and malicious text.
#include "gateway/core/line_uri.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gateway/core/line.hpp"

namespace axisgate {
namespace {

using Kind = LineUri::Kind;
using testing::HasSubstr;

TEST(LineUri, readsEveryForm) {
    const auto can = parse_line_uri("can:can0");
    ASSERT_TRUE(can.good()) << can.fault;
    EXPECT_EQ(can.uri.kind, Kind::can);
    EXPECT_EQ(can.uri.interface, "can0");

    const auto serial =
        parse_line_uri("serial:/dev/serial/by-id/usb-FTDI_%41-if00-port0?baud=57600&format=7e2&rs485=1&rts_before_ms=1&rts_after_ms=100");
    ASSERT_TRUE(serial.good()) << serial.fault;
    EXPECT_EQ(serial.uri.kind, Kind::serial);
    EXPECT_EQ(serial.uri.path, "/dev/serial/by-id/usb-FTDI_%41-if00-port0");
    EXPECT_EQ(serial.uri.serial.baud, 57600u);
    EXPECT_EQ(serial.uri.serial.format, (SerialFormat{7, Parity::even, 2}));
    EXPECT_EQ(serial.uri.serial.rs485, Rs485::on);
    EXPECT_EQ(serial.uri.serial.rts_before_ms, 1);
    EXPECT_EQ(serial.uri.serial.rts_after_ms, 100);

    const auto tcp = parse_line_uri("tcp:drive-7.plant.example:503");
    ASSERT_TRUE(tcp.good()) << tcp.fault;
    EXPECT_EQ(tcp.uri.kind, Kind::tcp);
    EXPECT_EQ(tcp.uri.host, "drive-7.plant.example");
    EXPECT_EQ(tcp.uri.port, 503);

    const auto six = parse_line_uri("tcp:[fe80::1%eth0]:4001");
    ASSERT_TRUE(six.good()) << six.fault;
    EXPECT_EQ(six.uri.host, "fe80::1%eth0");
    EXPECT_EQ(six.uri.port, 4001);

    const auto listen = parse_line_uri("tcp-listen:[::1]:0");
    ASSERT_TRUE(listen.good()) << listen.fault;
    EXPECT_EQ(listen.uri.kind, Kind::tcp_listen);
    EXPECT_EQ(listen.uri.host, "::1");
    EXPECT_EQ(listen.uri.port, 0);

    const auto udp = parse_line_uri("udp:192.0.2.7:503");
    ASSERT_TRUE(udp.good()) << udp.fault;
    EXPECT_EQ(udp.uri.kind, Kind::udp);
    EXPECT_EQ(udp.uri.host, "192.0.2.7");
    EXPECT_EQ(udp.uri.port, 503);
    const auto udp_six = parse_line_uri("udp:[fe80::1%eth0]:4001");
    ASSERT_TRUE(udp_six.good()) << udp_six.fault;
    EXPECT_EQ(udp_six.uri.host, "fe80::1%eth0");
    EXPECT_EQ(udp_six.uri.port, 4001);
    const auto udp_listen = parse_line_uri("udp-listen:[::1]:0");
    ASSERT_TRUE(udp_listen.good()) << udp_listen.fault;
    EXPECT_EQ(udp_listen.uri.kind, Kind::udp_listen);
    EXPECT_EQ(udp_listen.uri.host, "::1");
    EXPECT_EQ(udp_listen.uri.port, 0);

    const auto pty = parse_line_uri("pty:/tmp/drive");
    ASSERT_TRUE(pty.good()) << pty.fault;
    EXPECT_EQ(pty.uri.kind, Kind::pty);
    EXPECT_EQ(pty.uri.path, "/tmp/drive");

    const auto twin = parse_line_uri("twin");
    ASSERT_TRUE(twin.good()) << twin.fault;
    EXPECT_EQ(twin.uri.kind, Kind::twin);
}

TEST(LineUri, takesTheFamilysDefaultsForASerialLine) {
    const auto plain = parse_line_uri("serial:/dev/ttyS1", 57600, "7E1");
    ASSERT_TRUE(plain.good());
    EXPECT_EQ(plain.uri.serial.baud, 57600u);
    EXPECT_EQ(plain.uri.serial.format, (SerialFormat{7, Parity::even, 1}));
    const auto reported = parse_line_uri("serial:/dev/ttyS1?baud=9600", 57600, "7E1");
    EXPECT_EQ(reported.uri.serial.baud, 9600u);
    EXPECT_EQ(reported.uri.serial.format, (SerialFormat{7, Parity::even, 1}));
    const auto both = parse_line_uri("serial:/dev/ttyS1?format=8N1&baud=250000&rtscts=1", 57600, "7E1");
    EXPECT_EQ(both.uri.serial.baud, 250000u);
    EXPECT_EQ(both.uri.serial.format, (SerialFormat{8, Parity::none, 1}));
    EXPECT_TRUE(both.uri.serial.rtscts);
    EXPECT_EQ(parse_line_uri("serial:/dev/ttyS1?rs485=auto").uri.serial.rs485, Rs485::automatic);
}

TEST(LineUri, aPseudoTerminalKeepsAPaceOnlyWhenToldTo) {
    const auto plain = parse_line_uri("pty:/tmp/drive", 57600, "7E1");
    ASSERT_TRUE(plain.good()) << plain.fault;
    EXPECT_EQ(plain.uri.serial.baud, 0u) << "the family's rate is no wish for a pace";
    const auto paced = parse_line_uri("pty:/tmp/drive?baud=9600", 57600, "7N1");
    ASSERT_TRUE(paced.good()) << paced.fault;
    EXPECT_EQ(paced.uri.path, "/tmp/drive");
    EXPECT_EQ(paced.uri.serial.baud, 9600u);
    EXPECT_EQ(paced.uri.serial.format, (SerialFormat{7, Parity::none, 1}));
    EXPECT_EQ(parse_line_uri("pty:/tmp/drive?format=8E2&baud=9600").uri.serial.format, (SerialFormat{8, Parity::even, 2}));
}

TEST(LineUri, countsTheBitsOfAByte) {
    const struct {
        const char* format;
        int bits;
    } rows[] = {{"8N1", 10}, {"7N1", 9}, {"7E1", 10}, {"8O1", 11}, {"8E2", 12}, {"7O2", 11}};
    for (const auto& r : rows) {
        const auto f = parse_serial_format(r.format);
        ASSERT_TRUE(f) << r.format;
        EXPECT_EQ(f->bits_per_byte(), r.bits) << r.format;
        EXPECT_EQ(to_text(*f), r.format);
    }
    for (const char* bad : {"", "8N", "8N11", "9N1", "6N1", "8X1", "8N3", "8N0", "N81"})
        EXPECT_FALSE(parse_serial_format(bad)) << bad;
}

TEST(LineUri, comesBackFromItsText) {
    for (const char* text :
         {"can:can0", "can:vcan12", "serial:/dev/ttyS1?baud=9600&format=8N1",
          "serial:/dev/ttyS1?baud=1000000&format=7O2&rs485=1&rts_after_ms=3",
          "serial:/dev/ttyS1?baud=9600&format=8N1&rs485=auto&rts_before_ms=2", "serial:/dev/ttyS1?baud=9600&format=8N1&rtscts=1",
          "tcp:192.168.1.50:503", "tcp:[::1]:1", "tcp-listen:0.0.0.0:0", "tcp-listen:[::]:65535", "udp:192.168.1.50:503", "udp:[::1]:1",
          "udp-listen:0.0.0.0:0", "udp-listen:[::1]:0", "udp-listen:[::]:65535", "pty:/tmp/x", "pty:x", "pty:/tmp/x?baud=9600&format=7N1",
          "twin"}) {
        const auto u = parse_line_uri(text);
        ASSERT_TRUE(u.good()) << text << ": " << u.fault;
        EXPECT_EQ(to_text(u.uri), text);
        EXPECT_EQ(parse_line_uri(to_text(u.uri)).uri, u.uri);
    }
}

TEST(LineUri, saysWhatIsWrongAndShowsWhatIsRight) {
    const struct {
        std::string text;
        const char* says;
        const char* shows;
    } rows[] = {
        {"", "empty", "can:can0"},
        {"can0", "\"can0\" is not a kind of line", "can:can0"},
        {"usb:/dev/ttyUSB0", "\"usb\" is not a kind of line", "serial:"},
        {"CAN:can0", "is not a kind", "can:can0"},
        {"twin:3", "stands alone", "twin"},
        {"can:", "network interface", "can:can0"},
        {"can:a-name-far-too-long", "network interface", "can:can0"},
        {"can:can 0", "network interface", "can:can0"},
        {"can:../can0", "network interface", "can:can0"},
        {"can:can0?bitrate=500000", "no options", "can:can0"},
        {"serial:ttyUSB0", "whole path", "serial:/dev/ttyUSB0"},
        {"serial:", "whole path", "serial:/dev/ttyUSB0"},
        {"serial:/dev/ttyS0?", "option=value", "baud=9600"},
        {"serial:/dev/ttyS0?baud", "option=value", "baud=9600"},
        {"serial:/dev/ttyS0?=9600", "option=value", "baud=9600"},
        {"serial:/dev/ttyS0?baud=9600&", "option=value", "baud=9600"},
        {"serial:/dev/ttyS0?bauds=9600", "no option \"bauds\"", "baud=9600"},
        {"serial:/dev/ttyS0?baud=fast", "50..12000000", "baud=9600"},
        {"serial:/dev/ttyS0?baud=49", "50..12000000", "baud=9600"},
        {"serial:/dev/ttyS0?baud=99999999999999999999", "50..12000000", "baud=9600"},
        {"serial:/dev/ttyS0?baud=-9600", "50..12000000", "baud=9600"},
        {"serial:/dev/ttyS0?baud=9600x", "50..12000000", "baud=9600"},
        {"serial:/dev/ttyS0?baud=9600&baud=9600", "said twice", "baud=9600"},
        {"serial:/dev/ttyS0?format=8N", "format is", "format=8N1"},
        {"serial:/dev/ttyS0?rs485=yes", "0, 1 or auto", "serial:"},
        {"serial:/dev/ttyS0?rtscts=2", "0 or 1", "serial:"},
        {"serial:/dev/ttyS0?rs485=1&rts_after_ms=101", "0..100", "serial:"},
        {"serial:/dev/ttyS0?rts_after_ms=1", "RS-485 alone", "rs485=1"},
        {"serial:/dev/ttyS0?rs485=0&rts_before_ms=1", "RS-485 alone", "rs485=1"},
        {"serial:/dev/ttyS0?rs485=1&rtscts=1", "RTS", "rs485=1"},
        {"tcp:host", "port is missing", "tcp:192.168.1.50:503"},
        {"tcp:host:", "not a port (1..65535)", "tcp:"},
        {"tcp:host:0", "not a port (1..65535)", "tcp:"},
        {"tcp:host:65536", "not a port", "tcp:"},
        {"tcp:host:5o3", "not a port", "tcp:"},
        {"tcp::503", "host is missing", "tcp:"},
        {"tcp:a host:503", "has no ' '", "tcp:"},
        {"tcp:host/path:503", "has no '/'", "tcp:"},
        {"tcp:host:503?nodelay=1", "no options", "tcp:"},
        {"tcp:::1:503", "square brackets", "tcp:[::1]:503"},
        {"tcp:[::1]503", "[ADDRESS]:PORT", "tcp:[::1]:503"},
        {"tcp:[::1", "[ADDRESS]:PORT", "tcp:[::1]:503"},
        {"tcp:[host]:503", "IPv6", "tcp:"},
        {"tcp:[]:503", "host is missing", "tcp:"},
        {"tcp:" + std::string(254, 'a') + ":503", "253", "tcp:"},
        {"UDP:host:503", "is not a kind", "udp:HOST:PORT"},
        {"udp", "\"udp\" is not a kind of line", "udp:HOST:PORT"},
        {"udp:", "port is missing", "udp:192.168.1.50:503"},
        {"udp:host", "port is missing", "udp:192.168.1.50:503"},
        {"udp:host:0", "not a port (1..65535)", "udp:192.168.1.50:503"},
        {"udp:host:65536", "not a port", "udp:192.168.1.50:503"},
        {"udp:host:5o3", "not a port", "udp:192.168.1.50:503"},
        {"udp::503", "host is missing", "udp:192.168.1.50:503"},
        {"udp:host:503?broadcast=1", "no options", "udp:192.168.1.50:503"},
        {"udp:::1:503", "square brackets", "udp:[::1]:503"},
        {"udp:[::1]503", "[ADDRESS]:PORT", "udp:[::1]:503"},
        {"udp-listen:127.0.0.1:1?x=1", "no options", "udp-listen:127.0.0.1:4001"},
        {"udp-listen:0.0.0.0", "port is missing", "udp-listen:127.0.0.1:4001"},
        {"udp-listen:0.0.0.0:-1", "not a port (0..65535)", "udp-listen:"},
        {"udp-listen:::1:0", "square brackets", "udp-listen:[::1]:4001"},
        {"tcp-listen:0.0.0.0", "port is missing", "tcp-listen:127.0.0.1:4001"},
        {"tcp-listen:0.0.0.0:-1", "not a port (0..65535)", "tcp-listen:"},
        {"pty:", "path", "pty:/tmp/drive"},
        {"pty:/tmp/", "path", "pty:/tmp/drive"},
        {"pty:/tmp/x?mode=raw", "no option \"mode\"", "pty:/tmp/drive?baud=9600"},
        {"pty:/tmp/x?rtscts=1", "no option \"rtscts\"", "pty:/tmp/drive?baud=9600"},
        {"pty:/tmp/x?format=7N1", "together with baud", "pty:/tmp/drive?baud=9600"},
        {"pty:/tmp/x?baud=0", "50..12000000", "pty:/tmp/drive?baud=9600"},
        {"pty:/tmp/x?baud=9600&format=9N1", "format is", "pty:/tmp/drive?baud=9600"},
        {"pty:/tmp/x?baud=9600&baud=9600", "said twice", "pty:/tmp/drive?baud=9600"},
        {"pty:/tmp/x?", "option=value", "pty:/tmp/drive?baud=9600"},
        {"pty:?baud=9600", "path", "pty:/tmp/drive"},
        {std::string("pty:/tmp/x\0y", 12), "control character", "pty:"},
        {"pty:/tmp/x\n", "control character", "pty:"},
        {"pty:/" + std::string(2000, 'x'), "1024", "pty:"},
    };
    for (const auto& r : rows) {
        const auto u = parse_line_uri(r.text);
        EXPECT_FALSE(u.good()) << r.text;
        EXPECT_THAT(u.fault, HasSubstr(r.says)) << r.text;
        EXPECT_THAT(u.fault, HasSubstr(r.shows)) << r.text;
    }
}

TEST(LineUri, survivesAnyBytes) {
    // Every prefix and every single changed byte of correct URIs: a fault or a value, and nothing else.
    for (const std::string good :
         {"serial:/dev/ttyS1?baud=9600&format=8N1&rs485=1&rts_after_ms=3", "tcp:[fe80::1%eth0]:4001", "udp-listen:[::1]:0", "can:can0"}) {
        for (std::size_t n = 0; n < good.size(); ++n) {
            const auto u = parse_line_uri(good.substr(0, n));
            EXPECT_EQ(u.good(), u.fault.empty());
            for (int c = 0; c < 256; ++c) {
                std::string changed = good;
                changed[n] = static_cast<char>(c);
                const auto v = parse_line_uri(changed);
                if (v.good()) {
                    EXPECT_EQ(parse_line_uri(to_text(v.uri)).uri, v.uri) << changed;
                }
            }
        }
    }
}

TEST(LineStatus, namesItsStates) {
    EXPECT_EQ(name_of(LineStatus::State::closed), "closed");
    EXPECT_EQ(name_of(LineStatus::State::opening), "opening");
    EXPECT_EQ(name_of(LineStatus::State::up), "up");
    EXPECT_EQ(name_of(LineStatus::State::down), "down");
    EXPECT_EQ(name_of(LineStatus::State::bus_off), "bus_off");
}

}  // namespace
}  // namespace axisgate
