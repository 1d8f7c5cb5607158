// Several reports of one fault of an axis are one alarm. When another side begins to serve a drive, its alarms must occur again within a
// time. The end of one drive's fault never clears the alarm of another.
#include "gateway/services/alarms/alarm.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <vector>

namespace axisgate {
namespace {
/// True for alarms of an axis that exist only while its drive is in fault and end with the fault.
bool ends_with_fault(const Alarm& a) { return !a.axis.empty() && a.kind != "not_stored"; }

/// True for reports of the drive itself, in addition to its fault; reports of the gateway are alarms of their own.
bool from_drive(const std::string& kind) { return kind != "fault" && kind != "not_stored" && kind != "site"; }

constexpr std::size_t most_text = 400;
void add_text(std::string& text, const std::string& more) {
    if (text.find(more) == std::string::npos && text.size() + more.size() < most_text) text += fmt::format("; also: {}", more);
}

bool same(const Alarm& a, const Event& e) {
    if (a.kind != e.kind || a.code != e.code || a.axis != e.axis) return false;
    if (!a.axis.empty()) return true;
    return a.drive == e.drive && (!a.drive.empty() || a.line == e.line);
}

/// A line that is down and a silent drive are warnings as events, because they may be intended; while they last they are on the list.
bool is_loss(const Event& e) { return e.severity != Severity::info && (e.kind == "line" || e.kind == "drive"); }

template <class List>
bool has_name(const List& list, const std::string& name) {
    return name.empty() || std::ranges::any_of(list, [&](const auto& x) { return x.name == name; });
}
}  // namespace

std::string_view name_of(AlarmState state) noexcept {
    switch (state) {
        case AlarmState::unacknowledged_active:
            return "unacknowledged_active";
        case AlarmState::acknowledged_active:
            return "acknowledged_active";
        case AlarmState::unacknowledged_cleared:
            return "unacknowledged_cleared";
        case AlarmState::shelved:
            return "shelved";
    }
    return "";
}

AlarmState Alarm::state() const noexcept {
    if (shelved_until_unix_ns != 0) return AlarmState::shelved;
    if (!active) return AlarmState::unacknowledged_cleared;
    return acknowledged ? AlarmState::acknowledged_active : AlarmState::unacknowledged_active;
}

std::optional<AlarmFilter> alarm_filter_named(std::string_view word) noexcept {
    static constexpr std::array<std::string_view, 5> names{"active", "cleared", "unacknowledged", "acknowledged", "shelved"};
    const auto it = std::ranges::find(names, word);
    if (it == names.end()) return std::nullopt;
    return static_cast<AlarmFilter>(it - names.begin());
}

bool fits(const Alarm& a, AlarmFilter filter) noexcept {
    const bool on_shelf = a.shelved_until_unix_ns != 0;
    switch (filter) {
        case AlarmFilter::active:
            return a.active;
        case AlarmFilter::cleared:
            return !a.active;
        case AlarmFilter::unacknowledged:
            return !a.acknowledged && !on_shelf;
        case AlarmFilter::acknowledged:
            return a.acknowledged;
        case AlarmFilter::shelved:
            return on_shelf;
    }
    return false;
}

void AlarmList::restore(Alarm alarm) {
    if (alarms_.size() < most_alarms) alarms_.insert_or_assign(alarm.id, std::move(alarm));
}

const Alarm* AlarmList::find(std::uint64_t id) const {
    const auto it = alarms_.find(id);
    return it == alarms_.end() ? nullptr : &it->second;
}

std::size_t AlarmList::unacknowledged() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(alarms_, [](const auto& a) { return fits(a.second, AlarmFilter::unacknowledged); }));
}

bool AlarmList::fault_active(const std::string& axis) const {
    return std::ranges::any_of(alarms_,
                               [&](const auto& a) { return a.second.active && a.second.kind == "fault" && a.second.axis == axis; });
}

