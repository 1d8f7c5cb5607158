// Site trial: see the header. In and out: see the header.
#include "gateway/runtime/site_trial.hpp"

#include <fmt/format.h>

#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <filesystem>

#include "gateway/runtime/clock.hpp"
#include "gateway/store/backup.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
constexpr std::string_view mark_kind = "site_stage", mark_name = "trial";

SiteChange names_in(const json::value& document) {
    SiteChange change;
    change.axes.emplace();
    change.drives.emplace();
    const auto names = [&](const char* list, std::vector<std::string>& out) {
        const auto* all = document.is_object() ? document.get_object().if_contains(list) : nullptr;
        if (!all || !all->is_array()) return;
        for (const auto& v : all->get_array()) {
            const auto* n = v.is_object() ? v.get_object().if_contains("name") : nullptr;
            if (n && n->is_string()) out.emplace_back(n->get_string());
        }
    };
    names("axes", *change.axes);
    names("drives", *change.drives);
    return change;
}
}  // namespace

StoreResult<> mark_trial(Store& store, std::uint64_t roll_back_to, std::string_view who, std::int64_t confirm_by_unix_ns,
                         std::int64_t now_unix_ns) {
    StoreDocument d;
    d.kind = mark_kind;
    d.name = mark_name;
    d.text = json::serialize(json::object{{"roll_back_to", roll_back_to}, {"confirm_by", confirm_by_unix_ns}});
    d.who = who;
    d.at_unix_ns = now_unix_ns;
    return store.save_document(d);
}

StoreResult<> unmark_trial(Store& store) { return store.delete_document(mark_kind, mark_name); }

SiteChange names_of(const Site& site) { return names_in(to_json(site)); }

std::string end_trial(Store& store, bool roll_back) {
    const auto mark = store.document(mark_kind, mark_name);
    if (!mark) return mark.error().text;
    if (!*mark) return {};
    std::uint64_t to = 0;
    boost::system::error_code ec;
    const auto value = json::parse((*mark)->text, ec);
    const auto* n = !ec && value.is_object() ? value.get_object().if_contains("roll_back_to") : nullptr;
    if (n && n->is_number()) to = n->to_number<std::uint64_t>(ec);
    const auto now = store.load_site();
    if (!now) return now.error().text;
    // The mark is on disk before the site is: without a newer site, nothing was applied.
    if (roll_back && n && *now && (*now)->revision != to) {
        std::string text;
        if (to == 0) {
            text = json::serialize(to_json(Site{}));
        } else {
            const auto before = store.site(to);
            if (!before) return before.error().text;
            if (*before) text = (*before)->text;
        }
        Event e;
        e.kind = "site";
        e.severity = Severity::warning;
        e.at_unix_ns = unix_now_ns();
        e.who = (*mark)->who;
        e.door = name_of(Door::internal);
        if (text.empty()) {
            e.text = fmt::format("revision {} was applied by {} and not confirmed, but revision {} is not kept any more: it stays in force",
                                 (*now)->revision, (*mark)->who, to);
        } else {
            const auto saved = store.save_site(text, "rolled back at start", unix_now_ns(), names_in(json::parse(text, ec)));
            if (!saved) return saved.error().text;
            e.text = fmt::format(
                "revision {} was applied by {} and not confirmed before the gateway ended: rolled back to revision {}, which is {} now",
                (*now)->revision, (*mark)->who, to, *saved);
        }
        const Event events[] = {e};
        if (const auto told = store.append_events(events); !told) return told.error().text;
    }
    const auto gone = unmark_trial(store);
    return gone ? std::string() : gone.error().text;
}

std::string laid_down_backup(const std::string& directory) { return directory + "/restore-at-start.db"; }

std::string take_laid_down_backup(const StoreOptions& options) {
    const std::string file = laid_down_backup(options.directory);
    std::error_code ec;
    if (!std::filesystem::exists(file, ec)) return {};
    const auto done = restore_database(file, options);
    if (!done) {
        std::filesystem::rename(file, file + ".refused", ec);
        return fmt::format("the backup that was laid down cannot be taken: {}; it is kept as {}.refused, start again to go on without it",
                           done.error().text, file);
    }
    std::filesystem::remove(file, ec);
    return {};
}

}  // namespace axisgate
