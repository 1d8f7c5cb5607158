// Language: syntax and ranges of the catalogue, cut into forms and fields once at the start.
// In: parameters and commands of the catalogue. Out: words by mnemonic.
// Never guesses: a field whose range the catalogue does not have takes any value.
#include "adapters/mcode/native_language.hpp"

#include <fmt/core.h>

#include <optional>

#include "gateway/core/text.hpp"

namespace axisgate::mcode {
namespace {
namespace json = boost::json;

constexpr double most_whole = 2147483647.0, least_whole = -2147483648.0;

std::string_view text_in(const json::object& o, std::string_view key) {
    const auto* v = o.if_contains(key);
    return v && v->is_string() ? std::string_view(v->get_string()) : std::string_view();
}
std::optional<std::pair<double, double>> pair_in(const json::object* o, std::string_view key) {
    const auto* v = o ? o->if_contains(key) : nullptr;
    if (!v || !v->is_array() || v->get_array().size() != 2) return std::nullopt;
    return std::pair{v->get_array()[0].to_number<double>(), v->get_array()[1].to_number<double>()};
}
const json::object* object_in(const json::object& o, std::string_view key) {
    const auto* v = o.if_contains(key);
    return v && v->is_object() ? &v->get_object() : nullptr;
}
bool usage_has(const json::object& o, std::string_view place) {
    const auto* v = o.if_contains("usage");
    if (!v || !v->is_array()) return false;
    for (const auto& u : v->get_array()) {
        if (u.is_string() && std::string_view(u.get_string()) == place) return true;
    }
    return false;
}

/// What stands between < and >: figures and ranges, or the name of a field, whose range `ranges` may have.
Field field_of(std::string_view inside, const json::object* ranges) {
    Field f;
    if (inside == "label|address") return f.kind = Field::Kind::target, f;
    if (inside == "condition") return f.kind = Field::Kind::condition, f;
    if (inside == "variable") return f.kind = Field::Kind::variable, f;
    if (inside == "name") return f.kind = Field::Kind::name, f;
    if (inside == "item") return f.kind = Field::Kind::item, f;
    if (const auto r = pair_in(ranges, inside)) return f.ranges = {*r}, f;
    for (std::string_view rest = inside; !rest.empty();) {
        const auto end = std::min(rest.find('|'), rest.size());
        const std::string_view part = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        auto dash = part.find("..");
        std::size_t width = 2;
        if (dash == std::string_view::npos) dash = part.find('-', 1), width = 1;
        const auto low = parse_number(part.substr(0, dash));
        const auto high = dash == std::string_view::npos ? low : parse_number(part.substr(dash + width));
        if (!low || !high) return f.ranges.clear(), f;  // a name without a range
        f.ranges.emplace_back(*low, *high);
    }
    return f;
}

/// `MA <position>[,<0|1>[,<0|1>]]`; several forms with ` | ` between them.
std::vector<Form> forms_of(std::string_view syntax, const json::object* ranges) {
    std::vector<Form> forms;
    while (!syntax.empty()) {
        const auto bar = std::min(syntax.find(" | "), syntax.size());
        std::string_view one = syntax.substr(0, bar);
        syntax.remove_prefix(std::min(bar + 3, syntax.size()));
        one.remove_prefix(std::min(one.find_first_of(" =[<"), one.size()));
        Form form;
        bool optional = false;
        for (std::size_t i = 0; i < one.size();) {
            if (one[i] == '[') optional = true;
            const bool digit = (one[i] >= '0' && one[i] <= '9') || one[i] == '-';
            if (one[i] != '<' && !digit) {
                ++i;
                continue;
            }
            const auto end = one[i] == '<' ? one.find('>', i) : std::min(one.find_first_not_of("0123456789", i + 1), one.size());
            const std::size_t from = one[i] == '<' ? i + 1 : i;
            Field f = field_of(one.substr(from, end - from), ranges);
            f.optional = optional;
            if (f.kind != Field::Kind::item || form.empty()) form.push_back(std::move(f));
            i = one[i] == '<' ? end + 1 : end;
        }
        forms.push_back(std::move(form));
    }
    return forms;
}

Word parameter_of(const Parameter& p) {
    Word w;
    w.kind = Word::Kind::parameter;
    w.readable = p.readable();
    w.writable = p.writable();
    w.immediate = usage_has(p.wire, "immediate");
    w.program = usage_has(p.wire, "program");
    w.number = w.readable && p.type != ValueType::text && p.type != ValueType::bytes;
    if (const auto own = text_in(p.wire, "syntax"); !own.empty()) {
        w.syntax = own;
        w.forms = forms_of(own, object_in(p.wire, "ranges"));
        return w;
    }
    Field f;
    if (const auto writes = pair_in(&p.wire, "writes")) {
        f.ranges.push_back(*writes);
    } else if (!p.allowed.empty()) {
        for (const auto& [value, meaning] : p.allowed)
            f.ranges.emplace_back(static_cast<double>(value), static_cast<double>(value));
    } else if (p.min && p.max) {
        f.ranges.emplace_back(*p.min, *p.max);
    } else if (p.type == ValueType::i32) {
        f.ranges.emplace_back(least_whole, most_whole);
    }
    if (p.type == ValueType::text) f.kind = Field::Kind::text;
    w.syntax = fmt::format("{}=<{}>", p.id, p.name);
    w.forms.push_back({std::move(f)});
    return w;
}
}  // namespace

Language::Language(const Catalogue& catalogue) {
    // With EE = 1 some ranges are others: the document has them beside min and max.
    std::map<std::string_view, const json::object*> others;
    if (const auto* list = catalogue.document().if_contains("parameters"); list && list->is_array()) {
        for (const auto& entry : list->get_array()) {
            if (entry.is_object()) others[text_in(entry.get_object(), "id")] = object_in(entry.get_object(), "ranges");
        }
    }
    for (const Parameter& p : catalogue.parameters()) {
        const std::string_view own = text_in(p.wire, "word");
        if (own.find(',') != std::string_view::npos) continue;  // one value of a word that has several
        Word w = parameter_of(p);
        const auto other = pair_in(others[p.id], "ee1");
        if (other && p.allowed.empty() && !w.forms.empty() && w.forms[0].size() == 1) w.forms[0][0].ranges.push_back(*other);
        words_[std::string(own.empty() ? std::string_view(p.id) : own)] = std::move(w);
    }
    const auto* list = catalogue.document().if_contains("commands");
    if (!list || !list->is_array()) return;
    for (const auto& entry : list->get_array()) {
        if (!entry.is_object()) continue;
        const json::object& c = entry.get_object();
        const std::string_view id = text_in(c, "id"), kind = text_in(c, "kind");
        Word w;
        w.immediate = usage_has(c, "immediate");
        w.program = usage_has(c, "program");
        w.syntax = text_in(c, "syntax");
        if (kind == "instruction") {
            w.forms = forms_of(w.syntax, object_in(c, "ranges"));
        } else if (kind == "keyword") {
            w.kind = Word::Kind::keyword;
            w.readable = w.syntax.starts_with("PR ");
        } else if (kind == "reserved") {
            w.kind = Word::Kind::reserved;
        } else if (kind == "operator" && id.size() == 5) {  // op:AB
            w.kind = id == "op:PI" ? Word::Kind::constant : Word::Kind::function;
            w.readable = w.number = id == "op:PI";
            words_.emplace(id.substr(3), std::move(w));
            continue;
        } else {
            continue;
        }
        words_.emplace(id, std::move(w));  // a parameter of that name says more
    }
}

const Word* Language::find(std::string_view mnemonic) const {
    const auto it = words_.find(mnemonic);
    return it == words_.end() ? nullptr : &it->second;
}

}  // namespace axisgate::mcode
