-- Views for people: UTC as ISO 8601 text, milliseconds cut off, not rounded.
--
-- The text is built from whole seconds and whole milliseconds, so no floating point is involved.
-- The row of leap_second in force one second *later* is asked for: within a leap second it is the
-- new offset, with which the second counts as 23:59:59 again; start_tai_ns > t_tai_ns then makes
-- it 23:59:60. NULL before 1972, where UTC was not whole seconds from TAI. SQL has no function to
-- share the expression by, hence its copies: one for each table that other views do not build on.

CREATE VIEW pulse_utc AS
SELECT
  (SELECT strftime('%Y-%m-%dT%H:%M:', t_tai_ns / 1000000000 - tai_minus_utc_s, 'unixepoch')
     || format('%02d.%03dZ',
               (t_tai_ns / 1000000000 - tai_minus_utc_s) % 60 + (start_tai_ns > t_tai_ns),
               t_tai_ns / 1000000 % 1000)
   FROM leap_second WHERE start_tai_ns <= t_tai_ns + 1000000000
   ORDER BY start_tai_ns DESC LIMIT 1) AS utc,
  *
FROM pulse;

CREATE VIEW revolution_utc AS
SELECT
  (SELECT strftime('%Y-%m-%dT%H:%M:', t_tai_ns / 1000000000 - tai_minus_utc_s, 'unixepoch')
     || format('%02d.%03dZ',
               (t_tai_ns / 1000000000 - tai_minus_utc_s) % 60 + (start_tai_ns > t_tai_ns),
               t_tai_ns / 1000000 % 1000)
   FROM leap_second WHERE start_tai_ns <= t_tai_ns + 1000000000
   ORDER BY start_tai_ns DESC LIMIT 1) AS utc,
  *,
  60.0 / period_s AS spin_rate_rpm
FROM revolution;

CREATE VIEW spin_fix_utc AS
SELECT
  (SELECT strftime('%Y-%m-%dT%H:%M:', t_tai_ns / 1000000000 - tai_minus_utc_s, 'unixepoch')
     || format('%02d.%03dZ',
               (t_tai_ns / 1000000000 - tai_minus_utc_s) % 60 + (start_tai_ns > t_tai_ns),
               t_tai_ns / 1000000 % 1000)
   FROM leap_second WHERE start_tai_ns <= t_tai_ns + 1000000000
   ORDER BY start_tai_ns DESC LIMIT 1) AS utc,
  *
FROM spin_fix;

CREATE VIEW spin_estimate_utc AS
SELECT
  (SELECT strftime('%Y-%m-%dT%H:%M:', t_tai_ns / 1000000000 - tai_minus_utc_s, 'unixepoch')
     || format('%02d.%03dZ',
               (t_tai_ns / 1000000000 - tai_minus_utc_s) % 60 + (start_tai_ns > t_tai_ns),
               t_tai_ns / 1000000 % 1000)
   FROM leap_second WHERE start_tai_ns <= t_tai_ns + 1000000000
   ORDER BY start_tai_ns DESC LIMIT 1) AS utc,
  *
FROM spin_estimate;

CREATE VIEW run_fault_utc AS
SELECT
  (SELECT strftime('%Y-%m-%dT%H:%M:', t_tai_ns / 1000000000 - tai_minus_utc_s, 'unixepoch')
     || format('%02d.%03dZ',
               (t_tai_ns / 1000000000 - tai_minus_utc_s) % 60 + (start_tai_ns > t_tai_ns),
               t_tai_ns / 1000000 % 1000)
   FROM leap_second WHERE start_tai_ns <= t_tai_ns + 1000000000
   ORDER BY start_tai_ns DESC LIMIT 1) AS utc,
  *
FROM run_fault;

CREATE VIEW attitude_utc AS
SELECT
  (SELECT strftime('%Y-%m-%dT%H:%M:', t_tai_ns / 1000000000 - tai_minus_utc_s, 'unixepoch')
     || format('%02d.%03dZ',
               (t_tai_ns / 1000000000 - tai_minus_utc_s) % 60 + (start_tai_ns > t_tai_ns),
               t_tai_ns / 1000000 % 1000)
   FROM leap_second WHERE start_tai_ns <= t_tai_ns + 1000000000
   ORDER BY start_tai_ns DESC LIMIT 1) AS utc,
  *
