#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/shown.h"
#include "services/telemetry/telemetry_stream.h"
#include "tests/support/matchers.h"
#include "tests/support/read_telemetry.h"
#include "tests/support/temporary_folder.h"

namespace spindrift::pulse_file_test {

/// Reads a pulse file with this row between two good ones.
ReadTelemetry read_row(std::string_view row) {
  std::string text = "t_tai_ns,channel\n1795143637568806257,sun1\n";
  return read_text(text.append(row).append("\n1795143637648746313,sun2\n"));
}

TEST(PulseFile, GivesSamplesWithTheirOrigin) {
  const auto pulses =
      read_text("t_tai_ns,channel\n1795143637568806257,sun1\n1795143637648746313,south_out\n");
  EXPECT_TRUE(pulses.rejected.empty());
  ASSERT_EQ(pulses.samples.size(), 2U);
  EXPECT_EQ(pulses.samples[0].spacecraft, "SPINNER");
  EXPECT_EQ(pulses.samples[0].origin.source, "pulses.csv");
  EXPECT_EQ(pulses.samples[0].origin.session, 0U);
  EXPECT_EQ(pulses.samples[0].origin.seq, 2U);
  EXPECT_EQ(pulses.samples[0].value, (Pulse{tai_from_ns(kT0_tai_ns), PulseChannel::Sun1}));
  EXPECT_EQ(pulses.samples[1].origin.seq, 3U);
  EXPECT_EQ(pulses.samples[1].value,
            (Pulse{tai_from_ns(1795143637648746313), PulseChannel::SouthOut}));
}

TEST(PulseFile, KnowsEveryChannel) {
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto pulses = read_row("1795143637600000000," + std::string{kPulseChannelNames.at(i)});
    ASSERT_EQ(pulses.samples.size(), 3U);
    EXPECT_EQ(index_of(pulses.samples[1].value.channel), i);
  }
}

TEST(PulseFile, TakesTheSpacecraftFromItsColumn) {
  const auto pulses = read_text(
      "t_tai_ns,spacecraft,channel\n"
      "1795143637568806257,GMS-5,sun1\n"
      "1795143637568806258,,sun1\n"
      "1795143637568806259,123456789012345678901234567890123,sun1\n");
  ASSERT_EQ(pulses.samples.size(), 1U);
  EXPECT_EQ(pulses.samples[0].spacecraft, "GMS-5");
  ASSERT_EQ(pulses.rejected.size(), 2U);
  EXPECT_THAT(pulses.rejected[0].reason,
              HasSubstr("spacecraft = \"\": must be 1 to 32 printable ASCII characters"));
  EXPECT_EQ(pulses.rejected[1].line, 4);
}

TEST(PulseFile, ReadsWhatOtherSystemsWrite) {
  const auto plain = read_text("t_tai_ns,channel\n1795143637568806257,sun1\n");
  for (const char* text : {"t_tai_ns,channel\r\n1795143637568806257,sun1\r\n",
                           "\xEF\xBB\xBFt_tai_ns,channel\n1795143637568806257,sun1\n",
                           "t_tai_ns,channel\n1795143637568806257,sun1",
                           "\n\r\nt_tai_ns,channel\n\n\r\n1795143637568806257,sun1\n\n"}) {
    SCOPED_TRACE(text);
    const auto pulses = read_text(text);
    EXPECT_TRUE(pulses.rejected.empty());
    ASSERT_EQ(pulses.samples.size(), 1U);
    EXPECT_EQ(pulses.samples[0].value, plain.samples[0].value);
  }
}

TEST(PulseFile, WithAHeaderAloneIsNoTelemetryAndNoError) {
  const auto pulses = read_text("t_tai_ns,channel\n");
  EXPECT_TRUE(pulses.samples.empty());
  EXPECT_TRUE(pulses.rejected.empty());
}

void expect_rejected(const BadRow& bad) {
  SCOPED_TRACE(bad.row);
  const auto pulses = read_row(bad.row);
  EXPECT_EQ(pulses.samples.size(), 2U);
  ASSERT_EQ(pulses.rejected.size(), 1U);
  EXPECT_THAT(pulses.rejected[0].source, EndsWith("/pulses.csv"));
  EXPECT_EQ(pulses.rejected[0].line, 3);
  EXPECT_THAT(pulses.rejected[0].reason, HasSubstr(bad.reason));
}

