// Fixture for lines: a scripted twin, an owner that keeps what it is told, and a loop over virtual time.
// In: what a test scripts. Out: what was heard, with its instants. Never uses a clock.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gateway/core/line.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate::test {

constexpr Duration us(std::int64_t n) { return std::chrono::microseconds(n); }
constexpr Duration ms(std::int64_t n) { return std::chrono::milliseconds(n); }

inline Frame can(std::uint32_t id, std::initializer_list<std::uint8_t> data = {}) {
    return Frame::can_extended(id, std::span<const std::uint8_t>(data.begin(), data.size()));
}
inline Frame text(std::string_view s) { return Frame::run({reinterpret_cast<const std::uint8_t*>(s.data()), s.size()}); }
inline std::string as_text(const Frame& f) { return {f.data().begin(), f.data().end()}; }

/// A twin whose behaviour is a few functions.
class ScriptTwin final : public Twin {
public:
    std::function<void(const Frame&, Instant, Out&)> receives;
    std::function<void(Instant, Out&)> due;
    std::vector<std::pair<Frame, Instant>> received;
    std::vector<Instant> dues;
    Instant next = never;
    NonVolatile memory;
    std::uint64_t revision = 0;
    int powered_on = 0;
    Acceptance accepts;
    bool keep = true;  // what was heard

    void on_frame(const Frame& f, Instant now, Out& out) override {
        if (keep) received.emplace_back(f, now);
        if (receives) receives(f, now, out);
    }
    void on_deadline(Instant now, Out& out) override {
        dues.push_back(now);
        next = never;
        if (due) due(now, out);
    }
    [[nodiscard]] Instant deadline() const override { return next; }
    [[nodiscard]] Acceptance acceptance() const noexcept override { return accepts; }
    void power_on(const NonVolatile& m, Instant, Out&) override {
        memory = m;
        ++powered_on;
    }
    [[nodiscard]] NonVolatile non_volatile() const override { return memory; }
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return revision; }
    [[nodiscard]] std::vector<HandItem> hand() const override { return {}; }
    [[nodiscard]] std::string set_hand(const std::string& name, const Value&, Instant, Out& out) override {
        if (name != "shout") return "no such item: use shout";
        out.send(shout);
        return {};
    }
    [[nodiscard]] TwinMechanics mechanics(int, Instant) const override { return {}; }
    Frame shout;
};

/// The owner of a line.
struct Owner : LineEvents {
    std::vector<Frame> frames;
    std::vector<Frame> sent;
    std::vector<std::pair<bool, std::string>> states;
    std::function<void(const Frame&)> receives;
    std::function<void(const Frame&)> has_sent;
    std::function<void(bool)> changes;

    void on_frame(const Frame& f) override {
        frames.push_back(f);
        if (receives) receives(f);
    }
    void on_line_state(bool up, const std::string& why) override {
        states.emplace_back(up, why);
        if (changes) changes(up);
    }
    void on_sent(const Frame& f) override {
        sent.push_back(f);
        if (has_sent) has_sent(f);
    }
    [[nodiscard]] bool up() const { return !states.empty() && states.back().first; }
};

/// Calls the line at each of its deadlines, on time, up to `until`.
inline void run(Line& line, Instant until) {
    for (int guard = 0; guard < 1'000'000; ++guard) {
        const Instant t = line.deadline();
        if (t > until) break;
        line.on_deadline(t);
    }
    line.on_deadline(until);
}

}  // namespace axisgate::test
