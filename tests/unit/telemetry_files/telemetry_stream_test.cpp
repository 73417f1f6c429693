#include "services/telemetry_files/telemetry_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace spindrift {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kT0_tai_ns = 1795143637568806257;

/// Everything that a stream gives, in its order; no batch is larger than it may be.
struct Telemetry {
  std::vector<PulseSample> samples;
  std::vector<CodedSample> coded;
  std::vector<RejectedInput> rejected;
  std::vector<TaiTime> times;  ///< Of samples of both kinds.
};

Telemetry read(const std::vector<std::filesystem::path>& paths,
               std::size_t buffer_bytes = TelemetryStream::kBufferBytes) {
  const auto files = scan_telemetry(paths);
  EXPECT_TRUE(files) << files.error().message;
  auto stream = TelemetryStream::open(*files, "SPINNER", buffer_bytes);
  EXPECT_TRUE(stream) << stream.error().message;
  Telemetry all;
  while (true) {
    const auto batch = stream->next();
    EXPECT_TRUE(batch) << batch.error().message;
    EXPECT_TRUE(batch->pulses.empty() || batch->coded.empty());
    EXPECT_LE(batch->pulses.size() + batch->coded.size(), TelemetryStream::kBatch);
    EXPECT_LE(batch->rejected.size(), TelemetryStream::kBatch);
    if (batch->pulses.empty() && batch->coded.empty() && batch->rejected.empty()) {
      EXPECT_EQ(stream->bytes_given(), stream->bytes_total());
      return all;
    }
    for (const PulseSample& sample : batch->pulses) {
      all.samples.push_back(sample);
      all.times.push_back(sample.pulse.t);
    }
    for (const CodedSample& sample : batch->coded) {
      all.coded.push_back(sample);
      all.times.push_back(sample.frame.t);
    }
    all.rejected.insert(all.rejected.end(), batch->rejected.begin(), batch->rejected.end());
  }
}

/// A pulse file with this row between two good ones.
Telemetry read_row(std::string_view row) {
  const TemporaryFolder folder;
  std::string text = "t_tai_ns,channel\n1795143637568806257,sun1\n";
  text.append(row).append("\n1795143637648746313,sun2\n");
  return read({folder.write("pulses.csv", text)});
}

TEST(PulseFile, GivesSamplesWithTheirOrigin) {
  const TemporaryFolder folder;
  const auto pulses = read({folder.write(
      "pulses.csv",
      "t_tai_ns,channel\n1795143637568806257,sun1\n1795143637648746313,south_out\n")});
  EXPECT_TRUE(pulses.rejected.empty());
  ASSERT_EQ(pulses.samples.size(), 2U);
  EXPECT_EQ(pulses.samples[0].spacecraft, "SPINNER");
  EXPECT_EQ(pulses.samples[0].origin.source, "pulses.csv");
  EXPECT_EQ(pulses.samples[0].origin.session, 0U);
  EXPECT_EQ(pulses.samples[0].origin.seq, 2U);
  EXPECT_EQ(pulses.samples[0].pulse, (Pulse{tai_from_ns(kT0_tai_ns), PulseChannel::Sun1}));
  EXPECT_EQ(pulses.samples[1].origin.seq, 3U);
  EXPECT_EQ(pulses.samples[1].pulse,
            (Pulse{tai_from_ns(1795143637648746313), PulseChannel::SouthOut}));
}

TEST(PulseFile, KnowsEveryChannel) {
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto pulses = read_row("1795143637600000000," + std::string{kPulseChannelNames.at(i)});
    ASSERT_EQ(pulses.samples.size(), 3U);
    EXPECT_EQ(index_of(pulses.samples[1].pulse.channel), i);
  }
}

TEST(PulseFile, TakesTheSpacecraftFromItsColumn) {
  const TemporaryFolder folder;
  const auto pulses =
      read({folder.write("a.csv",
                         "t_tai_ns,spacecraft,channel\n"
                         "1795143637568806257,GMS-5,sun1\n"
                         "1795143637568806258,,sun1\n"
                         "1795143637568806259,123456789012345678901234567890123,sun1\n")});
  ASSERT_EQ(pulses.samples.size(), 1U);
  EXPECT_EQ(pulses.samples[0].spacecraft, "GMS-5");
  ASSERT_EQ(pulses.rejected.size(), 2U);
  EXPECT_THAT(pulses.rejected[0].reason,
              HasSubstr("spacecraft = \"\": must be 1 to 32 printable ASCII characters"));
  EXPECT_EQ(pulses.rejected[1].line, 4);
}

