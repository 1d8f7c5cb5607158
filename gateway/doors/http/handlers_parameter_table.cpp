// Handlers of parameters as a table: the history of one, all as CSV, and a table written back.
#include <fmt/core.h>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/services/parameters/parameter_table.hpp"
#include "gateway/services/parameters/parameter_view.hpp"

namespace axisgate::http {

std::function<void(const Refusable<WrittenParameters>&)> show_written(Respond respond) {
    return [respond = std::move(respond)](const Refusable<WrittenParameters>& answer) {
        respond(given(answer, [](const WrittenParameters& w) { return json_response(document_of(w)); }));
    };
}

Handled job_later(const std::string& axis) {
    /// A job that takes longer continues, and is shown at .../snapshot-progress.
    constexpr std::chrono::seconds job_wait{20};
    Response r = json_response(boost::json::object{{"state", "running"}, {"text", "it goes on: ask for its progress"}}, 202);
    r.headers.set("Location", fmt::format("/api/v1/axes/{}/snapshot-progress", percent_encode(axis)));
    return {job_wait, std::move(r)};
}

Handled get_parameter_history(Call& c, const ParameterPort& parameters, const SitePort& sites) {
    const auto place = find_parameter(sites, c.names[0], c.names[1], false);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&place)) return problem_of(*refusal);
    std::optional<Response> fault;
    const auto limit = query_whole(c, "limit", 1, 1000, 100, fault);
    if (fault) return *fault;
    return json_response(parameter_history(parameters, std::get<ParameterPlace>(place), static_cast<std::size_t>(limit)));
}

Handled get_parameters_csv(Call& c, const ParameterPort& parameters, const SitePort& sites) {
    const auto axis = find_axis(sites, c.names[0]);
    if (!axis) return nothing_named("axis", c.names[0]);
    return file_answer("text/csv; charset=utf-8", "parameters.csv", parameters_csv(parameters, *axis));
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
    auto plan = plan_of_csv(c.request.body, parameters, *axis, include);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&plan)) return problem_of(*refusal);
    if (dry_run) return json_response(document_of(std::get<ParameterPlan>(plan)));
    write_planned(c.context.jobs, axes, *axis, std::get<ParameterPlan>(std::move(plan)), c.origin(), show_written(c.respond));
    return job_later(c.names[0]);
}

}  // namespace axisgate::http
