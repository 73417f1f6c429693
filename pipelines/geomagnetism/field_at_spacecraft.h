/// @file
/// The Earth's main magnetic field at a spacecraft.

#pragma once

#include <Eigen/Core>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/geomagnetism/main_field_model.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// @return Field in ICRF, nT; NoCoverage outside the model's years, InvalidInput within the core.
Expected<Eigen::Vector3d> field_icrf_nt(const MainFieldModel& model, TaiTime t,
                                        const Eigen::Vector3d& position_icrf_km,
                                        TurningEarth& earth);

}  // namespace spindrift
