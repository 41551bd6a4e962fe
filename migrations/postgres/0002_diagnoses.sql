-- What was found of a version on trials that it was not made of; the newest one of a champion is a ship's condition.
CREATE TABLE diagnoses (
    id         TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    version_id TEXT COLLATE "C" NOT NULL REFERENCES versions (id),
    made_id    TEXT COLLATE "C" REFERENCES versions (id),
    report_id  TEXT COLLATE "C" NOT NULL REFERENCES reports (id),
    verdict    TEXT COLLATE "C" NOT NULL,
    effects    TEXT NOT NULL,
    trials     TEXT NOT NULL,
    created_us BIGINT NOT NULL
);
CREATE INDEX diagnoses_by_version ON diagnoses (version_id, id);
CREATE INDEX diagnoses_by_made ON diagnoses (made_id, id);
CREATE TRIGGER diagnoses_insert_only BEFORE UPDATE OR DELETE ON diagnoses FOR EACH ROW EXECUTE FUNCTION refuse_change();
