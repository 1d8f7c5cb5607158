// Demand bench: the line bench with every feedback kept, and what the tests ask of it: sources, following errors.
// In: moves, lines, a hand at the shaft. Out: the worst following error since the last look, and whether every word was of one source.
// Never asks the adapter's reckoning itself: twins say where the rotor is, and known speeds say where it should be.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {

inline Move order(std::int64_t target, Move::Kind kind = Move::Kind::absolute, std::optional<std::int64_t> speed = {}) {
    Move m;
    m.kind = kind;
    m.target = target;
    m.velocity = speed;
    return m;
}

struct Track : LineBench {
    explicit Track(std::string_view names = "!", std::uint32_t rate = 115200, std::map<std::string, std::string> options = {})
        : LineBench(names, rate, std::move(options)) {
        on_feedback = [this](AxisId a, const AxisFeedback& f) { trail[static_cast<std::size_t>(a)].push_back(f); };
        run(4s);
        before_enable = source();
        for (std::size_t i = 0; i < setup.drives.size(); ++i) {
            EXPECT_EQ(wait(Enable{}, i).outcome, Outcome::done) << i;
            line("MT=50", i);
            line("HT=50", i);
        }
        run(200ms);
    }
    void line(const std::string& text, std::size_t i = 0) {
        const auto r = wait(Native{{text.begin(), text.end()}}, i);
        EXPECT_TRUE(good(r)) << text << ": " << r.text;
    }
    /// EE = 1: 78, 60000, 78125, 78125 counts, 4000 to a turn.
    void encoder(std::size_t i = 0) {
        line("EE=1", i);
        line("SF=65000", i);
        run(300ms);
        trail.clear();
    }
    const AxisFeedback& at(std::size_t i = 0) { return feedback[AxisId{static_cast<std::uint16_t>(i)}]; }
    DemandSource source(std::size_t i = 0) { return at(i).demand_source; }
    std::int64_t error(std::size_t i = 0) { return at(i).position_demand - at(i).position; }
    void move(std::int64_t target, Move::Kind kind = Move::Kind::absolute, std::optional<std::int64_t> speed = {}, std::size_t i = 0) {
        const Result r = wait(order(target, kind, speed), i);
        EXPECT_TRUE(good(r)) << r.text;
    }
    DemandSource before_enable{};
    static constexpr std::int64_t nobody = 999'999'999;
    std::map<std::size_t, std::vector<AxisFeedback>> trail;  ///< every feedback since the last look
    /// The greatest following error of `trail` and the next `d`, which are all of this source; else `nobody`.
    std::int64_t worst(Duration d, DemandSource wanted, std::size_t i = 0) {
        run(d);
        std::int64_t most = 0;
        for (const auto& f : std::exchange(trail[i], {}))
            most = std::max(most, f.demand_source == wanted ? std::abs(f.position_demand - f.position) : nobody);
        return most;
    }
    /// Every feedback of the next `d` is of this source.
    bool only(DemandSource wanted, Duration d, std::size_t i = 0) {
        trail[i].clear();
        return worst(d, wanted, i) < nobody;
    }
    /// What was computed since the last look was right.
    bool honest(std::int64_t limit, std::size_t i = 0) {
        return std::ranges::all_of(std::exchange(trail[i], {}), [&](const AxisFeedback& f) {
            return f.demand_source != DemandSource::computed || std::abs(f.position_demand - f.position) <= limit;
        });
    }
    bool asked(std::string_view item) const {
        return std::ranges::any_of(sent, [&](const Sent& s) { return s.bytes.find(item) != std::string::npos; });
    }
};

/// Latency cancels out, since order and position count from the end of their requests: what is left is rounding, and the processing of a
/// line, 1 ms of the fastest speed in here at most.
constexpr std::int64_t latency(std::int64_t speed) { return 2 + speed / 1000; }

}  // namespace axisgate::mcode::test
