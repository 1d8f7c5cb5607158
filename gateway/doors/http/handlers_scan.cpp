// Handlers of a line's scan: begin, report, end; and the ports of this machine at which a line can be.
#include <fmt/core.h>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/services/line_scan.hpp"

namespace axisgate::http {
namespace {
Response no_answer() { return problem(504, "no_answer", "the gateway has not answered"); }

}  // namespace

Handled list_host_ports(Call&, const LinePort& lines, const SitePort& sites) {
    return json_response(host_ports_document(lines, sites.site()->site));
}

Handled start_scan(Call& c, LinePort& lines, const SitePort& sites) {
    const auto line = find_line(sites, c.names[0]);
    if (!line) return nothing_named("line", c.names[0]);
    std::vector<Fault> faults;
    auto wish = read_scan_wish(c.body.get_object(), faults);
    if (!faults.empty()) return invalid(std::move(faults));
    lines.start_scan(line->id, std::move(wish), c.origin(), [respond = c.respond, &lines, line = *line](const std::string& fault) {
        if (!fault.empty()) return respond(problem(409, "conflict", fault));
        lines.scan_report(line.id, [respond, line](const ScanReport& r) {
            Response answer = json_response(scan_document(r, line.name), 202);
            answer.headers.set("Location", fmt::format("/api/v1/lines/{}/scan", percent_encode(line.name)));
            respond(std::move(answer));
        });
    });
    return {gateway_limit, no_answer()};
}

Handled get_scan(Call& c, LinePort& lines, const SitePort& sites) {
    const auto line = find_line(sites, c.names[0]);
    if (!line) return nothing_named("line", c.names[0]);
    lines.scan_report(line->id,
                      [respond = c.respond, name = line->name](const ScanReport& r) { respond(json_response(scan_document(r, name))); });
    return {gateway_limit, no_answer()};
}

Handled cancel_scan(Call& c, LinePort& lines, const SitePort& sites) {
    const auto line = find_line(sites, c.names[0]);
    if (!line) return nothing_named("line", c.names[0]);
    lines.cancel_scan(line->id,
                      [respond = c.respond, name = line->name](const ScanReport& r) { respond(json_response(scan_document(r, name))); });
    return {gateway_limit, no_answer()};
}

}  // namespace axisgate::http
