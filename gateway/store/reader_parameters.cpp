// Reads axes, stored values, their history, reported values and snapshots. Stored values of a removed axis, or of another family than the
// present one, are not shown, because the same id is another parameter there.
#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "gateway/store/reader.hpp"

namespace axisgate {
namespace {

/// Columns: parameter, value_type, value, old_type, old_value, door, who, at_unix_ns, storage, id.
StoreResult<ParameterRecord> record_of(const Query& q) {
    ParameterRecord r;
    r.parameter = q.text(0);
    auto value = q.value(1);
    if (!value) return fail(value, r.parameter);
    auto previous = q.value(3);
    if (!previous) return fail(previous, r.parameter);
    r.value = std::move(*value);
    r.previous = std::move(*previous);
    r.door = q.text(5);
    r.who = q.text(6);
    r.at_unix_ns = q.integer(7);
    r.storage = q.text(8);
    r.id = static_cast<std::uint64_t>(q.integer(9));
    return r;
}

StoreResult<std::vector<ParameterRecord>> all_records(Query& q, std::string_view axis) {
    std::vector<ParameterRecord> list;
    for (;;) {
        const auto row = q.row();
        if (!row) return fail(row, fmt::format("values of axis {} could not be read", axis));
        if (!*row) return list;
        auto record = record_of(q);
        if (!record) return fail(record, fmt::format("values of axis {} could not be read", axis));
        list.push_back(std::move(*record));
    }
}

SnapshotInfo info_of(const Query& q) {
    SnapshotInfo s;
    s.n = static_cast<std::uint32_t>(q.integer(0));
    s.name = q.text(1);
    s.comment = q.text(2);
    s.who = q.text(3);
    s.at_unix_ns = q.integer(4);
    s.values = static_cast<std::uint64_t>(q.integer(5));
    s.family = q.text(6);
    return s;
}

}  // namespace

StoreResult<std::vector<AxisRecord>> StoreReader::axes() {
    std::vector<AxisRecord> list;
    Query q(*db_, "SELECT name, removed_unix_ns, family FROM axis ORDER BY name");
    for (;;) {
        const auto row = q.row();
        if (!row) return fail(row, "the list of axes could not be read");
        if (!*row) return list;
        list.push_back({q.text(0), q.text(2), q.null(1) ? std::nullopt : std::optional(q.integer(1))});
    }
}

StoreResult<std::vector<ParameterRecord>> StoreReader::stored(std::string_view axis) {
    Query q(*db_,
            "SELECT s.parameter, s.value_type, s.value, s.old_type, s.old_value, s.door, s.who, s.at_unix_ns, s.storage, 0 "
            "FROM axis a JOIN parameter_stored s ON s.axis_id = a.id AND s.family = a.family WHERE a.name = ? AND a.removed_unix_ns IS "
            "NULL ORDER BY s.parameter");
    q.bind(axis);
    return all_records(q, axis);
}

StoreResult<std::optional<ParameterRecord>> StoreReader::stored(std::string_view axis, std::string_view parameter) {
    Query q(*db_,
            "SELECT s.parameter, s.value_type, s.value, s.old_type, s.old_value, s.door, s.who, s.at_unix_ns, s.storage, 0 "
            "FROM axis a JOIN parameter_stored s ON s.axis_id = a.id AND s.family = a.family AND s.parameter = ?2 "
            "WHERE a.name = ?1 AND a.removed_unix_ns IS NULL");
    q.bind(axis).bind(parameter);
    auto list = all_records(q, axis);
    if (!list) return fail(list);
    if (list->empty()) return std::nullopt;
    return std::move(list->front());
}

StoreResult<std::vector<ParameterRecord>> StoreReader::history(std::string_view axis, std::string_view parameter, std::size_t limit,
                                                               std::uint64_t before_id) {
    const auto rows = static_cast<std::int64_t>(std::clamp<std::size_t>(limit, 1, max_answer_rows));
    const std::int64_t before = before_id == 0 || before_id > std::numeric_limits<std::int64_t>::max()
                                    ? std::numeric_limits<std::int64_t>::max()
                                    : static_cast<std::int64_t>(before_id);
    if (parameter.empty()) {
        Query q(*db_,
                "SELECT parameter, value_type, value, old_type, old_value, door, who, at_unix_ns, storage, id FROM parameter_write "
                "WHERE (axis_id, family) = (SELECT id, family FROM axis WHERE name = ?) AND id < ? ORDER BY id DESC LIMIT ?");
        q.bind(axis).bind(before).bind(rows);
        return all_records(q, axis);
    }
    Query q(*db_,
            "SELECT parameter, value_type, value, old_type, old_value, door, who, at_unix_ns, storage, id FROM parameter_write "
            "WHERE (axis_id, family) = (SELECT id, family FROM axis WHERE name = ?) AND parameter = ? AND id < ? ORDER BY id DESC LIMIT ?");
    q.bind(axis).bind(parameter).bind(before).bind(rows);
    return all_records(q, axis);
}

StoreResult<std::vector<ParameterSeen>> StoreReader::seen(std::string_view axis) {
    std::vector<ParameterSeen> list;
    Query q(*db_,
            "SELECT s.parameter, s.value_type, s.value, s.at_unix_ns FROM axis a JOIN parameter_seen s ON s.axis_id = a.id "
            "WHERE a.name = ? ORDER BY s.parameter");
    q.bind(axis);
    for (;;) {
        const auto row = q.row();
        if (!row) return fail(row, fmt::format("values last seen of axis {} could not be read", axis));
        if (!*row) return list;
        auto value = q.value(1);
        if (!value) return fail(value, fmt::format("axis {}, {}", axis, q.text(0)));
        list.push_back({std::string(axis), q.text(0), std::move(*value), q.integer(3)});
    }
}

StoreResult<std::vector<SnapshotInfo>> StoreReader::snapshots(std::string_view axis) {
    std::vector<SnapshotInfo> list;
    Query q(*db_,
            "SELECT s.n, s.name, s.comment, s.who, s.at_unix_ns, "
            "(SELECT count(*) FROM snapshot_value v WHERE v.axis_id = s.axis_id AND v.n = s.n), s.family "
            "FROM axis a JOIN snapshot s ON s.axis_id = a.id WHERE a.name = ? ORDER BY s.n");
    q.bind(axis);
    for (;;) {
        const auto row = q.row();
        if (!row) return fail(row, fmt::format("snapshots of axis {} could not be read", axis));
        if (!*row) return list;
        list.push_back(info_of(q));
    }
}

StoreResult<std::optional<AxisSnapshot>> StoreReader::snapshot(std::string_view axis, std::uint32_t n) {
    const auto what = [&] { return fmt::format("snapshot {} of axis {} could not be read", n, axis); };
    // One statement, so that a snapshot that is deleted meanwhile is seen completely or not at all.
    Query q(*db_,
            "SELECT s.n, s.name, s.comment, s.who, s.at_unix_ns, 0, s.family, v.parameter, v.value_type, v.value FROM axis a "
            "JOIN snapshot s ON s.axis_id = a.id LEFT JOIN snapshot_value v ON v.axis_id = s.axis_id AND v.n = s.n "
            "WHERE a.name = ? AND s.n = ? ORDER BY v.parameter");
    q.bind(axis).bind(std::int64_t{n});
    AxisSnapshot s;
    for (bool first = true;; first = false) {
        const auto row = q.row();
        if (!row) return fail(row, what());
        if (!*row && first) return std::nullopt;
        if (!*row) break;
        if (first) static_cast<SnapshotInfo&>(s) = info_of(q);
        if (q.null(7)) continue;  // a snapshot without values
        auto value = q.value(8);
        if (!value) return fail(value, fmt::format("snapshot {} of axis {}, {}", n, axis, q.text(7)));
        s.parameters.push_back({q.text(7), std::move(*value)});
    }
    s.values = s.parameters.size();
    return s;
}

}  // namespace axisgate
