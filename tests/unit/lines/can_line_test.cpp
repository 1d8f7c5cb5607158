// CanLine with a fake kernel: datagram sockets that carry the same structures as CAN and netlink sockets. No CAN interface is needed.
#include "gateway/lines/can_line.hpp"

#include <gmock/gmock.h>
#include <linux/can/error.h>
#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>

#include <cstring>
#include <deque>

#include "tests/unit/lines/fixture.hpp"

namespace axisgate {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

Frame can(std::uint32_t id, std::initializer_list<std::uint8_t> data = {}) {
    return Frame::can_extended(id, std::span<const std::uint8_t>(data.begin(), data.size()));
}

/// The kernel's side. An echo is marked in a byte that CAN does not use.
struct FakeKernel final : CanKernel {
    mutable Fd wire, links;
    mutable int opened = 0;
    mutable std::string fault;  // of the next attempts to open
    mutable std::deque<int> send_errors;
    mutable std::vector<CanFilter> filters;
    mutable int sends = 0;
    int index = 7;
    bool has_links = true;

    static CanOpened pair(Fd& other) {
        std::array<int, 2> fds{};
        EXPECT_EQ(::socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, fds.data()), 0);
        other = Fd(fds[1]);
        CanOpened o;
        o.fd = fds[0];
        return o;
    }
    CanOpened open_can(const std::string&, std::span<const CanFilter> f) const override {
        ++opened;
        filters.assign(f.begin(), f.end());
        CanOpened o;
        o.fault = fault;
        if (fault.empty()) o = pair(wire);
        o.index = index;
        return o;
    }
    CanOpened open_links() const override {
        if (!has_links) return {};
        return pair(links);
    }
    int send(int fd, const ::can_frame& f) const override {
        ++sends;
        if (!send_errors.empty()) {
            const int e = send_errors.front();
            send_errors.pop_front();
            if (e != 0) return e;
        }
        return ::send(fd, &f, sizeof f, MSG_NOSIGNAL) >= 0 ? 0 : errno;
    }
    bool is_echo(const ::can_frame& f, int) const override { return f.__res0 == 1; }

    /// The frames that the line has given to the controller.
    [[nodiscard]] std::vector<std::uint32_t> take() const {
        std::vector<std::uint32_t> ids;
        ::can_frame f{};
        while (::recv(wire.fd, &f, sizeof f, 0) == sizeof f) {
            ids.push_back(f.can_id & CAN_EFF_MASK);
            last = f;
        }
        return ids;
    }
    void say(::can_frame f) const { EXPECT_EQ(::send(wire.fd, &f, sizeof f, 0), static_cast<ssize_t>(sizeof f)); }
    void say(const Frame& f) const { say(to_kernel(f)); }
    void echo(const Frame& f) const {
        ::can_frame k = to_kernel(f);
        k.__res0 = 1;
        say(k);
    }
    void report(std::uint32_t classes, std::uint8_t controller = 0, std::uint8_t tx = 0, std::uint8_t rx = 0) const {
        ::can_frame k{};
        k.can_id = classes | CAN_ERR_FLAG;
        k.len = 8;
        k.data[1] = controller;
        k.data[6] = tx;
        k.data[7] = rx;
        say(k);
    }
    /// Questions and orders of the line, as message types.
    [[nodiscard]] std::vector<std::uint16_t> asked() const {
        std::vector<std::uint16_t> types;
        std::array<std::uint8_t, 512> b{};
        while (::recv(links.fd, b.data(), b.size(), 0) > 0) {
            nlmsghdr h{};
            std::memcpy(&h, b.data(), sizeof h);
            types.push_back(h.nlmsg_type);
            if (h.nlmsg_type == RTM_NEWLINK) restart_sequence = h.nlmsg_seq;
        }
        return types;
    }
    void tell(const std::vector<std::uint8_t>& datagram) const {
        EXPECT_EQ(::send(links.fd, datagram.data(), datagram.size(), 0), static_cast<ssize_t>(datagram.size()));
    }
    mutable ::can_frame last{};
    mutable std::uint32_t restart_sequence = 0;
};

