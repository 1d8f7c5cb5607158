// Stores changed alarms in batches, one batch at a time, each with the number of the last event that it includes. An acknowledgement is
// answered only when it is stored.
#include "gateway/services/alarms/alarm_service.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/array.hpp>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>

#include "gateway/core/text.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
const std::string kind = "alarm";
const std::string seen_name = "seen";  // not a number, so not the name of an alarm

std::string name_of_document(std::uint64_t id) { return fmt::format("{:016}", id); }

json::value time_or_null(std::int64_t unix_ns) { return unix_ns == 0 ? json::value(nullptr) : json::value(format_time(unix_ns)); }

json::object kept_form(const Alarm& a) {
    return {{"id", a.id},
            {"axis", a.axis},
            {"drive", a.drive},
            {"line", a.line},
            {"kind", a.kind},
            {"code", a.code},
            {"text", a.text},
            {"severity", static_cast<int>(a.severity)},
            {"active", a.active},
            {"acknowledged", a.acknowledged},
            {"since", a.since_unix_ns},
            {"cleared", a.cleared_unix_ns},
            {"acknowledged_by", a.acknowledged_by},
            {"comment", a.comment},
            {"acknowledged_at", a.acknowledged_unix_ns},
            {"shelved_until", a.shelved_until_unix_ns},
            {"shelved_by", a.shelved_by},
            {"reason", a.reason},
            {"count", a.count}};
}

std::optional<Alarm> read_kept(const std::string& text) {
    boost::system::error_code ec;
    const auto v = json::parse(text, ec);
    if (ec || !v.is_object()) return std::nullopt;
    const auto& o = v.get_object();
    const auto whole = [&](std::string_view key) -> std::int64_t {
        const auto* x = o.if_contains(key);
        boost::system::error_code bad;
        const auto n = x ? x->to_number<std::int64_t>(bad) : 0;
        return bad ? 0 : n;
    };
    const auto text_of = [&](std::string_view key) {
        const auto* x = o.if_contains(key);
        return x && x->is_string() ? std::string(x->get_string()) : std::string();
    };
    const auto flag = [&](std::string_view key) {
        const auto* x = o.if_contains(key);
        return x && x->is_bool() && x->get_bool();
    };
    Alarm a;
    a.id = static_cast<std::uint64_t>(whole("id"));
    a.axis = text_of("axis");
    a.drive = text_of("drive");
    a.line = text_of("line");
    a.kind = text_of("kind");
    a.code = static_cast<std::int32_t>(whole("code"));
    a.text = text_of("text");
    a.severity = static_cast<Severity>(std::clamp<std::int64_t>(whole("severity"), 0, 2));
    a.active = flag("active");
    a.acknowledged = flag("acknowledged");
    a.since_unix_ns = whole("since");
    a.cleared_unix_ns = whole("cleared");
    a.acknowledged_by = text_of("acknowledged_by");
    a.comment = text_of("comment");
    a.acknowledged_unix_ns = whole("acknowledged_at");
    a.shelved_until_unix_ns = whole("shelved_until");
    a.shelved_by = text_of("shelved_by");
    a.reason = text_of("reason");
    a.count = static_cast<std::uint64_t>(std::max<std::int64_t>(1, whole("count")));
    if (a.id == 0) return std::nullopt;
    return a;
}

std::string subject(const Alarm& a) { return !a.axis.empty() ? a.axis : !a.drive.empty() ? a.drive : a.line; }
}  // namespace

json::object alarm_document(const Alarm& a) {
    return {{"id", a.id},
            {"axis", text_or_null(a.axis)},
            {"drive", text_or_null(a.drive)},
            {"line", text_or_null(a.line)},
            {"kind", a.kind},
            {"code", a.code == 0 ? json::value(nullptr) : json::value(a.code)},
            {"text", a.text},
            {"severity", name_of(a.severity)},
            {"state", name_of(a.state())},
            {"active", a.active},
            {"acknowledged", a.acknowledged},
            {"since", format_time(a.since_unix_ns)},
            {"cleared_at", time_or_null(a.cleared_unix_ns)},
            {"acknowledged_by", text_or_null(a.acknowledged_by)},
            {"acknowledged_at", time_or_null(a.acknowledged_unix_ns)},
            {"comment", text_or_null(a.comment)},
            {"shelved_until", time_or_null(a.shelved_until_unix_ns)},
            {"shelved_by", text_or_null(a.shelved_by)},
            {"reason", text_or_null(a.reason)},
            {"count", a.count}};
}