TEST(PulseFile, RejectsABadRowWithItsReasonAndGoesOn) {
  using namespace std::string_view_literals;
  const std::vector<BadRow> rows = {
      {"1795143637600000000", "has 1 columns, must have 2"},
      {"1795143637600000000,sun1,7", "has 3 columns, must have 2"},
      {"17951436376000", "has 1 columns, must have 2"},
      {"1795143637600000000,sun", "channel = \"sun\": must be one of sun1, sun2, north_in"},
      {"1795143637600000000,SUN1", "channel = \"SUN1\": must be one of"},
      {"1795143637600000000,", "channel = \"\": must be one of"},
      {"1795143637600000000, sun1", "channel = \" sun1\": must be one of"},
      {"1795143637600000000,sun1\0"sv, R"(channel = "sun1\x00": must be one of)"},
      {"17951436376\0"
       "00000000,sun1"sv,
       R"(t_tai_ns = "17951436376\x0000000000": must be an integer)"},
      {",sun1", "t_tai_ns = \"\": must be an integer"},
      {"nan,sun1", "t_tai_ns = \"nan\": must be an integer"},
      {"1.7951436376e18,sun1", "t_tai_ns = \"1.7951436376e18\": must be an integer"},
      {"+1795143637600000000,sun1", "must be an integer"},
      {"1795143637600000000 ,sun1", "must be an integer"},
      {"0,sun1", "t_tai_ns = \"0\": must lie in the years 1972 to 2099"},
      {"-1795143637600000000,sun1", "must lie in the years"},
      {"1795143637,sun1", "must lie in the years"},
      {"99999999999999999999999,sun1", "must lie in the years"},
      {"63072009999999999,sun1", "must lie in the years"},
      {"4102444800000000000,sun1", "must lie in the years"},
      {"\xff\xfe\x1b[31m,sun1", R"(t_tai_ns = "\xff\xfe\x1b[31m": must be an integer)"},
  };
  for (const BadRow& bad : rows) {
    expect_rejected(bad);
  }
}

TEST(PulseFile, RejectsRowsUnderThePathAsGivenAndKeepsSamplesUnderFolderAndName) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "a");
  std::filesystem::create_directory(folder.path() / "b");
  const std::string text = "t_tai_ns,channel\nsoon,sun1\n1795143637568806257,sun1\n";
  const auto a = std::filesystem::relative(folder.write("a/pulses.csv", text));
  const auto b = folder.write("b/pulses.csv", text);
  const auto pulses = read({a, b});
  ASSERT_EQ(pulses.rejected.size(), 2U);
  EXPECT_EQ(pulses.rejected[0].source, a.string());
  EXPECT_EQ(pulses.rejected[1].source, b.string());
  ASSERT_EQ(pulses.samples.size(), 2U);
  EXPECT_EQ(pulses.samples[0].origin.source, "a/pulses.csv");
  EXPECT_EQ(pulses.samples[1].origin.source, "b/pulses.csv");
}

TEST(PulseFile, TakesTheFirstAndTheLastInstantThatItAllows) {
  EXPECT_EQ(read_row("63072010000000000,sun1").samples.size(), 3U);
  EXPECT_EQ(read_row("4102444799999999999,sun1").samples.size(), 3U);
}

TEST(PulseFile, RejectsALineWithoutEndInConstantMemory) {
  for (const std::size_t length : {1024U, 1025U, 1026U, 100000U}) {
    SCOPED_TRACE(length);
    const auto pulses = read_row(std::string(length, '7'));
    EXPECT_EQ(pulses.samples.size(), 2U);
    ASSERT_EQ(pulses.rejected.size(), 1U);
    EXPECT_EQ(pulses.rejected[0].line, 3);
    EXPECT_LT(pulses.rejected[0].reason.size(), kMostShown + 100);
  }
}

TEST(PulseFile, RejectsALastRowCutInHalf) {
  const std::string text = "t_tai_ns,channel\n1795143637568806257,sun1\n1795143637648746313,sun2";
  const std::size_t last_row = text.rfind('\n') + 1;
  for (std::size_t length = last_row + 1; length < text.size(); ++length) {
    SCOPED_TRACE(length);
    const auto pulses = read_text(text.substr(0, length));
    EXPECT_EQ(pulses.samples.size(), 1U);
    EXPECT_THAT(pulses.rejected, ElementsAre(Field(&RejectedInput::line, 3)));
  }
}

TEST(PulseFile, OfAnotherKindIsRefused) {
  const TemporaryFolder folder;
  const auto path = folder.write("star.csv", "t_tai_ns,qx,qy,qz,qw\n");
  EXPECT_THAT(TelemetryRows<Pulse>::open(path, "SPINNER"),
              IsRefused(ErrorCode::InvalidConfiguration,
                        path.string() + ": holds star telemetry, must hold pulses"));
}

}  // namespace spindrift::pulse_file_test