// --- netlink messages as the kernel sends them -------------------------------------------------------------------------

std::vector<std::uint8_t> attribute(std::uint16_t type, const void* data, std::size_t size) {
    std::vector<std::uint8_t> b(4 + (size + 3) / 4 * 4);
    const rtattr head{static_cast<unsigned short>(4 + size), type};
    std::memcpy(b.data(), &head, 4);
    std::memcpy(b.data() + 4, data, size);
    return b;
}
void append(std::vector<std::uint8_t>& to, const std::vector<std::uint8_t>& more) { to.insert(to.end(), more.begin(), more.end()); }

std::vector<std::uint8_t> with_header(std::uint16_t type, std::uint32_t sequence, const void* head, std::size_t size,
                                      const std::vector<std::uint8_t>& rest) {
    nlmsghdr h{};
    h.nlmsg_len = static_cast<std::uint32_t>(sizeof h + size + rest.size());
    h.nlmsg_type = type;
    h.nlmsg_seq = sequence;
    std::vector<std::uint8_t> m(sizeof h + size);
    std::memcpy(m.data(), &h, sizeof h);
    std::memcpy(m.data() + sizeof h, head, size);
    append(m, rest);
    return m;
}
std::vector<std::uint8_t> link_news(int index, const char* name, bool up, std::uint32_t state = CAN_STATE_ERROR_ACTIVE,
                                    std::uint32_t restart_ms = 0, bool removed = false) {
    ifinfomsg i{};
    i.ifi_index = index;
    i.ifi_flags = up ? IFF_UP : 0;
    can_bittiming timing{};
    timing.bitrate = 250'000;
    std::vector<std::uint8_t> data = attribute(IFLA_CAN_BITTIMING, &timing, sizeof timing);
    append(data, attribute(IFLA_CAN_STATE, &state, sizeof state));
    append(data, attribute(IFLA_CAN_RESTART_MS, &restart_ms, sizeof restart_ms));
    std::vector<std::uint8_t> info = attribute(IFLA_INFO_KIND, "can", 4);
    append(info, attribute(IFLA_INFO_DATA, data.data(), data.size()));
    std::vector<std::uint8_t> rest = attribute(IFLA_IFNAME, name, std::strlen(name) + 1);
    append(rest, attribute(IFLA_LINKINFO, info.data(), info.size()));
    return with_header(removed ? RTM_DELLINK : RTM_NEWLINK, 0, &i, sizeof i, rest);
}
std::vector<std::uint8_t> answer(std::uint32_t sequence, int error) {
    nlmsgerr e{};
    e.error = -error;
    return with_header(NLMSG_ERROR, sequence, &e, sizeof e, {});
}

class CanLineTest : public LineTest {
protected:
    FakeKernel kernel;
    std::unique_ptr<CanLine> line;

    void open(CanLineOptions options = {}, Duration first = milliseconds(5), Duration last = milliseconds(40)) {
        options.restart_pauses = {milliseconds(5), milliseconds(40)};
        line = std::make_unique<CanLine>(base(first, last), "can0", options, kernel);
        ASSERT_TRUE(comes_up(*line));
        if (!kernel.has_links) return;
        ASSERT_TRUE(until([&] {
            asked_at_open = kernel.asked();
            return !asked_at_open.empty();
        }));
    }
    bool send(const Frame& f, Priority p = Priority::command) { return line->send(f, p, clock.now()); }
    [[nodiscard]] LineStatus status() const { return line->status(clock.now()); }
    [[nodiscard]] std::vector<std::uint32_t> sent_ids() const {
        std::vector<std::uint32_t> ids;
        for (const auto& f : owner.sent)
            ids.push_back(f.id);
        return ids;
    }
    std::vector<std::uint16_t> asked_at_open;
};

