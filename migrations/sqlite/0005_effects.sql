-- Libraries of effects, each under the SHA-256 of its document: recipes name them.
CREATE TABLE effect_libraries (
    sha256     TEXT NOT NULL PRIMARY KEY,
    document   TEXT NOT NULL,
    created_us INTEGER NOT NULL
) STRICT;
CREATE TRIGGER effect_libraries_no_update BEFORE UPDATE ON effect_libraries BEGIN SELECT RAISE(ABORT, 'effect_libraries is insert-only'); END;
CREATE TRIGGER effect_libraries_no_delete BEFORE DELETE ON effect_libraries BEGIN SELECT RAISE(ABORT, 'effect_libraries is insert-only'); END;