TEST(PulseFile, ReadsWhatOtherSystemsWrite) {
  const TemporaryFolder folder;
  const auto plain = read({folder.write("a.csv", "t_tai_ns,channel\n1795143637568806257,sun1\n")});
  for (const char* text : {"t_tai_ns,channel\r\n1795143637568806257,sun1\r\n",
                           "\xEF\xBB\xBFt_tai_ns,channel\n1795143637568806257,sun1\n",
                           "t_tai_ns,channel\n1795143637568806257,sun1",
                           "\n\r\nt_tai_ns,channel\n\n\r\n1795143637568806257,sun1\n\n"}) {
    SCOPED_TRACE(text);
    const auto pulses = read({folder.write("b.csv", text)});
    EXPECT_TRUE(pulses.rejected.empty());
    ASSERT_EQ(pulses.samples.size(), 1U);
    EXPECT_EQ(pulses.samples[0].pulse, plain.samples[0].pulse);
  }
}

TEST(PulseFile, WithAHeaderAloneIsNoTelemetryAndNoError) {
  const TemporaryFolder folder;
  const auto pulses = read({folder.write("a.csv", "t_tai_ns,channel\n")});
  EXPECT_TRUE(pulses.samples.empty());
  EXPECT_TRUE(pulses.rejected.empty());
}

struct BadRow {
  std::string_view row;
  const char* reason;
};

void expect_rejected(const BadRow& bad) {
  SCOPED_TRACE(bad.row);
  const auto pulses = read_row(bad.row);
  EXPECT_EQ(pulses.samples.size(), 2U);
  ASSERT_EQ(pulses.rejected.size(), 1U);
  EXPECT_THAT(pulses.rejected[0].source, ::testing::EndsWith("/pulses.csv"));
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

TEST(PulseFile, RejectsRowsUnderThePathAsGivenAndKeepsSamplesUnderTheName) {
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
  EXPECT_EQ(pulses.samples[0].origin.source, "pulses.csv");
  EXPECT_EQ(pulses.samples[1].origin.source, "pulses.csv");
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
    EXPECT_LT(pulses.rejected[0].reason.size(), 200U);
  }
}

TEST(PulseFile, RejectsALastRowCutInHalf) {
  const TemporaryFolder folder;
  const std::string text = "t_tai_ns,channel\n1795143637568806257,sun1\n1795143637648746313,sun2";
  const std::size_t last_row = text.rfind('\n') + 1;
  for (std::size_t length = last_row + 1; length < text.size(); ++length) {
    SCOPED_TRACE(length);
    const auto pulses = read({folder.write("a.csv", text.substr(0, length))});
    EXPECT_EQ(pulses.samples.size(), 1U);
    ASSERT_EQ(pulses.rejected.size(), 1U);
    EXPECT_EQ(pulses.rejected[0].line, 3);
  }
}

TEST(PulseFile, OfAnotherKindIsRefused) {
  const TemporaryFolder folder;
  const auto path = folder.write("star.csv", "t_tai_ns,qx,qy,qz,qw\n");
  const auto file = TelemetryRows<Pulse>::open(path, "SPINNER");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, ErrorCode::InvalidConfiguration);
  EXPECT_EQ(file.error().message, path.string() + ": holds star telemetry, must hold pulses");
}

TEST(TelemetryStream, OfAFileThatHasGoneIsAnError) {
  const TemporaryFolder folder;
  const std::vector<TelemetryFile> files = {
      {.path = folder.path() / "gone.csv", .kind = TelemetryKind::Pulses}};
  const auto pulses = TelemetryStream::open(files, "SPINNER");
  ASSERT_FALSE(pulses);
  EXPECT_THAT(pulses.error().message, HasSubstr("gone.csv: cannot be read: No such file"));
}

TEST(TelemetryStream, OfAFileThatFailsWhileReadingIsAnError) {
  // A regular file that opens; nothing is mapped at address 0, where reading begins.
  const auto file = TelemetryRows<Pulse>::open("/proc/self/mem", "SPINNER");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(file.error().message, HasSubstr("/proc/self/mem: reading failed"));
}

TEST(TelemetryStream, PassesOtherKindsOver) {
  const TemporaryFolder folder;
  folder.write("pulses.csv", "t_tai_ns,channel\n1795143637568806257,sun1\n");
  folder.write("star.csv", "t_tai_ns,qx,qy,qz,qw\nrubbish\n");
  const auto pulses = read({folder.path()});
  EXPECT_EQ(pulses.samples.size(), 1U);
  EXPECT_TRUE(pulses.rejected.empty());
}

