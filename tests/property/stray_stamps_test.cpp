/// Samples with a wrong time, however many and wherever they are, do not change the products of the
/// others, live or from files.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <random>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "pipelines/spin/pass/spin_pass.h"
#include "pipelines/three_axis/three_axis_pass.h"
#include "services/telemetry/telemetry_files.h"
#include "services/telemetry/telemetry_row.h"
#include "services/telemetry/telemetry_stream.h"
#include "tests/support/matchers.h"
#include "tests/support/product_text.h"
#include "tests/support/recorded_pass.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::stray_stamps_test {

using namespace std::chrono_literals;

/// Describes wrong times in a stream of samples.
struct Strays {
  std::size_t count;
  bool in_a_row;
  std::chrono::seconds off;  ///< Time error; 0 for a random one each.
};

std::string text_of(const Strays& strays) {
  return fmt::format("{} {} by {} s", strays.count, strays.in_a_row ? "in a row" : "spread",
                     strays.off.count());
}

std::vector<Strays> all_strays() {
  std::vector<Strays> all;
  for (const std::size_t count : {1U, 2U, 7U, 8U, 9U, 20U, 100U}) {
    for (const bool in_a_row : {true, false}) {
      for (const auto off : {1800s, -1800s, 7200s, 0s}) {
        all.push_back({.count = count, .in_a_row = in_a_row, .off = off});
      }
    }
  }
  return all;
}

/// Returns the indices of the strays: consecutive from a third of the stream on, or spread over it.
std::set<std::size_t> places_of(const Strays& strays, std::size_t samples) {
  std::set<std::size_t> places;
  for (std::size_t i = 0; i < strays.count; ++i) {
    places.insert(strays.in_a_row ? samples / 3 + i : (i + 1) * samples / (strays.count + 1));
  }
  return places;
}

/// Returns a time error of two minutes to a day, either way.
std::chrono::nanoseconds error_of(const Strays& strays, std::mt19937_64& rng) {
  if (strays.off != 0s) {
    return strays.off;
  }
  std::uniform_int_distribution<std::int64_t> off_s{120, 86'400};
  const std::chrono::seconds off{off_s(rng)};
  return rng() % 2 == 0 ? off : -off;
}

template <class Sample>
struct Stream {
  std::vector<Sample> all;   ///< Samples in order of arrival.
  std::vector<Sample> good;  ///< Samples without the strays.
};

template <class Sample>
Stream<Sample> with_strays(const std::vector<Sample>& samples, const Strays& strays) {
  std::mt19937_64 rng{43};
  const std::set<std::size_t> places = places_of(strays, samples.size());
  Stream<Sample> stream;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    stream.all.push_back(samples[i]);
    if (places.contains(i)) {
      stream.all.back().t += error_of(strays, rng);
    } else {
      stream.good.push_back(samples[i]);
    }
  }
  return stream;
}

bool is_for_its_time(std::optional<Rejection> rejected_by) {
  return rejected_by == Rejection::OutOfTime || rejected_by == Rejection::Late;
}

/// Returns the products as text without the edges rejected for their time, which are counted.
std::vector<std::string> in_time(const SpinOutput& output, std::size_t& left_out) {
  std::vector<std::string> texts;
  for (const SpinProduct& product : output.products) {
    const auto* const use = std::get_if<PulseUse>(&product);
    if (use != nullptr && is_for_its_time(use->rejected_by)) {
      ++left_out;
    } else {
      texts.push_back(testing::text_of(product));
    }
  }
  return texts;
}

template <class Value>
void write(const TemporaryFolder& folder, const std::vector<Value>& values) {
  std::string text = header_of<Value>() + "\n";
  for (const Value& value : values) {
    append_row(value, text);
  }
  folder.write(std::string{Telemetry<Value>::kName} + ".csv", text);
}

/// Reads the files like `process`.
/// @param see Receives each sample in order.
template <class See>
void read(const TemporaryFolder& folder, See see) {
  const std::vector<std::filesystem::path> paths{folder.path()};
  auto stream = TelemetryStream::open(scan_telemetry(paths).value(), "SAT").value();
  for (auto batch = stream.next().value(); !is_empty(batch); batch = stream.next().value()) {
    in_order_of_arrival(batch.samples, [&](const auto& sample) { see(sample.value); });
  }
}