FROM attitude;

-- Every sample of a three-axis spacecraft that a run left out, the test that did, and in words.
CREATE VIEW rejected_sample_utc AS
SELECT
  (SELECT strftime('%Y-%m-%dT%H:%M:', t_tai_ns / 1000000000 - tai_minus_utc_s, 'unixepoch')
     || format('%02d.%03dZ',
               (t_tai_ns / 1000000000 - tai_minus_utc_s) % 60 + (start_tai_ns > t_tai_ns),
               t_tai_ns / 1000000 % 1000)
   FROM leap_second WHERE start_tai_ns <= t_tai_ns + 1000000000
   ORDER BY start_tai_ns DESC LIMIT 1) AS utc,
  *
FROM rejected_sample JOIN rejection USING (rejected_by);

-- Of what, when, and in words.
CREATE VIEW notice_utc AS
SELECT
  (SELECT strftime('%Y-%m-%dT%H:%M:', t_tai_ns / 1000000000 - tai_minus_utc_s, 'unixepoch')
     || format('%02d.%03dZ',
               (t_tai_ns / 1000000000 - tai_minus_utc_s) % 60 + (start_tai_ns > t_tai_ns),
               t_tai_ns / 1000000 % 1000)
   FROM leap_second WHERE start_tai_ns <= t_tai_ns + 1000000000
   ORDER BY start_tai_ns DESC LIMIT 1) AS utc,
  *
FROM notice;

-- The time of a revolution is that of its sun1, or of its first edge where it has none.
CREATE VIEW spin_measurement_utc AS
SELECT
  (SELECT strftime('%Y-%m-%dT%H:%M:', t_tai_ns / 1000000000 - tai_minus_utc_s, 'unixepoch')
     || format('%02d.%03dZ',
               (t_tai_ns / 1000000000 - tai_minus_utc_s) % 60 + (start_tai_ns > t_tai_ns),
               t_tai_ns / 1000000 % 1000)
   FROM leap_second WHERE start_tai_ns <= t_tai_ns + 1000000000
   ORDER BY start_tai_ns DESC LIMIT 1) AS utc,
  *
FROM (
  SELECT ifnull(
      (SELECT t_tai_ns FROM revolution
       WHERE revolution.run_id = spin_measurement.run_id AND revolution.revolution = spin_measurement.revolution),
      (SELECT min(t_tai_ns) FROM pulse_use
       WHERE pulse_use.run_id = spin_measurement.run_id AND pulse_use.revolution = spin_measurement.revolution)
    ) AS t_tai_ns, spin_measurement.*
  FROM spin_measurement
);

-- Every edge that a run left out, the test that did, and in words. Edges of coded telemetry have no source here.
CREATE VIEW rejected_pulse AS
SELECT run_id,
  (SELECT strftime('%Y-%m-%dT%H:%M:', t_tai_ns / 1000000000 - tai_minus_utc_s, 'unixepoch')
     || format('%02d.%03dZ',
               (t_tai_ns / 1000000000 - tai_minus_utc_s) % 60 + (start_tai_ns > t_tai_ns),
               t_tai_ns / 1000000 % 1000)
   FROM leap_second WHERE start_tai_ns <= t_tai_ns + 1000000000
   ORDER BY start_tai_ns DESC LIMIT 1) AS utc,
  spacecraft_id, t_tai_ns, channel, revolution, rejected_by, says, source, session, seq
FROM pulse_use JOIN rejection USING (rejected_by)
  LEFT JOIN pulse USING (spacecraft_id, t_tai_ns, channel)
WHERE accepted = 0;

-- All axes that a revolution allows: 0 is the one of its fix, the others in the order of the pipeline. misfit: chi-square of
-- what the measurements have too much about it.
CREATE VIEW spin_fix_candidate AS
SELECT run_id, revolution, 0 AS candidate, ra_deg, dec_deg, misfit FROM spin_fix
UNION ALL
SELECT run_id, revolution, 1, alternate_ra_deg, alternate_dec_deg, alternate_misfit FROM spin_fix
WHERE alternate_ra_deg IS NOT NULL
UNION ALL
SELECT run_id, revolution, candidate, ra_deg, dec_deg, misfit FROM spin_fix_other;

