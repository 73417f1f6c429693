/// @file
/// The solution of the estimator `batch` for a pass, as a kind of product.

#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "pipelines/spin/batch/batch_solution.h"
#include "pipelines/spin/batch/pass_information.h"
#include "services/base/bias_words.h"
#include "services/base/degrees.h"
#include "services/products/axis_columns.h"
#include "services/products/product_kind.h"

namespace spindrift {

/// Shared because of its size. Its estimate is a separate product.
using BatchProduct = std::shared_ptr<const BatchSolution>;

inline std::int64_t batch_t_tai_ns(const BatchProduct& solution) {
  return tai_ns(solution->estimate.t);
}

struct SpinBatchTable {
  static constexpr std::string_view kName = "spin_batch";
  static constexpr std::array<std::string_view, 1> kKey{"t_tai_ns"};
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", &batch_t_tai_ns},
      ProductColumn{"bound_deg", [](const BatchProduct& s) { return s->bound_rad * kDegPerRad; }},
      ProductColumn{"edges", &BatchSolution::edges},
      ProductColumn{"outliers", &BatchSolution::outliers},
      ProductColumn{"residual_limit", [](const BatchProduct& /*s*/) { return kOutlierSigmas; }},
      ProductColumn{"noise", &BatchSolution::noise},
      ProductColumn{"iterations",
                    [](const BatchProduct& s) { return std::int64_t{s->iterations}; }},
      ProductColumn{"changed_tai_ns",
                    [](const BatchProduct& s) {
                      return s->changed ? std::optional{tai_ns(*s->changed)} : std::nullopt;
                    }},
      ProductColumn{"noise_sigma_deg",
                    [](const BatchProduct& s) {
                      return AxisColumns<SpinEstimate>::noise_sigma_deg(s->estimate);
                    }},
      ProductColumn{
          "consider_sigma_deg",
          [](const BatchProduct& s) { return AxisColumns<SpinEstimate>::sigma_deg(s->estimate); }},
      ProductColumn{"rate_drift_rpm_h",
                    [](const BatchProduct& s) { return s->drift_rad_s2 * kRpmPerHourPerRad_s2; }},
      ProductColumn{"rate_drift_sigma_rpm_h", [](const BatchProduct& s) {
                      return s->drift_sigma_rad_s2 * kRpmPerHourPerRad_s2;
                    }});
};

/// An element of a list in the solution.
template <class Value>
struct NumberedRow {
  std::int64_t t_tai_ns;
  std::int64_t position;  ///< Counted from 1.
  Value value;
};

/// Provides `kKey`, `rows` and `group` for the table of such a list.
template <class Value, std::vector<Value> BatchSolution::*kList>
struct NumberedTable {
  static constexpr std::array<std::string_view, 2> kKey{"t_tai_ns", "position"};
  using Row = NumberedRow<Value>;

  static std::int64_t group(const BatchProduct& solution) { return batch_t_tai_ns(solution); }
  static std::vector<Row> rows(const BatchProduct& solution) {
    std::vector<Row> rows;
    for (const Value& value : (*solution).*kList) {
      rows.push_back({.t_tai_ns = batch_t_tai_ns(solution),
                      .position = static_cast<std::int64_t>(rows.size()) + 1,
                      .value = value});
    }
    return rows;
  }
  /// @param stored Returns the stored form of a value.
  template <class Stored>
  static constexpr auto numbered(std::string_view name, Stored stored) {
    return columns(ProductColumn{"t_tai_ns", &Row::t_tai_ns},
                   ProductColumn{"position", &Row::position},
                   ProductColumn{name, [stored](const Row& row) { return stored(row.value); }});
  }
};

struct SpinBatchSingularValueTable : NumberedTable<double, &BatchSolution::singular_values> {
  static constexpr std::string_view kName = "spin_batch_singular_value";
  static constexpr auto kColumns = numbered("value", [](double value) { return value; });
};

struct SpinBatchUndeterminedTable : NumberedTable<BiasSet, &BatchSolution::undetermined> {
  static constexpr std::string_view kName = "spin_batch_undetermined";
  static constexpr auto kColumns = numbered("direction", &undetermined_sentence);
};

struct SpinBiasTable {
  static constexpr std::string_view kName = "spin_bias";
  static constexpr std::array<std::string_view, 2> kKey{"estimator", "name"};

  static std::int64_t t_tai_ns(const BatchProduct& solution) { return batch_t_tai_ns(solution); }
  static std::string_view group(const BatchProduct& solution) {
    return name_of(solution->estimate.estimator);
  }
  /// Gives no row for a channel that fell silent.
  static const std::vector<BiasEstimate>& rows(const BatchProduct& solution) {
    return solution->biases;
  }
  static double to_unit(const BiasEstimate& bias) {
    return range_of(bias.bias).is_angle ? kDegPerRad : 1.0;
  }
  static constexpr auto kColumns = columns(
      ProductColumn{"estimator",
                    [](const BiasEstimate& /*bias*/) { return name_of(SpinEstimator::Batch); }},
      ProductColumn{"name", [](const BiasEstimate& bias) { return range_of(bias.bias).name; }},
      ProductColumn{"value",
                    [](const BiasEstimate& bias) {
                      return bias.observable ? std::optional{bias.value * to_unit(bias)}
                                             : std::nullopt;
                    }},
      ProductColumn{"unit",
                    [](const BiasEstimate& bias) {
                      return std::string_view{range_of(bias.bias).is_angle ? "deg" : "km"};
                    }},
      ProductColumn{"sigma", [](const BiasEstimate& bias) { return bias.sigma * to_unit(bias); }},
      ProductColumn{"observable", &BiasEstimate::observable},
      ProductColumn{"estimated", &BiasEstimate::estimated});
};

