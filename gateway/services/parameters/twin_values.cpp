// Some values change others when they are written (a mode of scaling, the resolution), so what still differs is written again.
#include "gateway/services/parameters/twin_values.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/array.hpp>

#include "gateway/services/axis_place.hpp"
#include "gateway/services/parameters/snapshots.hpp"
#include "gateway/services/recipes/rehearsal_gateway.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
using namespace std::chrono_literals;

constexpr Duration twin_start_limit = 60s, job_limit = std::chrono::hours(2), settle_time = 3s, twin_lease = 30s;
constexpr int most_rounds = 3;

/// The twin, switched on and identified.
class SimulatedDrive {
public:
    SimulatedDrive(const TwinPlace& place, const NonVolatile& memory)
        : name_(place.axis),
          drive_(place.drive().name),
          gateway_(place.families, simulated_site(only_its_drive(place.site, place.axis), place.families), {{{drive_, memory}}, {}},
                   twin_lease) {
        const auto axis = find_axis(gateway_, name_);
        if (!axis || !axis->catalogue) {
            fault_ = fmt::format("there is no axis {}", name_);
            return;
        }
        axis_ = *axis;
        for (const Instant end = gateway_.now() + twin_start_limit; !gateway_.answers(axis_.id()) && gateway_.now() < end;)
            gateway_.step(end);
        if (!gateway_.answers(axis_.id()))
            fault_ = fmt::format("its twin does not answer within {} s: {}",
                                 std::chrono::duration_cast<std::chrono::seconds>(twin_start_limit).count(), gateway_.last_warning());
    }
    [[nodiscard]] const std::string& fault() const noexcept { return fault_; }
    [[nodiscard]] const Catalogue& catalogue() const { return *axis_.catalogue; }
    [[nodiscard]] const NonVolatile& memory() const { return gateway_.twin_memory(drive_); }

    JobEnd run(std::vector<JobPoint> points, bool write) {
        JobEnd end;
        bool over = false;
        (void)AxisJobs::start(jobs_, gateway_, name_, axis_.id(), std::move(points), write, {}, [&](JobEnd e) {
            end = std::move(e);
            over = true;
        });
        for (const Instant limit = gateway_.now() + job_limit; !over && gateway_.now() < limit;)
            gateway_.step(limit);
        if (!over) end.broken_off = "it takes too long";
        return end;
    }
    void act(const std::string& name) {
        Command c;
        c.axis = axis_.id();
        c.body = Action{name, "", {}};
        bool over = false;
        gateway_.submit(std::move(c), [&](const Result&) { over = true; });
        for (const Instant limit = gateway_.now() + twin_start_limit; !over && gateway_.now() < limit;)
            gateway_.step(limit);
    }
    /// Some drives write their memory behind the answer.
    void rest() {
        for (const Instant end = gateway_.now() + settle_time; gateway_.now() < end;)
            gateway_.step(end);
    }

private:
    std::string name_, drive_, fault_;
    RehearsalGateway gateway_;
    AxisPlace axis_;
    std::shared_ptr<AxisJobs> jobs_ = std::make_shared<AxisJobs>();
};

/// The commands of the page with "saves": the drive keeps its present settings.
std::vector<std::string> saving_commands(const Catalogue& catalogue) {
    std::vector<std::string> out;
    const auto* listed = catalogue.document().if_contains("commands");
    if (!listed || !listed->is_array()) return out;
    for (const auto& c : listed->get_array()) {
        const auto* o = c.if_object();
        const auto* saves = o ? o->if_contains("saves") : nullptr;
        const auto* id = o ? o->if_contains("id") : nullptr;
        if (saves && saves->is_bool() && saves->get_bool() && id && id->is_string()) out.emplace_back(id->get_string());
    }
    return out;
}

TwinValues read_values(JobEnd end) {
    TwinValues out;
    for (auto& v : end.values)
        out.values[v.parameter] = std::move(v.value);
    for (auto& f : end.failed)
        out.refused[f.parameter] = std::move(f.reason);
    out.fault = std::move(end.broken_off);
    return out;
}

bool twin_holds(const TwinValues& twin, const SnapshotValue& held) {
    const auto it = twin.values.find(held.parameter);
    return it != twin.values.end() && equal_values(it->second, held.value);
}

