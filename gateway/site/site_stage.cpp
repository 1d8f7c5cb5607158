// A step begins with begin_...() and is complete when its storage is reported. Differences are found entry by entry, by name.
#include "gateway/site/site_stage.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include "gateway/site/site_state.hpp"

namespace axisgate {
namespace json = boost::json;
std::string identity_of(std::string_view who) {
    const auto colon = who.rfind(':');
    const bool port =
        colon != std::string_view::npos && colon + 1 < who.size() &&
        std::all_of(who.begin() + static_cast<std::ptrdiff_t>(colon) + 1, who.end(), [](char c) { return c >= '0' && c <= '9'; });
    return std::string(port ? who.substr(0, colon) : who);
}

std::string_view name_of(SiteStage::State state) noexcept {
    switch (state) {
        case SiteStage::State::none:
            return "none";
        case SiteStage::State::staged:
            return "staged";
        case SiteStage::State::applying:
            return "applying";
        case SiteStage::State::applied:
            return "applied";
        case SiteStage::State::rolling_back:
            return "rolling_back";
    }
    return "none";
}

void SiteStage::clear() {
    state_ = State::none;
    site_ = {};
    by_.clear();
    base_revision_ = 0;
    confirm_by_unix_ns_ = 0;
}

std::string SiteStage::stage(Site site, std::uint64_t base_revision, std::string_view who) {
    if (busy()) return fmt::format("a site that {} applied is on trial: confirm it or roll it back first", by_);
    state_ = State::staged;
    ++id_;
    site_ = std::move(site);
    base_revision_ = base_revision;
    by_ = identity_of(who);
    return {};
}

std::string SiteStage::discard() {
    if (busy()) return fmt::format("the site that {} applied is on trial: roll it back instead", by_);
    clear();
    return {};
}

std::string SiteStage::begin_apply(std::uint64_t revision, std::uint32_t confirm_within_s, std::int64_t now_unix_ns, std::string_view who) {
    if (state_ == State::none) return "nothing is staged: stage a site first";
    if (busy()) return fmt::format("the site that {} applied is on trial already: confirm it or roll it back first", by_);
    if (revision != base_revision_)
        return fmt::format("the site has changed since this was staged: it is revision {} now, not {}; stage it again", revision,
                           base_revision_);
    if (confirm_within_s != 0 && (confirm_within_s < min_trial_s || confirm_within_s > max_trial_s))
        return fmt::format("confirm_within_s must be 0 or {} to {}", min_trial_s, max_trial_s);
    state_ = State::applying;
    by_ = identity_of(who);
    confirm_by_unix_ns_ = confirm_within_s == 0 ? 0 : now_unix_ns + std::int64_t{confirm_within_s} * 1'000'000'000;
    return {};
}

void SiteStage::applied(bool good) {
    if (state_ != State::applying) return;
    if (!good) {
        state_ = State::staged;
        confirm_by_unix_ns_ = 0;
    } else if (confirm_by_unix_ns_ == 0) {
        clear();
    } else {
        state_ = State::applied;
    }
}

std::string SiteStage::check_confirm(std::string_view who, std::int64_t now_unix_ns) const {
    if (state_ != State::applied) return "no applied site waits to be confirmed";
    if (expired(now_unix_ns)) return "the time to confirm has passed: the site is being rolled back";
    if (identity_of(who) != by_) return fmt::format("only {}, who applied the site, can confirm it", by_);
    return {};
}

std::string SiteStage::begin_roll_back() {
    if (state_ != State::applied) return "no applied site waits to be confirmed: there is nothing to roll back";
    state_ = State::rolling_back;
    return {};
}

void SiteStage::rolled_back(bool good, std::int64_t again_unix_ns) {
    if (state_ != State::rolling_back) return;
    if (good) return clear();
    state_ = State::applied;
    confirm_by_unix_ns_ = again_unix_ns;
}

namespace {
std::string key_of(const json::object& entry) {
    for (const char* k : {"name", "id"}) {
        if (const auto* v = entry.if_contains(k); v && v->is_string()) return std::string(v->get_string());
    }
    for (const char* k : {"instance", "unit"}) {
        if (const auto* v = entry.if_contains(k); v && v->is_int64()) return std::to_string(v->get_int64());
    }
    return {};
}
const json::object* find_in(const json::array& list, std::string_view key) {
    for (const auto& v : list) {
        if (v.is_object() && key_of(v.get_object()) == key) return &v.get_object();
    }
    return nullptr;
}
}  // namespace

json::array site_diff(const Site& from, const Site& to) {
    json::array out;
    const json::object a = to_json(from), b = to_json(to);
    for (const char* list : {"lines", "drives", "axes", "mappings", "modbus_units", "profiles", "assemblies"}) {
        const auto* before = a.if_contains(list);
        const auto* after = b.if_contains(list);
        const json::array none;
        const auto& old_list = before && before->is_array() ? before->get_array() : none;
        const auto& new_list = after && after->is_array() ? after->get_array() : none;
        const auto put = [&](const char* kind, std::string_view key, const json::object* x, const json::object* y) {
            out.push_back(json::object{{"kind", kind},
                                       {"what", fmt::format("{}/{}", list, key)},
                                       {"before", x ? json::value(*x) : json::value()},
                                       {"after", y ? json::value(*y) : json::value()}});
        };
        for (const auto& v : old_list) {
            const auto& x = v.get_object();
            const auto* y = find_in(new_list, key_of(x));
            if (!y)
                put("removed", key_of(x), &x, nullptr);
            else if (*y != x)
                put("changed", key_of(x), &x, y);
        }
        for (const auto& v : new_list) {
            const auto& y = v.get_object();
            if (!find_in(old_list, key_of(y))) put("added", key_of(y), nullptr, &y);
        }
    }
    return out;
}

SiteState as_if_in_force(const SiteState& now, Site wanted) {
    SiteState s;
    s.revision = now.revision;
    const auto ids = [](const auto& before, const auto& known, const auto& after, auto& out, auto none) {
        using Id = decltype(none);
        std::map<std::string_view, Id> by_name;
        for (std::size_t i = 0; i < before.size() && i < known.size(); ++i)
            by_name.emplace(before[i].name, known[i]);
        std::uint16_t fresh = index_of(none);
        for (const auto& entry : after) {
            const auto at = by_name.find(entry.name);
            out.push_back(at != by_name.end() ? at->second : Id{--fresh});
        }
    };
    ids(now.site.axes, now.axis_ids, wanted.axes, s.axis_ids, no_axis);
    ids(now.site.drives, now.drive_ids, wanted.drives, s.drive_ids, no_drive);
    ids(now.site.lines, now.line_ids, wanted.lines, s.line_ids, no_line);
    s.site = std::move(wanted);
    return s;
}

std::vector<std::string> disturbed_axes(const Site& from, const Site& to) {
    const KeptParts kept{from, to};
    std::vector<std::string> out;
    for (const auto& a : from.axes) {
        if (!kept.axis(a)) out.push_back(a.name);
    }
    return out;
}

}  // namespace axisgate
