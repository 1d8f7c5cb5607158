// Handlers of backups: the gateway as one file, a backup stored for the next start, and its removal. The database in use is never replaced.
#include <fmt/core.h>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/doors/http/text.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate::http {
namespace json = boost::json;

namespace {
/// A header, because a passphrase must not be in an address, which is logged on the way, and the body is the backup itself.
constexpr std::string_view passphrase_header = "X-Backup-Passphrase";
/// For making and checking a backup: the storage thread does it, which gives way to all others, and the key of a sealed backup takes a
/// second of processor time.
constexpr std::chrono::seconds backup_limit{120};

/// Empty text: none was sent. No value: it is not percent-encoded text.
std::optional<std::string> passphrase_of(const Call& c) { return percent_decode(c.request.headers.get(passphrase_header)); }
Handled not_encoded() {
    return invalid({{"", fmt::format("the header {} is not percent-encoded", passphrase_header),
                     "send each byte of the passphrase but letters, digits and -._~ as %XX"}});
}
}  // namespace

Handled get_backup(Call& c, BackupPort& backups, EventPort& events) {
    const auto passphrase = passphrase_of(c);
    if (!passphrase) return not_encoded();
    auto note_sent = [&events, who = c.who(), sent = c.request.method == Method::get, sealed = !passphrase->empty()](std::size_t bytes) {
        if (!sent) return;  // HEAD: nothing is sent
        Event e;
        e.kind = "site";  // the kind of a stored backup's event
        e.text = fmt::format("a backup was handed out: the whole database, {} bytes, with users, tokens and all that was stored, {}", bytes,
                             sealed ? "and private keys, sealed with a passphrase" : "in the open");
        e.who = who;
        e.door = std::string(axisgate::name_of(clients));
        events.note(std::move(e));
    };
    backups.backup(*passphrase, [respond = c.respond, note_sent = std::move(note_sent), sealed = !passphrase->empty()](
                                    std::optional<std::string> bytes, const BackupOutcome& outcome) {
        if (!bytes && !outcome.no_room)
            return respond(invalid({{"", "no backup is made: " + outcome.fault, "send another passphrase, or none"}}));
        if (!bytes) return respond(problem(507, "not_stored", outcome.fault));
        note_sent(bytes->size());
        Response r;
        r.headers.set("Content-Type", "application/octet-stream");
        r.headers.set("Content-Disposition", fmt::format("attachment; filename=\"axisgate-backup.{}\"", sealed ? "sealed" : "tar"));
        r.body = std::move(*bytes);
        respond(std::move(r));
    });
    return {backup_limit, problem(504, "time_out", "the backup was not made in time: use `axisgate backup`")};
}

Handled put_backup(Call& c, BackupPort& backups) {
    const auto passphrase = passphrase_of(c);
    if (!passphrase) return not_encoded();
    backups.restore(c.request.body, *passphrase, c.origin(), [respond = c.respond](const BackupOutcome& outcome) {
        if (outcome.no_room) return respond(problem(507, "not_stored", "the backup is not taken: " + outcome.fault));
        if (!outcome.fault.empty())
            return respond(
                invalid({{"", "the backup is not taken: " + outcome.fault,
                          fmt::format("send a whole backup of this or an older version, and the passphrase of a sealed one in {}",
                                      passphrase_header)}}));
        std::string text = "the backup is whole and laid down: it takes the place of the database at the next start";
        if (!outcome.note.empty()) text += "; " + outcome.note;
        respond(json_response(json::object{{"restart_needed", true}, {"text", text}}, 202));
    });
    return {backup_limit, problem(504, "time_out", "the backup was not checked in time")};
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
