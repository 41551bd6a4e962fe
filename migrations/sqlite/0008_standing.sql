-- Facts say how ships stand: those of every ship are written again.
INSERT INTO search_queue (ship, mark) SELECT name, 'migration 8' FROM ships WHERE true
    ON CONFLICT (ship) DO UPDATE SET mark = excluded.mark;
