// Points: filters as instants, edges by the level before, captures and clocks of the typed points.
// In: levels, settings, time. Out: edges, counts, error codes.
// Never samples a digital input: a filter is one instant at which the change counts.
#include "adapters/mcode/twin/io.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {
namespace {
bool is_clock(InputType t) noexcept { return t >= InputType::step_direction; }

bool known_input(std::int64_t type) noexcept { return (type >= 0 && type <= 8) || (type >= 11 && type <= 15); }

bool known_output(std::int64_t type) noexcept { return type >= 16 && type <= 29 && type != 22; }

}  // namespace

void Inputs::factory(Instant now) {
    type_ = {};
    high_ = {};
    filter_ms_ = {};
    sense_ = 9;
    range_ = 0;
    index_high_ = false;
    average_length_ = 0;
    average_ = analog_;
    average_at_ = now;
    due_.fill(never);
    // The state of the pins at the start is no edge.
    for (std::size_t i = 0; i < input_count; ++i)
        active_[i] = raw(i);
}

int Inputs::set_up(std::span<const std::int64_t> f, Instant now) {
    if (f.empty()) return err::bad_value;
    if (f[0] == 5) {
        if (!analog_set_) return err::illegal_data;
        if (f.size() != 3 || (f[2] != 0 && f[2] != 1)) return err::bad_value;
        if (f[1] != 9 && f[1] != 10) return err::wrong_type;
        sense_ = static_cast<int>(f[1]);
        range_ = static_cast<int>(f[2]);
        return 0;
    }
    if (f[0] == 6) {
        // The index has no type; the printed form has a 0 in its place, which is taken too.
        const std::int64_t a = f.size() == 3 ? f[2] : f.size() == 2 ? f[1] : -1;
        if (a != 0 && a != 1) return err::bad_value;
        index_high_ = a == 1;
        return 0;
    }
    if (f[0] < 1 || f[0] > static_cast<std::int64_t>(fitted_)) return err::no_such_point;
    if (f.size() < 2 || f.size() > 3) return err::bad_value;
    const auto n = static_cast<std::size_t>(f[0] - 1);
    const bool high = f.size() == 3 ? f[2] == 1 : high_[n];
    if (f.size() == 3 && f[2] != 0 && f[2] != 1) return err::bad_value;
    if (!known_input(f[1])) return err::wrong_type;
    const auto type = static_cast<InputType>(f[1]);
    if (type == InputType::capture && (n != 0 || fitted_ < input_count)) return err::wrong_type;
    if (is_clock(type)) {
        if (n < 2) return err::wrong_type;
        if (fitted_ < input_count) return err::wrong_clock;
    } else if (type != InputType::general && type_[n] == type) {
        // This point has it already; other points may have it too. General is free: listing 9.3 sets it on points that have it. So are
        // the clocks, since setting one of the pair sets the other.
        return err::already_so;
    }
    type_[n] = type;
    high_[n] = high;
    if (n >= 2 && fitted_ == input_count) {
        // Clock inputs are a pair: setting one changes the other, and taking one away too [L3524].
        const std::size_t pair = n == 2 ? 3 : 2;
        if (is_clock(type)) {
            type_[pair] = type;
        } else if (is_clock(type_[pair])) {
            type_[pair] = InputType::general;
        }
    }
    judge(n, now);
    return 0;
}

std::string Inputs::text() const {
    std::string s;
    for (std::size_t i = 0; i < fitted_; ++i) {
        s += "IS = " + std::to_string(i + 1) + ", " + std::to_string(static_cast<int>(type_[i])) + ", " + (high_[i] ? "1" : "0") + "\r\n";
    }
    s += "IS = 5, " + std::to_string(sense_) + ", " + std::to_string(range_) + "\r\n";
    s += "IS = 6, 0, " + std::string(index_high_ ? "1" : "0");
    return s;
}

void Inputs::save(NonVolatile& m) const {
    for (std::size_t i = 0; i < fitted_; ++i) {
        const std::string name = "IS." + std::to_string(i + 1);
        m[name + ".type"] = Value{static_cast<std::int64_t>(type_[i])};
        m[name + ".active"] = Value{std::int64_t{high_[i] ? 1 : 0}};
    }
    m["IS.5.sense"] = Value{std::int64_t{sense_}};
    m["IS.5.range"] = Value{std::int64_t{range_}};
    m["IS.6.active"] = Value{std::int64_t{index_high_ ? 1 : 0}};
}

