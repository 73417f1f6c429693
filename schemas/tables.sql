-- The tables of an archive. Instants: t_tai_ns, integer nanoseconds of TAI since 1970-01-01T00:00:00 TAI.
-- Angles: degrees. Flags: 0 or 1.
--
-- Where a table grows with every edge or revolution, a list of allowed texts is written as a chain of OR:
-- of an IN list of more than two texts SQLite makes a table of its own for every row that it checks, which
-- costs more than storing the row.

-- From start_tai_ns on, TAI - UTC = tai_minus_utc_s. Rewritten whenever a writer opens the archive.
CREATE TABLE leap_second (
  start_tai_ns    INTEGER PRIMARY KEY,
  tai_minus_utc_s INTEGER NOT NULL
) STRICT;

-- Which write-ahead log is that of this file: salt-1 of its header, and that of the log before. A program that is to
-- write refuses a log beside the file that has neither, since it was left of another file.
CREATE TABLE own_log (
  id          INTEGER PRIMARY KEY CHECK (id = 1),
  salt        INTEGER NOT NULL,
  salt_before INTEGER NOT NULL
) STRICT;
INSERT INTO own_log VALUES (1, abs(random()) % 4294967296, abs(random()) % 4294967296);

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
  config_path      TEXT NOT NULL,     -- where it was read, absolute; an orbit file that it names is relative to it
  orbit_sha256     TEXT,              -- of the orbit file; NULL: the mission names none
  telemetry_sha256 TEXT,              -- of all bytes of its files, in their order; NULL: it did not come from files
  label            TEXT,              -- that somebody gave it; NULL: none
  started_utc      TEXT NOT NULL,
  finished_utc     TEXT,              -- NULL: running, interrupted or killed
  first_arrival    INTEGER NOT NULL,  -- no sample of the run has an earlier one; rises from run to run
  first_tai_ns     INTEGER,           -- the earliest of the run's samples; NULL: none yet
  last_tai_ns      INTEGER,           -- the latest, as of the last minute of telemetry; of a run that ended exactly
  contact_share    REAL               -- of the ten-second spans of [contact], those in which samples came; NULL: none is planned
) STRICT;

-- Where its telemetry came from, in the order of the command line.
CREATE TABLE run_telemetry (
  run_id    TEXT NOT NULL REFERENCES run,
  position  INTEGER NOT NULL CHECK (position >= 1),
  telemetry TEXT NOT NULL,  -- the absolute path of a file or folder, or 'DDS domain N, partition P'
  PRIMARY KEY (run_id, position)
) STRICT, WITHOUT ROWID;

-- Telemetry: of the spacecraft, not of a run; stored once however often it arrives.
-- source, session, seq: which sample of which sender came first with it. session and seq are the bus's
-- unsigned 64 bits in SQLite's signed ones. arrival: order of arrival in the run that took the sample
-- last; larger is later. Negative: -arrival is its place among the others, and the run left the sample out,
-- since its source's time disagreed with that of the others. The keys begin with the spacecraft, so that its
-- samples in a span lie together; the indexes hold what was left out.

CREATE TABLE pulse (
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  t_tai_ns      INTEGER NOT NULL,
  channel       TEXT NOT NULL CHECK (
    channel = 'sun1' OR channel = 'sun2' OR channel = 'north_in' OR channel = 'north_out'
    OR channel = 'south_in' OR channel = 'south_out'),
  source        TEXT NOT NULL,
  session       INTEGER NOT NULL,
  seq           INTEGER NOT NULL,
  arrival       INTEGER NOT NULL,
  PRIMARY KEY (spacecraft_id, t_tai_ns, channel)
) STRICT, WITHOUT ROWID;
CREATE INDEX left_out_pulse ON pulse (spacecraft_id, arrival) WHERE arrival < 0;

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
  arrival       INTEGER NOT NULL,
  PRIMARY KEY (spacecraft_id, t_tai_ns)
) STRICT, WITHOUT ROWID;
CREATE INDEX left_out_coded_frame ON coded_frame (spacecraft_id, arrival) WHERE arrival < 0;

-- Body axes.
CREATE TABLE gyro_sample (
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  t_tai_ns      INTEGER NOT NULL,
  wx_rad_s      REAL NOT NULL,
  wy_rad_s      REAL NOT NULL,
  wz_rad_s      REAL NOT NULL,
  source        TEXT NOT NULL,
  session       INTEGER NOT NULL,
  seq           INTEGER NOT NULL,
  arrival       INTEGER NOT NULL,
  PRIMARY KEY (spacecraft_id, t_tai_ns)
) STRICT, WITHOUT ROWID;
CREATE INDEX left_out_gyro_sample ON gyro_sample (spacecraft_id, arrival) WHERE arrival < 0;

-- q_icrf_sensor, as received: its norm is 1 within 0.001.
CREATE TABLE star_sample (
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  t_tai_ns      INTEGER NOT NULL,
  qx            REAL NOT NULL,
  qy            REAL NOT NULL,
  qz            REAL NOT NULL,
  qw            REAL NOT NULL,
  source        TEXT NOT NULL,
  session       INTEGER NOT NULL,
  seq           INTEGER NOT NULL,
  arrival       INTEGER NOT NULL,
  PRIMARY KEY (spacecraft_id, t_tai_ns)
) STRICT, WITHOUT ROWID;
CREATE INDEX left_out_star_sample ON star_sample (spacecraft_id, arrival) WHERE arrival < 0;

-- Vector to the Sun, body axes.
CREATE TABLE sun_sample (
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  t_tai_ns      INTEGER NOT NULL,
  sx            REAL NOT NULL,
  sy            REAL NOT NULL,
  sz            REAL NOT NULL,
  source        TEXT NOT NULL,
  session       INTEGER NOT NULL,
  seq           INTEGER NOT NULL,
  arrival       INTEGER NOT NULL,
  PRIMARY KEY (spacecraft_id, t_tai_ns)
) STRICT, WITHOUT ROWID;
CREATE INDEX left_out_sun_sample ON sun_sample (spacecraft_id, arrival) WHERE arrival < 0;