-- What each edge said to an estimator: measured minus expected time, its sigma by what the estimator knew before, and the
-- limit of the one over the other. Edges that the clock of turns rejected ahead of `sequential` stand with it.
CREATE VIEW edge_residual AS
SELECT run_id, t_tai_ns, channel, 'sequential' AS estimator, revolution,
  residual_ns / 1e9 AS residual_s, sigma_ns / 1e9 AS sigma_s, residual_ns * 1.0 / sigma_ns AS whitened,
  residual_limit_milli / 1e3 AS "limit", used,
  CASE used WHEN 0 THEN coalesce(rejected_by, 'innovation') END AS rejected_by
FROM pulse_use WHERE used IS NOT NULL
UNION ALL
SELECT said.run_id, said.t_tai_ns, named.channel, 'batch', revolution,
  said.residual_ns / 1e9, said.sigma_ns / 1e9, said.residual_ns * 1.0 / said.sigma_ns,
  (SELECT residual_limit FROM spin_batch WHERE spin_batch.run_id = said.run_id ORDER BY t_tai_ns DESC LIMIT 1),
  said.used, CASE said.used WHEN 0 THEN 'innovation' END
FROM batch_residual AS said JOIN (SELECT 0 AS number, 'sun1' AS channel UNION ALL VALUES
    (1, 'sun2'), (2, 'north_in'), (3, 'north_out'), (4, 'south_in'), (5, 'south_out')) AS named ON named.number = said.channel
  LEFT JOIN pulse_use ON pulse_use.run_id = said.run_id AND pulse_use.t_tai_ns = said.t_tai_ns
    AND pulse_use.channel = named.channel;

-- How many edges, measurements, other samples and input rows were left out, by reason.
CREATE VIEW rejection_summary AS
SELECT run_id, 'pulse' AS what, channel AS name, rejected_by, count(*) AS rejected
FROM pulse_use WHERE accepted = 0 GROUP BY run_id, channel, rejected_by
UNION ALL
SELECT run_id, 'measurement', quantity, rejected_by, count(*)
FROM spin_measurement WHERE accepted = 0 GROUP BY run_id, quantity, rejected_by
UNION ALL
SELECT run_id, 'sample', kind, rejected_by, count(*)
FROM rejected_sample GROUP BY run_id, kind, rejected_by
UNION ALL
SELECT run_id, 'input', source, reason, sum(samples)
FROM rejected_input GROUP BY run_id, source, reason;

-- The answer of a pass: the last estimate of each estimator of each run; finished = 0: of a run that goes
-- on, or was interrupted. One of before a manoeuvre that was marked is of another axis, and no answer any more.
-- Each is looked for from the end of its run, and CROSS JOIN keeps it so: all estimates of a day take most of a second.
CREATE VIEW pass_answer AS
WITH last AS (
  SELECT run_id, one.estimator,
    (SELECT t_tai_ns FROM spin_estimate
     WHERE spin_estimate.run_id = run.run_id AND spin_estimate.estimator = one.estimator
     ORDER BY t_tai_ns DESC LIMIT 1) AS t_tai_ns
  FROM run, (SELECT 'mean' AS estimator UNION ALL SELECT 'sequential' UNION ALL SELECT 'batch') AS one
)
SELECT spacecraft_id, finished_utc IS NOT NULL AS finished, spin_estimate_utc.*
FROM last CROSS JOIN spin_estimate_utc USING (run_id, estimator, t_tai_ns) JOIN run USING (run_id)
WHERE NOT EXISTS (
  SELECT * FROM operator_action AS marked JOIN run AS told ON told.run_id = marked.run_id
  WHERE marked.spacecraft_id = run.spacecraft_id AND told.mode = run.mode AND told.first_arrival <= run.first_arrival
    AND marked.action = 'mark_manoeuvre' AND marked.t_tai_ns > last.t_tai_ns
    AND EXISTS (SELECT * FROM spin_estimate AS later WHERE later.run_id = last.run_id
      AND later.estimator IN ('mean', 'sequential', 'batch') AND later.t_tai_ns >= marked.t_tai_ns));

