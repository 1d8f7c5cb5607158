// `axisgate compare FAMILY RECORDING` plays a recorded line of a real drive to the twin of that drive and prints the differences. No line
// is opened, so nothing is written and nothing moves.
#include <fmt/core.h>

#include <boost/json/serialize.hpp>

#include "gateway/runtime/catalogues.hpp"
#include "gateway/runtime/commands.hpp"
#include "gateway/runtime/compare_input.hpp"
#include "gateway/runtime/compare_report.hpp"
#include "gateway/runtime/files.hpp"
#include "gateway/services/recorder/axr.hpp"

namespace axisgate {

int command_compare(const CompareOptions& o) {
    std::vector<std::string> faults;
    const auto families = load_families(faults);
    for (const auto& f : faults)
        complain(f);
    if (!faults.empty()) return exit_failed;
    std::string fault, state;
    if (o.file.empty()) {
        complain("name a recording, or a line with --line");
        return exit_usage;
    }
    const auto refuse = [&fault] {
        complain(fault);
        return exit_usage;
    };
    const auto bytes = read_file(o.file, fault, most_axr_bytes);
    if (!bytes) return refuse();
    if (!o.state_file.empty()) {
        auto text = read_file(o.state_file, fault);
        if (!text) return refuse();
        state = std::move(*text);
    }
    const auto input = comparison_input(families, o, *bytes, state, fault);
    if (!input) return refuse();
    const Comparison result = compare(*input);
    if (!result.fault.empty()) {
        fault = fmt::format("{}: {}", o.file, result.fault);
        return refuse();
    }
    if (o.json)
        fmt::print("{}\n", boost::json::serialize(comparison_json(*input, result)));
    else
        fmt::print("{}", comparison_text(*input, result));
    return result.differences.empty() && result.changes.empty() ? exit_good : exit_failed;
}

}  // namespace axisgate