template <class Value>
std::vector<Value> from_file(const std::vector<Value>& values) {
  const TemporaryFolder folder;
  write(folder, values);
  std::vector<Value> read_back;
  read(folder, [&]<class Other>(const Other& value) {
    if constexpr (std::is_same_v<Other, Value>) {
      read_back.push_back(value);
    }
  });
  return read_back;
}

/// Expects the products of the good samples, live and from a file.
/// @return Number of edges that were left out for their time, of both runs.
template <class Sample>
std::array<std::size_t, 2> expect_unmoved(const RecordedPass& pass,
                                          const std::vector<Sample>& samples,
                                          const Strays& strays) {
  const Stream<Sample> stream = with_strays(samples, strays);
  const auto expected = texts_of(run(SpinPass{pass.config, pass.orbit}, stream.good));
  std::array<std::size_t, 2> left_out{};
  EXPECT_EQ(in_time(run(SpinPass{pass.config, pass.orbit}, stream.all), left_out[0]), expected);
  EXPECT_EQ(in_time(run(SpinPass{pass.config, pass.orbit}, from_file(stream.all)), left_out[1]),
            expected);
  return left_out;
}

/// Returns the recorded pulses in order, no more than these.
RecordedPass nominal(std::size_t pulses) {
  RecordedPass pass = recorded_pass("nominal");
  std::sort(pass.pulses.begin(), pass.pulses.end());
  pass.pulses.resize(pulses);
  return pass;
}

TEST(StrayStamps, OfPulsesMoveNothingHoweverManyThereAre) {
  const RecordedPass pass = nominal(1200);
  for (const Strays& strays : all_strays()) {
    SCOPED_TRACE(text_of(strays));
    EXPECT_THAT(expect_unmoved(pass, pass.pulses, strays), Each(strays.count));
  }
}

TEST(StrayStamps, OfCodedFramesMoveNothing) {
  const RecordedPass pass = recorded_pass("coded");
  for (const Strays& strays : {Strays{20, false, 1800s}, Strays{9, true, 1800s}}) {
    SCOPED_TRACE(text_of(strays));
    // A frame contains several edges.
    EXPECT_THAT(expect_unmoved(pass, pass.frames, strays), Each(::testing::Gt(strays.count)));
  }
}

struct ThreeAxisSamples {
  std::vector<GyroSample> gyro;
  std::vector<StarFix> star;
};

/// Holds ten minutes of a gyro at 4 Hz, 2,400 samples.
struct ThreeAxisScene {
  ThreeAxisSamples samples;
  ThreeAxisConfig config = usual_three_axis();

  ThreeAxisScene() {
    std::mt19937_64 rng{44};
    const TurningBody body = TurningBody::smooth(rng, 600.0, 0.02);
    Sensors sensors{body, config, rng};
    for (int i = 0; i < 2400; ++i) {
      samples.gyro.push_back(sensors.gyro(0.25 * i));
      if (i % 4 == 0) {
        samples.star.push_back(sensors.star(0.25 * i + 0.1));
      }
    }
  }
};

class ThreeAxisTexts {
 public:
  explicit ThreeAxisTexts(const ThreeAxisConfig& config) : pass_{config, std::nullopt} {}

  template <class Value>
  void push(const Value& value) {
    if constexpr (requires { pass_.push(value); }) {
      keep(pass_.push(value));
    }
  }
  void finish() { keep(pass_.finish()); }

  std::vector<std::string> texts;
  std::size_t left_out = 0;

 private:
  void keep(const ThreeAxisOutput& output) {
    for (const ThreeAxisProduct& product : output.products) {
      if (const auto* const sample = std::get_if<RejectedSample>(&product)) {
        if (is_for_its_time(sample->rejected_by)) {
          ++left_out;
        } else {
          texts.push_back(fmt::format("{} {}", tai_ns(sample->t), name_of(sample->rejected_by)));
        }
      } else if (const auto* const estimate = std::get_if<AttitudeEstimate>(&product)) {
        texts.push_back(fmt::format("{} {} {} {} {}", tai_ns(estimate->t),
                                    estimate->q_icrf_body.x(), estimate->q_icrf_body.w(),
                                    estimate->covariance_rad2.trace(),
                                    static_cast<int>(estimate->assessment.quality)));
      }
    }
  }

  ThreeAxisPass pass_;
};

