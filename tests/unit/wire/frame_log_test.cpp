// FrameLog and its exports: what is kept, what is missed, readers beside a writer, and files that other tools read.
// In: frames. Out: pass or fail. Never needs another program.
#include "gateway/wire/frame_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "gateway/wire/frame_export.hpp"
#include "tests/unit/wire/twin_bus_fixture.hpp"

namespace axisgate {
namespace {

using namespace test;

Frame at(Frame f, std::int64_t ns) {
    f.at = at_ns(ns);
    return f;
}
Frame remote_frame(std::uint32_t id, std::uint16_t length) {
    Frame f = can(id);
    f.remote = true;
    f.size = length;
    return f;
}
Frame report(std::uint32_t classes, std::initializer_list<std::uint8_t> detail) {
    Frame f = can(classes, detail);
    f.kind = Frame::Kind::can_error;
    f.extended = false;
    return f;
}

TEST(FrameLog, givesBackWhatWasRecorded) {
    FrameLog log;
    EXPECT_EQ(log.capacity(), 4096u);
    EXPECT_TRUE(log.read(0, 100, 0).entries.empty());
    Frame standard = can(0x123, {1, 2, 3, 4, 5, 6, 7, 8});
    standard.extended = false;
    const Frame frames[] = {at(can(0x04280095, {1}), 10),
                            at(standard, 11),
                            at(can(0x1FFFFFFF), 12),
                            at(text("PR P\r"), 13),
                            at(text(std::string(Frame::capacity, 'z')), 14),
                            at(report(0x40, {0, 0, 0, 0, 0, 0, 128, 3}), 15),
                            at(remote_frame(7, 5), 16)};
    for (std::size_t i = 0; i < std::size(frames); ++i)
        log.record(frames[i], i % 2 == 0, i % 3 == 0);
    const auto r = log.read(0, 100, 1'000'000);
    ASSERT_EQ(r.entries.size(), std::size(frames));
    EXPECT_EQ(r.missed, 0u);
    EXPECT_EQ(r.next, std::size(frames) + 1);
    for (std::size_t i = 0; i < std::size(frames); ++i) {
        const TraceEntry& e = r.entries[i];
        EXPECT_EQ(e.sequence, i + 1);
        EXPECT_EQ(e.to_drive, i % 2 == 0);
        EXPECT_EQ(e.simulated, i % 3 == 0);
        EXPECT_EQ(e.at_unix_ns, 1'000'010 + static_cast<std::int64_t>(i));
        EXPECT_EQ(e.frame.at, frames[i].at);
        EXPECT_EQ(e.frame.size, frames[i].size);
        EXPECT_EQ(e.frame.remote, frames[i].remote);
        EXPECT_TRUE(e.frame.remote || e.frame.same(frames[i])) << i;
    }
}

TEST(FrameLog, keepsTheNewestAndTellsWhatIsMissing) {
    FrameLog log(8);
    for (std::uint32_t i = 1; i <= 20; ++i)
        log.record(can(i), true, false);
    EXPECT_EQ(log.next_sequence(), 21u);
    auto r = log.read(0, 100, 0);
    ASSERT_EQ(r.entries.size(), 8u);
    EXPECT_EQ(r.entries.front().sequence, 13u);
    EXPECT_EQ(r.entries.front().frame.id, 13u);
    EXPECT_EQ(r.missed, 12u);
    EXPECT_EQ(r.next, 21u);

    r = log.read(11, 3, 0);
    ASSERT_EQ(r.entries.size(), 3u);
    EXPECT_EQ(r.missed, 2u);
    EXPECT_EQ(r.entries.front().sequence, 13u);
    EXPECT_EQ(r.next, 16u);

    r = log.read(r.next, 100, 0);  // goes on without a gap
    EXPECT_EQ(r.entries.front().sequence, 16u);
    EXPECT_EQ(r.missed, 0u);

    r = log.read(21, 100, 0);  // nothing new
    EXPECT_TRUE(r.entries.empty());
    EXPECT_EQ(r.missed, 0u);
    EXPECT_EQ(r.next, 21u);

    r = log.read(1'000'000, 100, 0);  // from another life of the log: starts with what comes next
    EXPECT_TRUE(r.entries.empty());
    EXPECT_EQ(r.next, 21u);

    r = log.read(15, 0, 0);
    EXPECT_TRUE(r.entries.empty());
    EXPECT_EQ(r.next, 15u);

    r = log.read_newest(3, 0);
    ASSERT_EQ(r.entries.size(), 3u);
    EXPECT_EQ(r.entries.front().sequence, 18u);
    EXPECT_EQ(log.read_newest(100, 0).entries.size(), 8u);
    EXPECT_TRUE(FrameLog(8).read_newest(5, 0).entries.empty());
}

TEST(FrameLog, cutsRunsThatDoNotFitASlot) {
    FrameLog log(16, 8);
    log.record(text("0123456789abcdefg"), true, false);
    log.record(can(5, {1, 2, 3, 4, 5, 6, 7, 8}), false, false);
    const auto r = log.read(0, 100, 0);
    ASSERT_EQ(r.entries.size(), 4u);
    EXPECT_EQ(as_text(r.entries[0].frame) + as_text(r.entries[1].frame) + as_text(r.entries[2].frame), "0123456789abcdefg");
    EXPECT_EQ(r.entries[3].frame.size, 8u);
    EXPECT_EQ(FrameLog(0, 0).capacity(), 1u);
}

TEST(FrameLog, aReaderBesideTheWriterSeesWholeFramesOnly) {
    FrameLog log(256);
    std::atomic<bool> stop{false};
    std::thread writer([&] {
        std::array<std::uint8_t, Frame::capacity> data{};
        for (std::uint32_t i = 1; !stop.load(std::memory_order_relaxed); ++i) {
            data.fill(static_cast<std::uint8_t>(i));
            Frame f = Frame::run(std::span(data).first(1 + i % Frame::capacity));
            f.id = i;
            f.at = at_ns(i);
            log.record(f, i % 2 == 0, i % 3 == 0);
        }
    });
    std::uint64_t next = 1, seen = 0, missed = 0;
    while (seen < 5'000) {
        const auto r = log.read(next, 50, 0);
        std::uint64_t last = next - 1;
        for (const TraceEntry& e : r.entries) {
            ASSERT_GT(e.sequence, last);
            last = e.sequence;
            ASSERT_EQ(e.frame.id, static_cast<std::uint32_t>(e.sequence));
            ASSERT_EQ(ns_of(e.frame.at), static_cast<std::int64_t>(e.sequence));
            ASSERT_EQ(e.frame.size, 1 + e.sequence % Frame::capacity);
            ASSERT_EQ(e.to_drive, e.sequence % 2 == 0);
            for (const auto b : e.frame.data())
                ASSERT_EQ(b, static_cast<std::uint8_t>(e.sequence));
        }
        ASSERT_EQ(r.next - next, r.entries.size() + r.missed);  // every number is either given or counted
        seen += r.entries.size();
        missed += r.missed;
        next = r.next;
    }
    stop = true;
    writer.join();
    EXPECT_EQ(seen + missed, next - 1);
}

// --- exports --------------------------------------------------------------------------------------------------------

std::vector<TraceEntry> entries(std::initializer_list<std::tuple<Frame, bool, bool>> list) {
    FrameLog log;
    std::int64_t ns = 0;
    for (auto [f, to_drive, simulated] : list) {
        f.at = at_ns(ns);
        ns += 1'500'000;
        log.record(f, to_drive, simulated);
    }
    return log.read(0, 4096, 1'436'509'052'249'713'999).entries;
}

TEST(FrameExport, writesCandumpLogs) {
    Frame standard = can(0x44, {0x2A, 0x36, 0x6C});
    standard.extended = false;
    const auto e = entries({{can(0x04280095, {1}), true, false},
                            {standard, false, false},
                            {can(0x1FFFFFFF), false, true},
                            {remote_frame(0x7, 0), true, false},
                            {remote_frame(0x7, 8), true, false},
                            {report(0x40, {0, 0, 0, 0, 0, 0, 0, 0}), false, false},
                            {text("bytes are left out"), true, false}});
    EXPECT_EQ(candump_text(e, "can0"),
              "(1436509052.249713) can0 04280095#01\n"
              "(1436509052.251213) can0 044#2A366C\n"
              "(1436509052.252713) can0 1FFFFFFF#\n"
              "(1436509052.254213) can0 00000007#R\n"
              "(1436509052.255713) can0 00000007#R8\n"
              "(1436509052.257213) can0 20000040#0000000000000000\n");
    EXPECT_EQ(candump_text({}, "can0"), "");
}

TEST(FrameExport, writesReadableLinesOfAnyLine) {
    const auto e =
        entries({{text(std::string("\xAA\x05\x95", 3)), true, false}, {text("!"), false, true}, {can(0x04280095, {1}), false, true}});
    EXPECT_EQ(trace_text(e, "ttyS1"),
              "(1436509052.249713) ttyS1 device > AA 05 95\n"
              "(1436509052.251213) ttyS1 twin < 21\n"
              "(1436509052.252713) ttyS1 twin < 04280095#01\n");
}

/// Reads a capture back, trusting nothing.
struct Capture {
    struct Packet {
        std::uint32_t interface = 0;
        std::uint64_t at = 0;
        std::uint32_t flags = 0;
        std::string data;
    };
    std::vector<std::pair<std::uint16_t, std::string>> interfaces;
    std::vector<Packet> packets;
    bool good = true;

