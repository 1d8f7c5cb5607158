// All axes of the control. In: what is told to all, memory. Out: states, what is kept. Never starts a traverse.
#include "adapters/pacontrol/twin/axes.hpp"

#include <algorithm>
#include <cmath>

#include "gateway/core/specimen.hpp"

namespace axisgate::pacontrol::twin {

Axes::Axes(int n, const AxisModel& model, const std::map<int, double>& rotary, const AxisParameters& factory)
    : model_(model), rotary_(rotary), factory_(factory) {
    for (int i = std::clamp(n, 1, most); i > 0; --i)
        add();
}

void Axes::add() {
    AxisModel model = model_;
    model.seed = specimen_draw(model_.seed, "axis", static_cast<std::uint64_t>(count()));
    if (const auto it = rotary_.find(count() + 1); it != rotary_.end()) model.revolution = it->second;
    axes_.emplace_back(model, factory_);
    kept_.emplace_back();
}

void Axes::fit(int n) {
    for (const int after = std::clamp(n, 1, most); count() < after;) {
        add();
        axes_.back().boot(kept_.back());
    }
}

bool Axes::all_stand() const noexcept {
    return std::ranges::none_of(axes_, [](const Axis& a) { return a.running(); });
}

void Axes::advance(Instant now) {
    for (Axis& a : axes_)
        a.advance(now);
}

void Axes::settle(Instant now) {
    for (Axis& a : axes_)
        a.settle(now);
}

Instant Axes::deadline() const noexcept {
    Instant next = never;
    for (const Axis& a : axes_)
        next = std::min(next, a.traverse().deadline());
    return next;
}

void Axes::interrupt(Instant now) {
    for (Axis& a : axes_)
        a.traverse().interrupt(now);
}

void Axes::resume(Instant now) {
    for (Axis& a : axes_)
        a.traverse().resume(now);
}

void Axes::finish(Instant now) {
    for (Axis& a : axes_) {
        a.traverse().forget_interrupted();
        a.traverse().finish(now);
    }
}

void Axes::clear_faults() noexcept {
    for (Axis& a : axes_)
        a.clear_fault();
}

void Axes::clear_displaced() noexcept {
    for (Axis& a : axes_)
        a.clear_displaced();
}

void Axes::keep_of(int n) {
    Axis& a = at(n);
    if (!a.take_changed() || a.running()) return;
    kept_[static_cast<std::size_t>(n - 1)] = a.kept();
    ++revision_;
}

void Axes::keep(Memory& memory) const {
    for (int n = 1; n <= count(); ++n) {
        const bool absolute = at(n).parameters()[ap::absolute] != 0;
        const Axis::Kept& kept = kept_[static_cast<std::size_t>(n - 1)];
        if (absolute && kept.position != 0) memory[axis_name(n, "position")] = kept.position;
        if (kept.shaft != 0) memory[axis_name(n, "shaft")] = kept.shaft;
        if (absolute && kept.shift != 0) memory[axis_name(n, "shift")] = kept.shift;
    }
}

bool Axes::restore(std::string_view name, const Value& value) {
    const auto [n, what] = axis_named(name, count());
    const auto number = as_number(value);
    if (n == 0 || !number || !std::isfinite(*number)) return false;
    Axis::Kept& kept = kept_[static_cast<std::size_t>(n - 1)];
    double* const place = what == "position" ? &kept.position : what == "shaft" ? &kept.shaft : what == "shift" ? &kept.shift : nullptr;
    if (place == nullptr) return false;
    *place = std::clamp(*number, -1e9, 1e9);
    return true;
}

void Axes::forget() {
    for (Axis& a : axes_) {
        for (std::size_t i = 1; i <= axis_parameters; ++i)
            a.set_parameter(i, factory_[i]);
    }
    std::ranges::fill(kept_, Axis::Kept{});
}

void Axes::boot() {
    for (std::size_t i = 0; i < axes_.size(); ++i)
        axes_[i].boot(kept_[i]);
}

void Axes::lose_power(Instant now) {
    for (Axis& a : axes_)
        a.lose_power(now);
}

}  // namespace axisgate::pacontrol::twin
