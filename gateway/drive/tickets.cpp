#include "gateway/drive/tickets.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace axisgate::drive {

void Tickets::refuse(const Command& command, Reason reason, std::string text, Out& out) {
    if (command.ticket == no_ticket) return;
    out.results.push_back({command.ticket, command.axis, Outcome::refused, reason, 0, std::move(text), {}, {}});
}

bool Tickets::open(const Command& command, Out& out) {
    if (command.ticket == no_ticket) return true;
    const std::size_t most = is_urgent(command.body) ? limit_ : limit_ - std::min(limit_, for_stops);
    if (open_.size() >= most) {
        refuse(command, Reason::busy, fmt::format("{} commands wait for their results already", open_.size()), out);
        return false;
    }
    open_.push_back({command.ticket, command.axis});
    return true;
}

bool Tickets::answer(Ticket ticket, Outcome outcome, Reason reason, std::string text, Out& out, std::int32_t code, Value value,
                     std::vector<std::uint8_t> bytes) {
    const auto it = std::ranges::find(open_, ticket, &Open::ticket);
    if (it == open_.end()) return false;
    const AxisId axis = it->axis;
    open_.erase(it);
    out.results.push_back({ticket, axis, outcome, reason, code, std::move(text), std::move(value), std::move(bytes)});
    return true;
}

void Tickets::fail_all(Reason reason, std::string_view text, Out& out) {
    for (const Open& o : std::exchange(open_, {}))
        out.results.push_back({o.ticket, o.axis, Outcome::failed, reason, 0, std::string(text), {}, {}});
}

void Tickets::fail_axis(AxisId axis, Reason reason, std::string_view text, Out& out) {
    for (const Open& o : open_) {
        if (o.axis == axis) out.results.push_back({o.ticket, o.axis, Outcome::failed, reason, 0, std::string(text), {}, {}});
    }
    std::erase_if(open_, [axis](const Open& o) { return o.axis == axis; });
}

bool Tickets::is_open(Ticket ticket) const noexcept { return std::ranges::find(open_, ticket, &Open::ticket) != open_.end(); }

}  // namespace axisgate::drive
