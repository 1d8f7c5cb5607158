// Handlers of drive descriptions: EDS and DCF files that drives of the site may name: stored, shown, removed. DescriptionFiles reads them.
#include <fmt/core.h>

#include "gateway/doors/http/handlers.hpp"

namespace axisgate::http {

Handled list_descriptions(Call&, const DescriptionFiles& files) { return json_response(files.list()); }

Handled get_drive_description(Call& c, const DescriptionFiles& files) {
    const auto format = c.target.query.get("format");
    if (format && *format != "eds" && *format != "json") return problem(400, "bad_request", "format must be eds or json");
    const auto found = files.find(c.names[0]);
    if (!found) return nothing_named("description", c.names[0]);
    std::optional<Response> fault;
    const bool as_json = wants_json(c, "eds", fault);
    if (fault) return *fault;
    if (as_json) return json_response(files.document(*found));
    Response r =
        file_answer(fmt::format("text/plain; charset={}", is_utf8(found->text) ? "utf-8" : "iso-8859-1"), found->name, found->text);
    r.headers.set("Vary", "Accept");
    return r;
}

Handled get_description_objects(Call& c, const DescriptionFiles& files) {
    const auto found = files.find(c.names[0]);
    return found ? json_response(DescriptionFiles::objects(*found)) : nothing_named("description", c.names[0]);
}

Handled add_description(Call& c, const DescriptionFiles& files) {
    std::vector<Fault> faults;
    auto file = read_description(c.body, c.request.body, std::string(c.target.query.get("name").value_or("")), faults);
    if (!faults.empty()) return invalid(std::move(faults));
    files.add(
        std::move(file), c.origin(),
        [respond = c.respond](const Refusable<DescriptionFiles::Added>& answer) {
            respond(given(answer, [](const DescriptionFiles::Added& added) {
                Response r = json_response(added.document, added.is_new ? 201 : 200);
                if (added.is_new) r.headers.set("Location", "/api/v1/descriptions/" + percent_encode(added.name));
                return r;
            }));
        },
        thrown(c.respond));
    return {gateway_limit, problem(504, "no_answer", "the store has not answered")};
}

Handled remove_description(Call& c, const DescriptionFiles& files) {
    files.remove(
        c.names[0], c.origin(),
        [respond = c.respond](const std::optional<ServiceRefusal>& refusal) { respond(refusal ? problem_of(*refusal) : nothing_left()); },
        thrown(c.respond));
    return {gateway_limit, problem(504, "no_answer", "the store has not answered")};
}

}  // namespace axisgate::http
