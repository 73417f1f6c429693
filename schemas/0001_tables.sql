-- Instants: t_tai_ns, integer nanoseconds of TAI since 1970-01-01T00:00:00 TAI. Angles: degrees.

-- From start_tai_ns on, TAI - UTC = tai_minus_utc_s. Rewritten whenever a writer opens the archive.
CREATE TABLE leap_second (
  start_tai_ns    INTEGER PRIMARY KEY,
  tai_minus_utc_s INTEGER NOT NULL
) STRICT;

CREATE TABLE spacecraft (
  spacecraft_id TEXT PRIMARY KEY,
  name          TEXT NOT NULL,
  kind          TEXT NOT NULL CHECK (kind IN ('spin', 'three_axis'))
) STRICT, WITHOUT ROWID;

-- Few and wide rows, for which an ordinary table is the better one; so is alert.
CREATE TABLE run (
  run_id           TEXT PRIMARY KEY NOT NULL,
  spacecraft_id    TEXT NOT NULL REFERENCES spacecraft,
  mode             TEXT NOT NULL CHECK (mode IN ('live', 'process', 'replay')),
  software_version TEXT NOT NULL,
  config_toml      TEXT NOT NULL,
  config_sha256    TEXT NOT NULL,
  orbit_sha256     TEXT,           -- of the orbit file; NULL: the mission names none
  telemetry        TEXT NOT NULL,  -- file paths, one a line, or 'DDS domain N, partition P'
  started_utc      TEXT NOT NULL,
  finished_utc     TEXT  -- NULL: running, or ended without a word
) STRICT;

-- Telemetry: of the spacecraft, not of a run; stored once however often it arrives.
-- source, session, seq: which sample of which sender came first with it. session and seq are the
-- bus's unsigned 64 bits in SQLite's signed ones.

CREATE TABLE pulse (
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  t_tai_ns      INTEGER NOT NULL,
  channel       TEXT NOT NULL CHECK (
    channel IN ('sun1', 'sun2', 'north_in', 'north_out', 'south_in', 'south_out')),
  source        TEXT NOT NULL,
  session       INTEGER NOT NULL,
  seq           INTEGER NOT NULL,
  PRIMARY KEY (spacecraft_id, t_tai_ns, channel)
) STRICT, WITHOUT ROWID;

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
  PRIMARY KEY (spacecraft_id, t_tai_ns)
) STRICT, WITHOUT ROWID;

CREATE TABLE gyro_sample (
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  t_tai_ns      INTEGER NOT NULL,
  wx_rad_s      REAL NOT NULL,
  wy_rad_s      REAL NOT NULL,
  wz_rad_s      REAL NOT NULL,
  PRIMARY KEY (spacecraft_id, t_tai_ns)
) STRICT, WITHOUT ROWID;

-- q_icrf_sensor
CREATE TABLE star_sample (
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  t_tai_ns      INTEGER NOT NULL,
  qx            REAL NOT NULL,
  qy            REAL NOT NULL,
  qz            REAL NOT NULL,
  qw            REAL NOT NULL,
  PRIMARY KEY (spacecraft_id, t_tai_ns)
) STRICT, WITHOUT ROWID;

-- Unit vector to the Sun, body axes.
CREATE TABLE sun_sample (
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  t_tai_ns      INTEGER NOT NULL,
  sx            REAL NOT NULL,
  sy            REAL NOT NULL,
  sz            REAL NOT NULL,
  PRIMARY KEY (spacecraft_id, t_tai_ns)
) STRICT, WITHOUT ROWID;

-- Body axes.
CREATE TABLE magnetometer_sample (
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  t_tai_ns      INTEGER NOT NULL,
  bx_nt         REAL NOT NULL,
  by_nt         REAL NOT NULL,
  bz_nt         REAL NOT NULL,
  PRIMARY KEY (spacecraft_id, t_tai_ns)
) STRICT, WITHOUT ROWID;

