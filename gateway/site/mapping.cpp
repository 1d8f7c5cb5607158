// Mapping: reads and writes the entries of a user map. Only the form of an entry is checked here; no value is read.
#include "gateway/site/mapping.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "gateway/core/catalogue.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {

template <class E, std::size_t N>
std::optional<E> named(const std::array<std::pair<std::string_view, E>, N>& names, std::string_view name) {
    const auto it = std::ranges::find(names, name, &std::pair<std::string_view, E>::first);
    return it == names.end() ? std::nullopt : std::optional(it->second);
}
template <class E, std::size_t N>
std::string_view name_in(const std::array<std::pair<std::string_view, E>, N>& names, E e) {
    return std::ranges::find(names, e, &std::pair<std::string_view, E>::second)->first;
}
template <class E, std::size_t N>
std::string list(const std::array<std::pair<std::string_view, E>, N>& names) {
    std::string s;
    for (const auto& [n, e] : names)
        s += (s.empty() ? "" : ", ") + std::string(n);
    return s;
}

constexpr std::array table_names{std::pair{std::string_view("coils"), MapTable::coils},
                                 std::pair{std::string_view("discrete_inputs"), MapTable::discrete_inputs},
                                 std::pair{std::string_view("holding_registers"), MapTable::holding_registers},
                                 std::pair{std::string_view("input_registers"), MapTable::input_registers}};
// Common short names that are accepted, too.
constexpr std::array table_short_names{std::pair{std::string_view("coil"), MapTable::coils},
                                       std::pair{std::string_view("discrete"), MapTable::discrete_inputs},
                                       std::pair{std::string_view("discrete_input"), MapTable::discrete_inputs},
                                       std::pair{std::string_view("holding"), MapTable::holding_registers},
                                       std::pair{std::string_view("holding_register"), MapTable::holding_registers},
                                       std::pair{std::string_view("input"), MapTable::input_registers},
                                       std::pair{std::string_view("input_register"), MapTable::input_registers}};
constexpr std::array type_names{
    std::pair{std::string_view("bool"), MapType::boolean}, std::pair{std::string_view("u16"), MapType::u16},
    std::pair{std::string_view("i16"), MapType::i16},      std::pair{std::string_view("u32"), MapType::u32},
    std::pair{std::string_view("i32"), MapType::i32},      std::pair{std::string_view("f32"), MapType::f32},
    std::pair{std::string_view("u64"), MapType::u64},      std::pair{std::string_view("i64"), MapType::i64},
    std::pair{std::string_view("f64"), MapType::f64},      std::pair{std::string_view("string"), MapType::string}};
constexpr std::array type_long_names{std::pair{std::string_view("boolean"), MapType::boolean}};
constexpr std::array access_names{std::pair{std::string_view("R"), MapAccess::read}, std::pair{std::string_view("W"), MapAccess::write},
                                  std::pair{std::string_view("RW"), MapAccess::read_write}};
constexpr std::array access_long_names{
    std::pair{std::string_view("read"), MapAccess::read},    std::pair{std::string_view("r"), MapAccess::read},
    std::pair{std::string_view("ro"), MapAccess::read},      std::pair{std::string_view("write"), MapAccess::write},
    std::pair{std::string_view("w"), MapAccess::write},      std::pair{std::string_view("read_write"), MapAccess::read_write},
    std::pair{std::string_view("rw"), MapAccess::read_write}};
constexpr std::array order_names{std::pair{std::string_view("high_first"), MapWordOrder::high_first},
                                 std::pair{std::string_view("low_first"), MapWordOrder::low_first}};
constexpr std::array overflow_names{std::pair{std::string_view("mark"), MapOverflow::mark},
                                    std::pair{std::string_view("clamp"), MapOverflow::clamp}};

constexpr bool is_bits(MapTable t) noexcept { return t == MapTable::coils || t == MapTable::discrete_inputs; }

