#include "services/mission/mission_alignment.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/core/shown.h"
#include "services/mission/key_check.h"
#include "services/mission/nearest_name.h"
#include "services/mission/values.h"

namespace spindrift {
namespace {

constexpr std::string_view kNames = "calibration.names";
constexpr std::string_view kCovariance = "calibration.covariance";

/// Tolerance of symmetry and of correlations, for rounding in what a program or a person writes.
constexpr double kRounding = 1e-9;

/// Something that the mission file may be off by.
struct StatedError {
  std::string_view name;  ///< Name in [calibration].
  double unit;            ///< One unit of name and sigma in the unit of the pipeline.
  std::string sigma_key;  ///< Dotted key of its sigma.
  std::string needs;      ///< Dotted key that only a mission file with this sensor has.
};
using StatedErrors = std::vector<StatedError>;

StatedErrors spin_errors() {
  static constexpr std::array<std::string_view, kSpinAlignmentErrors> kSigmas = {
      "slit_cant_deg",     "slit_separation_deg", "north_mount_angle_deg", "south_mount_angle_deg",
      "north_azimuth_deg", "south_azimuth_deg",   "co2_altitude_km",       "time_tag_s"};
  StatedErrors errors;
  for (std::size_t i = 0; i < kSigmas.size(); ++i) {
    const std::string_view name = kSpinAlignmentKeys.at(i);
    errors.push_back({.name = name,
                      .unit = name.ends_with("_deg") ? kRadPerDeg : 1.0,
                      .sigma_key = fmt::format("spin.alignment.{}", kSigmas.at(i)),
                      .needs = std::string{name}});
  }
  return errors;
}

StatedErrors three_axis_errors(const TomlValues& values) {
  struct Group {
    int first;
    std::string_view sigma;
    std::string_view needs;
  };
  constexpr std::string_view kOfInertia = "inertia.sigma_fraction";
  const bool has_own = values.contains(fmt::format("three_axis.{}", kOfInertia));
  const std::array<Group, 10> groups = {{
      {StarTrackerError, "alignment.star_tracker_deg", "star_tracker.noise_arcsec"},
      {SunSensorError, "alignment.sun_sensor_deg", "sun_sensor.noise_deg"},
      {MagnetometerError, "alignment.magnetometer_deg", "magnetometer.noise_nt"},
      {MagnetometerBiasError, "alignment.magnetometer_bias_nt", "magnetometer.noise_nt"},
      {GyroScaleError, "alignment.gyro_scale", "gyro.noise_deg_s"},
      {GyroAxisError, "alignment.gyro_deg", "gyro.noise_deg_s"},
      {StarTrackerTimeError, "alignment.time_tag_s", "star_tracker.noise_arcsec"},
      {SunSensorTimeError, "alignment.time_tag_s", "sun_sensor.noise_deg"},
      {MagnetometerTimeError, "alignment.time_tag_s", "magnetometer.noise_nt"},
      {InertiaError, has_own ? kOfInertia : "alignment.inertia_fraction", "inertia.kg_m2"},
  }};
  StatedErrors errors;
  for (int i = 0; i < kAttitudeAlignmentErrors; ++i) {
    const Group& group = *std::prev(std::ranges::upper_bound(groups, i, {}, &Group::first));
    const AttitudeAlignmentName& name = kAttitudeAlignmentNames.at(static_cast<std::size_t>(i));
    errors.push_back({.name = name.name,
                      .unit = name.unit,
                      .sigma_key = fmt::format("three_axis.{}", group.sigma),
                      .needs = fmt::format("three_axis.{}", group.needs)});
  }
  return errors;
}

StatedErrors errors_of(SpacecraftKind kind, const TomlValues& values) {
  return kind == SpacecraftKind::Spin ? spin_errors() : three_axis_errors(values);
}

/// Returns the number of the error of this name, behind the last if there is none.
std::size_t numbered(const StatedErrors& errors, std::string_view name) {
  const auto found = std::ranges::find(errors, name, &StatedError::name);
  return static_cast<std::size_t>(found - errors.begin());
}

std::vector<std::string> calibrated_names(const TomlValues& values) {
  return value_if<std::vector<std::string>>(values, kNames).value_or(std::vector<std::string>{});
}

/// The covariance of [calibration], in the units of its names.
Eigen::MatrixXd calibrated_covariance(const TomlValues& values) {
  const auto elements = value_of<std::vector<double>>(values, kCovariance);
  const auto size = std::lround(std::sqrt(static_cast<double>(elements.size())));
  return Eigen::Map<const Eigen::MatrixXd>{elements.data(), size, size}.transpose();
}

/// Returns the covariance in the units of the pipeline.
Eigen::MatrixXd stated_covariance(const TomlValues& values, const StatedErrors& errors) {
  Eigen::VectorXd sigma{static_cast<Eigen::Index>(errors.size())};
  std::ranges::transform(errors, sigma.begin(), [&](const StatedError& error) {
    return number(values, error.sigma_key) * error.unit;
  });
  Eigen::MatrixXd covariance = sigma.cwiseAbs2().asDiagonal();
  const std::vector<std::string> names = calibrated_names(values);
  if (names.empty()) {
    return covariance;
  }
  std::vector<std::size_t> at;
  std::ranges::transform(names, std::back_inserter(at),
                         [&](const std::string& name) { return numbered(errors, name); });
  Eigen::VectorXd unit{std::ssize(at)};
  std::ranges::transform(at, unit.begin(), [&](std::size_t i) { return errors[i].unit; });
  covariance(at, at) = unit.asDiagonal() * calibrated_covariance(values) * unit.asDiagonal();
  return covariance;
}

/// Returns the greatest sigma that the schema allows for a key, which needs no dot in its name.
double most_sigma(const TableRule& schema, std::string_view dotted) {
  const TableRule* table = &schema;
  for (std::size_t dot = dotted.find('.'); dot != std::string_view::npos; dot = dotted.find('.')) {
    table = &table->tables.find(dotted.substr(0, dot))->second;
    dotted.remove_prefix(dot + 1);
  }
  return as_number(table->keys.find(dotted)->second.upper->value);
}

/// Checks [calibration], the names first: only good ones say what the covariance may be.
class CalibrationCheck {
 public:
  CalibrationCheck(TomlDocument& document, const TableRule& schema, SpacecraftKind kind)
      : document_{document},
        schema_{schema},
        kind_{kind},
        errors_{errors_of(kind, document.values)},
        names_{calibrated_names(document.values)},
        covariance_{calibrated_covariance(document.values)} {}

