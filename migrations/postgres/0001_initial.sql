-- What every table follows: times are microseconds since 1970, ids are UUID v7 or slugs, JSON documents are text
-- (their exact bytes are hashed), booleans are 0 or 1. Keyed text is compared byte by byte.

CREATE TABLE laws (
    name       TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    document   TEXT NOT NULL,
    sha256     TEXT COLLATE "C" NOT NULL,
    created_us BIGINT NOT NULL
);

CREATE TABLE ships (
    name       TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    title      TEXT NOT NULL,
    category   TEXT COLLATE "C" NOT NULL,
    document   TEXT NOT NULL,
    revision   BIGINT NOT NULL CHECK (revision > 0),
    created_us BIGINT NOT NULL,
    updated_us BIGINT NOT NULL,
    deleted_us BIGINT
);
CREATE INDEX ships_by_category ON ships (category, name);

CREATE TABLE ship_revisions (
    ship       TEXT COLLATE "C" NOT NULL REFERENCES ships (name),
    revision   BIGINT NOT NULL,
    title      TEXT NOT NULL,
    category   TEXT COLLATE "C" NOT NULL,
    document   TEXT NOT NULL,
    created_us BIGINT NOT NULL,
    PRIMARY KEY (ship, revision)
);

CREATE TABLE trials (
    id          TEXT COLLATE "C" NOT NULL UNIQUE,
    ship        TEXT COLLATE "C" NOT NULL REFERENCES ships (name),
    sha256      TEXT COLLATE "C" NOT NULL,
    name        TEXT NOT NULL,
    manifest    TEXT NOT NULL,
    conventions TEXT NOT NULL,
    manoeuvre   TEXT,
    sample_rows BIGINT NOT NULL CHECK (sample_rows >= 0),
    duration_s  DOUBLE PRECISION NOT NULL CHECK (duration_s >= 0),
    warnings    TEXT NOT NULL,
    object_key  TEXT NOT NULL,
    created_us  BIGINT NOT NULL,
    deleted_us  BIGINT,
    PRIMARY KEY (ship, sha256)
);
CREATE INDEX trials_by_ship ON trials (ship, id);

-- One row per model: where the next version number comes from, and what aliases are moved under.
CREATE TABLE models (
    name        TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    next_number BIGINT NOT NULL CHECK (next_number > 0)
);

CREATE TABLE versions (
    id         TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    model      TEXT COLLATE "C" NOT NULL REFERENCES models (name),
    number     BIGINT NOT NULL CHECK (number > 0),
    parent     TEXT COLLATE "C" REFERENCES versions (id),
    law        TEXT COLLATE "C" NOT NULL,
    method     TEXT NOT NULL,
    document   TEXT NOT NULL,
    sha256     TEXT COLLATE "C" NOT NULL,
    created_us BIGINT NOT NULL,
    UNIQUE (model, number)
);
CREATE INDEX versions_by_parent ON versions (parent, id);

CREATE TABLE aliases (
    model          TEXT COLLATE "C" NOT NULL,
    alias          TEXT COLLATE "C" NOT NULL,
    version_number BIGINT NOT NULL,
    revision       BIGINT NOT NULL CHECK (revision > 0),
    PRIMARY KEY (model, alias),
    FOREIGN KEY (model, version_number) REFERENCES versions (model, number)
);

CREATE TABLE alias_moves (
    id          TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    model       TEXT COLLATE "C" NOT NULL,
    alias       TEXT COLLATE "C" NOT NULL,
    from_number BIGINT,
    to_number   BIGINT NOT NULL,
    revision    BIGINT NOT NULL,
    reason      TEXT NOT NULL,
    actor       TEXT NOT NULL,
    moved_us    BIGINT NOT NULL,
    UNIQUE (model, alias, revision),
    FOREIGN KEY (model, to_number) REFERENCES versions (model, number)
);

CREATE TABLE idempotency_keys (
    scope          TEXT COLLATE "C" NOT NULL,
    key            TEXT COLLATE "C" NOT NULL,
    request_sha256 TEXT COLLATE "C" NOT NULL,
    status         BIGINT,
    response       TEXT,
    created_us     BIGINT NOT NULL,
    PRIMARY KEY (scope, key)
);
CREATE INDEX idempotency_keys_by_age ON idempotency_keys (created_us);

CREATE TABLE jobs (
    id               TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    kind             TEXT COLLATE "C" NOT NULL,
    ship             TEXT COLLATE "C",
    request          TEXT NOT NULL,
    state            TEXT COLLATE "C" NOT NULL CHECK (state IN ('queued', 'running', 'succeeded', 'failed', 'cancelled')),
    progress         DOUBLE PRECISION NOT NULL,
    message          TEXT NOT NULL,
    result           TEXT,
    error            TEXT,
    attempt          BIGINT NOT NULL,
    fence            BIGINT NOT NULL,
    lease_until_us   BIGINT,
    worker           TEXT,
    created_us       BIGINT NOT NULL,
    started_us       BIGINT,
    finished_us      BIGINT,
    cancel_requested BIGINT NOT NULL CHECK (cancel_requested IN (0, 1))
);
CREATE INDEX jobs_by_ship ON jobs (ship, id);
CREATE INDEX jobs_to_claim ON jobs (id) WHERE state IN ('queued', 'running');

CREATE TABLE reports (
    id         TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    version_id TEXT COLLATE "C" REFERENCES versions (id),
    ship       TEXT COLLATE "C" NOT NULL,
    kind       TEXT COLLATE "C" NOT NULL,
    document   TEXT NOT NULL,
    html       TEXT NOT NULL,
    created_us BIGINT NOT NULL
);
CREATE INDEX reports_by_version ON reports (version_id, id);

-- What is insert-only stays so, whoever holds the connection.
CREATE FUNCTION refuse_change() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    RAISE EXCEPTION '% is insert-only', TG_TABLE_NAME;
END;
$$;
CREATE TRIGGER laws_insert_only BEFORE UPDATE OR DELETE ON laws FOR EACH ROW EXECUTE FUNCTION refuse_change();
CREATE TRIGGER ship_revisions_insert_only BEFORE UPDATE OR DELETE ON ship_revisions FOR EACH ROW EXECUTE FUNCTION refuse_change();
CREATE TRIGGER versions_insert_only BEFORE UPDATE OR DELETE ON versions FOR EACH ROW EXECUTE FUNCTION refuse_change();
CREATE TRIGGER alias_moves_insert_only BEFORE UPDATE OR DELETE ON alias_moves FOR EACH ROW EXECUTE FUNCTION refuse_change();
