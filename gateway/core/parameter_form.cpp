// Forms are read from the catalogue's document at each request, because writes and lists are rare compared with polls. A wrong member is a
// fault at the start (check_forms) and ignored here.
#include "gateway/core/parameter_form.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

namespace axisgate {
namespace {
namespace json = boost::json;

std::optional<std::int64_t> whole(std::string_view text) {
    std::int64_t n = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), n);
    return fault == std::errc{} && end == text.data() + text.size() ? std::optional(n) : std::nullopt;
}

std::string text_of(const json::object& o, std::string_view key) {
    const auto* v = o.if_contains(key);
    return v && v->is_string() ? std::string(v->get_string()) : std::string();
}

std::optional<double> number_of(const json::object& o, std::string_view key) {
    const auto* v = o.if_contains(key);
    return v && v->is_int64() ? std::optional(static_cast<double>(v->get_int64())) : std::nullopt;
}

/// {"0": "low"}, or the name of a list of the document whose entries have `code` and `title`.
std::vector<std::pair<std::int64_t, std::string>> allowed_of(const json::object& document, const json::object& field) {
    std::vector<std::pair<std::int64_t, std::string>> out;
    if (const auto* own = field.if_contains("allowed"); own && own->is_object()) {
        for (const auto& [k, meaning] : own->get_object()) {
            if (const auto n = whole(k); n && meaning.is_string()) out.emplace_back(*n, std::string(meaning.get_string()));
        }
    }
    const auto* list = document.if_contains(text_of(field, "values"));
    if (list && list->is_array()) {
        for (const auto& v : list->get_array()) {
            const auto* o = v.if_object();
            const auto* code = o ? o->if_contains("code") : nullptr;
            if (code && code->is_int64()) out.emplace_back(code->get_int64(), text_of(*o, "title"));
        }
    }
    return out;
}

/// "7" or "14..8", the highest first.
bool read_bits(std::string_view text, ParameterField& f) {
    const auto dots = text.find("..");
    const auto high = whole(text.substr(0, dots));
    const auto low = dots == std::string_view::npos ? high : whole(text.substr(dots + 2));
    if (!high || !low || *low < 0 || *high < *low || *high > 31) return false;
    f.low_bit = static_cast<unsigned>(*low);
    f.bits = static_cast<unsigned>(*high - *low + 1);
    return true;
}

/// "0" or "1..60000".
bool read_range(std::string_view text, ParameterMeaning& m) {
    const auto dots = text.find("..");
    const auto from = whole(text.substr(0, dots));
    const auto through = dots == std::string_view::npos ? from : whole(text.substr(dots + 2));
    if (!from || !through || *through < *from) return false;
    m.from = *from;
    m.through = *through;
    return true;
}

std::string listed(const std::vector<std::pair<std::int64_t, std::string>>& allowed) {
    std::string s;
    for (const auto& [n, meaning] : allowed)
        s += fmt::format("{}{}{}", s.empty() ? "" : ", ", n, meaning.empty() ? "" : " (" + meaning + ")");
    return s;
}

/// `when` is "ID=VALUE", or "write".
std::optional<ParameterAlternate> read_alternate(const Catalogue& catalogue, const json::object& o) {
    ParameterAlternate a;
    const std::string when = text_of(o, "when");
    const auto min = number_of(o, "min"), max = number_of(o, "max");
    if (!min || !max || *min > *max) return std::nullopt;
    a.unit = text_of(o, "unit");
    a.min = *min;
    a.max = *max;
    if (when == "write") return a;
    const auto equals = when.rfind('=');
    if (equals == std::string::npos) return std::nullopt;
    a.of = catalogue.find(when.substr(0, equals));
    const auto value = whole(std::string_view(when).substr(equals + 1));
    if (!a.of || !value) return std::nullopt;
    a.equals = *value;
    return a;
}
}  // namespace

const json::object* entry_of(const Catalogue& catalogue, Point point) {
    const auto* list = catalogue.document().if_contains("parameters");
    if (!list || !list->is_array() || point.parameter >= list->get_array().size()) return nullptr;
    return list->get_array()[point.parameter].if_object();
}

std::vector<ParameterField> fields_of(const Catalogue& catalogue, Point point) {
    std::vector<ParameterField> out;
    const auto* entry = entry_of(catalogue, point);
    const auto* list = entry ? entry->if_contains("fields") : nullptr;
    if (!list || !list->is_array()) return out;
    for (const auto& v : list->get_array()) {
        const auto* o = v.if_object();
        ParameterField f;
        if (!o || !read_bits(text_of(*o, "bits"), f)) continue;
        f.name = text_of(*o, "name");
        f.allowed = allowed_of(catalogue.document(), *o);
        out.push_back(std::move(f));
    }
    return out;
}

std::vector<ParameterMeaning> meanings_of(const Catalogue& catalogue, Point point) {
    std::vector<ParameterMeaning> out;
    const auto* entry = entry_of(catalogue, point);
    const auto* list = entry ? entry->if_contains("meanings") : nullptr;
    if (!list || !list->is_object()) return out;
    for (const auto& [range, text] : list->get_object()) {
        ParameterMeaning m;
        if (!text.is_string() || !read_range(range, m)) continue;
        m.text = std::string(text.get_string());
        out.push_back(std::move(m));
    }
    return out;
}

