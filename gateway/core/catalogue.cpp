// Reads a family's JSON page and checks values before they are written. All faults are reported together: a missing field is a fault, a
// null means "unknown".
#include "gateway/core/catalogue.hpp"

#include <fmt/core.h>
#include <boost/json/parse.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "gateway/core/json_read.hpp"
#include "gateway/core/parameter_form.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;

constexpr std::array<std::string_view, 6> completion_names{"acknowledged", "target_reached", "standstill",
                                                           "powered",      "online_again",   "reported"};

std::string text_or_empty(const json::object& o, std::string_view key) {
    const auto* v = o.if_contains(key);
    return v && v->is_string() ? std::string(v->get_string()) : std::string();
}

std::optional<double> number(const json::value& v) {
    if (v.is_int64()) return static_cast<double>(v.get_int64());
    if (v.is_uint64()) return static_cast<double>(v.get_uint64());
    if (v.is_double()) return v.get_double();
    return std::nullopt;
}

struct Reader {
    std::vector<std::string>& faults;

    std::string text(const json::object& o, std::string_view key, const std::string& where) {
        const auto* v = o.if_contains(key);
        if (!v || !v->is_string() || v->get_string().empty()) {
            faults.push_back(fmt::format("{}.{}: a text is missing", where, key));
            return {};
        }
        return std::string(v->get_string());
    }

    bool flag(const json::object& o, std::string_view key, const std::string& where) {
        const auto* v = o.if_contains(key);
        if (v && !v->is_bool()) faults.push_back(fmt::format("{}.{}: write true or false", where, key));
        return v && v->is_bool() && v->get_bool();
    }

    Parameter parameter(const json::object& o, const std::string& where) {
        Parameter p;
        p.id = text(o, "id", where);
        p.name = text(o, "name", where);
        p.group = text(o, "group", where);
        p.description = text(o, "description", where);
        p.storage = text_or_empty(o, "storage");
        p.unit = text_or_empty(o, "unit");
        const auto type = value_type_named(text(o, "type", where));
        if (!type) faults.push_back(where + ".type: not a known type (bool u8 i8 u16 i16 i24 u32 i32 i64 f32 f64 text bytes)");
        p.type = type.value_or(ValueType::i32);
        const std::string access = text(o, "access", where);
        if (access != "R" && access != "W" && access != "RW") faults.push_back(where + ".access: write R, W or RW");
        p.access = access == "RW" ? Access::read_write : access == "W" ? Access::write : Access::read;
        if (const auto* v = o.if_contains("min")) p.min = number(*v);
        if (const auto* v = o.if_contains("max")) p.max = number(*v);
        if (p.min && p.max && *p.min > *p.max) faults.push_back(where + ": min is above max");
        if (const auto* v = o.if_contains("default")) p.factory_default = value_of_json(*v);
        if (const auto* v = o.if_contains("allowed"); v && v->is_object()) {
            for (const auto& [k, meaning] : v->get_object()) {
                std::int64_t n = 0;
                const std::string_view key = k;
                if (std::from_chars(key.data(), key.data() + key.size(), n).ec != std::errc{}) {
                    faults.push_back(fmt::format("{}.allowed: {} is not a whole number", where, key));
                } else {
                    p.allowed.emplace_back(n, meaning.is_string() ? std::string(meaning.get_string()) : std::string());
                }
            }
        }
        p.addressing = flag(o, "addressing", where);
        p.live = flag(o, "live", where);
        if (const auto* v = o.if_contains("first"); v && v->is_int64()) p.first = static_cast<std::uint16_t>(v->get_int64());
        if (const auto* v = o.if_contains("count"); v && v->is_int64()) p.count = static_cast<std::uint16_t>(v->get_int64());
        if (const auto* v = o.if_contains("wire"); v && v->is_object()) p.wire = v->get_object();
        return p;
    }

