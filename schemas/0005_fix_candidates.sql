-- A revolution may leave up to four axes that its measurements do not tell apart.

-- All other axes of a fix that has more than one; the first of them stands in spin_fix too.
CREATE TABLE spin_fix_candidate (
  run_id     TEXT NOT NULL REFERENCES run,
  revolution INTEGER NOT NULL,
  candidate  INTEGER NOT NULL CHECK (candidate >= 1),  -- in the order of the pipeline
  ra_deg     REAL NOT NULL CHECK (ra_deg >= 0 AND ra_deg < 360),
  dec_deg    REAL NOT NULL CHECK (dec_deg BETWEEN -90 AND 90),
  PRIMARY KEY (run_id, revolution, candidate)
) STRICT, WITHOUT ROWID;