std::optional<ParameterAlternate> alternate_of(const Catalogue& catalogue, Point point) {
    const auto* entry = entry_of(catalogue, point);
    const auto* o = entry ? entry->if_contains("alternate") : nullptr;
    return o && o->is_object() ? read_alternate(catalogue, o->get_object()) : std::nullopt;
}

bool in_force(const ParameterAlternate& a, const KnownValue& known_value, bool writing) {
    if (!a.of) return writing;
    return known_value && as_integer(known_value(*a.of)) == a.equals;
}

ParameterForm form_now(const Catalogue& catalogue, Point point, const KnownValue& known_value) {
    const Parameter* p = catalogue.parameter(point);
    if (!p) return {};
    const auto a = alternate_of(catalogue, point);
    if (a && in_force(*a, known_value, false)) return {a->unit, a->min, a->max};
    return {p->unit, p->min, p->max};
}

std::string value_in_words(const Catalogue& catalogue, Point point, const Value& value) {
    const Parameter* p = catalogue.parameter(point);
    const auto n = as_integer(value);
    if (!p || !n) return {};
    const auto named = [](const auto& allowed, std::int64_t v) {
        const auto it = std::ranges::find(allowed, v, [](const auto& pair) { return pair.first; });
        return it == allowed.end() ? std::string() : it->second;
    };
    if (!p->allowed.empty()) return named(p->allowed, *n);
    for (const auto& m : meanings_of(catalogue, point)) {
        if (*n >= m.from && *n <= m.through) return m.text;
    }
    std::string s;
    for (const auto& f : fields_of(catalogue, point)) {
        const auto v = f.of(*n);
        const auto words = named(f.allowed, v);
        s += fmt::format("{}{}: {}", s.empty() ? "" : "; ", f.name, words.empty() ? std::to_string(v) : words);
    }
    return s;
}

std::string wrong_field(const Catalogue& catalogue, Point point, std::int64_t value) {
    for (const auto& f : fields_of(catalogue, point)) {
        const auto v = f.of(value);
        if (f.allowed.empty() || std::ranges::any_of(f.allowed, [v](const auto& a) { return a.first == v; })) continue;
        return fmt::format("{}: {} (bits {}..{} of {}) is not allowed; allowed: {}", f.name, v, f.low_bit + f.bits - 1, f.low_bit, value,
                           listed(f.allowed));
    }
    return {};
}

Catalogue::Checked check_write_now(const Catalogue& catalogue, Point point, const Value& value, const KnownValue& known_value) {
    auto checked = catalogue.check_write(point, value);
    if (!checked.fault.empty()) return checked;
    const auto a = alternate_of(catalogue, point);
    const auto n = as_number(checked.value);
    if (!a || !n || !in_force(*a, known_value, true) || (*n >= a->min && *n <= a->max)) return checked;
    return {
        {},
        fmt::format("{}: {:.0f} is outside {:.0f}..{:.0f}{}{}{}", catalogue.id_of(point), *n, a->min, a->max, a->unit.empty() ? "" : " ",
                    a->unit, a->of ? fmt::format(", because {} is {}", catalogue.id_of(*a->of), a->equals) : std::string())};
}

void check_forms(const Catalogue& catalogue, std::vector<std::string>& faults) {
    const auto parameters = catalogue.parameters();
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const Parameter& p = parameters[i];
        const Point point{static_cast<std::uint16_t>(i), p.first};
        const auto* entry = entry_of(catalogue, point);
        if (!entry) continue;
        const auto fault = [&](std::string_view member, std::string_view what) {
            faults.push_back(fmt::format("parameters[{}].{}: {}", i, member, what));
        };
        if (const auto* v = entry->if_contains("fields"); v && !v->is_null()) {
            const auto fields = fields_of(catalogue, point);
            if (!v->is_array() || fields.size() != v->get_array().size())
                fault("fields", "write a list of {name, bits: \"7\" or \"14..8\"}");
            std::uint64_t taken = 0;
            for (const auto& f : fields) {
                const std::uint64_t mask = ((std::uint64_t{1} << f.bits) - 1) << f.low_bit;
                if (f.name.empty() || (taken & mask) != 0) fault("fields", "a field has no name, or shares its bits with another");
                taken |= mask;
            }
            for (const auto& one : v->is_array() ? v->get_array() : json::array()) {
                const auto* o = one.if_object();
                if (o && o->contains("values") && allowed_of(catalogue.document(), *o).empty())
                    fault("fields", "values names no list of the catalogue");
            }
        }
        if (const auto* v = entry->if_contains("meanings"); v && !v->is_null()) {
            if (!v->is_object() || meanings_of(catalogue, point).size() != v->get_object().size())
                fault("meanings", "write {\"0\": \"text\", \"1..9\": \"text\"}");
        }
        if (const auto* v = entry->if_contains("alternate"); v && !v->is_null()) {
            const auto a = alternate_of(catalogue, point);
            if (!a) fault("alternate", "write {when: \"ID=VALUE\" or \"write\", unit, min, max} with a parameter that exists");
            if (a && ((p.min && a->min < *p.min) || (p.max && a->max > *p.max))) fault("alternate", "its range must lie within min..max");
        }
    }
}

}  // namespace axisgate
