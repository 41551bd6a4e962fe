-- What ships are found by. Facts and vectors are derived from a ship's document and her champion's; a ship in the queue has
-- changed since they were.
CREATE TABLE ship_facts (
    ship  TEXT NOT NULL REFERENCES ships (name),
    fact  TEXT NOT NULL,
    value REAL NOT NULL,
    PRIMARY KEY (ship, fact)
) STRICT, WITHOUT ROWID;
CREATE INDEX ship_facts_by_value ON ship_facts (fact, value, ship);

CREATE TABLE ship_vectors (
    ship     TEXT NOT NULL PRIMARY KEY REFERENCES ships (name),
    category TEXT NOT NULL,
    vectors  TEXT NOT NULL
) STRICT, WITHOUT ROWID;
CREATE INDEX ship_vectors_by_category ON ship_vectors (category, ship);

CREATE TABLE ship_tags (
    ship TEXT NOT NULL REFERENCES ships (name),
    tag  TEXT NOT NULL,
    PRIMARY KEY (ship, tag)
) STRICT, WITHOUT ROWID;
CREATE INDEX ship_tags_by_tag ON ship_tags (tag, ship);

CREATE TABLE search_queue (
    ship TEXT NOT NULL PRIMARY KEY REFERENCES ships (name),
    mark TEXT NOT NULL
) STRICT, WITHOUT ROWID;
INSERT INTO search_queue (ship, mark) SELECT name, 'migration' FROM ships;

CREATE INDEX jobs_by_kind ON jobs (kind, state, created_us);
CREATE INDEX jobs_by_state ON jobs (state, id);
CREATE INDEX trials_by_object ON trials (object_key);
CREATE INDEX diagnoses_by_report ON diagnoses (report_id);