    void arguments(const json::object& o, const std::string& where, std::vector<CommandArgument>& into) {
        const auto* list = o.if_contains("arguments");
        if (!list || list->is_null()) return;
        if (!list->is_array()) return faults.push_back(where + ".arguments: not a list");
        for (const auto& v : list->get_array()) {
            const std::string at = fmt::format("{}.arguments[{}]", where, into.size());
            if (!v.is_object()) return faults.push_back(at + ": not an object");
            const auto& a = v.get_object();
            CommandArgument argument;
            argument.name = text(a, "name", at);
            argument.description = text_or_empty(a, "description");
            argument.unit = text_or_empty(a, "unit");
            const auto type = value_type_named(text(a, "type", at));
            if (!type) faults.push_back(at + ".type: not a known type");
            argument.type = type.value_or(ValueType::i32);
            if (const auto* scale = a.if_contains("scale"); scale && !scale->is_null()) argument.scale = number(*scale).value_or(0);
            if (!(argument.scale > 0)) faults.push_back(at + ".scale: a number above 0 is missing");
            if (const auto* min = a.if_contains("min")) argument.min = number(*min);
            if (const auto* max = a.if_contains("max")) argument.max = number(*max);
            if (argument.min && argument.max && *argument.min > *argument.max) faults.push_back(at + ": min is above max");
            if (const auto* fallback = a.if_contains("default")) argument.fallback = value_of_json(*fallback);
            for (const auto& other : into) {
                if (other.name == argument.name) faults.push_back(fmt::format("{}: {} is there twice", at, argument.name));
            }
            into.push_back(std::move(argument));
        }
    }
};

CatalogueCommand command_of(const json::object& o, std::vector<std::string>& faults) {
    CatalogueCommand command{
        text_or_empty(o, "id"), text_or_empty(o, "name"), text_or_empty(o, "description"), Completion::acknowledged, {}};
    Reader{faults}.arguments(o, "commands: " + command.id, command.arguments);
    if (const auto* ask = o.if_contains("confirm"); ask && !(ask->is_string() && ask->get_string().ends_with('.')))
        faults.push_back(fmt::format("commands: {}: confirm: sentences that say what is lost, or leave it out", command.id));
    if (const std::string word = text_or_empty(o, "completes"); !word.empty()) {
        const auto found = std::ranges::find(completion_names, word);
        if (found == completion_names.end())
            faults.push_back(fmt::format("commands: {}: completes: {} is not known", command.id, word));
        else
            command.completes = static_cast<Completion>(found - completion_names.begin());
    }
    return command;
}

std::optional<ErrorCode> error_of(const json::object& o, std::size_t i, std::vector<std::string>& faults) {
    const auto* code = o.if_contains("code");
    if (!code || !code->is_int64()) {
        faults.push_back(fmt::format("errors[{}].code: a whole number is missing", i));
        return std::nullopt;
    }
    const auto* through = o.if_contains("through");
    if (through && !through->is_null() && !(through->is_int64() && through->get_int64() > code->get_int64())) {
        faults.push_back(fmt::format("errors[{}].through: a whole number above code is missing", i));
        return std::nullopt;
    }
    const bool range = through && through->is_int64();
    return ErrorCode{static_cast<std::int32_t>(code->get_int64()),
                     text_or_empty(o, "kind"),
                     text_or_empty(o, "name"),
                     text_or_empty(o, "text"),
                     text_or_empty(o, "cause"),
                     text_or_empty(o, "remedy"),
                     range ? static_cast<std::int32_t>(through->get_int64()) : 0};
}

std::vector<std::int16_t> modes_of(const json::value& list, std::vector<std::string>& faults) {
    std::vector<std::int16_t> modes;
    for (const auto& v : list.is_array() ? list.get_array() : json::array()) {
        const auto* n = v.if_int64();
        if (n && *n >= -128 && *n <= 127 && *n != 0 && std::ranges::find(modes, *n) == modes.end())
            modes.push_back(static_cast<std::int16_t>(*n));
        else
            faults.push_back("catalogue.modes: modes of operation are whole numbers from -128 to 127 without 0, each once");
    }
    if (modes.empty()) faults.push_back("catalogue.modes: a list of the modes of operation (CiA 402) that the drives offer is missing");
    return modes;
}
}  // namespace

