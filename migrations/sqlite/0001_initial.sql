-- What every table follows: times are microseconds since 1970, ids are UUID v7 or slugs, JSON documents are text
-- (their exact bytes are hashed), booleans are 0 or 1. Keyed text is compared byte by byte.

CREATE TABLE laws (
    name       TEXT NOT NULL PRIMARY KEY,
    document   TEXT NOT NULL,
    sha256     TEXT NOT NULL,
    created_us INTEGER NOT NULL
) STRICT;

CREATE TABLE ships (
    name       TEXT NOT NULL PRIMARY KEY,
    title      TEXT NOT NULL,
    category   TEXT NOT NULL,
    document   TEXT NOT NULL,
    revision   INTEGER NOT NULL CHECK (revision > 0),
    created_us INTEGER NOT NULL,
    updated_us INTEGER NOT NULL,
    deleted_us INTEGER
) STRICT;
CREATE INDEX ships_by_category ON ships (category, name);

CREATE TABLE ship_revisions (
    ship       TEXT NOT NULL REFERENCES ships (name),
    revision   INTEGER NOT NULL,
    title      TEXT NOT NULL,
    category   TEXT NOT NULL,
    document   TEXT NOT NULL,
    created_us INTEGER NOT NULL,
    PRIMARY KEY (ship, revision)
) STRICT;

CREATE TABLE trials (
    id          TEXT NOT NULL UNIQUE,
    ship        TEXT NOT NULL REFERENCES ships (name),
    sha256      TEXT NOT NULL,
    name        TEXT NOT NULL,
    manifest    TEXT NOT NULL,
    conventions TEXT NOT NULL,
    manoeuvre   TEXT,
    sample_rows INTEGER NOT NULL CHECK (sample_rows >= 0),
    duration_s  REAL NOT NULL CHECK (duration_s >= 0),
    warnings    TEXT NOT NULL,
    object_key  TEXT NOT NULL,
    created_us  INTEGER NOT NULL,
    deleted_us  INTEGER,
    PRIMARY KEY (ship, sha256)
) STRICT;
CREATE INDEX trials_by_ship ON trials (ship, id);

-- One row per model: where the next version number comes from, and what aliases are moved under.
CREATE TABLE models (
    name        TEXT NOT NULL PRIMARY KEY,
    next_number INTEGER NOT NULL CHECK (next_number > 0)
) STRICT;

CREATE TABLE versions (
    id         TEXT NOT NULL PRIMARY KEY,
    model      TEXT NOT NULL REFERENCES models (name),
    number     INTEGER NOT NULL CHECK (number > 0),
    parent     TEXT REFERENCES versions (id),
    law        TEXT NOT NULL,
    method     TEXT NOT NULL,
    document   TEXT NOT NULL,
    sha256     TEXT NOT NULL,
    created_us INTEGER NOT NULL,
    UNIQUE (model, number)
) STRICT;
CREATE INDEX versions_by_parent ON versions (parent, id);

CREATE TABLE aliases (
    model          TEXT NOT NULL,
    alias          TEXT NOT NULL,
    version_number INTEGER NOT NULL,
    revision       INTEGER NOT NULL CHECK (revision > 0),
    PRIMARY KEY (model, alias),
    FOREIGN KEY (model, version_number) REFERENCES versions (model, number)
) STRICT;

CREATE TABLE alias_moves (
    id          TEXT NOT NULL PRIMARY KEY,
    model       TEXT NOT NULL,
    alias       TEXT NOT NULL,
    from_number INTEGER,
    to_number   INTEGER NOT NULL,
    revision    INTEGER NOT NULL,
    reason      TEXT NOT NULL,
    actor       TEXT NOT NULL,
    moved_us    INTEGER NOT NULL,
    UNIQUE (model, alias, revision),
    FOREIGN KEY (model, to_number) REFERENCES versions (model, number)
) STRICT;

CREATE TABLE idempotency_keys (
    scope          TEXT NOT NULL,
    key            TEXT NOT NULL,
    request_sha256 TEXT NOT NULL,
    status         INTEGER,
    response       TEXT,
    created_us     INTEGER NOT NULL,
    PRIMARY KEY (scope, key)
) STRICT;
CREATE INDEX idempotency_keys_by_age ON idempotency_keys (created_us);

CREATE TABLE jobs (
    id               TEXT NOT NULL PRIMARY KEY,
    kind             TEXT NOT NULL,
    ship             TEXT,
    request          TEXT NOT NULL,
    state            TEXT NOT NULL CHECK (state IN ('queued', 'running', 'succeeded', 'failed', 'cancelled')),
    progress         REAL NOT NULL,
    message          TEXT NOT NULL,
    result           TEXT,
    error            TEXT,
    attempt          INTEGER NOT NULL,
    fence            INTEGER NOT NULL,
    lease_until_us   INTEGER,
    worker           TEXT,
    created_us       INTEGER NOT NULL,
    started_us       INTEGER,
    finished_us      INTEGER,
    cancel_requested INTEGER NOT NULL CHECK (cancel_requested IN (0, 1))
) STRICT;
CREATE INDEX jobs_by_ship ON jobs (ship, id);
CREATE INDEX jobs_to_claim ON jobs (id) WHERE state IN ('queued', 'running');

CREATE TABLE reports (
    id         TEXT NOT NULL PRIMARY KEY,
    version_id TEXT REFERENCES versions (id),
    ship       TEXT NOT NULL,
    kind       TEXT NOT NULL,
    document   TEXT NOT NULL,
    html       TEXT NOT NULL,
    created_us INTEGER NOT NULL
) STRICT;
CREATE INDEX reports_by_version ON reports (version_id, id);

-- What is insert-only stays so, whoever holds the connection.
CREATE TRIGGER laws_no_update BEFORE UPDATE ON laws BEGIN SELECT RAISE(ABORT, 'laws is insert-only'); END;
CREATE TRIGGER laws_no_delete BEFORE DELETE ON laws BEGIN SELECT RAISE(ABORT, 'laws is insert-only'); END;
CREATE TRIGGER ship_revisions_no_update BEFORE UPDATE ON ship_revisions BEGIN SELECT RAISE(ABORT, 'ship_revisions is insert-only'); END;
CREATE TRIGGER ship_revisions_no_delete BEFORE DELETE ON ship_revisions BEGIN SELECT RAISE(ABORT, 'ship_revisions is insert-only'); END;
CREATE TRIGGER versions_no_update BEFORE UPDATE ON versions BEGIN SELECT RAISE(ABORT, 'versions is insert-only'); END;
CREATE TRIGGER versions_no_delete BEFORE DELETE ON versions BEGIN SELECT RAISE(ABORT, 'versions is insert-only'); END;
CREATE TRIGGER alias_moves_no_update BEFORE UPDATE ON alias_moves BEGIN SELECT RAISE(ABORT, 'alias_moves is insert-only'); END;
CREATE TRIGGER alias_moves_no_delete BEFORE DELETE ON alias_moves BEGIN SELECT RAISE(ABORT, 'alias_moves is insert-only'); END;
