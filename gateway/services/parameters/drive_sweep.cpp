// The second reading begins when the first is complete, so that the two readings of a parameter are as far apart as the sweep is long.
#include "gateway/services/parameters/drive_sweep.hpp"

#include <algorithm>
#include <boost/json/array.hpp>
#include <map>
#include <set>

#include "gateway/services/parameters/snapshots.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
/// Arrays up to this length are read; longer ones (programs, tables) are left out.
constexpr std::uint16_t most_elements_kept = 256;

/// A member of a parameter's entry in the page; null if it is absent.
const json::value* member_of(const Catalogue& catalogue, std::size_t parameter, std::string_view name) {
    const auto* listed = catalogue.document().if_contains("parameters");
    const auto* all = listed ? listed->if_array() : nullptr;
    const auto* entry = all && parameter < all->size() ? (*all)[parameter].if_object() : nullptr;
    return entry ? entry->if_contains(name) : nullptr;
}
}  // namespace

std::vector<JobPoint> readable_points(const Catalogue& catalogue, std::vector<std::string>& left_out) {
    std::vector<JobPoint> out;
    const auto all = catalogue.parameters();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Parameter& p = all[i];
        if (!p.readable()) continue;
        const auto index = static_cast<std::uint16_t>(i);
        const auto* wanted = member_of(catalogue, i, "snapshot");
        const bool kept = !wanted || !wanted->is_bool() || wanted->as_bool();
        if (!kept || p.count > most_elements_kept || out.size() + std::max<std::size_t>(p.count, 1) > most_points) {
            left_out.push_back(p.id);
            continue;
        }
        const std::uint32_t first = p.count == 0 ? 0 : p.first, end = p.count == 0 ? 1 : std::uint32_t{p.first} + p.count;
        for (std::uint32_t e = first; e < end; ++e) {
            const Point point{index, static_cast<std::uint16_t>(e)};
            out.push_back({catalogue.id_of(point), point});
        }
    }
    return out;
}

SweepPlan sweep_plan(const Catalogue& catalogue) {
    SweepPlan plan;
    std::vector<std::string> excluded;
    plan.points = readable_points(catalogue, excluded);
    for (auto& id : excluded)
        plan.left_out.push_back({std::move(id), "it shows the present activity, or is too long"});
    std::erase_if(plan.points, [&](const JobPoint& p) {
        const auto* effect = member_of(catalogue, p.point.parameter, "read_effect");
        if (!effect || !effect->is_string()) return false;
        plan.left_out.push_back({p.id, std::string(effect->get_string())});
        return true;
    });
    const auto all = catalogue.parameters();
    for (const Parameter& p : all)
        if (!p.readable()) plan.left_out.push_back({p.id, "it can only be written"});
    return plan;
}

bool start_sweep(const std::shared_ptr<AxisJobs>& jobs, AxisPort& axes, const std::string& axis, AxisId id,
                 const std::vector<JobPoint>& points, const Origin& origin, std::function<void(Sweep)> then) {
    auto second = [jobs, &axes, axis, id, points, origin, then = std::move(then)](JobEnd first) {
        Sweep sweep;
        sweep.values = std::move(first.values);
        sweep.not_read = std::move(first.failed);
        sweep.broken_off = std::move(first.broken_off);
        if (!sweep.broken_off.empty()) return then(std::move(sweep));
        std::set<std::string, std::less<>> read;
        for (const auto& v : sweep.values)
            read.insert(v.parameter);
        auto again = points;
        std::erase_if(again, [&](const JobPoint& p) { return !read.contains(p.id); });
        auto kept = std::make_shared<Sweep>(std::move(sweep));
        const bool started = AxisJobs::start(jobs, axes, axis, id, std::move(again), false, origin, [kept, then](JobEnd end) {
            std::map<std::string, const Value*, std::less<>> before;
            for (const auto& v : kept->values)
                before.emplace(v.parameter, &v.value);
            for (auto& v : end.values)
                if (const auto it = before.find(v.parameter); it != before.end() && !equal_values(*it->second, v.value))
                    kept->changed.push_back({v.parameter, *it->second, v.value});
            for (auto& f : end.failed)
                kept->changed.push_back({f.parameter, before.contains(f.parameter) ? *before.at(f.parameter) : Value{}, Value{}});
            kept->broken_off = std::move(end.broken_off);
            then(std::move(*kept));
        });
        if (started) return;
        kept->broken_off = "another job has taken the axis between the two readings";
        then(std::move(*kept));
    };
    return AxisJobs::start(jobs, axes, axis, id, points, false, origin, std::move(second));
}

}  // namespace axisgate
