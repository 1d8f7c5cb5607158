// Handlers of comparisons of real drives with their twins: begin one, its newest report, and the adoption of that report by the twin.
#include <fmt/core.h>

#include "gateway/doors/http/handlers.hpp"

namespace axisgate::http {

Handled compare_with_twin(Call& c, const DriveComparisons& comparisons) {
    comparisons.compare(c.names[0], c.origin(),
                        [respond = c.respond](const Refusable<boost::json::object>& answer) { respond(given(answer, json_answer)); });
    auto later = job_later(c.names[0]);
    later.at_limit.headers.set("Location", fmt::format("/api/v1/axes/{}/comparison", percent_encode(c.names[0])));
    return later;
}

Handled get_comparison(Call& c, const DriveComparisons& comparisons) { return given(comparisons.report(c.names[0]), json_answer); }

Handled adopt_comparison(Call& c, const DriveComparisons& comparisons) {
    comparisons.adopt(c.names[0], c.origin(),
                      [respond = c.respond](const Refusable<boost::json::object>& answer) { respond(given(answer, json_answer)); });
    return {gateway_limit, problem(504, "time_out", "the values were not adopted in time: look at the twin before trying again")};
}

}  // namespace axisgate::http
