#include <string>
#include <string_view>
#include <vector>

#include "services/telemetry/telemetry_stream.h"
#include "tests/support/matchers.h"
#include "tests/support/read_telemetry.h"
#include "tests/support/temporary_folder.h"

namespace spindrift::coded_file_test {

ReadTelemetry read_coded_row(std::string_view row) {
  const TemporaryFolder folder;
  return read({folder.write("coded.csv", std::string{kCodedHeader}.append(row).append("\n"))});
}

TEST(CodedFile, GivesFramesWithTheirOrigin) {
  const auto telemetry =
      read_coded_row("1795143637568985513,1.00007,0.07932,0.4545,,0.45928,0.60985");
  EXPECT_TRUE(telemetry.rejected.empty());
  ASSERT_EQ(telemetry.coded.size(), 1U);
  const TelemetrySample<CodedFrame>& sample = telemetry.coded[0];
  EXPECT_EQ(sample.spacecraft, "SPINNER");
  EXPECT_EQ(sample.origin.source, "coded.csv");
  EXPECT_EQ(sample.origin.session, 0U);
  EXPECT_EQ(sample.origin.seq, 2U);
  EXPECT_EQ(tai_ns(sample.value.t), 1795143637568985513);
  EXPECT_EQ(sample.value.period_s, 1.00007);
  EXPECT_THAT(sample.value.delay_s,
              ElementsAre(std::nullopt, 0.07932, 0.4545, std::nullopt, 0.45928, 0.60985));
}

TEST(CodedFile, MayLackAnythingButItsTime) {
  const auto telemetry = read_coded_row("1795143637568985513,,,,,,");
  EXPECT_TRUE(telemetry.rejected.empty());
  ASSERT_EQ(telemetry.coded.size(), 1U);
  EXPECT_EQ(telemetry.coded[0].value.period_s, std::nullopt);
  EXPECT_THAT(telemetry.coded[0].value.delay_s, Each(std::nullopt));
}

TEST(CodedFile, RejectsABadRowWithItsReason) {
  const std::vector<BadRow> rows = {
      {"1795143637568985513,1.0,0.07932,0.45450,0.60319,0.45928", "has 6 columns, must have 7"},
      {"1795143637568985513,1.0,0.07932,0.4", "has 4 columns, must have 7"},
      {"1795143637568985513,1,0,0,0,0,0,0", "has 8 columns, must have 7"},
      {"1795143637568985513,1,0,0,0,0,0,0,0,0,0", "has 11 columns, must have 7"},
      {"-8520336000000000000,1,0,0,0,0,0", "t_tai_ns = \"-8520336000000000000\": must lie in"},
      {"now,1,0,0,0,0,0", "t_tai_ns = \"now\": must be an integer"},
      {"1795143637568985513,nan,0,0,0,0,0", "period_s = \"nan\": must be a number, or empty"},
      {"1795143637568985513,1,NaN,0,0,0,0", "sun2_s = \"NaN\": must be a number, or empty"},
      {"1795143637568985513,inf,0,0,0,0,0", "period_s = \"inf\": must be a number"},
      {"1795143637568985513,1,0,0,0,0,-infinity", "south_out_s = \"-infinity\": must be a number"},
      {"1795143637568985513,1,0,1e999,0,0,0", "north_in_s = \"1e999\": must be a number"},
      {"1795143637568985513,1,0,0.1s,0,0,0", "north_in_s = \"0.1s\": must be a number"},
      {"1795143637568985513,1,0, 0.1,0,0,0", "north_in_s = \" 0.1\": must be a number"},
      {"1795143637568985513,0,,,,,", "period_s = 0: must be above 0, at most 60 s"},
      {"1795143637568985513,-1,,,,,", "period_s = -1: must be above 0"},
      {"1795143637568985513,60.001,,,,,", "period_s = 60.001: must be above 0, at most 60 s"},
      {"1795143637568985513,1,-0.001,,,,", "sun2_s = -0.001: must be 0 to two periods, 2 s"},
      {"1795143637568985513,0.5,,1.01,,,", "north_in_s = 1.01: must be 0 to two periods, 1 s"},
      {"1795143637568985513,,,,61,,", "north_out_s = 61: must be 0 to 60 s"},
  };
  for (const BadRow& bad : rows) {
    SCOPED_TRACE(bad.row);
    const auto telemetry = read_coded_row(bad.row);
    EXPECT_TRUE(telemetry.coded.empty());
    EXPECT_THAT(telemetry.rejected,
                ElementsAre(AllOf(Field(&RejectedInput::line, 2),
                                  Field(&RejectedInput::reason, HasSubstr(bad.reason)))));
  }
}

TEST(CodedFile, TakesTheEndsOfWhatItAllows) {
  for (const char* row : {"1795143637568985513,60,0,60,,,", "1795143637568985513,1,1,2,,,",
                          "1795143637568985513,1e-3,0,0,0,0,0", "1795143637568985513,,60,,,,"}) {
    EXPECT_EQ(read_coded_row(row).coded.size(), 1U) << row;
  }
}

TEST(CodedFile, RejectsARowCutAnywhereThatLosesAColumn) {
  const std::string row = "1795143637568985513,1.00007,0.07932,0.45450,0.60319,0.45928,0.60985";
  for (std::size_t length = 1; length <= row.rfind(','); ++length) {
    const auto telemetry = read_coded_row(row.substr(0, length));
    EXPECT_TRUE(telemetry.coded.empty()) << length;
    EXPECT_EQ(telemetry.rejected.size(), 1U) << length;
  }
}

}  // namespace spindrift::coded_file_test