-- Body axes.
CREATE TABLE magnetometer_sample (
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  t_tai_ns      INTEGER NOT NULL,
  bx_nt         REAL NOT NULL,
  by_nt         REAL NOT NULL,
  bz_nt         REAL NOT NULL,
  source        TEXT NOT NULL,
  session       INTEGER NOT NULL,
  seq           INTEGER NOT NULL,
  arrival       INTEGER NOT NULL,
  PRIMARY KEY (spacecraft_id, t_tai_ns)
) STRICT, WITHOUT ROWID;
CREATE INDEX left_out_magnetometer_sample ON magnetometer_sample (spacecraft_id, arrival) WHERE arrival < 0;

-- EME2000.
CREATE TABLE orbit_state_sample (
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  t_tai_ns      INTEGER NOT NULL,
  x_km          REAL NOT NULL,
  y_km          REAL NOT NULL,
  z_km          REAL NOT NULL,
  vx_km_s       REAL NOT NULL,
  vy_km_s       REAL NOT NULL,
  vz_km_s       REAL NOT NULL,
  source        TEXT NOT NULL,
  session       INTEGER NOT NULL,
  seq           INTEGER NOT NULL,
  arrival       INTEGER NOT NULL,
  PRIMARY KEY (spacecraft_id, t_tai_ns)
) STRICT, WITHOUT ROWID;
CREATE INDEX left_out_orbit_state_sample ON orbit_state_sample (spacecraft_id, arrival) WHERE arrival < 0;

-- Of samples that came with more than one value all of them, that in the table of the kind too. used: 1, it is
-- the value that counts (rejected_sample tells of another reason to leave it out). Without a preferred source none
-- does, unless the others came after it had been computed.
-- Input, too, which a restarted service reads back: arrival is as above, NULL of what the table of the kind has.
CREATE TABLE contradiction (
  run_id        TEXT NOT NULL REFERENCES run,  -- that took the one that came again
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  kind          TEXT NOT NULL CHECK (kind IN ('coded_frame', 'gyro', 'star', 'sun', 'magnetometer', 'orbit_state')),
  t_tai_ns      INTEGER NOT NULL,
  source        TEXT NOT NULL,
  session       INTEGER NOT NULL,
  seq           INTEGER NOT NULL,
  value         TEXT NOT NULL,  -- JSON: an object of the columns of the table of the kind
  used          INTEGER NOT NULL CHECK (used IN (0, 1)),
  arrival       INTEGER,
  PRIMARY KEY (run_id, kind, t_tai_ns, source, value)
) STRICT, WITHOUT ROWID;

-- Before the sample of this arrival the stream of the run's spacecraft had been silent for a second of
-- wall-clock time, and what had come was computed: an edge from before that is late.
CREATE TABLE stream_silence (
  run_id  TEXT NOT NULL REFERENCES run,
  arrival INTEGER NOT NULL,
  PRIMARY KEY (run_id, arrival)
) STRICT, WITHOUT ROWID;

-- From the sample of this arrival on, the telemetry of this source was the clock by which the others are in time
-- or left out, since none was in time by the clock of the host. NULL: the host's, or a rehearsal's, counts again.
CREATE TABLE source_clock (
  run_id  TEXT NOT NULL REFERENCES run,
  arrival INTEGER NOT NULL,
  source  TEXT,
  session INTEGER,
  PRIMARY KEY (run_id, arrival)
) STRICT, WITHOUT ROWID;

-- What an operator said of the telemetry from t_tai_ns on: input, which holds for the run that took it and
-- all later ones of its mode. arrival: its place among the samples of that run, which are before and behind it.
-- What `sequential`, `mean` and the filters have computed before stays; of what is left out `batch` and the
-- reconstruction of a separation forget that, too. exclude_segment is of its beginning on where it does not say.
CREATE TABLE operator_action (
  action_id     TEXT PRIMARY KEY,
  spacecraft_id TEXT NOT NULL REFERENCES spacecraft,
  run_id        TEXT NOT NULL REFERENCES run,
  arrival       INTEGER NOT NULL,
  t_tai_ns      INTEGER NOT NULL,
  made_utc      TEXT NOT NULL,
  by            TEXT NOT NULL CHECK (by <> ''),
  action        TEXT NOT NULL CHECK (action IN (
    'exclude_channel', 'include_channel', 'exclude_segment', 'choose_root', 'set_prior', 'mark_manoeuvre',
    'set_target', 'set_limit')),
  arguments     TEXT NOT NULL,  -- JSON: an object
  note          TEXT NOT NULL
) STRICT, WITHOUT ROWID;

-- What came in and what became of it, by run.

-- Rows that could not be read or are impossible. Of a source on the bus the first 20 in a minute; the rest
-- of the minute is one row, with the last of them and their number.
CREATE TABLE rejected_input (
  run_id  TEXT NOT NULL REFERENCES run,
  source  TEXT NOT NULL,     -- the file's path as it was given; on the bus the sample's source
  session INTEGER NOT NULL,  -- 0 for a file
  line    INTEGER NOT NULL,  -- of the file, from 1; on the bus the sample's seq
  reason  TEXT NOT NULL,
  samples INTEGER NOT NULL,  -- for which the row stands
  PRIMARY KEY (run_id, source, session, line, reason)
) STRICT, WITHOUT ROWID;

-- seq counts all spacecraft of a source, and so do these counts: what is missing belongs to none of them.
-- They stand, like the rejected rows of the bus, under the run of the first spacecraft of the service.
CREATE TABLE source_count (
  run_id     TEXT NOT NULL REFERENCES run,
  source     TEXT NOT NULL,
  received   INTEGER NOT NULL,
  gaps       INTEGER NOT NULL,  -- samples that are missing
  duplicates INTEGER NOT NULL,
  disordered INTEGER NOT NULL,
  PRIMARY KEY (run_id, source)
) STRICT, WITHOUT ROWID;