-- The answers of a run two by two: apart in degrees and in the sigma of their difference. Of noise that is the
-- larger of the two, since estimators of the same edges differ by no more than the worse of them errs (Hausman
-- 1978: the variance of the difference from an efficient one is the difference of the variances). Errors of the
-- mission file are the same for both, and only what they move one further than the other counts (axis_shift; while a run
-- goes on, as much as they may move both). They disagree from 3 sigmas on, which is worth a look. Two that are AMBIGUOUS do
-- not, whichever of the roots each names first. What contradicts the answer in force is in spin_answer.
CREATE VIEW spin_comparison AS
WITH pair AS (
  SELECT a.run_id, a.spacecraft_id, a.finished, a.estimator AS one, b.estimator AS other,
    a.ra_deg AS one_ra_deg, a.dec_deg AS one_dec_deg, a.sigma_deg AS one_sigma_deg, a.quality AS one_quality,
    b.ra_deg AS other_ra_deg, b.dec_deg AS other_dec_deg, b.sigma_deg AS other_sigma_deg, b.quality AS other_quality,
    degrees(2 * asin(min(1, sqrt(
      pow(sin(radians(a.dec_deg - b.dec_deg) / 2), 2)
      + cos(radians(a.dec_deg)) * cos(radians(b.dec_deg))
        * pow(sin(radians(a.ra_deg - b.ra_deg) / 2), 2))))) AS apart_deg,
    sqrt(pow(max(a.noise_sigma_deg, b.noise_sigma_deg), 2) + ifnull(
      (SELECT sum(pow(one.x_deg - other.x_deg, 2) + pow(one.y_deg - other.y_deg, 2)
        + pow(one.z_deg - other.z_deg, 2))
       FROM axis_shift AS one JOIN axis_shift AS other USING (run_id, position)
       WHERE one.run_id = a.run_id AND (one.of_batch, one.estimator) = (a.estimator = 'batch', a.estimator)
         AND (other.of_batch, other.estimator) = (b.estimator = 'batch', b.estimator)),
      pow(sqrt(max(pow(a.sigma_deg, 2) - pow(a.noise_sigma_deg, 2), 0))
        + sqrt(max(pow(b.sigma_deg, 2) - pow(b.noise_sigma_deg, 2), 0)), 2))) AS sigma_deg
  FROM pass_answer AS a JOIN pass_answer AS b USING (run_id)
  WHERE (a.estimator = 'mean' AND b.estimator <> 'mean')
    OR (a.estimator = 'sequential' AND b.estimator = 'batch')
)
SELECT *, apart_deg / sigma_deg AS apart_sigmas,
  apart_deg > 3 * sigma_deg AND NOT (one_quality = 'AMBIGUOUS' AND other_quality = 'AMBIGUOUS') AS disagree
FROM pair;

-- The answer of a pass of a three-axis spacecraft: the last attitude of each run, but for those that were
-- reconstructed of a separation. Looked for from the end, as above.
CREATE VIEW attitude_answer AS
SELECT spacecraft_id, finished_utc IS NOT NULL AS finished, attitude_utc.*
FROM run CROSS JOIN attitude_utc ON attitude_utc.run_id = run.run_id
  AND (attitude_utc.t_tai_ns, attitude_utc.source) =
    (SELECT t_tai_ns, source FROM attitude WHERE attitude.run_id = run.run_id
     AND source NOT IN ('batch', 'sequential') ORDER BY t_tai_ns DESC, source LIMIT 1);

