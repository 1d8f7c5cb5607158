// The door on real sockets of the loopback: a session, a question over UDP, a connection with its data in both directions, its end.
#include "gateway/doors/enip/server.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/write.hpp>

#include "gateway/site/site_state.hpp"
#include "tests/unit/modbus/fake_port.hpp"

namespace axisgate::enip {
namespace {
namespace asio = boost::asio;
using cip::Bytes;

struct Sockets {
    Sockets() {
        const AxisId one = port.add_axis(1);
        EXPECT_EQ(server.open("127.0.0.1:0"), "");
        site.axis_ids = {one};
        site.site.axes.resize(1);
        site.site.axes[0].name = "feeder";
        site.site.axes[0].number = 1;
        put_site();
        const std::string at = server.addresses().at(0);
        number = static_cast<std::uint16_t>(std::stoi(at.substr(at.rfind(':') + 1)));
        tcp.connect({asio::ip::address_v4::loopback(), number});
        udp.open(asio::ip::udp::v4());
        udp.bind({asio::ip::address_v4::loopback(), 0});
        udp.non_blocking(true);
    }
    HotDoor& door() {
        return **std::ranges::find_if(port.doors, [](const HotDoor* d) { return d && d->name() == "enip"; });
    }
    void put_site() { door().on_site(site); }
    void turn() {
        for (int i = 0; i < 50; ++i)
            (void)io.poll_one();
    }
    Bytes answer(const Bytes& packet) {
        asio::write(tcp, asio::buffer(packet));
        Bytes in(1024);
        for (int i = 0; i < 1000; ++i) {
            turn();
            if (tcp.available() == 0) continue;
            in.resize(tcp.read_some(asio::buffer(in)));
            return in;
        }
        return {};
    }
    /// The next datagram from the device; its sender becomes `device`.
    Bytes received() {
        Bytes in(1024);
        for (int i = 0; i < 1000; ++i) {
            turn();
            boost::system::error_code ec;
            const std::size_t n = udp.receive_from(asio::buffer(in), device, 0, ec);
            if (ec) continue;
            in.resize(n);
            return in;
        }
        return {};
    }

