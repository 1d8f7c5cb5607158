// Composes the text of a refusal and of the request that it answers.
#include "gateway/registers/refusals.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace axisgate::registers {
namespace {
std::string_view host_of(std::string_view who) noexcept { return who.substr(0, who.rfind(':')); }
}  // namespace

std::string text_of(const RequestNote& n) {
    constexpr std::string_view tables[] = {"coil", "discrete input", "holding register", "input register"};
    if (n.count == 0) return fmt::format("unit {} function {}", n.unit, n.code);
    const bool coils = n.table == Table::coils;
    const std::string_view what = n.write && !coils ? "register" : tables[static_cast<std::size_t>(n.table)];
    std::string s = n.count == 1 ? fmt::format("unit {} {} {}", n.unit, what, n.address)
                                 : fmt::format("unit {} {}s {}..{}", n.unit, what, n.address, std::uint32_t{n.address} + n.count - 1);
    if (!n.write) return s;
    s += " =";
    const std::size_t shown = coils ? 1 : std::min<std::size_t>(n.count, RequestNote::most_shown);
    for (std::size_t i = 0; i < shown; ++i)
        s += fmt::format(" {}", n.values[i]);
    if (shown < n.count) s += " ...";
    return s;
}

Event RefusalLog::event_of(std::string_view who, Severity severity) const {
    Event e;
    e.kind = "refused";
    e.severity = severity;
    e.who = who;
    e.door = std::string(name_of(door_));
    return e;
}

void RefusalLog::add(std::string_view who, Refused r, const RequestNote& note, std::string_view answer, Instant now) {
    Event e = event_of(who, note.write ? Severity::warning : Severity::info);
    e.parameter = std::move(r.parameter);
    e.new_value = std::move(r.value);
    e.text = fmt::format("{} ({}: {})", r.text, text_of(note), answer.empty() ? "the parameter channel shows it" : answer);
    rows_.add(host_of(who), r.axis, std::move(e), {}, now);
}

void RefusalLog::add(std::string_view who, AxisId axis, std::string_view what, std::string_view why, Instant now) {
    Event e = event_of(who, Severity::warning);
    e.text = fmt::format("{} ({})", why, what);
    rows_.add(host_of(who), axis, std::move(e), {}, now);
}

}  // namespace axisgate::registers
