/// @file
/// The main field where a spacecraft is.

#pragma once

#include <Eigen/Core>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/geomagnetism/main_field_model.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// @return ICRF, nT; NoCoverage outside the years of the model, InvalidInput within the core.
Expected<Eigen::Vector3d> field_icrf_nt(const MainFieldModel& model, TaiTime t,
                                        const Eigen::Vector3d& position_icrf_km,
                                        TurningEarth& earth);

}  // namespace spindrift
