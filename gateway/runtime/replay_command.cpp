// `axisgate replay FILE` plays a recording again with this program, in virtual time, and prints a summary and each difference; exit code 0
// if there is none. No line is opened, and a file that is truncated, altered or of another version is refused.
#include <fmt/core.h>

#include <boost/json/parse.hpp>
#include <cstdio>

#include "gateway/engine/replay.hpp"
#include "gateway/runtime/catalogues.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/commands.hpp"
#include "gateway/runtime/files.hpp"
#include "gateway/services/recorder/axr.hpp"

namespace axisgate {

int command_replay(const std::string& file) {
    std::string fault;
    const auto bytes = read_file(file, fault, most_axr_bytes);
    if (!bytes) {
        complain(fault);
        return exit_failed;
    }
    const Axr axr = read_axr(*bytes);
    if (!axr.fault.empty()) {
        complain(fmt::format("{}: {}", file, axr.fault));
        return exit_failed;
    }
    const auto text = axr.section(axr_meta);
    boost::system::error_code ec;
    const auto meta = boost::json::parse({text.data(), text.size()}, ec);
    const auto* o = ec ? nullptr : meta.if_object();
    const auto word = [&](std::string_view key) {
        const auto* v = o ? o->if_contains(key) : nullptr;
        return v && v->is_string() ? std::string(v->get_string()) : std::string();
    };
    if (!axr.has(axr_inputs)) {
        const std::string why = word("not_replayable");
        complain(fmt::format("{}: it can be read and drawn, not replayed: {}", file, why.empty() ? "it has no inputs" : why));
        return exit_failed;
    }
    const auto* before = o ? o->if_contains("outcomes_before") : nullptr;
    std::vector<std::string> faults;
    const Families families = load_families(faults);
    for (const auto& f : faults)
        complain(f);
    if (!faults.empty()) return exit_failed;
    const Instant began = monotonic_now();
    const auto report = replay(families, {axr.section(axr_inputs), axr.section(axr_records),
                                          before && before->is_number() ? before->to_number<std::uint64_t>(ec) : 0});
    const double took = std::max(1e-9, std::chrono::duration<double>(monotonic_now() - began).count());
    const double span = std::chrono::duration<double>(report.span).count();
    for (const auto& d : report.listed)
        fmt::print("recorded: {}\nreplayed: {}\n", d.recorded.empty() ? "-" : d.recorded, d.replayed.empty() ? "-" : d.replayed);
    if (report.differences > report.listed.size()) fmt::print("... and {} more\n", report.differences - report.listed.size());
    fmt::print("{} inputs, {} outcomes compared, {} differences; {:.1f} s played in {:.2f} s, {:.0f} times real time\n", report.inputs,
               report.compared, report.differences, span, took, span / took);
    if (const std::string by = word("version"); by != AXISGATE_VERSION)
        fmt::print("recorded by axisgate {}, replayed by {}\n", by, AXISGATE_VERSION);
    if (!report.fault.empty()) {
        complain(fmt::format("{}: {}", file, report.fault));
        return exit_failed;
    }
    return report.differences == 0 ? exit_good : exit_failed;
}

}  // namespace axisgate
