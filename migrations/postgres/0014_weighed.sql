-- The condition of a ship weighs every diagnosis of its champion: which of its trials a diagnosis leaves something of that
-- nothing explains (a list of ids), and how much more the champion left of new trials than of those it was fitted on.
ALTER TABLE diagnoses ADD COLUMN unexplained TEXT NOT NULL DEFAULT '[]';
ALTER TABLE diagnoses ADD COLUMN drift TEXT;
