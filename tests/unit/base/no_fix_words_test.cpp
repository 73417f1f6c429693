#include "services/base/no_fix_words.h"

#include <gtest/gtest.h>

namespace spindrift::no_fix_words_test {

TEST(NoFixWords, GiveTheMeasuredValues) {
  EXPECT_EQ(sentence_of(WhyNoFix{
                NoFixCode::ConesApart,
                {{"sun_angle_deg", 10.0}, {"earth_angle_deg", 20.0}, {"sun_earth_deg", 40.00004}}}),
            "the cones of 10.0000 deg about the Sun and 20.0000 deg about the Earth do not meet, "
            "which stand 40.0000 deg apart");
  EXPECT_EQ(sentence_of(WhyNoFix{NoFixCode::SunEarthInLine, {{"sun_earth_deg", 2.9}}}),
            "Sun and Earth stand 2.900 deg apart: the axis needs between 3 and 177 deg");
}

}  // namespace spindrift::no_fix_words_test