/// Why a value is not even tried.
std::string why_not_tried(const Parameter& p) {
    if (!p.writable()) return "it can only be read";
    if (p.addressing) return "the drive is reached by it: the site has its address and the options of its line";
    if (p.live) return "it acts at once and is not kept";
    return {};
}
}  // namespace

const DriveSpec& TwinPlace::drive() const {
    static const DriveSpec none;
    const AxisSpec* a = site.axis(axis);
    const DriveSpec* d = a ? site.drive(a->drive) : nullptr;
    return d ? *d : none;
}

Site only_its_drive(Site site, const std::string& axis) {
    const AxisSpec* a = site.axis(axis);
    const std::string drive = a ? a->drive : "";
    const DriveSpec* d = site.drive(drive);
    const std::string line = d ? d->line : "";
    std::erase_if(site.axes, [&](const AxisSpec& x) { return x.drive != drive; });
    std::erase_if(site.drives, [&](const DriveSpec& x) { return x.name != drive; });
    std::erase_if(site.lines, [&](const LineSpec& x) { return x.name != line; });
    site.mappings.reset();
    site.profiles.clear();
    site.assemblies.clear();
    return site;
}

TwinValues read_twin(const TwinPlace& place, const NonVolatile& memory, const std::vector<JobPoint>& points) {
    SimulatedDrive twin(place, memory);
    TwinValues out;
    out.fault = twin.fault();
    return out.fault.empty() ? read_values(twin.run(points, false)) : out;
}

Adoption adopt(const TwinPlace& place, NonVolatile memory, const std::vector<JobPoint>& points, const std::vector<SnapshotValue>& held) {
    Adoption out;
    out.memory = std::move(memory);
    const TwinValues before = read_twin(place, out.memory, points);
    std::map<std::string, std::string, std::less<>> reasons;
    {
        SimulatedDrive twin(place, out.memory);
        if (!twin.fault().empty()) {
            out.not_adopted.push_back({"", twin.fault()});
            return out;
        }
        TwinValues now = before;
        for (int round = 0; round < most_rounds && now.fault.empty(); ++round) {
            std::vector<JobPoint> writes;
            for (const SnapshotValue& v : held) {
                const auto at = std::ranges::find(points, v.parameter, &JobPoint::id);
                const Parameter* p = at == points.end() ? nullptr : twin.catalogue().parameter(at->point);
                if (!p || twin_holds(now, v)) continue;
                if (auto why = why_not_tried(*p); why.empty())
                    writes.push_back({v.parameter, at->point, v.value});
                else
                    reasons[v.parameter] = std::move(why);
            }
            if (writes.empty()) break;
            const JobEnd end = twin.run(std::move(writes), true);
            for (const auto& f : end.failed)
                reasons[f.parameter] = "its twin refuses it: " + f.reason;
            now = read_values(twin.run(points, false));
        }
        for (const auto& command : saving_commands(twin.catalogue()))
            twin.act(command);
        twin.rest();
        if (!twin.memory().empty()) out.memory = twin.memory();
    }
    // Values that can only be read, such as a serial number, stand in some memories under the name of the parameter, or of the parameter of
    // which it is a field ("SN.serial").
    for (const SnapshotValue& v : held) {
        if (twin_holds(before, v) || !reasons.contains(v.parameter)) continue;
        auto it = out.memory.find(v.parameter);
        if (it == out.memory.end()) it = out.memory.find(v.parameter.substr(0, v.parameter.find('.')));
        if (it != out.memory.end()) it->second = v.value;
    }
    const TwinValues after = read_twin(place, out.memory, points);
    for (const SnapshotValue& v : held) {
        if (twin_holds(after, v)) {
            if (!twin_holds(before, v)) out.adopted.push_back(v.parameter);
            continue;
        }
        const auto why = reasons.find(v.parameter);
        const auto refused = after.refused.find(v.parameter);
        out.not_adopted.push_back({v.parameter, why != reasons.end()             ? why->second
                                                : refused != after.refused.end() ? "its twin does not have it: " + refused->second
                                                                                 : "its twin loses it when its power is off"});
    }
    return out;
}

}  // namespace axisgate