-- Why an edge, a measurement or another sample was left out. The last six are the test of the quantity of
-- that name; an edge has that of the first measurement with it, when all of them failed.
CREATE TABLE rejection (
  rejected_by TEXT PRIMARY KEY,
  says        TEXT NOT NULL
) STRICT, WITHOUT ROWID;
INSERT INTO rejection VALUES
  ('unassociated', 'no revolution had a place for the edge: spurious, doubled by chance, or ahead of the first spin period'),
  ('late', 'it arrived after its time had been processed'),
  ('out_of_time', 'far from all others in time: a sender''s clock is wrong'),
  ('contradicted', 'it came with another value, too, and no source is preferred: contradiction'),
  ('copy', 'in most revolutions the channel has several edges within a twentieth of a turn: another one counts, or this one came alone and may be either'),
  ('interference', 'an edge of another channel was, or is expected, so near that both may be spoilt'),
  ('operator', 'an operator left it out: operator_action'),
  ('phase', 'not where the edges of its channel lie, or the measurement rests on such an edge'),
  ('geometry', 'the measurement has no meaning: a chord of a whole turn, a slit lag out of range'),
  ('no_sensor', 'the mission file describes no such sensor'),
  ('no_orbit', 'the orbit does not reach: not testable, not wrong; or the orbit state is on no ellipse round the Earth'),
  ('no_field', 'the model of the Earth''s field does not reach: not testable, not wrong'),
  ('saturated', 'the gyro turns faster than it can measure'),
  ('frozen', 'the sensor gives the same numbers again and again'),
  ('outlier', 'the gyro''s samples beside it are elsewhere'),
  ('shadow', 'the Earth is before the Sun'),
  ('unit', 'the gyro''s rates are not in rad/s, by the turns between star fixes'),
  ('innovation', 'too far from where the estimator expects it, or it expects none there'),
  ('period', 'it failed the test of the spin period'),
  ('sun_angle', 'it failed the test of the sun angle'),
  ('north_chord', 'it failed the test of the north chord'),
  ('south_chord', 'it failed the test of the south chord'),
  ('north_dihedral', 'it failed the test of the north dihedral angle'),
  ('south_dihedral', 'it failed the test of the south dihedral angle'),
  ('mixed_azimuth', 'it failed the test of the mixed azimuth');

-- Not a reference to pulse: edges of coded telemetry have no row there.
CREATE TABLE pulse_use (
  run_id        TEXT NOT NULL REFERENCES run,
  spacecraft_id TEXT NOT NULL,
  t_tai_ns      INTEGER NOT NULL,
  channel       TEXT NOT NULL CHECK (
    channel = 'sun1' OR channel = 'sun2' OR channel = 'north_in' OR channel = 'north_out'
    OR channel = 'south_in' OR channel = 'south_out'),
  revolution    INTEGER,  -- NULL: no revolution had a place for the edge
  accepted      INTEGER NOT NULL CHECK (accepted IN (0, 1)),
  rejected_by   TEXT REFERENCES rejection,
  -- What it said to `sequential`, as that decided live (view edge_residual): measured minus expected time, its
  -- sigma by what the filter knew before, the limit of the one over the other, and whether it was used. Of an edge
  -- rejected by phase, or unassociated: the same by the clock that counts the turns. NULL: neither was asked; of
  -- residual_ns and sigma_ns also: the filter expected no such edge.
  residual_ns    INTEGER,
  sigma_ns       INTEGER,
  residual_limit_milli INTEGER,  -- thousandths take a quarter of the room of a number
  used           INTEGER CHECK (used IN (0, 1)),
  PRIMARY KEY (run_id, t_tai_ns, channel),  -- a run has one spacecraft
  CHECK (accepted = (rejected_by IS NULL))
) STRICT, WITHOUT ROWID;

-- Edges that were left out for a gap: of interference to the edge of another channel (measured; expected where that is too
-- narrow for both channels), of a copy or a second edge of its turn to the edge that counts. least_gap_s: what it must be.
CREATE TABLE pulse_gap (
  run_id      TEXT NOT NULL REFERENCES run,
  t_tai_ns    INTEGER NOT NULL,
  channel     TEXT NOT NULL,
  gap_s       REAL NOT NULL CHECK (gap_s >= 0),
  least_gap_s REAL NOT NULL,
  PRIMARY KEY (run_id, t_tai_ns, channel)
) STRICT, WITHOUT ROWID;

CREATE INDEX pulse_use_of_revolution ON pulse_use (run_id, revolution) WHERE revolution IS NOT NULL;

-- Of a three-axis spacecraft only the samples that the run left out. One that came again more than ten
-- minutes of telemetry later is late, too, if it was not left out before.
CREATE TABLE rejected_sample (
  run_id             TEXT NOT NULL REFERENCES run,
  t_tai_ns           INTEGER NOT NULL,
  kind               TEXT NOT NULL CHECK (
    kind = 'orbit_state' OR kind = 'gyro' OR kind = 'star' OR kind = 'sun' OR kind = 'magnetometer'),
  rejected_by        TEXT NOT NULL REFERENCES rejection,
  -- Normalised, of 2 (sun) or 3 degrees of freedom, of a magnetometer 1 (the strength) where there is no
  -- attitude yet. NULL: not by innovation
  squared_innovation REAL,
  -- What the test found, and what it was held against: innovation as squared_innovation, saturated and outlier in
  -- deg/s, frozen how many samples repeat, unit how many times too large the rates are. NULL: the test has no number
  value              REAL,
  "limit"            REAL,
  PRIMARY KEY (run_id, t_tai_ns, kind)
) STRICT, WITHOUT ROWID;

