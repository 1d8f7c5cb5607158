// A backup is tried in a folder of its own first, so that only a database that this program can open is stored for the next start. The name
// of the sender is in a small text beside it, which may be missing, and never belongs to another file.
#include "gateway/runtime/waiting_backup.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <boost/json/object.hpp>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <cerrno>
#include <filesystem>
#include <vector>

#include "gateway/runtime/backup_file.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/files.hpp"
#include "gateway/runtime/restore_note.hpp"
#include "gateway/store/backup.hpp"
#include "gateway/store/files.hpp"

namespace axisgate {
namespace {
namespace fs = std::filesystem;
namespace json = boost::json;
constexpr std::size_t most_note_bytes = 65536;

constexpr std::string_view check_name = "restore-check";

/// A plain database, or an unsealed archive: a sealed backup waits as readable as the database itself.
std::string file_in(const std::string& directory) { return directory + "/restore-at-start.db"; }
/// A second gateway that is started on the same directory must not use the folder of the first.
std::string check_folder_in(const std::string& directory) { return fmt::format("{}/{}-{}", directory, check_name, ::getpid()); }
std::string note_in(const std::string& directory) { return directory + "/restore-at-start.json"; }

/// Readable only by this user from the first moment, because a backup contains users and their hashes.
bool write_durably(const std::string& file, std::string_view bytes) {
    (void)::unlink(file.c_str());
    const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    bool good = fd >= 0;
    while (good && !bytes.empty()) {
        const auto n = ::write(fd, bytes.data(), bytes.size());
        good = n > 0 || (n < 0 && errno == EINTR);
        if (n > 0) bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    good = good && ::fsync(fd) == 0;
    if (fd >= 0) (void)::close(fd);
    return good;
}

/// The store's own texts name files of this machine; the sender of a backup over the network needs to know only its fault.
std::string words_for(const StoreError& e) {
    switch (e.kind) {
        case StoreError::Kind::corrupt:
            return "the file is damaged, cut short, or its tables were altered";
        case StoreError::Kind::not_ours:
            return "it is a database, but not one of axisgate";
        case StoreError::Kind::newer:
            return "it was written by a newer axisgate than this one";
        case StoreError::Kind::disk_full:
            return "there is no room for it on the gateway's disk: free some and send it again";
        case StoreError::Kind::read_only:
            return "the gateway's data directory cannot be written";
        default:
            return fmt::format("it could not be checked ({})", name_of(e.kind));
    }
}

BackupOutcome refused(const StoreError& e) {
    const bool theirs = e.kind == StoreError::Kind::corrupt || e.kind == StoreError::Kind::not_ours || e.kind == StoreError::Kind::newer;
    return {words_for(e), !theirs, {}};
}
BackupOutcome refused(const BackupFault& f) {
    if (f.kind == BackupFault::Kind::cannot_read || f.kind == BackupFault::Kind::cannot_write)  // its text names files
        return {"there is no room for it on the gateway's disk, or its data directory cannot be written", true, {}};
    return {f.text, false, {}};
}

/// The file with the decrypted content, and the database in it as one that can be tried.
tl::expected<std::string, BackupOutcome> spread_out(const std::string& bytes, const std::string& passphrase, const std::string& part,
                                                    const std::string& folder, std::string& note) {
    const auto form = backup_form_of(bytes);
    if (form == BackupForm::none) return tl::unexpected(BackupOutcome{"it is no backup of axisgate", false, {}});
    if (form == BackupForm::sealed) {
        if (auto r = unseal_backup(bytes, passphrase, part); !r) return tl::unexpected(refused(r.error()));
    } else if (!write_durably(part, bytes)) {
        return tl::unexpected(refused(BackupFault{BackupFault::Kind::cannot_write, {}}));
    }
    if (form == BackupForm::database) return part;
    const auto in_it = open_backup(part, {}, folder);
    if (!in_it) return tl::unexpected(refused(in_it.error()));
    std::string left;
    for (const auto& m : in_it->members) {
        if (m != database_member && !m.starts_with("http-")) left += (left.empty() ? "" : ", ") + m;
    }
    if (!left.empty()) note = fmt::format("files of the host are not taken over the network ({}): `axisgate restore` takes them", left);
    return fmt::format("{}/{}", folder, database_member);
}
}  // namespace

BackupOutcome lay_down_backup(const std::string& bytes, const std::string& passphrase, const std::string& who, std::int64_t at_unix_ns,
                              const StoreOptions& options) {
    // Tried in a folder of its own first, so that only a database that this program can open is stored.
    const std::string folder = check_folder_in(options.directory), part = options.directory + "/restore-at-start.part";
    std::error_code ec;
    fs::remove_all(folder, ec);
    BackupOutcome outcome;
    json::object note{{"at_unix_ns", at_unix_ns}, {"who", who}};
    if (const auto database = spread_out(bytes, passphrase, part, folder, outcome.note); !database) {
        outcome = database.error();
    } else {
        StoreOptions tried = options;
        tried.directory = folder + "/trial";
        if (const auto good = restore_database(*database, tried)) {
            note["version"] = good->version;
            note["site_revision"] = good->site_revision;
        } else {
            outcome = refused(good.error());
        }
    }
    fs::remove_all(folder, ec);
    if (outcome.fault.empty()) {
        // The text is written first. Beside an earlier backup it would name the wrong sender, so that backup is removed before.
        fs::remove(file_in(options.directory), ec);
        (void)write_durably(note_in(options.directory), json::serialize(note));
        fs::rename(part, file_in(options.directory), ec);
        if (ec) outcome = {"it could not be laid down: " + ec.message(), true, {}};
        if (outcome.fault.empty() && !files::sync_directory(options.directory))
            outcome = {"it could not be laid down durably: the disk failed", true, {}};
    }
    if (!outcome.fault.empty()) fs::remove(part, ec);
    return outcome;
}

std::optional<WaitingBackup> waiting_backup(const std::string& directory) {
    std::error_code ec;
    const auto bytes = fs::file_size(file_in(directory), ec);
    if (ec) return std::nullopt;
    WaitingBackup w;
    w.bytes = bytes;
    const auto written = fs::last_write_time(file_in(directory), ec);
    if (!ec) {
        const auto at = std::chrono::file_clock::to_sys(written).time_since_epoch();
        w.at_unix_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(at).count();
    }
    std::string none;
    const auto text = read_file(note_in(directory), none, most_note_bytes);
    if (!text) return w;
    boost::system::error_code wrong;
    const auto note = json::parse(*text, wrong);
    if (wrong || !note.is_object()) return w;
    const auto number = [&](const char* key) -> std::int64_t {
        const auto* v = note.get_object().if_contains(key);
        return v && v->is_int64() ? v->get_int64() : 0;
    };
    if (const auto at = number("at_unix_ns"); at != 0) w.at_unix_ns = at;
    w.version = static_cast<int>(number("version"));
    w.site_revision = static_cast<std::uint64_t>(number("site_revision"));
    if (const auto* who = note.get_object().if_contains("who"); who && who->is_string()) w.who = who->get_string();
    return w;
}

std::string cancel_waiting_backup(const std::string& directory) {
    std::error_code ec;
    const bool was = fs::remove(file_in(directory), ec);
    if (ec) return "it could not be taken away: " + ec.message();
    fs::remove(note_in(directory), ec);
    return was ? std::string() : std::string("none");
}

void remove_backup_leftovers(const std::string& directory) {
    std::error_code ec;
    std::vector<fs::path> gone;
    for (fs::directory_iterator it(directory, ec), end; !ec && it != end; it.increment(ec)) {
        const std::string name = it->path().filename().string();
        if (name == "restore-at-start.part" || name.starts_with(download_name) || name.starts_with(check_name)) gone.push_back(it->path());
    }
    for (const auto& path : gone)
        fs::remove_all(path, ec);
}

std::string take_waiting_backup(const StoreOptions& options) {
    const std::string file = file_in(options.directory), folder = check_folder_in(options.directory);
    std::error_code ec;
    if (!fs::exists(file, ec)) return {};
    const std::string who = waiting_backup(options.directory).value_or(WaitingBackup{}).who;
    std::string fault, database = file;
    bool in_use = false;
    if (backup_form_of_file(file) != BackupForm::database) {
        fs::remove_all(folder, ec);
        database = fmt::format("{}/{}", folder, database_member);
        if (const auto open = open_backup(file, {}, folder); !open) fault = open.error().text;
    }
    if (fault.empty()) {
        if (const auto done = restore_database(database, options); !done) {
            fault = done.error().text;
            in_use = done.error().kind == StoreError::Kind::in_use;
        } else {
            (void)leave_restore_note(options.directory, {who, unix_now_ns(), done->replaced_site_revision, done->site_revision});
        }
    }
    if (fault.empty() && fs::exists(folder + "/http-key.pem", ec) && fs::exists(folder + "/http-cert.pem", ec)) {
        // The key first, as where the pair is made: an interruption leaves a pair that does not fit, and the door makes a new one.
        for (const auto* name : {"/http-key.pem", "/http-cert.pem"})
            fs::rename(folder + name, options.directory + name, ec);
    }
    fs::remove_all(folder, ec);
    if (in_use) return fault;  // it waits for the gateway that runs here
    fs::remove(note_in(options.directory), ec);
    if (!fault.empty()) {
        fs::rename(file, file + ".refused", ec);
        return fmt::format("the backup that was laid down cannot be taken: {}; it is kept as {}.refused, start again to go on without it",
                           fault, file);
    }
    fs::remove(file, ec);
    return {};
}

}  // namespace axisgate
