// Stores the site document together with its consequences for all data that are stored by name, in one transaction, so that no value stays
// under a name that the site does not have any more.
#include <fmt/core.h>

#include <unordered_set>

#include "gateway/store/store.hpp"
#include "gateway/store/texts.hpp"

namespace axisgate {
namespace {
using Kind = StoreError::Kind;

StoreResult<> check_changes(std::string_view what, std::span<const NameChange> changes) {
    std::unordered_set<std::string_view> from;
    std::unordered_set<std::string_view> to;
    for (const auto& c : changes) {
        if (auto r = check_name(what, c.from); !r) return r;
        if (auto r = check_name(what, c.to); !r) return r;
        if (!from.insert(c.from).second || !to.insert(c.to).second) {
            return fail(Kind::invalid, fmt::format("{} {} -> {}: a name is there twice in one change", what, c.from, c.to));
        }
    }
    return {};
}
}  // namespace

StoreResult<std::uint64_t> Store::save_site(std::string_view text, std::string_view who, std::int64_t at_unix_ns,
                                            const SiteChange& change) {
    constexpr std::string_view what = "the site is not stored";
    if (text.empty() || text.size() > max_site_bytes) {
        return fail(Kind::invalid, fmt::format("{}: it has {} bytes; 1 to {} can be stored", what, text.size(), max_site_bytes));
    }
    if (auto r = check_changes("axis", change.renamed_axes); !r) return fail(r, what);
    if (auto r = check_changes("drive", change.renamed_drives); !r) return fail(r, what);
    auto done = db_->transaction([&]() -> StoreResult<std::uint64_t> {
        if (auto r = rename_axes(change.renamed_axes, at_unix_ns, true); !r) return fail(r);
        if (auto r = rename_drives(change.renamed_drives); !r) return fail(r);
        if (auto r = keep_only(change, at_unix_ns); !r) return fail(r);
        {
            Query same(*db_, "SELECT id FROM site_revision WHERE id = (SELECT max(id) FROM site_revision) AND text = ?");
            const auto row = same.bind(text).row();
            if (!row) return fail(row);
            if (*row) return static_cast<std::uint64_t>(same.integer(0));
        }
        if (auto r = Query(*db_, "INSERT INTO site_revision (at_unix_ns, bytes, who, text) VALUES (?, ?, ?, ?)")
                         .bind(at_unix_ns)
                         .bind(static_cast<std::int64_t>(text.size()))
                         .bind(cut(who, max_name_bytes))
                         .bind(text)
                         .run();
            !r) {
            return fail(r);
        }
        const std::int64_t id = db_->last_id();
        // Deletes the oldest revisions beyond the number, and beyond the total length (the newest one may have any length).
        if (auto r = Query(*db_,
                           "DELETE FROM site_revision WHERE id <= ?1 - ?2 OR id < ?1 AND id IN (SELECT id FROM (SELECT id, "
                           "sum(bytes) OVER (ORDER BY id DESC) AS together FROM site_revision) WHERE together > ?3)")
                         .bind(id)
                         .bind(static_cast<std::int64_t>(options_.limits.site_revisions))
                         .bind(static_cast<std::int64_t>(options_.limits.site_bytes))
                         .run();
            !r) {
            return fail(r);
        }
        return static_cast<std::uint64_t>(id);
    });
    if (!done) return fail(done, what);
    return done;
}

StoreResult<> Store::rename_axis(std::string_view from, std::string_view to, std::int64_t at_unix_ns) {
    const std::vector<NameChange> change{{std::string(from), std::string(to)}};
    if (auto r = check_changes("axis", change); !r) return r;
    auto done = db_->transaction([&] { return rename_axes(change, at_unix_ns, false); });
    if (!done) return fail(done, fmt::format("axis {} is not renamed to {}", from, to));
    return {};
}

StoreResult<> Store::remove_axis(std::string_view axis, std::int64_t at_unix_ns) {
    auto done = db_->transaction([&]() -> StoreResult<> {
        std::int64_t id = 0;
        {
            Query q(*db_, "SELECT id FROM axis WHERE name = ? AND removed_unix_ns IS NULL");
            const auto row = q.bind(axis).row();
            if (!row) return fail(row);
            if (!*row) return {};
            id = q.integer(0);
        }
        return mark_removed(id, at_unix_ns);
    });
    if (!done) return fail(done, fmt::format("the values of removed axis {} are still stored", axis));
    return {};
}

StoreResult<> Store::mark_removed(std::int64_t id, std::int64_t at_unix_ns) {
    if (auto r = Query(*db_, "DELETE FROM parameter_seen WHERE axis_id = ?").bind(id).run(); !r) return r;
    return Query(*db_, "UPDATE axis SET removed_unix_ns = ? WHERE id = ?").bind(at_unix_ns).bind(id).run();
}

StoreResult<> Store::set_aside(std::string_view name, std::int64_t at_unix_ns, bool site_decides) {
    std::int64_t id = 0;
    bool live = false;
    {
        Query q(*db_, "SELECT id, removed_unix_ns IS NULL FROM axis WHERE name = ?");
        const auto row = q.bind(name).row();
        if (!row) return fail(row);
        if (!*row) return {};
        id = q.integer(0);
        live = q.integer(1) != 0;
    }
    if (live && !site_decides) {
        return fail(Kind::conflict, fmt::format("another axis has the name {}. Rename or remove that one first", name));
    }
    // With a site: an axis that has the new name and is not renamed itself does not exist any more, whatever the store was told before.
    if (live) {
        if (auto r = mark_removed(id, at_unix_ns); !r) return r;
    }
    return Query(*db_, "UPDATE axis SET aside_of = name, name = name || ' (removed ' || id || ')' WHERE id = ?").bind(id).run();
}

StoreResult<> Store::rename_axes(std::span<const NameChange> changes, std::int64_t at_unix_ns, bool site_decides) {
    // In two rounds, so that names can be exchanged: first all get names that no axis can have, then each its new one.
    std::vector<std::int64_t> ids;
    for (const auto& c : changes) {
        Query q(*db_, "UPDATE axis SET name = char(31) || id WHERE name = ? AND removed_unix_ns IS NULL RETURNING id");
        const auto row = q.bind(c.from).row();
        if (!row) return fail(row);
        ids.push_back(*row ? q.integer(0) : 0);
        if (*row) {
            if (auto r = q.run(); !r) return r;
        }
    }
    for (std::size_t i = 0; i < changes.size(); ++i) {
        // Also for an axis that the store does not know yet, so that it does not find the history of a former axis under its new name.
        if (auto r = set_aside(changes[i].to, at_unix_ns, site_decides); !r) return r;
        if (ids[i] == 0) {  // so that the name is taken, and the renamed removed axis does not return under it
            if (!site_decides) continue;
            if (auto r = Query(*db_, "INSERT INTO axis (name) VALUES (?)").bind(changes[i].to).run(); !r) return r;
            continue;
        }
        if (auto r = Query(*db_, "UPDATE axis SET name = ? WHERE id = ?").bind(changes[i].to).bind(ids[i]).run(); !r) return r;
    }
    return {};
}

StoreResult<> Store::rename_drives(std::span<const NameChange> changes) {
    for (const auto& c : changes) {
        if (auto r = Query(*db_, "UPDATE twin_memory SET drive = char(31) || drive WHERE drive = ?").bind(c.from).run(); !r) return r;
    }
    for (const auto& c : changes) {
        if (auto r = Query(*db_, "DELETE FROM twin_memory WHERE drive = ?").bind(c.to).run(); !r) return r;
        if (auto r = Query(*db_, "UPDATE twin_memory SET drive = ? WHERE drive = char(31) || ?").bind(c.to).bind(c.from).run(); !r) {
            return r;
        }
    }
    return {};
}

/// The axis' row, made, or restored after its removal; later writes are stored under its family.
StoreResult<> Store::bring_in(const SiteAxis& axis) {
    if (auto r = check_name("axis", axis.name); !r) return r;
    const auto find = [&](std::int64_t& id, std::string& family, bool& removed) -> StoreResult<> {
        Query q(*db_, "SELECT id, family, removed_unix_ns IS NOT NULL FROM axis WHERE name = ?");
        const auto row = q.bind(axis.name).row();
        if (!row) return fail(row);
        id = *row ? q.integer(0) : 0;
        family = *row ? q.text(1) : std::string();
        removed = *row && q.integer(2) != 0;
        return {};
    };
    std::int64_t id = 0;
    std::string family;
    bool removed = false;
    if (auto r = find(id, family, removed); !r) return r;
    if (id == 0) {
        if (auto r =
                Query(*db_, "UPDATE axis SET name = aside_of, aside_of = NULL WHERE id = (SELECT max(id) FROM axis WHERE aside_of = ?)")
                    .bind(axis.name)
                    .run();
            !r) {
            return r;
        }
        if (auto r = Query(*db_, "INSERT OR IGNORE INTO axis (name) VALUES (?)").bind(axis.name).run(); !r) return r;
        if (auto r = find(id, family, removed); !r) return r;
    }
    if (removed) {
        if (auto r = Query(*db_, "UPDATE axis SET removed_unix_ns = NULL WHERE id = ?").bind(id).run(); !r) return r;
    }
    if (axis.family.empty() || axis.family == family) return {};
    // Rows from before families were stored belong to the family with which the axis is first seen. Snapshots keep an unknown family.
    for (const char* table : {"parameter_stored", "parameter_write"}) {
        if (!family.empty()) break;
        const std::string sql = fmt::format("UPDATE {} SET family = ? WHERE axis_id = ? AND family = ''", table);
        if (auto r = Query(*db_, sql.c_str()).bind(axis.family).bind(id).run(); !r) return r;
    }
    if (!family.empty()) {  // reports of the former drive are not valid for this one
        if (auto r = Query(*db_, "DELETE FROM parameter_seen WHERE axis_id = ?").bind(id).run(); !r) return r;
    }
    return Query(*db_, "UPDATE axis SET family = ? WHERE id = ?").bind(axis.family).bind(id).run();
}

/// Removed axes beyond their bound are deleted with all data, the earliest removed first.
StoreResult<> Store::forget_oldest_axes() {
    std::vector<std::int64_t> gone;
    {
        Query q(*db_, "SELECT id FROM axis WHERE removed_unix_ns IS NOT NULL ORDER BY removed_unix_ns DESC, id DESC LIMIT -1 OFFSET ?");
        q.bind(static_cast<std::int64_t>(options_.limits.removed_axes));
        for (;;) {
            const auto row = q.row();
            if (!row) return fail(row);
            if (!*row) break;
            gone.push_back(q.integer(0));
        }
    }
    for (const std::int64_t id : gone) {
        for (const char* sql :
             {"DELETE FROM parameter_write WHERE axis_id = ?", "DELETE FROM snapshot WHERE axis_id = ?", "DELETE FROM axis WHERE id = ?"}) {
            if (auto r = Query(*db_, sql).bind(id).run(); !r) return r;
        }
    }
    return {};
}

StoreResult<> Store::keep_only(const SiteChange& change, std::int64_t at_unix_ns) {
    if (change.axes) {
        std::unordered_set<std::string_view> keep(change.kept_axes.begin(), change.kept_axes.end());
        for (const SiteAxis& a : *change.axes) {
            keep.insert(a.name);
            if (auto r = bring_in(a); !r) return r;
        }
        std::vector<std::int64_t> gone;
        {
            Query q(*db_, "SELECT id, name FROM axis WHERE removed_unix_ns IS NULL");
            for (;;) {
                const auto row = q.row();
                if (!row) return fail(row);
                if (!*row) break;
                if (!keep.contains(q.text(1))) gone.push_back(q.integer(0));
            }
        }
        for (const std::int64_t id : gone) {
            if (auto r = mark_removed(id, at_unix_ns); !r) return r;
        }
        if (!gone.empty()) {
            if (auto r = forget_oldest_axes(); !r) return r;
        }
    }
    if (change.drives) {
        std::unordered_set<std::string_view> keep(change.drives->begin(), change.drives->end());
        keep.insert(change.kept_drives.begin(), change.kept_drives.end());
        std::vector<std::string> gone;
        {
            Query q(*db_, "SELECT DISTINCT drive FROM twin_memory");
            for (;;) {
                const auto row = q.row();
                if (!row) return fail(row);
                if (!*row) break;
                if (std::string drive = q.text(0); !keep.contains(drive)) gone.push_back(std::move(drive));
            }
        }
        for (const std::string& drive : gone) {
            if (auto r = Query(*db_, "DELETE FROM twin_memory WHERE drive = ?").bind(drive).run(); !r) return r;
        }
    }
    return {};
}

}  // namespace axisgate