-- When its telemetry begins and ends.
CREATE VIEW run_utc AS
SELECT
  (SELECT strftime('%Y-%m-%dT%H:%M:', first_tai_ns / 1000000000 - tai_minus_utc_s, 'unixepoch')
     || format('%02d.%03dZ',
               (first_tai_ns / 1000000000 - tai_minus_utc_s) % 60 + (start_tai_ns > first_tai_ns),
               first_tai_ns / 1000000 % 1000)
   FROM leap_second WHERE start_tai_ns <= first_tai_ns + 1000000000
   ORDER BY start_tai_ns DESC LIMIT 1) AS start_utc,
  (SELECT strftime('%Y-%m-%dT%H:%M:', last_tai_ns / 1000000000 - tai_minus_utc_s, 'unixepoch')
     || format('%02d.%03dZ',
               (last_tai_ns / 1000000000 - tai_minus_utc_s) % 60 + (start_tai_ns > last_tai_ns),
               last_tai_ns / 1000000 % 1000)
   FROM leap_second WHERE start_tai_ns <= last_tai_ns + 1000000000
   ORDER BY start_tai_ns DESC LIMIT 1) AS end_utc,
  *
FROM run;

-- One row a run: the answer in force (spin_answer), or the last attitude, or of a run that only reconstructed a
-- separation the attitude at T1; and whether to act on it: one of a run that failed to compute (run_fault) is DOUBTFUL,
-- unless it is LOST. t_tai_ns, utc: of the answer. NULL from
-- estimator to sigma_deg: the run has no answer; quality is then that of the run that failed. A spin axis leaves qx
-- to qw NULL, an attitude ra_deg, dec_deg and the rates. `why` is first what speaks against the answer, of a body that is lost the last advisory, then its own status;
-- `against` what speaks against it alone, with its own status unless that is OK: empty where nothing does.
-- sigma_deg is of noise and of what the mission file may be off by, noise_sigma_deg of noise alone, NULL: the estimator
-- does not say; `why` ends with the part that is alignment, if that is a hundredth or more. consider_sigma_deg: the same as sigma_deg. cov_*: of a spin axis east and north in the tangent plane, of an attitude about the axes of
-- the body; the others NULL. start_utc, end_utc: of the telemetry. contact_share: as in run.
CREATE VIEW pass_verdict AS
SELECT run_id, spacecraft_id, started_utc, finished, estimator, quality, ra_deg, dec_deg, qx, qy, qz, qw, sigma_deg,
  noise_sigma_deg, sigma_deg AS consider_sigma_deg, cov_east_east_deg2, cov_east_north_deg2, cov_north_north_deg2, cov_xx_deg2, cov_xy_deg2,
  cov_xz_deg2, cov_yy_deg2, cov_yz_deg2, cov_zz_deg2, spin_rate_rpm, sigma_rpm, start_utc, end_utc, contact_share, t_tai_ns,
  (SELECT strftime('%Y-%m-%dT%H:%M:', t_tai_ns / 1000000000 - tai_minus_utc_s, 'unixepoch')
     || format('%02d.%03dZ',
               (t_tai_ns / 1000000000 - tai_minus_utc_s) % 60 + (start_tai_ns > t_tai_ns),
               t_tai_ns / 1000000 % 1000)
   FROM leap_second WHERE start_tai_ns <= t_tai_ns + 1000000000
   ORDER BY start_tai_ns DESC LIMIT 1) AS utc,
  others || status || iif(noise_sigma_deg < 0.99995 * sigma_deg, format('; %.2g of %.2g deg is alignment',
    sqrt(pow(sigma_deg, 2) - pow(noise_sigma_deg, 2)), sigma_deg), '') AS why,
  CASE own_quality WHEN 'OK' THEN rtrim(others, '; ') ELSE others || status END AS against
