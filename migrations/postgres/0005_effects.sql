-- Libraries of effects, each under the SHA-256 of its document: recipes name them.
CREATE TABLE effect_libraries (
    sha256     TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    document   TEXT NOT NULL,
    created_us BIGINT NOT NULL
);
CREATE TRIGGER effect_libraries_insert_only BEFORE UPDATE OR DELETE ON effect_libraries FOR EACH ROW EXECUTE FUNCTION refuse_change();
