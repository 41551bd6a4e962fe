-- Sufficient statistics of trials, under the hash of all that shapes them; they can be made again from the samples.
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

CREATE TABLE family_members (
    family   TEXT COLLATE "C" NOT NULL REFERENCES families (name),
    ship     TEXT COLLATE "C" NOT NULL REFERENCES ships (name),
    added_us BIGINT NOT NULL,
    PRIMARY KEY (family, ship)
);
CREATE INDEX family_members_by_ship ON family_members (ship, family);

-- What a family has taught, each time it was learned.
CREATE TABLE family_priors (
    family     TEXT COLLATE "C" NOT NULL REFERENCES families (name),
    revision   BIGINT NOT NULL CHECK (revision > 0),
    document   TEXT NOT NULL,
    sha256     TEXT NOT NULL,
    created_us BIGINT NOT NULL,
    PRIMARY KEY (family, revision)
);

-- A refinement of all members: its chunks are jobs, and each ship has one outcome.
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

CREATE INDEX families_by_foundation ON families (foundation);
CREATE INDEX bulk_outcomes_by_ship ON bulk_outcomes (ship, bulk);
CREATE INDEX bulk_outcomes_by_version ON bulk_outcomes (version_id);

CREATE TRIGGER family_priors_insert_only BEFORE UPDATE OR DELETE ON family_priors FOR EACH ROW EXECUTE FUNCTION refuse_change();
