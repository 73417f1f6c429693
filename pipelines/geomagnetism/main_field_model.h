/// @file
/// The Earth's main magnetic field over a century: coefficients of epochs, even change between.

#pragma once

#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/geomagnetism/gauss_coefficients.h"
#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// The year and its part that has passed at `t`, by TAI: a year is 365 or 366 days.
double decimal_year(TaiTime t);
/// The other way round.
TaiTime instant_of_year(double year);

struct FieldEpoch {
  double year;
  GaussCoefficients coefficients;
};

/// Valid by construction.
class MainFieldModel {
 public:
  /// @return InvalidConfiguration for fewer than two epochs, and for epochs out of order.
  static Expected<MainFieldModel> make(std::vector<FieldEpoch> epochs);

  /// @param year With decimals. @return NoCoverage for a year outside the epochs.
  Expected<GaussCoefficients> coefficients(double year) const;

  /// @param degree Up to which is summed. @return NoCoverage likewise; InvalidInput for a degree
  ///        outside 1 to kHighestDegree.
  Expected<MainField> at(double year, int degree = kHighestDegree) const;

  double first_year() const { return epochs_.front().year; }
  double last_year() const { return epochs_.back().year; }

 private:
  explicit MainFieldModel(std::vector<FieldEpoch> epochs) : epochs_{std::move(epochs)} {}
  std::vector<FieldEpoch> epochs_;
};

}  // namespace spindrift