-- What each sample said to an estimator: measured minus expected, in components, with the sigma of each by what the
-- estimator knew before. star: about the body's axes; sun: about two axes across it; magnetometer: likewise, and its
-- strength, all in nT. nis: normalised innovation squared, a chi-square of dof degrees of freedom. Star fixes of batch and
-- sequential are held against the middle one of those beside them, by what the gyro turned between; dof 0: nothing was
-- expected. Of the gyro only samples that were left out: residual_1 is what the test found, limit what that was held
-- against (rejected_sample).
CREATE TABLE sample_residual (
  run_id      TEXT NOT NULL REFERENCES run,
  estimator   TEXT NOT NULL CHECK (
    estimator = 'mekf' OR estimator = 'usque' OR estimator = 'gukf' OR estimator = 'batch' OR estimator = 'sequential'),
  t_tai_ns    INTEGER NOT NULL,
  kind        TEXT NOT NULL CHECK (kind = 'gyro' OR kind = 'star' OR kind = 'sun' OR kind = 'magnetometer'),
  dof         INTEGER NOT NULL CHECK (dof BETWEEN 0 AND 3),
  unit        TEXT NOT NULL CHECK (
    unit = 'deg' OR unit = 'nT' OR unit = 'deg_s' OR unit = 'samples' OR unit = 'times'),
  residual_1  REAL,
  residual_2  REAL,  -- NULL beyond dof; likewise the following
  residual_3  REAL,
  sigma_1     REAL,
  sigma_2     REAL,
  sigma_3     REAL,
  nis         REAL,
  "limit"     REAL NOT NULL,
  used        INTEGER NOT NULL CHECK (used IN (0, 1)),
  rejected_by TEXT REFERENCES rejection,
  PRIMARY KEY (run_id, estimator, t_tai_ns, kind),
  CHECK (used = (rejected_by IS NULL))
) STRICT, WITHOUT ROWID;

-- Products: of a run, so that a reprocessing never overwrites an earlier one. Measurements and fixes do
-- not refer to revolution, which their run may store later.

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
    quantity = 'period' OR quantity = 'sun_angle' OR quantity = 'north_chord'
    OR quantity = 'south_chord' OR quantity = 'north_dihedral' OR quantity = 'south_dihedral'
    OR quantity = 'mixed_azimuth'),
  value       REAL NOT NULL,
  unit        TEXT NOT NULL CHECK (unit = CASE quantity WHEN 'period' THEN 's' ELSE 'deg' END),
  sigma       REAL NOT NULL CHECK (sigma >= 0),
  accepted    INTEGER NOT NULL CHECK (accepted IN (0, 1)),
  rejected_by TEXT REFERENCES rejection,
  -- What the test of the quantity expected, and how far from that it might be; NULL: it was not tested.
  expected    REAL,
  "limit"     REAL CHECK ("limit" >= 0),
  PRIMARY KEY (run_id, revolution, quantity),
  CHECK (accepted = (rejected_by IS NULL))
) STRICT, WITHOUT ROWID;

-- cov_*: tangent plane at the axis, east and north; sigma_deg is the square root of its trace.
CREATE TABLE spin_fix (
  run_id               TEXT NOT NULL REFERENCES run,
  revolution           INTEGER NOT NULL,
  t_tai_ns             INTEGER NOT NULL,
  geometry_case        INTEGER NOT NULL CHECK (geometry_case BETWEEN 1 AND 10),
  ra_deg               REAL NOT NULL CHECK (ra_deg >= 0 AND ra_deg < 360),
  dec_deg              REAL NOT NULL CHECK (dec_deg BETWEEN -90 AND 90),
  sigma_deg            REAL NOT NULL CHECK (sigma_deg >= 0),
  noise_sigma_deg      REAL NOT NULL CHECK (noise_sigma_deg >= 0),  -- were the mission file exact
  cov_east_east_deg2   REAL NOT NULL,
  cov_east_north_deg2  REAL NOT NULL,
  cov_north_north_deg2 REAL NOT NULL,
  alternate_ra_deg     REAL CHECK (alternate_ra_deg >= 0 AND alternate_ra_deg < 360),
  alternate_dec_deg    REAL CHECK (alternate_dec_deg BETWEEN -90 AND 90),
  resolution           TEXT NOT NULL CHECK (
    resolution = 'GEOMETRY' OR resolution = 'CONSTRAINT' OR resolution = 'PRIOR'
    OR resolution = 'DISPERSION' OR resolution = 'AMBIGUOUS'),
  norm                 REAL NOT NULL,  -- |P| before normalising: 1 for measurements that agree
  accepted             INTEGER NOT NULL CHECK (accepted IN (0, 1)),
  -- Chi-square of what the measurements have too much about the axis, by the edges' noise and what the mission
  -- file may be off.
  misfit               REAL NOT NULL CHECK (misfit >= 0),
  alternate_misfit     REAL CHECK (alternate_misfit >= 0),
  PRIMARY KEY (run_id, revolution),
  CHECK ((alternate_ra_deg IS NULL) = (alternate_dec_deg IS NULL))
) STRICT, WITHOUT ROWID;

-- The other axes of a fix that has more than one, from the second on; the first of them stands in spin_fix (view
-- spin_fix_candidate).
CREATE TABLE spin_fix_other (
  run_id     TEXT NOT NULL REFERENCES run,
  revolution INTEGER NOT NULL,
  candidate  INTEGER NOT NULL CHECK (candidate >= 2),  -- in the order of the pipeline
  ra_deg     REAL NOT NULL CHECK (ra_deg >= 0 AND ra_deg < 360),
  dec_deg    REAL NOT NULL CHECK (dec_deg BETWEEN -90 AND 90),
  misfit     REAL NOT NULL CHECK (misfit >= 0),
  PRIMARY KEY (run_id, revolution, candidate)
) STRICT, WITHOUT ROWID;

-- The axis that a run took, by `batch` where that has a solution, with the time of that; the best other axis, NULL
-- where there is none; and what settled it: its edges, or the first accepted fix that was not chosen by the pass's own axis.
-- delta_chi_square: by how much the edges fit the other axis worse, a state fitted to them near each (where that leads to the
-- same axis, phase and rate alone): their squared residuals by their noise, of an edge beyond 8 sigmas, or that a body about
-- that axis would not give, 64. NULL: only a solution of `batch` compares them.
CREATE TABLE axis_choice (
  run_id           TEXT PRIMARY KEY NOT NULL REFERENCES run,
  t_tai_ns         INTEGER NOT NULL,
  estimator        TEXT NOT NULL CHECK (estimator IN ('mean', 'sequential', 'batch')),
  ra_deg           REAL NOT NULL CHECK (ra_deg >= 0 AND ra_deg < 360),
  dec_deg          REAL NOT NULL CHECK (dec_deg BETWEEN -90 AND 90),
  other_ra_deg     REAL CHECK (other_ra_deg >= 0 AND other_ra_deg < 360),
  other_dec_deg    REAL CHECK (other_dec_deg BETWEEN -90 AND 90),
  delta_chi_square REAL,
  settled_by       TEXT NOT NULL CHECK (
    settled_by IN ('edges', 'geometry', 'constraint', 'prior', 'dispersion', 'nothing')),
  CHECK ((other_ra_deg IS NULL) = (other_dec_deg IS NULL)),
  CHECK (other_ra_deg IS NOT NULL OR delta_chi_square IS NULL)
) STRICT, WITHOUT ROWID;

