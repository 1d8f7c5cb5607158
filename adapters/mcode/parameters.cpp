// Parameters: one word, one value: PR asks for it, `word=value` sets it, and what was set is read back.
// In: points of the catalogue, texts of the drive. Out: steps, values.
// Never takes the drive's word for a value of another type.
#include "adapters/mcode/parameters.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "adapters/mcode/drive.hpp"
#include "adapters/mcode/parameters_variables.hpp"
#include "gateway/core/text.hpp"

namespace axisgate::mcode {

namespace {
std::string_view form_of(const Parameter& p) {
    const auto* f = p.wire.if_contains("form");
    return f && f->is_string() ? std::string_view(f->get_string()) : std::string_view("value");
}

std::optional<Value> value_of(const Parameter& p, std::string_view text) {
    const auto first = text.find_first_not_of(' ');
    text.remove_prefix(std::min(first, text.size()));
    text = text.substr(0, text.find_last_not_of(" \r\n") + 1);
    if (p.type == ValueType::text || p.type == ValueType::bytes) return Value{std::string(text)};
    const auto v = parse_number(text);
    if (!v) return std::nullopt;
    if (p.type == ValueType::boolean) return Value{*v != 0};
    if (p.type == ValueType::f32 || p.type == ValueType::f64) return Value{*v};
    return Value{static_cast<std::int64_t>(std::llround(*v))};
}

/// "\nOS=1,2,0\n": rows of the drive without blanks.
std::string bare_rows(std::string_view rows) {
    std::string bare(1, '\n');
    for (const char c : rows)
        if (c != ' ' && c != '\r') bare += c;
    return bare + '\n';
}
}  // namespace

std::string word_of_parameter(const Parameter& p) {
    const auto* w = p.wire.if_contains("word");
    return w && w->is_string() ? std::string(w->get_string()) : p.id;
}

bool is_link_word(std::string_view w) noexcept { return w == "PY" || w == "DN" || w == "CK" || w == "EM" || w == "ES"; }

const Parameter* Parameters::in_hand() const {
    const CommandBody& b = drive_.jobs.job().command.body;
    const auto* read = std::get_if<ReadParameter>(&b);
    const auto* write = std::get_if<WriteParameter>(&b);
    return read || write ? drive_.catalogue().parameter(read ? read->point : write->point) : nullptr;
}

void Parameters::plan(const Command& c, Turn& t) {
    already_typed_ = false;
    const Parameter* p = in_hand();
    if (!p) return refuse(Reason::unknown_point, "there is no such parameter", t);
    if (const auto* w = std::get_if<WriteParameter>(&c.body)) return write(*p, w->value, t);
    if (!p->readable()) {
        return refuse(Reason::not_supported, fmt::format("{}: the drive tells nothing back about it: it can only be written", p->id), t);
    }
    if (!fits(*p)) {
        return refuse(Reason::not_supported,
                      fmt::format("{}: {} does not have it: asking for it would be an error in the drive", p->id, name()), t);
    }
    job().ask_rows(word_of_parameter(*p));
}

/// A question for a word that the product or the line does not have is error 37: it sets EF, and runs the handler of errors (OE).
bool Parameters::fits(const Parameter& p) const {
    const auto* ethernet = p.wire.if_contains("ethernet");
    if (drive_.bus.ethernet && ethernet && ethernet->is_bool() && !ethernet->get_bool()) return false;
    const std::string_view product = drive_.start.product();
    const auto* products = p.wire.if_contains("products");
    if (product.empty() || !products || !products->is_array()) return true;
    return std::ranges::any_of(products->get_array(), [&](const auto& x) { return x.is_string() && x.get_string() == product; });
}

void Parameters::write(const Parameter& p, const Value& value, Turn& t) {
    const std::string w = word_of_parameter(p);
    if (is_link_word(w)) {
        return refuse(Reason::not_supported, fmt::format("{} belongs to the line: set it with the line's options, or with line.setup", w),
                      t);
    }
    if (form_of(p) == "variables") return write_variables(to_text(value), t);
    const bool quoted = form_of(p) == "text";
    const auto* flag = std::get_if<bool>(&value);
    const std::string text = flag ? (*flag ? "1" : "0") : to_text(value);
    std::string line = quoted ? fmt::format("{}=\"{}\"", w, text) : fmt::format("{}={}", w, text);
    if (auto why = check_line(line); !why.empty()) return refuse(Reason::out_of_range, fmt::format("{}: {}", w, why), t);
    job().send(std::move(line));
    if (p.readable() && !quoted) job().ask_rows(w);
}

void Parameters::write_variables(const std::string& rows, Turn& t) {
    std::istringstream in(rows);
    const Language language(drive_.bus.catalogue);
    std::string fault;
    for (std::string row; std::getline(in, row) && fault.empty();) {
        if (!row.empty() && row.back() == '\r') row.pop_back();
        if (row.find_first_not_of(' ') == std::string::npos) continue;
        if (auto line = variable_line(row, language, fault); !line.empty()) job().send(std::move(line));
    }
    if (fault.empty() && (job().steps.empty() || job().steps.size() > most_variables))
        fault = "write one variable or more, up to 192, each in a line of its own";
    if (!fault.empty()) return refuse(Reason::out_of_range, fault, t);
    job().ask_rows(word_of_parameter(*in_hand()));
}

/// Another point has the type, or this one has it: what is read tells.
bool Parameters::complained(const Step& step, int error, Turn& t) {
    if (error != 6 || !(step.text.starts_with("IS=") || step.text.starts_with("OS="))) return false;
    drive_.errors.clear_last();
    already_typed_ = true;
    drive_.jobs.step_done(t);
    return true;
}

bool Parameters::has_type(const std::string& data) const {
    return bare_rows(data).find(bare_rows(drive_.jobs.job().steps[0].text)) != std::string::npos;
}

void Parameters::answered(const std::string& data, Turn& t) {
    const Parameter* p = in_hand();
    const auto* write = std::get_if<WriteParameter>(&job().command.body);
    if (write && already_typed_ && !has_type(data)) {
        return refuse(Reason::drive_refused,
                      fmt::format("{}: {} was refused with error 6: a point has this type already; give it type {} first", name(),
                                  job().steps[0].text, p->id == "IS" ? 0 : 16),
                      t, 6);
    }
    const auto v = value_of(*p, data);
    if (!v) {
        if (write) return succeed(data, t, Value(write->value));
        return fail(Reason::not_supported, fmt::format("{} answered {} with \"{}\", which is no {}", name(), p->id, data, name_of(p->type)),
                    t);
    }
    const Point point = write ? write->point : std::get<ReadParameter>(job().command.body).point;
    t.out.samples.push_back({drive_.axis(), point, *v, Quality::good, t.now});
    learn(*p, *v, write != nullptr);
    // The gateway has read the code of an error already, and reading clears it in the drive.
    const bool read_before = word_of_parameter(*p) == "ER" && as_integer(*v) == 0 && drive_.errors.last() != 0;
    succeed({}, t, read_before ? Value{std::int64_t{drive_.errors.last()}} : *v);
}

void Parameters::learn(const Parameter& p, const Value& v, bool written) {
    const std::string w = word_of_parameter(p);
    const auto number = p.wire.contains("variable") ? std::nullopt : as_integer(v);
    if (number) feedback().learn_value(w, *number);
    if (number && w == "CE") drive_.words.ce = static_cast<int>(*number);
    if (!written || (w != "MS" && w != "EE" && w != "AS")) return;
    feedback().values_unknown();  // the drive has scaled them [L4293]
    feedback().demand.knows({0, 0, 0, 0, feedback().values.encoder});
}

std::string Parameters::variable_hint() const {
    const Parameter* p = in_hand();
    if (!p || !p->wire.contains("variable")) return {};
    return fmt::format(
        "{0} has no user variable {1} now: declare it (native VA {1}=0, or in its program), or take it out of the drive's option variables",
        name(), word_of_parameter(*p));
}

}  // namespace axisgate::mcode
