// Bench for the motor of the MCode twin: one motor in virtual time, without language.
// In: words by name. Out: values, error codes, the events that came.
// Never sleeps.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "adapters/mcode/twin/motor.hpp"

namespace axisgate::mcode::twin::test {

using std::chrono::milliseconds;

class MotorBench {
public:
    explicit MotorBench(MechanismSetup setup = {}) : motor(setup) {
        motor.restart(now);
        motor.factory(now);
        collect();
    }

    int set(std::string_view word, std::vector<double> fields) {
        const auto f = numbers(fields);
        const int code = motor.write(*word_named(word), f, now);
        collect();
        return code;
    }
    int set(std::string_view word, double v) { return set(word, std::vector<double>{v}); }
    int start(std::string_view word, std::vector<double> fields) {
        const auto f = numbers(fields);
        const int code = motor.start(*word_named(word), f, now);
        collect();
        return code;
    }
    int start(std::string_view word, double v) { return start(word, std::vector<double>{v}); }
    int arm(std::string_view word, std::vector<double> fields) {
        const auto f = numbers(fields);
        return motor.arm(*word_named(word), f, now);
    }
    double get(std::string_view word) {
        int error = 0;
        const Number n = motor.read(*word_named(word), now, error);
        collect();
        EXPECT_EQ(error, 0) << word;
        return n.as_double();
    }
    int status() { return static_cast<int>(get("AF")); }
    int read_error(std::string_view word) {
        int error = 0;
        (void)motor.read(*word_named(word), now, error);
        return error;
    }
    void hand(const std::string& name, Value v) {
        const auto fault = motor.set_hand(name, v, now);
        ASSERT_TRUE(fault.has_value()) << name;
        ASSERT_EQ(*fault, "");
        collect();
    }
    Value shown(const std::string& name) const {
        for (const HandItem& i : motor.hand(now)) {
            if (i.name == name) return i.value;
        }
        ADD_FAILURE() << "no hand item " << name;
        return {};
    }
    std::int64_t outputs() const { return as_integer(shown("outputs")).value_or(-1); }
    void pass(Duration d) {
        const Instant end = now + d;
        while (motor.deadline() <= end) {
            ASSERT_LT(++turns, 2'000'000) << "deadlines do not end";
            now = std::max(now, motor.deadline());
            motor.advance(now);
            collect();
        }
        now = end;
        motor.advance(now);
        collect();
    }
    void pass_ms(std::int64_t ms) { pass(milliseconds(ms)); }
    /// Seconds until MV falls, at most `limit`.
    double rest(Duration limit = std::chrono::minutes(10)) {
        const Instant from = now, end = now + limit;
        while (motor.moving(now) && motor.deadline() <= end) {
            now = std::max(now, motor.deadline());
            motor.advance(now);
            collect();
        }
        EXPECT_FALSE(motor.moving(now));
        return seconds(now - from);
    }
    /// Codes of the errors that came since the last call.
    std::vector<int> errors() {
        std::vector<int> codes;
        for (const MotorEvent& e : events) {
            if (e.kind == MotorEvent::Kind::error) codes.push_back(e.code);
        }
        events.clear();
        return codes;
    }
    int count(MotorEvent::Kind kind) const {
        return static_cast<int>(std::ranges::count_if(events, [&](const MotorEvent& e) { return e.kind == kind; }));
    }
    /// Trips that fired; each is rearmed by the caller, as TE would be.
    int trips(Word w) const {
        return static_cast<int>(
            std::ranges::count_if(events, [&](const MotorEvent& e) { return e.kind == MotorEvent::Kind::trip && e.word == w; }));
    }

    Motor motor;
    Instant now = Instant{} + std::chrono::seconds(1);
    std::vector<MotorEvent> events;
    long turns = 0;

private:
    static std::vector<Number> numbers(const std::vector<double>& v) {
        std::vector<Number> n;
        for (const double d : v)
            n.push_back(d == std::trunc(d) ? Number::of(static_cast<std::int64_t>(d)) : Number::of_real(d));
        return n;
    }
    void collect() {
        while (const auto e = motor.next_event())
            events.push_back(*e);
    }
};

using Codes = std::vector<int>;

}  // namespace axisgate::mcode::twin::test
