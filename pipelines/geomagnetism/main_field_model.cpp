#include "pipelines/geomagnetism/main_field_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace spindrift {
namespace {

using std::chrono::days;

struct YearSpan {
  days beginning;  ///< Start of the year, days since 1970.
  days length;
};

YearSpan span_of(std::chrono::year year) {
  using namespace std::chrono;
  const auto beginning = sys_days{year / January / 1}.time_since_epoch();
  return {.beginning = beginning,
          .length = sys_days{(year + years{1}) / January / 1}.time_since_epoch() - beginning};
}

}  // namespace

double decimal_year(TaiTime t) {
  using namespace std::chrono;
  const auto since_1970 = t.time_since_epoch();
  const year in = year_month_day{sys_days{floor<days>(since_1970)}}.year();
  const YearSpan span = span_of(in);
  return static_cast<int>(in) + duration<double>{since_1970 - span.beginning} / span.length;
}

TaiTime instant_of_year(double year) {
  const double whole = std::floor(year);
  const YearSpan span = span_of(std::chrono::year{static_cast<int>(whole)});
  return shifted(TaiTime{span.beginning},
                 (year - whole) * std::chrono::duration<double>{span.length}.count());
}

Expected<MainFieldModel> MainFieldModel::make(std::vector<FieldEpoch> epochs) {
  if (epochs.size() < 2) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("a main field of {} epochs: at least 2", epochs.size())}};
  }
  for (std::size_t i = 1; i < epochs.size(); ++i) {
    if (!(epochs[i - 1].year < epochs[i].year)) {
      return Unexpected{{ErrorCode::InvalidConfiguration,
                         fmt::format("a main field with epoch {} behind {}: must be later",
                                     epochs[i].year, epochs[i - 1].year)}};
    }
  }
  return MainFieldModel{std::move(epochs)};
}

Expected<GaussCoefficients> MainFieldModel::coefficients(double year) const {
  if (!(year >= first_year() && year <= last_year())) {
    return Unexpected{
        {ErrorCode::NoCoverage, fmt::format("the geomagnetic field of year {}: known from {} to {}",
                                            year, first_year(), last_year())}};
  }
  const auto later =
      std::upper_bound(epochs_.begin() + 1, epochs_.end() - 1, year,
                       [](double at, const FieldEpoch& epoch) { return at < epoch.year; });
  const GaussCoefficients& from = std::prev(later)->coefficients;
  const GaussCoefficients& to = later->coefficients;
  const double share = (year - std::prev(later)->year) / (later->year - std::prev(later)->year);
  GaussCoefficients between;
  for (std::size_t i = 0; i < GaussCoefficients::kCount; ++i) {
    between.g_nt[i] = from.g_nt[i] + share * (to.g_nt[i] - from.g_nt[i]);
    between.h_nt[i] = from.h_nt[i] + share * (to.h_nt[i] - from.h_nt[i]);
  }
  return between;
}

Expected<MainField> MainFieldModel::at(double year, int degree) const {
  if (degree < 1 || degree > kHighestDegree) {
    return Unexpected{
        {ErrorCode::InvalidInput, fmt::format("the geomagnetic field to degree {}: must be 1 to {}",
                                              degree, kHighestDegree)}};
  }
  return coefficients(year).map([&](const GaussCoefficients& of_year) {
    return MainField{of_year, degree};
  });
}

}  // namespace spindrift
