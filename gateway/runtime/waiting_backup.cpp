// Waiting backup: tried in a folder of its own first: what is laid down is a database that this program opens.
// In: bytes. Out: the file; who laid it down stands beside it in a small text, which may be missing.
// Never leaves a text that tells of another file.
#include "gateway/runtime/waiting_backup.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>

#include <boost/json/object.hpp>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <filesystem>
#include <vector>

#include "gateway/runtime/files.hpp"
#include "gateway/store/backup.hpp"
#include "gateway/store/files.hpp"

namespace axisgate {
namespace {
namespace fs = std::filesystem;
namespace json = boost::json;
constexpr std::size_t most_note_bytes = 65536;

std::string file_in(const std::string& directory) { return directory + "/restore-at-start.db"; }
std::string check_folder_in(const std::string& directory) { return directory + "/restore-check"; }
std::string note_in(const std::string& directory) { return directory + "/restore-at-start.json"; }

/// With rights for this user alone from its first moment: a backup has the users and their hashes in it.
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

/// The store's own words name files of this machine; who sends a backup over the network needs only to know what is wrong with it.
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
}  // namespace

RestoreFault lay_down_backup(const std::string& bytes, const std::string& who, std::int64_t at_unix_ns, const StoreOptions& options) {
    // Tried in a folder of its own first: what is laid down is a database that this program opens.
    const std::string folder = check_folder_in(options.directory), part = options.directory + "/restore-at-start.part";
    std::error_code ec;
    fs::remove_all(folder, ec);
    RestoreFault fault;
    json::object note{{"at_unix_ns", at_unix_ns}, {"who", who}};
    if (!write_durably(part, bytes))
        fault = {"there is no room for it on the gateway's disk, or its data directory cannot be written", true};
    if (fault.text.empty()) {
        StoreOptions tried = options;
        tried.directory = folder;
        if (const auto good = restore_database(part, tried)) {
            note["version"] = good->version;
            note["site_revision"] = good->site_revision;
        } else {
            const auto kind = good.error().kind;
            fault = {words_for(good.error()),
                     kind != StoreError::Kind::corrupt && kind != StoreError::Kind::not_ours && kind != StoreError::Kind::newer};
        }
    }
    fs::remove_all(folder, ec);
    if (fault.text.empty()) {
        // The text first: beside a backup of before it would tell of the wrong one, so that one goes before.
        fs::remove(file_in(options.directory), ec);
        (void)write_durably(note_in(options.directory), json::serialize(note));
        fs::rename(part, file_in(options.directory), ec);
        if (ec) fault = {"it could not be laid down: " + ec.message(), true};
        if (fault.text.empty() && !files::sync_directory(options.directory))
            fault = {"it could not be laid down durably: the disk failed", true};
    }
    if (!fault.text.empty()) fs::remove(part, ec);
    return fault;
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
    fs::remove_all(check_folder_in(directory), ec);
    std::vector<fs::path> gone;
    for (fs::directory_iterator it(directory, ec), end; !ec && it != end; it.increment(ec)) {
        const std::string name = it->path().filename().string();
        if (name == "restore-at-start.part" || name.starts_with(download_name)) gone.push_back(it->path());
    }
    for (const auto& path : gone)
        fs::remove(path, ec);
}

std::string take_waiting_backup(const StoreOptions& options) {
    const std::string file = file_in(options.directory);
    std::error_code ec;
    if (!fs::exists(file, ec)) return {};
    const auto done = restore_database(file, options);
    fs::remove(note_in(options.directory), ec);
    if (!done) {
        fs::rename(file, file + ".refused", ec);
        return fmt::format("the backup that was laid down cannot be taken: {}; it is kept as {}.refused, start again to go on without it",
                           done.error().text, file);
    }
    fs::remove(file, ec);
    return {};
}

}  // namespace axisgate