TEST(TelemetryStream, SortsByTimeThenChannelAndKeepsDuplicates) {
  const TemporaryFolder folder;
  const auto a = folder.write("a.csv",
                              "t_tai_ns,channel\n"
                              "1795143637000000002,sun1\n"
                              "1795143637000000001,sun2\n"
                              "1795143637000000001,sun1\n");
  const auto b = folder.write("b.csv",
                              "t_tai_ns,channel\n"
                              "1795143637000000001,sun1\n"
                              "1795143637000000000,south_out\n");
  const auto pulses = read({a, b});
  std::vector<std::string> seen;
  for (const PulseSample& sample : pulses.samples) {
    seen.push_back(std::to_string(tai_ns(sample.pulse.t) % 10) + " " +
                   std::string{name_of(sample.pulse.channel)} + " " + sample.origin.source);
  }
  EXPECT_THAT(seen, ::testing::ElementsAre("0 south_out b.csv", "1 sun1 a.csv", "1 sun1 b.csv",
                                           "1 sun2 a.csv", "2 sun1 a.csv"));
}

TEST(TelemetryStream, GivesTheSamePulsesWhateverTheOrderOfTheRowsAndFiles) {
  const std::filesystem::path nominal =
      std::filesystem::path{SPINDRIFT_TEST_DATA} / "spin" / "nominal" / "pulses.csv";
  const auto expected = read({nominal});
  ASSERT_EQ(expected.samples.size(), 3600U);
  EXPECT_TRUE(expected.rejected.empty());

  std::vector<std::string> rows;
  for (const PulseSample& sample : expected.samples) {
    rows.push_back(std::to_string(tai_ns(sample.pulse.t)) + "," +
                   std::string{name_of(sample.pulse.channel)} + "\n");
  }
  std::mt19937 random{20261120};
  for (int trial = 0; trial < 5; ++trial) {
    SCOPED_TRACE(trial);
    std::shuffle(rows.begin(), rows.end(), random);
    std::string first = "t_tai_ns,channel\n";
    std::string second = first;
    for (const std::string& row : rows) {
      (random() % 2 == 0 ? first : second) += row;
    }
    const TemporaryFolder folder;
    const auto a = folder.write("a.csv", first);
    const auto b = folder.write("b.csv", second);
    const auto shuffled = read({b, a});
    EXPECT_TRUE(std::equal(shuffled.samples.begin(), shuffled.samples.end(),
                           expected.samples.begin(), expected.samples.end(),
                           [](const auto& x, const auto& y) { return x.pulse == y.pulse; }));
  }
}

TEST(TelemetryStream, AccountsForEveryRowOfRandomBytes) {
  std::mt19937 random{7};
  constexpr std::string_view kAlphabet = "0123456789,sunorth_i\r\"-+.e \x80";
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    std::string text = "t_tai_ns,channel\n";
    for (int row = 0; row < 20; ++row) {
      text += "1";  // No row is empty.
      std::generate_n(std::back_inserter(text), random() % 30,
                      [&] { return kAlphabet[random() % kAlphabet.size()]; });
      text += '\n';
    }
    const TemporaryFolder folder;
    const auto pulses = read({folder.write("a.csv", text)});
    EXPECT_EQ(pulses.samples.size() + pulses.rejected.size(), 20U);
  }
}

constexpr std::string_view kCodedHeader =
    "t_tai_ns,period_s,sun2_s,north_in_s,north_out_s,south_in_s,south_out_s\n";

Telemetry read_coded_row(std::string_view row) {
  const TemporaryFolder folder;
  return read({folder.write("coded.csv", std::string{kCodedHeader}.append(row).append("\n"))});
}

TEST(CodedFile, GivesFramesWithTheirOrigin) {
  const auto telemetry =
      read_coded_row("1795143637568985513,1.00007,0.07932,0.4545,,0.45928,0.60985");
  EXPECT_TRUE(telemetry.rejected.empty());
  ASSERT_EQ(telemetry.coded.size(), 1U);
  const CodedSample& sample = telemetry.coded[0];
  EXPECT_EQ(sample.spacecraft, "SPINNER");
  EXPECT_EQ(sample.origin.source, "coded.csv");
  EXPECT_EQ(sample.origin.session, 0U);
  EXPECT_EQ(sample.origin.seq, 2U);
  EXPECT_EQ(tai_ns(sample.frame.t), 1795143637568985513);
  EXPECT_EQ(sample.frame.period_s, 1.00007);
  EXPECT_THAT(sample.frame.delay_s, ::testing::ElementsAre(std::nullopt, 0.07932, 0.4545,
                                                           std::nullopt, 0.45928, 0.60985));
}