/// Reads the members of one entry; each fault has its pointer.
class Entry {
public:
    Entry(const json::object& o, std::size_t index, std::vector<SiteFault>& faults)
        : o_(o), base_(fmt::format("/mappings/{}", index)), faults_(faults), faults_before_(faults.size()) {}

    [[nodiscard]] bool good() const noexcept { return faults_.size() == faults_before_; }

    void fault(std::string_view key, std::string text, std::string remedy) {
        faults_.push_back({key.empty() ? base_ : fmt::format("{}/{}", base_, key), std::move(text), std::move(remedy)});
    }
    void conflict(std::string_view key, std::string text, std::string remedy) {
        fault(key, std::move(text), std::move(remedy));
        faults_.back().conflict = true;
    }
    [[nodiscard]] const json::value* member(std::string_view key) const {
        const auto* v = o_.if_contains(key);
        return v && !v->is_null() ? v : nullptr;
    }
    std::string text(std::string_view key, std::size_t most, bool needed) {
        const auto* v = member(key);
        if (!v) {
            if (needed) fault(key, fmt::format("{} is missing", key), fmt::format("write \"{}\": \"...\"", key));
            return {};
        }
        if (v->is_int64()) return std::to_string(v->get_int64());
        if (!v->is_string() || v->get_string().size() > most) {
            fault(key, fmt::format("{} must be a text of at most {} bytes", key, most), "write it in quotes");
            return {};
        }
        return std::string(v->get_string());
    }
    std::optional<std::int64_t> whole(std::string_view key, std::int64_t low, std::int64_t high, std::optional<std::int64_t> fallback) {
        const auto* v = member(key);
        if (!v) {
            if (!fallback) fault(key, fmt::format("{} is missing", key), fmt::format("write a whole number {}..{}", low, high));
            return fallback;
        }
        std::int64_t n = 0;
        bool good = v->is_int64() || v->is_uint64() || v->is_double();
        if (v->is_int64()) n = v->get_int64();
        if (v->is_uint64()) {
            good = v->get_uint64() < 1'000'000'000;
            n = good ? static_cast<std::int64_t>(v->get_uint64()) : 0;
        }
        if (v->is_double()) {
            good = v->get_double() == std::floor(v->get_double()) && std::fabs(v->get_double()) < 1e9;
            n = good ? static_cast<std::int64_t>(v->get_double()) : 0;
        }
        if (!good || n < low || n > high) {
            fault(key, fmt::format("{} must be a whole number {}..{}", key, low, high), fmt::format("write a number {}..{}", low, high));
            return std::nullopt;
        }
        return n;
    }
    double number(std::string_view key, double fallback) {
        const auto* v = member(key);
        if (!v) return fallback;
        boost::system::error_code ec;
        const double n = v->to_number<double>(ec);
        if (ec || !std::isfinite(n)) {
            fault(key, fmt::format("{} must be a number", key), fmt::format("leave it out for {}", fallback));
            return fallback;
        }
        return n;
    }
    /// One of the words in `names` or of their short forms; nothing if the member is missing or is none of them.
    template <class E, std::size_t N, std::size_t M = 0>
    std::optional<E> word(std::string_view key, const std::array<std::pair<std::string_view, E>, N>& names,
                          const std::array<std::pair<std::string_view, E>, M>& others = {}) {
        const std::string t = text(key, 32, false);
        auto found = named(names, t);
        if (!found) found = named(others, t);
        if (!found && !t.empty())
            fault(key, fmt::format("there is no {} {}", key == "word_order" ? "word order" : key, t),
                  key == "access" ? "use R, W or RW" : "use one of " + list(names));
        return found;
    }
    void no_unknown_members() {
        constexpr std::array known{"id",         "unit",  "table",  "address", "axis",   "point",       "type",
                                   "word_order", "scale", "offset", "access",  "length", "on_overflow", "comment"};
        for (const auto& [key, value] : o_) {
            if (std::ranges::find(known, std::string_view(key)) == known.end())
                fault(key, fmt::format("{} is not known here", std::string_view(key)),
                      "a mapping has id, unit, table, address, axis, point, type, word_order, scale, offset, access, length, "
                      "on_overflow, comment");
        }
    }

private:
    const json::object& o_;
    std::string base_;
    std::vector<SiteFault>& faults_;
    std::size_t faults_before_;
};