std::optional<Catalogue> Catalogue::parse(std::string_view text, std::vector<std::string>& faults) {
    const std::size_t before = faults.size();
    boost::system::error_code ec;
    auto parsed = json::parse(json::string_view(text.data(), text.size()), ec);
    if (ec || !parsed.is_object()) {
        faults.push_back("the catalogue is not a JSON object" + (ec ? ": " + ec.message() : std::string()));
        return std::nullopt;
    }
    Catalogue c;
    c.document_ = parsed.get_object();
    c.family_ = Reader{faults}.text(c.document_, "family", "catalogue");
    if (const auto* n = c.document_.if_contains("number"); n && n->is_int64()) c.number_ = static_cast<std::uint16_t>(n->get_int64());
    if (c.number_ == 0) faults.push_back("catalogue.number: a family number from 1 on is missing");

    const auto array = [&](std::string_view key) -> const json::array* {
        const auto* v = c.document_.if_contains(key);
        if (!v || !v->is_array()) {
            faults.push_back(fmt::format("catalogue.{}: an array is missing", key));
            return nullptr;
        }
        return &v->get_array();
    };
    if (const auto* list = array("parameters")) {
        for (const auto& entry : *list)
            c.add_parameter(entry, faults);
    }
    if (const auto* list = array("commands")) {
        for (const auto& v : *list) {
            if (v.is_object()) c.commands_.push_back(command_of(v.get_object(), faults));
        }
    }
    if (const auto* list = array("errors")) {
        for (std::size_t i = 0; i < list->size(); ++i) {
            const auto* o = (*list)[i].if_object();
            if (auto error = o ? error_of(*o, i, faults) : std::nullopt) c.errors_.push_back(std::move(*error));
        }
    }
    c.freedoms_ = read_freedoms(c.document_, faults);
    if (const auto* list = c.document_.if_contains("modes")) c.modes_ = modes_of(*list, faults);
    check_forms(c, faults);
    if (faults.size() != before) return std::nullopt;
    return c;
}

void Catalogue::add_parameter(const json::value& entry, std::vector<std::string>& faults) {
    const std::string where = fmt::format("parameters[{}]", parameters_.size());
    if (!entry.is_object()) return faults.push_back(where + ": not an object");
    if (parameters_.size() >= std::size_t{65535}) return faults.push_back(where + ": a catalogue has at most 65535 parameters");
    Parameter p = Reader{faults}.parameter(entry.get_object(), where);
    const auto index = static_cast<std::uint16_t>(parameters_.size());
    for (const std::string& key : {p.id, p.name}) {
        if (const auto [it, fresh] = by_id_.emplace(key, index); !fresh && it->second != index) {
            faults.push_back(fmt::format("{}: {} is there twice", where, key));
        }
    }
    parameters_.push_back(std::move(p));
}

std::optional<Catalogue> Catalogue::with(const json::array& parameters, std::vector<std::string>& faults) const {
    const std::size_t before = faults.size();
    Catalogue c = *this;
    auto& list = c.document_.at("parameters").as_array();
    for (const auto& entry : parameters) {
        c.add_parameter(entry, faults);
        list.push_back(entry);
    }
    if (faults.size() == before) check_forms(c, faults);
    if (faults.size() != before) return std::nullopt;
    return c;
}

int Catalogue::most_channels() const noexcept {
    const auto* c = document_.if_contains("channels");
    const auto* max = c && c->is_object() ? c->get_object().if_contains("max") : nullptr;
    return max && max->is_int64() ? static_cast<int>(max->get_int64()) : 1;
}

bool Catalogue::offers_mode(std::int16_t mode) const noexcept { return std::ranges::find(modes_, mode) != modes_.end(); }

std::string_view name_of(Completion completion) noexcept { return completion_names[static_cast<std::size_t>(completion)]; }

const CatalogueCommand* Catalogue::command(std::string_view id_or_name) const noexcept {
    const auto found =
        std::ranges::find_if(commands_, [&](const CatalogueCommand& c) { return c.id == id_or_name || c.name == id_or_name; });
    return found == commands_.end() ? nullptr : &*found;
}

const Parameter* Catalogue::parameter(Point point) const noexcept {
    if (point.parameter >= parameters_.size()) return nullptr;
    const Parameter& p = parameters_[point.parameter];
    if (p.count == 0) return point.element == 0 ? &p : nullptr;
    return point.element >= p.first && point.element < p.first + p.count ? &p : nullptr;
}

