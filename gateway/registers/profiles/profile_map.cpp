// A request walks over the rows of the language that it touches; a gap is treated as in a user map. A write with one wrong value writes
// nothing.
#include "gateway/registers/profiles/profile_map.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "gateway/axis/cia402.hpp"
#include "gateway/registers/words.hpp"

namespace axisgate::registers {

std::uint32_t bits_of(MapType type, double value) noexcept {
    const auto within = [&](double low, double high) { return std::isnan(value) ? 0.0 : std::clamp(std::nearbyint(value), low, high); };
    switch (type) {
        case MapType::f32:
            return std::bit_cast<std::uint32_t>(static_cast<float>(value));
        case MapType::u32:
            return static_cast<std::uint32_t>(within(0, 4294967295.0));
        case MapType::i32:
            return static_cast<std::uint32_t>(static_cast<std::int32_t>(within(-2147483648.0, 2147483647.0)));
        case MapType::i16:
            return static_cast<std::uint16_t>(static_cast<std::int16_t>(within(-32768, 32767)));
        default:
            return static_cast<std::uint32_t>(within(0, 65535));
    }
}

double number_of(MapType type, std::uint32_t bits) noexcept {
    switch (type) {
        case MapType::f32:
            return std::bit_cast<float>(bits);
        case MapType::i32:
            return static_cast<std::int32_t>(bits);
        case MapType::i16:
            return static_cast<std::int16_t>(bits);
        default:
            return bits;
    }
}

ProfileMap::ProfileMap(const DoorPort& port, Setup setup) : setup_(std::move(setup)), port_(port) {
    written_.reserve(WritePlan::max_commands);
}

bool ProfileMap::there(const LanguageRow& row, Table table) const noexcept {
    const bool in_table = table == Table::holding_registers ? row.holding : table == Table::input_registers && row.input;
    return in_table && row.axis <= setup_.axes.size();
}

template <class F>
Verdict ProfileMap::each(Table table, std::uint16_t address, std::uint16_t count, bool writing, F&& f) {
    const std::uint32_t end = std::uint32_t{address} + count;
    std::uint32_t at = address;
    bool touched = false;
    const auto& rows = language().rows;
    auto it = std::ranges::partition_point(rows, [&](const LanguageRow& r) { return r.end() <= address; });
    for (; it != rows.end() && it->address < end; ++it) {
        if (!there(*it, table) || (writing ? !it->writable : !it->readable)) continue;
        if (it->address > at && (writing || setup_.gaps == MapGaps::refuse)) break;
        if (const Verdict e = f(static_cast<std::size_t>(it - rows.begin())); e != Verdict::good) return e;
        touched = true;
        at = it->end();
    }
    if (touched && (at >= end || (!writing && setup_.gaps == MapGaps::zero))) return Verdict::good;
    return refuse(Verdict::no_address, axis(0).id, writing ? Reason::not_writable : Reason::unknown_point,
                  fmt::format("a {} has no register {} that can be {}", language().title, at, writing ? "written" : "read"));
}

Verdict ProfileMap::check_read(Table table, std::uint16_t address, std::uint16_t count) {
    for (std::size_t i = 0; i < axes(); ++i) {
        if (picture(i).number == 0)
            return refuse(Verdict::no_path, no_axis, Reason::line_down, fmt::format("axis {} is not configured any more", axis(i).name));
    }
    return each(table, address, count, false, [](std::size_t) { return Verdict::good; });
}

Verdict ProfileMap::read_registers(Table table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out) {
    if (const Verdict e = check_read(table, address, count); e != Verdict::good) return e;
    std::memset(out, 0, 2 * std::size_t{count});
    const std::uint32_t begin = address, end = begin + count;
    return each(table, address, count, false, [&](std::size_t index) {
        const LanguageRow& row = language().rows[index];
        std::uint32_t bits = 0;
        if (!shown(index, now, bits)) {
            if (setup_.gaps == MapGaps::zero && count > row.width()) return Verdict::good;
            return refuse(Verdict::failed, axis(0).id, Reason::not_supported,
                          fmt::format("{} says nothing of what {} is", axis(0).name, row.name));
        }
        std::uint8_t bytes[4];
        put_bits(row, bits, bytes);
        const std::uint32_t from = std::max<std::uint32_t>(begin, row.address), to = std::min(end, row.end());
        std::memcpy(out + 2 * std::size_t{from - begin}, bytes + 2 * std::size_t{from - row.address}, 2 * std::size_t{to - from});
        return Verdict::good;
    });
}

Verdict ProfileMap::read_bits(Table, std::uint16_t, std::uint16_t, std::uint8_t*) {
    return refuse(Verdict::no_address, no_axis, Reason::unknown_point, fmt::format("a {} has registers alone", language().title));
}

Verdict ProfileMap::check_write(Table table, std::uint16_t address, std::uint16_t count) {
    if (table != Table::holding_registers)
        return refuse(Verdict::no_address, no_axis, Reason::not_writable, "inputs can only be read, and this unit has no coils");
    const std::uint32_t end = std::uint32_t{address} + count;
    const LanguageRow* half = nullptr;
    if (const Verdict e = each(table, address, count, true,
                               [&](std::size_t index) {
                                   const LanguageRow& row = language().rows[index];
                                   if (row.address < address || row.end() > end) half = &row;
                                   return Verdict::good;
                               });
        e != Verdict::good)
        return e;
    if (half)
        return refuse(
            Verdict::bad_value, axis(0).id, Reason::out_of_range,
            fmt::format("{} takes the registers {} and {}: write both in one request", half->name, half->address, half->address + 1));
    for (std::size_t i = 0; i < axes(); ++i) {
        if (picture(i).number == 0)
            return refuse(Verdict::no_path, no_axis, Reason::line_down, fmt::format("axis {} is not configured any more", axis(i).name));
    }
    return Verdict::good;
}

Verdict ProfileMap::write(Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data, WritePlan& plan) {
    if (const Verdict e = check_write(table, address, count); e != Verdict::good) return e;
    written_.clear();
    Verdict e = each(table, address, count, true, [&](std::size_t index) {
        const LanguageRow& row = language().rows[index];
        const std::uint8_t* const at = data + 2 * std::size_t{row.address - std::uint32_t{address}};
        std::uint32_t bits = 0;
        if (!bits_in(row, at, bits)) {
            out_of_range();
            return Verdict::bad_value;
        }
        written_.push_back({index, bits});
        return Verdict::good;
    });
    if (e == Verdict::good) e = taken(written_, plan);
    if (e != Verdict::good) plan.commands.clear();
    return e;
}

bool ProfileMap::bits_in(const LanguageRow& row, const std::uint8_t* at, std::uint32_t& bits) {
    bits = row.width() == 1 ? get16(at) : get32(at, setup_.word_order);
    const double n = number_of(row.type, bits);
    if (!std::isnan(n) && n >= row.min.value_or(n) && n <= row.max.value_or(n)) return true;
    (void)refuse(Verdict::bad_value, axis(0).id, Reason::out_of_range,
                 fmt::format("{} {} is out of its range: {} to {}", row.name, n, row.min.value_or(-INFINITY), row.max.value_or(INFINITY)));
    refused_.value = fmt::format("{}", n);
    return false;
}

void ProfileMap::put_bits(const LanguageRow& row, std::uint32_t bits, std::uint8_t* at) const noexcept {
    if (row.width() == 1) {
        put16(at, static_cast<std::uint16_t>(bits));
    } else {
        put32(at, bits, setup_.word_order);
    }
}

std::vector<MapValue> ProfileMap::values(Table table, std::uint16_t address, std::uint16_t count, bool written) {
    std::vector<MapValue> list;
    for (const LanguageRow& r : language().rows) {
        if (r.address < address || r.end() > std::uint32_t{address} + count || !there(r, table) || !(written ? r.writable : r.readable))
            continue;
        list.push_back({r.address, r.width(), false, setup_.word_order, axis(r.axis == 0 ? 0 : r.axis - 1u).id, std::nullopt});
    }
    return list;
}

void ProfileMap::show(Table table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out) {
    std::memset(out, 0, 2 * std::size_t{count});
    const auto& rows = language().rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const LanguageRow& r = rows[i];
        std::uint32_t bits = 0;
        if (r.address < address || r.end() > std::uint32_t{address} + count || !there(r, table) || !r.readable || !shown(i, now, bits))
            continue;
        put_bits(r, bits, out + 2 * std::size_t(r.address - address));
    }
}

