// Store: the site document, and what a new site means for everything that is kept by name.
// In: the document, renamed and removed axes and drives. Out: one transaction.
// Never leaves a value under a name that the site no longer has: document and names change together.
#include <fmt/format.h>

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
        if (auto r = Query(*db_, "INSERT INTO site_revision (at_unix_ns, who, text) VALUES (?, ?, ?)")
                         .bind(at_unix_ns)
                         .bind(cut(who, max_name_bytes))
                         .bind(text)
                         .run();
            !r) {
            return fail(r);
        }
        const std::int64_t id = db_->last_id();
        if (auto r = Query(*db_, "DELETE FROM site_revision WHERE id <= ?")
                         .bind(id - static_cast<std::int64_t>(options_.limits.site_revisions))
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
    if (auto r = Query(*db_, "DELETE FROM parameter_stored WHERE axis_id = ?").bind(id).run(); !r) return r;
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
    // With a site: who has the new name and is not renamed itself is no longer there, whatever the store was told before.
    if (live) {
        if (auto r = mark_removed(id, at_unix_ns); !r) return r;
    }
    return Query(*db_, "UPDATE axis SET name = name || ' (removed ' || id || ')' WHERE id = ?").bind(id).run();
}

StoreResult<> Store::rename_axes(std::span<const NameChange> changes, std::int64_t at_unix_ns, bool site_decides) {
    // In two rounds, so that names can be exchanged: first all go to names that no axis can have, then each to its new one.
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
        // Also for an axis that the store does not know yet: it must not find a former axis' history under its new name.
        if (auto r = set_aside(changes[i].to, at_unix_ns, site_decides); !r) return r;
        if (ids[i] == 0) continue;
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

StoreResult<> Store::keep_only(const SiteChange& change, std::int64_t at_unix_ns) {
    if (change.axes) {
        const std::unordered_set<std::string_view> keep(change.axes->begin(), change.axes->end());
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
    }
    if (change.drives) {
        const std::unordered_set<std::string_view> keep(change.drives->begin(), change.drives->end());
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
