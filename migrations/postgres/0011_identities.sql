-- Whom an OpenID provider knows, as which user: a subject of an issuer is one user.
CREATE TABLE identities (
    issuer     TEXT COLLATE "C" NOT NULL,
    subject    TEXT COLLATE "C" NOT NULL,
    user_name  TEXT COLLATE "C" NOT NULL REFERENCES users (name),
    created_us BIGINT NOT NULL,
    PRIMARY KEY (issuer, subject)
);
CREATE INDEX identities_by_user ON identities (user_name);

-- Sign-ins at a provider that have ended, until they would have expired: none ends twice.
CREATE TABLE spent_sign_ins (
    sha256     TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    expires_us BIGINT NOT NULL
);
CREATE INDEX spent_sign_ins_by_end ON spent_sign_ins (expires_us);
