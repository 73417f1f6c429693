#include "services/telemetry/telemetry_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/matchers.h"
#include "tests/support/read_telemetry.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"

namespace spindrift::telemetry_stream_test {

TEST(TelemetryStream, OfAFileThatHasGoneIsAnError) {
  const TemporaryFolder folder;
  const std::vector<TelemetryFile> files = {
      {.path = folder.path() / "gone.csv", .kind = Kind<Pulse>{}}};
  const auto pulses = TelemetryStream::open(files, "SPINNER");
  EXPECT_THAT(pulses, IsRefused(ErrorCode::InvalidConfiguration,
                                HasSubstr("gone.csv: cannot be read: No such file")));
}

TEST(TelemetryStream, RejectsBadRowsOfEveryKind) {
  const TemporaryFolder folder;
  folder.write("pulses.csv", "t_tai_ns,channel\n1795143637568806257,sun1\n");
  folder.write("star.csv", "t_tai_ns,qx,qy,qz,qw\nrubbish\n");
  const auto pulses = read({folder.path()});
  EXPECT_EQ(pulses.samples.size(), 1U);
  EXPECT_THAT(pulses.rejected, ElementsAre(Field(&RejectedInput::source, HasSubstr("star.csv"))));
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
  for (const TelemetrySample<Pulse>& sample : pulses.samples) {
    seen.push_back(std::to_string(tai_ns(sample.value.t) % 10) + " " +
                   std::string{name_of(sample.value.channel)} + " " + sample.origin.source);
  }
  EXPECT_THAT(seen, ElementsAre("0 south_out b.csv", "1 sun1 a.csv", "1 sun1 b.csv", "1 sun2 a.csv",
                                "2 sun1 a.csv"));
}

TEST(TelemetryStream, GivesTheSamePulsesWhateverTheOrderOfTheRowsAndFiles) {
  const std::filesystem::path nominal = recorded_passes() / "nominal" / "pulses.csv";
  const auto expected = read({nominal});
  ASSERT_EQ(expected.samples.size(), 3600U);
  EXPECT_TRUE(expected.rejected.empty());

  std::vector<std::string> rows;
  for (const TelemetrySample<Pulse>& sample : expected.samples) {
    rows.push_back(std::to_string(tai_ns(sample.value.t)) + "," +
                   std::string{name_of(sample.value.channel)} + "\n");
  }
  std::mt19937 random{20261120};
  for (int trial = 0; trial < 5; ++trial) {
    SCOPED_TRACE(trial);
    std::ranges::shuffle(rows, random);
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
                           [](const auto& x, const auto& y) { return x.value == y.value; }));
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
    const auto pulses = read_text(text);
    EXPECT_EQ(pulses.samples.size() + pulses.rejected.size(), 20U);
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
  for (auto batch = stream.next().value(); !is_empty(batch); batch = stream.next().value()) {
    in_order_of_arrival(batch.samples, [&]<class Value>(const TelemetrySample<Value>& sample) {
      order.push_back(fmt::format("{} {}", Telemetry<Value>::kName, tai_ns(sample.value.t) % 10));
    });
  }
  EXPECT_THAT(order, ElementsAre("pulses 1", "coded 1", "pulses 2", "coded 3", "pulses 4"));
}

/// Returns `count` rows a microsecond apart, shuffled within blocks of `block` rows.
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

TEST(TelemetryStream, SortsWhatItsBufferHoldsAndALongerFileWhoseRowsAreNearTheirPlace) {
  for (const auto& [count, block, buffer] :
       {std::array{20'000U, 20'000U, 20'001U}, std::array{50'000U, 500U, 1000U}}) {
    SCOPED_TRACE(count);
    const auto telemetry = read_text(disordered_rows(count, block), buffer * kRow);
    EXPECT_EQ(telemetry.samples.size(), count);
    EXPECT_TRUE(std::ranges::is_sorted(telemetry.times));
  }
}

TEST(TelemetryStream, PassesOnARowThatComesTooLateForItsPlace) {
  const auto telemetry = read_text(
      disordered_rows(50'000, 1) + std::to_string(kT0_tai_ns - 1) + ",sun2\n", 1000 * kRow);
  ASSERT_EQ(telemetry.samples.size(), 50'001U);
  EXPECT_NE(telemetry.samples.front().value.channel, PulseChannel::Sun2);
  std::vector<TaiTime> others;
  for (const TelemetrySample<Pulse>& sample : telemetry.samples) {
    if (sample.value.channel == PulseChannel::Sun1) {
      others.push_back(sample.value.t);
    }
  }
  EXPECT_EQ(others.size(), 50'000U);
  EXPECT_TRUE(std::ranges::is_sorted(others));
}

TEST(TelemetryStream, MergesManyFilesThatShareASmallBuffer) {
  // Each row is in one of ten files; the buffer holds a tenth of all rows.
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
  EXPECT_TRUE(std::ranges::is_sorted(telemetry.times));
}

TEST(TelemetryStream, NeverGathersRejectedRows) {
  std::string text = "t_tai_ns,channel\n";
  for (int i = 0; i < 10'000; ++i) {
    text += "soon,sun1\n";
  }
  text += "1795143637568806257,sun1\n";
  const auto telemetry = read_text(text);
  EXPECT_EQ(telemetry.rejected.size(), 10'000U);
  EXPECT_EQ(telemetry.samples.size(), 1U);
}

TEST(TelemetryStream, KeepsTheSpacecraftOfEveryRow) {
  std::string text = "spacecraft,t_tai_ns,channel\n";
  for (int i = 0; i < 1000; ++i) {
    text += "SC-" + std::to_string(i % 7) + "," + std::to_string(kT0_tai_ns - i) + ",sun1\n";
  }
  const auto telemetry = read_text(text);
  ASSERT_EQ(telemetry.samples.size(), 1000U);
  for (const TelemetrySample<Pulse>& sample : telemetry.samples) {
    EXPECT_EQ(sample.spacecraft, "SC-" + std::to_string((kT0_tai_ns - tai_ns(sample.value.t)) % 7));
  }
}

TEST(TelemetryStream, ReadsLinesThatCrossItsReads) {
  // Reads have a power of two bytes, whereas rows have 26.
  constexpr std::size_t kRows = 50'000;
  const auto telemetry = read_text(disordered_rows(kRows, 1));
  EXPECT_TRUE(telemetry.rejected.empty());
  ASSERT_EQ(telemetry.samples.size(), kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    ASSERT_EQ(tai_ns(telemetry.samples[i].value.t),
              kT0_tai_ns + static_cast<std::int64_t>(i) * 1000);
    ASSERT_EQ(telemetry.samples[i].origin.seq, i + 2);
  }
}

TEST(TelemetryStream, GoesOnBehindALineLongerThanItsReads) {
  const auto telemetry = read_text("t_tai_ns,channel\n" + std::string(1'000'000, '7') +
                                   "\n1795143637568806257,sun1\n");
  EXPECT_THAT(telemetry.rejected,
              ElementsAre(Field(&RejectedInput::reason, HasSubstr("too long for telemetry"))));
  ASSERT_EQ(telemetry.samples.size(), 1U);
  EXPECT_EQ(telemetry.samples[0].origin.seq, 3U);
}

}  // namespace spindrift::telemetry_stream_test
