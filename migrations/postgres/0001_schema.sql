-- Schema of the store. Times are microseconds since 1970, ids are UUID v7 or slugs, booleans are 0 or 1, and JSON
-- documents are text, because hashes are over their exact bytes. Keys are collated by byte, as SQLite compares
-- text.

-- Trigger of insert-only tables.
CREATE FUNCTION refuse_change() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    RAISE EXCEPTION '% is insert-only', TG_TABLE_NAME;
END;
$$;

-- Laws, ships and trials
-- ----------------------

-- Laws of motion: the text of each file under its name.
CREATE TABLE laws (
    name       TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    document   TEXT NOT NULL,
    sha256     TEXT COLLATE "C" NOT NULL,
    created_us BIGINT NOT NULL
);
CREATE TRIGGER laws_insert_only BEFORE UPDATE OR DELETE ON laws
    FOR EACH ROW EXECUTE FUNCTION refuse_change();

-- Current document of each ship; a deleted ship keeps its row with the time of deletion.
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

-- Every document that a ship has had.
CREATE TABLE ship_revisions (
    ship       TEXT COLLATE "C" NOT NULL REFERENCES ships (name),
    revision   BIGINT NOT NULL,
    title      TEXT NOT NULL,
    category   TEXT COLLATE "C" NOT NULL,
    document   TEXT NOT NULL,
    created_us BIGINT NOT NULL,
    PRIMARY KEY (ship, revision)
);
CREATE TRIGGER ship_revisions_insert_only BEFORE UPDATE OR DELETE ON ship_revisions
    FOR EACH ROW EXECUTE FUNCTION refuse_change();

-- Trials of a ship, each once by the hash of its samples, which are an object of the object store.
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
CREATE INDEX trials_by_object ON trials (object_key);

-- Models and their versions
-- -------------------------

-- One row per model. Its lock orders the numbers of new versions and the moves of aliases.
CREATE TABLE models (
    name        TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    next_number BIGINT NOT NULL CHECK (next_number > 0)
);

-- `weights_key` names the object with the weights of a learned correction, `author` the principal that requested the
-- version.
CREATE TABLE versions (
    id          TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    model       TEXT COLLATE "C" NOT NULL REFERENCES models (name),
    number      BIGINT NOT NULL CHECK (number > 0),
    parent      TEXT COLLATE "C" REFERENCES versions (id),
    law         TEXT COLLATE "C" NOT NULL,
    method      TEXT NOT NULL,
    document    TEXT NOT NULL,
    sha256      TEXT COLLATE "C" NOT NULL,
    created_us  BIGINT NOT NULL,
    weights_key TEXT COLLATE "C",
    author      TEXT NOT NULL,
    UNIQUE (model, number)
);
CREATE INDEX versions_by_parent ON versions (parent, id);
CREATE INDEX versions_by_weights ON versions (weights_key) WHERE weights_key IS NOT NULL;
CREATE TRIGGER versions_insert_only BEFORE UPDATE OR DELETE ON versions
    FOR EACH ROW EXECUTE FUNCTION refuse_change();

-- Version that each alias of a model names; `revision` counts the moves, for compare-and-swap.
CREATE TABLE aliases (
    model          TEXT COLLATE "C" NOT NULL,
    alias          TEXT COLLATE "C" NOT NULL,
    version_number BIGINT NOT NULL,
    revision       BIGINT NOT NULL CHECK (revision > 0),
    PRIMARY KEY (model, alias),
    FOREIGN KEY (model, version_number) REFERENCES versions (model, number)
);

-- Every move of an alias.
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
CREATE TRIGGER alias_moves_insert_only BEFORE UPDATE OR DELETE ON alias_moves
    FOR EACH ROW EXECUTE FUNCTION refuse_change();

-- Jobs and their results
-- ----------------------

-- Answers to requests with an `Idempotency-Key`. The process that works on a request updates `alive_us`; it is null until
-- the first update.
CREATE TABLE idempotency_keys (
    scope          TEXT COLLATE "C" NOT NULL,
    key            TEXT COLLATE "C" NOT NULL,
    request_sha256 TEXT COLLATE "C" NOT NULL,
    status         BIGINT,
    response       TEXT,
    created_us     BIGINT NOT NULL,
    alive_us       BIGINT,
    PRIMARY KEY (scope, key)
);
CREATE INDEX idempotency_keys_by_age ON idempotency_keys (created_us);