  void check() {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (const auto wrong = objection_to_name(i); !wrong.empty()) {
        const std::string key = fmt::format("{}[{}]", kNames, i);
        problem(key, fmt::format("{} = \"{}\": {}", key, shown(names_[i]), wrong));
      }
    }
    if (covariance_.rows() != std::ssize(names_)) {
      problem(kCovariance,
              fmt::format("{} has {} rows: must have a row and a column for each of the {} names",
                          kCovariance, covariance_.rows(), names_.size()));
    } else if (sound_) {
      check_elements();
    }
  }

 private:
  const std::string& name(Eigen::Index i) const { return names_[static_cast<std::size_t>(i)]; }

  void problem(std::string_view key, std::string text) {
    add_problem(document_, key, std::move(text));
    sound_ = false;
  }

  std::string objection_to_name(std::size_t i) const {
    const std::string& named = names_[i];
    const std::size_t at = numbered(errors_, named);
    if (at == errors_.size()) {
      return unknown(named);
    }
    if (!document_.values.contains(errors_[at].needs)) {
      return fmt::format("must be of a sensor that this mission has: {} is missing",
                         errors_[at].needs);
    }
    const auto first = std::ranges::find(names_, named) - names_.begin();
    return first == static_cast<std::ptrdiff_t>(i) ? std::string{} : "must be named once";
  }

  std::string unknown(const std::string& named) const {
    const auto other =
        kind_ == SpacecraftKind::Spin ? SpacecraftKind::ThreeAxis : SpacecraftKind::Spin;
    const auto others = errors_of(other, document_.values);
    if (numbered(others, named) != others.size()) {
      return fmt::format("is of a spacecraft of kind \"{}\", this one is \"{}\"", name_of(other),
                         name_of(kind_));
    }
    std::vector<std::string> all;
    std::ranges::transform(errors_, std::back_inserter(all),
                           [](const StatedError& error) { return std::string{error.name}; });
    const std::string nearest = nearest_name(shown(named), all);
    return nearest.empty() ? fmt::format("unknown; allowed here: {}", fmt::join(all, ", "))
                           : fmt::format("unknown; did you mean {}?", nearest);
  }

