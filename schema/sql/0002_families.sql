-- 0002: whose parameters a row tells of: the family that the axis' drive had then. '' is not known (rows from before this step, until the
-- site in force says what the axis is). The length of a site document stands before its text, so that a list need not read the texts.

ALTER TABLE axis ADD COLUMN family TEXT NOT NULL DEFAULT '';
-- The name that a removed axis had before another one took it; it gets it back when the name is free and wanted again.
ALTER TABLE axis ADD COLUMN aside_of TEXT;
ALTER TABLE parameter_write ADD COLUMN family TEXT NOT NULL DEFAULT '';
ALTER TABLE snapshot ADD COLUMN family TEXT NOT NULL DEFAULT '';

CREATE TABLE parameter_stored_2 (
    axis_id    INTEGER NOT NULL REFERENCES axis (id) ON DELETE CASCADE,
    family     TEXT    NOT NULL,
    parameter  TEXT    NOT NULL,
    value_type TEXT    NOT NULL CHECK (value_type IN ('u', 'b', 'i', 'f', 't')),
    value      ANY,
    old_type   TEXT    NOT NULL CHECK (old_type IN ('u', 'b', 'i', 'f', 't')),
    old_value  ANY,
    storage    TEXT    NOT NULL,
    door       TEXT    NOT NULL,
    who        TEXT    NOT NULL,
    at_unix_ns INTEGER NOT NULL,
    PRIMARY KEY (axis_id, family, parameter)
) STRICT, WITHOUT ROWID;
INSERT INTO parameter_stored_2
    SELECT axis_id, '', parameter, value_type, value, old_type, old_value, storage, door, who, at_unix_ns FROM parameter_stored;
DROP TABLE parameter_stored;
ALTER TABLE parameter_stored_2 RENAME TO parameter_stored;

CREATE TABLE site_revision_2 (
    id         INTEGER PRIMARY KEY AUTOINCREMENT,
    at_unix_ns INTEGER NOT NULL,
    bytes      INTEGER NOT NULL,
    who        TEXT    NOT NULL,
    text       TEXT    NOT NULL
) STRICT;
INSERT INTO site_revision_2 SELECT id, at_unix_ns, length(CAST(text AS BLOB)), who, text FROM site_revision;
DROP TABLE site_revision;
ALTER TABLE site_revision_2 RENAME TO site_revision;
