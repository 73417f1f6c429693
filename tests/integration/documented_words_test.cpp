// The words that stand in the archive stand in schemas/README.md, where an analyst looks them up.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "pipelines/spin/types/products.h"
#include "tests/support/text_of.h"

namespace spindrift {
namespace {

using ::testing::ContainsRegex;

const std::string kSchemas =
    text_of(std::filesystem::path{SPINDRIFT_TEST_DATA} / ".." / ".." / "schemas" / "README.md");

TEST(DocumentedWords, AreAllReasonsToLeaveAnEdgeOut) {
  for (int i = 0; i <= static_cast<int>(Rejection::MixedAzimuth); ++i) {
    // In the first column of a table, of several words perhaps.
    EXPECT_THAT(kSchemas, ContainsRegex("\n\\|[^|]*`" +
                                        std::string{name_of(static_cast<Rejection>(i))} + "`"));
  }
}

}  // namespace
}  // namespace spindrift