/// The ids of a list: those that are given, and new ones for entries without an id.
class Ids {
public:
    explicit Ids(const json::array& entries) {
        for (const auto& e : entries) {
            const auto* o = e.if_object();
            if (const auto* id = o ? o->if_contains("id") : nullptr; id && id->is_string()) taken_.insert(std::string(id->get_string()));
        }
    }
    std::string read(Entry& f) {
        std::string id = f.text("id", 64, false);
        if (id.empty()) {
            id = unique();
        } else if (!std::ranges::all_of(id, [](char c) {
                       return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' || c == '_' ||
                              c == '.';
                   })) {
            f.fault("id", fmt::format("\"{}\" is no id", id), "use 1 to 64 letters, digits, - _ and .");
        }
        if (!used_.insert(id).second) f.conflict("id", fmt::format("the id {} is there twice", id), "give each mapping its own, or none");
        return id;
    }

private:
    std::string unique() {
        for (;; ++next_) {
            std::string id = fmt::format("m{}", next_);
            if (taken_.insert(id).second) return id;
        }
    }

    std::set<std::string> taken_, used_;
    std::size_t next_ = 1;
};

/// "feeder.position", "feeder/position", "feeder:AC": an axis in front of its point, if the entry has no separate axis.
void split_axis(std::string& axis, std::string& point, const Site& site) {
    if (!axis.empty()) return;
    const AxisSpec* best = nullptr;
    for (const auto& a : site.axes) {
        const bool fits = point.size() > a.name.size() + 1 && point.starts_with(a.name) &&
                          std::string_view("./:").find(point[a.name.size()]) != std::string_view::npos;
        if (fits && (!best || a.name.size() > best->name.size())) best = &a;
    }
    if (!best) return;
    axis = best->name;
    point.erase(0, axis.size() + 1);
    for (const std::string_view prefix : {"parameters/", "parameters."}) {
        if (point.starts_with(prefix)) point.erase(0, prefix.size());
    }
}

std::shared_ptr<const Catalogue> catalogue_of_axis(const Site& site, const Families& families, std::string_view axis) {
    const AxisSpec* a = site.axis(axis);
    const DriveSpec* d = a ? site.drive(a->drive) : nullptr;
    return d ? catalogue_of(site, *d, families) : nullptr;
}

/// The properties of a mapping's point. If the point does not exist, they permit the remaining checks of the entry.
struct PointTraits {
    bool writable = false, readable = true, is_text = false, is_bit = false;
};

PointTraits read_point(Entry& f, Mapping& m, const Site& site, const Families& families) {
    m.axis = f.text("axis", 64, false);
    m.point = f.text("point", 128, true);
    split_axis(m.axis, m.point, site);
    if (m.axis.empty()) {
        f.fault("axis", "axis is missing", "write \"axis\": \"NAME\" of an axis of the site");
        return {};
    }
    if (!site.axis(m.axis)) {
        f.fault("axis", fmt::format("there is no axis {}", m.axis), "use the name of an axis of the site");
        return {};
    }
    if (m.point.empty()) return {};
    if (const auto p = axis_point_named(m.point)) {
        m.what = *p;
        return {.writable = writable(*p), .is_bit = info_of(*p).type == ValueType::boolean};
    }
    const auto catalogue = catalogue_of_axis(site, families, m.axis);
    if (const auto found = catalogue ? catalogue->find(m.point) : std::nullopt) {
        m.what = *found;
        const Parameter& parameter = *catalogue->parameter(*found);
        return {.writable = parameter.writable(),
                .readable = parameter.readable(),
                .is_text = parameter.type == ValueType::text || parameter.type == ValueType::bytes,
                .is_bit = parameter.type == ValueType::boolean};
    }
    f.fault("point", fmt::format("axis {} has no point {}", m.axis, m.point),
            "use a name of the register map such as position, or the id of a parameter of its drive");
    return {};
}

