/// @file
/// What fixes, which are solved with the spherical horizon, leave out of an oblate Earth.

#pragma once

#include "pipelines/spin/config.h"
#include "pipelines/spin/products.h"

namespace spindrift {

/// The fix with that in its covariances and those of its alternates, where the mission asks for
/// the ellipsoid: the limb of each beam anywhere between none and the whole of its displacement.
/// Unlike the noise of the pulses it does not shrink with the number of fixes.
/// @param disc_rad rho.
SpinFix with_horizon_allowance(const Horizon& horizon, double disc_rad, SpinFix fix);

}  // namespace spindrift
