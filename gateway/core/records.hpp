// Stored data of a site as plain values: parameters, snapshots, revisions of the site, and queries for events. They contain no ids of the
// running process.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gateway/core/event.hpp"
#include "gateway/core/sample.hpp"
#include "gateway/core/value.hpp"

namespace axisgate {

struct EventQuery {
    std::uint64_t since_id = 0;      ///< events with a greater id
    std::int64_t since_unix_ns = 0;  ///< and not older than this
    std::string axis;                ///< empty: any
    std::optional<Severity> at_least;
    std::size_t limit = 200;      ///< 1..1000; the newest ones if there are more, or the oldest ones
    bool oldest_first = false;    ///< the oldest ones if there are more than `limit`, for reading on from `since_id`
    std::string kind;             ///< empty: any
    std::uint64_t before_id = 0;  ///< events with a smaller id, for paging backwards; 0: no bound
};

struct StoredParameter {
    std::string parameter;  ///< catalogue id
    Value value;
    Value previous;
    std::string who, door;
    std::int64_t at_unix_ns = 0;
};
struct LiveParameter {
    Value value;
    std::int64_t at_unix_ns = 0;
    Quality quality = Quality::unknown;
};

// --- snapshots of an axis' parameters, and documents of the site ---
struct SnapshotValue {
    std::string parameter;
    Value value;
};
struct SnapshotInfo {
    std::uint32_t n = 0;  ///< increases per axis from 1; never used twice
    std::string name;
    std::string comment;
    std::string who;
    std::int64_t at_unix_ns = 0;
    std::uint64_t values = 0;  ///< number of values
    std::string family;        ///< of the drive that it was taken from; empty: unknown
};
struct AxisSnapshot : SnapshotInfo {
    std::vector<SnapshotValue> parameters;  ///< in order of parameter id
};

struct SiteRevision {
    std::uint64_t revision = 0;  ///< increases; never used twice
    std::int64_t at_unix_ns = 0;
    std::string who;
    std::string text;         ///< the document; empty in site_history()
    std::uint64_t bytes = 0;  ///< length of the document
};

}  // namespace axisgate
