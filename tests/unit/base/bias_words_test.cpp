/// Sentences about the directions of biases that edges do not determine.

#include "services/base/bias_words.h"

#include "tests/support/matchers.h"

namespace spindrift::bias_words_test {

TEST(BiasWords, NameWhatIsNotDeterminedAndWhatCannotBeToldApart) {
  EXPECT_EQ(undetermined_sentence(BiasSet{}.set(Co2HeightBias)),
            "height of the infrared horizon is not determined in this geometry");
  EXPECT_EQ(undetermined_sentence(BiasSet{}.set(NorthMountAngleBias).set(NorthChordBias)),
            "north chord and north mounting angle cannot be told apart in this geometry");
  EXPECT_EQ(undetermined_sentence(BiasSet{}.set(SunAngleBias).set(SlitSeparationBias) |
                                  unknowns_of(ConingX)),
            "sun angle, separation of the sun slits and coning cannot be told apart in this "
            "geometry");
}

TEST(BiasWords, ConingIsOneThing) {
  EXPECT_EQ(undetermined_sentence(unknowns_of(ConingY)),
            "coning is not determined in this geometry");
}

}  // namespace spindrift::bias_words_test
