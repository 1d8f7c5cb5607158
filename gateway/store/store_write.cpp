// Stores batches of acknowledged writes, events and reported values in one transaction. Faults of a batch are found before the transaction
// begins, so that half a batch is never stored.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/store/store.hpp"
#include "gateway/store/texts.hpp"

namespace axisgate {
namespace {
using Kind = StoreError::Kind;

StoreResult<> check_named(const std::string& axis, const std::string& parameter, const Value& value, const Value& previous) {
    if (auto r = check_name("axis", axis); !r) return r;
    if (auto r = check_name("parameter", parameter); !r) return r;
    for (const Value* v : {&value, &previous}) {
        const auto* text = std::get_if<std::string>(v);
        if (text != nullptr && text->size() > max_value_bytes) {
            return fail(Kind::invalid, fmt::format("the value of {} of axis {} has {} bytes; at most {} can be stored", parameter, axis,
                                                   text->size(), max_value_bytes));
        }
    }
    return {};
}

StoreResult<> check_batch(const StoreBatch& batch) {
    if (std::max({batch.writes.size(), batch.events.size(), batch.seen.size()}) > max_batch_rows) {
        return fail(Kind::invalid, fmt::format("a batch has at most {} rows of each kind. Split it", max_batch_rows));
    }
    for (const auto& w : batch.writes) {
        if (auto r = check_named(w.axis, w.parameter, w.value, w.previous); !r) return r;
    }
    for (const auto& s : batch.seen) {
        if (auto r = check_named(s.axis, s.parameter, s.value, {}); !r) return r;
    }
    return {};
}

/// The name of the data that were not stored, for the beginning of the error.
std::string name_of_batch(const StoreBatch& b) {
    if (!b.writes.empty()) {
        const auto& w = b.writes.front();
        const std::string more = b.writes.size() > 1 ? fmt::format(" and {} more values are", b.writes.size() - 1) : " is";
        return fmt::format("{} of axis {}{} not stored", w.parameter, w.axis, more);
    }
    if (!b.events.empty()) return fmt::format("{} event{} not stored", b.events.size(), b.events.size() == 1 ? " is" : "s are");
    return fmt::format("{} last seen value{} not stored", b.seen.size(), b.seen.size() == 1 ? " is" : "s are");
}

}  // namespace

StoreResult<std::int64_t> Store::axis_id(std::string_view axis) {
    {
        Query known(*db_, "SELECT id, removed_unix_ns IS NULL FROM axis WHERE name = ?");
        const auto row = known.bind(axis).row();
        if (!row) return fail(row);
        if (*row && known.integer(1) != 0) return known.integer(0);
    }
    // Unknown, or made again under the name of a removed one: history and snapshots continue.
    Query made(*db_, "INSERT INTO axis (name) VALUES (?) ON CONFLICT (name) DO UPDATE SET removed_unix_ns = NULL RETURNING id");
    const auto row = made.bind(axis).row();
    if (!row) return fail(row);
    const std::int64_t id = made.integer(0);
    if (auto r = made.run(); !r) return fail(r);
    return id;
}

StoreResult<> Store::put(const ParameterWrite& w) {
    const auto axis = axis_id(w.axis);
    if (!axis) return fail(axis);
    Query history(
        *db_,
        "INSERT INTO parameter_write (axis_id, parameter, value_type, value, old_type, old_value, storage, door, who, at_unix_ns, family) "
        "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, (SELECT family FROM axis WHERE id = ?1))");
    Query stored(
        *db_,
        "INSERT INTO parameter_stored (axis_id, parameter, value_type, value, old_type, old_value, storage, door, who, at_unix_ns, family) "
        "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, (SELECT family FROM axis WHERE id = ?1)) ON CONFLICT (axis_id, family, "
        "parameter) DO UPDATE SET value_type = excluded.value_type, "
        "value = excluded.value, old_type = excluded.old_type, old_value = excluded.old_value, storage = excluded.storage, "
        "door = excluded.door, who = excluded.who, at_unix_ns = excluded.at_unix_ns");
    for (Query* q : {&history, &stored}) {
        q->bind(*axis).bind(w.parameter).bind_value(w.value).bind_value(w.previous);
        q->bind(cut(w.storage, max_name_bytes)).bind(name_of(w.door)).bind(cut(w.who, max_name_bytes)).bind(w.at_unix_ns);
        if (auto r = q->run(); !r) return r;
    }
    return {};
}

StoreResult<> Store::put(const ParameterSeen& s) {
    const auto axis = axis_id(s.axis);
    if (!axis) return fail(axis);
    Query q(*db_,
            "INSERT INTO parameter_seen (axis_id, parameter, value_type, value, at_unix_ns) VALUES (?1, ?2, ?3, ?4, ?5) "
            "ON CONFLICT (axis_id, parameter) DO UPDATE SET value_type = excluded.value_type, value = excluded.value, at_unix_ns = "
            "excluded.at_unix_ns "
            "WHERE excluded.value_type IS NOT value_type OR excluded.value IS NOT value OR excluded.at_unix_ns - at_unix_ns >= ?6 "
            "OR at_unix_ns - excluded.at_unix_ns >= ?6");
    return q.bind(*axis).bind(s.parameter).bind_value(s.value).bind(s.at_unix_ns).bind(options_.limits.seen_refresh_ns).run();
}

StoreResult<std::uint64_t> Store::put(const Event& e) {
    Query q(*db_,
            "INSERT INTO event (id, at_unix_ns, severity, kind, axis, drive, line, code, text, who, door, parameter, old_value, new_value) "
            "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    if (e.id == 0) {
        q.bind_null();
    } else {
        q.bind(static_cast<std::int64_t>(e.id));
    }
    q.bind(e.at_unix_ns).bind(static_cast<std::int64_t>(e.severity)).bind(cut(e.kind, max_name_bytes)).bind(cut(e.axis, max_name_bytes));
    q.bind(cut(e.drive, max_name_bytes))
        .bind(cut(e.line, max_name_bytes))
        .bind(std::int64_t{e.code})
        .bind(cut(e.text, max_event_text_bytes));
    q.bind(cut(e.who, max_event_text_bytes)).bind(cut(e.door, max_name_bytes)).bind(cut(e.parameter, max_name_bytes));
    q.bind(cut(e.old_value, max_event_text_bytes)).bind(cut(e.new_value, max_event_text_bytes));
    if (auto r = q.run(); !r) return fail(r);
    return static_cast<std::uint64_t>(db_->last_id());
}

StoreResult<std::uint64_t> Store::commit(const StoreBatch& batch) {
    if (auto r = check_batch(batch); !r) return fail(r, name_of_batch(batch));
    if (batch.writes.empty() && batch.events.empty() && batch.seen.empty()) return 0;
    if (auto r = check_event_ids(batch.events); !r) return fail(r, name_of_batch(batch));
    auto done = db_->transaction([&]() -> StoreResult<std::uint64_t> {
        std::uint64_t last = 0;
        for (const auto& w : batch.writes) {
            if (auto r = put(w); !r) return fail(r);
        }
        for (const auto& s : batch.seen) {
            if (auto r = put(s); !r) return fail(r);
        }
        for (const auto& e : batch.events) {
            const auto id = put(e);
            if (!id) return fail(id);
            last = *id;
        }
        if (!batch.writes.empty() || !batch.events.empty()) {
            if (auto r = prune(batch.writes.size(), batch.events.size()); !r) return fail(r);
        }
        return last;
    });
    if (!done) return fail(done, name_of_batch(batch));
    return done;
}

StoreResult<> Store::check_event_ids(std::span<const Event> events) {
    if (std::none_of(events.begin(), events.end(), [](const Event& e) { return e.id != 0; })) return {};
    const auto before = last_event_id();
    if (!before) return fail(before);
    std::uint64_t last = *before;
    for (const Event& e : events) {
        if (e.id != 0 && (e.id <= last || e.id > max_event_id)) {
            return fail(Kind::invalid,
                        fmt::format("event id {} is not above {}. Begin with last_event_id() + 1, or leave ids to the store", e.id, last));
        }
        last = e.id != 0 ? e.id : last + 1;
    }
    return {};
}

StoreResult<> Store::commit(std::span<const ParameterWrite> writes) {
    const auto done = commit(StoreBatch{writes, {}, {}});
    if (!done) return fail(done);
    return {};
}

StoreResult<std::uint64_t> Store::append_events(std::span<const Event> events) { return commit(StoreBatch{{}, events, {}}); }

StoreResult<> Store::record_seen(std::span<const ParameterSeen> seen) {
    const auto done = commit(StoreBatch{{}, {}, seen});
    if (!done) return fail(done);
    return {};
}

}  // namespace axisgate