-- `fence` rises with each claim, so that a worker that lost the job cannot change it; `lost_workers` counts leases that
-- expired without a report, as that of a process does which has ended. `small` jobs precede large ones of the same share.
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
    cancel_requested BIGINT NOT NULL CHECK (cancel_requested IN (0, 1)),
    lost_workers     BIGINT NOT NULL DEFAULT 0,
    author           TEXT NOT NULL,
    small            BIGINT NOT NULL DEFAULT 0 CHECK (small IN (0, 1)),
    trace_parent     TEXT
);
CREATE INDEX jobs_by_ship ON jobs (ship, id);
CREATE INDEX jobs_to_claim ON jobs (id) WHERE state IN ('queued', 'running');
CREATE INDEX jobs_by_kind ON jobs (kind, state, created_us);
CREATE INDEX jobs_by_state ON jobs (state, id);
CREATE INDEX jobs_by_author ON jobs (author, started_us);
CREATE INDEX jobs_by_share ON jobs (author, ship, started_us);

-- Report of a job, as data and as a page.
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

-- Diagnoses of versions on trials on which they were not fitted. All diagnoses of a champion together give the condition
-- of its ship: `unexplained` lists the ids of trials with a remainder that nothing explains, `drift` is a document that
-- compares the unexplained force on new trials with that on the fitted ones.
CREATE TABLE diagnoses (
    id          TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    version_id  TEXT COLLATE "C" NOT NULL REFERENCES versions (id),
    made_id     TEXT COLLATE "C" REFERENCES versions (id),
    report_id   TEXT COLLATE "C" NOT NULL REFERENCES reports (id),
    verdict     TEXT COLLATE "C" NOT NULL,
    effects     TEXT NOT NULL,
    trials      TEXT NOT NULL,
    created_us  BIGINT NOT NULL,
    unexplained TEXT NOT NULL DEFAULT '[]',
    drift       TEXT
);
CREATE INDEX diagnoses_by_version ON diagnoses (version_id, id);
CREATE INDEX diagnoses_by_made ON diagnoses (made_id, id);
CREATE INDEX diagnoses_by_report ON diagnoses (report_id);
CREATE TRIGGER diagnoses_insert_only BEFORE UPDATE OR DELETE ON diagnoses
    FOR EACH ROW EXECUTE FUNCTION refuse_change();

-- Libraries of effects under the hash by which recipes name them.
CREATE TABLE effect_libraries (
    sha256     TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    document   TEXT NOT NULL,
    created_us BIGINT NOT NULL
);
CREATE TRIGGER effect_libraries_insert_only BEFORE UPDATE OR DELETE ON effect_libraries
    FOR EACH ROW EXECUTE FUNCTION refuse_change();

-- Search of ships
-- ---------------
-- Facts and vectors are derived from the document of a ship and from its champion.

CREATE TABLE ship_facts (
    ship  TEXT COLLATE "C" NOT NULL REFERENCES ships (name),
    fact  TEXT COLLATE "C" NOT NULL,
    value DOUBLE PRECISION NOT NULL,
    PRIMARY KEY (ship, fact)
);
CREATE INDEX ship_facts_by_value ON ship_facts (fact, value, ship);

-- `stamp` identifies a state of the vectors: a cache in memory is valid while the sum of the stamps stays the same.
CREATE TABLE ship_vectors (
    ship     TEXT COLLATE "C" NOT NULL PRIMARY KEY REFERENCES ships (name),
    category TEXT COLLATE "C" NOT NULL,
    vectors  TEXT NOT NULL,
    stamp    BIGINT NOT NULL DEFAULT 0
);
CREATE INDEX ship_vectors_by_category ON ship_vectors (category, ship);
CREATE INDEX ship_vectors_by_stamp ON ship_vectors (category, stamp);

CREATE TABLE ship_tags (
    ship TEXT COLLATE "C" NOT NULL REFERENCES ships (name),
    tag  TEXT COLLATE "C" NOT NULL,
    PRIMARY KEY (ship, tag)
);
CREATE INDEX ship_tags_by_tag ON ship_tags (tag, ship);

-- How the columns of a form of file are read, kept by name for a ship or, without a ship, for the whole server.
CREATE TABLE import_templates (
    ship       TEXT COLLATE "C" NOT NULL,
    name       TEXT COLLATE "C" NOT NULL,
    document   TEXT NOT NULL,
    changed_us BIGINT NOT NULL,
    PRIMARY KEY (ship, name)
);