-- How far one sigma of each error that the mission file may have moves an answer: true axis minus that of the
-- answer, ICRF. The errors are one draw a pass, the same for all estimators, so that what two of them share does not
-- tell them apart (view spin_comparison). Correlated errors stand as independent ones in the order of the mission
-- file, so that the sum of the squares of all rows of an answer is sigma_deg squared less noise_sigma_deg squared,
-- where it has estimated no bias.
-- of_batch: 0, of the pass when it ended; 1, of the last solution by `batch`. No rows: the file counts as exact.
CREATE TABLE axis_shift (
  run_id    TEXT NOT NULL REFERENCES run,
  of_batch  INTEGER NOT NULL CHECK (of_batch IN (0, 1)),
  estimator TEXT NOT NULL CHECK (estimator IN ('mean', 'sequential', 'batch')),
  position  INTEGER NOT NULL CHECK (position BETWEEN 1 AND 8),
  t_tai_ns  INTEGER NOT NULL,  -- when the answers were given
  x_deg     REAL NOT NULL,
  y_deg     REAL NOT NULL,
  z_deg     REAL NOT NULL,
  PRIMARY KEY (run_id, of_batch, estimator, position)
) STRICT, WITHOUT ROWID;

-- cov_* as in spin_fix.
CREATE TABLE spin_estimate (
  run_id               TEXT NOT NULL REFERENCES run,
  t_tai_ns             INTEGER NOT NULL,
  estimator            TEXT NOT NULL CHECK (
    estimator = 'mean' OR estimator = 'sequential' OR estimator = 'batch'),
  ra_deg               REAL NOT NULL CHECK (ra_deg >= 0 AND ra_deg < 360),
  dec_deg              REAL NOT NULL CHECK (dec_deg BETWEEN -90 AND 90),
  sigma_deg            REAL NOT NULL CHECK (sigma_deg >= 0),
  noise_sigma_deg      REAL NOT NULL CHECK (noise_sigma_deg >= 0),  -- what would be left if the mission file were exact
  cov_east_east_deg2   REAL NOT NULL,
  cov_east_north_deg2  REAL NOT NULL,
  cov_north_north_deg2 REAL NOT NULL,
  spin_rate_rpm        REAL NOT NULL,
  sigma_rpm            REAL NOT NULL CHECK (sigma_rpm >= 0),
  quality              TEXT NOT NULL CHECK (
    quality = 'OK' OR quality = 'CONVERGING' OR quality = 'AMBIGUOUS' OR quality = 'DOUBTFUL'
    OR quality = 'LOST'),
  reasons              TEXT NOT NULL,  -- JSON: array of objects with `code` and values
  status               TEXT NOT NULL,  -- a sentence for people made of the two
  announced_utc        TEXT,           -- of a live run, the time of the commit before it was announced; else NULL
  PRIMARY KEY (run_id, estimator, t_tai_ns)  -- the last of each is looked for once a second
) STRICT, WITHOUT ROWID;

-- Which estimate is in force (pipelines/supervision/answer_in_force.h), one row a run, as of t_tai_ns, the newest
-- estimate of the run by then: key of its row in spin_estimate; its quality, at best DOUBTFUL where estimates that are OK
-- contradict each other; which do. Stored by the supervision of the run with the estimates that it rests on.
CREATE TABLE spin_answer (
  run_id          TEXT PRIMARY KEY NOT NULL REFERENCES run,
  t_tai_ns        INTEGER NOT NULL,
  estimator       TEXT NOT NULL CHECK (estimator IN ('mean', 'sequential', 'batch')),
  estimate_tai_ns INTEGER NOT NULL,
  quality         TEXT NOT NULL CHECK (quality IN ('OK', 'CONVERGING', 'AMBIGUOUS', 'DOUBTFUL', 'LOST')),
  against         TEXT NOT NULL  -- empty: none do
) STRICT;

-- Of the last solution of the run and estimator: the next one replaces all its rows, so that a channel
-- that fell silent leaves none.
CREATE TABLE spin_bias (
  run_id     TEXT NOT NULL REFERENCES run,
  estimator  TEXT NOT NULL CHECK (estimator IN ('mean', 'sequential', 'batch')),
  name       TEXT NOT NULL,
  value      REAL CHECK ((value IS NULL) = (observable = 0)),  -- measured minus true
  unit       TEXT NOT NULL,
  sigma      REAL NOT NULL CHECK (sigma >= 0),  -- of the prior where it is not observable
  observable INTEGER NOT NULL CHECK (observable IN (0, 1)),
  -- 1: estimated with the axis; 0: held at zero, and the row is what the edges would say of all biases
  -- together, a hint where to look.
  estimated  INTEGER NOT NULL CHECK (estimated IN (0, 1)),
  PRIMARY KEY (run_id, estimator, name)
) STRICT, WITHOUT ROWID;

-- What `batch` found out beside its row of spin_estimate, whose t_tai_ns these rows have.

CREATE TABLE spin_batch (
  run_id                 TEXT NOT NULL REFERENCES run,
  t_tai_ns               INTEGER NOT NULL,
  bound_deg              REAL NOT NULL CHECK (bound_deg >= 0),  -- Cramer-Rao, both axes together
  edges                  INTEGER NOT NULL CHECK (edges > 0),
  outliers               INTEGER NOT NULL CHECK (outliers >= 0),
  residual_limit         REAL NOT NULL,  -- whitened: an edge that is farther off is an outlier
  noise                  REAL NOT NULL CHECK (noise >= 1),  -- times the stated one
  iterations             INTEGER NOT NULL,
  changed_tai_ns         INTEGER,  -- attitude or rate did, and only edges after it count; NULL: did not
  noise_sigma_deg        REAL NOT NULL CHECK (noise_sigma_deg >= 0),  -- of the axis, were the mission file exact
  consider_sigma_deg     REAL NOT NULL CHECK (consider_sigma_deg >= 0),  -- the sigma_deg of its row of spin_estimate
  rate_drift_rpm_h       REAL NOT NULL,  -- of the spin rate, even over the pass
  rate_drift_sigma_rpm_h REAL NOT NULL CHECK (rate_drift_sigma_rpm_h >= 0),
  PRIMARY KEY (run_id, t_tai_ns)
) STRICT, WITHOUT ROWID;

