-- How many workers a job has lost: those whose lease ran out without a word, as that of a process does which has ended.
ALTER TABLE jobs ADD COLUMN lost_workers INTEGER NOT NULL DEFAULT 0;
-- When whoever carries a request out has last said so; none before the first time.
ALTER TABLE idempotency_keys ADD COLUMN alive_us INTEGER;