-- Ships that have changed since their facts and vectors were derived.
CREATE TABLE search_queue (
    ship TEXT COLLATE "C" NOT NULL PRIMARY KEY REFERENCES ships (name),
    mark TEXT COLLATE "C" NOT NULL
);

-- Fleets
-- ------

-- Sufficient statistics of trials, under the hash of everything that they depend on. They can be derived again from the
-- samples.
CREATE TABLE trial_statistics (
    key        TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    document   TEXT NOT NULL,
    sha256     TEXT NOT NULL,
    created_us BIGINT NOT NULL
);

-- Ships whose models share a foundation.
CREATE TABLE families (
    name       TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    title      TEXT NOT NULL,
    foundation TEXT COLLATE "C" NOT NULL REFERENCES versions (id),
    created_us BIGINT NOT NULL
);
CREATE INDEX families_by_foundation ON families (foundation);

CREATE TABLE family_members (
    family   TEXT COLLATE "C" NOT NULL REFERENCES families (name),
    ship     TEXT COLLATE "C" NOT NULL REFERENCES ships (name),
    added_us BIGINT NOT NULL,
    PRIMARY KEY (family, ship)
);
CREATE INDEX family_members_by_ship ON family_members (ship, family);

-- Priors that were learned from a family, one for each time.
CREATE TABLE family_priors (
    family     TEXT COLLATE "C" NOT NULL REFERENCES families (name),
    revision   BIGINT NOT NULL CHECK (revision > 0),
    document   TEXT NOT NULL,
    sha256     TEXT NOT NULL,
    created_us BIGINT NOT NULL,
    PRIMARY KEY (family, revision)
);
CREATE TRIGGER family_priors_insert_only BEFORE UPDATE OR DELETE ON family_priors
    FOR EACH ROW EXECUTE FUNCTION refuse_change();

-- Refinements of all members of a family. Chunks are jobs, and each ship has one outcome.
CREATE TABLE bulk_refinements (
    id         TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    family     TEXT COLLATE "C" NOT NULL REFERENCES families (name),
    request    TEXT NOT NULL,
    ships      BIGINT NOT NULL CHECK (ships > 0),
    created_us BIGINT NOT NULL
);
CREATE INDEX bulk_refinements_by_family ON bulk_refinements (family, id);

CREATE TABLE bulk_chunks (
    bulk   TEXT COLLATE "C" NOT NULL REFERENCES bulk_refinements (id),
    number BIGINT NOT NULL,
    job    TEXT COLLATE "C" NOT NULL UNIQUE REFERENCES jobs (id),
    PRIMARY KEY (bulk, number)
);

CREATE TABLE bulk_outcomes (
    bulk         TEXT COLLATE "C" NOT NULL REFERENCES bulk_refinements (id),
    ship         TEXT COLLATE "C" NOT NULL REFERENCES ships (name),
    outcome      TEXT COLLATE "C" NOT NULL CHECK (outcome IN ('champion', 'candidate', 'unchanged', 'refused')),
    version_id   TEXT COLLATE "C" REFERENCES versions (id),
    worst_change DOUBLE PRECISION,
    document     TEXT NOT NULL,
    created_us   BIGINT NOT NULL,
    PRIMARY KEY (bulk, ship)
);
CREATE INDEX bulk_outcomes_by_ship ON bulk_outcomes (ship, bulk);
CREATE INDEX bulk_outcomes_by_version ON bulk_outcomes (version_id);

-- Users, rights and audit
-- -----------------------

CREATE TABLE users (
    name          TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    title         TEXT NOT NULL,
    password_hash TEXT,
    created_us    BIGINT NOT NULL,
    disabled_us   BIGINT
);

-- Roles of users (`user:NAME`) and service keys (`key:PREFIX`), each for the server, a ship or a family.
CREATE TABLE grants (
    principal  TEXT COLLATE "C" NOT NULL,
    scope_kind TEXT COLLATE "C" NOT NULL CHECK (scope_kind IN ('server', 'ship', 'family')),
    scope_name TEXT COLLATE "C" NOT NULL,
    role       TEXT NOT NULL CHECK (role IN ('reader', 'engineer', 'approver', 'admin')),
    PRIMARY KEY (principal, scope_kind, scope_name)
);

