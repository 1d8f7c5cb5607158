// Stores snapshots of an axis' parameters, the twins' non-volatile memory, small documents and descriptions of drives, one transaction
// each. Unchanged data are not written, because writing wears out flash memory.
#include <fmt/core.h>

#include <unordered_set>

#include "gateway/store/store.hpp"
#include "gateway/store/texts.hpp"

namespace axisgate {
namespace {
using Kind = StoreError::Kind;

StoreResult<> check_value(std::string_view name, const Value& value) {
    if (auto r = check_name("parameter", name); !r) return r;
    const auto* text = std::get_if<std::string>(&value);
    if (text != nullptr && text->size() > max_value_bytes) {
        return fail(Kind::invalid,
                    fmt::format("the value of {} has {} bytes; at most {} can be stored", name, text->size(), max_value_bytes));
    }
    return {};
}
}  // namespace

// --- snapshots --------------------------------------------------------------------------------------------------------------

StoreResult<std::uint32_t> Store::save_snapshot(std::string_view axis, std::string_view name, std::string_view comment,
                                                std::string_view who, std::int64_t at_unix_ns, std::span<const SnapshotValue> values) {
    const std::string what = fmt::format("the snapshot of axis {} is not saved", axis);
    if (auto r = check_name("axis", axis); !r) return fail(r, what);
    if (name.size() > max_name_bytes || comment.size() > max_comment_bytes) {
        return fail(Kind::invalid, fmt::format("{}: its name may have {} bytes and its comment {}. Shorten them", what, max_name_bytes,
                                               max_comment_bytes));
    }
    if (values.size() > max_snapshot_values) {
        return fail(Kind::invalid, fmt::format("{}: {} values are more than {}", what, values.size(), max_snapshot_values));
    }
    std::unordered_set<std::string_view> once;
    for (const auto& v : values) {
        if (auto r = check_value(v.parameter, v.value); !r) return fail(r, what);
        if (!once.insert(v.parameter).second) return fail(Kind::invalid, fmt::format("{}: parameter {} is there twice", what, v.parameter));
    }
    auto done = db_->transaction([&]() -> StoreResult<std::uint32_t> {
        {
            // A removed axis returns with a site that contains it, not with a snapshot that was still on its way when it was removed.
            Query removed(*db_, "SELECT 1 FROM axis WHERE name = ? AND removed_unix_ns IS NOT NULL");
            const auto row = removed.bind(axis).row();
            if (!row) return fail(row);
            if (*row) return fail(Kind::not_found, "the axis was removed meanwhile");
        }
        const auto id = axis_id(axis);
        if (!id) return fail(id);
        {
            Query count(*db_, "SELECT count(*) FROM snapshot WHERE axis_id = ?");
            const auto row = count.bind(*id).row();
            if (!row) return fail(row);
            if (count.integer(0) >= static_cast<std::int64_t>(max_snapshots)) {
                return fail(Kind::conflict,
                            fmt::format("the axis has {} snapshots. Delete those that are no longer needed", max_snapshots));
            }
        }
        std::int64_t n = 0;
        {
            Query next(*db_, "UPDATE axis SET last_snapshot = last_snapshot + 1 WHERE id = ? RETURNING last_snapshot");
            const auto row = next.bind(*id).row();
            if (!row) return fail(row);
            n = next.integer(0);
            if (auto r = next.run(); !r) return fail(r);
        }
        if (auto r = Query(*db_,
                           "INSERT INTO snapshot (axis_id, n, name, comment, who, at_unix_ns, family) VALUES (?1, ?2, ?3, ?4, ?5, ?6, "
                           "(SELECT family FROM axis WHERE id = ?1))")
                         .bind(*id)
                         .bind(n)
                         .bind(name)
                         .bind(comment)
                         .bind(cut(who, max_name_bytes))
                         .bind(at_unix_ns)
                         .run();
            !r) {
            return fail(r);
        }
        for (const auto& v : values) {
            Query q(*db_, "INSERT INTO snapshot_value (axis_id, n, parameter, value_type, value) VALUES (?, ?, ?, ?, ?)");
            if (auto r = q.bind(*id).bind(n).bind(v.parameter).bind_value(v.value).run(); !r) return fail(r);
        }
        return static_cast<std::uint32_t>(n);
    });
    if (!done) return fail(done, what);
    return done;
}

StoreResult<> Store::delete_snapshot(std::string_view axis, std::uint32_t n) {
    auto done = db_->transaction([&]() -> StoreResult<> {
        // its values are deleted with it
        Query q(*db_, "DELETE FROM snapshot WHERE axis_id = (SELECT id FROM axis WHERE name = ?) AND n = ?");
        if (auto r = q.bind(axis).bind(std::int64_t{n}).run(); !r) return r;
        if (db_->changes() == 0) return fail(Kind::not_found, "there is none of this number");
        return {};
    });
    if (!done) return fail(done, fmt::format("snapshot {} of axis {} is not deleted", n, axis));
    return {};
}

// --- twins ------------------------------------------------------------------------------------------------------------------

StoreResult<> Store::save_twin(std::string_view drive, const NonVolatile& memory) {
    const std::string what = fmt::format("the memory of the twin of drive {} is not saved", drive);
    if (auto r = check_name("drive", drive); !r) return fail(r, what);
    if (memory.size() > max_snapshot_values) {
        return fail(Kind::invalid, fmt::format("{}: {} values are more than {}", what, memory.size(), max_snapshot_values));
    }
    for (const auto& [name, value] : memory) {
        if (auto r = check_value(name, value); !r) return fail(r, what);
    }
    const auto saved = load_twin(drive);
    if (!saved) return fail(saved, what);
    std::vector<const NonVolatile::value_type*> changed;
    std::vector<std::string_view> gone;
    for (const auto& entry : memory) {
        const auto it = saved->find(entry.first);
        if (it == saved->end() || !same_value(it->second, entry.second)) changed.push_back(&entry);
    }
    for (const auto& entry : *saved) {
        if (!memory.contains(entry.first)) gone.push_back(entry.first);
    }
    if (changed.empty() && gone.empty()) return {};
    auto done = db_->transaction([&]() -> StoreResult<> {
        for (const auto* entry : changed) {
            Query q(*db_,
                    "INSERT INTO twin_memory (drive, name, value_type, value) VALUES (?, ?, ?, ?) "
                    "ON CONFLICT (drive, name) DO UPDATE SET value_type = excluded.value_type, value = excluded.value");
            if (auto r = q.bind(drive).bind(entry->first).bind_value(entry->second).run(); !r) return r;
        }
        for (const auto name : gone) {
            if (auto r = Query(*db_, "DELETE FROM twin_memory WHERE drive = ? AND name = ?").bind(drive).bind(name).run(); !r) return r;
        }
        return {};
    });
    if (!done) return fail(done, what);
    return {};
}

StoreResult<> Store::remove_drive(std::string_view drive) {
    auto done = db_->transaction([&] { return Query(*db_, "DELETE FROM twin_memory WHERE drive = ?").bind(drive).run(); });
    if (!done) return fail(done, fmt::format("the memory of the twin of removed drive {} is still there", drive));
    return {};
}

// --- documents --------------------------------------------------------------------------------------------------------------

StoreResult<> Store::save_document(const StoreDocument& d) {
    const std::string what = fmt::format("{} {} is not saved", d.kind, d.name);
    if (auto r = check_name("kind", d.kind); !r) return fail(r, what);
    if (auto r = check_name("document", d.name); !r) return fail(r, what);
    if (d.text.size() > max_document_bytes) {
        return fail(Kind::invalid, fmt::format("{}: it has {} bytes; at most {} can be stored", what, d.text.size(), max_document_bytes));
    }
    auto done = db_->transaction([&]() -> StoreResult<> {
        {
            Query count(*db_, "SELECT count(*) FROM document WHERE kind = ?1 AND name <> ?2");
            const auto row = count.bind(d.kind).bind(d.name).row();
            if (!row) return fail(row);
            if (count.integer(0) >= static_cast<std::int64_t>(max_documents)) {
                return fail(Kind::conflict,
                            fmt::format("there are {} of this kind. Delete those that are no longer needed", max_documents));
            }
        }
        return Query(*db_,
                     "INSERT INTO document (kind, name, text, who, at_unix_ns) VALUES (?, ?, ?, ?, ?) "
                     "ON CONFLICT (kind, name) DO UPDATE SET text = excluded.text, who = excluded.who, at_unix_ns = excluded.at_unix_ns")
            .bind(d.kind)
            .bind(d.name)
            .bind(d.text)
            .bind(cut(d.who, max_name_bytes))
            .bind(d.at_unix_ns)
            .run();
    });
    if (!done) return fail(done, what);
    return {};
}

StoreResult<> Store::delete_document(std::string_view kind, std::string_view name) {
    auto done = db_->transaction([&]() -> StoreResult<> {
        if (auto r = Query(*db_, "DELETE FROM document WHERE kind = ? AND name = ?").bind(kind).bind(name).run(); !r) return r;
        if (db_->changes() == 0) return fail(Kind::not_found, "there is none of this name");
        return {};
    });
    if (!done) return fail(done, fmt::format("{} {} is not deleted", kind, name));
    return {};
}

// --- descriptions -----------------------------------------------------------------------------------------------------------

StoreResult<> Store::save_description(const StoredDescription& d) {
    const std::string what = fmt::format("description {} is not saved", d.name);
    if (auto r = check_name("description", d.name); !r) return fail(r, what);
    if (d.text.size() > max_description_bytes)
        return fail(Kind::invalid,
                    fmt::format("{}: it has {} bytes; at most {} can be stored", what, d.text.size(), max_description_bytes));
    auto done = db_->transaction([&]() -> StoreResult<> {
        for (const bool same_name : {true, false}) {
            Query count(*db_, same_name ? "SELECT count(*) FROM description WHERE name = ?1" : "SELECT count(*) FROM description");
            if (same_name) count.bind(d.name);
            const auto row = count.row();
            if (!row) return fail(row);
            if (same_name && count.integer(0) != 0) return fail(Kind::conflict, "there is one of that name");
            if (count.integer(0) >= static_cast<std::int64_t>(max_descriptions))
                return fail(Kind::conflict, fmt::format("there are {}. Delete those that no drive names", max_descriptions));
        }
        return Query(*db_, "INSERT INTO description (name, text, who, at_unix_ns) VALUES (?, ?, ?, ?)")
            .bind(d.name)
            .bind(d.text)
            .bind(cut(d.who, max_name_bytes))
            .bind(d.at_unix_ns)
            .run();
    });
    if (!done) return fail(done, what);
    return {};
}

StoreResult<> Store::delete_description(std::string_view name) {
    auto done = db_->transaction([&]() -> StoreResult<> {
        if (auto r = Query(*db_, "DELETE FROM description WHERE name = ?").bind(name).run(); !r) return r;
        if (db_->changes() == 0) return fail(Kind::not_found, "there is none of this name");
        return {};
    });
    if (!done) return fail(done, fmt::format("description {} is not deleted", name));
    return {};
}

}  // namespace axisgate
