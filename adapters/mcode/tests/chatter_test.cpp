// A drive whose program prints several times in a second, on one pair of wires: a request that meets a printed line is lost with it.
#include <fmt/core.h>

#include <algorithm>

#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

struct Chatter : LineBench {
    /// `wait`: the reply time-out, which is near to a multiple of the program's period in some of the tests.
    Chatter(Duration wait, std::map<std::string, std::string> options) : LineBench("a", 9600, std::move(options)) {
        setup.timing.reply_timeout = wait;
        adapter.configure(setup, now, out);
        drain();
        run(20s);
    }
    void turn() {
        Move m;
        m.kind = Move::Kind::velocity;
        m.target = 4000;
        m.acceleration = m.deceleration = 20000;
        for (int i = 0; i < 5 && !good(wait(m)); ++i) {
        }
    }
};

TEST(McodeChatter, AStopIsConfirmedBesideAProgramThatPrintsAllTheTime) {
    for (const Duration timeout : {Duration{120ms}, Duration{380ms}, Duration{891ms}, Duration{990ms}}) {
        for (const char* order : {"0", "1"}) {
            Chatter b(timeout, {{"chatter_ms", "200"}, {"answer_order", order}});
            ASSERT_TRUE(b.online());
            for (int i = 0; i < 6; ++i) {
                const auto what = fmt::format("time-out {} ms, order {}, {}", timeout / 1ms, order, i);
                // The program, which a quick stop ends, prints again.
                for (int tries = 0; tries < 5 && !good(b.wait(Action{"program.start", "SU"})); ++tries) {
                }
                Result on = b.wait(Enable{});
                for (int tries = 0; tries < 5 && !good(on); ++tries)
                    on = b.wait(Enable{});
                ASSERT_TRUE(good(on)) << what << on.text;
                b.turn();
                b.run(1s + i * 23ms);
                const Instant asked = b.now;
                const Result r = b.wait(QuickStop{});
                EXPECT_TRUE(good(r)) << what << ": " << r.text;
                EXPECT_LT(b.now - asked, 4 * timeout + 3s) << what;
            }
        }
    }
}

TEST(McodeChatter, AStopIsSentAtOnceAlthoughTheLastRequestWasLost) {
    constexpr Duration timeout = 120ms;
    Chatter b(timeout, {{"chatter_ms", "200"}});  // the halt leaves the program running
    ASSERT_TRUE(b.online());
    Duration longest{};
    for (int i = 0; i < 60; ++i) {
        b.run(1s + i * 17ms);
        b.sent.clear();
        const Instant asked = b.now;
        (void)b.command(Halt{});
        const auto stop = [&] {
            return std::ranges::any_of(b.sent, [](const auto& s) { return s.bytes.find("SL") != std::string::npos; });
        };
        while (!stop() && b.now < asked + 2s)
            b.run(1ms);
        longest = std::max(longest, b.now - asked);
        b.run(3s);
    }
    EXPECT_LE(longest, timeout + 100ms) << "the exchange that is under way ends first, and nothing else";
}

}  // namespace
}  // namespace axisgate::mcode::test
