-- Tells rows whose vectors have changed: whoever keeps vectors in memory compares the sum.
ALTER TABLE ship_vectors ADD COLUMN stamp BIGINT NOT NULL DEFAULT 0;
CREATE INDEX ship_vectors_by_stamp ON ship_vectors (category, stamp);

-- Facts say what champions leave of trials: those of every ship are written again.
INSERT INTO search_queue (ship, mark) SELECT name, 'migration 12' FROM ships WHERE true
    ON CONFLICT (ship) DO UPDATE SET mark = excluded.mark;
