// A small JSON document in the data directory. An unreadable one is ignored.
#include "gateway/runtime/restore_note.hpp"

#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/json/object.hpp>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <filesystem>

#include "gateway/runtime/files.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;
constexpr std::size_t restore_note_most = 4096;
std::string file_in(const std::string& directory) { return directory + "/restored.json"; }
}  // namespace

std::string leave_restore_note(const std::string& directory, const RestoreNote& n) {
    const json::object document{{"who", n.who},
                                {"at_unix_ns", n.at_unix_ns},
                                {"replaced_revision", n.replaced_revision},
                                {"restored_revision", n.restored_revision}};
    const std::string file = file_in(directory);
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    if (std::string why = write_secret(file, json::serialize(document)); !why.empty())
        return fmt::format("cannot write {}: {}; the next start will not tell of the restore", file, why);
    struct stat of_folder {};
    if (::geteuid() == 0 && ::stat(directory.c_str(), &of_folder) == 0) {
        [[maybe_unused]] const int r = ::chown(file.c_str(), of_folder.st_uid, of_folder.st_gid);
    }
    return {};
}

std::optional<Event> take_restore_note(const std::string& directory) {
    std::string none;
    const std::string file = file_in(directory);
    const auto text = read_file(file, none, restore_note_most);
    if (!text) return std::nullopt;
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    boost::system::error_code wrong;
    const auto note = json::parse(*text, wrong);
    if (wrong || !note.is_object()) return std::nullopt;
    const auto number = [&note](const char* key) {
        const auto* v = note.get_object().if_contains(key);
        return v && v->is_number() ? v->to_number<std::int64_t>() : std::int64_t{0};
    };
    Event e;
    e.severity = Severity::warning;
    e.kind = "restore";
    e.at_unix_ns = number("at_unix_ns");
    if (const auto* who = note.get_object().if_contains("who"); who && who->is_string()) e.who = who->get_string();
    const auto old = number("replaced_revision"), now = number("restored_revision");
    if (old != 0) e.old_value = fmt::format("{}", old);
    if (now != 0) e.new_value = fmt::format("{}", now);
    e.text = fmt::format("a backup took the place of the database: site revision {} instead of {}; {}", now == 0 ? "none" : e.new_value,
                         old == 0 ? "none" : e.old_value, restore_warning);
    return e;
}

}  // namespace axisgate