AlarmService::AlarmService(const Needs& ports, std::function<Instant()> clock)
    : wall_(ports.get<ClockPort>()),
      documents_(ports.get<DocumentPort>()),
      events_(ports.get<EventPort>()),
      sites_(ports.get<SitePort>()),
      clock_(std::move(clock)) {}
AlarmService::~AlarmService() { detach(); }

void AlarmService::begin() {
    bool known_before = false;
    for (const auto& d : documents_.documents(kind)) {
        if (d.name == seen_name) {
            seen_ = static_cast<std::uint64_t>(parse_whole(d.text, 0, INT64_MAX).value_or(0));
            known_before = true;
        } else if (auto a = read_kept(d.text)) {
            list_.restore(std::move(*a));
        }
    }
    EventQuery query;
    query.since_id = seen_;
    query.limit = known_before ? 1000 : 1;
    for (const auto& e : events_.events(query)) {
        // A data directory from before the alarms were introduced: its old events raise no alarms.
        if (known_before) list_.on_event(e);
        seen_ = std::max(seen_, e.id);
    }
    list_.on_start(wall_.now_unix_ns());
    events_.listen(this);
    sites_.listen(this);
    attached_ = true;
    if (!known_before) waiting_.push_back([](const std::string&) {});  // from here on new events are known
    changed();
}

void AlarmService::detach() {
    if (attached_) {
        events_.unlisten(this);
        sites_.unlisten(this);
    }
    attached_ = false;
    rearm = nullptr;
    publish = nullptr;
    waiting_.clear();
}

json::object AlarmService::document(std::optional<AlarmFilter> only) const {
    std::vector<const Alarm*> sorted;
    for (const auto& [id, a] : list_.all()) {
        if (!only || fits(a, *only)) sorted.push_back(&a);
    }
    std::ranges::sort(sorted, [](const Alarm* a, const Alarm* b) {
        if (a->state() != b->state()) return a->state() < b->state();
        if (a->since_unix_ns != b->since_unix_ns) return a->since_unix_ns > b->since_unix_ns;
        return a->id > b->id;
    });
    json::array alarms;
    for (const auto* a : sorted)
        alarms.push_back(alarm_document(*a));
    return {{"unacknowledged", list_.unacknowledged()}, {"dropped", list_.dropped()}, {"alarms", std::move(alarms)}};
}

std::vector<std::uint64_t> AlarmService::open() const {
    std::vector<std::uint64_t> ids;
    for (const auto& [id, a] : list_.all()) {
        if (fits(a, AlarmFilter::unacknowledged)) ids.push_back(id);
    }
    return ids;
}

std::string AlarmService::acknowledge(const std::vector<std::uint64_t>& ids, const std::string& comment, const Origin& origin, Then then) {
    if (busy()) return "too many answers wait for the disk: come again in a moment";
    const std::string who = origin.who ? *origin.who : "";
    // All or none, so the change is made on a copy first.
    AlarmList trial = list_;
    for (const auto id : ids) {
        if (auto fault = trial.acknowledge(id, who, comment, wall_.now_unix_ns()); !fault.empty()) return fault;
    }
    for (const auto id : ids) {
        const Alarm before = *list_.find(id);
        (void)list_.acknowledge(id, who, comment, wall_.now_unix_ns());
        note(before, comment.empty() ? "acknowledged" : fmt::format("acknowledged: {}", comment), origin);
    }
    waiting_.push_back(std::move(then));
    changed();
    return {};
}

std::string AlarmService::shelve(std::uint64_t id, std::int64_t for_s, const std::string& reason, const Origin& origin, Then then) {
    if (busy()) return "too many answers wait for the disk: come again in a moment";
    if (auto fault = list_.shelve(id, for_s, origin.who ? *origin.who : "", reason, wall_.now_unix_ns()); !fault.empty()) return fault;
    note(*list_.find(id), fmt::format("shelved for {} s: {}", for_s, reason), origin);
    waiting_.push_back(std::move(then));
    changed();
    return {};
}