TEST(CodedFile, MayLackAnythingButItsTime) {
  const auto telemetry = read_coded_row("1795143637568985513,,,,,,");
  EXPECT_TRUE(telemetry.rejected.empty());
  ASSERT_EQ(telemetry.coded.size(), 1U);
  EXPECT_EQ(telemetry.coded[0].frame.period_s, std::nullopt);
  EXPECT_THAT(telemetry.coded[0].frame.delay_s, ::testing::Each(std::nullopt));
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
      {"1795143637568985513,1,-0.001,,,,", "sun2_s = -0.001: must be 0 to the period, 1 s"},
      {"1795143637568985513,0.5,,0.51,,,", "north_in_s = 0.51: must be 0 to the period, 0.5 s"},
      {"1795143637568985513,,,,61,,", "north_out_s = 61: must be 0 to 60 s"},
  };
  for (const BadRow& bad : rows) {
    SCOPED_TRACE(bad.row);
    const auto telemetry = read_coded_row(bad.row);
    EXPECT_TRUE(telemetry.coded.empty());
    ASSERT_EQ(telemetry.rejected.size(), 1U);
    EXPECT_EQ(telemetry.rejected[0].line, 2);
    EXPECT_THAT(telemetry.rejected[0].reason, HasSubstr(bad.reason));
  }
}

