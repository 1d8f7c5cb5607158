// Handlers of drives: one exchange in the drive's own language, and the conditions of simulated drives.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/services/drive_access.hpp"

namespace axisgate::http {
namespace json = boost::json;
Handled exchange_native(Call& c, AxisPort& axes, const ClockPort& clock, const SitePort& sites) {
    const auto drive = find_drive(sites, c.names[0]);
    if (!drive) return nothing_named("drive", c.names[0]);
    std::vector<Fault> faults;
    auto native = read_native(c.body.get_object(), faults);
    if (!faults.empty()) return invalid(std::move(faults));
    const auto chosen = axis_for(*drive);
    if (const auto* refusal = std::get_if<ServiceRefusal>(&chosen)) return problem_of(*refusal);
    const auto index = std::get<std::size_t>(chosen);
    Command command;
    command.axis = drive->site->axis_ids[index];
    command.body = std::move(*native);
    const std::int64_t begun_ns = clock.now_unix_ns();
    // In microseconds, because on a fast line an exchange takes less than one millisecond.
    const auto took_ms = [&clock, begun_ns] {
        return number(static_cast<double>(std::max<std::int64_t>(0, (clock.now_unix_ns() - begun_ns) / 1'000)) / 1000.0);
    };
    const std::string axis = drive->site->site.axes[index].name;
    command.origin = c.origin();
    const Ticket ticket = axes.submit(std::move(command), [took_ms, axis, respond = c.respond](const Result& r) {
        if (good(r)) return respond(json_response(json::object{{"reply", r.text}, {"reply_hex", to_hex(r.bytes)}, {"took_ms", took_ms()}}));
        if (r.reason != Reason::drive_refused || r.bytes.empty()) return respond(problem_of(r, axis, "native"));
        // The drive has answered, although with an error: the answer is included.
        respond(to_response(Problem{.status = 409,
                                    .reason = std::string(name_of(r.reason)),
                                    .detail = r.text,
                                    .code = r.code,
                                    .axis = axis,
                                    .more = {{"ticket", shown(r.ticket)},
                                             {"result", name_of(r.outcome)},
                                             {"command", "native"},
                                             {"reply_hex", to_hex(r.bytes)},
                                             {"took_ms", took_ms()}}}));
    });
    Result none;
    none.ticket = ticket;
    none.outcome = Outcome::failed;
    none.reason = Reason::no_answer;
    none.text = fmt::format("native: no result within {} s; nobody knows whether it was done", gateway_limit.count());
    return {gateway_limit, problem_of(none, axis, "native")};
}

Handled get_hand(Call& c, DrivePort& drives, const SitePort& sites) {
    const auto drive = find_drive(sites, c.names[0]);
    if (!drive) return nothing_named("drive", c.names[0]);
    std::optional<Response> fault;
    const bool describe = query_flag(c, "describe", fault);
    if (fault) return *fault;
    axisgate::get_hand(drives, *drive, [describe, respond = c.respond](const Refusable<HandItems>& answer) {
        respond(given(answer, [&](const HandItems& items) {
            return describe ? json_response(hand_description(items)) : json_response(hand_document(items));
        }));
    });
    return {gateway_limit, problem(504, "time_out", fmt::format("the hand of {} was not told in time", c.names[0]))};
}

Handled set_hand(Call& c, DrivePort& drives, const SitePort& sites) {
    const auto drive = find_drive(sites, c.names[0]);
    if (!drive) return nothing_named("drive", c.names[0]);
    std::vector<Fault> faults;
    auto wanted = read_hand_wish(c.body.get_object(), faults);
    if (!faults.empty()) return invalid(std::move(faults));
    axisgate::set_hand(drives, *drive, std::move(wanted), c.origin(), [respond = c.respond](const Refusable<HandItems>& answer) {
        respond(given(answer, [](const HandItems& items) { return json_response(hand_document(items)); }));
    });
    return {gateway_limit,
            problem(504, "time_out", fmt::format("the hand of {} did not answer in time; look again whether it was set", c.names[0]))};
}

}  // namespace axisgate::http
