// Handlers of parameters as a table: the history of one, all as CSV, and a table written back.
// In: calls. Out: rows; an import is checked as a whole first, and nothing is written if one row is wrong.
// Never guesses a value: a row that cannot be read is a fault with its line.
#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "gateway/core/csv.hpp"
#include "gateway/core/parameter_form.hpp"
#include "gateway/doors/http/parameter_jobs.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/services/parameters/axis_jobs.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
constexpr std::uint16_t most_listed_elements = 256;
constexpr std::size_t most_kept_faults = 1000;  // of one file; the first of them are told
}  // namespace

Handled get_parameter_history(Call& c, const ParameterPort& parameters, const SitePort& sites) {
    const auto axis = find_axis(sites, c.names[0]);
    if (!axis) return nothing_named("axis", c.names[0]);
    const auto point = axis->catalogue ? axis->catalogue->find(c.names[1]) : std::nullopt;
    if (!point)
        return to_response(Problem{.status = 404,
                                   .reason = "unknown_point",
                                   .detail = fmt::format("a {} has no parameter {}", axis->family, c.names[1]),
                                   .axis = c.names[0]});
    std::optional<Response> fault;
    const auto limit = query_whole(c, "limit", 1, 1000, 100, fault);
    if (fault) return *fault;
    json::array out;
    for (const auto& h : parameters.history(c.names[0], axis->catalogue->id_of(*point), static_cast<std::size_t>(limit)))
        out.push_back(json::object{{"at", format_time(h.at_unix_ns)},
                                   {"who", text_or_null(h.who)},
                                   {"door", text_or_null(h.door)},
                                   {"old", to_json(h.previous)},
                                   {"new", to_json(h.value)}});
    return json_response(out);
}

Handled get_parameters_csv(Call& c, const ParameterPort& parameters, const SitePort& sites) {
    const auto axis = find_axis(sites, c.names[0]);
    if (!axis) return nothing_named("axis", c.names[0]);
    std::string text = "parameter,name,group,access,unit,value,source\r\n";
    std::map<std::string, Value> stored;
    for (const auto& s : parameters.stored(c.names[0]))
        stored[s.parameter] = s.value;
    const auto all = axis->catalogue ? axis->catalogue->parameters() : std::span<const Parameter>();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Parameter& p = all[i];
        if (p.count > most_listed_elements) continue;
        const std::uint32_t first = p.count == 0 ? 0 : p.first, end = p.count == 0 ? 1 : std::uint32_t{p.first} + p.count;
        for (std::uint32_t e = first; e < end; ++e) {
            const Point point{static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(e)};
            const std::string id = axis->catalogue->id_of(point);
            const auto live = parameters.live(axis->id(), point);
            const auto it = stored.find(id);
            const Value value = known(live.value) ? live.value : it == stored.end() ? Value{} : it->second;
            text += fmt::format("{},{},{},{},{},{},{}\r\n", csv_cell(id), csv_cell(p.name), csv_cell(p.group), name_of(p.access),
                                csv_cell(p.unit), known(value) ? csv_cell(to_text(value)) : std::string(),
                                known(live.value)    ? "drive"
                                : it == stored.end() ? ""
                                                     : "stored");
        }
    }
    Response r;
    r.headers.set("Content-Type", "text/csv; charset=utf-8");
    r.headers.set("Content-Disposition", "attachment; filename=\"parameters.csv\"");
    r.body = std::move(text);
    return r;
}