std::string AlarmService::unshelve(std::uint64_t id, const Origin& origin, Then then) {
    if (busy()) return "too many answers wait for the disk: come again in a moment";
    const auto* a = list_.find(id);
    const Alarm before = a ? *a : Alarm{};
    if (auto fault = list_.unshelve(id); !fault.empty()) return fault;
    note(before, "taken back from the shelf", origin);
    waiting_.push_back(std::move(then));
    changed();
    return {};
}

void AlarmService::note(const Alarm& a, const std::string& what, const Origin& origin) {
    Event e;
    e.kind = "alarm";
    e.axis = a.axis;
    e.drive = a.drive;
    e.line = a.line;
    e.code = a.code;
    e.text = fmt::format("alarm {} of {} ({}) {}", a.id, subject(a), a.text, what);
    e.who = origin.who ? *origin.who : "";
    e.door = std::string(name_of(origin.door));
    events_.note(std::move(e));
}

void AlarmService::on_event(const Event& event) {
    seen_ = std::max(seen_, event.id);
    if (list_.on_event(event)) changed();
}

void AlarmService::on_site(const std::shared_ptr<const SiteState>& site) {
    if (list_.on_site(site->site, wall_.now_unix_ns())) changed();
}

void AlarmService::changed() {
    unsaved_.merge(list_.take_changed());
    unpublished_ = true;
    keep();
    if (rearm) rearm();
}

/// One batch at a time: the changes, and the last event that they include. The waiting callers are answered when all of it is on the disk.
struct AlarmService::Batch {
    std::size_t left = 0;
    std::string fault;
    std::vector<Then> waiting;
};

void AlarmService::keep() {
    if (saving_ || (unsaved_.empty() && waiting_.empty())) return;
    saving_ = true;
    const auto ids = std::exchange(unsaved_, {});
    auto batch = std::make_shared<Batch>();
    batch->left = ids.size() + 1;
    batch->waiting = std::exchange(waiting_, {});
    auto done = [self = weak_from_this(), batch](const std::string& fault) {
        if (batch->fault.empty()) batch->fault = fault;
        if (--batch->left > 0) return;
        for (const auto& then : batch->waiting)
            then(batch->fault);
        const auto me = self.lock();
        if (!me || !me->attached_) return;
        me->saving_ = false;
        if (!batch->fault.empty() && !std::exchange(me->fault_published_, true)) {
            Event e;
            e.severity = Severity::warning;
            e.kind = "store";
            e.text = fmt::format("alarms are not stored: {}; after a restart what was done since is missing", batch->fault);
            me->events_.note(std::move(e));
        }
        if (batch->fault.empty()) me->fault_published_ = false;
        me->keep();
    };
    const auto now = wall_.now_unix_ns();
    for (const auto id : ids) {
        if (const auto* a = list_.find(id)) {
            documents_.save_document(kind, {name_of_document(id), json::serialize(kept_form(*a)), a->acknowledged_by, now}, done);
        } else {
            documents_.delete_document(kind, name_of_document(id),
                                       [done](const std::string&) { done({}); });  // the document may never have been stored
        }
    }
    documents_.save_document(kind, {seen_name, std::to_string(seen_), "", now}, done);
}

Instant AlarmService::deadline() const {
    Instant next = unpublished_ ? std::max(published_ + publish_period, time_zero) : never;
    if (const auto due = list_.deadline()) {
        // At most a minute, because the wall clock may be set meanwhile.
        const auto rest = std::clamp<std::int64_t>(*due - wall_.now_unix_ns(), 0, 60'000'000'000);
        next = std::min(next, clock_() + std::chrono::nanoseconds(rest));
    }
    return next;
}

void AlarmService::on_deadline(Instant now) {
    if (list_.on_time(wall_.now_unix_ns())) changed();
    if (!unpublished_ || now < published_ + publish_period) return;
    unpublished_ = false;
    published_ = now;
    if (publish) publish(document());
}

}  // namespace axisgate
