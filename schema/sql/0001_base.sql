-- 0001: the parameter database as it began.
-- Every value is a pair of columns, (..._type, ...), so that it comes back as the same kind of value:
--   'u' unknown (NULL) · 'b' boolean (0, 1) · 'i' whole number · 'f' floating point (NULL: not a number) · 't' text, or bytes as hex pairs.
-- Times are nanoseconds since 1970 (UTC). This file runs inside one transaction and is never changed once released: add 0002_....sql.

-- The site document. The highest id is the one in force; older ones are kept up to a bound.
CREATE TABLE site_revision (
    id         INTEGER PRIMARY KEY AUTOINCREMENT,
    at_unix_ns INTEGER NOT NULL,
    who        TEXT    NOT NULL,
    text       TEXT    NOT NULL
) STRICT;

-- An axis as the store knows it. A removed axis keeps its row while it has history or snapshots; made again under the same name,
-- it is the same row.
CREATE TABLE axis (
    id              INTEGER PRIMARY KEY AUTOINCREMENT,
    name            TEXT    NOT NULL UNIQUE,
    removed_unix_ns INTEGER,
    last_snapshot   INTEGER NOT NULL DEFAULT 0
) STRICT;

-- Every write that a drive acknowledged: the audit. Bounded; the oldest go first.
CREATE TABLE parameter_write (
    id         INTEGER PRIMARY KEY AUTOINCREMENT,
    axis_id    INTEGER NOT NULL REFERENCES axis (id),
    parameter  TEXT    NOT NULL,
    value_type TEXT    NOT NULL CHECK (value_type IN ('u', 'b', 'i', 'f', 't')),
    value      ANY,
    old_type   TEXT    NOT NULL CHECK (old_type IN ('u', 'b', 'i', 'f', 't')),
    old_value  ANY,
    storage    TEXT    NOT NULL,
    door       TEXT    NOT NULL,
    who        TEXT    NOT NULL,
    at_unix_ns INTEGER NOT NULL
) STRICT;
CREATE INDEX parameter_write_by_axis ON parameter_write (axis_id, parameter, id);

-- The newest of them per axis and parameter.
CREATE TABLE parameter_stored (
    axis_id    INTEGER NOT NULL REFERENCES axis (id) ON DELETE CASCADE,
    parameter  TEXT    NOT NULL,
    value_type TEXT    NOT NULL CHECK (value_type IN ('u', 'b', 'i', 'f', 't')),
    value      ANY,
    old_type   TEXT    NOT NULL CHECK (old_type IN ('u', 'b', 'i', 'f', 't')),
    old_value  ANY,
    storage    TEXT    NOT NULL,
    door       TEXT    NOT NULL,
    who        TEXT    NOT NULL,
    at_unix_ns INTEGER NOT NULL,
    PRIMARY KEY (axis_id, parameter)
) STRICT, WITHOUT ROWID;

-- What the drive itself last said a parameter is.
CREATE TABLE parameter_seen (
    axis_id    INTEGER NOT NULL REFERENCES axis (id) ON DELETE CASCADE,
    parameter  TEXT    NOT NULL,
    value_type TEXT    NOT NULL CHECK (value_type IN ('u', 'b', 'i', 'f', 't')),
    value      ANY,
    at_unix_ns INTEGER NOT NULL,
    PRIMARY KEY (axis_id, parameter)
) STRICT, WITHOUT ROWID;

-- Non-volatile memory of the embedded drive models.
CREATE TABLE twin_memory (
    drive      TEXT NOT NULL,
    name       TEXT NOT NULL,
    value_type TEXT NOT NULL CHECK (value_type IN ('u', 'b', 'i', 'f', 't')),
    value      ANY,
    PRIMARY KEY (drive, name)
) STRICT, WITHOUT ROWID;

-- What happened. Names are those of the time. Bounded; the oldest go first.
CREATE TABLE event (
    id         INTEGER PRIMARY KEY AUTOINCREMENT,
    at_unix_ns INTEGER NOT NULL,
    severity   INTEGER NOT NULL CHECK (severity BETWEEN 0 AND 2),
    kind       TEXT    NOT NULL,
    axis       TEXT    NOT NULL,
    drive      TEXT    NOT NULL,
    line       TEXT    NOT NULL,
    code       INTEGER NOT NULL,
    text       TEXT    NOT NULL,
    who        TEXT    NOT NULL,
    door       TEXT    NOT NULL,
    parameter  TEXT    NOT NULL,
    old_value  TEXT    NOT NULL,
    new_value  TEXT    NOT NULL
) STRICT;
CREATE INDEX event_by_time ON event (at_unix_ns);
CREATE INDEX event_by_axis ON event (axis, id) WHERE axis <> '';
CREATE INDEX event_serious ON event (id) WHERE severity >= 1;

-- Saved sets of an axis' parameters. n counts up per axis and is never given twice (axis.last_snapshot).
CREATE TABLE snapshot (
    axis_id    INTEGER NOT NULL REFERENCES axis (id),
    n          INTEGER NOT NULL,
    name       TEXT    NOT NULL,
    comment    TEXT    NOT NULL,
    who        TEXT    NOT NULL,
    at_unix_ns INTEGER NOT NULL,
    PRIMARY KEY (axis_id, n)
) STRICT, WITHOUT ROWID;
CREATE TABLE snapshot_value (
    axis_id    INTEGER NOT NULL,
    n          INTEGER NOT NULL,
    parameter  TEXT    NOT NULL,
    value_type TEXT    NOT NULL CHECK (value_type IN ('u', 'b', 'i', 'f', 't')),
    value      ANY,
    PRIMARY KEY (axis_id, n, parameter),
    FOREIGN KEY (axis_id, n) REFERENCES snapshot (axis_id, n) ON DELETE CASCADE
) STRICT, WITHOUT ROWID;

-- Small named texts of the gateway's own: recipes, access tokens, ... One row per kind and name.
CREATE TABLE document (
    kind       TEXT    NOT NULL,
    name       TEXT    NOT NULL,
    text       TEXT    NOT NULL,
    who        TEXT    NOT NULL,
    at_unix_ns INTEGER NOT NULL,
    PRIMARY KEY (kind, name)
) STRICT, WITHOUT ROWID;