  void check_elements() {
    const Eigen::Index size = covariance_.rows();
    for (Eigen::Index i = 0; i < size; ++i) {
      const double most = most_sigma(schema_, errors_[numbered(errors_, name(i))].sigma_key);
      if (const double variance = covariance_(i, i); variance < 0.0 || variance > most * most) {
        element_problem(
            i, i, fmt::format("the variance of {} must lie in [0, {}]", name(i), most * most));
      }
    }
    for (Eigen::Index i = 0; sound_ && i < size; ++i) {
      for (Eigen::Index j = 0; j < i; ++j) {
        check_pair(i, j);
      }
    }
    if (sound_) {
      check_definiteness();
    }
  }

  void check_pair(Eigen::Index i, Eigen::Index j) {
    const double most = std::sqrt(covariance_(i, i) * covariance_(j, j));
    if (std::abs(covariance_(i, j) - covariance_(j, i)) > kRounding * most) {
      element_problem(i, j,
                      fmt::format("must be symmetric, [{}][{}] = {}", j, i, covariance_(j, i)));
    } else if (std::abs(covariance_(i, j)) > (1.0 + kRounding) * most) {
      element_problem(i, j,
                      fmt::format("the correlation of {} and {} must lie in [-1, 1]: at most "
                                  "{} by their variances",
                                  name(j), name(i), most));
    }
  }

  /// Checks the correlations, which do not depend on units; of what is known exactly there are
  /// none.
  void check_definiteness() {
    const Eigen::VectorXd weight = covariance_.diagonal().unaryExpr(
        [](double variance) { return variance > 0.0 ? 1.0 / std::sqrt(variance) : 0.0; });
    const Eigen::MatrixXd correlation = weight.asDiagonal() * covariance_ * weight.asDiagonal();
    const double least =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>{correlation, Eigen::EigenvaluesOnly}
            .eigenvalues()
            .minCoeff();
    if (least < -kRounding) {
      problem(kCovariance, fmt::format("{}: must be positive semidefinite: the least eigenvalue of "
                                       "its correlations is {:.3g}",
                                       kCovariance, least));
    }
  }

  void element_problem(Eigen::Index i, Eigen::Index j, std::string_view wrong) {
    const std::string key = fmt::format("{}[{}][{}]", kCovariance, i, j);
    problem(key, fmt::format("{} = {}: {}", key, covariance_(i, j), wrong));
  }

  TomlDocument& document_;
  const TableRule& schema_;
  SpacecraftKind kind_;
  StatedErrors errors_;
  std::vector<std::string> names_;
  Eigen::MatrixXd covariance_;  ///< As the file has it, rows and columns.
  bool sound_ = true;
};

}  // namespace

SpinAlignment spin_alignment(const TomlValues& values) {
  return stated_covariance(values, spin_errors());
}

AttitudeAlignment three_axis_alignment(const TomlValues& values) {
  return stated_covariance(values, three_axis_errors(values));
}

std::vector<DefaultSigma> default_sigmas(const TomlDocument& document, SpacecraftKind kind) {
  const StatedErrors errors = errors_of(kind, document.values);
  const std::vector<std::string> named = calibrated_names(document.values);
  std::vector<DefaultSigma> defaults;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const StatedError& error = errors[i];
    const bool counts = document.values.contains(error.needs) &&
                        std::ranges::find(named, error.name) == named.end();
    if (counts && !document.table.at_path(error.sigma_key) &&
        std::ranges::find(defaults, error.sigma_key, &DefaultSigma::key) == defaults.end()) {
      defaults.push_back({.key = error.sigma_key,
                          .value = number(document.values, error.sigma_key),
                          .error = static_cast<int>(i)});
    }
  }
  return defaults;
}

void check_calibration(TomlDocument& document, const TableRule& schema, SpacecraftKind kind) {
  if (document.values.contains(kNames)) {
    CalibrationCheck{document, schema, kind}.check();
  }
}

}  // namespace spindrift