bool AlarmList::on_event(const Event& e) {
    const auto clear_where = [&](auto&& wanted) {
        std::vector<std::uint64_t> ids;
        for (const auto& [id, a] : alarms_) {
            if (a.active && wanted(a)) ids.push_back(id);
        }
        for (const auto id : ids)
            clear(alarms_.at(id), e.at_unix_ns);
        return !ids.empty();
    };
    if (e.kind == "fault_cleared") return clear_where([&](const Alarm& a) { return a.axis == e.axis && ends_with_fault(a); });
    if (e.kind == "line" && e.severity == Severity::info)
        return clear_where([&](const Alarm& a) { return a.kind == "line" && a.line == e.line; });
    if (e.kind == "drive" && e.severity == Severity::info)
        return clear_where([&](const Alarm& a) { return a.kind == "drive" && a.drive == e.drive; });
    if (e.kind == "presence" && !e.drive.empty()) {
        // Another side serves the drive: it is unknown whether the alarms of the former one are over, but they must occur again.
        bool any = false;
        for (auto& [id, a] : alarms_) {
            if (!a.active || a.drive != e.drive || !ends_with_fault(a)) continue;
            a.doubtful_until_unix_ns = e.at_unix_ns + settle_ns;
            changed_.insert(id);
            any = true;
        }
        if (e.new_value != "device") return any;
        return clear_where([&](const Alarm& a) { return a.kind == "drive" && a.drive == e.drive; }) || any;
    }
    if (e.severity != Severity::alarm && !is_loss(e)) return false;
    // An alarm without an opposite event is raised and cleared at once and waits for its acknowledgement. If the drive reports a fault that
    // is on the list already, this is the same alarm.
    const auto known = [&](const auto& a) {
        return a.second.active && a.second.kind == "fault" && a.second.axis == e.axis && a.second.code == e.code;
    };
    if (!e.axis.empty() && e.kind != "fault" && e.code != 0 && std::ranges::any_of(alarms_, known)) return false;
    if (joins_fault(e)) return true;
    const bool part_of_fault = !e.axis.empty() && e.kind != "not_stored" && fault_active(e.axis);
    raise(e, !is_loss(e) && e.kind != "fault" && !part_of_fault);
    return true;
}

/// A report that follows from an unacknowledged fault adds its text to the alarm of the fault.
bool AlarmList::joins_fault(const Event& e) {
    if (e.axis.empty() || !from_drive(e.kind)) return false;
    for (auto it = alarms_.rbegin(); it != alarms_.rend(); ++it) {
        Alarm& a = it->second;
        if (!a.active || a.kind != "fault" || a.axis != e.axis || a.state() != AlarmState::unacknowledged_active) continue;
        if (e.at_unix_ns - a.since_unix_ns > together_ns) continue;
        add_text(a.text, e.text);
        changed_.insert(a.id);
        return true;
    }
    return false;
}

/// Removes alarms that the axis reported just before its fault and that nobody has acknowledged; returns their texts for the alarm of the
/// fault.
std::string AlarmList::take_forerunners(const Event& fault) {
    std::string text;
    for (auto it = alarms_.begin(); it != alarms_.end();) {
        const Alarm& a = it->second;
        const bool before = !fault.axis.empty() && a.axis == fault.axis && from_drive(a.kind) && a.count == 1 &&
                            a.state() == AlarmState::unacknowledged_cleared && a.cleared_unix_ns == a.since_unix_ns &&
                            fault.at_unix_ns - a.since_unix_ns <= together_ns;
        if (before) {
            if (text.empty())
                text = a.text;
            else
                add_text(text, a.text);
            changed_.insert(a.id);
        }
        it = before ? alarms_.erase(it) : std::next(it);
    }
    return text;
}

void AlarmList::raise(const Event& e, bool momentary) {
    const std::string forerunners = e.kind == "fault" ? take_forerunners(e) : "";
    const auto known = std::ranges::find_if(alarms_, [&](const auto& a) { return same(a.second, e); });
    if (known == alarms_.end()) {
        if (alarms_.size() >= most_alarms) {
            auto oldest = alarms_.end();
            for (auto it = alarms_.begin(); it != alarms_.end(); ++it) {
                if (!it->second.active && (oldest == alarms_.end() || it->second.cleared_unix_ns < oldest->second.cleared_unix_ns))
                    oldest = it;
            }
            if (oldest == alarms_.end()) {
                ++dropped_;
                return;
            }
            changed_.insert(oldest->first);
            alarms_.erase(oldest);
        }
        Alarm a;
        a.id = e.id;
        a.axis = e.axis;
        a.drive = e.drive;
        a.line = e.line;
        a.kind = e.kind;
        a.code = e.code;
        a.text = e.text;
        a.severity = e.severity;
        a.since_unix_ns = e.at_unix_ns;
        a.active = !momentary;
        a.cleared_unix_ns = momentary ? e.at_unix_ns : 0;
        if (!forerunners.empty()) add_text(a.text, forerunners);
        changed_.insert(a.id);
        alarms_.emplace(a.id, std::move(a));
        return;
    }
    Alarm& a = known->second;
    // The alarm occurs again after a change of the serving side or a start of the gateway: it is the same alarm.
    const bool goes_on = a.doubtful_until_unix_ns != 0;
    a.doubtful_until_unix_ns = 0;
    a.text = e.text;
    if (!forerunners.empty()) add_text(a.text, forerunners);
    a.severity = e.severity;
    if (!goes_on) ++a.count;
    if (!a.active) {
        a.since_unix_ns = e.at_unix_ns;
        a.acknowledged = false;
        a.acknowledged_unix_ns = 0;
        a.acknowledged_by.clear();
        a.comment.clear();
        a.active = !momentary;
        a.cleared_unix_ns = momentary ? e.at_unix_ns : 0;
    }
    changed_.insert(a.id);
}

