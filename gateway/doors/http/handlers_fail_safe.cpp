// Handlers of loss of command: the matrix of cause and action per axis, its change, and its rehearsal on models. Nothing is stopped or
// moved here.
#include <boost/json/array.hpp>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/site_change.hpp"
#include "gateway/services/fail_safe/fail_safe_matrix.hpp"
#include "gateway/services/fail_safe/rehearsals.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
Response row_of(const MatrixPorts& ports, std::string_view name) {
    const auto site = ports.get<SitePort>().site();
    const auto i = index_of_name(site->site.axes, name);
    return i ? site_answer(*site, fail_safe_row(ports, *site, *i)) : nothing_named("axis", name);
}
}  // namespace

Handled get_fail_safe(Call&, const MatrixPorts& ports) {
    const auto site = ports.get<SitePort>().site();
    json::array rows;
    for (std::size_t i = 0; i < site->site.axes.size() && i < site->axis_ids.size(); ++i)
        rows.push_back(fail_safe_row(ports, *site, i));
    return site_answer(*site, json::object{{"causes", loss_causes_document()}, {"axes", std::move(rows)}});
}

Handled get_axis_fail_safe(Call& c, const MatrixPorts& ports) { return row_of(ports, c.names[0]); }

Handled put_axis_fail_safe(Call& c, const MatrixPorts& ports, const StagePort& staging) {
    return change_site(c, ports.get<SitePort>(), staging, false,
                       [ports, choice = c.body.get_object(), name = c.names[0]](const SiteState& before) {
                           return planned(with_fail_safe(before.site, ports.get<SitePort>().families(), name, choice),
                                          [ports, name](const std::shared_ptr<const SiteState>&) { return row_of(ports, name); });
                       });
}

Handled get_rehearsal(Call& c) { return json_response(c.context.rehearsals->state()); }

Handled start_rehearsal(Call& c) {
    std::vector<Fault> faults;
    auto wish = read_rehearsal_choice(c.body.get_object(), faults);
    if (!faults.empty()) return invalid(std::move(faults));
    if (auto why = c.context.rehearsals->start(std::move(wish.axes), wish.steps, c.origin()); !why.empty())
        return problem(409, "conflict", std::move(why));
    return json_response(c.context.rehearsals->state(), 202);
}

}  // namespace axisgate::http
