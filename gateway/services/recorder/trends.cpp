// Rows are stored in blocks of a few kilobytes, each row as its difference from the previous one: 4 to 12 bytes while an axis moves. Only
// the newest block may be empty.
#include "gateway/services/recorder/trends.hpp"

#include <algorithm>
#include <utility>

#include "gateway/axis/image.hpp"

namespace axisgate {
namespace {
// The members of a row that differ from the previous one.
constexpr std::uint8_t position_bit = 1, demand_bit = 2, velocity_bit = 4, known_bit = 8, statusword_bit = 16, flags_bit = 32;

void put(std::string& out, std::int64_t difference) {
    auto v = static_cast<std::uint64_t>(difference) << 1 ^ static_cast<std::uint64_t>(difference >> 63);
    for (; v >= 0x80; v >>= 7)
        out.push_back(static_cast<char>(v | 0x80));
    out.push_back(static_cast<char>(v));
}
std::int64_t take(const char*& p) {
    std::uint64_t v = 0;
    unsigned shift = 0;
    std::uint8_t byte = 0;
    do {
        byte = static_cast<std::uint8_t>(*p++);
        v |= static_cast<std::uint64_t>(byte & 0x7Fu) << shift;
        shift += 7;
    } while (byte & 0x80u);
    return static_cast<std::int64_t>(v >> 1) ^ -static_cast<std::int64_t>(v & 1);
}
std::int64_t minus(std::int64_t a, std::int64_t b) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}
std::int64_t plus(std::int64_t a, std::int64_t b) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

void widen(TrendColumn& c, const TrendRow& r) {
    c.last = r;
    for (TrendRow* end : {&c.low, &c.high}) {
        end->statusword = r.statusword;
        end->flags = r.flags;
    }
    if (!r.known()) {
        c.gap = true;
        return;
    }
    const auto take = [&r, &c](bool had, auto... members) {
        for (const auto member : {members...}) {
            c.low.*member = had ? std::min(c.low.*member, r.*member) : r.*member;
            c.high.*member = had ? std::max(c.high.*member, r.*member) : r.*member;
        }
    };
    take(std::exchange(c.known, true), &TrendRow::position, &TrendRow::velocity);
    if (!r.demand_known) return;
    const bool had = std::exchange(c.demand_known, true);
    take(had, &TrendRow::demand);
    c.least_error = had ? std::min(c.least_error, r.following_error()) : r.following_error();
    c.greatest_error = had ? std::max(c.greatest_error, r.following_error()) : r.following_error();
}
TrendColumn column_of(const TrendRow& r) {
    TrendColumn c;
    c.first = c.low = c.high = r;
    widen(c, r);
    return c;
}
}  // namespace

namespace {
void put_row(std::string& out, const TrendRow& was, const TrendRow& row) {
    const auto mask = static_cast<std::uint8_t>(
        (row.position != was.position ? position_bit : 0) | (row.demand != was.demand ? demand_bit : 0) |
        (row.velocity != was.velocity ? velocity_bit : 0) | (row.demand_known != was.demand_known ? known_bit : 0) |
        (row.statusword != was.statusword ? statusword_bit : 0) | (row.flags != was.flags ? flags_bit : 0));
    out.push_back(static_cast<char>(mask));
    put(out, ns_of(row.at) - ns_of(was.at));
    if (mask & position_bit) put(out, minus(row.position, was.position));
    if (mask & demand_bit) put(out, minus(row.demand, was.demand));
    if (mask & velocity_bit) put(out, minus(row.velocity, was.velocity));
    if (mask & statusword_bit) put(out, row.statusword);
    if (mask & flags_bit) put(out, row.flags);
}

/// Like take(), but never reads beyond the end.
bool take_checked(std::span<const char>& in, std::int64_t& v) {
    std::uint64_t raw = 0;
    for (unsigned shift = 0; shift < 64 && !in.empty(); shift += 7) {
        const auto byte = static_cast<std::uint8_t>(in.front());
        in = in.subspan(1);
        raw |= static_cast<std::uint64_t>(byte & 0x7Fu) << shift;
        if ((byte & 0x80u) != 0) continue;
        v = static_cast<std::int64_t>(raw >> 1) ^ -static_cast<std::int64_t>(raw & 1);
        return true;
    }
    return false;
}
}  // namespace