-- Of the whitened equations of what is estimated, largest first.
CREATE TABLE spin_batch_singular_value (
  run_id   TEXT NOT NULL,
  t_tai_ns INTEGER NOT NULL,
  position INTEGER NOT NULL CHECK (position >= 1),
  value    REAL NOT NULL CHECK (value >= 0),
  PRIMARY KEY (run_id, t_tai_ns, position),
  FOREIGN KEY (run_id, t_tai_ns) REFERENCES spin_batch ON DELETE CASCADE
) STRICT, WITHOUT ROWID;

-- Directions of the biases that the edges leave open, in words.
CREATE TABLE spin_batch_undetermined (
  run_id    TEXT NOT NULL,
  t_tai_ns  INTEGER NOT NULL,
  position  INTEGER NOT NULL CHECK (position >= 1),
  direction TEXT NOT NULL,
  PRIMARY KEY (run_id, t_tai_ns, position),
  FOREIGN KEY (run_id, t_tai_ns) REFERENCES spin_batch ON DELETE CASCADE
) STRICT, WITHOUT ROWID;

-- What each edge said to the last solution of `batch` (view edge_residual), of a run that has ended: columns as in
-- pulse_use. In whole nanoseconds, which take half the room of seconds.
CREATE TABLE batch_residual (
  run_id         TEXT NOT NULL REFERENCES run,
  is_last        INTEGER NOT NULL CHECK (is_last = 1),
  t_tai_ns       INTEGER NOT NULL,
  channel        INTEGER NOT NULL CHECK (channel BETWEEN 0 AND 5),  -- in the order of the view
  residual_ns    INTEGER,
  sigma_ns       INTEGER NOT NULL,
  used           INTEGER NOT NULL CHECK (used IN (0, 1)),
  PRIMARY KEY (run_id, is_last, t_tai_ns, channel)
) STRICT, WITHOUT ROWID;

-- The search for free nutation in what an even spin left of the edges. NULL from half_angle_deg on: none
-- was detected.
CREATE TABLE spin_nutation (
  run_id                 TEXT NOT NULL REFERENCES run,
  t_tai_ns               INTEGER NOT NULL,
  detected               INTEGER NOT NULL CHECK (detected IN (0, 1)),
  false_alarm            REAL NOT NULL,  -- chance that noise alone shows as much
  detectable_deg         REAL NOT NULL,  -- half-angle that is found in 95 of 100 such passes
  half_angle_deg         REAL,
  half_angle_sigma_deg   REAL,
  period_s               REAL,  -- of the axis round the angular momentum, as seen from outside
  period_sigma_s         REAL,
  growth_per_h           REAL,  -- of the half-angle, as a share of it
  growth_sigma_per_h     REAL,
  lean_azimuth_deg       REAL,  -- where the axis leans at at_tai_ns
  lean_azimuth_sigma_deg REAL,
  at_tai_ns              INTEGER,  -- of half_angle_deg and lean_azimuth_deg
  PRIMARY KEY (run_id, t_tai_ns)
) STRICT, WITHOUT ROWID;

-- The sensors' axis leans away from the principal axis that the body spins about. NULL from tilt_deg on:
-- none was detected, and none is in the axis.
CREATE TABLE spin_coning (
  run_id            TEXT NOT NULL REFERENCES run,
  t_tai_ns          INTEGER NOT NULL,
  detected          INTEGER NOT NULL CHECK (detected IN (0, 1)),
  detectable_deg    REAL NOT NULL,  -- tilt that is found in 95 of 100 such passes, wherever it leans
  tilt_deg          REAL,
  tilt_sigma_deg    REAL,
  azimuth_deg       REAL,  -- to which the sensors' axis leans in the body, behind sun slit 1
  azimuth_sigma_deg REAL,
  PRIMARY KEY (run_id, t_tai_ns)
) STRICT, WITHOUT ROWID;

-- What the program's own mathematics threw: the answer of the run is DOUBTFUL. At the last edge of a solution of
-- `batch` only this one is missing; at a sample (0: before any) nothing later was computed of the run.
CREATE TABLE run_fault (
  run_id   TEXT NOT NULL REFERENCES run,
  t_tai_ns INTEGER NOT NULL,
  what     TEXT NOT NULL,  -- of the exception
  PRIMARY KEY (run_id, t_tai_ns)
) STRICT, WITHOUT ROWID;

-- What the last solution of a run says of the values of the mission file that it cannot check (names, keys as in
-- [calibration]): its whitened normal equations about the file's values b0 in the units of the names, with all that the
-- pass itself is asked for eliminated. The ground of a calibration over many passes.
CREATE TABLE normal_equations (
  run_id   TEXT PRIMARY KEY NOT NULL REFERENCES run,
  t_tai_ns INTEGER NOT NULL,
  names    TEXT NOT NULL,  -- JSON: an array of texts; the others are arrays of numbers
  b0       TEXT NOT NULL,  -- one a name
  n        TEXT NOT NULL,  -- information: a square of names, row by row
  g        TEXT NOT NULL   -- score at b0, one a name
) STRICT, WITHOUT ROWID;

-- What a person should know of a run beside its numbers: what `--json` gives as `warnings`.
CREATE TABLE notice (
  run_id    TEXT NOT NULL REFERENCES run,
  t_tai_ns  INTEGER,           -- NULL: it is of the whole run
  code      TEXT NOT NULL,
  arguments TEXT NOT NULL,     -- JSON: an object
  says      TEXT NOT NULL,     -- a sentence
  PRIMARY KEY (run_id, code, arguments)
) STRICT, WITHOUT ROWID;

