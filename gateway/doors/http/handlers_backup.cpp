// Handlers of backups: the database as one file, one laid down for the next start, what waits, and the way back.
// In: calls. Out: the file; what waits; 202 where something will happen later. Never replaces the database while it is served.
#include <fmt/core.h>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate::http {
namespace json = boost::json;

Handled get_backup(Call& c, BackupPort& backups, EventPort& events) {
    auto note_sent = [&events, who = c.who(), sent = c.request.method == Method::get](std::size_t bytes) {
        if (!sent) return;  // HEAD: nothing leaves
        Event e;
        e.kind = "site";  // as of a backup that is laid down
        e.text = fmt::format("a backup was handed out: the whole database, {} bytes, with users, tokens and all that was stored", bytes);
        e.who = who;
        e.door = std::string(axisgate::name_of(Door::http));
        events.note(std::move(e));
    };
    backups.backup([respond = c.respond, note_sent = std::move(note_sent)](std::optional<std::string> bytes, const std::string& fault) {
        if (!bytes) return respond(problem(507, "not_stored", fault));
        note_sent(bytes->size());
        Response r;
        r.headers.set("Content-Type", "application/octet-stream");
        r.headers.set("Content-Disposition", "attachment; filename=\"axisgate-backup.db\"");
        r.body = std::move(*bytes);
        respond(std::move(r));
    });
    return {gateway_limit, problem(504, "time_out", "the backup was not made in time: use `axisgate backup`")};
}

Handled put_backup(Call& c, BackupPort& backups) {
    if (!c.request.body.starts_with(std::string_view("SQLite format 3\0", 16)))
        return invalid({{"", "this is no backup of axisgate", "send the file that GET /backup gave"}});
    backups.restore(c.request.body, c.origin(), [respond = c.respond](const RestoreFault& fault) {
        if (fault.no_room) return respond(problem(507, "not_stored", "the backup is not taken: " + fault.text));
        if (!fault.text.empty())
            return respond(invalid({{"", "the backup is not taken: " + fault.text, "send a whole backup of this or an older version"}}));
        respond(
            json_response(json::object{{"restart_needed", true},
                                       {"text", "the backup is whole and laid down: it takes the place of the database at the next start"}},
                          202));
    });
    return {gateway_limit, problem(504, "time_out", "the backup was not checked in time")};
}

Handled get_waiting_backup(Call& c, BackupPort& backups) {
    backups.waiting_backup([respond = c.respond](const std::optional<WaitingBackup>& w) {
        const auto number_or_null = [](std::uint64_t n) { return n == 0 ? json::value() : json::value(n); };
        respond(json_response(json::object{{"waiting", w.has_value()},
                                           {"at", w ? json::value(format_time(w->at_unix_ns)) : json::value()},
                                           {"who", text_or_null(w ? w->who : "")},
                                           {"bytes", number_or_null(w ? w->bytes : 0)},
                                           {"version", number_or_null(w ? static_cast<std::uint64_t>(w->version) : 0)},
                                           {"site_revision", number_or_null(w ? w->site_revision : 0)}}));
    });
    return {gateway_limit, problem(504, "time_out", "it could not be looked at in time")};
}

Handled cancel_waiting_backup(Call& c, BackupPort& backups) {
    backups.cancel_restore(c.origin(), [respond = c.respond](const std::string& fault) {
        if (fault == "none") return respond(problem(404, "not_found", "no backup waits for the next start"));
        if (!fault.empty()) return respond(problem(507, "not_stored", fault));
        Response r;
        r.status = 204;
        respond(std::move(r));
    });
    return {gateway_limit, problem(504, "time_out", "it was not taken away in time: look before trying again")};
}

}  // namespace axisgate::http