    static std::uint64_t number(std::string_view s, std::size_t at, std::size_t n) {
        std::uint64_t v = 0;
        for (std::size_t i = 0; i < n; ++i)
            v |= std::uint64_t{static_cast<std::uint8_t>(s.at(at + i))} << (8 * i);
        return v;
    }
    static std::map<std::uint16_t, std::string> options(std::string_view s) {
        std::map<std::uint16_t, std::string> m;
        while (s.size() >= 4) {
            const auto code = static_cast<std::uint16_t>(number(s, 0, 2));
            const std::size_t length = number(s, 2, 2);
            if (code == 0) break;
            m[code] = s.substr(4, length);
            s.remove_prefix(4 + (length + 3) / 4 * 4);
        }
        return m;
    }
    explicit Capture(std::string_view s) {
        if (number(s, 0, 4) != 0x0A0D0D0A || number(s, 8, 4) != 0x1A2B3C4D) good = false;
        while (!s.empty()) {
            const auto type = static_cast<std::uint32_t>(number(s, 0, 4));
            const std::size_t length = number(s, 4, 4);
            if (length % 4 != 0 || length > s.size() || number(s, length - 4, 4) != length) {
                good = false;
                return;
            }
            const std::string_view body = s.substr(8, length - 12);
            if (type == 1) {
                const auto o = options(body.substr(8));
                interfaces.emplace_back(static_cast<std::uint16_t>(number(body, 0, 2)), o.at(2));
                if (o.at(9) != "\x09") good = false;
            }
            if (type == 6) {
                Packet p;
                p.interface = static_cast<std::uint32_t>(number(body, 0, 4));
                p.at = number(body, 4, 4) << 32 | number(body, 8, 4);
                const std::size_t size = number(body, 12, 4);
                if (p.interface >= interfaces.size() || number(body, 16, 4) != size) good = false;
                p.data = body.substr(20, size);
                p.flags = static_cast<std::uint32_t>(number(options(body.substr(20 + (size + 3) / 4 * 4)).at(2), 0, 4));
                packets.push_back(p);
            }
            s.remove_prefix(length);
        }
    }
};

TEST(FrameExport, writesPcapng) {
    const auto e = entries({{can(0x04280095, {1, 2, 3}), true, false},
                            {can(0x04280095), false, true},
                            {remote_frame(7, 8), true, false},
                            {report(0x40, {0, 1, 2, 3, 4, 5, 6, 7}), false, false},
                            {text("hello"), true, false}});
    const std::string file = pcapng(e, "can0");
    const Capture c(file);
    EXPECT_TRUE(c.good);
    ASSERT_EQ(c.interfaces.size(), 3u);
    EXPECT_EQ(c.interfaces[0], std::make_pair(std::uint16_t{227}, std::string("can0")));
    EXPECT_EQ(c.interfaces[1], std::make_pair(std::uint16_t{227}, std::string("can0 (twin)")));
    EXPECT_EQ(c.interfaces[2], std::make_pair(std::uint16_t{147}, std::string("can0")));
    ASSERT_EQ(c.packets.size(), 5u);
    EXPECT_EQ(c.packets[0].data, std::string("\x84\x28\x00\x95\x03\0\0\0\x01\x02\x03", 11));  // identifier big endian, with its flag
    EXPECT_EQ(c.packets[0].at, 1'436'509'052'249'713'999u);
    EXPECT_EQ(c.packets[0].flags, 2u);  // outbound
    EXPECT_EQ(c.packets[0].interface, 0u);
    EXPECT_EQ(c.packets[1].data, std::string("\x84\x28\x00\x95\0\0\0\0", 8));
    EXPECT_EQ(c.packets[1].flags, 1u);
    EXPECT_EQ(c.packets[1].interface, 1u);
    EXPECT_EQ(c.packets[2].data, std::string("\xC0\0\0\x07\x08\0\0\0", 8));
    EXPECT_EQ(c.packets[3].data, std::string("\x20\0\0\x40\x08\0\0\0\0\1\2\3\4\5\6\7", 16));
    EXPECT_EQ(c.packets[4].data, "hello");
    EXPECT_EQ(c.packets[4].interface, 2u);
    EXPECT_EQ(file, pcapng(e, "can0"));
}

TEST(FrameExport, goldenSectionHeader) {
    const std::string expected(
        "\x0A\x0D\x0D\x0A\x2C\0\0\0\x4D\x3C\x2B\x1A\x01\0\0\0\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x04\0\x08\0axisgate\0\0\0\0\x2C\0\0\0", 44);
    EXPECT_EQ(pcapng({}, "can0"), expected);
    EXPECT_TRUE(Capture(expected).good);
}

}  // namespace
}  // namespace axisgate