-- Flight against the ground model, of a run of `compare`. Flight minus model in the unit of the channel, all samples; outside: of
-- those, not within the band; normalised_rms: over the noise that the model gives the channel; NULL: no samples, as of
-- a channel that only has to come, unit ''. departed_...: the first instant from which on flight stays away, the
-- residual and the half-width of the band then; unit 's silent': nothing came where the model sends; NULL: it does not.
CREATE TABLE model_comparison (
  run_id          TEXT NOT NULL REFERENCES run,
  channel         TEXT NOT NULL,
  unit            TEXT NOT NULL,
  samples         INTEGER NOT NULL,
  outside         INTEGER NOT NULL,
  mean            REAL,
  sigma           REAL,
  rms             REAL,
  most            REAL,
  normalised_rms  REAL,
  departed_tai_ns INTEGER,
  departed_value  REAL,
  departed_limit  REAL,
  departed_unit   TEXT,
  PRIMARY KEY (run_id, channel)
) STRICT, WITHOUT ROWID;

-- q_icrf_body; rates in body axes, NULL where they are not estimated. Of mekf at most ten a second of
-- telemetry time, beside those at which it begins, falls silent or is lost.
CREATE TABLE attitude (
  run_id       TEXT NOT NULL REFERENCES run,
  t_tai_ns     INTEGER NOT NULL,
  source       TEXT NOT NULL CHECK (
    source = 'sequential' OR source = 'batch' OR source = 'mekf' OR source = 'usque'
    OR source = 'gukf' OR source = 'triad' OR source = 'quest'),
  qx           REAL NOT NULL,
  qy           REAL NOT NULL,
  qz           REAL NOT NULL,
  qw           REAL NOT NULL,
  rate_x_rad_s REAL,
  rate_y_rad_s REAL,
  rate_z_rad_s REAL,
  sigma_deg    REAL NOT NULL CHECK (sigma_deg >= 0),
  noise_sigma_deg REAL NOT NULL CHECK (noise_sigma_deg >= 0),  -- what would be left if the mission file were exact
  cov_xx_deg2  REAL NOT NULL,  -- of a small turn about the axes of the body; sigma_deg is the root of its trace
  cov_xy_deg2  REAL NOT NULL,
  cov_xz_deg2  REAL NOT NULL,
  cov_yy_deg2  REAL NOT NULL,
  cov_yz_deg2  REAL NOT NULL,
  cov_zz_deg2  REAL NOT NULL,
  quality      TEXT NOT NULL CHECK (
    quality = 'OK' OR quality = 'CONVERGING' OR quality = 'AMBIGUOUS' OR quality = 'DOUBTFUL'
    OR quality = 'LOST'),
  reasons      TEXT NOT NULL,  -- as in spin_estimate
  status       TEXT NOT NULL,
  announced_utc TEXT,          -- as in spin_estimate
  -- Of the samples that the filter accepted since its estimate before: the sum of their normalised squared
  -- innovations, a chi-square of innovation_freedom degrees of freedom when all is well. NULL: of no filter
  squared_innovations REAL,
  innovation_freedom  INTEGER,
  PRIMARY KEY (run_id, t_tai_ns, source)
) STRICT, WITHOUT ROWID;

-- Of the gyro as a filter has it, body axes, at most once a second of telemetry time: what the gyro says more
-- than the body turns.
CREATE TABLE gyro_bias (
  run_id         TEXT NOT NULL REFERENCES run,
  t_tai_ns       INTEGER NOT NULL,
  estimator      TEXT NOT NULL,
  bx_deg_s       REAL NOT NULL,
  by_deg_s       REAL NOT NULL,
  bz_deg_s       REAL NOT NULL,
  sigma_bx_deg_s REAL NOT NULL CHECK (sigma_bx_deg_s >= 0),
  sigma_by_deg_s REAL NOT NULL CHECK (sigma_by_deg_s >= 0),
  sigma_bz_deg_s REAL NOT NULL CHECK (sigma_bz_deg_s >= 0),
  PRIMARY KEY (run_id, t_tai_ns, estimator)
) STRICT, WITHOUT ROWID;

-- What the gates of a three-axis spacecraft say from then on; before its first row a gate is closed. evidence, of the
-- window of samples that decided: value of its last one, threshold, unit, hits, window (samples), share (of hits that
-- opens the gate), since_tai_ns (its first one); of lost certain (1: the Sun says the same) and sun_deg, of reached
-- sigma_deg, of safe mean_nis, sigma_deg, lead_nats.
CREATE TABLE gate_transition (
  run_id   TEXT NOT NULL REFERENCES run,
  t_tai_ns INTEGER NOT NULL,
  gate     TEXT NOT NULL CHECK (gate IN ('lost', 'usable', 'safe', 'reached')),
  open     INTEGER NOT NULL CHECK (open IN (0, 1)),
  evidence TEXT NOT NULL,  -- JSON: an object
  PRIMARY KEY (run_id, t_tai_ns, gate)
) STRICT, WITHOUT ROWID;

-- What is known of a body that is lost by the lost gate: when it is declared, when the advice changes, and once a minute.
-- sensors: of those on board, by kind, speaks, left_out (all of its last ten samples were), silent (for a minute) or
-- never. Attitude q_icrf_body with its rates in body axes, the last one of a minute: NULL while there is none.
-- may_control: the safe gate is open.
CREATE TABLE advisory (
  run_id       TEXT NOT NULL REFERENCES run,
  t_tai_ns     INTEGER NOT NULL,
  sensors      TEXT NOT NULL,  -- JSON: an object
  qx           REAL,
  qy           REAL,
  qz           REAL,
  qw           REAL,
  sigma_deg    REAL,
  rate_x_rad_s REAL,
  rate_y_rad_s REAL,
  rate_z_rad_s REAL,
  may_control  INTEGER NOT NULL CHECK (may_control IN (0, 1)),
  says         TEXT NOT NULL,  -- a sentence
  PRIMARY KEY (run_id, t_tai_ns)
) STRICT, WITHOUT ROWID;

