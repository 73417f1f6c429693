#include "services/program/comparison_notice.h"

#include "tests/support/matchers.h"

namespace spindrift::comparison_notice_test {

TEST(DisagreementWords, ShowHowFarApartToTheDigitsOfTheSigma) {
  EXPECT_EQ(sentence_of(Disagreement{"mean", "batch", 0.31, 4.2}),
            "mean and batch disagree: their axes are 0.310 deg apart, 4.2 times the sigma of their "
            "difference");
  EXPECT_EQ(sentence_of(Disagreement{"mean", "batch", 0.00042, 4.2}),
            "mean and batch disagree: their axes are 0.00042 deg apart, 4.2 times the sigma of "
            "their difference");
}

}  // namespace spindrift::comparison_notice_test