void AlarmList::clear(Alarm& a, std::int64_t now_unix_ns) {
    a.active = false;
    a.cleared_unix_ns = now_unix_ns;
    a.doubtful_until_unix_ns = 0;
    changed_.insert(a.id);
    settle(a.id);
}

/// A cleared and acknowledged alarm leaves the list. A shelf keeps it until its end, so that it stays quiet if it occurs again.
void AlarmList::settle(std::uint64_t id) {
    const auto it = alarms_.find(id);
    if (it != alarms_.end() && !it->second.active && it->second.acknowledged && it->second.shelved_until_unix_ns == 0) alarms_.erase(it);
}

void AlarmList::on_start(std::int64_t now_unix_ns) {
    for (auto& [id, a] : alarms_) {
        // A line reports when it is up; a drive stays silent without reporting this again.
        if (a.active && a.kind != "drive" && a.kind != "line") a.doubtful_until_unix_ns = now_unix_ns + settle_ns;
    }
}

bool AlarmList::on_site(const Site& site, std::int64_t now_unix_ns) {
    std::vector<std::uint64_t> gone;
    for (const auto& [id, a] : alarms_) {
        if (a.active && !(has_name(site.axes, a.axis) && has_name(site.drives, a.drive) && has_name(site.lines, a.line)))
            gone.push_back(id);
    }
    for (const auto id : gone)
        clear(alarms_.at(id), now_unix_ns);
    return !gone.empty();
}

bool AlarmList::on_time(std::int64_t now_unix_ns) {
    std::vector<std::uint64_t> due;
    for (const auto& [id, a] : alarms_) {
        const bool shelf = a.shelved_until_unix_ns != 0 && a.shelved_until_unix_ns <= now_unix_ns;
        const bool doubt = a.doubtful_until_unix_ns != 0 && a.doubtful_until_unix_ns <= now_unix_ns;
        if (shelf || doubt) due.push_back(id);
    }
    for (const auto id : due) {
        Alarm& a = alarms_.at(id);
        if (a.shelved_until_unix_ns != 0 && a.shelved_until_unix_ns <= now_unix_ns) (void)unshelve(id);
        const auto it = alarms_.find(id);
        if (it == alarms_.end()) continue;
        if (it->second.doubtful_until_unix_ns != 0 && it->second.doubtful_until_unix_ns <= now_unix_ns) clear(it->second, now_unix_ns);
    }
    return !due.empty();
}

std::optional<std::int64_t> AlarmList::deadline() const {
    std::optional<std::int64_t> next;
    for (const auto& [id, a] : alarms_) {
        for (const auto at : {a.shelved_until_unix_ns, a.doubtful_until_unix_ns}) {
            if (at != 0) next = std::min(next.value_or(at), at);
        }
    }
    return next;
}

std::string AlarmList::acknowledge(std::uint64_t id, std::string who, std::string comment, std::int64_t now_unix_ns) {
    const auto it = alarms_.find(id);
    if (it == alarms_.end()) return fmt::format("there is no alarm {}", id);
    Alarm& a = it->second;
    if (a.shelved_until_unix_ns != 0) return fmt::format("alarm {} is shelved: take it back from the shelf first", id);
    if (a.acknowledged) return fmt::format("alarm {} is acknowledged already, by {}", id, a.acknowledged_by);
    a.acknowledged = true;
    a.acknowledged_by = std::move(who);
    a.comment = std::move(comment);
    a.acknowledged_unix_ns = now_unix_ns;
    changed_.insert(id);
    settle(id);
    return {};
}

std::string AlarmList::shelve(std::uint64_t id, std::int64_t for_s, std::string who, std::string reason, std::int64_t now_unix_ns) {
    const auto it = alarms_.find(id);
    if (it == alarms_.end()) return fmt::format("there is no alarm {}", id);
    if (for_s < least_shelf_s || for_s > most_shelf_s)
        return fmt::format("an alarm is shelved for {} to {} s, not {}", least_shelf_s, most_shelf_s, for_s);
    it->second.shelved_until_unix_ns = now_unix_ns + for_s * 1'000'000'000;
    it->second.shelved_by = std::move(who);
    it->second.reason = std::move(reason);
    changed_.insert(id);
    return {};
}

std::string AlarmList::unshelve(std::uint64_t id) {
    const auto it = alarms_.find(id);
    if (it == alarms_.end()) return fmt::format("there is no alarm {}", id);
    if (it->second.shelved_until_unix_ns == 0) return fmt::format("alarm {} is not shelved", id);
    it->second.shelved_until_unix_ns = 0;
    it->second.shelved_by.clear();
    it->second.reason.clear();
    changed_.insert(id);
    settle(id);
    return {};
}

}  // namespace axisgate