/// Makes a column about the nutation that was found; null when none was found.
template <class Get>
constexpr auto nutation_column(std::string_view name, Get get) {
  return ProductColumn{name, [get](const BatchProduct& solution) {
                         const auto& found = solution->nutation->found;
                         return found ? std::optional{get(*found)} : std::nullopt;
                       }};
}

struct SpinNutationTable {
  static constexpr std::string_view kName = "spin_nutation";
  static constexpr std::array<std::string_view, 1> kKey{"t_tai_ns"};

  static bool has_row(const BatchProduct& solution) { return solution->nutation.has_value(); }

  using Found = FoundNutation;
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", &batch_t_tai_ns},
      ProductColumn{"detected",
                    [](const BatchProduct& s) { return s->nutation->found.has_value(); }},
      ProductColumn{"false_alarm", [](const BatchProduct& s) { return s->nutation->false_alarm; }},
      ProductColumn{"detectable_deg",
                    [](const BatchProduct& s) { return s->nutation->detectable_rad * kDegPerRad; }},
      nutation_column("half_angle_deg",
                      [](const Found& f) { return f.half_angle_rad.value * kDegPerRad; }),
      nutation_column("half_angle_sigma_deg",
                      [](const Found& f) { return f.half_angle_rad.sigma * kDegPerRad; }),
      nutation_column("period_s", [](const Found& f) { return f.period_s.value; }),
      nutation_column("period_sigma_s", [](const Found& f) { return f.period_s.sigma; }),
      nutation_column("growth_per_h",
                      [](const Found& f) { return f.growth_per_s.value * kHour_s; }),
      nutation_column("growth_sigma_per_h",
                      [](const Found& f) { return f.growth_per_s.sigma * kHour_s; }),
      nutation_column("lean_azimuth_deg",
                      [](const Found& f) { return f.lean_azimuth_rad.value * kDegPerRad; }),
      nutation_column("lean_azimuth_sigma_deg",
                      [](const Found& f) { return f.lean_azimuth_rad.sigma * kDegPerRad; }),
      ProductColumn{"at_tai_ns", [](const BatchProduct& s) {
                      return s->nutation->found ? std::optional{tai_ns(s->nutation_t)}
                                                : std::nullopt;
                    }});
};

/// Makes a column about the detected coning; null when none was detected.
template <class Get>
constexpr auto coning_column(std::string_view name, Get get) {
  return ProductColumn{name, [get](const BatchProduct& solution) {
                         const ConingEstimate& coning = solution->coning;
                         return coning.verdict.detected ? std::optional{get(coning) * kDegPerRad}
                                                        : std::nullopt;
                       }};
}

struct SpinConingTable {
  static constexpr std::string_view kName = "spin_coning";
  static constexpr std::array<std::string_view, 1> kKey{"t_tai_ns"};

  using Coning = ConingEstimate;
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns", &batch_t_tai_ns},
      ProductColumn{"detected", [](const BatchProduct& s) { return s->coning.verdict.detected; }},
      ProductColumn{
          "detectable_deg",
          [](const BatchProduct& s) { return s->coning.verdict.detectable_rad * kDegPerRad; }},
      coning_column("tilt_deg", [](const Coning& c) { return c.verdict.tilt_rad; }),
      coning_column("tilt_sigma_deg", [](const Coning& c) { return c.tilt_sigma_rad; }),
      coning_column("azimuth_deg", [](const Coning& c) { return c.verdict.azimuth_rad; }),
      coning_column("azimuth_sigma_deg", [](const Coning& c) { return c.azimuth_sigma_rad; }));
};

inline std::int64_t whole_ns(double t_s) { return std::llround(t_s * 1e9); }

/// Part of the view edge_residual. Whole nanoseconds and channel numbers take less room than
/// seconds and names.
struct BatchResidualTable {
  static constexpr std::string_view kName = "batch_residual";
  static constexpr std::array<std::string_view, 3> kKey{"is_last", "t_tai_ns", "channel"};
  static constexpr bool kOfResiduals = true;

  static std::int64_t t_tai_ns(const BatchProduct& solution) { return batch_t_tai_ns(solution); }
  static std::int64_t group(const BatchProduct& /*solution*/) { return 1; }
  static const std::vector<BatchEdge>& rows(const BatchProduct& solution) { return solution->said; }

  static constexpr auto kColumns = columns(
      ProductColumn{"is_last", [](const BatchEdge& /*edge*/) { return std::int64_t{1}; }},
      ProductColumn{"t_tai_ns", [](const BatchEdge& edge) { return tai_ns(edge.pulse.t); }},
      ProductColumn{
          "channel",
          [](const BatchEdge& edge) { return static_cast<std::int64_t>(edge.pulse.channel); }},
      ProductColumn{"residual_ns",
                    [](const BatchEdge& edge) {
                      return edge.residual_s ? std::optional{whole_ns(*edge.residual_s)}
                                             : std::nullopt;
                    }},
      ProductColumn{"sigma_ns", [](const BatchEdge& edge) { return whole_ns(edge.sigma_s); }},
      ProductColumn{"used", &BatchEdge::used});
};

template <>
struct ProductKind<BatchProduct> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<SpinBatchTable, SpinBatchSingularValueTable, SpinBatchUndeterminedTable,
                            SpinBiasTable, SpinNutationTable, SpinConingTable, BatchResidualTable>;
};

}  // namespace spindrift
