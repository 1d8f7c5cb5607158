// One row for each parameter that is not too long an array. A row that is read becomes a change, is left out, or is a fault.
#include "gateway/services/parameters/parameter_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <set>

#include "gateway/core/csv.hpp"
#include "gateway/core/parameter_form.hpp"
#include "gateway/core/text.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate {
namespace {
constexpr std::uint16_t most_elements_in_table = 256;
constexpr std::size_t most_faults_of_table = 1000;  // of one file; only the first faults are reported

/// The reading of a table into a plan.
class TableReading {
public:
    TableReading(const ParameterPort& parameters, const AxisPlace& axis, WriteBack include)
        : parameters_(parameters), axis_(axis), include_(include), known_(parameters, axis) {}

    Refusable<ParameterPlan> read(std::string_view csv) {
        if (!is_utf8(csv)) return ServiceRefusal{ServiceRefusal::Why::unreadable, "the table is not UTF-8"};
        CsvReader reader(csv);
        std::vector<CsvLine> rows;
        while (auto line = reader.next())
            rows.push_back(std::move(*line));
        if (reader.fault()) wrong(reader.fault()->line, reader.fault()->text);
        for (std::size_t i = 0; !rows.empty() && i < rows[0].cells.size(); ++i) {
            const auto name = lower(trimmed(rows[0].cells[i]));
            if (name == "parameter") id_column_ = i;
            if (name == "value") value_column_ = i;
        }
        if (id_column_ == SIZE_MAX || value_column_ == SIZE_MAX) {
            wrong(1, "the first line must name the columns, parameter and value among them");
            return faulty(std::move(faults_), axis_.spec().name);
        }
        for (std::size_t i = 1; i < rows.size(); ++i)
            note(rows[i].cells);
        for (std::size_t i = 1; i < rows.size(); ++i)
            take(rows[i]);
        if (plan_.points.size() > most_points) wrong(1, fmt::format("at most {} parameters at a time", most_points));
        if (!faults_.empty()) return faulty(std::move(faults_), axis_.spec().name);
        return std::move(plan_);
    }

private:
    void wrong(std::size_t line, std::string text) {
        if (faults_.size() < most_faults_of_table)
            faults_.push_back({fmt::format("/{}", line), std::move(text), "mend the line: nothing has been taken from the file"});
    }
    [[nodiscard]] std::optional<Point> point_named(std::string_view name) const {
        return axis_.catalogue ? axis_.catalogue->find(name) : std::nullopt;
    }
    [[nodiscard]] bool is_long_enough(const std::vector<std::string>& cells) const {
        return cells.size() > std::max(id_column_, value_column_);
    }
    /// Notes the table's value of a parameter, for the rows of parameters that depend on it.
    void note(const std::vector<std::string>& cells) {
        const auto point = is_long_enough(cells) ? point_named(trimmed(cells[id_column_])) : std::nullopt;
        const auto value = point ? parse_value(trimmed(cells[value_column_]), axis_.catalogue->parameter(*point)->type) : std::nullopt;
        if (value) given_[axis_.catalogue->id_of(*point)] = *value;
    }
    void take(const CsvLine& row) {
        const auto& [line, cells] = row;
        if (!is_long_enough(cells)) return wrong(line, "the line has too few columns");
        const std::string named(trimmed(cells[id_column_])), text(trimmed(cells[value_column_]));
        const auto point = point_named(named);
        if (!point) return wrong(line, fmt::format("a {} has no parameter {}", axis_.family, named));
        const Parameter& p = *axis_.catalogue->parameter(*point);
        const std::string id = axis_.catalogue->id_of(*point);
        const auto skip = [&](std::string why) { plan_.left_out.push_back({id, std::move(why)}); };
        if (!seen_.insert(id).second) return wrong(line, fmt::format("{} is there twice", id));
        if (text.empty()) return skip("no value is given");
        if (!p.writable()) return skip("can only be read");
        const auto value = parse_value(text, p.type);
        if (!value) return wrong(line, fmt::format("{}: {} is no {}", id, text, name_of(p.type)));
        // The table's own value of another parameter counts before its present value, because it will have been written by then.
        auto checked = check_write_now(*axis_.catalogue, *point, *value, [&](Point other) {
            const auto it = given_.find(axis_.catalogue->id_of(other));
            return it == given_.end() ? parameters_.live(axis_.id(), other).value : it->second;
        });
        if (!checked.fault.empty()) return wrong(line, checked.fault);
        Value now = known_.of(id);
        if (now == checked.value) return skip("has this value already");
        if (auto why = why_left_out(p, include_); !why.empty()) return skip(std::move(why));
        plan_.change(id, *point, std::move(now), std::move(checked.value));
    }

    const ParameterPort& parameters_;
    const AxisPlace& axis_;
    const WriteBack include_;
    const KnownParameters known_;
    std::size_t id_column_ = SIZE_MAX, value_column_ = SIZE_MAX;
    std::map<std::string, Value> given_;
    std::set<std::string> seen_;
    std::vector<Fault> faults_;
    ParameterPlan plan_;
};
}  // namespace

std::string parameters_csv(const ParameterPort& parameters, const AxisPlace& axis) {
    std::string text = "parameter,name,group,access,unit,value,source\r\n";
    const KnownParameters known_values(parameters, axis);
    const auto all = axis.catalogue ? axis.catalogue->parameters() : std::span<const Parameter>();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Parameter& p = all[i];
        if (p.count > most_elements_in_table) continue;
        const std::uint32_t first = p.count == 0 ? 0 : p.first, end = p.count == 0 ? 1 : std::uint32_t{p.first} + p.count;
        for (std::uint32_t e = first; e < end; ++e) {
            const std::string id = axis.catalogue->id_of({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(e)});
            const Value live = known_values.live(id);
            const auto it = known_values.stored().find(id);
            const Value value = known(live) || it == known_values.stored().end() ? live : it->second;
            text += fmt::format("{},{},{},{},{},{},{}\r\n", csv_cell(id), csv_cell(p.name), csv_cell(p.group), name_of(p.access),
                                csv_cell(p.unit), known(value) ? csv_cell(to_text(value)) : std::string(),
                                known(live)                         ? "drive"
                                : it == known_values.stored().end() ? ""
                                                                    : "stored");
        }
    }
    return text;
}

Refusable<ParameterPlan> plan_of_csv(std::string_view csv, const ParameterPort& parameters, const AxisPlace& axis, WriteBack include) {
    return TableReading(parameters, axis, include).read(csv);
}

}  // namespace axisgate
