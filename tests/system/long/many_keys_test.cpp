// Samples of a growing number of spacecraft that have no mission here.

#include <gtest/gtest.h>

#include "tests/support/on_bus.h"

namespace spindrift::many_keys_test {

/// Returns the peak memory of a service, KiB, that receives samples of this many spacecraft.
long peak_kib(int spacecraft) {
  ReadyService service{"nominal"};
  ForeignWriter sender{service.bus(), "keys", spacecraft};
  EXPECT_EQ(sender.exit_status(), 0);
  EXPECT_EQ(service.stop(), 0) << service.log();
  return service.program().peak_kib();
}

TEST(ManyKeys, OfOtherSpacecraftCostNoMemory) {
  if (is_sanitized()) {
    GTEST_SKIP() << "sanitizers need memory of their own";
  }
  const long few_kib = peak_kib(100);
  // A DDS instance takes 0.6 KiB in Cyclone, so that keeping all would need 200,000 KiB.
  EXPECT_LT(peak_kib(300'000), few_kib + 40'000);
}

}  // namespace spindrift::many_keys_test