void Inputs::load(const NonVolatile& m, Instant now) {
    for (std::size_t i = 0; i < fitted_; ++i) {
        const std::string name = "IS." + std::to_string(i + 1);
        const std::int64_t type = integer_in(m, name + ".type", 0, 0, 15);
        type_[i] = known_input(type) ? static_cast<InputType>(type) : InputType::general;
        high_[i] = integer_in(m, name + ".active", 0, 0, 1) == 1;
        judge(i, now);
        // No edge at the start: a saved reset input that is active would reset for ever.
        active_[i] = raw(i);
        due_[i] = never;
    }
    sense_ = static_cast<int>(integer_in(m, "IS.5.sense", 9, 9, 10));
    range_ = static_cast<int>(integer_in(m, "IS.5.range", 0, 0, 1));
    index_high_ = integer_in(m, "IS.6.active", 0, 0, 1) == 1;
}

bool Inputs::raw(std::size_t i) const noexcept {
    if (is_switch_[i]) return closed_[i];
    return ((levels_ >> i & 1) != 0) == high_[i];
}

/// A pin or what it means has changed: when does that count?
void Inputs::judge(std::size_t i, Instant now) {
    if (is_switch_[i]) {
        const auto bit = static_cast<std::uint8_t>(1U << i);
        levels_ = static_cast<std::uint8_t>(closed_[i] == high_[i] ? levels_ | bit : levels_ & ~bit);
    }
    if (raw(i) == active_[i]) {
        due_[i] = never;
    } else if (due_[i] == never) {
        due_[i] = now + std::chrono::milliseconds(filter_ms_[i]);
    }
}

void Inputs::levels(std::uint8_t mask, Instant now) {
    levels_ = mask & 0x0F;
    for (std::size_t i = 0; i < fitted_; ++i) {
        is_switch_[i] = false;
        judge(i, now);
    }
}

void Inputs::switches(std::uint8_t mask, Instant now) {
    for (std::size_t i = 0; i < fitted_; ++i) {
        is_switch_[i] = true;
        closed_[i] = (mask >> i & 1) != 0;
        judge(i, now);
    }
}

bool Inputs::drive(InputType type, bool active, Instant now) {
    const auto i = with_type(type);
    if (!i) return false;
    is_switch_[*i] = true;
    closed_[*i] = active;
    judge(*i, now);
    return true;
}

void Inputs::filter(std::size_t i, int ms, Instant now) {
    filter_ms_[i] = ms;
    due_[i] = never;
    judge(i, now);
}

std::uint8_t Inputs::active_mask() const noexcept {
    unsigned mask = 0;
    for (std::size_t i = 0; i < fitted_; ++i)
        mask |= active_[i] ? 1U << i : 0U;
    return static_cast<std::uint8_t>(mask);
}

std::optional<std::size_t> Inputs::with_type(InputType type) const noexcept {
    for (std::size_t i = 0; i < fitted_; ++i) {
        if (type_[i] == type) return i;
    }
    return std::nullopt;
}

bool Inputs::active(InputType type) const noexcept {
    for (std::size_t i = 0; i < fitted_; ++i) {
        if (type_[i] == type && active_[i]) return true;
    }
    return false;
}

Instant Inputs::deadline() const noexcept { return *std::ranges::min_element(due_); }

std::optional<InputEdge> Inputs::next_edge(Instant now) {
    const auto it = std::ranges::min_element(due_);
    if (*it > now) return std::nullopt;
    const auto i = static_cast<std::size_t>(it - due_.begin());
    due_[i] = never;
    active_[i] = raw(i);
    return InputEdge{i, type_[i], active_[i]};
}

void Inputs::analog_counts(double counts, Instant now) {
    average_ = filtered(now);
    average_at_ = now;
    analog_ = std::clamp(counts, 0.0, analog_full);
}

void Inputs::analog_signal(double value, Instant now) {
    double counts = 0;
    if (!analog_set_) {
        counts = value / 3.6 * analog_full;
    } else if (sense_ == 9) {
        counts = value / (range_ == 0 ? 5 : 10) * analog_full;
    } else {
        counts = range_ == 0 ? value / 20 * analog_full : (value - 4) / 16 * 3200;  // 4-20 mA ends at 3200 [L7144, E-30]
    }
    analog_counts(std::round(counts), now);
}

