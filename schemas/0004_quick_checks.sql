-- The tables that grow with every edge, with the same rules written so that SQLite is quick at them: of
-- an IN list of more than two texts it makes a table of its own for every row that it checks, which
-- cost more than storing the row.

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
  PRIMARY KEY (spacecraft_id, t_tai_ns, channel)
) STRICT, WITHOUT ROWID;
INSERT INTO new_pulse SELECT * FROM pulse;
DROP TABLE pulse;
ALTER TABLE new_pulse RENAME TO pulse;

CREATE TABLE new_pulse_use (
  run_id        TEXT NOT NULL REFERENCES run,
  spacecraft_id TEXT NOT NULL,
  t_tai_ns      INTEGER NOT NULL,
  channel       TEXT NOT NULL CHECK (
    channel = 'sun1' OR channel = 'sun2' OR channel = 'north_in' OR channel = 'north_out'
    OR channel = 'south_in' OR channel = 'south_out'),
  revolution    INTEGER,  -- NULL: no revolution had a place for the edge
  accepted      INTEGER NOT NULL CHECK (accepted IN (0, 1)),
  rejected_by   TEXT,
  PRIMARY KEY (run_id, spacecraft_id, t_tai_ns, channel),
  CHECK (accepted = (rejected_by IS NULL))
) STRICT, WITHOUT ROWID;
INSERT INTO new_pulse_use SELECT * FROM pulse_use;
DROP TABLE pulse_use;
ALTER TABLE new_pulse_use RENAME TO pulse_use;

CREATE TABLE new_spin_measurement (
  run_id      TEXT NOT NULL REFERENCES run,
  revolution  INTEGER NOT NULL,
  quantity    TEXT NOT NULL CHECK (
    quantity = 'period' OR quantity = 'sun_angle' OR quantity = 'north_chord'
    OR quantity = 'south_chord' OR quantity = 'north_dihedral' OR quantity = 'south_dihedral'
    OR quantity = 'mixed_azimuth'),
  value       REAL NOT NULL,
  unit        TEXT NOT NULL CHECK (unit = CASE quantity WHEN 'period' THEN 's' ELSE 'deg' END),
  sigma       REAL NOT NULL CHECK (sigma >= 0),
  accepted    INTEGER NOT NULL CHECK (accepted IN (0, 1)),
  rejected_by TEXT,
  PRIMARY KEY (run_id, revolution, quantity),
  CHECK (accepted = (rejected_by IS NULL))
) STRICT, WITHOUT ROWID;
INSERT INTO new_spin_measurement SELECT * FROM spin_measurement;
DROP TABLE spin_measurement;
ALTER TABLE new_spin_measurement RENAME TO spin_measurement;

CREATE TABLE new_spin_fix (
  run_id             TEXT NOT NULL REFERENCES run,
  revolution         INTEGER NOT NULL,
  t_tai_ns           INTEGER NOT NULL,
  geometry_case      INTEGER NOT NULL CHECK (geometry_case BETWEEN 1 AND 10),
  ra_deg             REAL NOT NULL CHECK (ra_deg >= 0 AND ra_deg < 360),
  dec_deg            REAL NOT NULL CHECK (dec_deg BETWEEN -90 AND 90),
  sigma_deg          REAL NOT NULL CHECK (sigma_deg >= 0),
  cov_east_east_deg2   REAL NOT NULL,
  cov_east_north_deg2  REAL NOT NULL,
  cov_north_north_deg2 REAL NOT NULL,
  alternate_ra_deg   REAL CHECK (alternate_ra_deg >= 0 AND alternate_ra_deg < 360),
  alternate_dec_deg  REAL CHECK (alternate_dec_deg BETWEEN -90 AND 90),
  resolution         TEXT NOT NULL CHECK (
    resolution = 'GEOMETRY' OR resolution = 'CONSTRAINT' OR resolution = 'PRIOR'
    OR resolution = 'DISPERSION' OR resolution = 'AMBIGUOUS'),
  norm               REAL NOT NULL,  -- |P| before normalising: 1 for measurements that agree
  accepted           INTEGER NOT NULL CHECK (accepted IN (0, 1)),
  PRIMARY KEY (run_id, revolution),
  CHECK ((alternate_ra_deg IS NULL) = (alternate_dec_deg IS NULL))
) STRICT, WITHOUT ROWID;
INSERT INTO new_spin_fix SELECT * FROM spin_fix;
DROP TABLE spin_fix;
ALTER TABLE new_spin_fix RENAME TO spin_fix;

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
  PRIMARY KEY (run_id, estimator, t_tai_ns)
) STRICT, WITHOUT ROWID;
INSERT INTO new_spin_estimate SELECT * FROM spin_estimate;
DROP TABLE spin_estimate;
ALTER TABLE new_spin_estimate RENAME TO spin_estimate;

PRAGMA legacy_alter_table = OFF;
