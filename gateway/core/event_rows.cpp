// Rows of identical events and two buckets: the client's own first, so that a client above its rate does not use up the rate of the others.
// A bucket fills by the instants that it is given.
#include "gateway/core/event_rows.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace axisgate {
namespace {
bool same_texts(const Event& a, const Event& b) noexcept {
    return a.text == b.text && a.parameter == b.parameter && a.new_value == b.new_value;
}
std::string times(std::uint64_t n) { return n == 1 ? std::string("once") : fmt::format("{} times", n); }
}  // namespace

bool EventRows::Bucket::take(double burst, double rate, Instant now) noexcept {
    const double filled = at == Instant{} ? burst : level + rate * std::chrono::duration<double>(now - at).count();
    level = std::clamp(filled, 0.0, burst);
    at = now;
    if (level < 1) return false;
    level -= 1;
    return true;
}

EventRows::Client& EventRows::client_of(std::string_view host, Instant now) {
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

void EventRows::tell(Client& c, std::string words, Instant now) {
    // The client's own bucket first: a client above its rate does not use up the rate of the others.
    if (!c.published.take(client_burst, client_rate, now) || !all_.take(all_burst, all_rate, now)) {
        ++c.unpublished;
        ++counted_only_;
        return;
    }
    if (c.unpublished > 0) words += fmt::format("; {} more {} of {} were not told one by one", c.unpublished, what_, c.host);
    c.unpublished = 0;
    Event e = c.event;
    e.text += words;
    tell_(std::move(e), c.axis);
}

void EventRows::end_row(Client& c, Instant now) {
    if (c.again == 0) return;
    const auto n = std::exchange(c.again, 0);
    const auto before = c.unpublished, counted = counted_only_;
    tell(c, fmt::format(": {} more", times(n)), now);
    if (c.unpublished > before) c.unpublished += n - 1;
    counted_only_ = counted;  // these were counted when they came
    c.row_published = now;
}

void EventRows::add(std::string_view host, AxisId axis, Event event, std::string row, Instant now) {
    Client& c = client_of(host, now);
    if (c.axis == axis && c.row == row && (!row.empty() || same_texts(c.event, event))) {
        ++c.again;
        ++counted_only_;
        if (now - c.row_published >= row_lasts_) end_row(c, now);
        return;
    }
    end_row(c, now);
    c.event = std::move(event);
    c.row = std::move(row);
    c.axis = axis;
    c.row_published = now;
    tell(c, {}, now);
}

void EventRows::flush(Instant now) {
    for (auto& c : clients_) {
        if (c.again > 0 && now - c.row_published >= row_lasts_) end_row(c, now);
    }
}

bool EventRows::pending() const noexcept {
    return std::ranges::any_of(clients_, [](const Client& c) { return c.again > 0; });
}

}  // namespace axisgate