-- The attitude from separation to the star fixes, reconstructed: its events and its history stand in the two
-- tables around. The last solution of a run; a service makes the first when the first star fix arrives, and one
-- of all samples when the run ends. t_tai_ns: of the end of the history. samples: that had come by then. Bias of the gyro: NULL but for batch. launcher_...: how far the
-- launcher's attitude at T1 is from it, chi-square of 3 degrees of freedom, the chance that errors alone keep
-- them as far apart; NULL: it told none, or no orbit frame is known.
CREATE TABLE reconstruction (
  run_id              TEXT NOT NULL REFERENCES run,
  method              TEXT NOT NULL CHECK (method IN ('batch', 'sequential')),
  t_tai_ns            INTEGER NOT NULL,
  quality             TEXT NOT NULL CHECK (
    quality = 'OK' OR quality = 'CONVERGING' OR quality = 'AMBIGUOUS' OR quality = 'DOUBTFUL'
    OR quality = 'LOST'),
  reasons             TEXT NOT NULL,  -- as in spin_estimate
  status              TEXT NOT NULL,
  samples             INTEGER NOT NULL,
  gyro_samples        INTEGER NOT NULL,
  sun_vectors         INTEGER NOT NULL,
  star_fixes          INTEGER NOT NULL,
  bias_x_rad_s        REAL,
  bias_y_rad_s        REAL,
  bias_z_rad_s        REAL,
  bias_sigma_x_rad_s  REAL,
  bias_sigma_y_rad_s  REAL,
  bias_sigma_z_rad_s  REAL,
  launcher_angle_deg  REAL,
  launcher_chi_square REAL,
  launcher_chance     REAL,
  PRIMARY KEY (run_id, method)
) STRICT, WITHOUT ROWID;

-- q_icrf_body; rates in body axes; Euler 3-1-2: 1 phi, 2 theta, 3 psi. found: 1, in the samples, as nobody named its time. NULL: the
-- mission has no orbit that covers the event; the Cramer-Rao bound but for batch.
CREATE TABLE reconstruction_event (
  run_id               TEXT NOT NULL REFERENCES run,
  method               TEXT NOT NULL CHECK (method IN ('batch', 'sequential')),
  event                TEXT NOT NULL CHECK (event IN ('T1', 'T2', 'T3', 'T4')),
  t_tai_ns             INTEGER NOT NULL,
  found                INTEGER NOT NULL CHECK (found IN (0, 1)),
  qx                   REAL NOT NULL,
  qy                   REAL NOT NULL,
  qz                   REAL NOT NULL,
  qw                   REAL NOT NULL,
  rate_x_rad_s         REAL NOT NULL,
  rate_y_rad_s         REAL NOT NULL,
  rate_z_rad_s         REAL NOT NULL,
  euler312_icrf_deg_1  REAL NOT NULL,
  euler312_icrf_deg_2  REAL NOT NULL,
  euler312_icrf_deg_3  REAL NOT NULL,
  euler312_orbit_deg_1 REAL,
  euler312_orbit_deg_2 REAL,
  euler312_orbit_deg_3 REAL,
  sigma_deg            REAL NOT NULL CHECK (sigma_deg >= 0),
  noise_sigma_deg      REAL NOT NULL CHECK (noise_sigma_deg >= 0),  -- what would be left if the mission file were exact
  cov_xx_deg2          REAL NOT NULL,  -- as in attitude
  cov_xy_deg2          REAL NOT NULL,
  cov_xz_deg2          REAL NOT NULL,
  cov_yy_deg2          REAL NOT NULL,
  cov_yz_deg2          REAL NOT NULL,
  cov_zz_deg2          REAL NOT NULL,
  bound_deg            REAL,
  PRIMARY KEY (run_id, method, event)
) STRICT, WITHOUT ROWID;

-- key: what the alert is about; one alert per key is open at a time. run_id: of the run that raised or last
-- changed it. returned_tai_ns: when its condition last returned within its hold-off. count: how often the condition
-- of its key has begun so far. accepted_by: who acknowledged it. Rows are replaced by higher revisions only.
CREATE TABLE alert (
  alert_id       TEXT PRIMARY KEY NOT NULL,
  run_id         TEXT NOT NULL REFERENCES run,
  spacecraft_id  TEXT NOT NULL REFERENCES spacecraft,
  key            TEXT NOT NULL,
  severity       TEXT NOT NULL CHECK (severity IN ('info', 'warning', 'critical')),
  state          TEXT NOT NULL CHECK (state IN ('active', 'acknowledged', 'shelved', 'cleared')),
  revision       INTEGER NOT NULL CHECK (revision > 0),
  raised_tai_ns  INTEGER NOT NULL,
  updated_tai_ns INTEGER NOT NULL,
  returned_tai_ns INTEGER,
  cleared_tai_ns INTEGER,
  shelved_until_tai_ns INTEGER,
  accepted_by    TEXT,
  accepted_tai_ns INTEGER,
  count          INTEGER NOT NULL CHECK (count > 0),
  message        TEXT NOT NULL,
  evidence       TEXT NOT NULL  -- JSON; json_valid() may not stand in a schema with trusted_schema off
) STRICT;

CREATE TABLE alert_transition (
  alert_id   TEXT NOT NULL REFERENCES alert,
  run_id     TEXT NOT NULL REFERENCES run,
  t_tai_ns   INTEGER NOT NULL,
  from_state TEXT CHECK (from_state IN ('active', 'acknowledged', 'shelved', 'cleared')),
  to_state   TEXT NOT NULL CHECK (to_state IN ('active', 'acknowledged', 'shelved', 'cleared')),
  by         TEXT NOT NULL,
  note       TEXT NOT NULL,
  PRIMARY KEY (alert_id, t_tai_ns, to_state)
) STRICT, WITHOUT ROWID;

-- SQLite has no other way to know that a revolution is a small part of a run, and would look for its edges
-- among all of the run's: rows, rows of a run, rows of a revolution.
ANALYZE;
INSERT INTO sqlite_stat1 VALUES
  ('pulse_use', 'pulse_use_of_revolution', '1000000 100000 6'),
  ('pulse_use', 'pulse_use', '1000000 100000 2 1');