void Inputs::analog_filter(int length, Instant now) {
    average_ = filtered(now);
    average_at_ = now;
    average_length_ = length;
}

double Inputs::filtered(Instant now) const noexcept {
    if (average_length_ <= 1) return analog_;
    const auto samples = static_cast<double>(std::max<std::int64_t>(milliseconds_of(now - average_at_), 0));
    return analog_ + (average_ - analog_) * std::pow((average_length_ - 1.0) / average_length_, samples);
}

int Inputs::analog(Instant now) const noexcept { return static_cast<int>(std::lround(filtered(now))); }

void Outputs::factory() {
    type_.fill(OutputType::general);
    high_ = {};
    on_ = {};
}

bool Outputs::has(OutputType type) const noexcept { return std::ranges::find(type_, type) != type_.end(); }

int Outputs::set_up(std::span<const std::int64_t> f) {
    if (f.empty() || f[0] < 1 || f[0] > static_cast<std::int64_t>(output_count)) return err::no_such_point;
    const auto n = static_cast<std::size_t>(f[0] - 1);
    if (!fitted(n)) return err::no_such_point;
    if (f.size() < 2 || f.size() > 3 || (f.size() == 3 && f[2] != 0 && f[2] != 1)) return err::bad_value;
    if (!known_output(f[1])) return err::wrong_type;
    const auto type = static_cast<OutputType>(f[1]);
    const bool high = f.size() == 3 ? f[2] == 1 : high_[n];
    switch (type) {
        case OutputType::encoder_a:
            if (n != 0) return err::wrong_type;
            break;
        case OutputType::encoder_b:
            if (n != 1) return err::wrong_type;
            break;
        case OutputType::trip:
            if (n != 2) return err::wrong_type;
            break;
        case OutputType::locked_rotor:
        case OutputType::hmt_active:
        case OutputType::makeup_active:
            if (!closed_loop_) return err::wrong_type;
            break;
        default:
            break;
    }
    if (type != OutputType::general && type_[n] == type) return err::already_so;
    type_[n] = type;
    high_[n] = type == OutputType::trip ? false : high;  // the trip output is active low only [L4629]
    return 0;
}

int Outputs::set(std::size_t n, bool on) {
    if (!fitted(n)) return err::not_available;
    if (type_[n] != OutputType::general) return err::typed;
    on_[n] = on;
    return 0;
}

int Outputs::set_all(std::int64_t mask) {
    for (std::size_t i = 0; i < output_count; ++i) {
        if (fitted(i) && type_[i] != OutputType::general) return err::typed;
    }
    for (std::size_t i = 0; i < output_count; ++i) {
        if (fitted(i)) on_[i] = (mask >> i & 1) != 0;
    }
    return 0;
}

std::string Outputs::text() const {
    std::string s;
    for (std::size_t i = 0; i < output_count; ++i) {
        if (!fitted(i)) continue;
        s += (s.empty() ? "OS = " : "\r\nOS = ") + std::to_string(i + 1) + ", " + std::to_string(static_cast<int>(type_[i])) + ", " +
             (high_[i] ? "1" : "0");
    }
    return s;
}

void Outputs::save(NonVolatile& m) const {
    for (std::size_t i = 0; i < output_count; ++i) {
        if (!fitted(i)) continue;
        const std::string name = "OS." + std::to_string(i + 1);
        m[name + ".type"] = Value{static_cast<std::int64_t>(type_[i])};
        m[name + ".active"] = Value{std::int64_t{high_[i] ? 1 : 0}};
    }
}

void Outputs::load(const NonVolatile& m) {
    for (std::size_t i = 0; i < output_count; ++i) {
        if (!fitted(i)) continue;
        const std::string name = "OS." + std::to_string(i + 1);
        const std::int64_t type = integer_in(m, name + ".type", 16, 16, 29);
        type_[i] = known_output(type) ? static_cast<OutputType>(type) : OutputType::general;
        high_[i] = integer_in(m, name + ".active", 0, 0, 1) == 1;
    }
}

Duration shortest_pulse(int mode) noexcept {
    constexpr std::array<int, 10> ns{50, 150, 200, 300, 500, 900, 1700, 3300, 6500, 12900};
    return Duration{ns[static_cast<std::size_t>(std::clamp(mode, 0, 9))]};
}

}  // namespace axisgate::mcode::twin
