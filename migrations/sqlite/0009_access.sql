-- Who may do what, and who has done what.
CREATE TABLE users (
    name          TEXT NOT NULL PRIMARY KEY,
    title         TEXT NOT NULL,
    password_hash TEXT,
    created_us    INTEGER NOT NULL,
    disabled_us   INTEGER
) STRICT;

-- Roles of users (`user:NAME`) and of service keys (`key:PREFIX`), each for the server, a ship or a family.
CREATE TABLE grants (
    principal  TEXT NOT NULL,
    scope_kind TEXT NOT NULL CHECK (scope_kind IN ('server', 'ship', 'family')),
    scope_name TEXT NOT NULL,
    role       TEXT NOT NULL CHECK (role IN ('reader', 'engineer', 'approver', 'admin')),
    PRIMARY KEY (principal, scope_kind, scope_name)
) STRICT;

-- Of a key only its prefix and the hash of the whole are kept.
CREATE TABLE service_keys (
    prefix       TEXT NOT NULL PRIMARY KEY,
    title        TEXT NOT NULL,
    user_name    TEXT REFERENCES users (name),
    sha256       TEXT NOT NULL,
    created_us   INTEGER NOT NULL,
    expires_us   INTEGER,
    revoked_us   INTEGER,
    last_used_us INTEGER
) STRICT;
CREATE INDEX service_keys_by_user ON service_keys (user_name);

-- Of a session only the hash of what the browser has is kept.
CREATE TABLE sessions (
    sha256     TEXT NOT NULL PRIMARY KEY,
    user_name  TEXT NOT NULL REFERENCES users (name),
    created_us INTEGER NOT NULL,
    expires_us INTEGER NOT NULL
) STRICT;
CREATE INDEX sessions_by_user ON sessions (user_name);
CREATE INDEX sessions_by_end ON sessions (expires_us);

CREATE TABLE settings (
    name       TEXT NOT NULL PRIMARY KEY,
    value      TEXT NOT NULL,
    changed_us INTEGER NOT NULL
) STRICT;

-- What has been done. Each entry has the hash of all that it says and of the entry before it.
CREATE TABLE audit (
    number          INTEGER NOT NULL PRIMARY KEY CHECK (number > 0),
    at_us           INTEGER NOT NULL,
    actor           TEXT NOT NULL,
    origin          TEXT NOT NULL,
    action          TEXT NOT NULL,
    subject         TEXT NOT NULL,
    state_before    TEXT,
    state_after     TEXT,
    previous_sha256 TEXT NOT NULL,
    sha256          TEXT NOT NULL
) STRICT;
CREATE INDEX audit_by_subject ON audit (subject, number);
CREATE INDEX audit_by_actor ON audit (actor, number);
CREATE TRIGGER audit_no_update BEFORE UPDATE ON audit BEGIN SELECT RAISE(ABORT, 'audit is insert-only'); END;
CREATE TRIGGER audit_no_delete BEFORE DELETE ON audit BEGIN SELECT RAISE(ABORT, 'audit is insert-only'); END;

-- The last entry; whoever adds one holds this row until the commit.
CREATE TABLE audit_head (
    one    INTEGER NOT NULL PRIMARY KEY CHECK (one = 1),
    number INTEGER NOT NULL,
    sha256 TEXT NOT NULL
) STRICT;

-- Who asked for a job, and for the version that came of it; none for those before this.
ALTER TABLE jobs ADD COLUMN author TEXT;
ALTER TABLE versions ADD COLUMN author TEXT;
