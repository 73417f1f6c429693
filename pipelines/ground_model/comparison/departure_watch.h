/// @file
/// Compares samples of flight and model channel by channel, and detects flight that leaves the band
/// about the model and stays outside.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/supervision/condition_watch.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

struct ComparedChannel {
  std::string name;       ///< Name, e.g. "gyro_x". Channel "gyro" tells whether the sensor sends.
  std::string_view unit;  ///< Unit of the values; empty for a channel that only has to send.
  double holding_s;       ///< Time over which a departure of flight is judged.
};

/// Values of flight and model in the unit of the channel.
struct ComparedValue {
  double flight;
  double model;
  double sigma;  ///< Standard deviation of their difference due to noise; above 0.

  double residual() const { return flight - model; }
  double normalised() const { return residual() / sigma; }
};

struct ComparedSample {
  std::size_t channel;  ///< Index among the model's channels.
  TaiTime t;
  bool came;  ///< False where the model sends and flight does not.
  std::optional<ComparedValue> value = {};
};

/// Returns the time over which a departure is judged: ten seconds and twenty samples at least, so
/// that single outliers are no departure.
/// @param step_s Time between samples.
inline double holding_s(double step_s) { return std::max(10.0, 20.0 * step_s); }

/// Accumulates residuals, flight minus model, in the unit of the channel. A statistic is 0 where
/// there are too few residuals for it.
class ResidualStatistics {
 public:
  void add(const ComparedValue& value) {
    const double residual = value.residual();
    const double before = residual - mean_;
    ++count_;
    mean_ += before / static_cast<double>(count_);
    about_mean_ += before * (residual - mean_);
    squares_ += residual * residual;
    normalised_squares_ += value.normalised() * value.normalised();
    most_ = std::max(most_, std::abs(residual));
  }

  std::int64_t count() const { return count_; }
  double mean() const { return mean_; }
  /// Returns the standard deviation about the mean.
  double sigma() const {
    return count_ > 1 ? std::sqrt(about_mean_ / static_cast<double>(count_ - 1)) : 0.0;
  }
  double rms() const { return root_mean(squares_); }
  /// Returns the rms of the residuals divided by their sigma: 1 where only noise makes them.
  double normalised_rms() const { return root_mean(normalised_squares_); }
  double most() const { return most_; }  ///< Largest absolute residual.

 private:
  double root_mean(double squares) const {
    return count_ > 0 ? std::sqrt(squares / static_cast<double>(count_)) : 0.0;
  }

  std::int64_t count_ = 0;
  double mean_ = 0.0;
  double about_mean_ = 0.0;  ///< Sum of squares about the mean.
  double squares_ = 0.0;
  double normalised_squares_ = 0.0;
  double most_ = 0.0;
};

/// Holds the result of the comparison in one channel.
struct ChannelComparison {
  ComparedChannel channel;
  ResidualStatistics residuals = {};
  std::int64_t outside = 0;  ///< Number of residuals outside the band.
  /// First departure of flight that lasted. Its value, limit and unit are of its first instant: the
  /// size of the residual and the half-width of its band or, in "s silent", the length of the
  /// silence.
  std::optional<Evidence> departure = {};
};

/// Watches for departures. A channel of values departs once, among its samples of the last
/// `holding_s`, those that are outside the band or missing outnumber the others by kAhead; it is
/// back when at most a quarter has been so for kClear_s. So flight that oscillates about the model
/// departs; outliers do not. A sensor departs that sends nothing for `holding_s` while the model
/// sends.
class DepartureWatch {
 public:
  static constexpr int kAhead = 8;
  static constexpr double kClear_s = 60.0;

  /// @param band_sigmas Half-width of the band, in sigma of each residual.
  DepartureWatch(const std::vector<ComparedChannel>& channels, double band_sigmas);

  void set_band(double band_sigmas) { band_sigmas_ = band_sigmas; }

  /// Judges a sample; one earlier than its channel's last sample counts for the statistics only.
  std::optional<ConditionChange> evaluate(const ComparedSample& sample);

  /// Returns the results in the order of the channels given to the constructor.
  std::vector<ChannelComparison> channels() const;

 private:
  struct Judged {
    bool is_away;
    Evidence evidence;
  };
  struct Watched {
    ChannelComparison comparison;
    ConditionWatch watch;
    /// Last samples; of a silent sensor the first and the last only.
    std::deque<Judged> window = {};
  };
  /// Returns empty where the channel counts neither as away nor as back.
  static std::optional<bool> is_away(const Judged& now, Watched& watched);
  static std::optional<bool> is_silent(const Judged& now, Watched& watched);

  double band_sigmas_;
  std::vector<Watched> watched_;
};

}  // namespace spindrift