/// Runs the samples live; each gyro sample arrives at its true time.
std::vector<std::string> live(const ThreeAxisScene& scene, const std::vector<GyroSample>& gyro,
                              const std::vector<TaiTime>& true_times, std::size_t& left_out) {
  ThreeAxisTexts texts{scene.config};
  auto star = scene.samples.star.begin();
  for (std::size_t i = 0; i < gyro.size(); ++i) {
    for (; star != scene.samples.star.end() && star->t < true_times[i]; ++star) {
      texts.push(*star);
    }
    texts.push(gyro[i]);
  }
  for (; star != scene.samples.star.end(); ++star) {
    texts.push(*star);
  }
  texts.finish();
  left_out = texts.left_out;
  return texts.texts;
}

std::vector<TaiTime> times_of(const std::vector<GyroSample>& samples) {
  std::vector<TaiTime> times;
  for (const GyroSample& sample : samples) {
    times.push_back(sample.t);
  }
  return times;
}

/// Runs the samples from files.
ThreeAxisTexts offline(const ThreeAxisConfig& config, const std::vector<GyroSample>& gyro,
                       const std::vector<StarFix>& star) {
  const TemporaryFolder folder;
  write(folder, gyro);
  write(folder, star);
  ThreeAxisTexts texts{config};
  read(folder, [&](const auto& sample) { texts.push(sample); });
  texts.finish();
  return texts;
}

TEST(StrayStamps, OfAGyroMoveNothingHoweverManyThereAre) {
  const ThreeAxisScene scene;
  for (const Strays& strays : all_strays()) {
    SCOPED_TRACE(text_of(strays));
    const Stream<GyroSample> stream = with_strays(scene.samples.gyro, strays);
    std::size_t left_out = 0;
    const auto expected = live(scene, stream.good, times_of(stream.good), left_out);
    ASSERT_EQ(left_out, 0U);
    ASSERT_EQ(live(scene, stream.all, times_of(scene.samples.gyro), left_out), expected);
    ASSERT_EQ(left_out, strays.count);

    const ThreeAxisTexts filed = offline(scene.config, stream.all, scene.samples.star);
    ASSERT_EQ(filed.texts, expected);
    ASSERT_EQ(filed.left_out, strays.count);
  }
}

TEST(StrayStamps, OfOneKindMoveNothingBehindTheOthersEither) {
  const ThreeAxisScene scene;
  // Spaced like the gyro's samples, or over the whole pass.
  for (const auto between : {250ms, 12'000ms}) {
    std::vector<GyroSample> gyro = scene.samples.gyro;
    for (std::size_t i = 0; i < 20; ++i) {
      GyroSample stray = gyro[i];
      stray.t += 1800s + static_cast<std::int64_t>(i) * between;
      gyro.push_back(stray);
    }
    const ThreeAxisTexts filed = offline(scene.config, gyro, scene.samples.star);
    std::size_t none = 0;
    ASSERT_EQ(filed.texts, live(scene, scene.samples.gyro, times_of(scene.samples.gyro), none));
    ASSERT_EQ(filed.left_out, 20U);
  }
}

TEST(StrayStamps, AreNoneOfASecondContactOfAFewSamples) {
  const ThreeAxisScene scene;
  ThreeAxisScene two;
  two.samples.gyro.resize(400);
  two.samples.star.resize(100);
  for (std::size_t i = 400; i < 420; ++i) {
    two.samples.gyro.push_back(scene.samples.gyro[i]);
    two.samples.gyro.back().t += 1800s;
  }
  for (std::size_t i = 101; i < 104; ++i) {
    two.samples.star.push_back(scene.samples.star[i]);
    two.samples.star.back().t += 1800s;
  }
  const ThreeAxisTexts filed = offline(scene.config, two.samples.gyro, two.samples.star);
  EXPECT_EQ(filed.left_out, 0U);
  EXPECT_TRUE(filed.texts.back().starts_with(std::to_string(tai_ns(two.samples.gyro.back().t))));

  RecordedPass pass = nominal(640);
  std::for_each(pass.pulses.begin() + 600, pass.pulses.end(),
                [](Pulse& pulse) { pulse.t += 1800s; });
  std::size_t left_out = 0;
  in_time(run(SpinPass{pass.config, pass.orbit}, from_file(pass.pulses)), left_out);
  EXPECT_EQ(left_out, 0U);
}

}  // namespace spindrift::testing::stray_stamps_test
