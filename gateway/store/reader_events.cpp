// Reads events by any combination of filters, in order of id. The text of a filter is never put into SQL: the combinations are a fixed
// table of statements whose values are bound.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>

#include "gateway/store/reader.hpp"

namespace axisgate {
namespace {

struct Mix {
    bool axis, kind, time, oldest_first;
    unsigned severity;  // 0: any, 1: warnings and alarms, 2: alarms
    [[nodiscard]] std::size_t place() const { return (((axis * 2u + kind) * 2u + time) * 2u + oldest_first) * 3u + severity; }
};

std::string sql_of(const Mix& m) {
    std::string sql =
        "SELECT id, at_unix_ns, severity, kind, axis, drive, line, code, text, who, door, parameter, old_value, new_value FROM event "
        "WHERE ";
    // Ids and times increase together except for steps of the clock: the first id of that time limits the search, the time itself decides.
    // There is only one lower bound, because SQLite would start from the first of two.
    sql += m.time ? "id > max(?1, ifnull((SELECT min(+id) - 1 FROM event INDEXED BY event_by_time WHERE at_unix_ns >= ?5), ?2)) AND "
                    "at_unix_ns >= ?5"
                  : "id > ?1";
    sql += " AND id < ?2";
    // The literal lets SQLite use the index of serious events, and the non-empty axis the index of axes.
    if (m.severity != 0) sql += " AND severity >= 1";
    if (m.severity == 2) sql += " AND severity >= 2";
    if (m.axis) sql += " AND axis = ?3 AND axis <> ''";
    if (m.kind) sql += " AND kind = ?4";
    sql += m.oldest_first ? " ORDER BY id LIMIT ?6" : " ORDER BY id DESC LIMIT ?6";
    return sql;
}

const std::array<std::string, 48>& statements() {
    static const std::array<std::string, 48> all = [] {
        std::array<std::string, 48> a;
        for (unsigned i = 0; i < 16; ++i) {
            for (unsigned severity = 0; severity < 3; ++severity) {
                const Mix m{(i & 8u) != 0, (i & 4u) != 0, (i & 2u) != 0, (i & 1u) != 0, severity};
                a[m.place()] = sql_of(m);
            }
        }
        return a;
    }();
    return all;
}

std::int64_t bounded(std::uint64_t id) {
    return static_cast<std::int64_t>(std::min<std::uint64_t>(id, std::numeric_limits<std::int64_t>::max()));
}

Event event_of(const Query& q) {
    Event e;
    e.id = static_cast<std::uint64_t>(q.integer(0));
    e.at_unix_ns = q.integer(1);
    e.severity = static_cast<Severity>(q.integer(2));
    e.kind = q.text(3);
    e.axis = q.text(4);
    e.drive = q.text(5);
    e.line = q.text(6);
    e.code = static_cast<std::int32_t>(q.integer(7));
    e.text = q.text(8);
    e.who = q.text(9);
    e.door = q.text(10);
    e.parameter = q.text(11);
    e.old_value = q.text(12);
    e.new_value = q.text(13);
    return e;
}

}  // namespace

StoreResult<std::vector<Event>> StoreReader::events(const EventFilter& f) {
    const Mix mix{!f.axis.empty(), !f.kind.empty(), f.since_unix_ns != 0, f.oldest_first,
                  f.at_least ? static_cast<unsigned>(*f.at_least) : 0u};
    Query q(*db_, statements()[mix.place()].c_str());
    q.bind(bounded(f.since_id)).bind(f.before_id == 0 ? std::numeric_limits<std::int64_t>::max() : bounded(f.before_id));
    q.bind(f.axis).bind(f.kind).bind(f.since_unix_ns);
    q.bind(static_cast<std::int64_t>(std::clamp<std::size_t>(f.limit, 1, max_answer_rows)));
    std::vector<Event> list;
    for (;;) {
        const auto row = q.row();
        if (!row) return fail(row, "events could not be read");
        if (!*row) break;
        list.push_back(event_of(q));
    }
    if (!f.oldest_first) std::reverse(list.begin(), list.end());
    return list;
}

StoreResult<std::uint64_t> StoreReader::last_event_id() {
    const auto id = db_->integer("SELECT seq FROM sqlite_sequence WHERE name = 'event'");
    if (!id) return fail(id, "the number of the last event could not be read");
    return static_cast<std::uint64_t>(*id);
}

}  // namespace axisgate