TEST(CodedFile, TakesTheEndsOfWhatItAllows) {
  for (const char* row : {"1795143637568985513,60,0,60,,,", "1795143637568985513,1,1,1.009,,,",
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

TEST(TelemetryStream, MergesPulsesAndFramesByTimeAndHandsOverOneKindAtATime) {
  const TemporaryFolder folder;
  const auto coded = folder.write("coded.csv", std::string{kCodedHeader} +
                                                   "1795143637000000003,1,,,,,\n"
                                                   "1795143637000000001,1,,,,,\n");
  const auto pulses = folder.write("pulses.csv",
                                   "t_tai_ns,channel\n"
                                   "1795143637000000004,sun1\n"
                                   "1795143637000000001,south_out\n"
                                   "1795143637000000002,sun1\n");
  const auto files = scan_telemetry({{coded, pulses}});
  auto stream = TelemetryStream::open(*files, "SPINNER").value();
  std::vector<std::string> order;
  for (auto batch = stream.next().value(); batch.pulses.size() + batch.coded.size() > 0;
       batch = stream.next().value()) {
    for (const PulseSample& sample : batch.pulses) {
      order.push_back("pulse " + std::to_string(tai_ns(sample.pulse.t) % 10));
    }
    for (const CodedSample& sample : batch.coded) {
      order.push_back("coded " + std::to_string(tai_ns(sample.frame.t) % 10));
    }
  }
  EXPECT_THAT(order, ::testing::ElementsAre("pulse 1", "coded 1", "pulse 2", "coded 3", "pulse 4"));
}

/// `count` rows a microsecond apart, moved about within blocks of `block` rows.
std::string disordered_rows(std::size_t count, std::size_t block) {
  std::vector<std::int64_t> times(count);
  for (std::size_t i = 0; i < count; ++i) {
    times[i] = kT0_tai_ns + static_cast<std::int64_t>(i) * 1000;
  }
  std::mt19937 random{20261121};
  for (std::size_t from = 0; from < count; from += block) {
    std::shuffle(times.begin() + static_cast<std::ptrdiff_t>(from),
                 times.begin() + static_cast<std::ptrdiff_t>(std::min(from + block, count)),
                 random);
  }
  std::string text = "t_tai_ns,channel\n";
  for (const std::int64_t t_tai_ns : times) {
    text += std::to_string(t_tai_ns) + ",sun1\n";
  }
  return text;
}

constexpr std::size_t kRow = sizeof(TelemetryRow<Pulse>);

TEST(TelemetryStream, SortsCompletelyWhatItsBufferHolds) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.csv", disordered_rows(20'000, 20'000));
  const auto telemetry = read({path}, 20'001 * kRow);
  EXPECT_EQ(telemetry.samples.size(), 20'000U);
  EXPECT_TRUE(std::is_sorted(telemetry.times.begin(), telemetry.times.end()));
}

TEST(TelemetryStream, SortsALongerFileWhoseRowsAreNearTheirPlace) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.csv", disordered_rows(50'000, 500));
  const auto telemetry = read({path}, 1000 * kRow);
  EXPECT_EQ(telemetry.samples.size(), 50'000U);
  EXPECT_TRUE(std::is_sorted(telemetry.times.begin(), telemetry.times.end()));
}

TEST(TelemetryStream, PassesOnARowThatComesTooLateForItsPlace) {
  const TemporaryFolder folder;
  const auto path = folder.write(
      "a.csv", disordered_rows(50'000, 1) + std::to_string(kT0_tai_ns - 1) + ",sun2\n");
  const auto telemetry = read({path}, 1000 * kRow);
  ASSERT_EQ(telemetry.samples.size(), 50'001U);
  EXPECT_NE(telemetry.samples.front().pulse.channel, PulseChannel::Sun2);
  std::vector<TaiTime> others;
  for (const PulseSample& sample : telemetry.samples) {
    if (sample.pulse.channel == PulseChannel::Sun1) {
      others.push_back(sample.pulse.t);
    }
  }
  EXPECT_EQ(others.size(), 50'000U);
  EXPECT_TRUE(std::is_sorted(others.begin(), others.end()));
}

TEST(TelemetryStream, MergesManyFilesThatShareASmallBuffer) {
  // Every row in one of ten files; the buffer holds a tenth of them all.
  std::istringstream rows{disordered_rows(50'000, 20)};
  std::vector<std::string> texts(10, "t_tai_ns,channel\n");
  std::string row;
  std::getline(rows, row);
  for (std::size_t i = 0; std::getline(rows, row); ++i) {
    texts[i % 10] += row + "\n";
  }
  const TemporaryFolder folder;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    folder.write(std::to_string(i) + ".csv", texts[i]);
  }
  const auto telemetry = read({folder.path()}, 5000 * kRow);
  EXPECT_EQ(telemetry.samples.size(), 50'000U);
  EXPECT_TRUE(std::is_sorted(telemetry.times.begin(), telemetry.times.end()));
}

TEST(TelemetryStream, NeverGathersRejectedRows) {
  std::string text = "t_tai_ns,channel\n";
  for (int i = 0; i < 10'000; ++i) {
    text += "soon,sun1\n";
  }
  text += "1795143637568806257,sun1\n";
  const TemporaryFolder folder;
  const auto telemetry = read({folder.write("a.csv", text)});
  EXPECT_EQ(telemetry.rejected.size(), 10'000U);
  EXPECT_EQ(telemetry.samples.size(), 1U);
}

TEST(TelemetryStream, KeepsTheSpacecraftOfEveryRow) {
  std::string text = "spacecraft,t_tai_ns,channel\n";
  for (int i = 0; i < 1000; ++i) {
    text += "SC-" + std::to_string(i % 7) + "," + std::to_string(kT0_tai_ns - i) + ",sun1\n";
  }
  const TemporaryFolder folder;
  const auto telemetry = read({folder.write("a.csv", text)});
  ASSERT_EQ(telemetry.samples.size(), 1000U);
  for (const PulseSample& sample : telemetry.samples) {
    EXPECT_EQ(sample.spacecraft, "SC-" + std::to_string((kT0_tai_ns - tai_ns(sample.pulse.t)) % 7));
  }
}

TEST(TelemetryStream, ReadsLinesThatCrossItsReads) {
  // Reads are of a power of two bytes; the rows are 26.
  constexpr std::size_t kRows = 50'000;
  const TemporaryFolder folder;
  const auto telemetry = read({folder.write("a.csv", disordered_rows(kRows, 1))});
  EXPECT_TRUE(telemetry.rejected.empty());
  ASSERT_EQ(telemetry.samples.size(), kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    ASSERT_EQ(tai_ns(telemetry.samples[i].pulse.t),
              kT0_tai_ns + static_cast<std::int64_t>(i) * 1000);
    ASSERT_EQ(telemetry.samples[i].origin.seq, i + 2);
  }
}

TEST(TelemetryStream, GoesOnBehindALineLongerThanItsReads) {
  const TemporaryFolder folder;
  const auto telemetry =
      read({folder.write("a.csv", "t_tai_ns,channel\n" + std::string(1'000'000, '7') +
                                      "\n1795143637568806257,sun1\n")});
  ASSERT_EQ(telemetry.rejected.size(), 1U);
  EXPECT_THAT(telemetry.rejected[0].reason, HasSubstr("too long for telemetry"));
  ASSERT_EQ(telemetry.samples.size(), 1U);
  EXPECT_EQ(telemetry.samples[0].origin.seq, 3U);
}

}  // namespace
}  // namespace spindrift
