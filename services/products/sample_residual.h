/// @file
/// The residual of a three-axis spacecraft's sample in the filter, as a kind of product.

#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <tuple>

#include "pipelines/three_axis/products.h"
#include "services/base/degrees.h"
#include "services/products/product_kind.h"
#include "services/products/pulse_use.h"
#include "services/products/rejected_sample.h"

namespace spindrift {

/// Gyro samples occur only when left out (rejected_sample.h).
inline bool is_gyro(const Observation& said) { return said.source == SampleSource::Gyro; }

/// Returns the factor to degrees, to nT, or to the unit of a gyro test.
inline double unit_of_residual(const Observation& said) {
  if (is_gyro(said)) {
    return unit_of_test(said.rejected_by.value());
  }
  return said.source == SampleSource::Magnetometer ? 1.0 : kDegPerRad;
}
inline std::string_view name_of_unit(const Observation& said) {
  if (is_gyro(said)) {
    return name_of_test_unit(said.rejected_by.value());
  }
  return said.source == SampleSource::Magnetometer ? "nT" : "deg";
}

/// Returns one component of the residual; null beyond the degrees of freedom.
template <int kComponent>
std::optional<double> residual_of(const Observation& said) {
  return kComponent < said.residual.freedom
             ? std::optional{said.residual.value[kComponent] * unit_of_residual(said)}
             : std::nullopt;
}
template <int kComponent>
std::optional<double> sigma_of(const Observation& said) {
  return kComponent < said.residual.freedom && !is_gyro(said)
             ? std::optional{said.residual.sigma[kComponent] * unit_of_residual(said)}
             : std::nullopt;
}
/// Returns null when nothing was expected.
inline std::optional<double> nis_of(const Observation& said) {
  return said.residual.freedom > 0 && !is_gyro(said) ? std::optional{said.nis} : std::nullopt;
}
inline double limit_of(const Observation& said) {
  return is_gyro(said) ? said.limit * unit_of_residual(said) : said.limit;
}

struct SampleResidualTable {
  static constexpr std::string_view kName = "sample_residual";
  static constexpr std::array<std::string_view, 3> kKey{"estimator", "t_tai_ns", "kind"};
  static constexpr std::string_view kCondition =
      "kind <> 'gyro' AND estimator NOT IN ('batch', 'sequential')";
  static constexpr bool kOfResiduals = true;

  using One = SampleObservation;
  static constexpr auto kColumns = columns(
      ProductColumn{"estimator", [](const One& one) { return name_of(one.estimator); }},
      ProductColumn{"t_tai_ns", [](const One& one) { return tai_ns(one.said.t); }},
      ProductColumn{"kind", [](const One& one) { return name_of(kind_of(one.said.source)); }},
      ProductColumn{"dof", [](const One& one) { return std::int64_t{one.said.residual.freedom}; }},
      ProductColumn{"unit", [](const One& one) { return name_of_unit(one.said); }},
      ProductColumn{"residual_1", [](const One& one) { return residual_of<0>(one.said); }},
      ProductColumn{"residual_2", [](const One& one) { return residual_of<1>(one.said); }},
      ProductColumn{"residual_3", [](const One& one) { return residual_of<2>(one.said); }},
      ProductColumn{"sigma_1", [](const One& one) { return sigma_of<0>(one.said); }},
      ProductColumn{"sigma_2", [](const One& one) { return sigma_of<1>(one.said); }},
      ProductColumn{"sigma_3", [](const One& one) { return sigma_of<2>(one.said); }},
      ProductColumn{"nis", [](const One& one) { return nis_of(one.said); }},
      ProductColumn{"limit", [](const One& one) { return limit_of(one.said); }},
      ProductColumn{"used", [](const One& one) { return !one.said.rejected_by; }},
      ProductColumn{"rejected_by", [](const One& one) { return name_of(one.said.rejected_by); }});
};

template <>
struct ProductKind<SampleObservation> {
  static constexpr ProductWeight kWeight = ProductWeight::Detail;
  using Tables = std::tuple<SampleResidualTable>;
};

}  // namespace spindrift