FROM (
  SELECT run.run_id, run.spacecraft_id, run.started_utc, run.finished_utc IS NOT NULL AS finished,
    coalesce(axis.estimator, source, separation.method) AS estimator,
    coalesce(axis.t_tai_ns, attitude.t_tai_ns, event.t_tai_ns) AS t_tai_ns,
    CASE WHEN 'LOST' IN (answer.quality, attitude.quality) THEN 'LOST'
      WHEN fault.what IS NOT NULL THEN 'DOUBTFUL'
      ELSE coalesce(answer.quality, attitude.quality, separation.quality) END AS quality,
    coalesce(axis.quality, attitude.quality, separation.quality) AS own_quality,
    ra_deg, dec_deg, ifnull(attitude.qx, event.qx) AS qx, ifnull(attitude.qy, event.qy) AS qy,
    ifnull(attitude.qz, event.qz) AS qz, ifnull(attitude.qw, event.qw) AS qw,
    coalesce(axis.sigma_deg, attitude.sigma_deg, event.sigma_deg) AS sigma_deg,
    coalesce(axis.noise_sigma_deg, attitude.noise_sigma_deg, event.noise_sigma_deg) AS noise_sigma_deg,
    spin_rate_rpm, sigma_rpm,
    cov_east_east_deg2, cov_east_north_deg2, cov_north_north_deg2,
    ifnull(attitude.cov_xx_deg2, event.cov_xx_deg2) AS cov_xx_deg2, ifnull(attitude.cov_xy_deg2, event.cov_xy_deg2) AS cov_xy_deg2,
    ifnull(attitude.cov_xz_deg2, event.cov_xz_deg2) AS cov_xz_deg2, ifnull(attitude.cov_yy_deg2, event.cov_yy_deg2) AS cov_yy_deg2,
    ifnull(attitude.cov_yz_deg2, event.cov_yz_deg2) AS cov_yz_deg2, ifnull(attitude.cov_zz_deg2, event.cov_zz_deg2) AS cov_zz_deg2,
    (SELECT start_utc FROM run_utc WHERE run_utc.run_id = run.run_id) AS start_utc,
    (SELECT end_utc FROM run_utc WHERE run_utc.run_id = run.run_id) AS end_utc, run.contact_share,
    ifnull('computing failed' || ifnull(' at ' || fault.utc, '') || ': ' || fault.what || '; ', '')
      || ifnull(nullif(answer.against, '') || '; ', '')
      || ifnull((SELECT says FROM advisory WHERE advisory.run_id = run.run_id AND ifnull((SELECT open
        FROM gate_transition WHERE gate_transition.run_id = run.run_id AND gate = 'lost'
        ORDER BY gate_transition.t_tai_ns DESC LIMIT 1), 0)
        ORDER BY advisory.t_tai_ns DESC LIMIT 1) || '; ', '') AS others,
    coalesce(axis.status, attitude.status, separation.status, 'no estimate') AS status
  FROM run LEFT JOIN spin_answer AS answer USING (run_id)
  LEFT JOIN spin_estimate AS axis ON axis.run_id = run.run_id
    AND (axis.t_tai_ns, axis.estimator) = (answer.estimate_tai_ns, answer.estimator)
  LEFT JOIN attitude ON attitude.run_id = run.run_id AND (attitude.t_tai_ns, attitude.source) =
    (SELECT t_tai_ns, source FROM attitude_answer WHERE attitude_answer.run_id = run.run_id)
  LEFT JOIN reconstruction AS separation ON attitude.run_id IS NULL AND separation.run_id = run.run_id
    AND separation.method = (SELECT min(method) FROM reconstruction WHERE reconstruction.run_id = run.run_id)
  LEFT JOIN reconstruction_event AS event ON event.run_id = separation.run_id
    AND event.method = separation.method AND event.event = 'T1'
  LEFT JOIN run_fault_utc AS fault ON fault.run_id = run.run_id AND fault.t_tai_ns =
    (SELECT min(t_tai_ns) FROM run_fault WHERE run_fault.run_id = run.run_id)
);

-- The attitude at separation, one row a run with a reconstruction: by `batch`, where there is none by `sequential`.
CREATE VIEW separation_verdict AS
SELECT run_id, method, quality, reconstruction_event.t_tai_ns AS t1_tai_ns, qx, qy, qz, qw, sigma_deg,
  noise_sigma_deg, cov_xx_deg2, cov_xy_deg2, cov_xz_deg2, cov_yy_deg2, cov_yz_deg2, cov_zz_deg2, launcher_angle_deg, launcher_chance,
  status || iif(noise_sigma_deg < 0.99995 * sigma_deg, format('; %.2g of %.2g deg is alignment',
    sqrt(pow(sigma_deg, 2) - pow(noise_sigma_deg, 2)), sigma_deg), '') AS why
FROM reconstruction JOIN reconstruction_event USING (run_id, method)
WHERE event = 'T1'
  AND method = (SELECT min(method) FROM reconstruction AS one WHERE one.run_id = reconstruction.run_id);