void ProfileMap::adopt(Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data, WritePlan& plan) {
    written_.clear();
    const auto& rows = language().rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const LanguageRow& r = rows[i];
        std::uint32_t bits = 0;
        if (r.address < address || r.end() > std::uint32_t{address} + count || !there(r, table) || !r.writable) continue;
        if (bits_in(r, data + 2 * std::size_t(r.address - address), bits)) written_.push_back({i, bits});
    }
    refused_ = {};
    adopted(written_, plan);
}

void ProfileMap::renew(Table table, std::uint16_t address, std::span<const MapValue> changed, const std::uint8_t* data, WritePlan& plan,
                       std::vector<Refused>& refused) {
    written_.clear();
    const auto& rows = language().rows;
    auto it = rows.begin();
    for (const MapValue& v : changed) {
        it = std::find_if(it, rows.end(), [&](const LanguageRow& r) { return r.address == v.address && there(r, table) && r.writable; });
        if (it == rows.end()) break;
        std::uint32_t bits = 0;
        if (bits_in(*it, data + 2 * std::size_t(v.address - address), bits)) {
            written_.push_back({static_cast<std::size_t>(it - rows.begin()), bits});
        } else {
            out_of_range();
            refused.push_back(take_refused());
        }
    }
    if (written_.empty()) return;
    if (taken(written_, plan) == Verdict::good) {
        if (auto why = take_refused(); why.reason != Reason::none) refused.push_back(std::move(why));
        return;
    }
    // In an image a wrong value affects only itself: the client gets no answer, and a stop beside it must not be lost.
    plan.commands.clear();
    refused_ = {};
    for (const Written& w : written_) {
        if (taken({&w, 1}, plan) != Verdict::good) refused.push_back(take_refused());
    }
}

bool ProfileMap::enabled(std::size_t i) const { return power_state_of(picture(i).statusword) == PowerState::operation_enabled; }

std::int64_t ProfileMap::increments(std::size_t i, double counts) const {
    constexpr double most = 9.2e18;
    const double x = std::nearbyint(counts * axis(i).increments_per_count);
    return std::isnan(x) ? 0 : static_cast<std::int64_t>(std::clamp(x, -most, most));
}

void ProfileMap::order(WritePlan& plan, std::size_t i, CommandBody body, std::uint32_t note, Answer answer) const {
    PlannedCommand c{axis(i).id, std::move(body), answer != Answer::client, note};
    c.reported = answer == Answer::client;
    c.until_done = answer == Answer::done;
    plan.commands.push_back(std::move(c));
}

Verdict ProfileMap::refused(std::size_t i, Reason reason, std::string text) {
    return refuse(verdict_of(reason), axis(i).id, reason, std::move(text));
}

}  // namespace axisgate::registers