-- What came in and what became of it, by run.

CREATE TABLE rejected_input (
  run_id  TEXT NOT NULL REFERENCES run,
  source  TEXT NOT NULL,     -- the file's path as it was given; on the bus the sample's source
  session INTEGER NOT NULL,  -- 0 for a file
  line    INTEGER NOT NULL,  -- of the file, from 1; on the bus the sample's seq
  reason  TEXT NOT NULL,
  PRIMARY KEY (run_id, source, session, line, reason)
) STRICT, WITHOUT ROWID;

CREATE TABLE source_count (
  run_id     TEXT NOT NULL REFERENCES run,
  source     TEXT NOT NULL,
  received   INTEGER NOT NULL,
  gaps       INTEGER NOT NULL,  -- samples that are missing
  duplicates INTEGER NOT NULL,
  disordered INTEGER NOT NULL,
  PRIMARY KEY (run_id, source)
) STRICT, WITHOUT ROWID;

CREATE TABLE pulse_use (
  run_id        TEXT NOT NULL REFERENCES run,
  spacecraft_id TEXT NOT NULL,
  t_tai_ns      INTEGER NOT NULL,
  channel       TEXT NOT NULL CHECK (
    channel IN ('sun1', 'sun2', 'north_in', 'north_out', 'south_in', 'south_out')),
  revolution    INTEGER,  -- NULL: no revolution had a place for the edge
  accepted      INTEGER NOT NULL CHECK (accepted IN (0, 1)),
  rejected_by   TEXT,
  PRIMARY KEY (run_id, spacecraft_id, t_tai_ns, channel),
  CHECK (accepted = (rejected_by IS NULL))
) STRICT, WITHOUT ROWID;

-- Products: of a run, so that a reprocessing never overwrites an earlier one.

CREATE TABLE revolution (
  run_id     TEXT NOT NULL REFERENCES run,
  revolution INTEGER NOT NULL,
  t_tai_ns   INTEGER NOT NULL,  -- sun1
  period_s   REAL NOT NULL CHECK (period_s > 0),
  PRIMARY KEY (run_id, revolution)
) STRICT, WITHOUT ROWID;

CREATE TABLE spin_measurement (
  run_id      TEXT NOT NULL REFERENCES run,
  revolution  INTEGER NOT NULL,
  quantity    TEXT NOT NULL CHECK (
    quantity IN ('period', 'sun_angle', 'north_chord', 'south_chord', 'north_dihedral',
                 'south_dihedral', 'mixed_azimuth')),
  value       REAL NOT NULL,
  unit        TEXT NOT NULL CHECK (unit = CASE quantity WHEN 'period' THEN 's' ELSE 'deg' END),
  sigma       REAL NOT NULL CHECK (sigma >= 0),
  accepted    INTEGER NOT NULL CHECK (accepted IN (0, 1)),
  rejected_by TEXT,
  PRIMARY KEY (run_id, revolution, quantity),
  CHECK (accepted = (rejected_by IS NULL))
) STRICT, WITHOUT ROWID;

-- cov_*: tangent plane at the axis, east and north; sigma_deg is the square root of its trace.
CREATE TABLE spin_fix (
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
    resolution IN ('GEOMETRY', 'CONSTRAINT', 'PRIOR', 'DISPERSION', 'AMBIGUOUS')),
  norm               REAL NOT NULL,  -- |P| before normalising: 1 for measurements that agree
  accepted           INTEGER NOT NULL CHECK (accepted IN (0, 1)),
  PRIMARY KEY (run_id, revolution),
  CHECK ((alternate_ra_deg IS NULL) = (alternate_dec_deg IS NULL))
) STRICT, WITHOUT ROWID;

