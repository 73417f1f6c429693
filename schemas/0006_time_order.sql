-- What is written together lies together: pulses of all spacecraft by their time, the estimates of a
-- moment beside each other. Each page that a commit changes goes into the log as a whole.

-- So that the views of 0002, which name these tables, stay as they are meanwhile.
PRAGMA legacy_alter_table = ON;

CREATE TABLE new_pulse (
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  t_tai_ns      INTEGER NOT NULL,
  channel       TEXT NOT NULL CHECK (
    channel = 'sun1' OR channel = 'sun2' OR channel = 'north_in' OR channel = 'north_out'
    OR channel = 'south_in' OR channel = 'south_out'),
  source        TEXT NOT NULL,
  session       INTEGER NOT NULL,
  seq           INTEGER NOT NULL,
  arrival       INTEGER,
  PRIMARY KEY (t_tai_ns, spacecraft_id, channel)
) STRICT, WITHOUT ROWID;
INSERT INTO new_pulse SELECT * FROM pulse ORDER BY t_tai_ns, spacecraft_id, channel;
DROP TABLE pulse;
ALTER TABLE new_pulse RENAME TO pulse;

CREATE TABLE new_spin_estimate (
  run_id               TEXT NOT NULL REFERENCES run,
  t_tai_ns             INTEGER NOT NULL,
  estimator            TEXT NOT NULL CHECK (
    estimator = 'mean' OR estimator = 'sequential' OR estimator = 'batch'),
  ra_deg               REAL NOT NULL CHECK (ra_deg >= 0 AND ra_deg < 360),
  dec_deg              REAL NOT NULL CHECK (dec_deg BETWEEN -90 AND 90),
  sigma_deg            REAL NOT NULL CHECK (sigma_deg >= 0),
  cov_east_east_deg2   REAL NOT NULL,
  cov_east_north_deg2  REAL NOT NULL,
  cov_north_north_deg2 REAL NOT NULL,
  spin_rate_rpm        REAL NOT NULL,
  sigma_rpm            REAL NOT NULL CHECK (sigma_rpm >= 0),
  status               TEXT NOT NULL,
  PRIMARY KEY (run_id, t_tai_ns, estimator)
) STRICT, WITHOUT ROWID;
INSERT INTO new_spin_estimate SELECT * FROM spin_estimate ORDER BY run_id, t_tai_ns, estimator;
DROP TABLE spin_estimate;
ALTER TABLE new_spin_estimate RENAME TO spin_estimate;

PRAGMA legacy_alter_table = OFF;
