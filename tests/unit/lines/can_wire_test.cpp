// Every pure part of the SocketCAN line, byte by byte, with the kernel's structures. No CAN interface is needed.
#include "gateway/lines/can_wire.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can/error.h>
#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <time.h>

#include "gateway/lines/can_kernel.hpp"
#include "gateway/lines/can_link.hpp"

namespace axisgate {
namespace {

using testing::HasSubstr;

Frame frame(std::uint32_t id, bool extended, std::initializer_list<std::uint8_t> data = {}) {
    Frame f = Frame::can_extended(id, std::span<const std::uint8_t>(data.begin(), data.size()));
    f.extended = extended;
    return f;
}

TEST(CanWire, carriesFramesBothWays) {
    const struct {
        Frame frame;
        std::uint32_t kernel_id;
    } rows[] = {
        {frame(0x04280095, true, {1}), 0x84280095},
        {frame(0x1FFFFFFF, true, {1, 2, 3, 4, 5, 6, 7, 8}), 0x9FFFFFFF},
        {frame(0x7FF, false, {9}), 0x7FF},
        {frame(0, false), 0},
    };
    for (const auto& r : rows) {
        const ::can_frame k = to_kernel(r.frame);
        EXPECT_EQ(k.can_id, r.kernel_id);
        EXPECT_EQ(k.len, r.frame.size);
        EXPECT_TRUE(from_kernel(k).same(r.frame)) << to_text(r.frame);
    }
    Frame remote = frame(0x123, true);
    remote.remote = true;
    remote.size = 4;
    const ::can_frame k = to_kernel(remote);
    EXPECT_EQ(k.can_id, 0xC0000123u);
    EXPECT_EQ(k.len, 4);
    EXPECT_TRUE(from_kernel(k).remote);
    EXPECT_EQ(from_kernel(k).size, 4);
}

TEST(CanWire, neverBelievesALength) {
    ::can_frame k{};
    k.len = 200;
    EXPECT_EQ(from_kernel(k).size, 8);
    Frame f = frame(1, true);
    f.size = 200;
    EXPECT_EQ(to_kernel(f).len, 8);
}

TEST(CanWire, cutsIdentifiersToTheirForm) {
    EXPECT_EQ(to_kernel(frame(0x1234, false)).can_id, 0x234u);
    ::can_frame k{};
    k.can_id = 0x1FFFFFFF;  // no extended flag: only eleven bits count
    EXPECT_EQ(from_kernel(k).id, 0x7FFu);
    EXPECT_FALSE(from_kernel(k).extended);
}

::can_frame report(std::uint32_t classes, std::uint8_t controller = 0, std::uint8_t tx = 0, std::uint8_t rx = 0) {
    ::can_frame k{};
    k.can_id = classes | CAN_ERR_FLAG;
    k.len = CAN_ERR_DLC;
    k.data[1] = controller;
    k.data[6] = tx;
    k.data[7] = rx;
    return k;
}

TEST(CanWire, readsErrorReports) {
    const struct {
        ::can_frame kernel;
        bool bus_off, restarted, tx_timeout, no_ack, overflow;
        std::optional<CanState> state;
        const char* text;
    } rows[] = {
        {report(CAN_ERR_BUSOFF), true, false, false, false, false, CanState::bus_off, "bus-off"},
        {report(CAN_ERR_RESTARTED), false, true, false, false, false, CanState::active, "controller restarted"},
        {report(CAN_ERR_TX_TIMEOUT), false, false, true, false, false, {}, "transmission timed out"},
        {report(CAN_ERR_ACK), false, false, false, true, false, {}, "no acknowledgement"},
        {report(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE), false, false, false, false, false, CanState::passive, "error-passive"},
        {report(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE), false, false, false, false, false, CanState::passive, "error-passive"},
        {report(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING), false, false, false, false, false, CanState::warning, "error-warning"},
        {report(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_PASSIVE), false, false, false, false, false, CanState::passive,
         "error-passive"},
        {report(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE), false, false, false, false, false, CanState::active, "error-active"},
        {report(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW), false, false, false, false, true, {}, "controller buffer overflow"},
        {report(CAN_ERR_CRTL | CAN_ERR_ACK, CAN_ERR_CRTL_TX_PASSIVE), false, false, false, true, false, CanState::passive,
         "no acknowledgement, error-passive"},
        {report(CAN_ERR_BUSOFF | CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE), true, false, false, false, false, CanState::bus_off,
         "bus-off, error-passive"},
        {report(CAN_ERR_BUSOFF | CAN_ERR_RESTARTED), true, true, false, false, false, CanState::bus_off, "bus-off, controller restarted"},
        {report(CAN_ERR_LOSTARB), false, false, false, false, false, {}, "error report"},
    };
    for (const auto& r : rows) {
        const CanReport got = read_report(r.kernel);
        EXPECT_EQ(got.text, r.text);
        EXPECT_EQ(got.bus_off, r.bus_off) << r.text;
        EXPECT_EQ(got.restarted, r.restarted) << r.text;
        EXPECT_EQ(got.tx_timeout, r.tx_timeout) << r.text;
        EXPECT_EQ(got.no_ack, r.no_ack) << r.text;
        EXPECT_EQ(got.overflow, r.overflow) << r.text;
        EXPECT_EQ(got.state, r.state) << r.text;
        EXPECT_FALSE(got.has_counters);
        const Frame f = from_kernel(r.kernel);
        EXPECT_EQ(f.kind, Frame::Kind::can_error);
        EXPECT_EQ(f.id, r.kernel.can_id & CAN_ERR_MASK);
        EXPECT_EQ(f.size, 8);
    }
    const CanReport counted = read_report(report(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE, 136, 2));
    EXPECT_TRUE(counted.has_counters);
    EXPECT_EQ(counted.tx_errors, 136);
    EXPECT_EQ(counted.rx_errors, 2);
    EXPECT_TRUE(read_report(report(0x200)).has_counters);  // CAN_ERR_CNT: the counters are valid, and zero
}

TEST(CanWire, asksForTheReportsThatMatter) {
    const std::uint32_t c = can_error_classes();
    for (const std::uint32_t wanted : {CAN_ERR_TX_TIMEOUT, CAN_ERR_CRTL, CAN_ERR_ACK, CAN_ERR_BUSOFF, CAN_ERR_RESTARTED})
        EXPECT_NE(c & wanted, 0u) << wanted;
    EXPECT_EQ(c & CAN_ERR_BUSERROR, 0u);  // floods
    EXPECT_EQ(c & CAN_ERR_LOSTARB, 0u);
}

TEST(CanWire, makesFilters) {
    const auto everything = to_kernel(std::span<const CanFilter>{});
    ASSERT_EQ(everything.size(), 1u);
    EXPECT_EQ(everything[0].can_mask, 0u);
    const CanFilter two[] = {{0x04280000, 0x1FFF0000, true}, {0x123, 0x7FF, false}};
    const auto k = to_kernel(two);
    ASSERT_EQ(k.size(), 2u);
    EXPECT_EQ(k[0].can_id, 0x84280000u);
    EXPECT_EQ(k[0].can_mask, 0x9FFF0000u);
    EXPECT_EQ(k[1].can_id, 0x123u);
    EXPECT_EQ(k[1].can_mask, 0x800007FFu);
    EXPECT_EQ(to_kernel(std::vector<CanFilter>(most_can_filters)).size(), most_can_filters);
    EXPECT_EQ(to_kernel(std::vector<CanFilter>(most_can_filters + 1)).size(), 1u);

    // Our filter agrees with the kernel's rule, (received & mask) == (filter & mask), for frames of both forms.
    for (std::uint32_t id = 0; id < 0x800; ++id) {
        for (const bool extended : {false, true}) {
            const Frame f = frame(extended ? 0x04280000 + id * 0x100 : id, extended);
            const std::uint32_t kernel_id = to_kernel(f).can_id;
            bool kernel_passes = false;
            for (const auto& x : k)
                kernel_passes = kernel_passes || (kernel_id & x.can_mask) == (x.can_id & x.can_mask);
            EXPECT_EQ(passes(two, f), kernel_passes) << to_text(f);
        }
    }
    EXPECT_TRUE(passes({}, frame(1, true)));
    EXPECT_TRUE(passes(std::vector<CanFilter>(most_can_filters + 1, {1, 0x7FF, false}), frame(9, true)));
}

/// A control buffer as the kernel writes it.
struct Control {
    alignas(cmsghdr) std::array<std::uint8_t, 256> bytes{};
    std::size_t used = 0;
    void add(int level, int type, const void* data, std::size_t size) {
        cmsghdr head{};
        head.cmsg_len = CMSG_LEN(size);
        head.cmsg_level = level;
        head.cmsg_type = type;
        std::memcpy(bytes.data() + used, &head, sizeof head);
        std::memcpy(bytes.data() + used + CMSG_LEN(0), data, size);
        used += CMSG_SPACE(size);
    }
    [[nodiscard]] msghdr message() {
        msghdr m{};
        m.msg_control = bytes.data();
        m.msg_controllen = used;
        return m;
    }
};

TEST(CanWire, readsWhatComesBesideAFrame) {
    Control none;
    EXPECT_EQ(read_beside(none.message()).stamp_unix_ns, 0);
    EXPECT_FALSE(read_beside(none.message()).overflow);

    Control c;
    const std::array<timespec, 3> three{timespec{1700000000, 123456789}, timespec{}, timespec{99, 99}};
    const std::uint32_t lost = 7;
    c.add(SOL_SOCKET, SO_TIMESTAMPING, three.data(), sizeof three);
    c.add(SOL_SOCKET, SO_RXQ_OVFL, &lost, sizeof lost);
    const CanBeside b = read_beside(c.message());
    EXPECT_EQ(b.stamp_unix_ns, 1'700'000'000'123'456'789);
    EXPECT_EQ(b.overflow, 7u);

    Control ns;
    const timespec one{5, 6};
    ns.add(SOL_SOCKET, SO_TIMESTAMPNS, &one, sizeof one);
    EXPECT_EQ(read_beside(ns.message()).stamp_unix_ns, 5'000'000'006);

    Control odd;  // too short, or of another kind: ignored
    odd.add(SOL_SOCKET, SO_TIMESTAMPING, &one, 4);
    odd.add(SOL_SOCKET, SO_RXQ_OVFL, &one, 2);
    odd.add(SOL_SOCKET + 1, SO_RXQ_OVFL, &lost, sizeof lost);
    EXPECT_EQ(read_beside(odd.message()).stamp_unix_ns, 0);
    EXPECT_FALSE(read_beside(odd.message()).overflow);
}

TEST(CanWire, placesStampsOnOurTimeLine) {
    const Instant now = at_ns(5'000'000'000);
    EXPECT_EQ(instant_of_stamp(999'999'000, 1'000'000'000, now), now - std::chrono::microseconds(1));
    EXPECT_EQ(instant_of_stamp(1'000'000'000, 1'000'000'000, now), now);
    EXPECT_EQ(instant_of_stamp(0, 1'000'000'000, now), now);
    EXPECT_EQ(instant_of_stamp(1'000'000'001, 1'000'000'000, now), now);  // the wall clock was set back
    EXPECT_EQ(instant_of_stamp(1, 9'000'000'000, now), now);              // or forward
}

TEST(CanWire, saysWhyACanSocketCannotBeOpened) {
    EXPECT_EQ(can_open_fault("can0", "socket", EAFNOSUPPORT),
              "this kernel has no CAN (address family not supported): load the modules can, can_raw");
    EXPECT_THAT(can_open_fault("can0", "interface", ENODEV), HasSubstr("no network interface can0"));
    EXPECT_THAT(can_open_fault("can0", "interface", ENETDOWN), HasSubstr("ip link set can0 up type can bitrate"));
    EXPECT_THAT(can_open_fault("can0", "socket", EPERM), HasSubstr("not permitted"));
    EXPECT_THAT(can_open_fault("can0", "bind", ENOMEM), HasSubstr("Cannot allocate memory (12)"));
}

TEST(CanWire, namesStates) {
    EXPECT_EQ(name_of(CanState::active), "error-active");
    EXPECT_EQ(name_of(CanState::warning), "error-warning");
    EXPECT_EQ(name_of(CanState::passive), "error-passive");
    EXPECT_EQ(name_of(CanState::bus_off), "bus-off");
    EXPECT_EQ(name_of(CanState::stopped), "stopped");
    EXPECT_EQ(name_of(CanState::sleeping), "sleeping");
}

// --- netlink --------------------------------------------------------------------------------------------------------

using Bytes = std::vector<std::uint8_t>;

void put(Bytes& b, const void* data, std::size_t size) {
    const auto* p = static_cast<const std::uint8_t*>(data);
    b.insert(b.end(), p, p + size);
}
Bytes attribute(std::uint16_t type, const Bytes& value) {
    Bytes b;
    const rtattr head{static_cast<unsigned short>(value.size() + 4), type};
    put(b, &head, sizeof head);
    put(b, value.data(), value.size());
    b.resize((b.size() + 3) / 4 * 4);
    return b;
}
template <class T>
Bytes value(const T& t) {
    Bytes b;
    put(b, &t, sizeof t);
    return b;
}
Bytes join(std::initializer_list<Bytes> list) {
    Bytes b;
    for (const auto& x : list)
        b.insert(b.end(), x.begin(), x.end());
    return b;
}
Bytes message(std::uint16_t type, const Bytes& body, std::uint32_t sequence = 0) {
    nlmsghdr head{};
    head.nlmsg_len = static_cast<std::uint32_t>(sizeof head + body.size());
    head.nlmsg_type = type;
    head.nlmsg_seq = sequence;
    return join({value(head), body});
}
Bytes text_value(const char* s) { return Bytes(s, s + std::strlen(s) + 1); }
Bytes link(int index, unsigned flags, const Bytes& attributes) {
    ifinfomsg i{};
    i.ifi_index = index;
    i.ifi_flags = flags;
    return join({value(i), attributes});
}
Bytes can_info(const char* type, std::uint32_t bit_rate, std::uint32_t state, std::uint32_t restart_ms) {
    can_bittiming t{};
    t.bitrate = bit_rate;
    const can_berr_counter errors{300, 5};
    const Bytes data = join({attribute(IFLA_CAN_BITTIMING, value(t)), attribute(IFLA_CAN_STATE, value(state)),
                             attribute(IFLA_CAN_RESTART_MS, value(restart_ms)), attribute(IFLA_CAN_BERR_COUNTER, value(errors))});
    return attribute(IFLA_LINKINFO, join({attribute(IFLA_INFO_KIND, text_value(type)), attribute(IFLA_INFO_DATA | NLA_F_NESTED, data)}));
}

TEST(CanLink, readsWhatTheKernelTells) {
    const Bytes m = message(
        RTM_NEWLINK, link(7, IFF_UP, join({attribute(IFLA_IFNAME, text_value("can0")), can_info("can", 500'000, CAN_STATE_BUS_OFF, 100)})));
    const auto news = read_link_news(m);
    ASSERT_EQ(news.size(), 1u);
    EXPECT_EQ(news[0].kind, LinkNews::Kind::link);
    EXPECT_EQ(news[0].index, 7);
    EXPECT_EQ(news[0].name, "can0");
    EXPECT_TRUE(news[0].up);
    EXPECT_EQ(news[0].type, "can");
    EXPECT_EQ(news[0].bit_rate, 500'000u);
    EXPECT_EQ(news[0].state, CanState::bus_off);
    EXPECT_EQ(news[0].restart_ms, 100u);
    EXPECT_TRUE(news[0].has_counters);
    EXPECT_EQ(news[0].tx_errors, 255);  // the kernel's may be larger than a byte
    EXPECT_EQ(news[0].rx_errors, 5);
}

TEST(CanLink, readsSeveralMessagesAndLeavesOutTheRest) {
    const nlmsgerr denied{-EPERM, {}};
    const nlmsgerr good{0, {}};
    const Bytes all = join({message(RTM_NEWADDR, Bytes(20)), message(RTM_DELLINK, link(3, 0, attribute(IFLA_IFNAME, text_value("can1")))),
                            message(NLMSG_ERROR, value(denied), 9), message(NLMSG_ERROR, value(good), 10),
                            message(RTM_NEWLINK, link(4, 0, can_info("vcan", 1, 1, 1)))});
    const auto news = read_link_news(all);
    ASSERT_EQ(news.size(), 4u);
    EXPECT_EQ(news[0].kind, LinkNews::Kind::removed);
    EXPECT_EQ(news[0].name, "can1");
    EXPECT_EQ(news[1].kind, LinkNews::Kind::answer);
    EXPECT_EQ(news[1].error, EPERM);
    EXPECT_EQ(news[1].sequence, 9u);
    EXPECT_EQ(news[2].error, 0);
    EXPECT_FALSE(news[3].up);
    EXPECT_EQ(news[3].type, "vcan");
    EXPECT_EQ(news[3].bit_rate, 0u);  // only a CAN controller has these attributes
    EXPECT_FALSE(news[3].state);
}

TEST(CanLink, survivesAnyBytes) {
    const Bytes good = message(
        RTM_NEWLINK, link(7, IFF_UP, join({attribute(IFLA_IFNAME, text_value("can0")), can_info("can", 500'000, CAN_STATE_BUS_OFF, 100)})));
    for (std::size_t n = 0; n < good.size(); ++n) {
        (void)read_link_news(std::span(good).first(n));
        for (const int v : {0, 1, 3, 4, 0x7F, 0x80, 0xFF}) {
            Bytes changed = good;
            changed[n] = static_cast<std::uint8_t>(v);
            for (const auto& news : read_link_news(changed))
                EXPECT_LE(news.name.size(), good.size());
        }
    }
}

TEST(CanLink, asksAsTheIpProgramDoes) {
    // struct nlmsghdr (length 52, RTM_NEWLINK, REQUEST|ACK, sequence), struct ifinfomsg (index 7), LINKINFO {KIND "can", DATA {RESTART 1}}
    const Bytes restart{0x38, 0, 0,    0, 0x10, 0, 0x05, 0, 0x2A, 0,   0,   0, 0,    0, 0, 0,  //
                        0,    0, 0,    0, 7,    0, 0,    0, 0,    0,   0,   0, 0,    0, 0, 0,  //
                        0x18, 0, 0x12, 0, 7,    0, 1,    0, 'c',  'a', 'n', 0, 0x0C, 0, 2, 0, 8, 0, 7, 0, 1, 0, 0, 0};
    EXPECT_EQ(restart_request(7, 42), restart);
    const Bytes question{0x20, 0, 0, 0, 0x12, 0, 0x01, 0, 0x2B, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(link_request(7, 43), question);
}

TEST(CanLink, theKernelUnderstandsTheQuestion) {
    // This machine's own loopback interface instead of CAN: the same question, the same answer.
    const CanOpened links = linux_can().open_links();
    ASSERT_GE(links.fd, 0) << links.fault;
    const int loopback = static_cast<int>(::if_nametoindex("lo"));
    const Bytes q = link_request(loopback, 1);
    ASSERT_EQ(::send(links.fd, q.data(), q.size(), 0), static_cast<ssize_t>(q.size()));
    Bytes buffer(32 * 1024);
    const ssize_t n = ::recv(links.fd, buffer.data(), buffer.size(), 0);
    ASSERT_GT(n, 0);
    ::close(links.fd);
    const auto news = read_link_news(std::span(buffer).first(static_cast<std::size_t>(n)));
    ASSERT_EQ(news.size(), 1u);
    EXPECT_EQ(news[0].name, "lo");
    EXPECT_EQ(news[0].index, loopback);
}

}  // namespace
}  // namespace axisgate
