-- Notes on ships are entries of the audit, found among many others.
CREATE INDEX audit_notes ON audit (subject, number) WHERE action = 'ship.note';
