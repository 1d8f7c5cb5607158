// Register image: a site's mappings become user maps; readings that the maps ask for have tickets of the image's own.
// In: sites, requests, results. Out: maps, bytes. What a map asks for never takes a place that a client's write needs.
#include "gateway/registers/register_image.hpp"

#include <algorithm>
#include <utility>

#include "gateway/site/site_state.hpp"

namespace axisgate::registers {

RegisterImage::RegisterImage(DoorPort& port, Settings settings) : port_(port), settings_(settings), standard_(port, settings.word_order) {
    maps_[0] = maps_[1] = maps_[255] = &standard_;
    readings_.use_number(port_.attach(*this));
}

RegisterImage::~RegisterImage() { port_.detach(*this); }

void RegisterImage::set_map(std::uint8_t unit, UnitMap* map) {
    if (unit <= 1 || unit == 255) return;
    UnitMap* const before = std::exchange(maps_[unit], map);
    if (!before || std::ranges::find(maps_, before) != maps_.end()) return;
    readings_.forget(before);
    for (MapUser* user : users_)
        user->forget(*before);
}

void RegisterImage::set_mappings(std::vector<PlacedMapping> mappings, const std::map<std::uint8_t, MapGaps>& gaps) {
    std::map<std::uint8_t, std::vector<PlacedMapping>> by_unit;
    for (auto& m : mappings)
        by_unit[m.mapping.unit].push_back(std::move(m));
    for (const auto& [unit, map] : user_maps_) {
        if (!by_unit.contains(unit)) set_map(unit, nullptr);
    }
    std::map<std::uint8_t, std::unique_ptr<UserMap>> made;
    for (auto& [unit, list] : by_unit) {
        const auto g = gaps.find(unit);
        auto map = std::make_unique<UserMap>(port_, std::move(list), g == gaps.end() ? settings_.gaps : g->second,
                                             [this](UnitMap& asking, PlannedCommand c) { return ask_for(asking, std::move(c)); });
        set_map(unit, map.get());
        map->begin(port_.now());
        made.emplace(unit, std::move(map));
    }
    user_maps_ = std::move(made);  // those of before stand behind no unit any more
}

void RegisterImage::on_site(const SiteState& state) {
    std::map<std::string_view, std::size_t> index;
    for (std::size_t i = 0; i < state.site.axes.size(); ++i)
        index.emplace(state.site.axes[i].name, i);
    std::vector<PlacedMapping> placed;
    placed.reserve(state.site.map().size());
    for (const auto& m : state.site.map()) {
        const auto it = index.find(m.axis);
        if (it == index.end() || it->second >= state.axis_ids.size()) continue;
        placed.push_back({m, state.axis_ids[it->second], state.site.axes[it->second].increments_per_unit});
    }
    set_mappings(std::move(placed), state.site.gaps);
}

void RegisterImage::on_sample(const Sample& sample) {
    for (const auto& [unit, map] : user_maps_)
        map->on_sample(sample);
}

RegisterRead RegisterImage::read(std::uint8_t unit, Table table, std::uint16_t address, std::uint16_t count) {
    RegisterRead r;
    UnitMap* const map = maps_[unit];
    if (!map) return {Verdict::no_path, {}};
    if (table == Table::coils || table == Table::discrete_inputs) {
        r.bytes.resize((count + 7u) / 8u);
        r.verdict = map->read_bits(table, address, count, r.bytes.data());
    } else {
        r.bytes.resize(2 * std::size_t{count});
        r.verdict = map->read_registers(table, address, count, port_.now(), r.bytes.data());
    }
    (void)map->take_refused();  // there is no client whose refusals are told
    if (r.verdict != Verdict::good) r.bytes.clear();
    return r;
}

void RegisterImage::expire(Instant now) {
    while (const auto waiting = readings_.expired(now)) {
        Result none;
        none.axis = waiting->axis;
        none.outcome = Outcome::failed;
        none.reason = Reason::no_answer;
        if (waiting->map) waiting->map->on_own_result(waiting->note, none);
    }
}

bool RegisterImage::ask_for(UnitMap& map, PlannedCommand planned) {
    const Instant now = port_.now();
    expire(now);
    if (readings_.free() == 0) return false;
    TicketTable::Waiting waiting;
    waiting.axis = planned.axis;
    waiting.map = &map;
    waiting.note = planned.note;
    Command command;
    command.ticket = readings_.open(waiting, now + reading_limit);
    command.axis = planned.axis;
    command.body = std::move(planned.body);
    command.origin.door = Door::internal;
    port_.submit(std::move(command));
    return true;
}

void RegisterImage::on_result(const Result& result) {
    const auto waiting = readings_.close(result.ticket);
    if (!waiting || !waiting->map) return;
    waiting->map->on_own_result(waiting->note, result);
    (void)waiting->map->take_refused();
}

}  // namespace axisgate::registers