void read_type(Entry& f, Mapping& m, const PointTraits& point) {
    const MapType usual = is_bits(m.table) || point.is_bit ? MapType::boolean : point.is_text ? MapType::string : MapType::i32;
    m.type = f.word("type", type_names, type_long_names).value_or(usual);
    if (is_bits(m.table) && m.type != MapType::boolean)
        f.fault("type", fmt::format("{} hold type bool alone, not {}", name_of(m.table), name_of(m.type)),
                "use bool, or a table of registers");
    if (point.is_text != (m.type == MapType::string) && !m.point.empty() && f.good())
        f.fault("type", fmt::format("{} is {}", m.point, point.is_text ? "a text: its type is string" : "no text: its type is not string"),
                "choose the type that fits");
    m.length = static_cast<std::uint16_t>(f.whole("length", 1, 64, 16).value_or(16));
}

void read_access(Entry& f, Mapping& m, const PointTraits& point) {
    const bool may_write = m.table == MapTable::coils || m.table == MapTable::holding_registers;
    const auto access = f.word("access", access_names, access_long_names);
    if (!access) {
        m.access = !point.readable ? MapAccess::write : point.writable && may_write ? MapAccess::read_write : MapAccess::read;
        return;
    }
    m.access = *access;
    if (m.access != MapAccess::read && !may_write) {
        f.fault("access", fmt::format("{} can only be read", name_of(m.table)), "use R, or coils or holding_registers");
    } else if (m.access != MapAccess::read && !point.writable && f.good()) {
        f.fault("access", fmt::format("{} of axis {} can only be read", m.point, m.axis), "use R");
    } else if (m.access != MapAccess::write && !point.readable && f.good()) {
        f.fault("access", fmt::format("{} of axis {} can only be written", m.point, m.axis), "use W");
    }
}

Mapping read_entry(Entry& f, Ids& ids, const Site& site, const Families& families) {
    f.no_unknown_members();
    Mapping m;
    m.id = ids.read(f);
    m.unit = static_cast<std::uint8_t>(f.whole("unit", 2, 254, std::nullopt).value_or(2));
    m.address = static_cast<std::uint16_t>(f.whole("address", 0, 65535, std::nullopt).value_or(0));
    m.table = f.word("table", table_names, table_short_names).value_or(MapTable::holding_registers);
    m.word_order = f.word("word_order", order_names).value_or(MapWordOrder::high_first);
    m.scale = f.number("scale", 1);
    if (m.scale == 0) f.fault("scale", "scale must not be 0", "leave it out for 1");
    m.offset = f.number("offset", 0);
    m.comment = f.text("comment", 256, false);
    m.on_overflow = f.word("on_overflow", overflow_names).value_or(MapOverflow::mark);
    const PointTraits point = read_point(f, m, site, families);
    read_type(f, m, point);
    read_access(f, m, point);
    if (m.end() > 65536)
        f.fault("address", fmt::format("{} registers from {} go beyond 65535", m.size(), m.address),
                fmt::format("use an address up to {}", 65536 - m.size()));
    return m;
}

using Called = std::function<std::string(std::size_t index)>;

void check_conflicts(const std::vector<Mapping>& all, const std::vector<std::size_t>& index_of, const Called& called,
                     std::vector<SiteFault>& faults) {
    std::map<std::pair<std::uint8_t, MapTable>, std::vector<std::size_t>> by_place;
    for (std::size_t i = 0; i < all.size(); ++i)
        by_place[{all[i].unit, all[i].table}].push_back(i);
    for (auto& [place, list] : by_place) {
        std::ranges::sort(list, [&](std::size_t a, std::size_t b) { return std::pair(all[a].address, a) < std::pair(all[b].address, b); });
        std::size_t farthest = list.front();
        for (std::size_t k = 1; k < list.size(); ++k) {
            const Mapping& before = all[farthest];
            const Mapping& here = all[list[k]];
            if (before.end() > here.address) {
                const std::size_t later = std::max(farthest, list[k]), earlier = std::min(farthest, list[k]);
                const std::string other = called ? called(index_of[earlier]) : std::string();
                faults.push_back({fmt::format("/mappings/{}/address", index_of[later]),
                                  fmt::format("unit {} {} {}..{} is taken by {} ({} of axis {})", here.unit, name_of(here.table),
                                              std::max<std::uint32_t>(before.address, here.address), std::min(before.end(), here.end()) - 1,
                                              other.empty() ? "mapping " + all[earlier].id : other, all[earlier].point, all[earlier].axis),
                                  other.empty() ? "choose another address, or remove that mapping"
                                                : "choose another address, or take one of the two rows out",
                                  true});
            }
            if (here.end() > before.end()) farthest = list[k];
        }
    }
}

}  // namespace

