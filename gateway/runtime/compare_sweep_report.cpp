// The comparison of a drive on a line as text: one line for each value that differs.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/runtime/compare_report.hpp"

namespace axisgate {
namespace {
constexpr std::size_t most_late_listed = 20;

std::string value_text(const Value& v, const std::string& unit) {
    if (!known(v)) return "-";
    return unit.empty() ? to_text(v) : fmt::format("{} {}", to_text(v), unit);
}
double in_milliseconds(Duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

std::string row_text(const ComparedValue& r) {
    std::string out = fmt::format("{:<9} {} ({}): drive {}", name_of(r.kind), r.id, r.name, value_text(r.drive, r.unit));
    if (r.kind == ComparedValue::Kind::changed) out += fmt::format(", then {}", value_text(r.again, r.unit));
    out += fmt::format(", twin {}", value_text(r.twin, r.unit));
    if (!r.text.empty()) out += fmt::format(" ({})", r.text);
    return out + "\n";
}

std::string replies_text(const DriveComparison::Replies& r) {
    if (!r.fault.empty()) return fmt::format("the reply times were not compared: {}\n", r.fault);
    std::string out = fmt::format("the drive replied after {:.1f} to {:.1f} ms, most often {:.1f} ms\n", in_milliseconds(r.shortest),
                                  in_milliseconds(r.longest), in_milliseconds(r.median));
    for (std::size_t i = 0; i < std::min(r.outside.size(), most_late_listed); ++i) {
        const Difference& d = r.outside[i];
        out += fmt::format("{:<9} {:.1f} ms, range {:.1f} to {:.1f} ms: {} -> {}\n", name_of(d.kind), in_milliseconds(d.reply),
                           in_milliseconds(d.least), in_milliseconds(d.most), d.request, d.recorded);
    }
    if (r.outside.size() > most_late_listed) out += fmt::format("... and {} more\n", r.outside.size() - most_late_listed);
    return out;
}

std::string list_text(const char* title, const std::vector<JobFailure>& list) {
    std::string out;
    for (const auto& f : list)
        out += fmt::format("  {}: {}\n", f.parameter.empty() ? "all values" : f.parameter, f.reason);
    return list.empty() ? "" : fmt::format("{}:\n{}", title, out);
}
}  // namespace

std::string sweep_text(const DriveComparison& c, const std::string& adopted_into) {
    std::string out = fmt::format("{} at address {}{}{}, compared with specimen {}\n", c.family, c.address, c.identity.empty() ? "" : ": ",
                                  c.identity, c.specimen);
    for (const ComparedValue& r : c.rows)
        out += row_text(r);
    out += replies_text(c.replies);
    out += list_text("not asked for", c.left_out);
    out += list_text("refused by the drive and by its twin", c.neither);
    if (!adopted_into.empty() && c.fault.empty()) {
        out += fmt::format("{} values of the drive were adopted into {}\n", c.adoption.adopted.size(), adopted_into);
        out += list_text("not adopted", c.adoption.not_adopted);
    }
    return out + fmt::format("{} values read, {} equal, {} differences\n", c.read, c.equal, c.differences());
}

}  // namespace axisgate
