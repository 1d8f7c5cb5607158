// Known: which answer tells which value; what is stored and acts after a restart.
// In: answers. Out: values, notices.
// Never takes what was written to PP for what is in force: it acts after a restart only [L1064].
#include "adapters/uim342/parameters_known.hpp"

#include <fmt/core.h>

#include <cstdlib>

#include "adapters/uim342/drive.hpp"

namespace axisgate::uim342 {

void Known::forget() noexcept {
    ram = {};
    auto_on = absolute_encoder = battery_ok = notifies = closed_loop = std::nullopt;
    ptp_speed.reset();
}

DriveRates Known::rates() const noexcept {
    DriveRates r;
    r.velocity = ptp_speed.value_or(0);
    r.quick_stop = ram.sd.value_or(0);
    if (!ram.time_ramps) return r;
    const auto rate = [&](const std::optional<std::uint32_t>& value) -> std::int64_t {
        if (!value || !*ram.time_ramps) return value.value_or(0);
        const std::int64_t step = r.velocity - static_cast<std::int64_t>(ram.ss.value_or(0));
        return *value == 0 || !ram.ss || step <= 0 ? 0 : 1000 * step / static_cast<std::int64_t>(*value);
    };
    r.acceleration = rate(ram.ac);
    r.deceleration = rate(ram.dc);
    return r;
}

bool Known::changes_rates(const Message& request) noexcept {
    const std::uint8_t f = request.function();
    if (f == cw::SY) return true;
    if (form_of(request) != Form::set) return false;
    return f == cw::AC || f == cw::DC || f == cw::SS || f == cw::SD || (f == cw::IC && request.d[0] == 4);
}

void Known::learn(const Message& request, std::int64_t value, Turn& t) {
    const std::uint8_t f = request.function(), index = request.dl > 0 ? request.d[0] : 0;
    const auto word = static_cast<std::uint32_t>(value);
    const bool set = form_of(request) == Form::set;
    if (f == cw::AC) ram.ac = word;
    if (f == cw::DC) ram.dc = word;
    if (f == cw::SS) ram.ss = word;
    if (f == cw::SD) ram.sd = word;
    if (value != 0 && ((f == cw::SP && set) || (f == cw::DV && index == 2 && !ptp_speed)))
        ptp_speed = static_cast<std::uint32_t>(std::llabs(value));
    if (f == cw::IC && index == 0) auto_on = value != 0;
    if (f == cw::IC && index == 4) ram.time_ramps = value != 0;
    if (f == cw::IC && index == 5) absolute_encoder = value != 0;
    if (f == cw::IC && index == 6) closed_loop = value != 0;
    if (f == cw::QE && index == 3) battery_ok = value != 0;
    if (f == cw::IE && index == 8) notifies = value != 0;
    if (f == cw::IL && index < ram.il.size()) ram.il[index] = static_cast<std::uint16_t>(value);
    if (f == cw::TG && index < ram.tg.size()) ram.tg[index] = static_cast<std::uint16_t>(value);
    if (f == cw::PP && !set && drive_.start.reading().pending()) stored(index, value, t);
}

void Known::misfit(std::string text, Turn& t) { drive_.notice(Severity::warning, "setup", 0, std::move(text), t); }

void Known::stored(std::uint8_t index, std::int64_t value, Turn& t) {
    const std::uint8_t id = drive_.address();
    if (index == 8) {
        group = static_cast<std::uint8_t>(value);
        const std::string other = group == id ? "its own" : drive_.bus.user_of(*group, drive_);
        if (group == id || other.ends_with("node ID"))
            misfit(fmt::format("group ID {} is also a node ID ({}): no two IDs of a network may coincide", *group, other), t);
    }
    if (index == 7 && value != id)
        misfit(fmt::format("it answers as ID {} but has ID {} stored: after its next restart it will be found there", id, value), t);
    const std::uint32_t rate = drive_.bus.bit_rate;
    if (index != 5 || drive_.bus.kind != LineKind::can || rate == 0 || value > 4) return;
    constexpr std::array<std::uint32_t, 5> rates{1'000'000, 800'000, 500'000, 250'000, 125'000};
    if (const auto there = rates[static_cast<std::size_t>(value)]; there != rate)
        misfit(fmt::format("it has {} bit/s stored, the line runs at {}: after its next restart it will be silent", there, rate), t);
}

}  // namespace axisgate::uim342
