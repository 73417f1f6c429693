-- Coning, and when a nutation that grows was as large as its row says.

ALTER TABLE spin_nutation ADD COLUMN at_tai_ns INTEGER;  -- of half_angle_deg and lean_azimuth_deg

-- The sensors' axis leans away from the principal axis that the body spins about; t_tai_ns as in
-- spin_estimate. NULL from tilt_deg on: none was detected, and none is in the axis.
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