std::optional<Point> Catalogue::find(std::string_view id) const {
    if (const auto it = by_id_.find(std::string(id)); it != by_id_.end() && parameters_[it->second].count == 0) {
        return Point{it->second, 0};
    }
    const auto open = id.rfind('[');
    if (open == std::string_view::npos || !id.ends_with(']')) return std::nullopt;
    const auto it = by_id_.find(std::string(id.substr(0, open)));
    if (it == by_id_.end()) return std::nullopt;
    std::uint16_t element = 0;
    const auto digits = id.substr(open + 1, id.size() - open - 2);
    const auto [end, ec] = std::from_chars(digits.data(), digits.data() + digits.size(), element);
    if (ec != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
    const Point point{it->second, element};
    return parameters_[it->second].count != 0 && parameter(point) ? std::optional(point) : std::nullopt;
}

std::optional<std::uint32_t> Catalogue::selector(Point point) const noexcept {
    const Parameter* p = parameter(point);
    if (!p || p->type == ValueType::text || p->type == ValueType::bytes) return std::nullopt;
    return std::uint32_t{point.element} << 16 | point.parameter;
}

std::string Catalogue::id_of(Point point) const {
    const Parameter* p = parameter(point);
    if (!p) return fmt::format("point {}.{}", point.parameter, point.element);
    return p->count == 0 ? p->id : fmt::format("{}[{}]", p->id, point.element);
}

const ErrorCode* Catalogue::error(std::int32_t code, std::string_view kind) const noexcept {
    for (const auto& e : errors_) {
        const bool meant = e.through == 0 ? e.code == code : e.code <= code && code <= e.through;
        if (meant && (kind.empty() || e.kind == kind)) return &e;
    }
    return nullptr;
}

Catalogue::Checked Catalogue::check_write(Point point, const Value& value) const {
    const Parameter* p = parameter(point);
    if (!p) return {{}, fmt::format("{} does not know this parameter", family_)};
    const std::string id = id_of(point);
    if (!p->writable()) return {{}, fmt::format("{} can only be read", id)};
    const std::string unit = p->unit.empty() ? "" : " " + p->unit;
    if (p->type == ValueType::text || p->type == ValueType::bytes) {
        if (const auto* s = std::get_if<std::string>(&value)) return {*s, {}};
        return {{}, fmt::format("{} takes a text", id)};
    }
    if (p->type == ValueType::f32 || p->type == ValueType::f64) {
        const auto d = as_number(value);
        if (!d || !std::isfinite(*d)) return {{}, fmt::format("{} takes a number, not {}", id, to_text(value))};
        if (p->type == ValueType::f32 && std::fabs(*d) > static_cast<double>(std::numeric_limits<float>::max())) {
            return {{}, fmt::format("{}: {} is more than a number of single precision can be (3.4028235e+38)", id, *d)};
        }
        if ((p->min && *d < *p->min) || (p->max && *d > *p->max)) {
            return {{},
                    fmt::format("{}: {} is outside {}..{}{}", id, *d, p->min ? fmt::format("{}", *p->min) : "",
                                p->max ? fmt::format("{}", *p->max) : "", unit)};
        }
        return {*d, {}};
    }
    const auto i = p->type != ValueType::boolean && std::holds_alternative<bool>(value) ? std::nullopt : as_integer(value);
    if (!i) return {{}, fmt::format("{} takes a whole number, not {}", id, to_text(value))};
    if (!p->allowed.empty()) {
        std::string list;
        for (const auto& [n, meaning] : p->allowed) {
            if (n == *i) return {p->type == ValueType::boolean ? Value{*i != 0} : Value{*i}, {}};
            list += fmt::format("{}{}{}", list.empty() ? "" : ", ", n, meaning.empty() ? "" : " (" + meaning + ")");
        }
        return {{}, fmt::format("{}: {} is not allowed; allowed: {}", id, *i, list)};
    }
    const auto own = range_of(p->type).value_or(IntegerRange{INT64_MIN, INT64_MAX});
    const double low = p->min.value_or(static_cast<double>(own.min));
    const double high = p->max.value_or(static_cast<double>(own.max));
    if (static_cast<double>(*i) < low || static_cast<double>(*i) > high) {
        return {{}, fmt::format("{}: {} is outside {:.0f}..{:.0f}{}", id, *i, low, high, unit)};
    }
    if (const auto wrong = wrong_field(*this, point, *i); !wrong.empty()) return {{}, fmt::format("{}.{}", id, wrong)};
    return {p->type == ValueType::boolean ? Value{*i != 0} : Value{*i}, {}};
}

}  // namespace axisgate
