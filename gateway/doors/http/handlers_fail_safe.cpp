// Handlers of loss of command: the matrix of cause and action per axis, its change, and its rehearsal on models.
// In: calls. Out: what the site names, what holds where it names nothing, and the last report. Never stops or moves anything.
#include <fmt/core.h>

#include <algorithm>
#include <boost/json/array.hpp>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/site_change.hpp"
#include "gateway/doors/http/site_edit.hpp"
#include "gateway/services/fail_safe/rehearsals.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
/// What happens to a motion without an end, and to one with an end, where the site says nothing.
struct ByDefault {
    FailSafeAction endless, to_a_target;
};
ByDefault by_default(LossCause cause) {
    const FailSafe none;
    return {none.action(cause, {.endless = true, .moving = true, .powered = true}),
            none.action(cause, {.endless = false, .moving = true, .powered = true})};
}

std::string_view described(LossCause cause) {
    switch (cause) {
        case LossCause::modbus_closed:
            return "the last Modbus connection of who commands the axis has ended";
        case LossCause::modbus_silent:
            return "who commands it is connected over Modbus, and has asked nothing for longer than watchdog_ms";
        case LossCause::set_points_silent:
            return "the set-points that it follows (other than over DDS) are not renewed in time, or their connection has ended";
        case LossCause::lease_ended:
            return "who commands it held it by a lease, and the lease has expired or was taken back with the right to command";
        case LossCause::enip_closed:
            return "the EtherNet/IP connection of who commands it was closed";
        case LossCause::enip_timed_out:
            return "the EtherNet/IP connection of who commands it has timed out (interval x multiplier)";
        case LossCause::enip_idle:
            return "the EtherNet/IP scanner of who commands it says that it is idle (program mode)";
        case LossCause::line_lost:
            return "the drive could not be reached while it was commanded; done as soon as it answers again";
        case LossCause::gateway_ends:
            return "the gateway is told to end";
        case LossCause::dds_deadline:
            return "who commands it does so over DDS, and its set-points have missed their deadline or nobody writes for it any more";
        case LossCause::enip_session_closed:
            return "who commands it did so by EtherNet/IP messages, and the last session or connection by which it did has ended";
        case LossCause::enip_silent:
            return "who commands it does so by EtherNet/IP messages, and has sent nothing for longer than watchdog_ms";
        case LossCause::none:
            break;
    }
    return "";
}

json::object choice_of(const FailSafe& chosen) {
    json::object o;
    for (const LossCause cause : loss_causes) {
        const auto& action = chosen.of(cause);
        o[name_of(cause)] = action ? json::value(name_of(*action)) : json::value(nullptr);
    }
    o["watchdog_ms"] = chosen.watchdog_ms ? json::value(*chosen.watchdog_ms) : json::value(nullptr);
    return o;
}

json::value state_of(DriveWatchdog::State state) {
    switch (state) {
        case DriveWatchdog::State::off:
            return "off";
        case DriveWatchdog::State::armed:
            return "armed";
        case DriveWatchdog::State::refused:
            return "refused";
        case DriveWatchdog::State::unknown:
            break;
    }
    return nullptr;
}

using MatrixPorts = PortSet<AxisPort, DrivePort, RehearsalPort, SitePort>;

/// What the drive of an axis does by itself when it does not hear the gateway any more: what its family has, and what was programmed.
json::object watchdog_of(const MatrixPorts& ports, const SiteState& site, const AxisSpec& spec) {
    json::object o{{"available", false}, {"state", nullptr}, {"time_ms", nullptr}, {"action", nullptr}, {"description", ""}};
    const auto d = index_of_name(site.site.drives, spec.drive);
    const auto page = d ? catalogue_of(site.site, site.site.drives[*d], ports.get<SitePort>().families()) : nullptr;
    const auto* says = page ? page->document().if_contains("drive_watchdog") : nullptr;
    if (!says || !says->is_object()) return o;
    o["available"] = says->get_object().at("available");
    o["description"] = says->get_object().at("description");
    if (*d >= site.drive_ids.size() || !o["available"].as_bool()) return o;
    const DriveWatchdog w = ports.get<DrivePort>().drive_status(site.drive_ids[*d]).watchdog;
    o["state"] = state_of(w.state);
    if (w.state != DriveWatchdog::State::armed) return o;
    o["time_ms"] = milliseconds_of(w.time);
    o["action"] = w.action;
    return o;
}

