// Trial shows the effect of one motion command: a bench that can omit the command, and the list of cases. The first unexpected result is
// stored.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "adapters/linmot/tests/twin_bench.hpp"

namespace axisgate::linmot::test {
using Numbers = std::vector<std::int64_t>;
constexpr std::int64_t quick = 1'000'000, steep = 10'000'000;  // 1 m/s, 100 m/s2
constexpr std::uint16_t mark = 0x14BE;                         ///< written by a row of the table, to show that the row was reached

/// A bench that omits one command and stores the first unexpected result.
struct Trial : Bench {
    std::string left_out, fault;
    explicit Trial(std::map<std::string, std::string> with, std::string out = {}) : Bench(std::move(with)), left_out(std::move(out)) {}

    void say(std::string_view id, const Numbers& values = {}) {
        if (id != left_out) motion(id, values);
    }
    void is(double seen, double wanted, const char* what, double within = 0.5) {
        if (fault.empty() && !(std::fabs(seen - wanted) <= within)) fault = fmt::format("{}: {} instead of {}", what, seen, wanted);
    }
    void to(std::int64_t place) {
        motion("010xh", {place, quick, steep, steep});
        run(2s);
    }
    void turn_to(std::int64_t count) { (void)hand("encoder", Value{count}); }
    void edge(bool rising) {
        if (!rising) (void)hand("trigger", Value{true});
        (void)hand("trigger", Value{rising});
    }
    /// A curve with straight segments.
    void draw(std::uint16_t id, std::initializer_list<int> points, int x_length) {
        auto& c = drive().curves[id];
        c.info.assign(70, 0);
        for (std::size_t i = 0; i < 4; ++i)
            c.info[32 + i] = static_cast<std::uint8_t>(x_length >> 8 * i);
        for (const int p : points)
            put(c.data, p, 4);
    }
    /// A row of the command table by the catalogue's layout. A row whose command is omitted does not wait and has no next row.
    void row(std::uint16_t number, std::string_view id, const Numbers& values, std::uint16_t next) {
        const auto* c = page().command(id);
        const bool out = id == left_out;
        std::vector<std::uint8_t> v;
        put(v, 0xA701, 2);
        put(v, next, 2);
        put(v, out ? 0 : std::stol(c->id.substr(0, 3), nullptr, 16) << 4, 2);
        for (std::size_t i = 0; i < c->arguments.size(); ++i)
            put(v, values.at(i), c->arguments[i].type == ValueType::i16 || c->arguments[i].type == ValueType::u16 ? 2 : 4);
        v.resize(64);
        std::ranges::copy(v, drive().table[number].begin());
    }
    void mark_row(std::uint16_t number, std::int64_t value, std::uint16_t next = 0xFFFF) { row(number, "002xh", {mark, value}, next); }
    [[nodiscard]] double marked() { return drive().ram(mark); }

    /// A wait before a mark: the mark must not be reached until `release` has been called.
    void wait(std::string_view id, const Numbers& values, Duration held, const std::function<void()>& release) {
        motion("002xh", {mark, 0});
        row(1, id, values, 2);
        mark_row(2, 7);
        motion("200xh", {1});
        run(held);
        is(marked(), 0, "it holds the table");
        release();
        is(marked(), 7, "it lets the table go on");
    }
    /// A branch with one value for "true" and one for "false".
    void branch(std::string_view id, const Numbers& yes, const Numbers& no) {
        for (const bool holds : {true, false}) {
            motion("002xh", {mark, 0});
            Numbers values = holds ? yes : no;
            values.insert(values.end(), {2, 3});
            row(1, id, values, 0xFFFF);
            mark_row(2, 21);
            mark_row(3, 22);
            motion("200xh", {1});
            run(10ms);
            is(marked(), holds ? 21 : 22, holds ? "true" : "false");
        }
    }
    /// Demand at 1 mm, slider held at 3 mm: the difference is -2 mm, 2 mm without its sign.
    void hold_apart() {
        to(30'000);
        (void)hand("stall", Value{true});
        to(10'000);
    }
    /// The demand moves with 10 mm/s, the slider is held.
    void hold_moving() {
        (void)hand("stall", Value{true});
        motion("0CExh", {10'000, quick});
        run(50ms);
    }
};

struct EffectCase {
    std::function<void(Trial&)> run;
    std::map<std::string, std::string> options = {};
};
using EffectCases = std::map<std::string, EffectCase>;

/// Cases of the command table and its variables (twin_each_row_test.cpp).
void add_table_effects(EffectCases& all);

}  // namespace axisgate::linmot::test