const std::vector<Mapping>& Site::map() const noexcept {
    static const std::vector<Mapping> none;
    return mappings ? *mappings : none;
}

std::string_view name_of(MapTable t) noexcept { return name_in(table_names, t); }
std::string_view name_of(MapType t) noexcept { return name_in(type_names, t); }
std::string_view name_of(MapAccess a) noexcept { return name_in(access_names, a); }
std::string_view name_of(MapWordOrder o) noexcept { return name_in(order_names, o); }
std::string_view name_of(MapOverflow o) noexcept { return name_in(overflow_names, o); }

std::uint16_t Mapping::size() const noexcept {
    if (is_bits(table)) return 1;
    switch (type) {
        case MapType::boolean:
        case MapType::u16:
        case MapType::i16:
            return 1;
        case MapType::u32:
        case MapType::i32:
        case MapType::f32:
            return 2;
        case MapType::u64:
        case MapType::i64:
        case MapType::f64:
            return 4;
        case MapType::string:
            return length;
    }
    return 1;
}

std::optional<std::vector<Mapping>> parse_mappings(const json::array& entries, const Site& site, const Families& families,
                                                   std::vector<SiteFault>& faults,
                                                   const std::function<std::string(std::size_t index)>& called) {
    const std::size_t before = faults.size();
    if (entries.size() > most_mappings) {
        faults.push_back({"/mappings", fmt::format("{} mappings are too many", entries.size()), fmt::format("at most {}", most_mappings)});
        return std::nullopt;
    }
    Ids ids(entries);
    std::vector<Mapping> out;
    std::vector<std::size_t> index_of;  // index in `entries` of each valid one
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const auto* o = entries[i].if_object();
        if (!o) {
            faults.push_back({fmt::format("/mappings/{}", i), "a mapping is an object",
                              "write {\"unit\": 2, \"address\": 0, \"axis\": ..., \"point\": ...}"});
            continue;
        }
        Entry f(*o, i, faults);
        Mapping m = read_entry(f, ids, site, families);
        if (!f.good()) continue;
        out.push_back(std::move(m));
        index_of.push_back(i);
    }
    if (!out.empty()) check_conflicts(out, index_of, called, faults);
    if (faults.size() != before) return std::nullopt;
    return out;
}

json::object to_json(const Mapping& m) {
    json::object o{{"id", m.id},
                   {"unit", std::int64_t{m.unit}},
                   {"table", name_of(m.table)},
                   {"address", std::int64_t{m.address}},
                   {"axis", m.axis},
                   {"point", m.point},
                   {"type", name_of(m.type)},
                   {"word_order", name_of(m.word_order)},
                   {"scale", m.scale},
                   {"offset", m.offset},
                   {"access", name_of(m.access)}};
    if (m.type == MapType::string) o["length"] = std::int64_t{m.length};
    if (m.on_overflow != MapOverflow::mark) o["on_overflow"] = name_of(m.on_overflow);
    if (!m.comment.empty()) o["comment"] = m.comment;
    return o;
}

json::array to_json(std::span<const Mapping> mappings) {
    json::array list;
    list.reserve(mappings.size());
    for (const auto& m : mappings)
        list.push_back(to_json(m));
    return list;
}

}  // namespace axisgate
