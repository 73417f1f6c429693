-- What a service needs that goes on with a pass after it was stopped, and where a coded frame came from.

-- arrival: order of arrival in the run that took the sample last; larger is later.
ALTER TABLE pulse ADD COLUMN arrival INTEGER;

-- No program before this one wrote the table.
DROP TABLE coded_frame;

-- NULL: not received.
CREATE TABLE coded_frame (
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  t_tai_ns      INTEGER NOT NULL,
  period_s      REAL,
  sun2_s        REAL,
  north_in_s    REAL,
  north_out_s   REAL,
  south_in_s    REAL,
  south_out_s   REAL,
  source        TEXT NOT NULL,
  session       INTEGER NOT NULL,
  seq           INTEGER NOT NULL,
  arrival       INTEGER,
  PRIMARY KEY (spacecraft_id, t_tai_ns)
) STRICT, WITHOUT ROWID;

-- first_arrival: no sample of the run has an earlier one. NULL: of a program before this one.
ALTER TABLE run ADD COLUMN first_arrival INTEGER;
-- first_tai_ns: the earliest of the run's samples. NULL: none yet.
ALTER TABLE run ADD COLUMN first_tai_ns INTEGER;
