-- What ships are found by. Facts and vectors are derived from a ship's document and her champion's; a ship in the queue has
-- changed since they were.
CREATE TABLE ship_facts (
    ship  TEXT COLLATE "C" NOT NULL REFERENCES ships (name),
    fact  TEXT COLLATE "C" NOT NULL,
    value DOUBLE PRECISION NOT NULL,
    PRIMARY KEY (ship, fact)
);
CREATE INDEX ship_facts_by_value ON ship_facts (fact, value, ship);

CREATE TABLE ship_vectors (
    ship     TEXT COLLATE "C" NOT NULL PRIMARY KEY REFERENCES ships (name),
    category TEXT COLLATE "C" NOT NULL,
    vectors  TEXT NOT NULL
);
CREATE INDEX ship_vectors_by_category ON ship_vectors (category, ship);

CREATE TABLE ship_tags (
    ship TEXT COLLATE "C" NOT NULL REFERENCES ships (name),
    tag  TEXT COLLATE "C" NOT NULL,
    PRIMARY KEY (ship, tag)
);
CREATE INDEX ship_tags_by_tag ON ship_tags (tag, ship);

CREATE TABLE search_queue (
    ship TEXT COLLATE "C" NOT NULL PRIMARY KEY REFERENCES ships (name),
    mark TEXT COLLATE "C" NOT NULL
);
INSERT INTO search_queue (ship, mark) SELECT name, 'migration' FROM ships;

CREATE INDEX jobs_by_kind ON jobs (kind, state, created_us);
CREATE INDEX jobs_by_state ON jobs (state, id);
CREATE INDEX trials_by_object ON trials (object_key);
CREATE INDEX diagnoses_by_report ON diagnoses (report_id);
