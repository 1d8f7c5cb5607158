// The texts of events about requests. Bodies are not read.
#include "gateway/doors/http/audit.hpp"
#include "gateway/doors/http/words.hpp"

#include <fmt/core.h>

#include <utility>

namespace axisgate::http {
namespace {
constexpr std::size_t most_path_bytes = 200;  // of the path of an unknown client

Event event_of(const Audit::Asked& asked, std::string_view kind, Severity severity, std::string text) {
    Event e;
    e.kind = kind;
    e.severity = severity;
    e.text = std::move(text);
    e.who = asked.who;
    e.door = std::string(name_of(clients));
    return e;
}
}  // namespace

std::string what_is_asked(const Request& request) {
    std::string_view path = std::string_view(request.target).substr(0, request.target.find('?'));
    const bool cut = path.size() > most_path_bytes;
    return fmt::format("{} {}{}", request.method == Method::other ? "?" : name_of(request.method), path.substr(0, most_path_bytes),
                       cut ? "..." : "");
}

void Audit::answered(const Asked& asked, const Response& r, Instant now) {
    if (r.status < 400 && !asked.kind.empty() && !r.changed_nothing)
        return events_.note(event_of(asked, asked.kind, Severity::info, asked.told));
    if (!is_refusal(r.status, asked.changes)) return;
    Event e = event_of(asked, "refused", asked.changes ? Severity::warning : Severity::info,
                       fmt::format("{}: {} ({} {})", asked.what, r.told.detail, r.status, r.told.reason));
    e.axis = r.told.axis;
    const std::string_view host = std::string_view(asked.peer).substr(0, asked.peer.rfind(':'));
    refusals_.add(host, no_axis, std::move(e), r.status == 401 ? "401 " + r.told.reason : std::string(), now);
}

}  // namespace axisgate::http
