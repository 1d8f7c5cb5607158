// Speed on the wire, in virtual time on a TwinBus: how busy polling keeps a party line, and how soon a stop is on it.
// In: several real twins at the family's rates. Out: shares and times that a slower adapter would miss.
#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

/// What the drives' own time for a line leaves is used: at least 95 % of it is bytes, either way.
TEST(McodeSpeed, PollingAPartyLineKeepsTheWireBusy) {
    for (const std::uint32_t rate : {115200U, 9600U}) {
        LineBench b("abcdefgh", rate);
        b.run(20s);
        for (std::size_t i = 0; i < 8; ++i)
            ASSERT_TRUE(b.online(i)) << rate << ' ' << i;
        const auto bytes = b.bytes_in + b.bytes_out;
        const auto exchanges = b.adapter.counters().exchanges;
        const auto timeouts = b.adapter.counters().timeouts;
        b.longest_gap.clear();
        b.run(10s);
        const Duration wire = wire_time((b.bytes_in + b.bytes_out - bytes) * 10, rate);
        const auto polls = b.adapter.counters().exchanges - exchanges;
        const Duration drives = polls * Duration{1ms};  // a typed line takes a drive 1 ms
        const double share = static_cast<double>(wire.count()) / static_cast<double>((Duration{10s} - drives).count());
        EXPECT_GE(share, 0.95) << rate;
        EXPECT_LE(share, 1.01) << rate << ": more than the wire can carry";
        EXPECT_EQ(b.adapter.counters().timeouts, timeouts);
        for (const auto& [axis, gap] : b.longest_gap)
            EXPECT_LE(gap, (Duration{10s} / static_cast<std::int64_t>(polls)) * 9) << "every drive has its turn";
        RecordProperty("polls_per_second_at_" + std::to_string(rate), static_cast<int>(polls / 10));
        RecordProperty("share_percent_at_" + std::to_string(rate), static_cast<int>(share * 100));
    }
}

/// At every moment of a round, with commands waiting for every drive: nothing is begun between the order and its line on the wire.
TEST(McodeSpeed, AStopIsOnTheWireBehindTheExchangeInProgress) {
    LineBench b("abcd", 9600);
    b.run(12s);
    for (std::size_t i = 0; i < 4; ++i) {
        ASSERT_TRUE(b.online(i));
        ASSERT_EQ(b.wait(Enable{}, i).outcome, Outcome::done);
    }
    Duration longest{};
    for (int at = 0; at < 80; ++at) {
        b.run(std::chrono::milliseconds(400 + 7 * at));
        for (std::size_t i = 0; i < 4; ++i)
            (void)b.command(Enable{}, i);
        b.run(std::chrono::milliseconds(at));
        const auto before = b.sent.size();
        const Instant asked = b.now;
        const auto axis = static_cast<std::size_t>(at % 4);
        const Ticket stop = at % 2 ? b.command(Halt{}, axis) : b.command(QuickStop{}, axis);
        b.run(200ms);
        ASSERT_GT(b.sent.size(), before) << at;
        EXPECT_NE(b.sent[before].bytes.find("SL 0"), std::string::npos) << at << ": " << b.sent[before].bytes;
        EXPECT_EQ(b.sent[before].bytes[0], "abcd"[axis]);
        longest = std::max(longest, b.sent[before].at - asked);
        b.run(2s);
        ASSERT_TRUE(b.result(stop)) << at;
        EXPECT_EQ(b.result(stop)->outcome, Outcome::accepted) << at;
    }
    // The longest exchange is a poll: some 51 bytes there and 21 back, and the drive's 1 ms.
    EXPECT_LE(longest, wire_time(std::uint64_t{75} * 10, 9600) + 1ms);
    EXPECT_GT(longest, 20ms) << "the moments that were tried fall into exchanges";
}

}  // namespace
}  // namespace axisgate::mcode::test
