-- Who is told of what happens: places on the web, each with the secret by which it knows us. Of drift
-- they are told where a champion leaves so many times as much of new trials as of those that it was
-- fitted on.
CREATE TABLE webhooks (
    id          TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    title       TEXT NOT NULL,
    url         TEXT NOT NULL,
    secret      TEXT NOT NULL,
    ship        TEXT COLLATE "C",
    drift_above DOUBLE PRECISION NOT NULL,
    created_us  BIGINT NOT NULL,
    ended_us    BIGINT
);

CREATE TABLE webhook_events (
    event   TEXT COLLATE "C" NOT NULL,
    webhook TEXT COLLATE "C" NOT NULL REFERENCES webhooks (id),
    PRIMARY KEY (event, webhook)
);
CREATE INDEX webhook_events_by_webhook ON webhook_events (webhook, event);

-- What each of them is told, written by the transaction that it tells of. Nothing is due once it has
-- arrived or was given up.
CREATE TABLE deliveries (
    id           TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    webhook      TEXT COLLATE "C" NOT NULL REFERENCES webhooks (id),
    event        TEXT COLLATE "C" NOT NULL,
    body         TEXT NOT NULL,
    created_us   BIGINT NOT NULL,
    attempts     BIGINT NOT NULL,
    due_us       BIGINT,
    delivered_us BIGINT,
    answer       TEXT
);
CREATE INDEX deliveries_due ON deliveries (due_us);
CREATE INDEX deliveries_by_webhook ON deliveries (webhook, id);
