// Handlers of fast captures: started, shown as JSON or CSV, renamed, cancelled and deleted. Requests are in units of the axes.
#include <fmt/format.h>

#include <algorithm>
#include <boost/json/array.hpp>

#include "gateway/core/text.hpp"
#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/services/recorder/capture_order.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
const CaptureInfo* capture_in(const std::vector<CaptureInfo>& list, std::string_view name) {
    const auto it = std::ranges::find(list, name, &CaptureInfo::name);
    return it == list.end() ? nullptr : &*it;
}

Response refused(std::vector<SiteFault> wrong) {
    std::vector<Fault> faults;
    for (auto& w : wrong)
        faults.push_back({std::move(w.pointer), std::move(w.text), std::move(w.remedy)});
    return invalid(std::move(faults));
}

}  // namespace

Handled list_captures(Call&, CapturePort& captures) {
    const auto room = captures.capture_room();
    json::array list;
    for (const auto& i : captures.captures())
        list.push_back(capture_document(i));
    return json_response(json::object{{"disk_bytes", room.bytes},
                                      {"disk_most_bytes", room.bound},
                                      {"disk_fault", text_or_null(room.disk_fault)},
                                      {"captures", std::move(list)}});
}

Handled arm_capture(Call& c, CapturePort& captures, EventPort& events, const SitePort& sites) {
    const auto site = sites.site();
    std::vector<SiteFault> wrong;
    CaptureOrder order = read_capture_order(c.body, *site, wrong);
    if (!wrong.empty()) return refused(std::move(wrong));
    order.who = c.who();
    const std::string name = order.name;
    Event e;
    e.kind = "capture";
    e.text = fmt::format("capture {} of {} is armed", name, order.axes.front().name);
    e.axis = order.axes.front().name;
    e.who = c.who();
    e.door = std::string(axisgate::name_of(clients));
    captures.arm(std::move(order), [name, e, &events, respond = c.respond](const RecordingFault& fault, const CaptureInfo& info) {
        if (fault.kind != RecordingFault::Kind::none) return respond(kept_refusal("capture", fault, name));
        events.note(e);
        Response r = json_response(capture_document(info), 201);
        r.headers.set("Location", "/api/v1/recorder/captures/" + percent_encode(name));
        respond(std::move(r));
    });
    return {gateway_limit, problem(504, "no_answer", "the line's thread has not answered")};
}

Handled get_capture(Call& c, CapturePort& captures) {
    const auto list = captures.captures();
    const auto* info = capture_in(list, c.names[0]);
    if (!info) return nothing_named("capture", c.names[0]);
    static constexpr std::string_view media[] = {"application/json", "text/csv"};
    const auto liked = best_accepted(c.request.headers.get("Accept"), media);
    if (!liked) return problem(406, "not_acceptable", "this is application/json or text/csv");
    captures.load_capture(c.names[0], [name = c.names[0], csv = *liked == 1, document = capture_document(*info), respond = c.respond](
                                          const RecordingFault& fault, json::array columns) mutable {
        if (fault.kind != RecordingFault::Kind::none) return respond(kept_refusal("capture", fault, name));
        Response r;
        if (csv) {
            r = file_answer("text/csv; charset=utf-8", name + ".csv", capture_csv(columns));
        } else {
            document["columns"] = std::move(columns);
            r = json_response(std::move(document));
        }
        r.headers.set("Vary", "Accept");
        respond(std::move(r));
    });
    return {gateway_limit, problem(504, "no_answer", "the disk has not answered")};
}

Handled rename_capture(Call& c, CapturePort& captures) {
    std::vector<SiteFault> wrong;
    const std::string to = read_capture_name(c.body, wrong);
    if (!wrong.empty()) return refused(std::move(wrong));
    captures.rename_capture(c.names[0], to, [name = c.names[0], to, &captures, respond = c.respond](const RecordingFault& fault) {
        if (fault.kind != RecordingFault::Kind::none) return respond(kept_refusal("capture", fault, name));
        const auto list = captures.captures();
        const auto* info = capture_in(list, to);
        respond(info ? json_response(capture_document(*info)) : nothing_named("capture", to));
    });
    return {gateway_limit, problem(504, "no_answer", "the disk has not answered")};
}

Handled remove_capture(Call& c, CapturePort& captures) {
    captures.remove_capture(c.names[0], [name = c.names[0], respond = c.respond](const RecordingFault& fault) {
        if (fault.kind != RecordingFault::Kind::none) return respond(kept_refusal("capture", fault, name));
        respond(nothing_left());
    });
    return {gateway_limit, problem(504, "no_answer", "the disk has not answered")};
}

}  // namespace axisgate::http
