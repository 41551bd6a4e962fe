-- Whom an OpenID provider knows, as which user: a subject of an issuer is one user.
CREATE TABLE identities (
    issuer     TEXT NOT NULL,
    subject    TEXT NOT NULL,
    user_name  TEXT NOT NULL REFERENCES users (name),
    created_us INTEGER NOT NULL,
    PRIMARY KEY (issuer, subject)
) STRICT;
CREATE INDEX identities_by_user ON identities (user_name);

-- Sign-ins at a provider that have ended, until they would have expired: none ends twice.
CREATE TABLE spent_sign_ins (
    sha256     TEXT NOT NULL PRIMARY KEY,
    expires_us INTEGER NOT NULL
) STRICT;
CREATE INDEX spent_sign_ins_by_end ON spent_sign_ins (expires_us);
