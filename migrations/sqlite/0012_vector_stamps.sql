-- Tells rows whose vectors have changed: whoever keeps vectors in memory compares the sum.
ALTER TABLE ship_vectors ADD COLUMN stamp INTEGER NOT NULL DEFAULT 0;
CREATE INDEX ship_vectors_by_stamp ON ship_vectors (category, stamp);