std::string pack_rows(std::span<const TrendRow> rows) {
    std::string out;
    TrendRow was;
    for (const TrendRow& r : rows) {
        put_row(out, was, r);
        was = r;
    }
    return out;
}

std::optional<std::vector<TrendRow>> unpack_rows(std::span<const char> in) {
    std::vector<TrendRow> rows;
    TrendRow r;
    while (!in.empty()) {
        const auto mask = static_cast<std::uint8_t>(in.front());
        in = in.subspan(1);
        std::int64_t v = 0;
        if (mask > 63 || !take_checked(in, v)) return std::nullopt;
        r.at = at_ns(plus(ns_of(r.at), v));
        for (const auto& [bit, member] :
             {std::pair{position_bit, &TrendRow::position}, {demand_bit, &TrendRow::demand}, {velocity_bit, &TrendRow::velocity}}) {
            if (!(mask & bit)) continue;
            if (!take_checked(in, v)) return std::nullopt;
            r.*member = plus(r.*member, v);
        }
        if (mask & known_bit) r.demand_known = !r.demand_known;
        for (const auto& [bit, member] : {std::pair{statusword_bit, &TrendRow::statusword}, {flags_bit, &TrendRow::flags}}) {
            if (!(mask & bit)) continue;
            if (!take_checked(in, v) || v < 0 || v > 0xFFFF) return std::nullopt;
            r.*member = static_cast<std::uint16_t>(v);
        }
        if (!rows.empty() && r.at < rows.back().at) return std::nullopt;
        rows.push_back(r);
    }
    return rows;
}

bool TrendRow::known() const noexcept { return (flags & flag_stale) == 0; }

TrendRow trend_row(const PictureRecord& p, Instant at) noexcept {
    TrendRow row;
    row.at = at;
    row.position = p.position;
    row.demand_known = p.demand_source == DemandSource::drive || p.demand_source == DemandSource::computed;
    row.demand = row.demand_known ? p.demand : p.position;
    row.velocity = p.velocity;
    row.statusword = p.statusword;
    row.flags = p.flags;
    return row;
}

template <class F>
void Trends::for_each(const Block& block, F&& f) {
    TrendRow r = block.head;
    f(r);
    const char* p = block.rows.data();
    const char* const end = p + block.rows.size();
    while (p < end) {
        const auto mask = static_cast<std::uint8_t>(*p++);
        r.at = at_ns(plus(ns_of(r.at), take(p)));
        if (mask & position_bit) r.position = plus(r.position, take(p));
        if (mask & demand_bit) r.demand = plus(r.demand, take(p));
        if (mask & velocity_bit) r.velocity = plus(r.velocity, take(p));
        if (mask & known_bit) r.demand_known = !r.demand_known;
        if (mask & statusword_bit) r.statusword = static_cast<std::uint16_t>(take(p));
        if (mask & flags_bit) r.flags = static_cast<std::uint16_t>(take(p));
        f(r);
    }
}

void Trends::append(Axis& a, const TrendRow& row) {
    if (a.blocks.empty() || a.blocks.back().rows.size() + 64 > block_bytes) {
        Block b;
        b.head = b.tail = row;
        b.rows.reserve(block_bytes);
        bytes_ += b.size();
        a.blocks.push_back(std::move(b));
        return;
    }
    Block& b = a.blocks.back();
    const TrendRow was = std::exchange(b.tail, row);
    put_row(b.rows, was, row);
}

