// Handlers of snapshots: calls of the snapshots' service, and its answers as HTTP.
#include <fmt/core.h>

#include "gateway/doors/http/handlers.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
Handled promise(std::string text) { return {gateway_limit, problem(504, "time_out", std::move(text))}; }
}  // namespace

Handled list_snapshots(Call& c, const Snapshots& snapshots) {
    return given(snapshots.list(c.names[0]), [&](const std::vector<SnapshotInfo>& list) {
        json::array out;
        for (const auto& s : list)
            out.push_back(document_of(s, c.names[0]));
        return json_response(out);
    });
}

Handled get_snapshot_progress(Call& c, const SitePort& sites) {
    return given(job_progress(sites, *c.context.jobs, c.names[0]), json_answer);
}

Handled take_snapshot(Call& c, const SitePort& sites, const Snapshots& snapshots) {
    if (!find_axis(sites, c.names[0])) return nothing_named("axis", c.names[0]);
    std::vector<Fault> faults;
    auto wish = read_snapshot_wish(c.body.get_object(), faults);
    if (!faults.empty()) return invalid(std::move(faults), c.names[0]);
    const bool stored = wish.from_stored;
    snapshots.take(c.names[0], std::move(wish), c.origin(),
                   [snapshots, respond = c.respond, name = c.names[0]](const Refusable<TakenSnapshot>& answer) {
                       respond(given(answer, [&](const TakenSnapshot& taken) {
                           Response r = json_response(snapshots.document(taken), 201);
                           r.headers.set("Location", fmt::format("/api/v1/axes/{}/snapshots/{}", percent_encode(name), taken.snapshot.n));
                           return r;
                       }));
                   });
    return stored ? promise("the snapshot was not stored in time: look at the list before trying again") : job_later(c.names[0]);
}

Handled get_snapshot(Call& c, const Snapshots& snapshots) {
    const auto found = snapshots.find(c.names[0], c.names[1]);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&found)) return problem_of(*refusal);
    const auto& kept = std::get<KeptSnapshot>(found);
    std::optional<Response> fault;
    const bool as_json = wants_json(c, "dcf", fault);
    if (fault) return *fault;
    if (as_json) return json_response(snapshots.document(kept));
    return given(snapshots.dcf(kept), [](const SnapshotDcf& dcf) {
        Response r = file_answer("text/plain; charset=utf-8", dcf.file_name, dcf.text);
        r.headers.set("Vary", "Accept");
        r.headers.set("Left-Out", std::to_string(dcf.left_out));
        return r;
    });
}

Handled remove_snapshot(Call& c, const Snapshots& snapshots) {
    snapshots.remove(c.names[0], c.names[1], c.origin(), [respond = c.respond](const std::optional<ServiceRefusal>& refusal) {
        respond(refusal ? problem_of(*refusal) : nothing_left());
    });
    return promise("the snapshot was not removed in time");
}

Handled diff_snapshot(Call& c, const Snapshots& snapshots) {
    const std::string with(c.target.query.get("with").value_or("device"));
    snapshots.compare(c.names[0], c.names[1], with, c.origin(), [respond = c.respond](const Refusable<SnapshotDifference>& answer) {
        respond(given(answer, [](const SnapshotDifference& d) { return json_response(document_of(d)); }));
    });
    return promise("the drive's parameters were not all read in time");
}

Handled restore_snapshot(Call& c, const Snapshots& snapshots) {
    const auto found = snapshots.find(c.names[0], c.names[1]);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&found)) return problem_of(*refusal);
    const auto& kept = std::get<KeptSnapshot>(found);
    if (const auto refusal = snapshots.why_not_restored(kept)) return problem_of(*refusal);
    std::vector<Fault> faults;
    const auto wish = read_restore_wish(c.body.get_object(), kept.snapshot, faults);
    if (!faults.empty()) return invalid(std::move(faults), c.names[0]);
    auto plan = snapshots.plan_restore(kept, wish);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&plan)) return problem_of(*refusal);
    if (wish.dry_run) return json_response(document_of(std::get<ParameterPlan>(plan)));
    snapshots.restore(kept, std::get<ParameterPlan>(std::move(plan)), c.origin(), show_written(c.respond));
    return job_later(c.names[0]);
}

}  // namespace axisgate::http
