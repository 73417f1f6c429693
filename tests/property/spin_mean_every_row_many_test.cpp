/// Whatever the geometry, and however few the fixes: no mean that is published as OK is wrong, and
/// none lies apart from its fixes. Over many passes.

#include <gtest/gtest.h>

#include "tests/support/every_mean.h"

namespace spindrift {
namespace {

TEST(SpinMeanEveryRowMany, IsRightWhereItIsOkAndAmongItsFixes) {
  constexpr int kPasses = 400;
  const testing::Checked checked = testing::check_passes_across_the_limb(3400U, kPasses);
  RecordProperty("ok", checked.ok);
  RecordProperty("misled", checked.misled);
  EXPECT_GT(checked.ok, kPasses / 2);
  // Which is for the disambiguation to prevent.
  EXPECT_LE(checked.misled, kPasses / 50);
}

}  // namespace
}  // namespace spindrift
