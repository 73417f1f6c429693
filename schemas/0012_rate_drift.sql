-- How the spin rate drifts, evenly over the pass, as `batch` has it; rpm/h and sigma. NULL: stored before
-- this was.
ALTER TABLE spin_batch ADD COLUMN rate_drift_rpm_h REAL;
ALTER TABLE spin_batch ADD COLUMN rate_drift_sigma_rpm_h REAL CHECK (rate_drift_sigma_rpm_h >= 0);
