-- What the estimator `batch` found out beside its row of spin_estimate, and all estimators side by side.

CREATE TABLE spin_batch (
  run_id          TEXT NOT NULL REFERENCES run,
  t_tai_ns        INTEGER NOT NULL,  -- as in spin_estimate
  bound_deg       REAL NOT NULL CHECK (bound_deg >= 0),  -- Cramer-Rao, both axes together
  edges           INTEGER NOT NULL CHECK (edges > 0),
  outliers        INTEGER NOT NULL CHECK (outliers >= 0),
  noise           REAL NOT NULL CHECK (noise >= 1),  -- times the stated one
  iterations      INTEGER NOT NULL,
  singular_values TEXT NOT NULL,  -- of the whitened equations of what is estimated, largest first; JSON
  undetermined    TEXT NOT NULL,  -- directions of the biases that the edges leave open; a line each
  changed_tai_ns  INTEGER,        -- attitude or rate did, and only edges after it count; NULL: did not
  PRIMARY KEY (run_id, t_tai_ns)
) STRICT, WITHOUT ROWID;

-- The search for free nutation in what an even spin left of the edges; t_tai_ns as in spin_estimate.
-- NULL from half_angle_deg on: none was detected.
CREATE TABLE spin_nutation (
  run_id               TEXT NOT NULL REFERENCES run,
  t_tai_ns             INTEGER NOT NULL,
  detected             INTEGER NOT NULL CHECK (detected IN (0, 1)),
  false_alarm          REAL NOT NULL,  -- chance that noise alone shows as much
  detectable_deg       REAL NOT NULL,  -- half-angle that is found in 95 of 100 such passes
  half_angle_deg       REAL,
  half_angle_sigma_deg REAL,
  period_s             REAL,  -- of the axis round the angular momentum, as seen from outside
  period_sigma_s       REAL,
  growth_per_h         REAL,  -- of the half-angle, as a share of it
  growth_sigma_per_h   REAL,
  lean_azimuth_deg     REAL,  -- where the axis leans in the middle of the pass
  lean_azimuth_sigma_deg REAL,
  PRIMARY KEY (run_id, t_tai_ns)
) STRICT, WITHOUT ROWID;

-- Angle between two axes in degrees and, of the two sigmas together, in standard deviations.
CREATE VIEW spin_comparison AS
WITH pair AS (
  SELECT a.run_id, a.spacecraft_id, a.estimator AS one, b.estimator AS other,
    a.ra_deg AS one_ra_deg, a.dec_deg AS one_dec_deg, a.sigma_deg AS one_sigma_deg,
    b.ra_deg AS other_ra_deg, b.dec_deg AS other_dec_deg, b.sigma_deg AS other_sigma_deg,
    degrees(2 * asin(min(1, sqrt(
      pow(sin(radians(a.dec_deg - b.dec_deg) / 2), 2)
      + cos(radians(a.dec_deg)) * cos(radians(b.dec_deg))
        * pow(sin(radians(a.ra_deg - b.ra_deg) / 2), 2))))) AS apart_deg,
    sqrt(a.sigma_deg * a.sigma_deg + b.sigma_deg * b.sigma_deg) AS sigma_deg
  FROM pass_answer AS a JOIN pass_answer AS b USING (run_id)
  WHERE (a.estimator = 'mean' AND b.estimator <> 'mean')
    OR (a.estimator = 'sequential' AND b.estimator = 'batch')
)
SELECT *, apart_deg / sigma_deg AS apart_sigmas, apart_deg > 3 * sigma_deg AS disagree
FROM pair;
