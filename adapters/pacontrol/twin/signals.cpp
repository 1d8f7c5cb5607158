// Elements of the control. In: values, memory. Out: values. Never keeps inputs and outputs without supply.
#include "adapters/pacontrol/twin/signals.hpp"

#include <cmath>

#include "adapters/pacontrol/twin/value.hpp"

namespace axisgate::pacontrol::twin {

bool Signals::input(std::int64_t n) const noexcept {
    return elements_.inputs.get(n) || (n != 0 && n == system_[sp::stop_input] && external_stop_);
}

bool Signals::output(std::int64_t n) const noexcept {
    if (n != 0 && n == system_[sp::readiness_output]) return !error_.stands();
    if (n != 0 && n == system_[sp::malfunction_output]) return error_.stands();
    return elements_.outputs.get(n);
}

void Signals::scan(Instant now) noexcept {
    if (period_ == Duration::zero()) return;
    const Instant tick = time_zero + (now - time_zero) / period_ * period_;
    if (tick <= scanned_) return;
    scanned_ = tick;
    inputs_ = elements_.inputs;
    outputs_ = elements_.outputs;
    const std::int64_t stop = system_[sp::stop_input];
    inputs_.set(stop, input(stop));
    for (const std::int64_t own : {std::int64_t{system_[sp::malfunction_output]}, std::int64_t{system_[sp::readiness_output]}})
        outputs_.set(own, output(own));
}

bool Signals::external_stop_powered() const noexcept {
    const std::int32_t n = system_[sp::stop_input];
    return n != 0 && input(n);
}

bool Signals::external_stop_open() const noexcept { return system_[sp::stop_input] != 0 && !external_stop_powered(); }

void Signals::set_flag(std::int64_t n, bool on) noexcept {
    if (elements_.flags.get(n) != on) ++revision_;
    elements_.flags.set(n, on);
}

void Signals::set_flag_word(std::int64_t n, std::uint16_t word) noexcept {
    if (elements_.flags.word_of(n) != word) ++revision_;
    elements_.flags.set_word_of(n, word);
}

void Signals::set_n(std::int64_t n, std::int32_t v) noexcept {
    if (elements_.n.get(n) != v) ++revision_;
    elements_.n.set(n, v);
}

void Signals::set_r(std::int64_t n, float v) noexcept {
    if (!std::isfinite(v)) return;  // an image may hold any bits
    if (elements_.r.get(n) != v) ++revision_;
    elements_.r.set(n, v);
}

void Signals::keep(Memory& memory) const {
    for (std::int64_t n = 1; n <= static_cast<std::int64_t>(twin::elements); ++n) {
        if (elements_.flags.get(n)) memory["M" + std::to_string(n)] = true;
        if (const auto v = elements_.n.get(n); v != 0) memory["N" + std::to_string(n)] = std::int64_t{v};
        if (const auto v = elements_.r.get(n); v != 0) memory["R" + std::to_string(n)] = static_cast<double>(v);
    }
}

bool Signals::restore(std::string_view name, const Value& value) {
    const auto number = as_number(value);
    if (!number) return false;
    if (const auto m = numbered(name, "M")) {
        elements_.flags.set(*m, *number != 0);
    } else if (const auto n = numbered(name, "N")) {
        elements_.n.set(*n, whole(Datum::integer(*number)));
    } else if (const auto r = numbered(name, "R")) {
        elements_.r.set(*r, single(Datum::number(*number)).value_or(0));
    } else {
        return false;
    }
    return true;
}

void Signals::forget() {
    const auto& is = elements_;
    elements_ = {is.inputs, Bits{is.outputs.count()}, Bits{is.flags.count()}, Registers<std::int32_t>{is.n.count()},
                 Registers<float>{is.r.count()}};
}

}  // namespace axisgate::pacontrol::twin
