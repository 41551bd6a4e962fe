-- What was found of a version on trials that it was not made of; the newest one of a champion is a ship's condition.
CREATE TABLE diagnoses (
    id         TEXT NOT NULL PRIMARY KEY,
    version_id TEXT NOT NULL REFERENCES versions (id),
    made_id    TEXT REFERENCES versions (id),
    report_id  TEXT NOT NULL REFERENCES reports (id),
    verdict    TEXT NOT NULL,
    effects    TEXT NOT NULL,
    trials     TEXT NOT NULL,
    created_us INTEGER NOT NULL
) STRICT;
CREATE INDEX diagnoses_by_version ON diagnoses (version_id, id);
CREATE INDEX diagnoses_by_made ON diagnoses (made_id, id);
CREATE TRIGGER diagnoses_no_update BEFORE UPDATE ON diagnoses BEGIN SELECT RAISE(ABORT, 'diagnoses is insert-only'); END;
CREATE TRIGGER diagnoses_no_delete BEFORE DELETE ON diagnoses BEGIN SELECT RAISE(ABORT, 'diagnoses is insert-only'); END;
