#include <gtest/gtest.h>

#include "tests/support/flight_off_file.h"

namespace spindrift::testing::reconstruction_off_file_test {

// The 95 % band of chi-square with 90 degrees of freedom.
TEST(ReconstructionOffFile, SigmaHoldsWhatTheMissionFileMayBeOffBy) {
  expect_total_sigma({}, 30, 65.6, 118.1);
}

}  // namespace spindrift::testing::reconstruction_off_file_test
