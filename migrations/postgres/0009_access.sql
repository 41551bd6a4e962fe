-- Who may do what, and who has done what.
CREATE TABLE users (
    name          TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    title         TEXT NOT NULL,
    password_hash TEXT,
    created_us    BIGINT NOT NULL,
    disabled_us   BIGINT
);

-- Roles of users (`user:NAME`) and of service keys (`key:PREFIX`), each for the server, a ship or a family.
CREATE TABLE grants (
    principal  TEXT COLLATE "C" NOT NULL,
    scope_kind TEXT COLLATE "C" NOT NULL CHECK (scope_kind IN ('server', 'ship', 'family')),
    scope_name TEXT COLLATE "C" NOT NULL,
    role       TEXT NOT NULL CHECK (role IN ('reader', 'engineer', 'approver', 'admin')),
    PRIMARY KEY (principal, scope_kind, scope_name)
);

-- Of a key only its prefix and the hash of the whole are kept.
CREATE TABLE service_keys (
    prefix       TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    title        TEXT NOT NULL,
    user_name    TEXT COLLATE "C" REFERENCES users (name),
    sha256       TEXT NOT NULL,
    created_us   BIGINT NOT NULL,
    expires_us   BIGINT,
    revoked_us   BIGINT,
    last_used_us BIGINT
);
CREATE INDEX service_keys_by_user ON service_keys (user_name);

-- Of a session only the hash of what the browser has is kept.
CREATE TABLE sessions (
    sha256     TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    user_name  TEXT COLLATE "C" NOT NULL REFERENCES users (name),
    created_us BIGINT NOT NULL,
    expires_us BIGINT NOT NULL
);
CREATE INDEX sessions_by_user ON sessions (user_name);
CREATE INDEX sessions_by_end ON sessions (expires_us);

CREATE TABLE settings (
    name       TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    value      TEXT NOT NULL,
    changed_us BIGINT NOT NULL
);

-- What has been done. Each entry has the hash of all that it says and of the entry before it.
CREATE TABLE audit (
    number          BIGINT NOT NULL PRIMARY KEY CHECK (number > 0),
    at_us           BIGINT NOT NULL,
    actor           TEXT COLLATE "C" NOT NULL,
    origin          TEXT NOT NULL,
    action          TEXT NOT NULL,
    subject         TEXT COLLATE "C" NOT NULL,
    state_before    TEXT,
    state_after     TEXT,
    previous_sha256 TEXT NOT NULL,
    sha256          TEXT NOT NULL
);
CREATE INDEX audit_by_subject ON audit (subject, number);
CREATE INDEX audit_by_actor ON audit (actor, number);
CREATE TRIGGER audit_insert_only BEFORE UPDATE OR DELETE ON audit FOR EACH ROW EXECUTE FUNCTION refuse_change();

-- The last entry; whoever adds one holds this row until the commit.
CREATE TABLE audit_head (
    one    BIGINT NOT NULL PRIMARY KEY CHECK (one = 1),
    number BIGINT NOT NULL,
    sha256 TEXT NOT NULL
);

-- Who asked for a job, and for the version that came of it; none for those before this.
ALTER TABLE jobs ADD COLUMN author TEXT;
ALTER TABLE versions ADD COLUMN author TEXT;