CREATE TABLE spin_estimate (
  run_id               TEXT NOT NULL REFERENCES run,
  t_tai_ns             INTEGER NOT NULL,
  estimator            TEXT NOT NULL CHECK (estimator IN ('mean', 'sequential', 'batch')),
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

CREATE TABLE spin_bias (
  run_id     TEXT NOT NULL REFERENCES run,
  estimator  TEXT NOT NULL CHECK (estimator IN ('mean', 'sequential', 'batch')),
  name       TEXT NOT NULL,
  value      REAL NOT NULL,
  unit       TEXT NOT NULL,
  sigma      REAL NOT NULL CHECK (sigma >= 0),
  observable INTEGER NOT NULL CHECK (observable IN (0, 1)),
  PRIMARY KEY (run_id, estimator, name)
) STRICT, WITHOUT ROWID;

-- q_icrf_body
CREATE TABLE attitude (
  run_id    TEXT NOT NULL REFERENCES run,
  t_tai_ns  INTEGER NOT NULL,
  source    TEXT NOT NULL CHECK (
    source IN ('sequential', 'batch', 'mekf', 'usque', 'gukf', 'triad', 'quest')),
  qx        REAL NOT NULL,
  qy        REAL NOT NULL,
  qz        REAL NOT NULL,
  qw        REAL NOT NULL,
  sigma_deg REAL NOT NULL CHECK (sigma_deg >= 0),
  PRIMARY KEY (run_id, source, t_tai_ns)
) STRICT, WITHOUT ROWID;

-- q_icrf_body; Euler 3-1-2: 1 phi, 2 theta, 3 psi. NULL: the mission has no orbit.
CREATE TABLE reconstruction_event (
  run_id               TEXT NOT NULL REFERENCES run,
  method               TEXT NOT NULL CHECK (method IN ('batch', 'sequential')),
  event                TEXT NOT NULL CHECK (event IN ('T1', 'T2', 'T3', 'T4')),
  t_tai_ns             INTEGER NOT NULL,
  qx                   REAL NOT NULL,
  qy                   REAL NOT NULL,
  qz                   REAL NOT NULL,
  qw                   REAL NOT NULL,
  euler312_icrf_deg_1  REAL NOT NULL,
  euler312_icrf_deg_2  REAL NOT NULL,
  euler312_icrf_deg_3  REAL NOT NULL,
  euler312_orbit_deg_1 REAL,
  euler312_orbit_deg_2 REAL,
  euler312_orbit_deg_3 REAL,
  sigma_deg            REAL NOT NULL CHECK (sigma_deg >= 0),
  PRIMARY KEY (run_id, method, event)
) STRICT, WITHOUT ROWID;

-- key: what the alert is about; one alert per key is open at a time.
CREATE TABLE alert (
  alert_id       TEXT PRIMARY KEY NOT NULL,
  spacecraft_id  TEXT NOT NULL REFERENCES spacecraft,
  key            TEXT NOT NULL,
  severity       TEXT NOT NULL CHECK (severity IN ('info', 'warning', 'critical')),
  state          TEXT NOT NULL CHECK (state IN ('active', 'acknowledged', 'shelved', 'cleared')),
  raised_tai_ns  INTEGER NOT NULL,
  updated_tai_ns INTEGER NOT NULL,
  cleared_tai_ns INTEGER,
  count          INTEGER NOT NULL CHECK (count > 0),
  message        TEXT NOT NULL,
  evidence       TEXT NOT NULL  -- JSON; json_valid() may not stand in a schema with trusted_schema off
) STRICT;

CREATE TABLE alert_transition (
  alert_id   TEXT NOT NULL REFERENCES alert,
  t_tai_ns   INTEGER NOT NULL,
  from_state TEXT CHECK (from_state IN ('active', 'acknowledged', 'shelved', 'cleared')),
  to_state   TEXT NOT NULL CHECK (to_state IN ('active', 'acknowledged', 'shelved', 'cleared')),
  by         TEXT NOT NULL,
  note       TEXT NOT NULL,
  PRIMARY KEY (alert_id, t_tai_ns, to_state)
) STRICT, WITHOUT ROWID;