json::object axis_row(const MatrixPorts& ports, const SiteState& site, std::size_t i) {
    const AxisSpec& spec = site.site.axes[i];
    const auto cause = static_cast<LossCause>(ports.get<AxisPort>().picture(site.axis_ids[i]).fail_safe_cause);
    return {{"axis", spec.name},
            {"fail_safe", choice_of(spec.fail_safe)},
            {"watchdog_ms_in_force", milliseconds_of(spec.fail_safe.watchdog(ports.get<RehearsalPort>().watchdog()))},
            {"last_cause", cause == LossCause::none ? json::value(nullptr) : json::value(name_of(cause))},
            {"drive_watchdog", watchdog_of(ports, site, spec)}};
}

std::optional<Response> row_of(const MatrixPorts& ports, std::string_view name) {
    const auto site = ports.get<SitePort>().site();
    const auto i = index_of_name(site->site.axes, name);
    if (!i) return std::nullopt;
    Response r = json_response(axis_row(ports, *site, *i));
    put_revision(r, *site);
    return r;
}
}  // namespace

Handled get_fail_safe(Call&, AxisPort& axes, DrivePort& drives, RehearsalPort& player, SitePort& sites) {
    const MatrixPorts ports{axes, drives, player, sites};
    json::array causes, rows;
    for (const LossCause cause : loss_causes) {
        const auto [endless, to_a_target] = by_default(cause);
        causes.push_back(json::object{{"cause", name_of(cause)},
                                      {"number", static_cast<int>(cause)},
                                      {"description", described(cause)},
                                      {"default_endless", name_of(endless)},
                                      {"default_to_a_target", name_of(to_a_target)}});
    }
    const auto site = sites.site();
    for (std::size_t i = 0; i < site->site.axes.size() && i < site->axis_ids.size(); ++i)
        rows.push_back(axis_row(ports, *site, i));
    Response r = json_response(json::object{{"causes", std::move(causes)}, {"axes", std::move(rows)}});
    put_revision(r, *site);
    return r;
}

Handled get_axis_fail_safe(Call& c, AxisPort& axes, DrivePort& drives, RehearsalPort& player, SitePort& sites) {
    auto row = row_of({axes, drives, player, sites}, c.names[0]);
    return row ? std::move(*row) : nothing_named("axis", c.names[0]);
}

Handled put_axis_fail_safe(Call& c, AxisPort& axes, DrivePort& drives, RehearsalPort& player, SitePort& sites, const StagePort& staging) {
    json::object wanted;  // null is the default, as GET tells it
    for (const auto& [key, value] : c.body.get_object()) {
        if (!value.is_null()) wanted[key] = value;
    }
    const MatrixPorts ports{axes, drives, player, sites};
    return change_site(
        c, sites, staging, false, [ports, wanted = std::move(wanted), name = c.names[0]](const SiteState& before) -> Planned {
            auto edited = patch_entry(to_json(before.site), Collection::axes, name, {{"fail_safe", nullptr}});
            if (auto* refusal = std::get_if<Response>(&edited)) return std::move(*refusal);
            edited = patch_entry(std::move(std::get<Edit>(edited).document), Collection::axes, name, {{"fail_safe", wanted}});
            if (auto* refusal = std::get_if<Response>(&edited)) return std::move(*refusal);
            const Edit& edit = std::get<Edit>(edited);
            std::vector<SiteFault> faults;
            auto site = parse_site(edit.document, ports.get<SitePort>().families(), faults);
            if (!site) return refusal_for(faults, edit.pointer + "/fail_safe", false);
            return Plan{std::move(*site), [ports, name](const std::shared_ptr<const SiteState>&) {
                            auto row = row_of(ports, name);
                            return row ? std::move(*row) : nothing_named("axis", name);
                        }};
        });
}

Handled get_rehearsal(Call& c) { return json_response(c.context.rehearsals->state()); }

Handled start_rehearsal(Call& c) {
    std::vector<std::string> axes;
    std::vector<Fault> faults;
    for (const auto& [key, value] : c.body.get_object()) {
        if (key != "axes") {
            faults.push_back({"/" + std::string(key), fmt::format("{} is not known here", std::string_view(key)), "leave it out"});
        } else if (!value.is_array() || !std::ranges::all_of(value.get_array(), [](const json::value& v) { return v.is_string(); })) {
            faults.push_back({"/axes", "axes must be a list of names", "leave it out for all axes"});
        } else {
            for (const auto& v : value.get_array())
                axes.emplace_back(v.get_string());
        }
    }
    if (!faults.empty()) return invalid(std::move(faults));
    if (auto why = c.context.rehearsals->start(std::move(axes), c.origin()); !why.empty()) return problem(409, "conflict", std::move(why));
    return json_response(c.context.rehearsals->state(), 202);
}

}  // namespace axisgate::http
