// The recorder benchmark measures the cost of recording 64 moving axes for the recording thread and for a write on its way, and the speed
// of a replay. For each figure it prints the ratio, its limit and both figures; exit 1 if a limit is exceeded. The worlds run in virtual
// time, and processor time is counted. The ring is the real one, emptied between two measurements as another thread would.
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "gateway/engine/replay.hpp"
#include "gateway/runtime/record_ring.hpp"
#include "tests/bench/report.hpp"
#include "tests/world/world.hpp"

namespace axisgate::bench {
namespace {
using namespace std::chrono_literals;
constexpr std::size_t axes = 64;
constexpr int seconds = 10, rounds = 3, writes = 20'000;

Move turn(std::int64_t target) {
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = target;
    return m;
}

double processor_seconds() {
    timespec t{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

/// Passes records on as the program does.
struct Tape final : FlightTap {
    RecordRing ring{4u << 20};
    FlightLog inputs{256u << 20, false}, window{256u << 20, true};
    std::uint64_t records = 0;
    void empty() {
        ring.empty([this](const FlightRecord& r) {
            ++records;
            window.add(r);
            if (is_input(r.kind)) inputs.add(r);
        });
    }
    static std::string joined(const FlightLog& log) {
        std::string all;
        for (const auto& c : log.chunks())
            all += c->bytes;
        return all;
    }

private:
    void take(const FlightRecord& r) override { (void)ring.push(r); }
    void take_site(std::shared_ptr<const SiteInput> input, Instant now) override {
        const std::string packed = pack_site(*input);
        (void)ring.push({FlightKind::site, 0xFFFF, now, packed});
    }
};

const test::Subject& subject() {
    for (const auto& s : test::subjects())
        if (s.family->name == std::string_view("uim342") && s.wire == test::Wire::can) return s;
    std::abort();
}

/// `n` axes that turn until they are stopped.
std::vector<AxisId> turning(test::World& w, std::size_t n, Tape* tape) {
    if (tape) w.engine.set_tap(tape);
    const auto state = w.apply(w.twins(subject(), n));
    for (const AxisId a : state->axis_ids) {
        (void)w.run_until_true([&] { return (w.picture(a).flags & flag_online) != 0; }, 20s);
        (void)w.command(a, Enable{});
    }
    w.run_for(1s);
    for (const AxisId a : state->axis_ids)
        (void)w.command(a, turn(100));
    return {state->axis_ids.begin(), state->axis_ids.end()};
}

/// Processor seconds for `seconds` of `n` moving axes.
double play(std::size_t n, Tape* tape) {
    test::World w(1);
    (void)turning(w, n, tape);
    double spent = 0;
    for (int i = 0; i < seconds * 20; ++i) {
        const double before = processor_seconds();
        w.run_for(50ms);
        spent += processor_seconds() - before;
        if (tape) tape->empty();
    }
    return spent;
}

/// The time from a written set-point until its frame is given to the line, the slowest of a hundred, while `axes` move.
double write_p99_us(Tape* tape) {
    test::World w(1);
    const auto ids = turning(w, axes, tape);
    std::vector<double> us;
    int not_taken = 0;
    for (int i = 0; i < writes && not_taken < 10; ++i) {
        w.run_for(1ms);
        const AxisId axis = ids[static_cast<std::size_t>(i) % ids.size()];
        const double before = processor_seconds();
        const Ticket ticket = w.command(axis, turn(100 + i % 100));
        us.push_back((processor_seconds() - before) * 1e6);
        const Result* r = w.wait(ticket, 1s);
        if (!r || !good(*r)) std::printf("    a write was not taken: %s\n", r ? r->text.c_str() : "no result"), ++not_taken;
        if (tape) tape->empty();
    }
    if (not_taken > 0) return 1e9;  // a refused write costs nothing, which would make the figure too good
    const auto at = us.begin() + static_cast<std::ptrdiff_t>(us.size() * 99 / 100);
    std::ranges::nth_element(us, at);
    return *at;
}

bool cost() {
    double plain = 1e9, taped = 1e9;
    std::uint64_t records = 0;
    for (int i = 0; i < rounds; ++i) {
        plain = std::min(plain, play(axes, nullptr));
        Tape tape;
        taped = std::min(taped, play(axes, &tape));
        records = tape.records;
        if (tape.ring.lost() > 0) std::printf("    %llu records were lost\n", static_cast<unsigned long long>(tape.ring.lost()));
    }
    std::printf("    64 axes: %.0f records a second\n", static_cast<double>(records) / seconds);
    const double with = 100 * taped / seconds, without = 100 * plain / seconds;
    return say("64 axes: hot thread, for recording", with - without, "<=", 3, "with", with, "without", without, "%");
}

/// 99 of 100 writes may take 200 us until their frame (`write`); compared with that, recording must take almost nothing.
bool tail() {
    double plain = 1e9, taped = 1e9;
    for (int i = 0; i < rounds; ++i) {
        plain = std::min(plain, write_p99_us(nullptr));
        Tape tape;
        taped = std::min(taped, write_p99_us(&tape));
    }
    return say("64 axes: p99 of a write, for recording", (taped - plain) / 200, "<=", 0.01, "with", taped, "without", plain, "us");
}

bool speed(std::size_t n, double limit) {
    Tape tape;
    (void)play(n, &tape);
    const std::string in = Tape::joined(tape.inputs), out = Tape::joined(tape.window);
    const double before = processor_seconds();
    const auto report = replay(test::families(), {in, out, tape.window.gone_outcomes()});
    const double took = std::max(1e-9, processor_seconds() - before), span = std::chrono::duration<double>(report.span).count();
    if (report.differences > 0 || !report.fault.empty())
        std::printf("    the replay of %zu axes differs %llu times %s\n", n, static_cast<unsigned long long>(report.differences),
                    report.fault.c_str());
    const std::string what = std::to_string(n) + " axes: replay, times real time";
    return say(what.c_str(), span / took, ">=", limit, "recorded", span, "played in", took, "s") && report.differences == 0;
}
}  // namespace
}  // namespace axisgate::bench

int main() {
    std::printf("recording and replay, simulated UIM342 drives on one CAN line, all moving\n");
    bool kept = axisgate::bench::cost();
    kept &= axisgate::bench::tail();
    kept &= axisgate::bench::speed(4, 200);
    kept &= axisgate::bench::speed(64, 200);
    std::printf(kept ? "all limits kept\n" : "NOT all limits kept\n");
    return kept ? 0 : 1;
}