TEST_F(CanLineTest, sendsAndReceives) {
    open({500'000, {}, {}, secs(1)});
    EXPECT_THAT(asked_at_open, ElementsAre(RTM_GETLINK));
    EXPECT_EQ(owner.states.back().second, "up on can0 at 500000 bit/s");
    EXPECT_TRUE(send(can(0x04280095, {1, 2})));
    EXPECT_TRUE(owner.sent.empty());
    settle();
    EXPECT_THAT(kernel.take(), ElementsAre(0x04280095));
    EXPECT_EQ(kernel.last.len, 2);
    EXPECT_TRUE(owner.sent.empty());  // not before the controller says so
    kernel.echo(can(0x04280095, {1, 2}));
    kernel.say(can(0x123, {3}));
    ASSERT_TRUE(until([&] { return owner.frames.size() == 1; }));
    ASSERT_EQ(owner.sent.size(), 1u);
    EXPECT_TRUE(owner.sent[0].same(can(0x04280095, {1, 2})));
    EXPECT_TRUE(owner.frames[0].same(can(0x123, {3})));
    EXPECT_LE(owner.frames[0].at, clock.now());
    EXPECT_GT(owner.frames[0].at, clock.now() - secs(5));
    const LineStatus s = status();
    EXPECT_EQ(s.frames_in, 1u);
    EXPECT_EQ(s.frames_out, 1u);
    EXPECT_EQ(s.bytes_in, 1u);
    EXPECT_EQ(s.bytes_out, 2u);
    EXPECT_GT(s.load, 0.0);
}

TEST_F(CanLineTest, keepsFewFramesUnderWaySoThatAStopOvertakes) {
    open();
    for (std::uint32_t i = 1; i <= 10; ++i)
        EXPECT_TRUE(send(can(i), Priority::poll));
    settle();
    EXPECT_THAT(kernel.take(), ElementsAre(1, 2, 3, 4));
    EXPECT_EQ(status().queued, 6u);
    EXPECT_TRUE(send(can(99), Priority::urgent));
    settle();
    EXPECT_TRUE(kernel.take().empty());
    kernel.echo(can(1));
    ASSERT_TRUE(until([&] { return owner.sent.size() == 1; }));
    settle();
    EXPECT_THAT(kernel.take(), ElementsAre(99));
    for (const std::uint32_t id : {2u, 3u, 4u, 99u})
        kernel.echo(can(id));
    ASSERT_TRUE(until([&] { return owner.sent.size() == 5; }));
    settle();
    EXPECT_THAT(kernel.take(), ElementsAre(5, 6, 7, 8));
    EXPECT_THAT(sent_ids(), ElementsAre(1, 2, 3, 4, 99));
}

TEST_F(CanLineTest, isBounded) {
    open();
    int taken = 0;
    for (int i = 0; i < 400; ++i)
        taken += send(can(1), Priority::poll) ? 1 : 0;
    EXPECT_EQ(taken, 256);
    EXPECT_EQ(status().dropped, 144u);
    EXPECT_TRUE(send(can(2), Priority::urgent));
    EXPECT_EQ(status().dropped, 145u);
    EXPECT_FALSE(send(text("bytes do not belong here")));
}

TEST_F(CanLineTest, waitsWhenTheInterfacesQueueIsFull) {
    open();
    kernel.send_errors = {ENOBUFS, ENOBUFS, ENOBUFS};
    EXPECT_TRUE(send(can(1)));
    EXPECT_TRUE(send(can(2)));
    std::vector<std::uint32_t> out;
    ASSERT_TRUE(until([&] {
        for (const auto id : kernel.take())
            out.push_back(id);
        return out.size() == 2;
    }));
    EXPECT_THAT(out, ElementsAre(1, 2));
    EXPECT_EQ(line->counters().tx_full, 3u);
    EXPECT_EQ(status().dropped, 0u);
    EXPECT_TRUE(owner.up());
}

TEST_F(CanLineTest, waitsForRoomInTheSocket) {
    open();
    kernel.send_errors = {EAGAIN};
    EXPECT_TRUE(send(can(1)));
    std::vector<std::uint32_t> out;
    ASSERT_TRUE(until([&] {
        for (const auto id : kernel.take())
            out.push_back(id);
        return out.size() == 1;
    }));
    EXPECT_EQ(kernel.sends, 2);
}

TEST_F(CanLineTest, aFrameThatIsNotWantedDoesNotStopTheOthers) {
    open();
    kernel.send_errors = {EINVAL};
    EXPECT_TRUE(send(can(1)));
    EXPECT_TRUE(send(can(2)));
    settle();
    EXPECT_THAT(kernel.take(), ElementsAre(2));
    EXPECT_EQ(status().errors, 1u);
    EXPECT_EQ(status().dropped, 1u);
}

TEST_F(CanLineTest, saysSoWhenNobodyAcknowledges) {
    open({0, {}, {}, milliseconds(20)});
    for (std::uint32_t i = 1; i <= 6; ++i)
        EXPECT_TRUE(send(can(i)));
    settle();
    EXPECT_THAT(kernel.take(), ElementsAre(1, 2, 3, 4));
    ASSERT_TRUE(until([&] { return line->counters().tx_stalled == 1; }));
    EXPECT_THAT(status().text, HasSubstr("nobody acknowledges"));
    EXPECT_TRUE(owner.up());
    settle();
    EXPECT_THAT(kernel.take(), ElementsAre(5));  // from now on one at a time
    ASSERT_TRUE(until([&] { return line->counters().tx_stalled == 2; }));
    EXPECT_THAT(kernel.take(), ElementsAre(6));
    kernel.echo(can(1));  // another node answers after all
    ASSERT_TRUE(until([&] { return owner.sent.size() == 1; }));
    EXPECT_THAT(status().text, testing::Not(HasSubstr("nobody")));
}

TEST_F(CanLineTest, aFrameThatWaitedTooLongIsNotSentAnyMore) {
    open();
    for (std::uint32_t i = 1; i <= 6; ++i)
        EXPECT_TRUE(send(can(i)));
    settle();
    EXPECT_EQ(kernel.take().size(), 4u);
    clock.ahead = stale_send_limit + milliseconds(1);
    EXPECT_TRUE(send(can(7)));
    kernel.echo(can(1));
    ASSERT_TRUE(until([&] { return owner.sent.size() == 1; }));
    settle();
    EXPECT_THAT(kernel.take(), ElementsAre(7));
    EXPECT_EQ(status().dropped, 2u);
}

TEST_F(CanLineTest, goesDownWithTheInterfaceAndComesBack) {
    open();
    kernel.send_errors = {ENETDOWN};
    kernel.fault = can_open_fault("can0", "interface", ENETDOWN);
    EXPECT_TRUE(send(can(1)));
    ASSERT_TRUE(until([&] { return owner.states.size() == 2; }));
    EXPECT_FALSE(owner.up());
    EXPECT_THAT(owner.states.back().second, HasSubstr("ip link set can0 up"));
    EXPECT_EQ(status().state, LineStatus::State::down);
    EXPECT_FALSE(send(can(2)));
    const int before = kernel.opened;
    ASSERT_TRUE(until([&] { return kernel.opened >= before + 3; }));  // tries again and again
    EXPECT_EQ(owner.states.size(), 2u);                               // and reports it once
    kernel.fault.clear();
    ASSERT_TRUE(until([&] { return owner.up(); }));
    EXPECT_EQ(status().reopened, 1u);
}

TEST_F(CanLineTest, pausesGrowWhileItStaysAway) {
    kernel.fault = "there is no network interface can0";
    line = std::make_unique<CanLine>(base(milliseconds(10), milliseconds(80)), "can0", CanLineOptions{}, kernel);
    line->open(owner, clock.now());
    ASSERT_TRUE(until([&] { return !owner.states.empty(); }));
    EXPECT_FALSE(owner.up());
    EXPECT_EQ(owner.states[0].second, "there is no network interface can0");
    run_for(milliseconds(200));  // 10 + 20 + 40 + 80 ...: five attempts, not twenty
    EXPECT_GE(kernel.opened, 4);
    EXPECT_LE(kernel.opened, 7);
    EXPECT_EQ(status().text, "there is no network interface can0");
}

TEST_F(CanLineTest, busOffIsAStateOfItsOwnAndIsRestarted) {
    open();
    for (std::uint32_t i = 1; i <= 8; ++i)
        (void)send(can(i));
    settle();
    (void)kernel.take();
    kernel.report(CAN_ERR_BUSOFF);
    ASSERT_TRUE(until([&] { return owner.states.size() == 2; }));
    EXPECT_FALSE(owner.up());
    EXPECT_THAT(owner.states.back().second, StartsWith("can0 is bus-off after too many errors"));
    EXPECT_EQ(status().state, LineStatus::State::bus_off);
    EXPECT_EQ(status().queued, 0u);
    EXPECT_EQ(status().dropped, 4u);
    EXPECT_FALSE(send(can(9), Priority::urgent));
    ASSERT_EQ(owner.frames.size(), 1u);  // the report, for the trace
    EXPECT_EQ(owner.frames[0].kind, Frame::Kind::can_error);
    EXPECT_EQ(owner.frames[0].id, CAN_ERR_BUSOFF);

    std::vector<std::uint16_t> asked;
    ASSERT_TRUE(until([&] {
        for (const auto t : kernel.asked())
            asked.push_back(t);
        return std::ranges::count(asked, RTM_NEWLINK) >= 2;  // asks again, with growing pauses
    }));
    EXPECT_GE(line->counters().restarts_asked, 2u);
    kernel.tell(answer(kernel.restart_sequence, 0));
    kernel.report(CAN_ERR_RESTARTED);
    ASSERT_TRUE(until([&] { return owner.up(); }));
    EXPECT_EQ(owner.states.size(), 3u);
    EXPECT_THAT(owner.states.back().second, HasSubstr("after bus-off"));
    EXPECT_EQ(status().reopened, 1u);
    EXPECT_EQ(line->counters().bus_off, 1u);
    EXPECT_EQ(kernel.opened, 1);  // the socket stays
    (void)kernel.asked();
    EXPECT_TRUE(send(can(10)));
    settle();
    EXPECT_THAT(kernel.take(), ElementsAre(10));
    run_for(milliseconds(60));
    EXPECT_TRUE(kernel.asked().empty());  // nothing more to restart
}

TEST_F(CanLineTest, saysWhatToTypeWhenItMayNotRestart) {
    open();
    kernel.report(CAN_ERR_BUSOFF);
    ASSERT_TRUE(until([&] { return std::ranges::count(kernel.asked(), RTM_NEWLINK) > 0; }));
    kernel.tell(answer(kernel.restart_sequence, EPERM));
    ASSERT_TRUE(until([&] { return status().text.find("ip link set can0 type can restart-ms 100") != std::string::npos; }));
    EXPECT_THAT(status().text, HasSubstr("not permitted"));
    EXPECT_EQ(status().state, LineStatus::State::bus_off);
    kernel.tell(answer(1, 0));  // an answer to another question changes nothing
    settle();
    EXPECT_THAT(status().text, HasSubstr("not permitted"));
}

TEST_F(CanLineTest, saysWhatToTypeWithoutNetlink) {
    kernel.has_links = false;
    open();
    kernel.report(CAN_ERR_BUSOFF);
    ASSERT_TRUE(until([&] { return status().text.find("restart-ms 100") != std::string::npos; }));
    kernel.report(CAN_ERR_RESTARTED);
    EXPECT_TRUE(until([&] { return owner.up(); }));
}

TEST_F(CanLineTest, leavesAControllerAloneThatRestartsItself) {
    open();
    kernel.tell(link_news(7, "can0", true, CAN_STATE_ERROR_ACTIVE, 100));
    ASSERT_TRUE(until([&] { return status().text == "up on can0 at 250000 bit/s"; }));
    kernel.report(CAN_ERR_BUSOFF);
    ASSERT_TRUE(until([&] { return !owner.up(); }));
    EXPECT_THAT(owner.states.back().second, HasSubstr("by itself after 100 ms"));
    run_for(milliseconds(60));
    EXPECT_EQ(std::ranges::count(kernel.asked(), RTM_NEWLINK), 0);
    EXPECT_EQ(line->counters().restarts_asked, 0u);
    kernel.tell(link_news(7, "can0", true, CAN_STATE_ERROR_ACTIVE, 100));  // the report itself was lost
    EXPECT_TRUE(until([&] { return owner.up(); }));
}

TEST_F(CanLineTest, findsAControllerThatIsBusOffAlready) {
    open();
    kernel.tell(link_news(7, "can0", true, CAN_STATE_BUS_OFF));
    ASSERT_TRUE(until([&] { return status().state == LineStatus::State::bus_off; }));
    EXPECT_FALSE(owner.up());
    kernel.tell(link_news(7, "can0", true, CAN_STATE_STOPPED));  // on its way: not yet
    settle();
    EXPECT_EQ(status().state, LineStatus::State::bus_off);
    kernel.tell(link_news(7, "can0", true, CAN_STATE_ERROR_WARNING));
    EXPECT_TRUE(until([&] { return owner.up(); }));
}

TEST_F(CanLineTest, noticesAnInterfaceThatIsSetDownOrRemoved) {
    open({}, secs(60), secs(60));  // the pause must not be the reason for its return
    kernel.fault = "down";
    kernel.tell(link_news(9, "can1", false));  // another interface
    settle();
    EXPECT_TRUE(owner.up());
    kernel.tell(link_news(7, "can0", false));
    ASSERT_TRUE(until([&] { return !owner.up(); }));
    EXPECT_THAT(owner.states.back().second, HasSubstr("can0 is down"));
    kernel.fault.clear();
    kernel.tell(link_news(9, "can1", true));
    run_for(milliseconds(30));
    EXPECT_FALSE(owner.up());
    kernel.tell(link_news(7, "can0", true));
    ASSERT_TRUE(until([&] { return owner.up(); }));

    kernel.tell(link_news(7, "can0", false, CAN_STATE_STOPPED, 0, true));
    ASSERT_TRUE(until([&] { return !owner.up(); }));
    EXPECT_THAT(owner.states.back().second, HasSubstr("no network interface can0"));
    kernel.index = 12;  // plugged in again, under a new number
    kernel.tell(link_news(12, "can0", true));
    ASSERT_TRUE(until([&] { return owner.up(); }));
    kernel.tell(link_news(7, "can0", false));  // a message about the old one
    settle();
    EXPECT_TRUE(owner.up());
    EXPECT_EQ(status().reopened, 2u);
}

TEST_F(CanLineTest, showsErrorStatesAndCounters) {
    open();
    kernel.report(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE, 136, 4);
    ASSERT_TRUE(until([&] { return status().tx_errors == 136; }));
    EXPECT_EQ(status().rx_errors, 4);
    EXPECT_EQ(status().errors, 1u);
    EXPECT_THAT(status().text, HasSubstr("error-passive (tx 136, rx 4)"));
    EXPECT_TRUE(owner.up());
    kernel.report(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE, 90, 0);
    ASSERT_TRUE(until([&] { return status().tx_errors == 90; }));
    EXPECT_EQ(status().text, "up on can0");
}

TEST_F(CanLineTest, framesOfTheWrongSizeAreCounted) {
    open();
    EXPECT_EQ(::send(kernel.wire.fd, "short", 5, 0), 5);
    std::array<std::uint8_t, 72> fd_frame{};  // a CAN FD frame, which was not requested
    EXPECT_EQ(::send(kernel.wire.fd, fd_frame.data(), fd_frame.size(), 0), 72);
    kernel.say(can(1));
    ASSERT_TRUE(until([&] { return owner.frames.size() == 1; }));
    EXPECT_EQ(status().errors, 2u);
}

TEST_F(CanLineTest, takesManyFramesPerTurnAndLosesNone) {
    open();
    std::size_t reported = 0;
    ASSERT_TRUE(until([&] {
        ::can_frame k = to_kernel(can(static_cast<std::uint32_t>(reported)));
        while (reported < 2000 && ::send(kernel.wire.fd, &k, sizeof k, 0) == sizeof k)
            k = to_kernel(can(static_cast<std::uint32_t>(++reported)));
        return owner.frames.size() == 2000;
    }));
    for (std::uint32_t i = 0; i < 2000; ++i)
        ASSERT_EQ(owner.frames[i].id, i);
}

TEST_F(CanLineTest, framesWhoseEchoTheFilterHidesCountAsSentAtOnce) {
    open({0, {{0x100, 0x700, true}}, {}, secs(1)});
    EXPECT_EQ(kernel.filters, (std::vector<CanFilter>{{0x100, 0x700, true}}));
    for (int i = 0; i < 10; ++i)
        EXPECT_TRUE(send(can(0x200)));
    EXPECT_TRUE(send(can(0x123)));
    settle();
    EXPECT_EQ(kernel.take().size(), 11u);
    EXPECT_EQ(owner.sent.size(), 10u);
    kernel.echo(can(0x123));
    EXPECT_TRUE(until([&] { return owner.sent.size() == 11; }));
}

TEST_F(CanLineTest, opensAnewWithOtherFilters) {
    open();
    line->set_filters({{1, 2, true}});
    ASSERT_TRUE(until([&] { return kernel.opened == 2 && owner.up(); }));
    EXPECT_EQ(kernel.filters.size(), 1u);
    line->set_filters({{1, 2, true}});  // the same: nothing happens
    settle();
    EXPECT_EQ(kernel.opened, 2);
}

TEST_F(CanLineTest, mayBeClosedOrDestroyedFromItsEvents) {
    open();
    owner.on_received = [&](const Frame&) { line->close(); };
    kernel.say(can(1));
    kernel.say(can(2));
    ASSERT_TRUE(until([&] { return !owner.frames.empty(); }));
    settle();
    EXPECT_EQ(owner.frames.size(), 1u);
    EXPECT_EQ(status().state, LineStatus::State::closed);

    owner.on_received = [&](const Frame&) { line.reset(); };
    owner.frames.clear();
    owner.states.clear();
    ASSERT_TRUE(comes_up(*line));
    kernel.say(can(1));
    kernel.say(can(2));
    ASSERT_TRUE(until([&] { return line == nullptr; }));
    settle();
    EXPECT_EQ(owner.frames.size(), 1u);
}

TEST_F(CanLineTest, mayBeDestroyedWhenItGoesDown) {
    open();
    owner.changes = [&](bool up) {
        if (!up) line.reset();
    };
    kernel.report(CAN_ERR_BUSOFF);
    EXPECT_TRUE(until([&] { return line == nullptr; }));
    settle();
}

TEST_F(CanLineTest, onThisMachineSaysWhatIsMissing) {
    CanLine real(base(), "nocan9");
    real.open(owner, clock.now());
    ASSERT_TRUE(until([&] { return !owner.states.empty(); }));
    EXPECT_FALSE(owner.up());
    // With or without CAN in its kernel, this machine has no such interface.
    EXPECT_THAT(owner.states[0].second,
                testing::AnyOf(HasSubstr("this kernel has no CAN (address family not supported): load the modules can, can_raw"),
                               HasSubstr("no network interface nocan9"), HasSubstr("not permitted")));
}

}  // namespace
}  // namespace axisgate
