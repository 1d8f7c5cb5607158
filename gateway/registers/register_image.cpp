// Makes user maps and profiles from the mappings of a site. Parameter reads that the maps request have tickets of the image's own and never
// take the place that a client's write needs.
#include "gateway/registers/register_image.hpp"

#include <algorithm>
#include <utility>

#include "gateway/registers/profiles/cia402_block.hpp"
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
    user_maps_ = std::move(made);  // the former maps are now unused
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
    set_profiles(state);
}

namespace {
/// Counts of a language for one unit of the axis, if the site does not state them.
double own_counts(ProfileLanguage language, const AxisSpec& axis) {
    if (language == ProfileLanguage::pacontrol) return 1;
    if (language != ProfileLanguage::linmot) return axis.increments_per_unit;
    return axis.unit == "m" ? 1e7 : axis.unit == "um" ? 10 : 1e4;  // 0.1 um, for an axis in mm unless its unit is another one
}

PlacedProfileAxis placed_axis(const ProfileAxis& given, ProfileLanguage language, const AxisSpec& axis, AxisId id) {
    PlacedProfileAxis a;
    a.id = id;
    a.number = axis.number;
    a.name = axis.name;
    a.counts_per_unit = given.counts_per_unit.value_or(own_counts(language, axis));
    a.increments_per_count = axis.increments_per_unit / a.counts_per_unit;
    const auto counts = [&](const std::optional<double>& first, const std::optional<double>& second) {
        const auto& x = first ? first : second;
        return x ? std::optional(*x * a.counts_per_unit) : std::nullopt;
    };
    a.velocity = counts(given.velocity, axis.velocity_max);
    a.acceleration = counts(given.acceleration, axis.acceleration_max);
    a.lowest = counts(axis.position_min, std::nullopt);
    a.highest = counts(axis.position_max, std::nullopt);
    return a;
}
}  // namespace

void RegisterImage::set_profiles(const SiteState& state) {
    std::vector<PlacedProfileAxis> axes;
    std::vector<std::vector<PlacedProfileAxis>> by_profile;
    for (const auto& spec : state.site.profiles) {
        auto& list = by_profile.emplace_back();
        for (const auto& given : spec.axes) {
            const auto it = std::ranges::find(state.site.axes, given.axis, &AxisSpec::name);
            const auto i = static_cast<std::size_t>(it - state.site.axes.begin());
            if (it != state.site.axes.end() && i < state.axis_ids.size())
                list.push_back(placed_axis(given, spec.language, *it, state.axis_ids[i]));
        }
        axes.insert(axes.end(), list.begin(), list.end());
    }
    // Modes, toggles and kept registers survive a change of the site that does not concern them.
    if (state.site.profiles == profile_specs_ && axes == profile_axes_ && state.site.gaps == profile_gaps_) return;
    std::map<std::uint8_t, std::unique_ptr<UnitMap>> made;
    for (const auto& [unit, map] : profiles_) {
        if (maps_[unit] == map.get()) set_map(unit, nullptr);
    }
    for (std::size_t p = 0; p < by_profile.size(); ++p) {
        const ProfileSpec& spec = state.site.profiles[p];
        if (by_profile[p].empty()) continue;
        std::unique_ptr<UnitMap> map;
        if (spec.language == ProfileLanguage::cia402) {
            map = std::make_unique<Cia402Block>(standard_, static_cast<std::uint16_t>(by_profile[p].front().number));
        } else if (const auto& page = settings_.languages[static_cast<std::size_t>(spec.language)]) {
            const auto gaps = state.site.gaps.find(spec.unit);
            map = make_profile(spec.language, port_,
                               {page, spec.word_order.value_or(page->word_order), std::move(by_profile[p]),
                                gaps == state.site.gaps.end() ? settings_.gaps : gaps->second});
        }
        if (!map) continue;
        set_map(spec.unit, map.get());
        made.emplace(spec.unit, std::move(map));
    }
    profiles_ = std::move(made);
    profile_specs_ = state.site.profiles;
    profile_axes_ = std::move(axes);
    profile_gaps_ = state.site.gaps;
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
    (void)map->take_refused();  // there is no client to which refusals could be reported
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