    asio::io_context io;
    modbus::test::FakePort port;
    registers::RegisterImage image{port, {}};
    Server server{io, port, image, {.io_port = 0, .lease_s = 30, .incarnation = 1}};
    SiteState site;
    std::uint16_t number = 0;
    asio::io_context own;
    asio::ip::tcp::socket tcp{own};
    asio::ip::udp::socket udp{own};
    asio::ip::udp::endpoint device;
};

TEST(EnipServer, AConnectionFromItsOpeningToItsEnd) {
    Sockets s;
    cip::Header h;
    h.command = 0x65;
    const Bytes session = s.answer(cip::packet(h, Bytes{1, 0, 0, 0}));
    ASSERT_EQ(session.size(), 28u);
    h.session = cip::read_header(session).session;
    h.command = 0x63;
    s.udp.send_to(asio::buffer(cip::packet(h, {})), {asio::ip::address_v4::loopback(), s.number});
    const Bytes identity = s.received();
    EXPECT_NE(std::string(identity.begin(), identity.end()).find("axisgate"), std::string::npos);

    Bytes open{10, 14};
    cip::put32(open, 0);
    cip::put32(open, 0x7001);
    cip::put16(open, 1);
    cip::put16(open, 1);
    cip::put32(open, 1);
    cip::put32(open, 0);
    for (const std::uint16_t size : {std::uint16_t{38}, std::uint16_t{34}}) {
        cip::put32(open, 10'000);
        cip::put16(open, 0x4800 | size);
    }
    const Bytes path{0x20, 4, 0x24, 199, 0x2C, 151, 0x2C, 101};
    cip::put8(open, 1);
    cip::put8(open, 4);
    cip::put_bytes(open, path);
    const Bytes message = cip::request(cip::service::forward_open, Bytes{0x20, 6, 0x24, 1}, open);
    Bytes body(6), address;
    cip::put16(body, 3);
    cip::put_item(body, cip::item::null_address, {});
    cip::put_item(body, cip::item::unconnected_data, message);
    cip::put_sockaddr(address, {0, s.udp.local_endpoint().port()});
    cip::put_item(body, cip::item::sockaddr_to, address);
    h.command = 0x6F;
    const Bytes answer = s.answer(cip::packet(h, body));
    const auto items = cip::read_items(cip::View(answer).subspan(30));
    ASSERT_TRUE(items);
    const auto opened = cip::read_answer(items->list[1].data);
    ASSERT_TRUE(opened && opened->general == cip::General::success);
    const auto* where = items->find(cip::item::sockaddr_ot);
    ASSERT_TRUE(where) << "its port for implicit data is not 2222";
    const Bytes first = s.received();
    const auto given = cip::read_implicit(first);
    ASSERT_TRUE(given);
    EXPECT_EQ(given->connection, 0x7001u);
    EXPECT_EQ(given->data.size(), 34u);
    EXPECT_EQ(s.device.port(), cip::endpoint_of(*where)->port);

    Bytes out, data{1, 0, 0, 0, 0x06, 0};
    data.resize(36);
    cip::write_implicit(out, cip::Reader(opened->data).u32(), 1, std::uint16_t{1}, data);
    s.udp.send_to(asio::buffer(out), s.device);
    for (int i = 0; i < 1000 && s.port.commands.empty(); ++i)
        s.turn();
    ASSERT_EQ(s.port.commands.size(), 2u);
    EXPECT_TRUE(std::holds_alternative<HoldAxis>(s.port.commands[0].body)) << "an owner that runs holds its axis";
    EXPECT_EQ(std::get<ProcessData>(s.port.commands[1].body).controlword, 6);

    s.put_site();
    EXPECT_TRUE(s.server.adapter().connections().owned()) << "the same site again is no change";
    s.port.set_mapping_revision(99);
    s.put_site();
    EXPECT_TRUE(s.server.adapter().connections().owned()) << "another mapping somewhere leaves its bytes as they are";
    s.site.axis_ids.clear();
    s.site.site.axes.clear();
    s.put_site();
    EXPECT_FALSE(s.server.adapter().connections().owned());
    EXPECT_NE(s.port.notes.back().first.text.find("site was changed"), std::string::npos);
    h.command = 0x66;
    asio::write(s.tcp, asio::buffer(cip::packet(h, {})));
    for (int i = 0; i < 1000 && s.server.adapter().sessions() > 0; ++i)
        s.turn();
    EXPECT_EQ(s.server.adapter().sessions(), 0u);
}

TEST(EnipServer, OutOfDescriptorsItWaitsInsteadOfSpinning) {
    Sockets s;
    s.port.time = at_ns(1'000'000'000);  // in the past of the host's clock, so that its timer expires at once
    cip::Header h;
    h.command = 0x65;
    const Bytes registration = cip::packet(h, Bytes{1, 0, 0, 0});
    h.session = cip::read_header(s.answer(registration)).session;
    asio::ip::tcp::socket second(s.own, asio::ip::tcp::v4()), third(s.own, asio::ip::tcp::v4());
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    const int spare = ::dup(0);  // every number below this one is in use
    ::close(spare);
    rlimit tight = before;
    tight.rlim_cur = static_cast<rlim_t>(spare);
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &tight), 0);
    second.connect({asio::ip::address_v4::loopback(), s.number});
    const auto postponed = [&](int times) {
        const std::string line = "\naxisgate_enip_accepts_postponed_total " + std::to_string(times) + "\n";
        return s.door().metrics().find(line) != std::string::npos;
    };
    const auto changed_places = [&s](asio::ip::tcp::socket& with) { std::swap(s.tcp, with); };
    changed_places(second);
    h.session = 0;
    EXPECT_EQ(s.answer(registration).size(), 28u) << "by the descriptor that is kept for this moment";
    changed_places(second);
    EXPECT_TRUE(postponed(0));
    third.connect({asio::ip::address_v4::loopback(), s.number});
    for (int i = 0; i < 20; ++i)
        s.turn();
    EXPECT_TRUE(postponed(1)) << "once, not with every turn";
    EXPECT_EQ(s.server.adapter().sessions(), 2u) << "who is connected and has just asked stays";
    s.port.time += std::chrono::seconds(1);
    for (int i = 0; i < 20; ++i)
        s.turn();
    EXPECT_EQ(s.server.adapter().sessions(), 2u) << "one that has been silent since then gave way";
    changed_places(third);
    EXPECT_EQ(s.answer(registration).size(), 28u) << "it waited in the queue and is served now";
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
}

TEST(EnipServer, WhatCannotBeListenedOnIsSaid) {
    asio::io_context io;
    modbus::test::FakePort port;
    registers::RegisterImage image(port, {});
    Server server(io, port, image, {.io_port = 0, .lease_s = 30, .incarnation = 1});
    EXPECT_NE(server.open("somewhere").find("ADDRESS:PORT"), std::string::npos);
    EXPECT_NE(server.open("[::1]:44818").find("IPv4"), std::string::npos);
    EXPECT_NE(server.open("192.0.2.1:44818").find("cannot listen"), std::string::npos);
}
TEST(EnipServer, AnotherPortForImplicitDataWhereNobodyChoseTheOneThatIsTaken) {
    asio::io_context io;
    modbus::test::FakePort port;
    registers::RegisterImage image(port, {});
    asio::ip::udp::socket taken(io, {asio::ip::address_v4::loopback(), 0});
    const std::uint16_t busy = taken.local_endpoint().port();
    Server chosen(io, port, image, {.io_port = busy});
    EXPECT_NE(chosen.open("127.0.0.1:0").find("cannot listen"), std::string::npos);
    Server other(io, port, image, {.io_port = busy, .another_io_port = true});
    EXPECT_EQ(other.open("127.0.0.1:0"), "");
    EXPECT_NE(other.facts().io_port, busy);
    EXPECT_NE(other.facts().io_port, 0);
}

}  // namespace
}  // namespace axisgate::enip