-- Service keys: prefix and hash only, never the key.
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

-- Sessions of browsers, under the hash of the token.
CREATE TABLE sessions (
    sha256     TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    user_name  TEXT COLLATE "C" NOT NULL REFERENCES users (name),
    created_us BIGINT NOT NULL,
    expires_us BIGINT NOT NULL
);
CREATE INDEX sessions_by_user ON sessions (user_name);
CREATE INDEX sessions_by_end ON sessions (expires_us);

-- Users of OpenID providers: a subject of an issuer is one user.
CREATE TABLE identities (
    issuer     TEXT COLLATE "C" NOT NULL,
    subject    TEXT COLLATE "C" NOT NULL,
    user_name  TEXT COLLATE "C" NOT NULL REFERENCES users (name),
    created_us BIGINT NOT NULL,
    PRIMARY KEY (issuer, subject)
);
CREATE INDEX identities_by_user ON identities (user_name);

-- Completed sign-ins at a provider, kept until they would have expired, so that none is used twice.
CREATE TABLE spent_sign_ins (
    sha256     TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    expires_us BIGINT NOT NULL
);
CREATE INDEX spent_sign_ins_by_end ON spent_sign_ins (expires_us);

CREATE TABLE settings (
    name       TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    value      TEXT NOT NULL,
    changed_us BIGINT NOT NULL
);

-- Audit: every change with its author. The hash of an entry is over its fields and the hash of the entry before it;
-- `row_sha256` is that of the protected columns of its subject. Notes
-- on ships are entries, too, with an index of their own.
CREATE TABLE audit (
    number          BIGINT NOT NULL PRIMARY KEY CHECK (number > 0),
    at_us           BIGINT NOT NULL,
    actor           TEXT COLLATE "C" NOT NULL,
    origin          TEXT NOT NULL,
    action          TEXT NOT NULL,
    subject         TEXT COLLATE "C" NOT NULL,
    state_before    TEXT,
    state_after     TEXT,
    row_sha256      TEXT,
    previous_sha256 TEXT NOT NULL,
    sha256          TEXT NOT NULL
);
CREATE INDEX audit_by_subject ON audit (subject, number);
CREATE INDEX audit_by_actor ON audit (actor, number);
CREATE INDEX audit_notes ON audit (subject, number) WHERE action = 'ship.note';
CREATE TRIGGER audit_insert_only BEFORE UPDATE OR DELETE ON audit
    FOR EACH ROW EXECUTE FUNCTION refuse_change();

-- Last entry of the audit. A transaction that adds one locks this row until its commit.
CREATE TABLE audit_head (
    one    BIGINT NOT NULL PRIMARY KEY CHECK (one = 1),
    number BIGINT NOT NULL,
    sha256 TEXT NOT NULL
);

-- Webhooks
-- --------

-- Receivers of events. `secret` signs deliveries; an event of drift is sent when the unexplained force on new trials
-- exceeds that on the fitted ones by the factor `drift_above`.
CREATE TABLE webhooks (
    id          TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    title       TEXT NOT NULL,
    url         TEXT NOT NULL,
    secret      TEXT NOT NULL,
    ship        TEXT COLLATE "C",
    drift_above DOUBLE PRECISION NOT NULL,
    created_us  BIGINT NOT NULL,
    ended_us    BIGINT
);

CREATE TABLE webhook_events (
    event   TEXT COLLATE "C" NOT NULL,
    webhook TEXT COLLATE "C" NOT NULL REFERENCES webhooks (id),
    PRIMARY KEY (event, webhook)
);
CREATE INDEX webhook_events_by_webhook ON webhook_events (webhook, event);

-- Deliveries, written by the transaction of the event. `due_us` is null once a delivery has arrived or was given up.
CREATE TABLE deliveries (
    id           TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    webhook      TEXT COLLATE "C" NOT NULL REFERENCES webhooks (id),
    event        TEXT COLLATE "C" NOT NULL,
    body         TEXT NOT NULL,
    created_us   BIGINT NOT NULL,
    attempts     BIGINT NOT NULL,
    due_us       BIGINT,
    delivered_us BIGINT,
    answer       TEXT
);
CREATE INDEX deliveries_due ON deliveries (webhook, due_us);
CREATE INDEX deliveries_by_webhook ON deliveries (webhook, id);
