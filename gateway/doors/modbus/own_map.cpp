// Own map: see the header. In: the image, mappings. Out: registers, planned commands.
// Never allocates in a read of points that are not texts.
#include "gateway/doors/modbus/own_map.hpp"

#include <algorithm>
#include <cstring>
#include <optional>

#include "gateway/core/process_data.hpp"
#include "gateway/doors/modbus/register_map.hpp"

namespace axisgate::modbus {
namespace {

constexpr std::size_t widest = 2 * 64;  // bytes of the longest text

Table table_of(MapTable t) noexcept {
    switch (t) {
        case MapTable::coils:
            return Table::coils;
        case MapTable::discrete_inputs:
            return Table::discrete_inputs;
        case MapTable::holding_registers:
            return Table::holding_registers;
        case MapTable::input_registers:
            return Table::input_registers;
    }
    return Table::holding_registers;
}

Value axis_value(const Image& image, const AxisPicture& p, AxisPoint point, double increments_per_unit, Instant now) {
    const auto whole = [](auto n) { return Value{static_cast<std::int64_t>(n)}; };
    const auto flag = [&](std::uint16_t f) { return Value{(p.flags & f) != 0}; };
    switch (point) {
        case AxisPoint::statusword:
            return whole(p.statusword);
        case AxisPoint::mode_display:
            return whole(p.mode_display);
        case AxisPoint::position:
            return whole(p.position);
        case AxisPoint::velocity:
            return whole(p.velocity);
        case AxisPoint::position_demand:
            return whole(p.position_demand);
        case AxisPoint::following_error:
            return whole(p.following_error());
        case AxisPoint::error_code:
            return whole(p.error_code);
        case AxisPoint::flags:
            return whole(p.flags);
        case AxisPoint::native_status:
            return whole(p.native_status);
        case AxisPoint::age_ms:
            return whole(age_ms(p, now));
        case AxisPoint::setpoints_accepted:
            return whole(p.setpoints_accepted);
        case AxisPoint::authority:
            return whole(static_cast<int>(p.authority));
        case AxisPoint::controlword:
            return whole(p.controlword);
        case AxisPoint::mode:
            return whole(p.mode);
        case AxisPoint::target_position:
            return whole(p.target_position);
        case AxisPoint::profile_velocity:
            return whole(p.profile_velocity);
        case AxisPoint::profile_acceleration:
            return whole(p.profile_acceleration);
        case AxisPoint::profile_deceleration:
            return whole(p.profile_deceleration);
        case AxisPoint::target_velocity:
            return whole(p.target_velocity);
        case AxisPoint::homing_method:
            return whole(p.homing_method);
        case AxisPoint::online:
            return flag(flag_online);
        case AxisPoint::simulated:
            return flag(flag_simulated);
        case AxisPoint::stale:
            return flag(flag_stale);
        case AxisPoint::referenced:
            return flag(flag_referenced);
        case AxisPoint::moving:
            return flag(flag_moving);
        case AxisPoint::target_reached:
            return flag(flag_target_reached);
        case AxisPoint::fault:
            return flag(flag_fault);
        case AxisPoint::warning:
            return flag(flag_warning);
        case AxisPoint::position_units:
            return static_cast<double>(p.position) / increments_per_unit;
        case AxisPoint::velocity_units:
            return static_cast<double>(p.velocity) / increments_per_unit;
        case AxisPoint::heartbeat:
            return whole(heartbeat(now));
        case AxisPoint::family:
            return whole(p.family_number);
        case AxisPoint::mapping_revision:
            return whole(image.mapping_revision);
    }
    return {};
}

}  // namespace

OwnMap::OwnMap(const DoorPort& port, std::vector<PlacedMapping> mappings, Ask ask) : port_(port), ask_(std::move(ask)) {
    std::ranges::sort(mappings, {}, [](const PlacedMapping& m) { return m.mapping.address; });
    for (auto& m : mappings) {
        Place place{std::move(m), 0};
        if (const auto* point = std::get_if<Point>(&place.at.mapping.what)) {
            const auto [it, added] = index_.emplace(std::pair(place.at.axis, *point), static_cast<std::uint32_t>(values_.size()));
            if (added) values_.push_back({place.at.axis, *point, {}, {}, false});
            place.value = it->second;
        }
        tables_[static_cast<std::size_t>(table_of(place.at.mapping.table))].push_back(std::move(place));
    }
}

OwnMap::Places::const_iterator OwnMap::first_at(const Places& list, std::uint32_t address) const noexcept {
    // Entries do not overlap, so their ends are in order as well.
    return std::ranges::upper_bound(list, address, {}, [](const Place& p) { return p.at.mapping.end(); });
}

template <class F>
Exception OwnMap::each(Table table, std::uint16_t address, std::uint16_t count, F&& f) const {
    const Places& list = places(table);
    const std::uint32_t end = std::uint32_t{address} + count;
    std::uint32_t at = address;
    for (auto it = first_at(list, address); at < end; ++it) {
        if (it == list.end() || it->at.mapping.address > at) return Exception::illegal_address;
        if (const Exception e = f(*it); e != Exception::none) return e;
        at = it->at.mapping.end();
    }
    return Exception::none;
}

void OwnMap::want(std::uint32_t index, Instant now) {
    ParameterValue& v = values_[index];
    if (v.asked || readings_ >= most_readings || (known(v.value) && now - v.at < fresh_for)) return;
    if (!ask_(*this, {v.axis, ReadParameter{v.point}, true, index})) return;
    v.asked = true;
    ++readings_;
}

void OwnMap::begin(Instant now) {
    for (std::uint32_t i = 0; i < values_.size(); ++i)
        want(i, now);
}

void OwnMap::on_own_result(std::uint32_t note, const Result& result) {
    if (note >= values_.size()) return;
    ParameterValue& v = values_[note];
    if (v.asked) --readings_;
    v.asked = false;
    if (!good(result) || !known(result.value)) return;
    v.value = result.value;
    v.at = port_.now();
}

void OwnMap::on_sample(const Sample& sample) {
    const auto it = index_.find({sample.axis, sample.point});
    if (it == index_.end()) return;
    values_[it->second].value = sample.value;
    values_[it->second].at = sample.at;
}

Exception OwnMap::value_of(const Place& place, Instant now, Value& value) {
    const AxisPicture& picture = port_.image().picture(place.at.axis);
    if (picture.number == 0) return Exception::no_path;
    if (const auto* point = std::get_if<AxisPoint>(&place.at.mapping.what)) {
        value = axis_value(port_.image(), picture, *point, place.at.increments_per_unit, now);
        return Exception::none;
    }
    if ((picture.flags & flag_online) == 0) return Exception::no_answer;
    want(place.value, now);
    value = values_[place.value].value;
    return known(value) ? Exception::none : Exception::busy;  // asked for just now: come again
}

Exception OwnMap::check_read(Table table, std::uint16_t address, std::uint16_t count) {
    return each(table, address, count, [&](const Place& p) {
        if (p.at.mapping.access == MapAccess::write) return Exception::illegal_address;
        return port_.image().picture(p.at.axis).number == 0 ? Exception::no_path : Exception::none;
    });
}

Exception OwnMap::read_registers(Table table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out) {
    const std::uint32_t begin = address, end = begin + count;
    return each(table, address, count, [&](const Place& p) {
        const Mapping& m = p.at.mapping;
        if (m.access == MapAccess::write) return Exception::illegal_address;
        Value value;
        if (const Exception e = value_of(p, now, value); e != Exception::none) return e;
        std::uint8_t bytes[widest];
        if (!encode(m, value, bytes)) return Exception::device_failure;  // more than the type can show: no wrong number instead
        const std::uint32_t from = std::max<std::uint32_t>(begin, m.address), to = std::min(end, m.end());
        std::memcpy(out + 2 * std::size_t{from - begin}, bytes + 2 * std::size_t{from - m.address}, 2 * std::size_t{to - from});
        return Exception::none;
    });
}

Exception OwnMap::read_bits(Table table, std::uint16_t address, std::uint16_t count, std::uint8_t* out) {
    std::memset(out, 0, (count + 7u) / 8u);
    const Instant now = port_.now();
    return each(table, address, count, [&](const Place& p) {
        if (p.at.mapping.access == MapAccess::write) return Exception::illegal_address;
        Value value;
        if (const Exception e = value_of(p, now, value); e != Exception::none) return e;
        std::uint8_t bytes[2];
        if (!encode(p.at.mapping, value, bytes)) return Exception::device_failure;
        const std::uint32_t bit = p.at.mapping.address - std::uint32_t{address};
        if (bytes[1] != 0) out[bit / 8] = static_cast<std::uint8_t>(out[bit / 8] | (1u << (bit % 8)));
        return Exception::none;
    });
}

Exception OwnMap::check_write(Table table, std::uint16_t address, std::uint16_t count) {
    if (table == Table::discrete_inputs || table == Table::input_registers) return Exception::illegal_address;
    const std::uint32_t end = std::uint32_t{address} + count;
    bool halves = false, path = true;
    const Exception e = each(table, address, count, [&](const Place& p) {
        const Mapping& m = p.at.mapping;
        if (m.access == MapAccess::read) return Exception::illegal_address;
        halves = halves || m.address < address || m.end() > end;
        path = path && port_.image().picture(p.at.axis).number != 0;
        return Exception::none;
    });
    if (e != Exception::none) return e;
    if (halves) return Exception::illegal_value;
    return path ? Exception::none : Exception::no_path;
}

Exception OwnMap::plan_value(const Place& place, const Value& value, WritePlan& plan) const {
    if (!known(value)) return Exception::illegal_value;
    const AxisId axis = place.at.axis;
    if (const auto* point = std::get_if<AxisPoint>(&place.at.mapping.what)) {
        const auto n = as_integer(value);
        if (!n) return Exception::illegal_value;
        // All registers 32..44 of one axis in one request act together, the control word last.
        auto same = std::ranges::find_if(
            plan.commands, [&](const PlannedCommand& c) { return c.axis == axis && std::holds_alternative<ProcessData>(c.body); });
        if (same == plan.commands.end()) {
            plan.commands.push_back({axis, ProcessData{}, false, 0});
            same = std::prev(plan.commands.end());
        }
        return put_process_data(std::get<ProcessData>(same->body), *point, *n) ? Exception::none : Exception::illegal_value;
    }
    const Point point = std::get<Point>(place.at.mapping.what);
    const Catalogue* catalogue = port_.catalogue(axis);
    if (!catalogue || !catalogue->parameter(point)) return Exception::no_path;
    auto checked = catalogue->check_write(point, value);
    if (!checked.fault.empty()) return Exception::illegal_value;
    plan.commands.push_back({axis, WriteParameter{point, std::move(checked.value)}, false, 0});
    return Exception::none;
}

Exception OwnMap::write(Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data, WritePlan& plan) {
    if (const Exception e = check_write(table, address, count); e != Exception::none) return e;
    const bool bits = table == Table::coils;
    const Exception e = each(table, address, count, [&](const Place& p) {
        const std::uint32_t at = p.at.mapping.address - std::uint32_t{address};
        const Value value =
            bits ? Value{static_cast<std::int64_t>((data[at / 8] >> (at % 8)) & 1)} : decode(p.at.mapping, data + 2 * std::size_t{at});
        return plan_value(p, value, plan);
    });
    if (e != Exception::none) plan.commands.clear();
    return e;
}

}  // namespace axisgate::modbus
