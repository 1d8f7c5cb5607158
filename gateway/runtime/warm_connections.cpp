// An id consists of the door's name and the number of the connection in that door.
#include "gateway/runtime/warm_connections.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

#include "gateway/runtime/clock.hpp"

namespace axisgate {
namespace {
std::string id_of(const HotDoor& door, const DoorConnection& c) { return fmt::format("{}-{}", door.name(), c.number); }

/// `wanted`: only those that this site would close.
std::vector<ClientConnection> all_of(const Hot& hot, const SiteState& site, const SiteState* wanted = nullptr) {
    std::vector<ClientConnection> list;
    for (const HotDoor* door : hot.doors()) {
        const auto goes = wanted ? door->closed_by(*wanted) : std::vector<std::uint64_t>{};
        if (wanted && goes.empty()) continue;
        for (const DoorConnection& c : door->connections()) {
            if (wanted && std::ranges::find(goes, c.number) == goes.end()) continue;
            ClientConnection out{
                id_of(*door, c), std::string(door->name()), std::string(c.kind), c.peer, unix_ns_of(c.since), unix_ns_of(c.received), {},
                c.commands};
            for (const AxisId axis : c.axes) {
                const auto it = std::ranges::find(site.axis_ids, axis);
                if (it != site.axis_ids.end())
                    out.axes.push_back(site.site.axes[static_cast<std::size_t>(it - site.axis_ids.begin())].name);
            }
            list.push_back(std::move(out));
        }
    }
    std::ranges::sort(list, {}, &ClientConnection::id);
    return list;
}

/// The text of the closed connection; empty if the id does not exist.
std::optional<std::string> close_one(const Hot& hot, const std::string& id) {
    const auto dash = id.rfind('-');
    std::uint64_t number = 0;
    if (dash == std::string::npos) return std::nullopt;
    const char* const end = id.data() + id.size();
    if (const auto read = std::from_chars(id.data() + dash + 1, end, number); read.ec != std::errc{} || read.ptr != end)
        return std::nullopt;
    for (HotDoor* door : hot.doors()) {
        if (door->name() != std::string_view(id).substr(0, dash)) continue;
        const auto list = door->connections();
        const auto it = std::ranges::find(list, number, &DoorConnection::number);
        if (it == list.end() || !door->close_connection(number)) continue;
        return fmt::format("connection {} ({}) of {} was closed by a person", id, it->kind, it->peer);
    }
    return std::nullopt;
}
}  // namespace

void WarmConnections::closed_by(Site wanted, std::function<void(List)> then) {
    auto job = [this, wanted = std::move(wanted), then](Engine& engine, Instant) mutable {
        const SiteState there = as_if_in_force(*engine.site(), std::move(wanted));
        threads_.answer([then, list = all_of(threads_.hot, *engine.site(), &there)]() mutable { then(std::move(list)); });
    };
    if (!threads_.on_hot(std::move(job))) threads_.answer([then] { then(std::nullopt); });
}

void WarmConnections::list_connections(std::function<void(List)> then) {
    auto job = [this, then](Engine& engine, Instant) {
        threads_.answer([then, list = all_of(threads_.hot, *engine.site())]() mutable { then(std::move(list)); });
    };
    if (!threads_.on_hot(std::move(job))) threads_.answer([then] { then(std::nullopt); });
}

void WarmConnections::close_connection(std::string id, Origin origin, std::function<void(Closed)> then) {
    auto job = [this, id = std::move(id), origin = std::move(origin), then](Engine&, Instant) {
        threads_.answer([this, origin, then, closed = close_one(threads_.hot, id)] {
            if (closed) events_.note("connection", *closed, origin, Severity::warning);
            then(closed ? Closed::done : Closed::unknown);
        });
    };
    if (!threads_.on_hot(std::move(job))) threads_.answer([then] { then(Closed::busy); });
}

}  // namespace axisgate
