// Names the causes, and shows the data of each axis.
#include "gateway/services/fail_safe/fail_safe_matrix.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "gateway/services/axis_place.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/services/site/site_change.hpp"
#include "gateway/services/site/site_edit.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
/// The default actions, for a motion without an end and for one with an end.
struct ByDefault {
    FailSafeAction endless, to_a_target;
};
ByDefault by_default(LossCause cause) {
    const FailSafe none;
    return {none.action(cause, {.endless = true, .moving = true, .powered = true}),
            none.action(cause, {.endless = false, .moving = true, .powered = true})};
}

json::object choice_of(const FailSafe& chosen) {
    json::object o;
    for (const LossCause cause : loss_causes()) {
        const auto& action = chosen.of(cause);
        o[name_of(cause)] = action ? json::value(name_of(*action)) : json::value(nullptr);
    }
    o["watchdog_ms"] = chosen.watchdog_ms ? json::value(*chosen.watchdog_ms) : json::value(nullptr);
    return o;
}

/// The API's word for the state of a function that the drive carries out by itself; null: unknown.
template <class Kept>
json::value state_of(typename Kept::State state) {
    switch (state) {
        case Kept::State::off:
            return "off";
        case Kept::State::armed:
            return "armed";
        case Kept::State::refused:
            return "refused";
        case Kept::State::unknown:
            break;
    }
    return nullptr;
}

/// A function that the drive carries out by itself: the data of its family's page, and the state of this drive if the family has the
/// function.
struct KeptByDrive {
    bool available = false;
    std::string description;
    std::optional<DriveStatus> status;
};
KeptByDrive kept_by_drive(const MatrixPorts& ports, const SiteState& site, const AxisSpec& spec, std::string_view member) {
    KeptByDrive kept;
    const auto d = index_of_name(site.site.drives, spec.drive);
    const auto page = d ? catalogue_of(site.site, site.site.drives[*d], ports.get<SitePort>().families()) : nullptr;
    const auto* says = page ? page->document().if_contains(member) : nullptr;
    if (!says || !says->is_object()) return kept;
    kept.available = says->get_object().at("available").as_bool();
    kept.description = says->get_object().at("description").as_string();
    if (kept.available && *d < site.drive_ids.size()) kept.status = ports.get<DrivePort>().drive_status(site.drive_ids[*d]);
    return kept;
}

/// The drive's watchdog, as it was programmed.
json::object watchdog_of(const MatrixPorts& ports, const SiteState& site, const AxisSpec& spec) {
    const KeptByDrive kept = kept_by_drive(ports, site, spec, "drive_watchdog");
    const DriveWatchdog w = kept.status ? kept.status->watchdog : DriveWatchdog{};
    const bool armed = w.state == DriveWatchdog::State::armed;
    return {{"available", kept.available},
            {"state", state_of<DriveWatchdog>(w.state)},
            {"time_ms", armed ? json::value(milliseconds_of(w.time)) : json::value(nullptr)},
            {"action", armed ? json::value(w.action) : json::value(nullptr)},
            {"description", kept.description}};
}

/// The site's limits of position, as the drive has acknowledged them.
json::object limits_of(const MatrixPorts& ports, const SiteState& site, const AxisSpec& spec) {
    const KeptByDrive kept = kept_by_drive(ports, site, spec, "drive_limits");
    const bool wanted = spec.position_min || spec.position_max;  // the state belongs to the drive, and another axis of it may be limited
    const DriveLimits limits = kept.status && wanted ? kept.status->limits : DriveLimits{};
    const bool refused = limits.state == DriveLimits::State::refused;
    return {{"available", kept.available},
            {"wanted", wanted},
            {"state", state_of<DriveLimits>(limits.state)},
            {"refusal", refused ? json::value(limits.text) : json::value(nullptr)},
            {"description", kept.description}};
}