Handled put_parameters_csv(Call& c, AxisPort& axes, const ParameterPort& parameters, const SitePort& sites) {
    const auto axis = find_axis(sites, c.names[0]);
    if (!axis) return nothing_named("axis", c.names[0]);
    std::optional<Response> fault;
    const bool dry_run = query_flag(c, "dry_run", fault);
    WriteBack include;
    include.addressing = query_flag(c, "include_addressing", fault);
    include.live = query_flag(c, "include_live", fault);
    if (fault) return *fault;
    std::vector<Fault> faults;
    const auto wrong = [&](std::size_t line, std::string text) {
        if (faults.size() < most_kept_faults)
            faults.push_back({fmt::format("/{}", line), std::move(text), "mend the line: nothing has been taken from the file"});
    };
    if (!is_utf8(c.request.body)) return problem(400, "bad_request", "the table is not UTF-8");
    CsvReader reader(c.request.body);
    std::vector<CsvLine> rows;
    while (auto line = reader.next())
        rows.push_back(std::move(*line));
    if (reader.fault()) wrong(reader.fault()->line, reader.fault()->text);
    std::size_t id_column = SIZE_MAX, value_column = SIZE_MAX;
    if (!rows.empty()) {
        for (std::size_t i = 0; i < rows[0].cells.size(); ++i) {
            const auto name = lower(trimmed(rows[0].cells[i]));
            if (name == "parameter") id_column = i;
            if (name == "value") value_column = i;
        }
    }
    if (id_column == SIZE_MAX || value_column == SIZE_MAX) {
        wrong(1, "the first line must name the columns, parameter and value among them");
        return invalid(std::move(faults), c.names[0]);
    }
    std::map<std::string, Value> stored;
    for (const auto& s : parameters.stored(c.names[0]))
        stored[s.parameter] = s.value;
    std::map<std::string, Value> given;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const auto& cells = rows[i].cells;
        const auto point = axis->catalogue && cells.size() > std::max(id_column, value_column)
                               ? axis->catalogue->find(trimmed(cells[id_column]))
                               : std::nullopt;
        const auto value = point ? parse_value(trimmed(cells[value_column]), axis->catalogue->parameter(*point)->type) : std::nullopt;
        if (value) given[axis->catalogue->id_of(*point)] = *value;
    }
    std::set<std::string> seen;
    json::array changes, skipped;
    std::vector<JobPoint> points;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const auto& [line, cells] = rows[i];
        if (cells.size() <= std::max(id_column, value_column)) {
            wrong(line, "the line has too few columns");
            continue;
        }
        const std::string named(trimmed(cells[id_column])), text(trimmed(cells[value_column]));
        const auto point = axis->catalogue ? axis->catalogue->find(named) : std::nullopt;
        if (!point) {
            wrong(line, fmt::format("a {} has no parameter {}", axis->family, named));
            continue;
        }
        const Parameter& p = *axis->catalogue->parameter(*point);
        const std::string id = axis->catalogue->id_of(*point);
        const auto skip = [&](std::string_view why) { skipped.push_back(json::object{{"parameter", id}, {"why", why}}); };
        if (!seen.insert(id).second) {
            wrong(line, fmt::format("{} is there twice", id));
            continue;
        }
        if (text.empty()) {
            skip("no value is given");
            continue;
        }
        if (!p.writable()) {
            skip("can only be read");
            continue;
        }
        const auto value = parse_value(text, p.type);
        if (!value) {
            wrong(line, fmt::format("{}: {} is no {}", id, text, name_of(p.type)));
            continue;
        }
        // What the table itself gives another parameter counts before what that has now: it will have been written.
        auto checked = check_write_now(*axis->catalogue, *point, *value, [&](Point other) {
            const auto it = given.find(axis->catalogue->id_of(other));
            return it == given.end() ? parameters.live(axis->id(), other).value : it->second;
        });
        if (!checked.fault.empty()) {
            wrong(line, checked.fault);
            continue;
        }
        const auto live = parameters.live(axis->id(), *point);
        const auto it = stored.find(id);
        const Value now = known(live.value) ? live.value : it == stored.end() ? Value{} : it->second;
        if (now == checked.value) {
            skip("has this value already");
            continue;
        }
        if (const auto why = why_left_out(p, include); !why.empty()) {
            skip(why);
            continue;
        }
        changes.push_back(json::object{{"parameter", id}, {"from", to_json(now)}, {"to", to_json(checked.value)}});
        points.push_back({id, *point, std::move(checked.value)});
    }
    if (points.size() > most_points) wrong(1, fmt::format("at most {} parameters at a time", most_points));
    if (!faults.empty()) return invalid(std::move(faults), c.names[0]);
    if (dry_run) return json_response(json::object{{"dry_run", true}, {"changes", std::move(changes)}, {"skipped", std::move(skipped)}});
    return write_parameters(c, axes, *axis, std::move(points), {{"skipped", std::move(skipped)}});
}

}  // namespace axisgate::http
