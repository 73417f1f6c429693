/// Noise alone settles no dual solution by its dispersion.

#include "tests/support/noisy_axes.h"

namespace spindrift::testing::spin_dispersion_many_test {

TEST(SpinDispersionMany, NoiseAloneSettlesNothing) { expect_noise_alone_settles_nothing(200); }

}  // namespace spindrift::testing::spin_dispersion_many_test
