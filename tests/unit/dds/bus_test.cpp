// Two participants of one domain on the loopback interface: states for late joiners, ends, partitions, optional members.
#include "gateway/doors/dds/bus.hpp"
#include "tests/unit/dds/own_domain.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <thread>
#include <vector>

namespace axisgate::dds {
namespace {
using std::chrono::steady_clock;

/// One end, with the samples of a topic that it has taken.
struct End {
    std::atomic<int> woken{0};
    Bus bus{[this] { ++woken; }};

    /// Takes until `enough`; false after 10 s.
    template <class T, class Enough>
    bool take_until(std::vector<std::pair<T, Bus::Seen>>& into, Enough enough) {
        const auto limit = steady_clock::now() + std::chrono::seconds(10);
        while (!enough()) {
            if (steady_clock::now() > limit) return false;
            const int before = woken;
            if (bus.take<T>(64, [&into](const T& s, const Bus::Seen& seen) { into.emplace_back(s, seen); }) == 0) {
                while (woken == before && steady_clock::now() < limit && !enough())
                    std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
        }
        return true;
    }
};

BusSettings domain(std::string partition = "plant") { return {test::own_domain(0), std::move(partition), "lo"}; }

axisgate_GatewayState state_of(const char* name, std::uint32_t axes) {
    axisgate_GatewayState s{};
    put_text(s.gateway, name);
    s.instance = 5;
    s.axes = axes;
    return s;
}

TEST(DdsBus, ALateComerHasTheNewestStateAndHearsOfItsEnd) {
    End reader;
    std::vector<std::pair<axisgate_GatewayState, Bus::Seen>> got;
    {
        End writer;
        ASSERT_EQ(writer.bus.open(domain(), {Topic::gateway_state}, {}), "");
        ASSERT_TRUE(writer.bus.write(state_of("hall", 1)));
        ASSERT_TRUE(writer.bus.write(state_of("hall", 2)));
        ASSERT_EQ(reader.bus.open(domain(), {}, {Topic::gateway_state}), "");
        ASSERT_TRUE(reader.take_until(got, [&] { return !got.empty(); }));
        EXPECT_STREQ(got[0].first.gateway, "hall");
        EXPECT_EQ(got[0].first.axes, 2u);
        EXPECT_TRUE(got[0].second.valid && got[0].second.alive);
        reader.bus.close();
        ASSERT_EQ(reader.bus.open(domain(), {}, {Topic::gateway_state}), "");
        got.clear();
        ASSERT_TRUE(reader.take_until(got, [&] { return !got.empty(); }));
        // Only the writer's own participant; the domain of the process stays with the one that opened it first.
        axisgate_GatewayState end = state_of("hall", 0);
        ASSERT_TRUE(writer.bus.dispose(end));
        got.clear();
        ASSERT_TRUE(reader.take_until(got, [&] { return !got.empty() && !got.back().second.alive; }));
        EXPECT_STREQ(got.back().first.gateway, "hall") << "the key is told with the end";
        reader.bus.close();
    }
}

TEST(DdsBus, AnotherPartitionSeesNothing) {
    End first, here, there;
    ASSERT_EQ(first.bus.open(domain(), {Topic::gateway_state}, {}), "");
    ASSERT_EQ(here.bus.open(domain(), {}, {Topic::gateway_state}), "");
    ASSERT_EQ(there.bus.open(domain("other"), {}, {Topic::gateway_state}), "");
    ASSERT_TRUE(first.bus.write(state_of("hall", 1)));
    std::vector<std::pair<axisgate_GatewayState, Bus::Seen>> got, none;
    ASSERT_TRUE(here.take_until(got, [&] { return !got.empty(); }));
    (void)there.bus.take<axisgate_GatewayState>(64, [&none](const auto& s, const auto& seen) { none.emplace_back(s, seen); });
    EXPECT_TRUE(none.empty());
    there.bus.close();
    here.bus.close();
}

TEST(DdsBus, OptionalMembersOfACommandArriveOrAreAbsent) {
    End first, reader;
    ASSERT_EQ(first.bus.open(domain(), {Topic::axis_command}, {}), "");
    ASSERT_EQ(reader.bus.open(domain(), {}, {Topic::axis_command}), "");
    axisgate_AxisCommand c{};
    put_text(c.gateway, "hall");
    put_text(c.axis, "feeder");
    put_text(c.command, "move_absolute");
    double position = 12.5;
    c.position = &position;
    std::vector<std::pair<std::optional<double>, bool>> got;
    const auto limit = steady_clock::now() + std::chrono::seconds(10);
    while (got.empty() && steady_clock::now() < limit) {
        // Commands are only for readers that are present: the command is written again until the two have found each other.
        ASSERT_TRUE(first.bus.write(c));
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        (void)reader.bus.take<axisgate_AxisCommand>(64, [&got](const axisgate_AxisCommand& s, const Bus::Seen& seen) {
            if (seen.valid) got.emplace_back(s.position ? std::optional(*s.position) : std::nullopt, s.velocity != nullptr);
        });
    }
    ASSERT_FALSE(got.empty());
    EXPECT_EQ(got[0].first, 12.5);
    EXPECT_FALSE(got[0].second);
    reader.bus.close();
}

TEST(DdsBus, AnInterfaceThatIsNotThereIsAFaultWithAWayOut) {
    End e;
    const std::string fault = e.bus.open({test::own_domain(1), "plant", "nosuch9"}, {Topic::gateway_state}, {});
    EXPECT_NE(fault.find("nosuch9"), std::string::npos) << fault;
    EXPECT_NE(fault.find("[dds] interface"), std::string::npos) << fault;
    EXPECT_FALSE(e.bus.is_open());
}

TEST(DdsBus, TextsAreCutBetweenCharacters) {
    char four[5];
    put_text(four, "abcdef");
    EXPECT_STREQ(four, "abcd");
    put_text(four, "abc\xC3\xA4");
    EXPECT_STREQ(four, "abc");
    put_text(four, "ab\xC3\xA4");
    EXPECT_STREQ(four, "ab\xC3\xA4");
}
}  // namespace
}  // namespace axisgate::dds
