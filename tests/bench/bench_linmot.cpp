// bench_linmot measures the cost of 256 LinMot twins that move under VAI commands and are read a thousand times a second, as processor time
// per virtual second. The limit is half of one core.
#include <chrono>
#include <ctime>
#include <memory>
#include <vector>

#include "adapters/linmot/twin/device.hpp"
#include "tests/bench/report.hpp"

namespace axisgate::bench {
namespace {
using namespace linmot::twin;
using Bytes = std::vector<std::uint8_t>;

double processor_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}
void put(Bytes& b, std::uint32_t v, int n) {
    for (int i = 0; i < n; ++i)
        b.push_back(static_cast<std::uint8_t>(v >> 8 * i));
}
Bytes telegram(std::uint8_t id, std::uint8_t main, const Bytes& data) {
    Bytes t{1, id, static_cast<std::uint8_t>(data.size() + 3), 2, 0, main};
    t.insert(t.end(), data.begin(), data.end());
    t.push_back(4);
    return t;
}

/// Share of one core; less than 0: the twins did not move.
double share() {
    constexpr int twins = 256, milliseconds = 10'000;
    Instant now = at_ns(1'000'000'000);
    std::vector<std::unique_ptr<Device>> all;
    Out out;
    const auto say = [&](int i, std::uint8_t main, const Bytes& data) {
        all[static_cast<std::size_t>(i)]->on_frame(Frame::run(telegram(static_cast<std::uint8_t>(i), main, data)), now, out);
        out = {};
    };
    const auto control = [&](int i, std::uint32_t word) {
        Bytes b;
        put(b, word, 2);
        say(i, 1, b);
    };
    for (int i = 0; i < twins; ++i) {
        DeviceSetup setup;
        setup.id = static_cast<std::uint8_t>(i);
        all.push_back(std::make_unique<Device>(setup));
        all.back()->power_on({}, now, out);
        control(i, 0x3E);
        control(i, 0x3F);
    }
    now += std::chrono::seconds(1);
    double seen = 0;
    const double before = processor_seconds();
    for (int ms = 0; ms < milliseconds; ++ms) {
        now += std::chrono::milliseconds(1);
        for (int i = 0; i < twins; ++i) {
            if ((ms + i) % 250 == 0) {  // to and fro, 50 mm at 1 m/s, a fifth of a second each
                const int turn = (ms + i) / 250;
                Bytes b;
                put(b, 0x0100u | static_cast<std::uint32_t>(turn & 15), 2);
                for (const std::uint32_t v : {turn % 2 == 0 ? 0u : 500'000u, 1'000'000u, 1'000'000u, 1'000'000u})
                    put(b, v, 4);
                say(i, 2, b);
            }
            const auto m = all[static_cast<std::size_t>(i)]->mechanics(1, now);
            seen += m.velocity > 0 ? 1 : 0;
        }
    }
    const double used = processor_seconds() - before;
    return seen > 0.2 * twins * milliseconds ? used / (milliseconds / 1000.0) : -1;
}
}  // namespace
}  // namespace axisgate::bench

int main() {
    const double used = axisgate::bench::share();
    if (used < 0) return 2;
    return axisgate::bench::say("256 LinMot twins at 1 kHz", used, "<=", 0.5, "used", used, "one core", 1, "s/s") ? 0 : 1;
}
