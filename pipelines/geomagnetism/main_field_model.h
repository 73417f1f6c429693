/// @file
/// The Earth's main magnetic field over a century, interpolated linearly between epochs.

#pragma once

#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/geomagnetism/gauss_coefficients.h"
#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Returns the year and its elapsed fraction at `t`, by TAI: a year is 365 or 366 days.
double decimal_year(TaiTime t);
/// Returns the inverse of `decimal_year`.
TaiTime instant_of_year(double year);

struct FieldEpoch {
  double year;
  GaussCoefficients coefficients;
};

/// A field model, valid by construction.
class MainFieldModel {
 public:
  /// @return InvalidConfiguration for fewer than two epochs, and for epochs out of order.
  static Expected<MainFieldModel> make(std::vector<FieldEpoch> epochs);

  /// @param year Decimal year. @return NoCoverage for a year outside the epochs.
  Expected<GaussCoefficients> coefficients(double year) const;

  /// @param degree Highest degree of the sum.
  Expected<MainField> at(double year, int degree = kHighestDegree) const;

  double first_year() const { return epochs_.front().year; }
  double last_year() const { return epochs_.back().year; }

 private:
  explicit MainFieldModel(std::vector<FieldEpoch> epochs) : epochs_{std::move(epochs)} {}
  std::vector<FieldEpoch> epochs_;
};

}  // namespace spindrift
