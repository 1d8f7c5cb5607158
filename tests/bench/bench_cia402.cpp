// bench_cia402 measures one SDO round trip against the simulated CiA 402 drive in this process: the client, the node and its dictionary. It
// prints median and p99 of the cost beyond the time on the wire; the limit is 20 microseconds. The time on the wire is computed from the
// sent frames and only shown.
#include <algorithm>
#include <chrono>
#include <vector>

#include "adapters/cia402/twin/twin.hpp"
#include "gateway/core/wire_time.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"
#include "tests/bench/report.hpp"

namespace axisgate::bench {
namespace {
using Clock = std::chrono::steady_clock;
constexpr std::size_t rounds = 200'000;

struct Trips {
    std::vector<double> us;
    double wire_us = 0;  ///< of the first round trip
    std::size_t failed = 0;
    [[nodiscard]] double at(double share) {
        const auto place = us.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(us.size() - 1));
        std::nth_element(us.begin(), place, us.end());
        return *place;
    }
};

/// Each round trip is at another instant, so that the twin computes its measured values anew.
Trips trips(Twin& twin, bool writes) {
    canopen::SdoClient client(5);
    Trips t;
    t.us.reserve(rounds);
    Instant now = at_ns(2'000'000'000);
    std::vector<Frame> frames;
    Out out;
    for (std::size_t i = 0; i < rounds; ++i) {
        now += std::chrono::milliseconds(1);
        frames.clear();
        out.clear();
        const auto begun = Clock::now();
        if (writes) {
            const auto v = static_cast<std::uint8_t>(1 + i % 200);
            (void)client.write({0x6081, 0}, {v, 0, 0, 0}, now, frames);
        } else {
            (void)client.read({0x6064, 0}, now, frames);
        }
        bool done = false;
        for (const Frame& f : frames)
            twin.on_frame(f, now, out);
        std::vector<Frame> more;
        for (const auto& tx : out.frames)
            if (const auto end = client.on_frame(tx.frame, now, more)) done = end->done();
        t.us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - begun).count());
        t.failed += done ? 0 : 1;
        if (i > 0) continue;
        std::uint64_t bits = 0;
        for (const Frame& f : frames)
            bits += can_bits(f) + can_intermission_bits;
        for (const auto& tx : out.frames)
            bits += can_bits(tx.frame) + can_intermission_bits;
        t.wire_us = seconds(wire_time(bits, 1'000'000)) * 1e6;
    }
    return t;
}
}  // namespace
}  // namespace axisgate::bench

int main() {
    using namespace axisgate;
    TwinSetup setup;
    setup.address = "5";
    setup.kind = LineKind::can;
    const auto twin = cia402_drive::twin::make_twin(setup);
    Out out;
    twin->power_on({}, at_ns(1'000'000'000), out);
    bool kept = true;
    for (const bool writes : {false, true}) {
        bench::Trips t = bench::trips(*twin, writes);
        if (t.failed > 0) return 2;
        const double median = t.at(0.5), late = t.at(0.99);
        kept &= bench::say(writes ? "SDO write beyond its wire time, p99" : "SDO read beyond its wire time, p99", late / 20, "<=", 1, "p99",
                           late, "limit", 20, "us");
        std::printf("    %-34s median %.2f us; on the wire at 1 Mbit/s %.0f us\n", "", median, t.wire_us);
    }
    return kept ? 0 : 1;
}
