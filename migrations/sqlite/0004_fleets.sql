-- Sufficient statistics of trials, under the hash of all that shapes them; they can be made again from the samples.
CREATE TABLE trial_statistics (
    key        TEXT NOT NULL PRIMARY KEY,
    document   TEXT NOT NULL,
    sha256     TEXT NOT NULL,
    created_us INTEGER NOT NULL
) STRICT;

-- Ships whose models share a foundation.
CREATE TABLE families (
    name       TEXT NOT NULL PRIMARY KEY,
    title      TEXT NOT NULL,
    foundation TEXT NOT NULL REFERENCES versions (id),
    created_us INTEGER NOT NULL
) STRICT;

CREATE TABLE family_members (
    family   TEXT NOT NULL REFERENCES families (name),
    ship     TEXT NOT NULL REFERENCES ships (name),
    added_us INTEGER NOT NULL,
    PRIMARY KEY (family, ship)
) STRICT;
CREATE INDEX family_members_by_ship ON family_members (ship, family);

-- What a family has taught, each time it was learned.
CREATE TABLE family_priors (
    family     TEXT NOT NULL REFERENCES families (name),
    revision   INTEGER NOT NULL CHECK (revision > 0),
    document   TEXT NOT NULL,
    sha256     TEXT NOT NULL,
    created_us INTEGER NOT NULL,
    PRIMARY KEY (family, revision)
) STRICT;

-- A refinement of all members: its chunks are jobs, and each ship has one outcome.
CREATE TABLE bulk_refinements (
    id         TEXT NOT NULL PRIMARY KEY,
    family     TEXT NOT NULL REFERENCES families (name),
    request    TEXT NOT NULL,
    ships      INTEGER NOT NULL CHECK (ships > 0),
    created_us INTEGER NOT NULL
) STRICT;
CREATE INDEX bulk_refinements_by_family ON bulk_refinements (family, id);

CREATE TABLE bulk_chunks (
    bulk   TEXT NOT NULL REFERENCES bulk_refinements (id),
    number INTEGER NOT NULL,
    job    TEXT NOT NULL UNIQUE REFERENCES jobs (id),
    PRIMARY KEY (bulk, number)
) STRICT;

CREATE TABLE bulk_outcomes (
    bulk         TEXT NOT NULL REFERENCES bulk_refinements (id),
    ship         TEXT NOT NULL REFERENCES ships (name),
    outcome      TEXT NOT NULL CHECK (outcome IN ('champion', 'candidate', 'unchanged', 'refused')),
    version_id   TEXT REFERENCES versions (id),
    worst_change REAL,
    document     TEXT NOT NULL,
    created_us   INTEGER NOT NULL,
    PRIMARY KEY (bulk, ship)
) STRICT;

CREATE INDEX families_by_foundation ON families (foundation);
CREATE INDEX bulk_outcomes_by_ship ON bulk_outcomes (ship, bulk);
CREATE INDEX bulk_outcomes_by_version ON bulk_outcomes (version_id);

CREATE TRIGGER family_priors_no_update BEFORE UPDATE ON family_priors BEGIN SELECT RAISE(ABORT, 'family_priors is insert-only'); END;
CREATE TRIGGER family_priors_no_delete BEFORE DELETE ON family_priors BEGIN SELECT RAISE(ABORT, 'family_priors is insert-only'); END;
