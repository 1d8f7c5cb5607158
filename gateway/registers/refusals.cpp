// Refusals: rows of identical refusals, and two buckets: the client's own first, so that who is over it uses up nothing of the others'.
// In: refusals. Out: events. Never looks at a clock: a bucket fills by the instants that it is given.
#include "gateway/registers/refusals.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace axisgate::registers {
namespace {
std::string_view host_of(std::string_view who) noexcept { return who.substr(0, who.rfind(':')); }
bool same_row(const Event& a, const Event& b) noexcept {
    return a.text == b.text && a.parameter == b.parameter && a.new_value == b.new_value;
}
std::string times(std::uint64_t n) { return n == 1 ? std::string("once") : fmt::format("{} times", n); }
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

bool RefusalLog::Bucket::take(double burst, double rate, Instant now) noexcept {
    const double filled = at == Instant{} ? burst : level + rate * std::chrono::duration<double>(now - at).count();
    level = std::clamp(filled, 0.0, burst);
    at = now;
    if (level < 1) return false;
    level -= 1;
    return true;
}

RefusalLog::Client& RefusalLog::client_of(std::string_view host, Instant now) {
    auto it = std::ranges::find(clients_, host, &Client::host);
    if (it == clients_.end()) {
        if (clients_.size() >= most_clients) {
            it = std::ranges::min_element(clients_, {}, &Client::received);
            end_row(*it, now);
            *it = {};
        } else {
            it = clients_.emplace(clients_.end());
        }
        it->host = host;
    }
    it->received = now;
    return *it;
}

void RefusalLog::tell(Client& c, std::string words, Instant now) {
    // The client's own bucket first: one that is over its rate does not use up what the others may tell.
    if (!c.published.take(client_burst, client_rate, now) || !all_.take(all_burst, all_rate, now)) {
        ++c.unpublished;
        return;
    }
    if (c.unpublished > 0) words += fmt::format("; {} more refusals of {} were not told one by one", c.unpublished, c.host);
    c.unpublished = 0;
    Event e = c.event;
    e.text += words;
    tell_(std::move(e), c.axis);
}

void RefusalLog::end_row(Client& c, Instant now) {
    if (c.again == 0) return;
    const auto n = std::exchange(c.again, 0);
    const auto before = c.unpublished;
    tell(c, fmt::format(": {} more", times(n)), now);
    if (c.unpublished > before) c.unpublished += n - 1;
    c.row_published = now;
}

void RefusalLog::add(std::string_view who, Refused r, const RequestNote& note, std::string_view answer, Instant now) {
    Client& c = client_of(host_of(who), now);
    Event e;
    e.kind = "refused";
    e.severity = note.write ? Severity::warning : Severity::info;
    e.who = who;
    e.door = std::string(name_of(door_));
    e.parameter = std::move(r.parameter);
    e.new_value = std::move(r.value);
    e.text = fmt::format("{} ({}: {})", r.text, text_of(note), answer.empty() ? "the parameter channel shows it" : answer);
    if (c.axis == r.axis && same_row(c.event, e)) {
        ++c.again;
        if (now - c.row_published >= row_period) end_row(c, now);
        return;
    }
    end_row(c, now);
    c.event = std::move(e);
    c.axis = r.axis;
    c.row_published = now;
    tell(c, {}, now);
}

void RefusalLog::flush(Instant now) {
    for (auto& c : clients_) {
        if (c.again > 0 && now - c.row_published >= row_period) end_row(c, now);
    }
}

bool RefusalLog::pending() const noexcept {
    return std::ranges::any_of(clients_, [](const Client& c) { return c.again > 0; });
}

}  // namespace axisgate::registers