void Trends::add(AxisId id, const PictureRecord& p, Instant at) {
    if (!p.current && !axes_.contains(id)) return;  // there was no feedback yet
    Axis& a = axes_[id];
    if (p.current && at - p.age != a.reported) {
        a.reported = at - p.age;
        ++a.counted;
    }
    if (a.counted_from == Instant{}) a.counted_from = at;
    if (const Duration span = at - a.counted_from; span >= std::chrono::seconds(1)) {
        a.rate_hz = static_cast<double>(a.counted) / std::chrono::duration<double>(span).count();
        a.counted = 0;
        a.counted_from = at;
    }
    const TrendRow row = trend_row(p, a.blocks.empty() ? at : std::max(at, a.blocks.back().tail.at));
    if (row.known()) a.newest = std::max(a.newest.value_or(at), at);
    if (!a.blocks.empty() && a.blocks.back().tail.same_values(row)) return;
    append(a, row);
    shorten(a, at);
    if (bytes_ > bound_) make_room();
}

/// A block is dropped when the next one begins before the retained period, so that the row that is valid at its begin stays known.
void Trends::shorten(Axis& a, Instant now) {
    while (a.blocks.size() > 1 && now - a.blocks[1].head.at > keep_) {
        bytes_ -= a.blocks.front().size();
        a.blocks.pop_front();
    }
}

void Trends::restore(AxisId id, std::span<const TrendRow> rows) {
    if (axes_.contains(id) || rows.empty()) return;
    Axis& a = axes_[id];
    for (const TrendRow& r : rows)
        append(a, r);
    const auto known = std::ranges::find_if(rows.rbegin(), rows.rend(), &TrendRow::known);
    if (known != rows.rend()) a.newest = known->at;
    if (bytes_ > bound_) make_room();
}

void Trends::make_room() {
    while (bytes_ > bound_) {
        Axis* oldest = nullptr;
        for (auto& [id, a] : axes_) {
            if (a.blocks.size() > 1 && (!oldest || a.blocks.front().head.at < oldest->blocks.front().head.at)) oldest = &a;
        }
        if (!oldest) return;  // each axis needs at least one block
        bytes_ -= oldest->blocks.front().size();
        oldest->blocks.pop_front();
    }
}

TrendStretch Trends::read(AxisId id, Instant from, Instant to, std::size_t columns) const {
    TrendStretch out;
    const auto it = axes_.find(id);
    if (it == axes_.end() || it->second.blocks.empty()) return out;
    const Axis& a = it->second;
    out.rate_hz = a.rate_hz;
    out.oldest = a.blocks.front().head.at;
    out.newest = a.newest;
    if (to < from) return out;
    std::vector<TrendRow> rows;
    std::optional<TrendRow> holds;
    for (std::size_t i = 0; i < a.blocks.size(); ++i) {
        if (i + 1 < a.blocks.size() && a.blocks[i + 1].head.at <= from) continue;  // all of it is older
        if (a.blocks[i].head.at > to) break;
        for_each(a.blocks[i], [&](const TrendRow& r) {
            if (r.at <= from)
                holds = r;
            else if (r.at <= to)
                rows.push_back(r);
        });
    }
    if (holds) {
        holds->at = from;
        rows.insert(rows.begin(), *holds);
    }
    if (columns == 0 || rows.size() <= columns) {
        for (const auto& r : rows)
            out.columns.push_back(column_of(r));
        return out;
    }
    out.thinned = true;
    const auto span = std::max<std::int64_t>(1, (to - from).count());
    const auto place = [&](Instant at) {
        const double share = static_cast<double>((at - from).count()) / static_cast<double>(span);
        return std::min(columns - 1, static_cast<std::size_t>(share * static_cast<double>(columns)));
    };
    std::size_t last = columns;  // none yet
    TrendRow before = rows.front();
    for (const auto& r : rows) {
        const std::size_t n = place(r.at);
        if (n != last) {
            // The value at the begin of a column is part of it, unless a new value was reported at that very instant.
            TrendRow first = r;
            const Instant begins =
                from +
                Duration(static_cast<std::int64_t>(static_cast<double>(span) * static_cast<double>(n) / static_cast<double>(columns)));
            if (last != columns && r.at > begins) {
                first = before;
                first.at = begins;
            }
            out.columns.push_back(column_of(first));
            last = n;
        }
        widen(out.columns.back(), r);
        before = r;
    }
    return out;
}

}  // namespace axisgate
