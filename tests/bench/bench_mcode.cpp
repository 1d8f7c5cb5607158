// bench_mcode measures how many statements per second the MCode twin executes when their duration is not simulated, as a ratio to five
// million, with a loop of five simple statements; and the cost of a held program.
#include <chrono>

#include "adapters/mcode/twin/run.hpp"
#include "tests/bench/report.hpp"

namespace axisgate::bench {
namespace {
using namespace mcode::twin;

/// A drive behind the interpreter that answers at once.
struct Nobody final : Host {
    Number read(Word, int&) override { return Number::of(1); }
    int write(Word, std::span<const Number>) override { return 0; }
    int perform(const Statement&, std::span<const Number>) override { return 0; }
    bool moving() override { return false; }
};

double rate_of(std::chrono::duration<double> least) {
    Nobody host;
    Program program;
    std::int32_t address = 1;
    for (const char* line : {"LB K1", "IC R1", "R2=R1+3", "R3=R2&7", "BR K1,R1<1000000000", "E"}) {
        if (program.enter(line, address) != 0) return 0;
    }
    mcode::twin::Run run(program, host);
    run.start(0);
    constexpr int piece = 100'000;
    std::int64_t done = 0;
    const auto begin = std::chrono::steady_clock::now();
    std::chrono::duration<double> taken{};
    while ((taken = std::chrono::steady_clock::now() - begin) < least) {
        for (int i = 0; i < piece; ++i) {
            if (run.step({}) != 0) return 0;
        }
        done += piece;
    }
    return static_cast<double>(done) / taken.count();
}
}  // namespace
}  // namespace axisgate::bench

int main() {
    constexpr double wanted = 5e6;
    const double rate = axisgate::bench::rate_of(std::chrono::seconds(2));
    const bool kept = axisgate::bench::say("MCode statements per second", rate / wanted, ">=", 1, "twin", rate, "wanted", wanted, "1/s");
    return kept ? 0 : 1;
}
