// The mark is on the disk before the site is: a mark without a newer site means that nothing was applied. The former site becomes the
// newest revision, or, if it is not stored any more, an event says so.
#include "gateway/runtime/site_trial.hpp"

#include <fmt/core.h>

#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>

#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/site_names.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
constexpr std::string_view mark_kind = "site_stage", mark_name = "trial";

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
    // The mark is on the disk before the site is: without a newer site, nothing was applied.
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
            const auto saved = store.save_site(text, "rolled back at start", unix_now_ns(),
                                               names_between(json::parse((*now)->text, ec), json::parse(text, ec)));
            if (!saved) return saved.error().text;
            e.text = fmt::format(
                "revision {} was applied by {} and not confirmed before the gateway ended: rolled back to revision {}, which is {} now",
                (*now)->revision, (*mark)->who, to, *saved);
        }
        const Event events[] = {e};
        if (const auto kept = store.append_events(events); !kept) return kept.error().text;
    }
    const auto gone = unmark_trial(store);
    return gone ? std::string() : gone.error().text;
}

}  // namespace axisgate
