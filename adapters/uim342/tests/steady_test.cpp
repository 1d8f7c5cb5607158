// The cost of the UIM342 adapter in the steady state, counted in allocations.
#include <atomic>
#include <cstdlib>
#include <new>

#include "adapters/uim342/tests/fake_bench.hpp"

namespace {
// Counted for the whole test program; only the differences within one test mean something.
std::atomic<std::uint64_t> allocations{0};
}  // namespace

// Not inlined: GCC 12 would warn of free() on what came from new.
[[gnu::noinline]] void* operator new(std::size_t n) {
    ++allocations;
    if (void* p = std::malloc(n == 0 ? 1 : n)) return p;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace axisgate::uim342::test {
namespace {

/// 120 nodes at 100 Hz: after the start nothing is allocated any more, and every axis is fresh.
TEST(Uim342Steady, TheSteadyStateAllocatesNothing) {
    LineAdapter adapter(catalogue(), LineKind::can);
    LineSetup setup;
    setup.kind = LineKind::can;
    setup.timing.poll_period = 10ms;
    for (std::uint16_t n = 0; n < 120; ++n) {
        DriveSetup d;
        d.id = DriveId{n};
        d.name = "d";
        d.address = std::to_string(5 + n);
        d.axes = {{AxisId{n}, 1}};
        setup.drives.push_back(d);
    }
    std::vector<std::unique_ptr<FakeNode>> fakes;
    for (std::uint16_t n = 0; n < 120; ++n) {
        fakes.push_back(std::make_unique<FakeNode>(static_cast<std::uint8_t>(5 + n)));
        fakes.back()->on = true;
        fakes.back()->stop = false;
    }
    Out out, next;
    Instant now = time_zero + 1h;
    adapter.configure(setup, now, out);
    adapter.on_line(true, now, out);
    std::uint64_t feedbacks = 0, exchanges = 0;
    // Status and speed answers are made once: only the adapter is under test here.
    std::array<std::array<Frame, 2>, 120> polls;
    for (std::size_t n = 0; n < 120; ++n) {
        const auto id = static_cast<std::uint8_t>(5 + n);
        polls[n][0] = Frame::can_extended(can_id(id, host_id, 0x11), fakes[n]->status());
        polls[n][1] = Frame::can_extended(can_id(id, host_id, 0x11), fakes[n]->speed_and_position());
    }
    const auto run = [&](Instant end) {
        while (now < end) {
            // Answer everything that was sent, until nothing is.
            while (!out.frames.empty()) {
                std::swap(out, next);
                out.clear();
                for (const auto& tx : next.frames) {
                    const Frame& f = tx.frame;
                    const std::size_t n = consumer_of(f.id) - 5u;
                    ++exchanges;
                    if ((f.id & 0xFF) == 0x91 && f.size == 1) {
                        adapter.on_frame(polls[n][f.storage[0]], now, out);
                    } else {
                        const auto reply = fakes[n]->take(message(fakes[n]->id, static_cast<std::uint8_t>(f.id), f.data()));
                        if (reply) adapter.on_frame(Frame::can_extended(can_id(reply->id, host_id, reply->cw), reply->data()), now, out);
                    }
                }
                feedbacks += out.feedback.size();
            }
            now = std::min(end, adapter.deadline());
            out.clear();
            if (adapter.deadline() <= now) adapter.on_deadline(now, out);
        }
    };
    run(now + 2s);
    out.frames.reserve(512);
    next.frames.reserve(512);
    out.feedback.reserve(512);
    next.feedback.reserve(512);
    feedbacks = exchanges = 0;
    const std::uint64_t before = allocations;
    const auto begin = std::chrono::steady_clock::now();
    run(now + 2s);
    const auto took = std::chrono::steady_clock::now() - begin;
    EXPECT_EQ(allocations - before, 0u);
    EXPECT_NEAR(static_cast<double>(exchanges), 120 * 200 * 2, 500) << "120 nodes, 100 Hz, 2 s, MS[0] and MS[1]";
    EXPECT_GE(feedbacks, 120u * 195u);
    RecordProperty("ns_per_exchange", std::to_string(std::chrono::nanoseconds(took).count() / static_cast<std::int64_t>(exchanges)));
    std::printf("[          ] %lld ns per exchange, test's own work included\n",
                static_cast<long long>(std::chrono::nanoseconds(took).count() / static_cast<std::int64_t>(exchanges)));
}

}  // namespace
}  // namespace axisgate::uim342::test
