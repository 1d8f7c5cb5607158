// Entries are in order of their addresses and do not overlap, so a request is one search and a walk. Registers 32..44 of an axis in one
// request act together, the control word last. A read of points that are not texts allocates no memory.
#include "gateway/registers/user_map.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "gateway/axis/process_data.hpp"
#include "gateway/registers/register_map.hpp"

namespace axisgate::registers {
namespace {

constexpr std::size_t widest = 2 * 64;  // bytes of the longest text

}  // namespace

Value axis_value(const AxisPointRow& row, const Image& image, const AxisPicture& p, double increments_per_unit, Instant now) {
    const auto whole = [](auto n) { return Value{static_cast<std::int64_t>(n)}; };
    if (row.map == AxisPoint::age_ms) return whole(age_ms(p, now));
    if (row.map == AxisPoint::heartbeat) return whole(heartbeat(now));
    if (row.map == AxisPoint::mapping_revision) return whole(image.mapping_revision);
    const PointValue v = measured(row, p, increments_per_unit);
    if (const auto* b = std::get_if<bool>(&v)) return *b;
    if (const auto* n = std::get_if<std::int64_t>(&v)) return *n;
    if (const auto* d = std::get_if<double>(&v)) return *d;
    if (const auto* s = std::get_if<std::string_view>(&v)) return std::string(*s);
    return {};
}

UserMap::UserMap(const DoorPort& port, std::vector<PlacedMapping> mappings, MapGaps gaps, Ask ask)
    : port_(port), gaps_(gaps), ask_(std::move(ask)) {
    std::ranges::sort(mappings, {}, [](const PlacedMapping& m) { return m.mapping.address; });
    for (auto& m : mappings) {
        Place place{std::move(m)};
        if (const auto* point = std::get_if<AxisPoint>(&place.at.mapping.what)) place.row = row_of(*point);
        if (const auto* point = std::get_if<Point>(&place.at.mapping.what)) {
            const auto [it, added] = index_.emplace(std::pair(place.at.axis, *point), static_cast<std::uint32_t>(values_.size()));
            if (added) values_.push_back({place.at.axis, *point, {}, {}, false});
            place.value = it->second;
        }
        tables_[static_cast<std::size_t>(place.at.mapping.table)].push_back(std::move(place));
    }
}

UserMap::Places::const_iterator UserMap::first_at(const Places& list, std::uint32_t address) const noexcept {
    // Entries do not overlap, so their ends are in order as well.
    return std::ranges::upper_bound(list, address, {}, [](const Place& p) { return p.at.mapping.end(); });
}

template <class F>
Verdict UserMap::each_written(Table table, std::uint16_t address, std::uint16_t count, F&& f) {
    const Places& list = places(table);
    const std::uint32_t end = std::uint32_t{address} + count;
    std::uint32_t at = address;
    for (auto it = first_at(list, address); at < end; ++it) {
        if (it == list.end() || it->at.mapping.address > at) return refuse_gap(table, at, false);
        if (const Verdict e = f(*it); e != Verdict::good) return e;
        at = it->at.mapping.end();
    }
    return Verdict::good;
}

template <class F>
Verdict UserMap::each_read(Table table, std::uint16_t address, std::uint16_t count, F&& f) {
    const Places& list = places(table);
    const std::uint32_t end = std::uint32_t{address} + count;
    std::uint32_t at = address;
    bool touched = false;
    for (auto it = first_at(list, address); it != list.end() && it->at.mapping.address < end; ++it) {
        if (it->at.mapping.access == MapAccess::write) continue;
        if (gaps_ == MapGaps::refuse && it->at.mapping.address > at) break;
        if (const Verdict e = f(*it); e != Verdict::good) return e;
        touched = true;
        at = it->at.mapping.end();
    }
    return !touched || (gaps_ == MapGaps::refuse && at < end) ? refuse_gap(table, at, !touched) : Verdict::good;
}

Verdict UserMap::refuse_gap(Table table, std::uint32_t address, bool nothing_at_all) {
    constexpr std::array names{"coils", "discrete inputs", "holding registers", "input registers"};
    const Places& list = places(table);
    const auto it = first_at(list, address);
    const char* const name = names[static_cast<std::size_t>(table)];
    if (it != list.end() && it->at.mapping.address <= address) {
        return refuse(Verdict::no_address, it->at.axis, Reason::not_writable,
                      fmt::format("address {} of the {} ({} of axis {}) can only be written", address, name, it->at.mapping.point,
                                  it->at.mapping.axis));
    }
    return refuse(Verdict::no_address, no_axis, Reason::unknown_point,
                  nothing_at_all && gaps_ == MapGaps::zero
                      ? fmt::format("nothing is mapped in the {} that the request asks for, from address {} on", name, address)
                      : fmt::format("nothing is mapped at address {} of the {}", address, name));
}

Verdict UserMap::refuse_axis(const Place& place) {
    return refuse(Verdict::no_path, no_axis, Reason::line_down, fmt::format("axis {} is not configured any more", place.at.mapping.axis));
}

void UserMap::want(std::uint32_t index, Instant now) {
    ParameterValue& v = values_[index];
    if (v.asked || readings_ >= most_readings || (known(v.value) && now - v.at < fresh_for)) return;
    if (!ask_(*this, {v.axis, ReadParameter{v.point}, true, index})) return;
    v.asked = true;
    ++readings_;
}

void UserMap::begin(Instant now) {
    for (std::uint32_t i = 0; i < values_.size(); ++i)
        want(i, now);
}

void UserMap::on_own_result(std::uint32_t note, const Result& result) {
    if (note >= values_.size()) return;
    ParameterValue& v = values_[note];
    if (v.asked) --readings_;
    v.asked = false;
    if (!good(result) || !known(result.value)) return;
    v.value = result.value;
    v.at = port_.now();
}

void UserMap::on_sample(const Sample& sample) {
    const auto it = index_.find({sample.axis, sample.point});
    if (it == index_.end()) return;
    values_[it->second].value = sample.value;
    values_[it->second].at = sample.at;
}

Verdict UserMap::value_of(const Place& place, Instant now, Value& value) {
    const AxisPicture& picture = port_.image().picture(place.at.axis);
    if (picture.number == 0) return refuse_axis(place);
    if (place.row) {
        value = axis_value(*place.row, port_.image(), picture, place.at.increments_per_unit, now);
        return Verdict::good;
    }
    if ((picture.flags & flag_online) == 0) return Verdict::no_answer;
    want(place.value, now);
    value = values_[place.value].value;
    return known(value) ? Verdict::good : Verdict::busy;  // the read was just requested; the client must try again
}

Verdict UserMap::check_read(Table table, std::uint16_t address, std::uint16_t count) {
    return each_read(table, address, count,
                     [&](const Place& p) { return port_.image().picture(p.at.axis).number == 0 ? refuse_axis(p) : Verdict::good; });
}

Verdict UserMap::read_registers(Table table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out) {
    const std::uint32_t begin = address, end = begin + count;
    std::memset(out, 0, 2 * std::size_t{count});
    return each_read(table, address, count, [&](const Place& p) {
        const Mapping& m = p.at.mapping;
        Value value;
        if (const Verdict e = value_of(p, now, value); e != Verdict::good) return e;
        std::uint8_t bytes[widest];
        (void)encode(m, value, bytes);  // a value that does not fit affects only itself: it shows its mark, or the end of its type
        const std::uint32_t from = std::max<std::uint32_t>(begin, m.address), to = std::min(end, m.end());
        std::memcpy(out + 2 * std::size_t{from - begin}, bytes + 2 * std::size_t{from - m.address}, 2 * std::size_t{to - from});
        return Verdict::good;
    });
}

std::vector<MapValue> UserMap::values(Table table, std::uint16_t address, std::uint16_t count, bool written) {
    std::vector<MapValue> list;
    const std::uint32_t end = std::uint32_t{address} + count;
    for (auto it = first_at(places(table), address); it != places(table).end() && it->at.mapping.address < end; ++it) {
        const Mapping& m = it->at.mapping;
        if (m.address < address || m.end() > end || m.access == (written ? MapAccess::read : MapAccess::write)) continue;
        const auto* point = std::get_if<AxisPoint>(&m.what);
        list.push_back(
            {m.address, m.size(), m.type == MapType::string, m.word_order, it->at.axis, point ? std::optional(*point) : std::nullopt});
    }
    return list;
}

void UserMap::show(Table table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out) {
    std::memset(out, 0, 2 * std::size_t{count});
    const std::uint32_t end = std::uint32_t{address} + count;
    for (auto it = first_at(places(table), address); it != places(table).end() && it->at.mapping.address < end; ++it) {
        const Mapping& m = it->at.mapping;
        if (m.address < address || m.end() > end || m.access == MapAccess::write) continue;
        Value value;
        if (value_of(*it, now, value) != Verdict::good) value = {};
        (void)encode(m, value, out + 2 * std::size_t(m.address - address));
    }
    refused_ = {};
}

Verdict UserMap::read_bits(Table table, std::uint16_t address, std::uint16_t count, std::uint8_t* out) {
    std::memset(out, 0, (count + 7u) / 8u);
    const Instant now = port_.now();
    return each_read(table, address, count, [&](const Place& p) {
        Value value;
        if (const Verdict e = value_of(p, now, value); e != Verdict::good) return e;
        std::uint8_t bytes[2];
        (void)encode(p.at.mapping, value, bytes);
        const std::uint32_t bit = p.at.mapping.address - std::uint32_t{address};
        if (bytes[1] != 0) out[bit / 8] = static_cast<std::uint8_t>(out[bit / 8] | (1u << (bit % 8)));
        return Verdict::good;
    });
}

bool UserMap::is_exact(std::uint16_t address, Instant now) {
    const Places& list = places(Table::holding_registers);
    const auto it = first_at(list, address);
    Value value;
    std::uint8_t bytes[widest];
    if (it == list.end() || it->at.mapping.address > address || value_of(*it, now, value) != Verdict::good)
        return true;  // refused elsewhere
    if (encode(it->at.mapping, value, bytes)) return true;
    (void)refuse(Verdict::failed, it->at.axis, Reason::wrong_state,
                 fmt::format("{} of axis {} is {}, which its register cannot show: a part of it cannot be changed", it->at.mapping.point,
                             it->at.mapping.axis, to_text(value)));
    return false;
}

Verdict UserMap::check_write(Table table, std::uint16_t address, std::uint16_t count) {
    if (table == Table::discrete_inputs || table == Table::input_registers)
        return refuse(Verdict::no_address, no_axis, Reason::not_writable, "inputs can only be read");
    const std::uint32_t end = std::uint32_t{address} + count;
    const Place* half = nullptr;
    const Place* lost = nullptr;
    const Verdict e = each_written(table, address, count, [&](const Place& p) {
        const Mapping& m = p.at.mapping;
        if (m.access == MapAccess::read) {
            return refuse(Verdict::no_address, p.at.axis, Reason::not_writable,
                          fmt::format("{} of axis {}, at address {}, can only be read", m.point, m.axis, m.address));
        }
        if (!half && (m.address < address || m.end() > end)) half = &p;
        if (!lost && port_.image().picture(p.at.axis).number == 0) lost = &p;
        return Verdict::good;
    });
    if (e != Verdict::good) return e;
    if (half) {
        const Mapping& m = half->at.mapping;
        return refuse(Verdict::bad_value, half->at.axis, Reason::out_of_range,
                      fmt::format("{} of axis {} takes the registers {}..{}: write all of them in one request", m.point, m.axis, m.address,
                                  m.end() - 1));
    }
    return lost ? refuse_axis(*lost) : Verdict::good;
}

Verdict UserMap::plan_value(const Place& place, const Value& value, WritePlan& plan) {
    const AxisId axis = place.at.axis;
    const Mapping& m = place.at.mapping;
    const auto wrong = [&](std::string text) {
        (void)refuse(Verdict::bad_value, axis, Reason::out_of_range, std::move(text));
        refused_.value = to_text(value);
        if (std::holds_alternative<Point>(m.what)) refused_.parameter = m.point;
        return Verdict::bad_value;
    };
    if (!known(value)) return wrong(fmt::format("axis {}: what the registers of {} hold is no number", m.axis, m.point));
    if (const auto* point = std::get_if<AxisPoint>(&place.at.mapping.what)) {
        const auto n = as_integer(value);
        if (!n) return wrong(fmt::format("axis {}: {} is {}, which is no whole number", m.axis, m.point, to_text(value)));
        // All registers 32..44 of one axis in one request act together, the control word last.
        auto same = std::ranges::find_if(
            plan.commands, [&](const PlannedCommand& c) { return c.axis == axis && std::holds_alternative<ProcessData>(c.body); });
        if (same == plan.commands.end()) {
            plan.commands.push_back({axis, ProcessData{}, false, 0});
            same = std::prev(plan.commands.end());
        }
        if (put_process_data(std::get<ProcessData>(same->body), *point, *n)) return Verdict::good;
        return wrong(fmt::format("axis {}: {} {} does not fit its register", m.axis, m.point, *n));
    }
    const Point point = std::get<Point>(place.at.mapping.what);
    const Catalogue* catalogue = port_.catalogue(axis);
    if (!catalogue || !catalogue->parameter(point)) return refuse_axis(place);
    auto checked = catalogue->check_write(point, value);
    if (!checked.fault.empty()) return wrong(fmt::format("axis {}: {}", m.axis, checked.fault));
    plan.commands.push_back({axis, WriteParameter{point, std::move(checked.value)}, false, 0});
    return Verdict::good;
}

Verdict UserMap::write(Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data, WritePlan& plan) {
    if (const Verdict e = check_write(table, address, count); e != Verdict::good) return e;
    const bool bits = table == Table::coils;
    const Verdict e = each_written(table, address, count, [&](const Place& p) {
        const std::uint32_t at = p.at.mapping.address - std::uint32_t{address};
        const Value value =
            bits ? Value{static_cast<std::int64_t>((data[at / 8] >> (at % 8)) & 1)} : decode(p.at.mapping, data + 2 * std::size_t{at});
        return plan_value(p, value, plan);
    });
    if (e != Verdict::good) plan.commands.clear();
    return e;
}

}  // namespace axisgate::registers