/// A list of names, or empty with a fault.
std::optional<std::vector<std::string>> names_listed(std::string_view key, const json::value& v, std::vector<Fault>& faults) {
    if (!v.is_array() || !std::ranges::all_of(v.get_array(), [](const json::value& one) { return one.is_string(); })) {
        faults.push_back({"/" + std::string(key), fmt::format("{} must be a list of names", key), "leave it out for all"});
        return std::nullopt;
    }
    std::vector<std::string> names;
    for (const auto& one : v.get_array())
        names.emplace_back(one.get_string());
    return names;
}

RehearsalSteps steps_in(const json::value& v, std::vector<Fault>& faults) {
    RehearsalSteps steps;
    const auto names = names_listed("steps", v, faults);
    for (std::size_t i = 0; names && i < names->size(); ++i) {
        if (const auto step = rehearsal_step_of((*names)[i])) {
            steps.add(*step);
        } else {
            std::string known;
            for (const RehearsalStep s : rehearsal_steps)
                known += (known.empty() ? "" : ", ") + std::string(name_of(s));
            faults.push_back({fmt::format("/steps/{}", i), fmt::format("{} is no step of a rehearsal", (*names)[i]), "one of " + known});
        }
    }
    return steps;
}
}  // namespace

json::array loss_causes_document() {
    json::array causes;
    for (const LossCause cause : loss_causes()) {
        const auto [endless, to_a_target] = by_default(cause);
        causes.push_back(json::object{{"cause", name_of(cause)},
                                      {"number", static_cast<int>(cause)},
                                      {"description", words_of(cause)->description},
                                      {"default_endless", name_of(endless)},
                                      {"default_to_a_target", name_of(to_a_target)}});
    }
    return causes;
}

json::object fail_safe_row(const MatrixPorts& ports, const SiteState& site, std::size_t i) {
    const AxisSpec& spec = site.site.axes[i];
    const auto cause = static_cast<LossCause>(ports.get<AxisPort>().picture(site.axis_ids[i]).fail_safe_cause);
    return {{"axis", spec.name},
            {"fail_safe", choice_of(spec.fail_safe)},
            {"watchdog_ms_in_force", milliseconds_of(spec.fail_safe.watchdog(ports.get<RehearsalPort>().watchdog()))},
            {"last_cause", cause == LossCause::none ? json::value(nullptr) : json::value(name_of(cause))},
            {"drive_watchdog", watchdog_of(ports, site, spec)},
            {"drive_limits", limits_of(ports, site, spec)}};
}

Refusable<Site> with_fail_safe(const Site& before, const Families& families, std::string_view axis, const json::object& choice) {
    json::object wanted;
    for (const auto& [key, value] : choice) {
        if (!value.is_null()) wanted[key] = value;
    }
    auto edited = patch_entry(to_json(before), Collection::axes, axis, {{"fail_safe", nullptr}});
    if (auto* refusal = std::get_if<ServiceRefusal>(&edited)) return std::move(*refusal);
    edited = patch_entry(std::move(std::get<Edit>(edited).document), Collection::axes, axis, {{"fail_safe", wanted}});
    if (auto* refusal = std::get_if<ServiceRefusal>(&edited)) return std::move(*refusal);
    const Edit& edit = std::get<Edit>(edited);
    return checked_site(edit.document, families, edit.pointer + "/fail_safe");
}

RehearsalChoice read_rehearsal_choice(const json::object& body, std::vector<Fault>& faults) {
    RehearsalChoice wish;
    for (const auto& [key, value] : body) {
        if (key == "axes") {
            if (auto listed = names_listed(key, value, faults)) wish.axes = std::move(*listed);
        } else if (key == "steps") {
            wish.steps = steps_in(value, faults);
        } else {
            faults.push_back({"/" + std::string(key), fmt::format("{} is not known here", std::string_view(key)), "leave it out"});
        }
    }
    return wish;
}

}  // namespace axisgate
