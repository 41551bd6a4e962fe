-- The object that holds the weights of a version's learned branch, where it has one.
ALTER TABLE versions ADD COLUMN weights_key TEXT COLLATE "C";
CREATE INDEX versions_by_weights ON versions (weights_key) WHERE weights_key IS NOT NULL;
