-- What misplaced sensors could hide, and a comparison that knows that the estimators share their edges.

-- Root mean square error of the axis, both directions together, were no bias known better than by its
-- prior, those held at zero included. NULL: stored before this was.
ALTER TABLE spin_batch ADD COLUMN consider_sigma_deg REAL CHECK (consider_sigma_deg >= 0);

-- As before, but for the sigma: estimators of the same edges differ by no more than the worse of them
-- errs (Hausman 1978: the variance of the difference from an efficient one is the difference of the
-- variances).
DROP VIEW spin_comparison;
CREATE VIEW spin_comparison AS
WITH pair AS (
  SELECT a.run_id, a.spacecraft_id, a.estimator AS one, b.estimator AS other,
    a.ra_deg AS one_ra_deg, a.dec_deg AS one_dec_deg, a.sigma_deg AS one_sigma_deg,
    b.ra_deg AS other_ra_deg, b.dec_deg AS other_dec_deg, b.sigma_deg AS other_sigma_deg,
    degrees(2 * asin(min(1, sqrt(
      pow(sin(radians(a.dec_deg - b.dec_deg) / 2), 2)
      + cos(radians(a.dec_deg)) * cos(radians(b.dec_deg))
        * pow(sin(radians(a.ra_deg - b.ra_deg) / 2), 2))))) AS apart_deg,
    max(a.sigma_deg, b.sigma_deg) AS sigma_deg
  FROM pass_answer AS a JOIN pass_answer AS b USING (run_id)
  WHERE (a.estimator = 'mean' AND b.estimator <> 'mean')
    OR (a.estimator = 'sequential' AND b.estimator = 'batch')
)
SELECT *, apart_deg / sigma_deg AS apart_sigmas, apart_deg > 3 * sigma_deg AS disagree
FROM pair;
