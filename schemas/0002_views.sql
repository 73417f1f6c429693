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

CREATE VIEW spin_measurement_utc AS
SELECT revolution_utc.utc, spin_measurement.*
FROM spin_measurement LEFT JOIN revolution_utc USING (run_id, revolution);

-- Every edge that a run left out, and the test that did.
CREATE VIEW rejected_pulse AS
SELECT run_id, utc, spacecraft_id, t_tai_ns, channel, revolution, rejected_by, source, session, seq
FROM pulse_use LEFT JOIN pulse_utc USING (spacecraft_id, t_tai_ns, channel)
WHERE accepted = 0;

CREATE VIEW rejection_summary AS
SELECT run_id, 'pulse' AS what, channel AS name, rejected_by, count(*) AS rejected
FROM pulse_use WHERE accepted = 0 GROUP BY run_id, channel, rejected_by
UNION ALL
SELECT run_id, 'measurement', quantity, rejected_by, count(*)
FROM spin_measurement WHERE accepted = 0 GROUP BY run_id, quantity, rejected_by
UNION ALL
SELECT run_id, 'input', source, reason, count(*)
FROM rejected_input GROUP BY run_id, source, reason;

-- The answer of a pass: the last estimate of each estimator of each run.
CREATE VIEW pass_answer AS
SELECT spacecraft_id, spin_estimate_utc.*
FROM spin_estimate_utc JOIN run USING (run_id)
WHERE t_tai_ns = (SELECT max(t_tai_ns) FROM spin_estimate AS other
                  WHERE other.run_id = spin_estimate_utc.run_id
                    AND other.estimator = spin_estimate_utc.estimator);
