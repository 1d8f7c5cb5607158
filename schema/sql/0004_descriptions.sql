-- 0004: descriptions of drives: EDS and DCF files of their makers, checked when they came in. A drive of the site names one; a description
-- is never changed, only removed when no drive names it.
CREATE TABLE description (
    name       TEXT    NOT NULL PRIMARY KEY,
    text       TEXT    NOT NULL,
    who        TEXT    NOT NULL,
    at_unix_ns INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
